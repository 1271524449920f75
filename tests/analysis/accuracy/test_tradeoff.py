"""A trade-off beside independent runs, its choices on tables made by hand, and what it says."""

import csv
import math
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from trade_rows import asked
from trade_rows import one_row as row

import hapticlab as hl
from hapticlab.analysis.accuracy.handle_motions import HandleMotion, handle_motions
from hapticlab.analysis.accuracy.tradeoff import tradeoff
from hapticlab.analysis.accuracy.tradeoff_choice import Asked, chosen
from hapticlab.analysis.accuracy.tradeoff_rows import Table
from hapticlab.errors import AnalysisError, ProgramError

SPRING = hl.Scene(force=hl.parameters("k", units="N/m", values=150) * hl.x(hl.n), name="spring")
ASKED = Asked(1e-2, 0.5, True)


def choose(rows, asked=ASKED, target="uno"):
    return chosen(rows, target, asked, lambda row: {"method": row.method})


def test_the_least_load_that_is_good_enough_is_chosen():
    rows = [row(load=0.4), row(method="rk4", load=0.2), row(method="heun", load=0.1, err_max=0.02), row(load=0.05, target="pc")]
    assert choose(rows).options == {"method": "rk4"}


@pytest.mark.parametrize(
    ("bad", "word"),
    [
        ({"err_max": 0.023}, "tolerance 2.3 % instead of 1 %"),
        ({"load": 0.62}, "load 62 % instead of 50 %"),
        ({"margin": 1.5}, "margin 1.5 instead of 2"),
        ({"steps_per_contact": 5.0}, "contacts that last 2 times as long"),
        ({"b_req": 0.4}, "a device with b >= 0.4 N s/m (this one has 0.3 N s/m)"),
        ({"status": "does not fit", "why": "needs 900 bytes of memory; uno has 848", "load": 0.4}, "needs 900 bytes"),
    ],
)
def test_each_thing_asked_for_is_kept_and_named_where_it_is_missed(bad, word):
    answer = choose([row(**bad), row(status="unstable at t=0.1 s", why="wild", err_max=math.nan)])
    assert not answer and word in str(answer)
    assert choose([row(**bad), row(method="rk4", load=0.49)]).row.method == "rk4"


def test_what_is_scaled_by_the_factor_that_is_named_is_passive():
    """A linear scene whose stiffness, damping and mass all are s times as large asks for s times the damping."""
    z, (K, b, m) = hl.coordinate("z", unit="m"), hl.parameters("K b m", units="N/m N*s/m kg")
    F = K * (hl.x(hl.t) - z) + b * (hl.v(hl.t) - z.diff(hl.t))
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)])
    asked = hl.passivity.port_damping(hl.Device(T=1e-3), scene(K=500, b=0.1, m=0.05))
    s = 0.3 / asked
    assert hl.passivity.port_damping(hl.Device(T=1e-3), scene(K=500 * s, b=0.1 * s, m=0.05 * s)) == pytest.approx(0.3, rel=1e-6)


def test_no_sensor_is_worth_more_than_half_its_own_error():
    rows = [row(err_max=0.004, sensor_floor=0.02, load=0.1), row(err_max=1e-4, sensor_floor=0.02, load=0.4)]
    answer = choose(rows, Asked(1e-3, 0.5, True))
    assert answer.row is rows[0] and answer.tolerance == 0.01
    assert "tolerance raised from 0.1 % to 1 %" in str(answer)


def test_a_reference_that_is_not_certain_counts_as_error():
    assert not choose([row(err_max=0.008, doubt=0.003)])
    assert choose([row(err_max=0.008, doubt=0.001)])


def test_another_board_is_named_where_it_would_do():
    words = str(choose([row(load=0.9), row(target="pico", load=0.07)]))
    assert "another board: pico needs 7 % of the period with verlet," in words


def test_where_several_things_are_missed_the_nearest_names_all_of_them():
    rows = [row(load=0.9, err_max=0.02), row(load=5.0, err_max=0.02)]
    answer = choose(rows)
    assert answer.nearest is rows[0]
    assert "all of these together" in str(answer) and "load 90 %" in str(answer) and "tolerance 2 %" in str(answer)


# ---------------------------------------------------------------- the whole, on one scene


@pytest.fixture(scope="module")
def found():
    paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, counts_per_metre=1 / 12.8e-6)
    return tradeoff(
        hl.library.mass_spring_damper(),
        paddle,
        tried=hl.methods.Tried(
            methods=["semi_implicit_euler", "rk4", "exact"], T=[2e-3, 1e-3], holds=["zoh", "soh"], substeps=[1, 2]
        ),
        targets=["pc", "uno"],
        conditions=hl.methods.Conditions(motions=handle_motions()[1:3]),
        workers=1,
        progress=False,
    )


def test_its_errors_are_those_of_an_independent_solver(found):
    """The held error of rk4 with zoh, against scipy's solution of the same equations on the same motion."""
    scipy = pytest.importorskip("scipy.integrate")
    motion = handle_motions()[1]
    K, b, b_c, k, m = (found.bench.scene.values[name] for name in ("K", "b", "b_c", "k", "m"))

    handle = sp.lambdify(hl.t, [motion.x, motion.x.diff(hl.t)], "math")

    def force(time, z, w):
        x, v = handle(time)
        return K * (x - z) + b_c * (v - w)

    times = np.arange(round(motion.duration / 2e-3)) * 2e-3
    solved = scipy.solve_ivp(
        lambda time, y: [y[1], (force(time, *y) - b * y[1] - k * y[0]) / m], (0, times[-1]), [0, 0], "DOP853", times,
        rtol=1e-10, atol=1e-12,
    )  # fmt: skip
    true = np.array([force(*state) for state in zip(times, *solved.y, strict=True)])
    program = hl.compile(found.bench.scene, "rk4", T=2e-3, hold="zoh")
    F = hl.compiler.engines.engine.load(program, "interpreter").run(len(times), motion.at(times)[0][:, None]).outputs[:, 0, 0]
    alone = tradeoff(
        found.bench.scene,
        hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3),
        tried=hl.methods.Tried(methods=["rk4"], T=[2e-3], holds=["zoh"], substeps=[1], precision=["float32"]),
        targets=["pc"],
        conditions=hl.methods.Conditions(motions=[motion]),
        workers=1,
        progress=False,
    )
    assert alone.table[0].err_max == pytest.approx(np.abs(F - true).max() / alone.bench.peak, rel=1e-6)


def test_every_setting_is_a_row_and_those_that_did_not_run_say_why(found):
    assert len(found.table) == 3 * 2 * 2 * 2 * 3  # methods, T, substeps, holds; float32 on both targets, float64 on the pc
    assert all(r.why for r in found.table if r.status != "ok")


def test_where_every_method_is_refused_the_reason_is_the_answer():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3)
    none = tradeoff(
        hl.library.stick_slip(),
        paddle,
        tried=hl.methods.Tried(methods=["rk4", "heun"], T=[1e-3]),
        targets=["uno"],
        workers=1,
        progress=False,
        conditions=hl.methods.Conditions(motions=[HandleMotion("slow", 0.001 * hl.t, 0.05)]),
    )
    assert {r.status for r in none.table} == {"refused"}
    answer = none.choose()
    assert not answer and answer.nearest is None and "friction needs events located" in str(answer)


def test_more_substeps_are_left_out_where_the_hold_makes_the_error(found):
    by = {(r.method, r.hold, r.substeps): r for r in found.table.where(T=2e-3, target="uno")}
    assert by["rk4", "zoh", 2].status == "not tried" and "hold='zoh' alone" in by["rk4", "zoh", 2].why
    assert "exact with substeps=1 has an error of" in by["semi_implicit_euler", "soh", 2].why


def test_what_compiles_to_the_same_instructions_is_the_same_row():
    """Semi-implicit Euler looks at the handle at the start of a step alone, where zoh and foh are one."""
    both = tradeoff(
        hl.library.mass_spring_damper(),
        hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3),
        tried=hl.methods.Tried(
            methods=["semi_implicit_euler"], T=[1e-3], substeps=[1], holds=["foh", "zoh"], precision=["float32"]
        ),
        conditions=hl.methods.Conditions(motions=handle_motions()[1:2]),
        workers=1,
        progress=False,
    )
    for target in both.targets:
        foh, zoh = both.table.where(target=target)
        given = {"hold": "zoh", "order_claimed": None, "sensor_floor": 0.0}  # nan without an encoder
        assert replace(foh, **given) == replace(zoh, **given)
        assert foh.ran and foh.seconds > 0 and foh.b_req is not None


def test_predicted_cycles_are_those_of_the_cost_model_and_load_is_their_share(found):
    for one in found.table.where(target="uno", method="rk4", substeps=1):
        taken = hl.compiler.boards.cost.cost(hl.compile(found.bench.scene, **found.bench.options(one)), every=10)
        assert (one.cycles, one.load) == (taken.typical, pytest.approx(taken.share))
        assert (one.status == "does not fit") == (not taken.fits)


def test_passivity_is_that_of_the_tick_map(found):
    for one in filter(lambda one: one.ran, found.table.where(target="uno", substeps=1, T=1e-3)):
        options = {name: getattr(one, name) for name in ("method", "hold")}
        assert one.b_req == pytest.approx(hl.passivity.port_damping(hl.Device(T=1e-3), found.bench.scene, **options), rel=1e-6)


def test_the_choice_compiles_and_holds(found):
    choice = found.choose(target="uno", tolerance=0.01, load=0.75)
    row = choice.row
    assert row.err_max <= 0.01 and row.load <= 0.75 and row.passive
    program = hl.compile(found.bench.scene, **choice.options)
    assert (program.T, program.facts["method"]) == (row.T, row.method)
    assert str(choice) in found.summary(load=0.75) and "hl.compile(scene, method=" in str(choice)


def test_the_front_falls_in_error_and_none_beats_it(found):
    front = found.front("uno")
    assert all(a.load < b.load and a.err_max > b.err_max for a, b in zip(front, front[1:], strict=False))
    for one in found.table.where(target="uno", status="ok"):
        assert any(f.load <= one.load and f.err_max <= one.err_max for f in front)


def test_a_measurement_takes_the_place_of_a_prediction(found):
    one = found.table.where(target="uno", method="rk4", status="ok")[0]
    changed = found.measured(one, 1.05 * one.cycles)
    new = next(r for r in changed.table if r.measured)
    assert new.measured == 1.05 * one.cycles and new.load == pytest.approx(one.load + 0.05 * one.cycles / 16e6 / one.T)
    assert "measured" in changed.explain(new) and "1.050 of the prediction" in changed.explain(new)
    with pytest.raises(AnalysisError, match="is not a row of this trade-off"):
        changed.measured(replace(one, T=3e-3), 1.0)


def test_it_explains_where_an_error_comes_from(found):
    by = {(r.method, r.hold, r.T): r for r in found.table.where(target="uno", substeps=1)}
    assert "exact methods have 6.9 % with hold='zoh', and with hold='soh' 0.0" in found.explain(by["rk4", "zoh", 2e-3])
    assert "of that; the rest comes from the steps of the method" in found.explain(by["semi_implicit_euler", "soh", 2e-3])
    assert "the error of the encoder alone" in found.explain(by["exact", "soh", 1e-3])


def test_it_prints_draws_and_writes_its_table(found, tmp_path):
    text = str(found.table)
    assert len(text.splitlines()) == len(found.table) + 1 and "err max" in text
    with open(found.table.to_csv(tmp_path / "rows.csv"), newline="") as file:
        rows = list(csv.DictReader(file))
    assert float(rows[0]["err_max"]) == found.table[0].err_max and len(rows) == len(found.table)
    assert found.plot("uno").get_suptitle() == f"{found.name}: error against load, on uno"
    pc, uno = found.plot().axes
    assert (pc.get_xscale(), pc.get_yscale(), uno.get_title()) == ("log", "log", "on uno")
    for axes in (pc, uno):  # no decade is empty, but for the one in which what is asked for lies
        loads, errors = np.concatenate([line.get_xydata() for line in axes.lines if line.get_marker() in tuple("s^o")]).T
        for (low, high), many in ((axes.get_xlim(), loads), (axes.get_ylim(), errors)):
            assert many.min() / 30 < low < many.min() and many.max() < high < 30 * many.max()
    dashed = [line.get_ydata()[0] for line in uno.lines if line.get_linestyle() == "--" and len(set(line.get_ydata())) == 1]
    assert 100 * found.table[0].sensor_floor == pytest.approx(max(dashed), rel=0.5)


def test_a_force_of_the_samples_alone_has_one_setting_a_period():
    wall = tradeoff(
        SPRING,
        hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3),
        targets=["uno"],
        tried=hl.methods.Tried(T=[1e-3, 5e-4], precision=["float32"]),
        workers=1,
        progress=False,
    )
    assert [one.T for one in wall.table] == [1e-3, 5e-4]
    assert all(one.err_max < 1e-6 for one in wall.table)  # rounding of float32
    assert wall.table[0].b_req == pytest.approx(150 * 1e-3 / 2, rel=1e-6)


@pytest.mark.parametrize(
    ("given", "word"),
    [
        ({"targets": ["arduino"]}, "target = 'arduino'; needs one of pc, uno"),
        ({"T": [1e-3, math.pi / 3000]}, "no common divisor of 1e-05 s or more;"),
        ({"holds": "zoh"}, r"holds=\['zoh'\]"),
        ({"holds": []}, "needs a sequence of at least one"),
        ({"precision": ["float16"]}, "precision = 'float16'"),
        ({"methods": ["rk5"]}, "method = 'rk5'; needs one of euler"),
        ({"tolerance": 0}, "tolerance = 0; needs a number > 0"),
        ({"tolerance": math.nan}, "tolerance = nan; needs a number > 0"),
        ({"motions": [0.01]}, r"motions = \[0.01\]; needs one HandleMotion"),
        ({"motions": HandleMotion("blink", 0.001 * hl.t, 1e-3)}, "blink lasts 0.001 s; needs at least two periods,"),
        ({"workers": "two"}, "workers = 'two'; needs a whole number"),
    ],
)
def test_what_cannot_be_asked_for_is_refused(given, word):
    with pytest.raises((AnalysisError, ProgramError), match=word):
        tradeoff(SPRING, hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3), progress=False, **asked(**given))


def test_a_paddle_and_every_value_are_needed():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3)
    with pytest.raises(AnalysisError, match="paddle = 'uno'; needs a SimulatedPaddle"):
        tradeoff(SPRING, "uno", progress=False)
    k, c = hl.parameters("k c", units="N/m N*s/m")
    with pytest.raises(AnalysisError, match=r"no value for c, k; bind them: scene\(c=..., k=...\).* --set c=... --set k=..."):
        tradeoff(hl.Scene(force=k * hl.x(hl.n) + c * hl.v(hl.n), name="damped"), paddle, progress=False)


def test_one_of_a_thing_is_enough_and_the_front_is_short():
    slow = HandleMotion("slow", 0.002 * hl.t, 0.1)
    wall = tradeoff(
        SPRING,
        hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3),
        targets="uno",
        tried=hl.methods.Tried(T=1e-3),
        conditions=hl.methods.Conditions(motions=slow),
        workers=map,
        progress=False,
    )
    (one,) = wall.table
    lines = wall.front("uno").brief().splitlines()
    assert lines[1].startswith("none needed") and "rk4" not in lines[1] and one.name == "T = 1 ms, float32"
    everything = Table([row(method="semi_implicit_euler_damped", force_at="after", sensor_floor=1e-9), one])
    assert max(map(len, everything.brief().splitlines())) < 120
    with pytest.raises(AnalysisError, match=r"row = 0; needs a row, such as found.explain\(found.table\[0\]\)"):
        wall.explain(0)
    with pytest.raises(ProgramError, match="target = 'foo'; needs one of uno"):
        wall.plot("foo")


def test_of_measured_times_that_are_the_same_the_error_decides():
    close = [row(target="pc", cycles=None, load=load, err_max=e) for load, e in ((1e-4, 9e-3), (1.1e-4, 4e-3), (1.3e-4, 1e-3))]
    assert choose(close, target="pc").row is close[1]
    assert choose([row(load=0.1, err_max=9e-3), row(load=0.11, err_max=4e-3)]).row.load == 0.1  # cycles are no measurement


@pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="needs processes that can be copied")
@pytest.mark.wide
def test_two_workers_find_the_same_as_one():
    scene, paddle = hl.library.detents(), hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3)
    one, two = (tradeoff(scene, paddle, targets=["uno"], workers=n, progress=False).table for n in (1, 2))
    assert repr(one) == repr(two)
