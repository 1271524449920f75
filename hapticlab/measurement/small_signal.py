"""A scene's own law at a place: force per small motion, from its program's answer to one sample that is off."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..compiler.engines.engine import load
from ..errors import AnalysisError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..base.annotations import Array
    from ..compiler.ir.program import Program

#: of the motion [m], and samples of the answer that are followed
SMALL, LONGEST = 1e-6, 20_000


def law_at(
    program: Program, place: float, theta: Array, *, small: float = SMALL
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """H(e^(j theta)) of F to x, and of F to a measured v, complex arrays, linearised at a place [m].

    The program runs at rest there until it has settled; then x is off by a micrometre for one sample, and what the force
    does is the law's impulse response. Run it in float64: a float32 has no micrometre to spare.

    Raises
    ------
    AnalysisError
        For an answer that does not die out: the scene has a motion of its own without damping.
    """
    engine, names = load(program), [c.name for c in program.inputs]
    rest = np.zeros((LONGEST, len(names)))
    rest[:, names.index("x")] = place
    states = engine.run(LONGEST, rest).states
    still, found = engine.run(LONGEST, rest, states=states).outputs[:, 0, 0], {}
    for name, size in (("x", small), ("v", small / program.T)):
        if name not in names:
            found[name] = np.zeros(len(theta), complex)
            continue
        off = rest.copy()
        off[0, names.index(name)] += size
        answer = (engine.run(LONGEST, off, states=states).outputs[:, 0, 0] - still) / size
        if abs(answer[-LONGEST // 10 :]).max() > 1e-6 * abs(answer).max():
            raise AnalysisError(
                f"{program.name}: the response of its force to a motion does not die out within {LONGEST} samples"
            )
        last = np.flatnonzero(abs(answer) > 1e-12 * abs(answer).max())
        answer = answer[: last[-1] + 1] if len(last) else answer[:1]
        found[name] = np.exp(-1j * np.outer(theta, np.arange(len(answer)))) @ answer
    return found["x"], found["v"]


def force_at_rest(program: Program, place: float) -> float:
    """The force with the handle at rest at a place, settled [N]."""
    names = [c.name for c in program.inputs]
    rest = np.zeros((LONGEST, len(names)))
    rest[:, names.index("x")] = place
    return float(load(program).run(LONGEST, rest).outputs[-1, 0, 0])
