"""What methods refuse, and the term that they name."""

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.errors import ProgramError

T = 1e-3
m, K, B, g, l = hl.parameters("m K B g l", units="kg N/m N*s/m m/s^2 m", values=(0.05, 500.0, 1.0, 9.81, 0.1))
tau, z_o = hl.parameters("tau z_o", units="s m", values=(0.05, 0.01))
z, y = hl.coordinate("z", unit="m"), hl.coordinate("y", unit="m")
a, b = hl.coordinate("a", unit="rad"), hl.coordinate("b", unit="rad", initial=1)
PULL = K * (x(t) - z)


def scene(*eom, force=PULL):
    return hl.Scene(force=force, eom=list(eom))


def swinging(*angles):
    """A chain of pendulums, absolute angles."""
    kinetic = potential = 0
    horizontal = vertical = 0
    for angle in angles:
        horizontal, vertical = horizontal + l * sp.sin(angle), vertical - l * sp.cos(angle)
        kinetic += m * (sp.diff(horizontal, t) ** 2 + sp.diff(vertical, t) ** 2) / 2
        potential += m * g * vertical
    return hl.mechanics.lagrange(kinetic - potential)


@pytest.mark.parametrize(
    ("eom", "force", "said"),
    [
        ([sp.Eq(m * z.diff(t, 2), PULL - B * z.diff(t))], PULL, r"acceleration of z depends on .*, through -B\*Derivative\(z"),
        ([sp.Eq(m * z.diff(t, 2), PULL), sp.Eq(tau * y.diff(t), z - y)], PULL + K * y, "y has an equation of first order"),
        ([swinging(a, b)], K * l * sp.sin(a), "acceleration of a depends on .*it nystrom4 has order 2, not 4. Use 'rk4'"),
    ],
)  # fmt: skip
def test_nystroms_method_wants_accelerations_free_of_velocities(eom, force, said):
    with pytest.raises(ProgramError, match=said):
        hl.compile(scene(*eom, force=force), "nystrom4", T=T)


def test_nystroms_method_sees_through_what_only_looks_like_a_velocity():
    """Of Lagrange's equations the term d/dt(dL/dq') holds velocities only where masses move: one pendulum's do not."""
    pendulum = hl.Scene(force=K * l * sp.sin(a), eom=[swinging(a)])
    assert hl.compile(pendulum, "nystrom4", T=T).facts["method"] == "nystrom4"
    turned = hl.Scene(force=PULL, eom=[sp.Eq(m * z.diff(t, 2), PULL + B * z.diff(t) - z.diff(t) * B)])
    hl.compile(turned, "nystrom4", T=T)
    with pytest.raises(ProgramError, match="square of velocities"):
        hl.compile(hl.Scene(force=PULL, eom=[hl.mechanics.lagrange(
            m * (z.diff(t) ** 2 + y.diff(t) ** 2) / 2, forces={z: PULL}, constraints=[z - y])]), "nystrom4", T=T)  # fmt: skip


@pytest.mark.parametrize("method", ["adams_bashforth2", "adams_bashforth3"])
@pytest.mark.parametrize(
    ("term", "said"),
    [
        (-K * sp.Max(0, z - z_o), r"Max\(0, .* in the equation of z changes with z\(t\)"),
        (hl.when(x(t) > z_o, -K * z), r"Piecewise.* changes with x\(t\)"),
        (-B * sp.sign(z.diff(t)) * sp.Abs(v(n)), r"(Abs|sign)\(.*\) in the equation of z changes with"),
    ],
)  # fmt: skip
def test_multistep_methods_refuse_cases(method, term, said):
    with pytest.raises(ProgramError, match=said + ".*rates from earlier steps"):
        hl.compile(scene(sp.Eq(m * z.diff(t, 2), PULL + term)), method, T=T)


def test_multistep_methods_refuse_contacts_and_what_is_exact_beside_them():
    contact = hl.contact.Contact(z_o - z, hl.contact.penalty(k=K), name="stop")
    model = hl.mechanics.lagrange(m * z.diff(t) ** 2 / 2, forces={z: PULL}, contacts=[contact])
    with pytest.raises(ProgramError, match="stop starts and ends within a step: adams_bashforth3 uses rates from earlier steps,"):
        hl.compile(scene(model), "adams_bashforth3", T=T)
    rows = [sp.Eq(m * z.diff(t, 2), PULL), sp.Eq(m * y.diff(t, 2), K * (z - y) - K * l * sp.sin(y / l))]
    with pytest.raises(ProgramError, match="Use 'exact\\+rk4'"):
        hl.compile(scene(*rows, force=PULL + K * y), "exact+adams_bashforth2", T=T, live=())


def test_cases_of_parameters_alone_are_no_cases_of_the_motion():
    hl.compile(scene(sp.Eq(m * z.diff(t, 2), PULL + hl.when(K > B / tau, -K * z))), "adams_bashforth2", T=T)
