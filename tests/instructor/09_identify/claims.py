"""What lab 09 says of the paddle in use; see tests/labs/test_on_paddles.py."""

import numpy as np

import hapticlab as hl


def true_ratio(lab):
    return lab.paddle.b / lab.paddle.m


def integral_is_nearer(lab):
    """The student's own fit, which does not differentiate, is nearer the truth than the differentiated one."""
    own = lab.coast_fit(lab.t_coast, lab.x_coast)["b/m"]
    return abs(own - true_ratio(lab)) < 0.2 * abs(lab.twice[0] - true_ratio(lab))


def separates(lab):
    """The two accelerations differ by more than their intervals, and give mass and friction within 5 %."""
    found = lab.mass_and_friction(5 * lab.my_paddle.m, lab.rising, lab.falling)
    apart = lab.rising - lab.half_rising > lab.falling + lab.half_falling
    return apart and all(abs(found[name] / getattr(lab.paddle, name) - 1) < 0.05 for name in ("m", "coulomb"))


def missed(lab):
    """How many of the seven intervals miss the constant that was drawn."""
    delay = lab.paddle.delay + lab.paddle.sensor_delay
    true = [(lab.found[name], getattr(lab.paddle, name)) for name in ("m", "b", "coulomb")]
    true += [(lab.found["delay"], delay), *((lab.mine[name], getattr(lab.my_hand, name)) for name in ("m", "b", "k"))]
    return sum(value not in interval for interval, value in true)


def is_the_paddle(lab):
    """The file holds the encoder, the period and the force limit of the profile, and what was found in its intervals."""
    kept = all(getattr(lab.twin, name) == getattr(lab.my_paddle, name) for name in ("counts_per_metre", "force_max"))
    found = all(getattr(lab.paddle, name) in lab.twin[name] for name in ("m", "b", "coulomb"))
    return kept and found and abs(lab.twin.T - lab.my_paddle.T) < 1e-12 and not lab.twin.nominal


def is_predicted(lab):
    """The interval depends on the three constants of the handle, and contains the distance of the paddle that was drawn."""
    drawn = lab.my_paddle.at(m=lab.paddle.m, b=lab.paddle.b, coulomb=lab.paddle.coulomb)
    return set(lab.predicted.low_ends) == {"m", "b", "coulomb"} and lab.distance(drawn) in lab.predicted


def pays(lab):
    """The guarantee of the interval is less than that of the estimate, and true of the paddle that was drawn."""
    b = lab.found["b"]
    sure, guess = (lab.promised_stiffness(low, high, lab.paddle.T, 0.0) for low, high in ((b.low, b.high), (b.value, b.value)))
    true = hl.passivity_limit(hl.Device(b=lab.paddle.b, T=lab.paddle.T)).K
    return sure < guess and sure <= true * (1 + 1e-9)


def is_the_motor(lab):
    """From the readings alone: the torque constant of the motor that was drawn, to 2 %, and its dead band."""
    drive, motor = lab.drive, lab.motor
    true = lab.full * drive.jacobian * drive.resistance / drive.supply
    return abs(lab.k_t / true - 1) < 0.02 and 0.04 < motor["duty_dead"].value < 0.06 and 0 < lab.part < 1


CLAIMS = [
    ("the Jacobian $J$ of lab 00 give the torque constant", is_the_motor, ""),
    ("how much stiffness do the lags", lambda lab: 0 < lab.walls[0] <= lab.walls[1] * (1 + 1e-9), ""),
    (
        "because it *stops on the way*, at $v = 0$, where friction holds it",
        lambda lab: np.ptp(lab.coast.x[-20:]) <= 5 * lab.count,
        "",
    ),
    ("the integral of the noise is far smaller than the noise", integral_is_nearer, ""),
    ("so the two accelerations separate mass and friction", separates, ""),
    ("the residuals must look like sensor noise", lambda lab: lab.found.explained and lab.found.converged, ""),
    ("Now use the interval.", pays, ""),
    ("Is one OUTSIDE among seven a reason to distrust the method?", lambda lab: missed(lab) <= 1, ""),
    ("each interval of the hand contains the uncertainty of these", lambda lab: lab.mine.explained, ""),
    ("A *digital twin* keeps what you found", is_the_paddle, ""),
    ("If your measurement lies outside the interval", lambda lab: lab.inside, "OUTSIDE the interval"),
    ("and says which ends decide", is_predicted, ""),
]
