"""What the command line does with a scene that is shared: one file for any browser."""

import sys
import tokenize
from pathlib import Path

from ..widgets.shared.code import why_private
from ..widgets.shared.scene_code import values_code
from ..widgets.shared.share import share as write_file
from .scenes import compiling, opened, tell


def share(parser, options):
    """Write a scene file as a file for any browser, and say what it runs."""
    chosen = compiling(parser, options)
    file, path = opened(parser, options), Path(options.file)
    code = _code(_text(path), options) if _may_be_copied(path, options) else False
    shared = write_file(file.scene, file.paddle, options.out or f"{path.stem}.html", let_go=options.let_go, code=code, **chosen)
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


def _text(path):
    """Return the text of a Python file, in the encoding that it names."""
    with tokenize.open(path) as file:
        return file.read()


def _may_be_copied(path, options):
    """Tell whether readers may copy the text of the scene file; ask, where there is someone to ask."""
    if options.code is not None:
        return options.code
    why = why_private(_text(path))
    if options.json or not sys.stdin.isatty():
        return not why
    doubt = f" ({why})" if why else ""
    print(f"Let readers of the page copy the text of {path.name}{doubt}? [{'y/N' if why else 'Y/n'}] ", end="", file=sys.stderr)
    answer = sys.stdin.readline().strip().lower()
    return answer in ("y", "yes") if why else answer not in ("n", "no")


def _code(text, options):
    """Return the text of a scene file, with the values and options of the command line."""
    more = [f"scene = scene({values_code(dict(options.set))})"] if options.set else []
    named = {"T": options.T, "method": options.method, "paddle": options.paddle and Path(options.paddle).name}
    given = [f"--{name} {value}" for name, value in named.items() if value]
    more += [f"# shared with {' '.join(given)}"] if given else []
    return "\n".join([text.rstrip(), *more]) + "\n"
