"""Measured impedances against closed forms, against the law read as H(z), and against a fine integration."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.device.board.settings import changed, simulated
from hapticlab.device.link.serial_ports import open_port
from hapticlab.measurement.impedance import measured_impedance
from hapticlab.measurement.impedance_signal import Signal
from hapticlab.measurement.signals import lines_of

pytest.importorskip("llvmlite")  # some ten thousand ticks
T, K, DELAY = 1e-3, 150.0, 3e-4
HAND = hl.Hand(m=0.02, b=1.0, k=200.0)
FREQUENCY = [3.0, 11.0, 51.0, 151.0]


def paddle(delay=DELAY, **changes):
    return hl.SimulatedPaddle(m=0.05, b=0.1, T=T, delay=delay, hand=HAND, **changes)


def held(s, delay=DELAY):
    return (1 - np.exp(-s * T)) / (s * T) * np.exp(-s * delay)


@pytest.mark.parametrize("how", ["multisine", "swept_sine"])
def test_a_plain_wall_is_a_held_spring(how):
    """Z = K (1 - e^-sT)/(sT) e^-s d / s: at low frequencies a damper of -K (T/2 + d) beside the spring."""
    found = measured_impedance(
        paddle(), hl.wall()(k=K), excitation=hl.measure.Excitation(how=how, frequency=FREQUENCY), dtype="float64"
    )
    s = 2j * np.pi * found.frequency
    assert found.frequency == pytest.approx(FREQUENCY)
    assert found.rendered == pytest.approx(K / s * held(s), rel=1e-10)
    assert found.law == pytest.approx(K / s * held(s), rel=1e-9)  # from a micrometre in float64
    assert found.damping[0] == pytest.approx(-K * (T / 2 + DELAY), rel=1e-3)
    assert found.ideal == pytest.approx(K / s) and abs(found.transparency[0]) == pytest.approx(1.0, abs=1e-4)
    assert found.coherence == pytest.approx(1.0, abs=1e-9) and found.left_wall == 0
    assert str(found.about) in str(found) and "4 frequencies" in repr(found)


@pytest.mark.parametrize(
    ("law", "taps"), [("backward_difference", (1.5, -0.5)), ("ellis", (2.0, -1.5, 0.5)), ("half_sample", None)]
)
def test_every_law_is_rendered_as_its_own_response(law, taps):
    found = measured_impedance(
        paddle(0.0), hl.wall(law)(k=K), excitation=hl.measure.Excitation(frequency=FREQUENCY), dtype="float64"
    )
    s = 2j * np.pi * found.frequency
    z = np.exp(-s * T)
    H = K * (1 + s * T / 2) if taps is None else K * sum(c * z**k for k, c in enumerate(taps))
    assert found.law == pytest.approx(H / s * held(s, 0.0), rel=1e-8)
    # the velocity at a sample has more of the images between samples than the position: 3 % at 151 Hz
    assert found.rendered == pytest.approx(found.law, rel=1e-8 if taps else 5e-2)
    if taps:
        named = hl.laws.LinearLaw.of(law, K=K, T=T).at(s.imag * T)
        assert H == pytest.approx(named, rel=1e-12)


def test_what_the_hand_feels_against_a_fine_integration():
    """The loop in plain NumPy, the handle known at 40 places in every period, the hand's force from its own equation."""
    from scipy.linalg import expm

    scene, fine, P, N = hl.wall()(k=K), 40, 6, 1000
    found = measured_impedance(
        paddle(0.0),
        scene,
        excitation=hl.measure.Excitation(frequency=FREQUENCY, seed=5),
        dtype="float64",
        averaging=hl.measure.Averaging(realizations=1, blocks=2, settle=4.0),
    )
    samples, lines = lines_of(FREQUENCY, T, 1.0)
    intent = Signal("multisine", lines, samples, T, 1e-3, 5).period
    M, b, k = 0.07, 1.1, 200.0
    # y = [x, v, F, intent, rate of intent]: expm of the whole, at every fortieth of a period
    A = np.zeros((5, 5))
    A[0, 1], A[1], A[3, 4] = 1.0, [-k / M, -b / M, -1 / M, k / M, 1.0 / M], 1.0
    maps = [expm(A * T * j / fine) for j in range(fine + 1)]
    rows = np.array([m[:1] for m in maps[:-1]])[:, 0]
    x, v, path = 0.0, 0.0, np.zeros((N, fine))
    for n in range(P * N):
        now, after = intent[n % N], intent[(n + 1) % N]
        y = np.array([x, v, K * x, now, (after - now) / T])
        path[n % N] = rows @ y
        x, v = (maps[-1] @ y)[:2]
    s = 2j * np.pi * lines / (N * T)
    X = 2 / (N * fine) * np.fft.rfft(path.ravel())[lines]
    goal = np.concatenate([intent, intent[:1]])
    line = np.interp(np.arange(N * 400) / 400, np.arange(N + 1), goal)  # its corners have a spectrum that falls slowly
    goes = 2 / line.size * np.fft.rfft(line)[lines]
    felt = (200 + s) * (goes - X) - 0.02 * s**2 * X
    assert found.handle == pytest.approx(felt / (s * X), rel=2e-6)  # images at forty times the rate
    assert found.felt == pytest.approx(found.handle - (0.05 * s + 0.1))
    # the rendered impedance by another way: without asking what the motor was told
    assert found.felt[:2] == pytest.approx(found.rendered[:2], rel=1e-5)


def test_a_hand_without_a_spring_holds_the_place_by_a_push():
    damper = hl.SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hl.Hand(b=3.0))
    found = measured_impedance(
        damper, hl.wall()(k=K), excitation=hl.measure.Excitation(frequency=FREQUENCY, amplitude=2e-4), dtype="float64", place=0.02
    )
    s = 2j * np.pi * found.frequency
    assert found.left_wall == 0 and found.rendered == pytest.approx(K / s * held(s, 0.0), rel=1e-9)


def test_the_device_is_in_the_way_at_the_handle():
    """m s + b beside k/s: 0.05 kg and 150 N/m cancel at 8.7 Hz, and the mass outweighs the wall above."""
    found = measured_impedance(
        paddle(0.0), hl.wall()(k=K), excitation=hl.measure.Excitation(frequency=[2.0, 9.0, 51.0]), dtype="float64"
    )
    s = 2j * np.pi * found.frequency
    assert found.transparency_at_handle == pytest.approx((0.05 * s + 0.1 + K / s * held(s, 0.0)) / (K / s), rel=1e-3)
    figure = found.plot()
    assert [axes.get_ylabel() for axes in figure.axes] == ["|Z| [N s/m]", "Re Z [N s/m]", "transparency [1]"]
    assert figure.axes[-1].get_xlabel() == "frequency [Hz]" and figure.axes[0].get_xscale() == "log"


def test_the_motor_drives_the_mechanics_and_the_scene_alike():
    found = measured_impedance(
        paddle(), hl.wall()(k=K, x_o=0.002), excitation=hl.measure.Excitation(drive="motor", frequency=FREQUENCY), dtype="float64"
    )
    s = 2j * np.pi * found.frequency
    assert found.rendered == pytest.approx(K / s * held(s), rel=1e-9)
    mechanics = 0.07 * s + 1.1 + 200 / s
    # sampled motion: what lies between the samples folds, as (f T)^2
    assert abs(found.mechanics / mechanics - 1) == pytest.approx(0.0, abs=2e-2)
    assert abs(found.mechanics / mechanics - 1)[:2] == pytest.approx(0.0, abs=2e-4)
    with pytest.raises(hl.errors.AnalysisError, match="no force sensor"):
        _ = found.handle


def test_an_encoder_is_seen_as_distortion_and_noise_as_uncertainty():
    plain = measured_impedance(paddle(0.0), hl.wall()(k=K), excitation=hl.measure.Excitation(frequency=FREQUENCY))
    coarse = measured_impedance(
        paddle(0.0, counts_per_metre=2e4), hl.wall()(k=K), excitation=hl.measure.Excitation(frequency=FREQUENCY)
    )
    noisy = measured_impedance(
        paddle(0.0, noise=2e-5),
        hl.wall()(k=K),
        excitation=hl.measure.Excitation(frequency=FREQUENCY),
        averaging=hl.measure.Averaging(blocks=6),
    )
    assert plain.distortion < 1e-6 < 1e-3 < coarse.distortion
    assert noisy.radius[0] > 1e3 * plain.radius[0] and noisy.coherence[-1] < 0.9999
    assert (abs(noisy.rendered - noisy.law) < 2 * noisy.radius).all()


def test_the_hand_feels_friction_that_the_motor_does_not_make():
    """A sinusoid feels Coulomb friction as a damper 4 f_c/(pi V), its describing function; the rendered force is as before."""
    sticky, tone = paddle(0.0, coulomb=0.02), hl.measure.Excitation(frequency=[5.0], amplitude=0.01)
    found = measured_impedance(sticky, hl.wall()(k=K), dtype="float64", excitation=tone, place=0.03)
    s = 2j * np.pi * found.frequency[0]
    assert found.rendered[0] == pytest.approx(K / s * held(s, 0.0), rel=1e-6)
    # the intent's sinusoid through hand and loop, friction as that damper: a fixed point in the speed
    speed = 0.1
    for _ in range(50):
        whole = 0.07 * s**2 + (1.1 + 4 * 0.02 / (np.pi * speed)) * s + 200 + K * held(s, 0.0)
        speed = abs(s * 0.01 * (200 + s) / whole)
    felt = found.felt[0] - found.rendered[0]
    assert felt.real == pytest.approx(4 * 0.02 / (np.pi * speed), rel=0.03)  # of the motion's own harmonics nothing


def test_a_motion_that_has_not_settled_is_told():
    """Without a hand b - K T/2 = 0.05 N s/m is left to 0.05 kg: after 2 s a seventh of the beginning is there still."""
    free = hl.SimulatedPaddle(m=0.05, b=0.1, T=T)
    early, late = (
        measured_impedance(
            free,
            hl.wall()(k=100.0),
            excitation=hl.measure.Excitation(frequency=[5.0, 51.0]),
            averaging=hl.measure.Averaging(settle=settle),
        )
        for settle in (2.0, 20.0)
    )
    assert "had not settled: give a longer Averaging(settle=" in str(early) and "not settled" not in str(late)
    assert late.mechanics[0] == pytest.approx((0.05 * 2j * np.pi * 5 + 0.1), rel=1e-2)


def test_a_handle_that_leaves_the_wall_is_reported():
    found = measured_impedance(paddle(), hl.wall()(k=K), place=0.0, excitation=hl.measure.Excitation(frequency=FREQUENCY))
    assert found.left_wall > 100 and "left the wall" in str(found)
    assert measured_impedance(paddle(), hl.wall()(k=K), excitation=hl.measure.Excitation(frequency=FREQUENCY)).left_wall == 0


def test_scenes_with_motion_of_their_own_have_an_ideal_in_continuous_time():
    z = hl.coordinate("z", unit="m")
    m, k, c = hl.parameters("m k c", units="kg N/m N*s/m", values=(0.1, 300.0, 2.0))
    F = hl.laws.virtual_coupler(z, K=k, b=c)
    scene = hl.Scene(F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)], name="mass")
    found = measured_impedance(
        paddle(0.0),
        scene,
        excitation=hl.measure.Excitation(frequency=[3.0, 11.0]),
        dtype="float64",
        averaging=hl.measure.Averaging(settle=4.0),
    )
    s = 2j * np.pi * found.frequency
    coupler = k.value / s + c.value
    assert found.ideal == pytest.approx(1 / (1 / coupler + 1 / (0.1 * s)), rel=1e-9)  # in series
    assert abs(found.transparency - 1).max() < 0.05
    assert found.rendered == pytest.approx(found.law, rel=1e-2)


def test_the_same_call_on_a_board():
    with hl.connect("sim://hapkit", paddle=paddle(0.0)) as board:
        found = measured_impedance(
            board,
            hl.wall()(k=K),
            excitation=hl.measure.Excitation(frequency=FREQUENCY),
            averaging=hl.measure.Averaging(realizations=1),
        )
    s = 2j * np.pi * found.frequency
    assert found.rendered == pytest.approx(K / s * held(s, 0.0), rel=1e-3)  # float32 and a sensor of 0.1 um
    assert abs(found.mechanics / (0.07 * s + 1.1 + 200 / s) - 1)[:2].max() < 1e-2
    assert "no force sensor" in found.about


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"how": "step"}, "needs one of multisine, swept_sine"),
        ({"drive": "foot"}, "needs 'hand' or 'motor'"),
        ({"frequency": [700.0]}, "half the sampling rate"),
    ],
)
def test_refusals(arguments, words):
    with pytest.raises(hl.errors.AnalysisError, match=words):
        measured_impedance(paddle(), hl.wall()(k=K), excitation=hl.measure.Excitation(**arguments))
    with pytest.raises(hl.errors.PaddleError, match="needs a simulated hand"):
        measured_impedance(hl.SimulatedPaddle(m=0.05, b=0.1, T=T), hl.wall()(k=K), excitation=hl.measure.Excitation(drive="hand"))


COUNTED = {"m": 0.03, "b": 0.6, "T": T, "counts_per_metre": 1 / 12.8e-6, "noise": 5e-6}
SHORT = {
    "excitation": hl.measure.Excitation(frequency=[5.0, 21.0]),
    "averaging": hl.measure.Averaging(period=0.5, settle=0.2, blocks=2, realizations=1),
}


def with_motor(stands, **changes):
    """Return a simulated board whose motor stands for so much force for long [N], and the list of its records."""
    paddle = hl.SimulatedPaddle(**{**COUNTED, **changes})
    port, kept = open_port("sim://hapkit"), simulated(paddle)
    kept = changed(kept, force_continuous=stands)
    port.put_on(paddle, settings=kept, store=kept.to_bytes())
    board, logs = hl.devices.SerialPaddle("sim://hapkit", port=port), []
    board.home(at=0.0)
    run = board.run

    def recorded(*given, **options):
        logs.append(run(*given, **options))
        return logs[-1]

    board.run = recorded
    return board, logs


@pytest.mark.parametrize("stiffness", [150.0, 500.0, 1000.0])
@pytest.mark.always("500.0")
def test_a_board_is_moved_gently_whatever_the_wall(stiffness):
    """Stable below 2 b/T = 1200 N/m. The motor stands for 2 N: it holds 5 mm, or K depth = 1 N, and is led there."""
    board, logs = with_motor(2.0)
    with board:
        found = measured_impedance(board, hl.wall()(k=stiffness), **SHORT)
    pull = min(stiffness * 0.005, 1.0)
    assert max(abs(log.F).max() for log in logs) < 0.1 + max(0.5 * pull, 0.2)
    # twice three counts of backward difference beside 0.1 N at its quickest
    assert max(abs(log.v).max() for log in logs) < 0.2
    assert max(log.x.max() for log in logs) < pull / stiffness + 1.5e-3
    s = 2j * np.pi * found.frequency
    assert found.left_wall == 0 and found.rendered == pytest.approx(stiffness / s * held(s, 0.0), rel=1e-3)
    assert abs(logs[-1].F[0]) < 0.01  # it rises


def test_a_wall_that_chatters_on_a_board_is_cut_and_told():
    """Unstable above 2 b/T = 200 N/m: force below its hold and twice the amplitude, and the call is named."""
    board, logs = with_motor(2.0, b=0.1)
    with board:
        with pytest.raises(hl.errors.PaddleError, match="hl.measure.impedance: the .*softer wall"):
            measured_impedance(board, hl.wall()(k=900), **SHORT)
        assert board.state()["state"] == 0 and board.state()["force"] == 0
    assert max(abs(log.F).max() for log in logs) <= 1.2 + 1e-6
    pulled, logs = with_motor(2.0, hand=hl.Hand(push=0.9))  # 45 mm of the 20 N/m that lead it
    with (
        pulled,
        pytest.raises(hl.errors.PaddleError, match="hl.measure.impedance: the handle was moved towards 2 mm but is at 381 mm."),
    ):
        measured_impedance(pulled, hl.wall()(k=100), place=0.002, **SHORT)
    assert abs(logs[-1].F).max() == pytest.approx(0.2 + 2 * 0.1)
    limits = hl.measure.Safety(speed_max=0.06, force_max=5.0)
    with (
        hl.connect("sim://hapkit", paddle=hl.SimulatedPaddle(**COUNTED | {"b": 0.1})) as slow,
        pytest.raises(hl.errors.PaddleError, match="hl.measure.impedance: the motor was switched off after .*speed_max="),
    ):
        measured_impedance(slow, hl.wall()(k=900), place=0.003, safety=limits, **SHORT)


def test_a_board_refuses_more_than_its_motor_stands_and_an_interrupt_leaves_it_off(monkeypatch):
    board, logs = with_motor(2.0)
    with board:
        with pytest.raises(
            hl.errors.PaddleError, match="2.5 N to hold the position and 0.1 N to shake the handle are.* more than the 2 N"
        ):
            measured_impedance(board, hl.wall()(k=500), place=0.005, **SHORT)
        assert not logs  # before anything moves
        patch = "hapticlab.device.board.serial_paddle.SerialPaddle._collect"
        monkeypatch.setattr(patch, lambda *given: (_ for _ in ()).throw(KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            measured_impedance(board, hl.wall()(k=150), **SHORT)
        assert board.state()["state"] == 0 and board.state()["force"] == 0


@pytest.mark.parametrize(
    ("record", "wrong"),
    [
        *((hl.measure.Averaging, {name: 0}) for name in ("realizations", "blocks", "period")),
        *((hl.measure.Averaging, wrong) for wrong in ({"blocks": 1.5}, {"settle": -1})),
        *((hl.measure.Excitation, wrong) for wrong in ({"amplitude": 0}, {"amplitude": -1.0})),
        *((hl.measure.Safety, wrong) for wrong in ({"reach": 0}, {"speed_max": "fast"})),
    ],
)  # fmt: skip
def test_a_number_that_measures_nothing_is_named(record, wrong):
    (name,) = wrong
    with pytest.raises(hl.errors.AnalysisError, match=f"{name} = "):
        record(**wrong)


@pytest.mark.parametrize("wrong", [{"place": float("nan")}, {"excitation": hl.measure.Excitation(frequency=[])}])
def test_a_place_and_frequencies_that_are_none_are_named(wrong):
    with pytest.raises(hl.errors.AnalysisError, match="place = |frequency = "):
        measured_impedance(paddle(), hl.wall()(k=K), **wrong)
