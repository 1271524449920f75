"""What the command line does with a scene that is shared: one file for any browser."""

from pathlib import Path

from ..widgets.shared.share import share as write_file
from .scenes import compiling, opened, tell


def share(parser, options):
    """Write a scene file as a file for any browser, and say what it runs."""
    chosen = compiling(parser, options)
    file, path = opened(parser, options), Path(options.file)
    shared = write_file(file.scene, file.paddle, options.out or f"{path.stem}.html", let_go=options.let_go, **chosen)
    program = file.paddle.program(file.scene, **chosen)
    values = {c.name: value for c, value in zip(program.parameters, program.values, strict=True)}
    facts = {
        "scene": shared.scene,
        "bytes": shared.bytes,
        "parameters": values,
        "units": {c.name: c.unit for c in program.parameters},
    }
    shown = ", ".join(f"{name} = {value:g}" for name, value in values.items()) or "no parameters"
    made = f", {program.facts['method']}" if "method" in program.facts else ""
    lines = (
        f"scene    {shared.scene}: {shown}",
        f"program  {len(program)} instructions per tick, T = {program.T:g} s{made}, with paddle and hand around it",
        f"size     {shared.bytes / 1000:.0f} kB. Open it by a double click; it needs no network",
    )
    return tell(options, facts, {"file": shared.path}, "\n".join(lines))
