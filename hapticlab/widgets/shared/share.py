"""hl.share: a scene as one file, which a browser runs without hapticlab."""

from __future__ import annotations

import time
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...base.arguments import number
from ...base.shows_itself import ShowsItself
from ...device.simulated.simulated_paddle import SimulatedPaddle
from ...errors import PaddleError
from ...scene.scene import check_scene
from ..live import SPEEDS
from ..stage import Stage
from .around import body, fixed, heading, lead
from .code import shared_code
from .page import page
from .page_data import page_data
from .still import still
from .units import units

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...base.annotations import File
    from ...scene.scene import Scene

#: options of :func:`share` that its code to copy does not name
USUAL = {"sliders": None, "time_scale": 1.0, "picture": None, "let_go": False}


def share(
    scene: Scene,
    paddle: SimulatedPaddle,
    path: File | None = None,
    *,
    sliders: Mapping[str, tuple[float, float]] | None = None,
    time_scale: float = 1.0,
    picture: Any = None,
    let_go: bool = False,
    code: str | bool = True,
    **compile_options: Any,
) -> SharedFile:
    """Write a scene on a simulated paddle as one HTML file that runs in any browser, without Python and without a network.

    The file opens by a double click and shows what :func:`hapticlab.live` shows in a notebook: the picture, sliders, traces,
    the loop of force over position. The page runs the compiled program of scene, paddle and hand, so that the same hand
    feels the same forces as by ``paddle.run``, bit for bit; noise alone is drawn by a different generator, see
    docs/how_to/sharing.md. The file never opens a port, so that no motor can move.

    Parameters
    ----------
    scene : Scene
        With values for all its parameters.
    paddle : SimulatedPaddle
        Its hand holds the handle, led by whoever opens the file, or ``hl.Hand("pinch")`` where that hand has no spring.
    path : str or Path, optional
        The file to write, which ends in .html; a file of that name is replaced. By default the name of the scene, in the
        current folder.
    sliders, time_scale, picture, let_go
        As for :func:`hapticlab.live`.
    code : str or bool
        The Python that readers of the page can copy: a text such as that of your own file; True for a text that is made from
        the scene, where it can be written out; False for none.
    **compile_options
        Of hapticlab.compile: method, substeps, hold, dtype.

    Returns
    -------
    SharedFile
        In a notebook, a link to the file.

    Raises
    ------
    PaddleError
        For a paddle that is not simulated, a path that does not end in .html, and a time_scale out of its range.
    ParameterError
        For sliders of what cannot be set, and a parameter without a value.
    AnalysisError
        For a drawing function that does not use functions of NumPy alone, see docs/how_to/sharing.md.
    OSError
        Where the file cannot be written.

    Examples
    --------
    >>> import hapticlab as hl, tempfile
    >>> paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
    >>> shared = hl.share(hl.wall()(k=300, x_o=0.01), paddle, f"{tempfile.mkdtemp()}/wall.html")
    >>> shared.path.name, shared.bytes < 500_000
    ('wall.html', True)
    """
    check_scene(scene)
    if not isinstance(paddle, SimulatedPaddle):
        raise PaddleError(
            f"paddle = {paddle!r}; a shared file runs on a simulated paddle, since it never opens a port. Give "
            "hl.SimulatedPaddle(...), or hl.SimulatedPaddle.from_profile(...) of a profile or its file"
        )
    path = Path(_file_name(scene.name) if path is None else path)
    if path.suffix.lower() not in (".html", ".htm"):  # a browser shows others as text, and a scene file would be lost
        other = path.parent / f"{path.stem or 'scene'}.html"
        raise PaddleError(f"path = {str(path)!r}; a browser opens a file that ends in .html. Give {str(other)!r}")
    slowest, fastest = SPEEDS
    why = "1 is real time, 0.1 slow motion"
    speed = number("time_scale", time_scale, "", "a shared file", least=slowest, most=fastest, why=why, error=PaddleError)
    looks = {"sliders": sliders, "speed": speed, "picture": picture, "let_go": let_go}
    stage = Stage(paddle, scene, clock=time.monotonic, **looks, **compile_options)
    given = {"sliders": sliders, "time_scale": speed, "picture": picture, "let_go": bool(let_go)}
    changed = {name: value for name, value in given.items() if value != USUAL[name]}
    python = _code(code, scene, paddle, changed | compile_options)
    data = page_data(stage) | {"metric": units(), "code": python, "fixed": fixed(scene, stage.source)}
    picture = still(stage.drawn(None), stage.picture.box, f"{scene.name}: the first picture of the scene")
    text = page(data, heading(scene), lead(scene), body(scene, python, data["fixed"]), picture)
    path.write_text(text, "utf-8", newline="\n")
    return SharedFile(path, len(text.encode()), stage.source.program.name)


def _code(code, scene, paddle, given):
    """Return Python before and after a visitor's values, or None."""
    if isinstance(code, str):
        return f"{code.rstrip()}\n", ""
    return shared_code(scene, paddle, **given) if code else None


@dataclass(frozen=True)
class SharedFile(ShowsItself):
    """A file that :func:`share` wrote.

    Attributes
    ----------
    path : Path
    bytes : int
        Its size.
    scene : str
        Name of the scene that it runs.
    """

    path: Path
    bytes: int
    scene: str

    def _repr_html_(self) -> str:
        return f'<p><a href="{escape(str(self.path))}" target="_blank">{escape(str(self))}</a></p>'

    def __str__(self) -> str:
        return f"{self.path}: {self.scene}, {self.bytes / 1000:.0f} kB, for any browser"


def _file_name(scene):
    stem = "".join(c if c.isalnum() else "_" for c in scene).strip("_") or "scene"
    return f"{stem}.html"
