"""What a scene does at the handle: its force, sample by sample, over a motion that is given."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import CourseError
from ..scene.scene import check_scene

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..base.annotations import Array
    from ..scene.scene import Scene

#: what may be given beside the motion, as hl.compile takes it
OPTIONS = ("method", "substeps", "hold", "force_at")
#: samples times instructions, up to which interpreting takes less time than compiling to machine code, with the same bits
FEW = 4000


def felt(
    scene: Scene,
    *,
    x: Sequence[float] | Array,
    v: Sequence[float] | Array | None = None,
    T: float = 1e-3,
    values: Mapping[str, float] | None = None,
    channels: Sequence[str] | None = None,
    **options: Any,
) -> Array | dict[str, Array]:
    """Force of a scene over given samples, in float64.

    Parameters
    ----------
    scene : Scene
    x : sequence of float
        Handle position [m], one a sample.
    v : sequence of float, optional
        Handle velocity [m/s]; by default the backward difference of x.
    T : float
        Sampling period [s].
    values : dict of str to float, optional
        Values of the scene's parameters, SI.
    channels : sequence of str, optional
        What it watches that is wanted beside the force.
    **options
        Of :func:`hapticlab.compile`: method, substeps, hold, force_at.

    Returns
    -------
    ndarray of F [N], or with ``channels`` a dict of "F" and each channel

    Examples
    --------
    >>> import hapticlab as hl
    >>> felt(hl.wall(), x=[0, 0.005, 0.012], values={"k": 150.0, "x_o": 0.01}).round(12).tolist()
    [0.0, 0.0, 0.3]
    """
    # here, as the compiler takes as long to import as SymPy, and most answers are no scenes
    from ..compiler.engines.engine import load
    from ..compiler.tick.compile_scene import compile

    check_scene(scene)
    strange = sorted(set(options) - set(OPTIONS))
    if strange:
        raise CourseError(f"{', '.join(strange)} given; a scene runs with x, v, T, values, channels, {', '.join(OPTIONS)}")
    velocity = "backward_difference" if v is None else "measured"
    bound = scene(**(values or {}))
    program = compile(bound, T=T, dtype="float64", velocity=velocity, live=(), **options)
    motion = {"x": x, "v": v}
    rows = np.array([np.asarray(motion[c.name], float) for c in program.inputs]).T.reshape(len(x), len(program.inputs))
    engine = "interpreter" if len(x) * program.size <= FEW else "auto"
    outputs = load(program, engine).run(len(x), rows).outputs[:, :, 0]
    named = dict(zip((c.name for c in program.outputs), outputs.T, strict=True))
    if channels is None:
        return named["F"]
    missing = [name for name in channels if name not in named]
    if missing:
        raise CourseError(f"the scene does not watch {', '.join(missing)}; it watches {', '.join(named)}. Add watch=[...]")
    return {name: named[name] for name in ("F", *channels)}
