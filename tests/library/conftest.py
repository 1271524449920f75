"""A scene moved by a handle that is led, so that what the mechanism does can be compared with a closed form."""

from types import SimpleNamespace

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.engines import engine


@pytest.fixture(scope="session")
def led():
    """Return a function that leads the handle along x [m] and returns what is felt and watched, in double precision.

    Every state that ``start`` does not name is zero there, and the handle has been at rest.
    """

    def lead(scene, x, *, T, start=None, velocity="backward_difference", **options):
        program = hl.compile(scene, T=T, dtype="float64", velocity=velocity, **options)
        names = [c.name for c in program.states]
        loaded, x = engine.load(program), np.asarray(x, float)
        inputs = x[:, None] if len(program.inputs) == 1 else np.column_stack([x, np.gradient(x, T)])
        states = None
        if start is not None:
            states = np.zeros((len(names), 1))
            for name, value in {**{name: x[0] for name in names if name.startswith("x(")}, **start}.items():
                states[names.index(name), 0] = value
        run = loaded.run(len(x), inputs, program.values, states)
        columns = {c.name: run.outputs[:, j, 0] for j, c in enumerate(program.outputs)}
        return SimpleNamespace(t=np.arange(len(x)) * T, x=x, **columns)

    return lead
