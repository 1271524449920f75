"""What a scene requires: every figure is the difference of two programs, every part left out leaves the force as it was."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.analysis.programs.replay import replay
from hapticlab.analysis.programs.requires import requires
from hapticlab.compiler.contacts.broad_phase import contacts_between
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.prune.dependence import Dependence
from hapticlab.errors import AnalysisError, ParameterError, ProgramError, SceneError
from hapticlab.scene.shapes.shapes import Circle, ground

T = 1e-3
w, y, z = (hl.coordinate(name, unit="m") for name in "wyz")
th, ph = (hl.coordinate(name, unit="rad") for name in ("th", "ph"))
k, m, b = hl.parameters("k m b", units="N/m kg N*s/m", values=(500, 0.05, 0.8))
g, length, c = hl.parameters("g l c", units="m/s^2 m 1/m/s^2", values=(9.81, 0.1, 40))
COUPLER = k * (x(t) - z) + b * (v(t) - z.diff(t))
MASS = sp.Eq(m * z.diff(t, 2), COUPLER)


def pendulum(q, drive):
    return sp.Eq(q.diff(t, 2), -g / length * sp.sin(q) + c * drive)


def found(report, name, among=("kept", "dropped")):
    items = [i for group in among for i in getattr(report, group) if i.name == name]
    assert len(items) == 1, f"{name} in {report}"
    return items[0]


def size(scene, **options):
    return len(hl.compile(scene, T=T, **options))


def test_states_that_the_force_cannot_see():
    """Two pendula on a coupled mass that nothing watches, the one hanging on the other's angle."""
    seen = hl.Scene(force=COUPLER, eom=[MASS])
    scene = hl.Scene(force=COUPLER, eom=[MASS, pendulum(th, z), pendulum(ph, th * length)])
    report = requires(scene)
    item = found(report, "ph, th")
    watching = hl.Scene(force=COUPLER, eom=scene.eom, watch=[ph])
    assert item.kind == "state" and item.why == "no path to F or a watched channel"
    assert item.saves == size(watching) - size(seen) > 80
    assert len(report.program) == size(seen) and report.program.states == hl.compile(seen, T=T).states
    assert [found(report, name).why for name in "cgl"] == ["only parts that are left out use it"] * 3
    assert found(report, "z").why == "the force depends on it"
    assert report.felt is scene and report.view is None


@pytest.mark.parametrize("order", [1, pytest.param(-1, marks=pytest.mark.wide)])
def test_an_acceleration_that_goes_one_way_couples_nothing(order):
    """A pendulum that a mass drags along, and that never pulls back; the mass does not need it, but it needs the mass."""
    dragged = sp.Eq(length * th.diff(t, 2), -g * sp.sin(th) - z.diff(t, 2) * sp.cos(th))
    scene, alone = hl.Scene(force=COUPLER, eom=[MASS, dragged][::order]), hl.Scene(force=COUPLER, eom=[MASS])
    assert found(requires(scene), "th").why == "no path to F or a watched channel"
    motion = 0.01 * np.sin(np.arange(300) * 0.03)
    forces = [hl.records.evaluate(hl.compile(one, T=T), x=motion).F for one in (scene, alone)]
    assert np.array_equal(*forces) and size(scene) == size(alone)
    report = requires(hl.Scene(force=COUPLER, eom=scene.eom, watch=[th]))
    assert (report.offered[0].kind, report.offered[0].name) == ("view", "th")
    assert size(report.felt) == size(alone) and {type(q).__name__ for q in report.view.coordinates} == {"z", "th"}
    pulls = sp.Eq(m * z.diff(t, 2) + m * length * th.diff(t, 2), COUPLER)  # and now it pulls back
    assert found(requires(hl.Scene(force=COUPLER, eom=[pulls, dragged])), "th").why == "the force depends on it through z"


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.always("[01]")
def test_states_are_needed_as_the_inverse_of_the_mass_matrix_says(seed):
    """Each row of M q'' = x - q: q_j'' enters q_i'' where the inverse has an entry, and so on through q_i."""
    random = np.random.default_rng(seed)
    M = np.where(random.random((6, 6)) < 0.18, random.uniform(0.1, 0.4, (6, 6)), 0.0) + np.diag(random.uniform(1, 2, 6))
    q, one = [hl.coordinate(f"q{i}", unit="m") for i in range(6)], hl.parameters("one", units="1/s^2", values=1.0)
    eom = [sp.Eq(sum(M[i, j] * q[j].diff(t, 2) for j in range(6)), one * (x(t) - q[i])) for i in range(6)]
    reached, entries = np.eye(6)[0] > 0, abs(np.linalg.inv(M)) > 1e-12
    for _ in range(6):
        reached = reached | (reached @ entries)
    form = hl.Scene(force=k * (x(t) - q[0]), eom=eom).explicit()
    assert {type(form.coordinates[row]).__name__ for row in Dependence(form).needed} == {f"q{i}" for i in np.flatnonzero(reached)}


def test_the_way_to_the_force_is_named():
    eom = [sp.Eq(b * z.diff(t), k * (y - z)), sp.Eq(b * y.diff(t), k * (w - y)), sp.Eq(b * w.diff(t), k * (x(t) - w))]
    report = requires(hl.Scene(force=k * z, eom=eom, watch={"shown": y}))
    assert found(report, "w").why == "the force depends on it through z, y"  # though the channel is nearer
    assert found(report, "y").why == "the force depends on it through z"
    shown = requires(hl.Scene(force=k * z, eom=[*eom[1:], sp.Eq(b * z.diff(t), k * (x(t) - z))], watch={"shown": y}))
    assert found(shown, "w").why == "watch shown depends on it through y"
    assert not report.dropped or all(i.kind == "velocity" for i in report.dropped)


def test_parameters_that_are_folded():
    scene = hl.Scene(force=COUPLER, eom=[MASS])
    report = requires(scene, live="k")
    everything = size(scene)
    saves = {name: size(scene, live=["k", name]) - size(scene, live="k") for name in ("m", "b")}
    assert found(report, "m").saves == saves["m"] > 0
    assert saves["b"] == 0 and not any(i.name == "b" for i in report.dropped)  # the row of both names it
    together = found(report, "b, m")
    assert together.saves == everything - size(scene, live="k") > 0
    assert found(report, "m").why == "folded to 0.05 kg"
    assert found(report, "k").why == "live: can be changed while it runs, >= 0 N/m"


def test_a_velocity_that_nothing_uses():
    report = requires(hl.Scene(force=k * x(n)))
    assert found(report, "v").saves == 2  # (x(n) - x(n-1))/T
    assert not any(i.kind == "velocity" for i in requires(hl.wall()).dropped)  # its B is live
    assert not any(i.kind == "velocity" for i in requires(hl.Scene(force=b * v(n))).dropped)


def test_modes_that_the_ranges_exclude():
    low, high = hl.parameters("low high", units="m m", values=(0.01, 0.03), ranges=((0.005, 0.02), (0.025, 0.04)))
    swapped = hl.when(low > high, k * (x(n) - high), hl.when(x(n) > low, k * (x(n) - low), 0))
    plain = hl.Scene(force=hl.when(x(n) > low, k * (x(n) - low), 0))
    scene = hl.Scene(force=swapped)
    report = requires(scene)
    item = found(report, "low > high")
    assert item.kind == "mode" and item.why == "never holds: low in [0.005, 0.02], high in [0.025, 0.04]"
    assert len(report.program) == size(plain)
    assert item.saves == report.everything - len(report.program) - found(report, "v").saves > 2
    open_ = hl.parameters("low", units="m", values=0.01)
    assert not any(i.kind == "mode" for i in requires(hl.Scene(force=swapped.xreplace({low: open_}))).dropped)


def test_a_live_parameter_decides_by_its_range_and_a_fixed_one_by_its_value():
    stiff = hl.parameters("stiff", units="N/m", values=100, ranges=(0, 1000))
    scene = hl.Scene(force=sp.Max(stiff, hl.parameters("k_0", units="N/m", values=300)) * x(n))
    assert not any(i.kind == "mode" for i in requires(scene).dropped)
    fixed = requires(scene, live="")
    assert found(fixed, "Max(k_0, stiff)").why == "is k_0: k_0 in [300, 300], stiff in [100, 100]"
    out = load(hl.compile(scene, T=T, live=())).run(2, np.array([[0.01], [0.02]])).outputs[:, 0, 0]
    assert out == pytest.approx([3, 6], rel=1e-6)


def test_an_alias_costs_nothing():
    s, a = hl.signal("s", unit="m"), hl.signal("a", unit="m")
    scene = hl.Scene(force=k * (x(n) - a(n)), eom=[sp.Eq(a(n), s(n)), sp.Eq(s(n), z), MASS])  # in the wrong order
    assert size(scene) == size(hl.Scene(force=k * (x(n) - z), eom=[MASS]))
    assert found(requires(scene), "a").why == "another name of s(n): no instruction of its own"


SHOWN = hl.Scene(force=COUPLER, eom=[MASS, pendulum(th, z), pendulum(ph, z)], watch=[z, th], name="shown")


def test_an_island_that_only_feeds_a_view():
    report = requires(SHOWN)
    item = found(report, "th", ["offered"])
    assert item.kind == "view" and item.saves == size(SHOWN) - size(report.felt) > 40
    assert list(report.felt.watch) == ["z"] and list(report.view.watch) == ["th"]
    assert [type(q).__name__ for q in report.felt.coordinates] == ["z"]
    assert [type(q).__name__ for q in report.view.coordinates] == ["th", "z"]  # z moves it
    assert "view of shown" in str(report.view)


def paddle(**options):
    def intent(time):
        return 0.01 * (1 - np.cos(2 * np.pi * 2 * time))

    return hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hl.Hand(m=0.02, b=4, k=400, intent=intent), **options)


def test_a_view_is_replayed_at_a_slower_rate():
    report = requires(SHOWN)
    whole = paddle().run(SHOWN, duration=1.0, progress=False, dtype="float64")
    log = paddle().run(report.felt, duration=1.0, progress=False, dtype="float64")
    assert log.F == pytest.approx(whole.F, abs=1e-12)
    errors = {}
    for every in (1, 5, 20):
        result = replay(report.view, log, every=every, dtype="float64")
        assert result.log.columns == ("t", "x", "v", "F", "z", "th") and result.log.units["th"] == "rad"
        errors[every] = abs(result.log.th - whole.th).max() / abs(whole.th).max()
        assert result.error["th"] == pytest.approx(abs(result.log.th - whole.th).max(), rel=0.05, abs=1e-9)
    assert errors[1] < 1e-9 and errors[5] < 2e-4 and errors[20] < 1e-2
    assert "every 20 rows; largest difference from every row" in str(result)


def test_a_replay_follows_what_was_set_while_it_ran():
    rate = hl.parameters("r", units="1/s", values=5.0)
    view = hl.Scene(force=0, eom=[sp.Eq(y.diff(t), rate * (x(t) - y))], watch=[y])
    log = hl.records.Telemetry(
        t=np.arange(200) * T, x=np.full(200, 0.02), v=np.zeros(200), F=np.zeros(200), T=T, parameters={"r": 10.0},
        changes=((0.1, {"r": 50.0}),),
    )  # fmt: skip
    time = np.minimum(log.t, 0.1)
    exact = 0.02 * (1 - np.exp(-10 * time - 50 * (log.t - time)))
    assert replay(view, log, every=1).log.y == pytest.approx(exact, abs=1e-7)
    assert replay(view, log, every=10).log.y == pytest.approx(exact, abs=4e-4)  # it bends where r changes


def test_what_a_replay_refuses():
    log = paddle().run(hl.wall()(k=100, x_o=0), duration=0.05, progress=False)
    s = hl.signal("s", unit="m")
    smooth = hl.Scene(force=0, eom=[sp.Eq(s(n), 0.9 * s(n - 1) + 0.1 * x(n))], watch={"shown": s(n)})
    with pytest.raises(ProgramError, match=r"every = 10: s\(n\) depends on the sampling period,.*every=1"):
        replay(smooth, log)
    assert len(replay(smooth, log, every=1).log.shown) == 50
    with pytest.raises(ProgramError, match="from 1 to 49"):
        replay(SHOWN, log, every=50)
    with pytest.raises(AnalysisError, match="watches nothing"):
        replay(hl.Scene(force=0), log)
    with pytest.raises(AnalysisError, match="not a scene"):
        replay(None, log)
    with pytest.raises(AnalysisError, match="needs the record of a run"):
        replay(SHOWN, None)


def test_the_exact_method_is_offered():
    scene = hl.Scene(force=COUPLER, eom=[MASS, pendulum(th, z)], watch=[th])
    report = requires(scene)
    item = next(i for i in report.offered if i.kind == "linear")
    assert item.name == "z" and item.why.startswith("method='exact+rk4', live='c g l'")
    assert item.saves == size(scene, live="c g l") - size(scene, method="exact+rk4", live="c g l") > 20
    swing = requires(hl.Scene(force=length * k * sp.sin(th), eom=[pendulum(th, x(t))]))
    assert not swing.offered and swing.declined.endswith("its slope changes with th(t)")
    assert "\noffered: nothing; exact is not offered: " in str(swing) and "exact is not offered" in swing._repr_html_()
    assert not any(i.kind == "linear" for i in requires(scene, method="exact+rk4", live="c g l").offered)


def test_everything_is_what_was_left_out_together():
    scene = hl.Scene(force=COUPLER, eom=[MASS, pendulum(th, z)])
    kept = hl.Scene(force=COUPLER, eom=scene.eom, watch=[th])
    report = requires(scene, live="k")
    assert report.everything == size(kept) and len(report.program) == size(scene, live="k")
    assert f"{len(report.program)} instructions per tick and 4 states (1 coordinate, 1 rate, 2 past samples)" in str(report)
    assert f"; {report.everything} with nothing left out" in str(report)


def test_the_rows_add_up():
    """The second pendulum and the velocity share x(n-1), and folded parameters fold in what is left out too."""
    scene = hl.Scene(force=COUPLER, eom=[MASS, pendulum(th, z), pendulum(ph, v(t) * b / k)])
    for live in (None, "k", ""):
        report = requires(scene, live=live)
        rows = [i.saves for i in report.dropped if i.saves is not None and i.kind != "of these"]
        assert all(rows) and sum(rows) == report.everything - len(report.program), str(report)


def test_a_constant_that_costs_instructions_is_said_to():
    """x(n)*k with k = 1/3 needs a constant loaded; nothing is saved and no row claims so."""
    for scene in (hl.Scene(force=COUPLER, eom=[MASS]), hl.Scene(force=k * x(n)), hl.wall()(k=100, B=1, x_o=0)):
        report = requires(scene, live="")
        for item in report.dropped:
            assert item.saves is None or item.saves > 0 or item.kind == "shared", str(report)
            size_without = size(scene, live=[item.name]) if item.kind == "of these" else None
            if item.kind == "of these" and item.saves is None:
                assert size_without < size(scene, live="") and " more" in item.why


def test_the_printout():
    text = str(requires(SHOWN, live="k"))
    for line in ("kept", "left out", "offered", "folded to 0.05 kg", "no path to F or a watched channel"):
        assert line in text
    left_out = dict(requires(SHOWN)._tables())["left out"]
    assert "ph" in left_out.columns["name"] and len(left_out.columns["saves"]) == len(left_out)


def test_what_it_refuses():
    with pytest.raises(SceneError, match="k is not a scene; write hl.mechanics.requires"):
        requires(k)
    with pytest.raises(SceneError, match=r"cart_pole is a function, not a scene; call it: hl.library.cart_pole\(\)"):
        requires(hl.library.cart_pole)
    with pytest.raises(ParameterError, match="nobody is not a parameter"):
        requires(SHOWN, live="nobody")
    with pytest.raises(ProgramError, match="method = 'best'"):
        requires(SHOWN, method="best")


def test_a_decision_on_a_coordinate_is_watched_over():
    """A stop that z cannot reach is left out; where z leaves its range after all, the motor goes off and says why."""
    near = hl.coordinate("near", unit="m", range=(-0.02, 0.02))
    z_o = hl.parameters("z_o", units="m", values=0.03, ranges=(0.025, 0.04))
    pull = k * (x(t) - near)
    scene = hl.Scene(force=pull, eom=[sp.Eq(m * near.diff(t, 2), pull - hl.when(near > z_o, k * (near - z_o)))])
    program = hl.compile(scene, T=T)
    assert program.notes[0] == "F is nan where near left -0.02..0.02 m"
    assert found(requires(scene), "near(t) > z_o").saves > 10
    log = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hl.Hand(push=5)).run(scene, duration=0.3, progress=False)
    assert "Most likely near left -0.02..0.02 m" in log.fault
    quiet = hl.SimulatedPaddle(m=0.05, b=0.1, T=T).run(scene, duration=0.3, v=0.05, progress=False)
    assert quiet.fault is None and abs(quiet.F).max() > 0.1


def test_energies_of_several_bodies():
    """One Lagrangian of a mass that is felt and a pendulum that is not: the graph tells them apart, blocks of M included."""
    L = m * z.diff(t) ** 2 / 2 + m * length**2 * th.diff(t) ** 2 / 2 + m * g * length * sp.cos(th) - k * (x(t) - z) ** 2 / 2
    scene = hl.Scene(force=k * (x(t) - z), eom=[hl.mechanics.lagrange(L, dissipation=b * (v(t) - z.diff(t)) ** 2 / 2)])
    report = requires(scene, live="g l")
    assert found(report, "th").why == "no path to F or a watched channel" and found(report, "th").saves > 30
    assert next(i for i in report.offered if i.kind == "linear").name == "z"
    exact = hl.compile(scene, T=T, method="exact", live="g l", dtype="float64")
    assert "th" in exact.notes[0]
    plain = hl.Scene(force=k * (x(t) - z), eom=[MASS])
    outputs = [
        load(hl.compile(s, T=T, method="exact", live=(), dtype="float64")).run(50, np.linspace(0, 0.01, 50)[:, None]).outputs
        for s in (scene, plain)
    ]
    assert outputs[0] == pytest.approx(outputs[1], abs=1e-13)


def test_what_a_constraint_ties_is_kept():
    """A pendulum whose mass slides on a rail of the felt mass: the constraint alone ties what the force needs."""
    L = m * (z.diff(t) ** 2 + w.diff(t) ** 2) / 2 - k * (x(t) - z) ** 2 / 2
    tied = hl.mechanics.lagrange(L, constraints=[sp.Eq(w, 2 * z)], enforce="kkt")
    report = requires(hl.Scene(force=k * (x(t) - z), eom=[tied]))
    assert found(report, "w").kind == "state"
    assert not [i for i in report.dropped if i.kind == "state"]
    assert not report.offered and report.declined in ("w is tied by a constraint", "z is tied by a constraint")


def test_the_cause_is_an_inertia_that_changes():
    """That of the first of two links is constant, though written with sin^2 + cos^2; that which couples them is not."""
    at_1 = length * sp.sin(th), -length * sp.cos(th)
    at_2 = at_1[0] + length * sp.sin(ph), at_1[1] - length * sp.cos(ph)
    L = sum(m * p.diff(t) ** 2 / 2 for p in (*at_1, *at_2)) - m * g * (at_1[1] + at_2[1])
    report = requires(hl.Scene(force=k * (x(t) - at_1[0]), eom=[hl.mechanics.lagrange(L)]))
    assert "that couples ph and th changes with ph(t), th(t)" in report.declined
    turned = sum(m * p.diff(t) ** 2 / 2 for p in at_1) - k * length**2 * th**2 / 2
    plain = requires(hl.Scene(force=k * (x(t) - length * th), eom=[hl.mechanics.lagrange(turned)]))
    assert plain.declined.startswith("-k*l**2*th(t) in the equation of th is written with Deriv")


def test_friction_may_stick():
    F_c = hl.parameters("F_c", units="N", values=0.5)
    model = hl.mechanics.lagrange(
        m * z.diff(t) ** 2 / 2 - k * (x(t) - z) ** 2 / 2, contacts=[hl.contact.friction(slip=z.diff(t), coulomb=F_c)]
    )
    report = requires(hl.Scene(force=k * (x(t) - z), eom=[model]), method="taylor")
    assert next(i.why for i in report.kept if i.kind == "contact") == "may stick: friction"
    assert report.declined == "z is a coordinate of a model with friction, which may stick"


def test_pairs_that_cannot_meet():
    """Three balls over a table, each with a range of its own: no two of them can meet, and the middle one is felt."""

    heights = [hl.coordinate(f"h{i}", unit="m", initial=0.03, range=(0.0, 0.1)) for i in range(3)]
    balls = [Circle(0.01).at(x=0.05 * i, y=h, name=f"ball{i}") for i, h in enumerate(heights)]
    contacts = contacts_between([ground(), *balls], contact_law=hl.contact.penalty(k=k))
    L = sum(m * h.diff(t) ** 2 / 2 - m * g * h for h in heights) - k * (x(t) - heights[1]) ** 2 / 2
    scene = hl.Scene(force=k * (x(t) - heights[1]), eom=[hl.mechanics.lagrange(L, contacts=contacts)])
    report = requires(scene)
    assert [i.name for i in report.dropped if i.kind == "pair"] == ["ball0, ball1", "ball0, ball2", "ball1, ball2"]
    assert [i.name for i in report.kept if i.kind == "contact"] == ["ground_ball0", "ground_ball1", "ground_ball2"]
    why = "its declared range is used, and outside it the motor switches off"
    assert found(report, "h0").why == found(report, "h2").why == why
    assert any(note.startswith("F is nan where h") for note in report.program.notes)


def test_a_defined_coordinate_is_no_state():
    scene = hl.Scene(force=k * (x(t) - w), eom=[sp.Eq(w, 3 * z), sp.Eq(m * z.diff(t, 2), 3 * k * (x(t) - w))])
    assert found(requires(scene), "w").why == "another name of 3*z(t): no state of its own"


def test_a_contact_of_what_nobody_sees_is_left_out_with_it():
    a, b = hl.coordinate("a", unit="m"), hl.coordinate("b", unit="m", initial=0.1)
    m, k, K = hl.parameters("m k K", units="kg N/m N/m", values=(0.05, 500, 200))
    kinetic = m * (a.diff(hl.t) ** 2 + b.diff(hl.t) ** 2) / 2
    pull = K * (hl.x(hl.t) - a)
    model = hl.mechanics.lagrange(kinetic, forces={a: pull}, contacts=[hl.contact.Contact(b, hl.contact.penalty(k=k))])
    alone = hl.mechanics.lagrange(m * a.diff(hl.t) ** 2 / 2, forces={a: pull})
    both, one = (hl.compile(hl.Scene(pull, eom), T=1e-3, method="exact", live="") for eom in (model, alone))
    assert both.tick == one.tick
