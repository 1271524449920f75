"""Scenes under a handle that moves as given: its polynomials, what samples become, one tick on arrays of one's own."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import T, n, t, v, x
from hapticlab.analysis.accuracy.continuous_handle import DEGREE, coefficients, driven, without_samples
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.table import ENGINES
from hapticlab.errors import ProgramError


def test_a_period_of_the_handle_is_its_taylor_polynomial():
    # x = sin(w t): the derivatives are known, and the rest after the last term is (w h/2)^(DEGREE+1)/(DEGREE+1)!
    w, h, k = 30.0, 1e-3, np.arange(DEGREE + 1)
    middle = h * (np.arange(5) + 0.5)
    derivatives = w ** k[:, None] * np.sin(w * middle + k[:, None] * np.pi / 2)
    rows = coefficients(derivatives, h)
    assert rows.shape == (5, DEGREE + 1)
    for theta in (-0.5, 0.0, 0.31, 0.5):
        assert np.allclose(rows @ theta**k, np.sin(w * (middle + theta * h)), rtol=0, atol=1e-15)


def test_what_samples_become_as_the_period_goes_to_zero():
    k = hl.parameters("k", units="N/m", values=3)
    assert without_samples(k * x(n)) == k * x(n)
    assert without_samples(sp.Rational(3, 2) * x(n) - x(n - 1) / 2) == x(n)
    assert without_samples((x(n) - x(n - 2)) / (2 * T)) == v(n)
    assert without_samples(x(n) + T / 2 * v(n)) == x(n)
    assert without_samples(k * sp.sin(3 * n * T)) == k * sp.sin(3 * t)
    assert without_samples(hl.laws.delay(hl.laws.delay(k * v(n)))) == k * v(n)
    assert "acceleration" in str(without_samples((v(n) - v(n - 1)) / T))
    with pytest.raises(ProgramError, match="difference of a delay"):
        without_samples((k * x(n) - hl.laws.delay(k * x(n))) / T)


def test_a_driven_program_sees_the_handle_move_within_the_period():
    # y' = x(t) from 0 with x = t^2: y = t^3/3 at the end of every period, which no hold of a sample gives
    y = hl.coordinate("y", unit="m*s")
    scene = hl.Scene(force=hl.parameters("k", units="N/(m*s)", values=1) * y, eom=[sp.Eq(y.diff(t), x(t))])
    h, k = 0.1, np.arange(11)
    middle = h * (k + 0.5)
    rows = coefficients(np.array([middle**2, 2 * middle, 0 * middle + 2, *[0 * middle] * (DEGREE - 2)]), h)
    program = driven(scene, T=h, order=6)
    inputs = np.column_stack([(h * k) ** 2, 2 * h * k, 0 * k + 2, rows])[:, : len(program.inputs)]
    assert np.allclose(load(program).run(11, inputs).outputs[:, 0, 0], (h * k) ** 3 / 3, rtol=1e-14)


@pytest.mark.parametrize("engine", [name for name, record in ENGINES.items() if record.automatic and record.is_here()])
def test_one_tick_on_arrays_is_a_tick_of_a_run(engine):
    z = hl.coordinate("z", unit="m")
    m, K, b = hl.parameters("m K b", units="kg N/m N*s/m", values=(0.08, 310, 0.6))
    F = hl.laws.virtual_coupler(z, K=K, b=b)
    program = hl.compile(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)]), T=1e-3, dtype="float64")
    loaded, samples = load(program, engine), np.sin(np.arange(6.0))
    first = loaded.run(1, samples[:1, None])
    inputs, states, outputs, tick = loaded.once()
    states[:] = first.states[:, 0]
    found = []
    for sample in samples[1:]:
        inputs[0] = sample
        tick()
        found.append(outputs[0])
    whole = loaded.run(6, samples[:, None])
    assert found == whole.outputs[1:, 0, 0].tolist() and states.tolist() == whole.states[:, 0].tolist()
