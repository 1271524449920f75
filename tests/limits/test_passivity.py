"""Passivity limits against Colgate's closed forms and against the energy of whole motions, which knows no frequency."""

import math

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError, PaddleError
from hapticlab.limits.passivity import passivity_limit, required_damping
from hapticlab.scene.laws.taps import TAPS

b, T = 0.13, 0.7e-3

# b/(K T) for d = 0, 1, 2, 3 periods of delay, derived by hand from Eq. (23.10)'s general form
REQUIRED = {
    "zoh": (1 / 2, 3 / 2, 5 / 2, 7 / 2),
    "backward_difference": (1, 5 / 4, 2, 3),
    "ellis": (2, 1.5281529477, 2, 3),
}


@pytest.mark.parametrize("law", REQUIRED)
@pytest.mark.parametrize("periods", range(4))
def test_whole_delays_match_the_closed_forms(law, periods):
    limit = passivity_limit(hl.Device(b=b, T=T, delay=periods * T), law=law)
    tolerance = 1e-10 if (law, periods) == ("ellis", 1) else 1e-13  # that closed form is known to 11 digits
    assert limit.K * T / b == pytest.approx(1 / REQUIRED[law][periods], rel=tolerance)
    assert required_damping(K=limit.K, T=T, delay=periods * T, law=law) == pytest.approx(b, rel=1e-12)


def test_worst_frequencies():
    assert passivity_limit(hl.Device(b=b, T=T)).frequency is None  # every frequency alike
    nyquist = 1 / (2 * T)
    assert passivity_limit(hl.Device(b=b, T=T), law="ellis").frequency == pytest.approx(nyquist, rel=1e-7)
    assert passivity_limit(hl.Device(b=b, T=T, delay=T), law="backward_difference").frequency == pytest.approx(
        nyquist / 3, rel=1e-6
    )
    assert passivity_limit(hl.Device(b=b, T=T, delay=T), law="ellis").frequency == pytest.approx(0.53432 * nyquist, rel=1e-4)


@pytest.mark.parametrize("B", [0.3, -0.3, 0.06, -0.11, 0.129])
def test_virtual_damper_of_either_sign(B):
    B = B if abs(B) < b else B * b
    assert passivity_limit(hl.Device(b=b, T=T), B=B).K == pytest.approx(2 * (b - abs(B)) / T, rel=1e-12)  # Eq. (23.10)
    # backward_difference is zoh with KT/2 more virtual damping: |B + KT/2| + KT/2 = b
    assert passivity_limit(hl.Device(b=b, T=T), B=B, law="backward_difference").K == pytest.approx((b - B) / T, rel=1e-12)
    if B > 0:
        assert passivity_limit(hl.Device(b=b, T=T), B=B, law="ellis").K == pytest.approx((b - B) / (2 * T), rel=1e-12)


def energy_form(K, B, law, delay, periods):
    """The energy of every periodic motion x, as a matrix over its positions at the samples and at the force's changes.

    Built from work = force times displacement, period by period; nothing of the frequency domain enters.
    """
    whole, f = int(delay // T), delay / T - delay // T
    at, change = np.eye(2 * periods)[:periods], np.eye(2 * periods)[periods:]  # row n: the position as a linear form

    def past(form, n):
        return np.roll(form, n, axis=0)

    force = sum(K * c * past(at, i) for i, c in enumerate(TAPS[law])) + B / T * (at - past(at, 1))
    first, second = change - at, past(at, -1) - change
    Q = b / T * (first.T @ first / f + second.T @ second / (1 - f))
    Q += past(force, whole + 1).T @ first + past(force, whole).T @ second
    return (Q + Q.T) / 2


@pytest.mark.parametrize("law", REQUIRED)
@pytest.mark.parametrize("delay", [0.2, 0.5, 1.35])
@pytest.mark.parametrize("B", [0.0, 0.4, -0.5])
@pytest.mark.always("*-0.2-zoh", "*-0.5-ellis", "*-1.35-backward_difference")
def test_fractional_delay_is_where_some_motion_first_yields_energy(law, delay, B):
    K = passivity_limit(hl.Device(b=b, T=T, delay=delay * T), B=B * b, law=law).K
    assert K > 0
    least = [np.linalg.eigvalsh(energy_form(K * s, B * b, law, delay * T, 120))[0] * T / b for s in (0.999, 1.02)]
    assert least[0] > -1e-11  # a rigid shift costs nothing, so the least eigenvalue of a passive wall is zero
    assert least[1] < -1e-6


def test_fraction_joins_whole_delays_without_a_jump():
    for law in REQUIRED:
        whole = passivity_limit(hl.Device(b=b, T=T, delay=T), law=law).K
        for near in (1 - 1e-7, 1 + 1e-7):
            assert passivity_limit(hl.Device(b=b, T=T, delay=near * T), law=law).K == pytest.approx(whole, rel=1e-5)


@pytest.mark.parametrize("delay", [0.0, 0.3, 1.0, 2.6])
@pytest.mark.parametrize("law", REQUIRED)
def test_required_damping_is_the_inverse(law, delay):
    need = required_damping(K=410.0, T=T, B=0.02, delay=delay * T, law=law)
    assert passivity_limit(hl.Device(b=need, T=T, delay=delay * T), B=0.02, law=law).K == pytest.approx(410.0, rel=1e-10)


def test_required_damping_at_the_edges():
    assert required_damping(K=0, T=T) == 0.0
    assert required_damping(K=0, T=T, B=-0.2) == pytest.approx(0.2, rel=1e-12)
    assert required_damping(K=100, T=T, law="half_sample") == math.inf


def test_zero_limits_say_why():
    exact_velocity = passivity_limit(hl.Device(b=b, T=T), law="half_sample")
    assert exact_velocity.K == 0 and "velocity" in exact_velocity.reason
    for B in (0.2, -0.2):
        damper = passivity_limit(hl.Device(b=b, T=T), B=B)
        assert damper.K == 0 and "even without the spring" in damper.reason and "0.13 N s/m" in damper.reason
    assert "passivity" in damper.kind
    undamped = passivity_limit(hl.Device(b=0, T=T))
    assert undamped.K == 0 and "nothing dissipates the energy that the hold generates" in undamped.reason
    assert not any("unilateral" in note for limit in (exact_velocity, undamped) for note in limit.assumptions)


def test_a_limit_at_rest_is_said_in_words():
    assert "worst for slow motion" in str(passivity_limit(hl.Device(b=b, T=T, delay=T / 2)))


@pytest.mark.parametrize(
    "change, words",
    [
        ({"b": -0.1}, "b = -0.1 N s/m"),
        ({"b": math.nan}, "b = nan N s/m"),
        ({"T": 0}, "T = 0 s; a device needs T > 0"),
        ({"T": math.inf}, "T = inf s"),
        ({"B": math.nan}, "B = nan N s/m"),
        ({"delay": -1e-3}, "delay = -0.001 s; a device needs delay >= 0: a force cannot come before its sample"),
        ({"delay": 1.0}, "at most 200 periods"),
        ({"law": "foh"}, f"law = 'foh'; needs one of {', '.join(TAPS)}"),
        (
            {"b": "thick"},
            "b = 'thick'; a device needs b >= 0: its damping dissipates the energy that the hold generates. "
            "Give a number in N s/m",
        ),
    ],
)
def test_bad_arguments_are_named_with_value_and_unit(change, words):
    device, rest = {"b": b, "T": T, **change}, {name: change[name] for name in ("B", "law") if name in change}
    with pytest.raises((AnalysisError, PaddleError)) as error:
        passivity_limit(hl.Device(**{name: value for name, value in device.items() if name not in rest}), **rest)
    assert words in str(error.value)


def test_a_misspelt_keyword_does_not_pass():
    with pytest.raises(TypeError, match="dellay"):
        passivity_limit(hl.Device(b=b, T=T), dellay=1e-3)


def test_negative_stiffness_is_refused():
    with pytest.raises(
        AnalysisError, match="K = -50 N/m; a wall needs K >= 0. A negative spring pushes the handle away and is not passive"
    ):
        required_damping(K=-50, T=T)
