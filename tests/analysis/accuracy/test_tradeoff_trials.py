"""What all settings of a trade-off are tried on: delays, encoders, saturation, forces that never act or end too soon."""

import math

import numpy as np
import pytest
import sympy as sp
from trade_rows import asked

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.analysis.accuracy.handle_motions import HandleMotion
from hapticlab.analysis.accuracy.tradeoff_trials import sensor_floor
from hapticlab.errors import AnalysisError

SWING = HandleMotion("swing", 0.01 * sp.sin(20 * t) * (1 - sp.exp(-((t / 0.05) ** 2))), 0.5)
k, b = hl.parameters("k b", units="N/m N*s/m", values=(200, 0.4))
SPRING = hl.Scene(force=k * x(n), name="spring")


def paddle(**changes):
    return hl.SimulatedPaddle(**({"m": 0.05, "b": 0.3, "T": 1e-3} | changes))


def tradeoff(scene, device=None, **options):
    given = {"motions": [SWING], "targets": ["uno"], "T": [1e-3], "precision": ["float32"], "workers": 1, "progress": False}
    return hl.methods.tradeoff(scene, device or paddle(), **asked(**given | options))


def test_a_delay_of_the_paddle_asks_for_damping_and_moves_the_held_force():
    """A spring asks for k (T/2 + delay); held over T after a delay it lags by up to T + delay."""
    late = tradeoff(SPRING, paddle(delay=1e-3)).table[0]
    now = tradeoff(SPRING).table[0]
    assert (now.b_req, late.b_req) == (pytest.approx(0.1, rel=1e-6), pytest.approx(0.3, rel=1e-6))
    assert late.err_hold / now.err_hold == pytest.approx(2, rel=0.01)
    assert late.err_max == now.err_max


def test_a_delay_need_not_be_a_whole_number_of_the_steps_of_the_reference():
    errors = [tradeoff(SPRING, paddle(delay=d)).table[0].err_hold for d in (2.5e-4, 2.8e-4, 3.75e-4)]
    assert np.interp(2.8e-4, (2.5e-4, 3.75e-4), (errors[0], errors[2])) == pytest.approx(errors[1], rel=1e-3)


def test_an_encoder_of_a_scene_too_fast_for_rk4_is_measured_with_a_method_that_is_stable():
    """sqrt(K/m) T is 4.5, past the 2.8 of rk4: one count of 10 um is felt as some K counts, not as a blow-up."""
    z, (K, m, c) = hl.coordinate("z", unit="m"), hl.parameters("K m c", units="N/m kg N*s/m", values=(500, 1e-4, 0.01))
    F = K * (x(t) - z)
    scene = hl.Scene(force=F + k * x(t), eom=[sp.Eq(m * z.diff(t, 2), F - c * z.diff(t))], name="stiff")
    found = tradeoff(scene, paddle(counts_per_metre=1e5), T=[2e-3], methods=["rk4", "exact"], substeps=[1], holds=["zoh"])
    floor = sensor_floor(found.bench, (2e-3, "zoh")) * found.bench.peak
    assert 500 * 1e-5 < floor < 10 * 700 * 1e-5


def test_a_measured_velocity_is_not_a_difference_of_counts():
    scene = hl.Scene(force=k * x(n) + b * v(n))
    device = paddle(counts_per_metre=1e5)
    floors = [tradeoff(scene, device, velocity=kind).table[0].sensor_floor for kind in ("measured", "backward_difference")]
    peak = tradeoff(scene, device).bench.peak
    assert floors[0] == pytest.approx(200 * 1e-5 / peak, rel=0.02)  # k times a count
    assert floors[1] > 0.9 * (200 * 1e-5 + 0.4 * 1e-5 / 1e-3) / peak  # and b times a count a period


def test_a_force_that_is_never_felt_is_refused():
    wall = hl.wall()(k=500, x_o=0.2)
    with pytest.raises(AnalysisError, match="during swing the force is 0 N throughout or is not finite"):
        tradeoff(wall)


def test_what_is_above_the_paddles_greatest_force_is_told():
    told = tradeoff(SPRING, paddle(force_max=1.0)).summary()
    assert "the paddle gives at most 1 N" in told
    assert "at most:" not in tradeoff(SPRING, paddle(force_max=10.0)).summary()


def test_past_samples_are_present_ones_in_the_reference_and_it_says_so():
    late = tradeoff(hl.Scene(force=k * x(n - 3), name="late"))
    assert "the reference uses present values for past samples and delayed forces" in late.summary()
    # 3 T late: k v 3 T at most, of k A
    assert late.table[0].err_max == pytest.approx(20 * 3e-3, rel=0.02)
    assert "past samples" not in tradeoff(SPRING).summary()


def test_a_scene_that_faults_is_compared_up_to_there_and_says_so():
    """A root of d - x has no value once x passes d: at 20 t = asin(d/A), the onset being over."""
    d = hl.parameters("d", units="m", values=0.005)
    scene = hl.Scene(force=k * sp.sqrt(d) * sp.sqrt(d - x(n)), name="root")
    found = tradeoff(scene)
    (run,) = found.bench.runs
    assert run.faulted and not run.chaotic and float(SWING.at([run.horizon])[0][0]) <= 0.005
    assert float(SWING.at([run.horizon + run.step])[0][0]) > 0.005
    assert "the scene faults (force of the handle alone," in str(run)
    assert found.table[0].status == f"faulted after {run.horizon:.3g} s" and math.isfinite(found.table[0].err_max)
    assert "faulted after" in str(found.choose(passive=False, load=0.9))


def test_where_one_of_the_solvers_gives_up_no_error_is_certain_and_nothing_is_chosen():
    """z'' = (K (x - z) - ...)/m with a root that ends at z = c: the second solver cannot step up to it."""
    z, (K, m, c) = hl.coordinate("z", unit="m"), hl.parameters("K m c", units="N/m kg m", values=(100, 0.05, 0.006))
    F = K * (x(t) - z)
    pushed = F - b * z.diff(t) - K * c * sp.sqrt(1 - z / c)
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), pushed)], name="ends")(b=0.1)
    found = tradeoff(scene, methods=["rk4"], substeps=[1], holds=["soh"])
    assert "only one solver, so no error is certain" in found.summary()
    answer = found.choose(passive=False, load=2.0)
    assert not answer and "only one of the two solved it" in str(answer) and "inf" not in str(answer)


def test_what_a_cubic_spring_asks_for_is_that_of_its_steepest_place():
    """At x = 0 its stiffness is nothing, at the end of the paddle's travel 3 a x^2: b = 3 a x^2 T/2; so it is further out."""
    a = hl.parameters("a", units="N/m^3", values=1e6)
    scene = hl.Scene(force=a * x(n) ** 3, name="hardening")
    found = tradeoff(scene, paddle(b=4.0))
    row = found.table[0]
    assert row.b_req == pytest.approx(3e6 * 0.05**2 * 1e-3 / 2, rel=1e-6)
    assert "x = -0.05" in row.b_where and row.b_where in found.explain(row)
    wide = tradeoff(scene, motions=[SWING.scaled(8)])
    reach = np.abs(SWING.scaled(8).at(wide.bench.runs[0].t)[0]).max()
    assert wide.table[0].b_req == pytest.approx(3e6 * reach**2 * 1e-3 / 2, rel=1e-6)
    assert "small motions" in str(found.choose(tolerance=0.1, load=0.9))
