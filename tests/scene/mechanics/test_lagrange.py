"""Lagrange's equations: against SymPy's, in energy, in print, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import LagrangesMethod

import hapticlab as hl
from hapticlab import t, x
from hapticlab.compiler.algebra.graph import Graph
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import MassError, ProgramLimitError, SceneError, UnitsError

m, M, l, g, k, c = hl.parameters("m M l g k c", units="kg kg m m/s^2 N/m N*s/m", values=(0.1, 0.5, 0.2, 9.81, 40.0, 0.0))
z, phi = hl.coordinate("z", unit="m", initial=x(hl.n)), hl.coordinate("phi", unit="rad")
bob = (z + l * sp.sin(phi), -l * sp.cos(phi))
KINETIC = M * z.diff(t) ** 2 / 2 + m * (bob[0].diff(t) ** 2 + bob[1].diff(t) ** 2) / 2
L = KINETIC - m * g * bob[1] - k * z**2 / 2


def test_matrix_and_forces_are_those_of_sympy():
    mech = hl.mechanics.lagrange(L, dissipation=c * z.diff(t) ** 2 / 2, forces={phi: k * l * (x(t) - z)})
    q = list(mech.coordinates)
    method = LagrangesMethod(L, q)
    method.form_lagranges_equations()
    forces = method.forcing + sp.Matrix([{z: -c * z.diff(t), phi: k * l * (x(t) - z)}[p] for p in q])
    at = {z: 0.03, phi: 0.7, z.diff(t): 0.4, phi.diff(t): -2.0, x(t): 0.01}
    at |= {p: p.value if p != c else 0.3 for p in (m, M, l, g, k, c)}
    got = Graph().evaluate([*(e for row in mech.M for e in row), *mech.f], at)
    rates_first = {e: n for e, n in at.items() if isinstance(e, sp.Derivative)}
    wanted = [float(e.xreplace(rates_first).xreplace(at)) for e in [*method.mass_matrix, *forces]]
    np.testing.assert_allclose(got, wanted, rtol=1e-13)


def test_energy_is_kept():
    mech = hl.mechanics.lagrange(L)
    E = m * g * bob[1] + k * z**2 / 2 + KINETIC
    kept = sp.expand(mech.energy.doit() - E.doit())
    assert sp.simplify(kept) == 0
    scene = hl.Scene(force=0, eom=[mech], watch={"E": mech.energy})
    program = hl.compile(scene, T=1e-3, dtype="float64", substeps=2)
    energy = load(program).run(200, np.full((200, len(program.inputs)), 0.02)).outputs[:, 1, 0]
    assert abs(energy - energy[0]).max() < 1e-9 * abs(energy[0])


def test_coordinates_by_name():
    mech = hl.mechanics.lagrange(L)
    assert mech["phi"] == phi
    with pytest.raises(SceneError, match="no coordinate 'psi'; there are phi, z"):
        mech["psi"]


def test_print():
    mech = hl.mechanics.lagrange(m * l**2 * phi.diff(t) ** 2 / 2 + m * g * l * sp.cos(phi))
    (equation,) = mech.equations
    assert equation == sp.Eq(m * l**2 * phi.diff(t, 2), -m * g * l * sp.sin(phi))
    latex = mech._repr_latex_()
    assert latex.startswith("$\\displaystyle")
    assert r"m \ddot{\phi}" in latex
    assert str(mech).startswith("L = g*l*m*cos(phi(t))")


def test_equations_with_multipliers():
    mech = hl.mechanics.lagrange(KINETIC - m * g * bob[1], constraints=[sp.Eq(z, l * phi)])
    forces = [e.rhs for e in mech.equations]
    one = sp.Symbol("lambda1")
    assert [sp.expand(f).coeff(one) for f in forces] == [-l, 1]
    assert "0 = " in mech._repr_latex_()
    assert str(mech).endswith("0 = -l*phi(t) + z(t)")


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"L": k * l**2}, MassError, r"contains no coordinate; declare one, z = hl.coordinate"),
        (
            {"L": m * l * z.diff(t, 2)},
            SceneError,
            r"contains Derivative\(z\(t\), \(t, 2\)\); energies depend on positions and rates only",
        ),
        ({"L": k * z}, UnitsError, r"L: .* is in N .*in N\*m"),
        ({"L": L - k * z}, UnitsError, r"L: .*"),
        ({"L": L, "dissipation": c * z.diff(t)}, UnitsError, r"dissipation: .*in W"),
        ({"L": L, "forces": {z: k}}, UnitsError, r"force on z: k is in N/m"),
        ({"L": L, "forces": {phi: k * z}}, UnitsError, r"force on phi: .*N\*m"),
        ({"L": L, "forces": {z.diff(t): k * z}}, SceneError, r"its keys are coordinates: phi\(t\), z\(t\)"),
        ({"L": L, "forces": {"z": k * z}}, SceneError, r"forces has the key 'z'; its keys are coordinates .*forces=\{z: F\}"),
        ({"L": L, "forces": [k * z]}, SceneError, r"forces = \[k\*z\(t\)\]; needs a dict"),
        ({"L": L, "forces": k * z}, SceneError, r"forces = k\*z\(t\); needs a dict"),
        ({"L": sp.Eq(z, L)}, SceneError, r"L = Eq\(.*is an equation; needs an expression, such as its right side"),
        ({"L": L, "dissipation": sp.Eq(z, L)}, SceneError, r"dissipation = Eq\(.*is an equation"),
        ({"L": L, "constraints": [z == phi]}, SceneError, r"Python's == compares at once. Write sp.Eq\(a, b\)"),
        ({"L": L, "constraints": [sp.Eq(z, z)]}, SceneError, r"constraint 1 is True: its sides are equal for every motion"),
        ({"L": L, "constraints": [sp.Eq(z, l * phi), sp.Eq(z, phi)]}, UnitsError, r"constraint 2: .*in m but .*in 1"),
        ({"L": L, "constraints": [l * phi - z.diff(t)]}, UnitsError, r"constraint 1: .*in m/s"),
        ({"L": L, "constraints": [z - l * phi], "alpha": 50.0}, SceneError, r"alpha = 50.0 .*enforce = 'auto' does not use."),
        ({"L": L, "contacts": [z]}, SceneError, r"contacts contains z\(t\); needs hl.contact.Contact\(gap,"),
        ({"L": L, "enforce": "glue"}, SceneError, r"enforce = 'glue'; needs one of auto, embed"),
        ({"L": "m*v"}, SceneError, r"L = 'm\*v'; needs a number, or an expression"),
    ],
)
def test_what_is_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        hl.mechanics.lagrange(**arguments)


def compiled(mech, **options):
    return hl.compile(hl.Scene(force=0, eom=[mech], watch=[mech.coordinates[0]]), T=1e-3, **options)


def test_a_coordinate_that_nothing_determines():
    with pytest.raises(MassError, match="do not determine the accelerations of phi .a massless direction"):
        compiled(hl.mechanics.lagrange(M * z.diff(t) ** 2 / 2 - k * (z - l * sp.sin(phi)) ** 2 / 2))


def test_a_massless_direction():
    y = hl.coordinate("y", unit="m")
    with pytest.raises(MassError, match="do not determine the accelerations of y and z"):
        compiled(hl.mechanics.lagrange(M * (z.diff(t) - y.diff(t)) ** 2 / 2 - k * z**2 / 2))


def test_two_models_of_one_coordinate():
    with pytest.raises(SceneError, match=r"two Lagrangians move z; add the energies and give one hl.mechanics.lagrange"):
        hl.compile(
            hl.Scene(force=0, eom=[hl.mechanics.lagrange(L), hl.mechanics.lagrange(M * z.diff(t) ** 2)], watch=["z"]), T=1e-3
        )


def test_a_model_without_energies_has_none():
    with pytest.raises(SceneError, match="came without a Lagrangian"):
        replace(hl.mechanics.lagrange(L), lagrangian=None).energy  # noqa: B018


def test_past_the_limit_the_term_that_grew_is_named(monkeypatch):
    monkeypatch.setattr("hapticlab.compiler.algebra.expressions.MOST_INSTRUCTIONS", 300)
    rough = sp.Add(*(sp.sin(j * phi) ** j for j in range(1, 80)))
    mech = hl.mechanics.lagrange(KINETIC - m * g * l * rough)
    with pytest.raises(ProgramLimitError, match=r"more than 300 instructions: \d+ of them are for sin\(phi.*fewer terms"):
        compiled(mech)
    many = [hl.coordinate(f"q{j}", unit="m") for j in range(20)]
    pulls = [k * sp.Add(*(many[j] - many[i] for i in range(20))) for j in range(20)]
    eom = [sp.Eq(m * p.diff(t, 2), -pull) for p, pull in zip(many, pulls, strict=True)]
    with pytest.raises(ProgramLimitError, match="none of which is the largest. Use fewer coordinates"):
        hl.compile(hl.Scene(force=0, eom=eom, watch=many), T=1e-3)
