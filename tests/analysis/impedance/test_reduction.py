"""Fewer masses at the handle: moments, passivity, errors measured against chains in closed form, and a run."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.analysis.impedance.impedance import impedance, port_of
from hapticlab.analysis.impedance.mass_chain import network_of
from hapticlab.analysis.impedance.moment_matching import candidates, soar
from hapticlab.analysis.impedance.reduction import reduction
from hapticlab.errors import AnalysisError

BARE = hl.Device(m=0.05, b=0.1)
HELD = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(m=0.02, b=4, k=400))


def chain(count, *, b=0.0, ground=0.0, start=0, uneven=False):
    """Return masses of 20 g in a row behind the handle on springs of 2000 N/m."""
    masses = [hl.coordinate(f"z{i}", unit="m", initial=start) for i in range(1, count + 1)]
    K, M, B, G = hl.parameters("k m b g", units="N/m kg N*s/m N/m", values=(2000, 0.02, b, ground))
    places, rates, eom = [x(t), *masses], [v(t), *(z.diff(t) for z in masses)], []

    def pull(i):
        return K * (places[i] - places[i + 1]) + (B * (rates[i] - rates[i + 1]) if b else 0)

    for i, z in enumerate(masses):
        rest = pull(i) - (pull(i + 1) if i < count - 1 else G * z if ground else 0)
        eom.append(sp.Eq(z.diff(t, 2), rest / M) if uneven and i % 2 else sp.Eq(M * z.diff(t, 2), rest))
    return hl.Scene(force=pull(0), eom=eom, name=f"chain of {count}")


def one_mass(spring):
    z, (K, M) = hl.coordinate("z", unit="m"), hl.parameters("k m", units="N/m kg", values=(spring, 0.08))
    return hl.Scene(force=K * (x(t) - z), eom=[sp.Eq(M * z.diff(t, 2), K * (x(t) - z))])


def test_the_fitted_mass_of_the_measured_chain():
    """Four masses against one of 80 g: a spring fitted to 10 Hz, the first spring, and the one that matches moments."""
    f = np.linspace(0.1, 10, 400)
    Z = impedance(chain(4), f)

    def error(spring, up_to):
        return (abs(impedance(one_mass(spring), f) - Z) / abs(Z))[f <= up_to].max()

    assert (error(1048, 5), error(1048, 10)) == (pytest.approx(0.0009, abs=1e-4), pytest.approx(0.0045, abs=6e-4))
    assert (error(2000, 5), error(2000, 10)) == (pytest.approx(0.036, abs=1e-3), pytest.approx(0.17, abs=6e-3))
    offer = reduction(chain(4), HELD, band=(0.1, 10), masses=1)
    # m^2 (4^2 + 3^2 + 2^2 + 1)/k is what the springs of the chain give way by: (4 m)^2/k_1 of one spring
    assert offer.scene.values == pytest.approx({"m_1": 0.08, "k_1": 2000 * 16 / 30}, rel=1e-9)
    assert error(offer.scene.values["k_1"], 5) < 0.0006


UNEVEN = {"b": 0.1, "ground": 300, "uneven": True}


@pytest.mark.parametrize("options", [{}, {"b": 0.05}, {"b": 2.0}, {"ground": 500}, UNEVEN], ids=str)
def test_two_masses_for_four(options):
    offer = reduction(chain(4, **options), HELD, band=(0.1, 10), masses=2)
    assert offer.largest < 0.002
    f = offer.frequency[::40]
    assert impedance(offer.scene, f) == pytest.approx(offer.impedance[::40], rel=1e-9)  # the scene is what was measured
    assert impedance(offer.full, f) == pytest.approx(offer.full_impedance[::40], rel=1e-9)


@pytest.mark.parametrize("options", [{"b": 0.3}, {"b": 0.1, "ground": 300}], ids=str)
@pytest.mark.parametrize("masses", [1, 3])
def test_reductions_are_passive(options, masses):
    offer = reduction(chain(5, **options), BARE, masses=masses, accept=True)
    Z = impedance(offer.scene, np.geomspace(1e-3, 1e4, 2000))
    assert Z.real.min() > -1e-9 * abs(Z).max()
    reduced = network_of(offer.scene, port_of(offer.scene))
    for matrix in (reduced.mass, reduced.damping, reduced.stiffness):
        assert np.linalg.eigvalsh(matrix).min() > -1e-9 * abs(matrix).max()


def test_moments_are_those_of_the_full_chain():
    """Near s = 0 the force is a power series in s, of which the reduced scene shares the first terms."""
    full = network_of(chain(5, ground=200), port_of(chain(5, ground=200))).of_unit_masses
    stiffness, _, _ = next(candidates(full.stiffness / 900, full.damping / 30, 2))

    def series(K, terms):
        z, found = -np.linalg.solve(K[1:, 1:], K[1:, 0]), [K[0, 0]]
        for _ in range(terms):  # z_(j+1) = -K^-1 z_j in powers of s^2
            found.append(K[0, 1:] @ z)
            z = -np.linalg.solve(K[1:, 1:], z)
        return np.r_[found[0] + found[1], found[2:]]

    assert series(stiffness, 5) == pytest.approx(series(full.stiffness / 900, 5), rel=1e-6)


def test_soar_spans_the_terms_of_the_series():
    generator = np.random.default_rng(3)
    G, H = generator.normal(size=(6, 6)), 0.2 * generator.normal(size=(6, 6))
    K, C = G @ G.T + np.eye(6), H @ H.T
    basis = soar(K, C, 4)[1:]
    assert basis.T @ basis == pytest.approx(np.eye(4), abs=1e-12)
    terms = [-np.linalg.solve(K[1:, 1:], K[1:, 0])]
    terms.append(-np.linalg.solve(K[1:, 1:], C[1:, 0] + C[1:, 1:] @ terms[0]))
    for _ in range(2):
        terms.append(-np.linalg.solve(K[1:, 1:], C[1:, 1:] @ terms[-1] + terms[-2]))
    for k, term in enumerate(terms):
        outside = term - basis[:, : k + 1] @ (basis[:, : k + 1].T @ term)
        assert np.linalg.norm(outside) < 1e-8 * np.linalg.norm(term)


def test_the_reduced_scene_runs_as_the_full_one():
    """A hand that moves smoothly within the band feels the same; starts are carried over."""

    def intent(time):
        return 0.01 * (1 - np.cos(2 * np.pi * 4 * time)) ** 2

    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(m=0.02, b=4, k=400, intent=intent))
    full = chain(4, b=0.2, ground=100)
    offer = reduction(full, paddle, band=(0.1, 15), masses=2)
    one, two = (paddle.run(scene, duration=0.5, progress=False, dtype="float64") for scene in (full, offer.scene))
    assert abs(one.F).max() > 2
    assert abs(one.F - two.F).max() < 2e-3 * abs(one.F).max()
    assert abs(one.x - two.x).max() < 2e-4 * abs(one.x).max()


def test_starts_are_carried_over():
    """A chain that starts as it rests with the handle at 10 mm rests in its reduction, too."""
    rigid = reduction(chain(4, start=x(n)), BARE, band=(0.1, 10), masses=2).scene
    log = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3).run(rigid, duration=0.02, x=0.01, progress=False)
    assert abs(log.F).max() < 1e-5
    moved = reduction(chain(4, start=hl.parameters("z_0", units="m", values=0.002)), BARE, band=(0.1, 10), masses=1).scene
    assert moved.values["r_1_0"] == pytest.approx(0.002)


def test_a_reduction_asks_no_more_of_the_device():
    """Fewer masses on softer springs: what holds of the full scene in any passive hand holds of the reduced one."""
    for masses in (1, 2, 3):
        full, reduced = reduction(chain(4, b=0.2), HELD, band=(0.1, 10), masses=masses).device_damping()
        assert 0.5 * full < reduced < full


def test_masses_that_nobody_feels_are_not_in_it():
    """A follower that the chain drives and that does not act back on it changes neither impedance nor reduction."""
    y, pull = hl.coordinate("y", unit="m"), hl.parameters("k_y m_y", units="N/m kg", values=(50, 0.1))
    plain = chain(3)
    last = plain.coordinates[-1]
    follower = sp.Eq(pull[1] * y.diff(t, 2), pull[0] * (last - y))
    scene = hl.Scene(force=plain.force, eom=[*plain.eom, follower], watch=[y])
    offer = reduction(scene, HELD, band=(0.1, 10), masses=1)
    assert offer.scene.values == pytest.approx(dict(reduction(plain, HELD, band=(0.1, 10), masses=1).scene.values))


def test_order_by_tolerance_and_the_printout():
    offer = reduction(chain(8), HELD, band=(0.1, 10))
    assert offer.masses == 2 and offer.within and [count for count, _ in offer.tried] == [1, 2]
    assert offer.tried[0][1] > 0.05 > offer.tried[1][1] == offer.largest
    before, after = offer.instructions()
    assert after < before / 3
    text = str(offer)
    assert f"8 masses replaced by 2, {before} instructions by {after}" in text and "within the tolerance" in text
    assert len(offer.plot().axes) == 2


def test_what_is_refused():
    with pytest.raises(
        AnalysisError,
        match=r"outside the tolerance of 0.05 over 0.1 to 100 Hz: .* with 1 mass, .* with 3 masses\. .*accept=True with masses=3",
    ):
        reduction(chain(4), HELD, band=(0.1, 100), accept=True)
    with pytest.raises(AnalysisError, match="a NoneType has no m; needs a paddle"):
        reduction(chain(4), None)
    with pytest.raises(AnalysisError, match="accept=True takes it"):
        reduction(chain(4), HELD, band=(0.1, 100), masses=1)
    assert not reduction(chain(4), HELD, band=(0.1, 100), masses=1, accept=True).within
    with pytest.raises(AnalysisError, match="no mass can be left out"):
        reduction(chain(1), HELD)
    with pytest.raises(AnalysisError, match="at least 1 and fewer"):
        reduction(chain(3), HELD, masses=3)
    with pytest.raises(AnalysisError, match="0 < low < high"):
        reduction(chain(3), HELD, band=(5, 1))


def test_scenes_that_are_no_network_of_masses():
    z, y = hl.coordinate("z", unit="m"), hl.coordinate("y", unit="m")
    k, m, b = hl.parameters("k m b", units="N/m kg N*s/m", values=(100, 0.02, 1.0), ranges={"b": (-2, 2)})
    pull, between = k * (x(t) - z), k * (z - y)
    second = sp.Eq(m * y.diff(t, 2), between)
    one_way = hl.Scene(force=k * (x(t) - y), eom=[sp.Eq(m * z.diff(t, 2), pull), second], name="one way")
    with pytest.raises(AnalysisError, match="do not act on the handle in the same way, so there is no network of masses"):
        reduction(one_way, HELD)
    active = hl.Scene(force=pull, eom=[sp.Eq(m * z.diff(t, 2), pull - between - b * z.diff(t)), second], name="active")
    with pytest.raises(AnalysisError, match="damping is negative"):
        reduction(active(b=-1), HELD)
    massless = hl.Scene(force=pull, eom=[sp.Eq(b * z.diff(t), pull - between), second], name="massless")
    with pytest.raises(AnalysisError, match="z has no mass"):
        reduction(massless, HELD)
    turn = hl.coordinate("turn", unit="m")
    size = hl.parameters("size", units="m", values=0.1)
    bent = [sp.Eq(m * turn.diff(t, 2), k * (x(t) - turn - size * sp.sin((turn - y) / size))), second.subs(z, turn)]
    with pytest.raises(AnalysisError, match=r"bent: k.*size\*sin.* is not linear"):
        reduction(hl.Scene(force=k * (x(t) - turn), eom=bent, name="bent"), HELD)
    with pytest.raises(AnalysisError, match=r"bent: .*Piecewise.* in the force is not linear"):
        reduction(hl.Scene(force=hl.when(x(t) > z, pull), eom=[sp.Eq(m * z.diff(t, 2), pull), second], name="bent"), HELD)
    weight, drive = hl.parameters("weight", units="N", values=0.2), hl.parameters("f", units="Hz", values=3)
    for more, said in (
        (weight, "the equation of z contains 0.2 at rest; measure"),
        (weight * sp.sin(2 * sp.pi * drive * t), ": time drives the equation of z"),
        (weight * x(n - 1) / size, "uses past samples"),
    ):
        scene = hl.Scene(force=pull, eom=[sp.Eq(m * z.diff(t, 2), pull - between + more), second])
        with pytest.raises(AnalysisError, match=said):
            reduction(scene, HELD)


def test_masses_that_move_as_one():
    """Two equal masses side by side on equal springs are one to the handle; asking for both is refused."""
    u, w, last = (hl.coordinate(name, unit="m") for name in ("u", "w", "last"))
    k, m = hl.parameters("k m", units="N/m kg", values=(800, 0.03))
    F = k * (x(t) - u) + k * (x(t) - w) + 2 * k * (x(t) - last)
    eom = [sp.Eq(m * u.diff(t, 2), k * (x(t) - u)), sp.Eq(m * w.diff(t, 2), k * (x(t) - w))]
    scene = hl.Scene(force=F, eom=[*eom, sp.Eq(2 * m * last.diff(t, 2), 2 * k * (x(t) - last))], name="side by side")
    one = reduction(scene, HELD)
    assert one.masses == 1 and one.largest < 1e-12
    assert one.scene.values == pytest.approx({"m_1": 0.12, "k_1": 3200}, rel=1e-9)
    with pytest.raises(AnalysisError, match="fewer than 2 separate masses; "):
        reduction(scene, HELD, masses=2)
