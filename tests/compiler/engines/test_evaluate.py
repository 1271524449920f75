"""A compiled program over a motion that is given: the same numbers as an engine gives, named, and refusals in words."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import ParameterError, ProgramError
from hapticlab.records import evaluate

X = 0.012 * np.sin(np.linspace(0, 3, 50))
MASS = hl.library.mass_spring_damper()


@pytest.mark.parametrize("engine", ["interpreter", "auto"])
def test_it_gives_what_the_engine_gives_with_names(engine):
    program = hl.compile(MASS, T=1e-3)
    log = evaluate(program, x=X, engine=engine)
    outputs = load(program, "interpreter").run(len(X), X[:, None]).outputs[:, :, 0]
    assert np.array_equal(log.F, outputs[:, 0]) and log.columns[4:] == tuple(c.name for c in program.outputs[1:])
    assert log.T == program.T and np.array_equal(log.x, X) and log.scene == program.name
    np.testing.assert_allclose(log.v[1:], np.diff(X) / 1e-3)
    assert log.parameters == dict(zip((c.name for c in program.parameters), program.values, strict=True))


def test_parameters_are_set_by_name_and_with_units():
    program = hl.compile(hl.wall()(k=150), T=1e-3, dtype="float64")
    stiff = evaluate(program, x=[0.011], k="0.3 N/mm", x_o="10 mm")
    assert stiff.F[0] == pytest.approx(0.3) and stiff.parameters["k"] == pytest.approx(300)
    assert evaluate(program, x=[0.011]).F[0] == pytest.approx(1.65)


def test_a_measured_velocity_is_given():
    B = hl.parameters("B", units="N*s/m", values=2)
    scene = hl.Scene(force=B * hl.v(hl.n))
    measured = hl.compile(scene, T=1e-3, velocity="measured")
    assert evaluate(measured, x=[0, 0], v=[1, 3]).F.tolist() == [2, 6]
    with pytest.raises(ProgramError, match="compiled with velocity='measured'; give v="):
        evaluate(measured, x=[0, 0])
    with pytest.raises(ProgramError, match="v has 1 values, x 2; give as many"):
        evaluate(measured, x=[0, 0], v=[1])
    with pytest.raises(ProgramError, match="estimates v from x. Leave out v,"):
        evaluate(hl.compile(scene, T=1e-3), x=[0, 0], v=[1, 1])


def test_what_cannot_be_is_refused():
    program = hl.compile(hl.wall(), T=1e-3)
    with pytest.raises(ProgramError, match="no value for k"):
        evaluate(program, x=[0])
    with pytest.raises(ParameterError, match="K is not a live parameter of zoh wall. It has B,"):
        evaluate(program, x=[0], K=3)
    with pytest.raises(ParameterError, match="a stiffness needs k >= 0"):
        evaluate(program, x=[0], k=-3)
    for wrong in ([], [[0]], [np.nan], "push"):
        with pytest.raises(ProgramError, match="needs one finite number per sample"):
            evaluate(program, x=wrong, k=3)
