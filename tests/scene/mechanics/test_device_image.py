"""The force of a device image: the reaction on the handle, in newtons whatever the constraint is written in."""

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, x
from hapticlab.errors import SceneError
from hapticlab.scene.notation.units import unit_of

q, theta = hl.coordinate("q", unit="m"), hl.coordinate("theta", unit="rad")
r = hl.parameters("r", units="m")


@pytest.mark.parametrize(
    ("constraint", "by_handle"),
    [(q - x(t), -1), (r * sp.sin(theta) - x(t), -1), (theta - x(t) / r, -1 / r), (q**2 - x(t) ** 2, -2 * x(t))],
)
def test_the_force_is_the_reaction_on_the_handle(constraint, by_handle):
    image = hl.mechanics.device_image(constraint, name="grip")
    (reaction,) = (f for f in image.force.atoms(sp.Function) if type(f).__name__ == "grip")
    assert image.force == -reaction * by_handle
    assert image.constraint == constraint
    assert unit_of(image.force) == "N"


def test_an_equation_is_taken_as_the_constraints_of_a_model_are():
    assert hl.mechanics.device_image(sp.Eq(q, x(t))) == hl.mechanics.device_image(q - x(t))


def test_a_constraint_without_the_handle_is_no_image():
    with pytest.raises(SceneError, match=r"grip: q\(t\) = 0 does not contain x\(t\),.*Write q - x\(t\)"):
        hl.mechanics.device_image(q, name="grip")
    with pytest.raises(SceneError, match="cannot name a device image"):
        hl.mechanics.device_image(q - x(t), name="x")
