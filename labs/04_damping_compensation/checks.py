"""Public checks of lab 04."""

from hapticlab.course.exercise import Case, Exercise, Lab

TURNED = "The sign is wrong: the handle feels -F, so to push along the motion F must be negative where v(n) > 0."
TURNED_DRY = "The sign of the dry part is wrong: both parts push along the motion."
ONE_SIDED = "Your dry part is right for v(n) > speed only. Below -speed the sign s is -1."
NO_ZONE = "Your sign has two values. Between -speed and speed it must be 0, or one count switches the motor."
SMOOTH = "That is a smooth sign, v/sqrt(v^2 + speed^2). Here s is +1, 0 or -1: use hl.when twice."
DAMPING_ALONE = "That is viscous friction alone, m v0/b. Keep the dry friction in the denominator b v + f_c."
DRY_FRICTION_ALONE = "That is dry friction alone, m v0^2/(2 f_c). Keep the damping in the denominator b v + f_c."
A_TIME = "That is the time until the handle rests. Integrate dx, not dt: there is one more factor v."
ADDED_LOGARITHM = "The two terms have opposite signs: v/(b v + f_c) = 1/b - (f_c/b)/(b v + f_c)."
LOG_10 = "That is the logarithm to the base 10. The integral of 1/x is the natural logarithm, np.log."
FIRST_BRAKING = "That keeps the braking force of the first instant. The viscous part falls with the speed."
CENTRE_LOST = (
    "You forgot to return from the centre of the half swing to the target: the handle turns at g/k + r (A + g/k) from it."
)
FROM_THE_TARGET = "Your half swing keeps r of A. It keeps r of the distance from the centre, A + g/k."
ONE_PUSH = "That is where g moves the centre of the swing, after a single half swing without damping. Which A repeats itself?"
UPSIDE_DOWN = "Numerator and denominator are swapped: if hardly anything is lost (r near 1), the amplitude is large."
DOUBLED = "You added 2 g/k in each half swing. The centre is g/k ahead of the target: A = g/k + r (A + g/k)."
EXCESS = "That is how much more than 1 is needed. Return the whole fraction, dry."
AT_ONE = "At 1 nothing is left over, so no swing can be as large as f_c/k, and the handle sticks. How much must be left over?"
ONE_OVER_R = "That balances one half swing that starts at g/k. Use the amplitude that repeats itself."
UPPER_END = "You used the upper ends. A device with less friction than that would be over-compensated."
INVERTED = "You divided the estimate by an end of its interval. The law multiplies its fraction by the estimate."
HALF_WAY = "That is half way between the lower end and the estimate; the friction may be smaller than that."
IN_NEWTONS = "Those are the lower ends themselves. Return fractions of the estimates."
ADDED = "A virtual damper of either sign lowers the limit: Eq. (23.10) has |B|. A negative one generates energy in slow motion."
NEGATIVE_HELPS = "You counted B < 0 as a help. It uses up a share of the damping, so b + b_added - |B| is left."
NO_B = "Eq. (23.10) requires K T/2 + |B|, so subtract the share of the virtual damper as well."
HALF = "The damping must cover K T/2, so K = 2 (...)/T."
NEGATIVE = "Below zero no stiffness is passive: return 0."
STRICT = "The wall also acts at x(n) = x_o: use >=, not >."
NO_BOUNDARY = "The spring is compressed by x - x_o, not by x."
INSIDE_TOO = "B also acts inside the wall. Here it must act only where x(n) < x_o."
NOT_OUTSIDE = "Nothing acts outside the wall: hl.when(condition, inside, outside) takes the virtual damper as its third argument."
TURNED_DAMPER = "The sign of the damper is wrong: its force on the environment is B v, and here B itself is negative."
LAWS_SWAPPED = "The two laws are swapped: hl.when(condition, inside, outside) takes the law for x(n) >= x_o first."
LATE_VELOCITY = "The velocity is one sample late: use the displacement that ends at x(n), x(n) - x(n-1)."
NOT_ALWAYS_1_MS = "The period is not always 1 ms: divide by hl.T, the period at which the scene runs."

LAB = Lab(
    number="04",
    title="Damping compensation",
    minutes=120,
    exercises=(
        Exercise("prediction_factor", kind="prediction", asks="by what factor the compensated handle coasts farther"),
        Exercise("prediction_over", kind="prediction", asks="what happens at 150 % of the dry friction"),
        Exercise("prediction_free_air", kind="prediction", asks="how many of 100 N/m remain"),
        Exercise(
            "compensating",
            kind="scene",
            points=1,
            asks="a Scene with viscous, dry [1], b [N s/m], f_c [N], speed [m/s]: F of both fractions, s = 0 within speed",
            cases=(
                Case(
                    {
                        "x": [0.0, 1e-4, 1.02e-4, 1e-4, 0.0, 0.0],
                        "T": 1e-3,
                        "values": {"viscous": 0.8, "dry": 0.5, "b": 0.1, "f_c": 0.05, "speed": 0.005},
                    },
                    [0.0, -0.033, -0.00016, 0.00016, 0.033, 0.0],
                    unit="N",
                    slips=(
                        ((0.0, 0.033, 0.00016, -0.00016, -0.033, 0.0), TURNED),
                        ((0.0, 0.017, -0.00016, 0.00016, -0.017, 0.0), TURNED_DRY),
                        ((0.0, -0.033, -0.00016, 0.00016, -0.017, 0.0), ONE_SIDED),
                        ((0.0, -0.033, -0.00016, 0.00016, 0.008, 0.0), ONE_SIDED),
                        ((0.025, -0.033, 0.02484, 0.02516, 0.033, 0.025), NO_ZONE),
                        ((-0.025, -0.033, -0.02516, -0.02484, 0.033, -0.025), NO_ZONE),
                        ((0.0, -0.032968808472, -0.009444766909, 0.009444766909, 0.032968808472, 0.0), SMOOTH),
                    ),
                ),
                Case(
                    {
                        "x": [0.0, 2e-5, 5e-4, 3e-4, 2.9e-4],
                        "T": 5e-4,
                        "values": {"viscous": 0.5, "dry": 1.2, "b": 0.3, "f_c": 0.02, "speed": 0.05},
                    },
                    [0.0, -0.006, -0.168, 0.084, 0.003],
                    unit="N",
                    slips=(
                        ((0.0, 0.006, 0.168, -0.084, -0.003), TURNED),
                        ((0.0, -0.006, -0.12, 0.036, 0.003), TURNED_DRY),
                        ((0.0, -0.006, -0.168, 0.036, 0.003), ONE_SIDED),
                        ((0.0, -0.006, -0.168, 0.06, 0.003), ONE_SIDED),
                        ((0.024, 0.018, -0.168, 0.084, 0.027), NO_ZONE),
                        ((-0.024, -0.03, -0.168, 0.084, -0.021), NO_ZONE),
                        ((0.0, -0.020992681141, -0.167967513995, 0.083814669041, 0.011913376232), SMOOTH),
                    ),
                ),
            ),
            hint="In which direction must the motor push while v(n) > 0? Which of the two frictions depends on the speed?",
            matters="The same line runs on every board, but it acts on a measured velocity, which is late and moves in counts.",
        ),
        Exercise(
            "coast",
            points=2,
            asks="the distance [m] from v0 [m/s] to rest; m [kg], b [N s/m], coulomb [N]",
            cases=(
                Case(
                    {"v0": 0.3, "m": 0.05, "b": 0.25, "coulomb": 0.05},
                    0.02334837072503379,
                    unit="m",
                    slips={
                        0.06: DAMPING_ALONE,
                        0.045: DRY_FRICTION_ALONE,
                        0.18325814637483104: A_TIME,
                        0.0966516292749662: ADDED_LOGARITHM,
                        0.0440823996531185: LOG_10,
                        0.018: FIRST_BRAKING,
                        -0.02334837072503379: "The distance is positive: the speed falls from v0 to 0, so dv < 0.",
                    },
                ),
                Case(
                    {"v0": 0.2, "m": 0.03, "b": 0.1, "coulomb": 0.02},
                    0.01841116916640329,
                    unit="m",
                    slips={
                        0.06: DAMPING_ALONE,
                        0.03: DRY_FRICTION_ALONE,
                        0.2079441541679836: A_TIME,
                        0.10158883083359671: ADDED_LOGARITHM,
                        0.04193820026016113: LOG_10,
                        0.015: FIRST_BRAKING,
                    },
                ),
                Case({"v0": 0.1, "m": 0.05, "b": 0.1, "coulomb": 0.0}, 0.05, unit="m"),
            ),
            rtol=1e-5,
            hint="What is the integral of 1/(b v + f_c)? What remains of your formula if f_c = 0?",
            matters="If all friction falls by one factor, every coast grows by it. That is how far a compensation is felt.",
        ),
        Exercise(
            "cycle_amplitude",
            points=2,
            asks="the amplitude [m] that repeats itself, from g [N], k [N/m] and the fraction kept in half a swing",
            cases=(
                Case(
                    {"g": 0.02, "k": 20.0, "kept": 0.8},
                    0.009,
                    unit="m",
                    slips={
                        0.004: CENTRE_LOST,
                        0.005: FROM_THE_TARGET,
                        0.001: ONE_PUSH,
                        0.00011111111111111109: UPSIDE_DOWN,
                        0.01: DOUBLED,
                    },
                ),
                Case(
                    {"g": 0.03, "k": 100.0, "kept": 0.9},
                    0.0057,
                    unit="m",
                    slips={
                        0.0027: CENTRE_LOST,
                        0.003: FROM_THE_TARGET,
                        0.0003: ONE_PUSH,
                        1.5789473684210522e-05: UPSIDE_DOWN,
                        0.006: DOUBLED,
                    },
                ),
            ),
            hint="How far from the centre does the handle start? On which side of the target is the centre at the next turn?",
            matters="An amplitude exists only because the damping dissipates more in a larger swing.",
        ),
        Exercise(
            "onset",
            points=1,
            asks="the fraction of the dry friction above which the handle keeps moving, from the fraction kept in half a swing",
            cases=(
                Case(
                    {"kept": 0.8},
                    1.1111111111111112,
                    unit="1",
                    slips={0.11111111111111108: EXCESS, 1.0: AT_ONE, 1.25: ONE_OVER_R},
                ),
                Case(
                    {"kept": 0.5},
                    1.3333333333333333,
                    unit="1",
                    slips={0.3333333333333333: EXCESS, 1.0: AT_ONE, 2.0: ONE_OVER_R},
                ),
            ),
            hint="Which force holds the handle at a turn, and which one pulls? Which amplitude makes them equal?",
            matters="In a hand a little more than all of the dry friction may be compensated; a free handle has no such margin.",
        ),
        Exercise(
            "safe_fractions",
            points=1,
            asks='{"viscous", "dry"} [1]: the largest fractions of the estimates that no device within the intervals exceeds',
            cases=(
                Case(
                    {"b": 0.2, "b_low": 0.18, "b_high": 0.24, "coulomb": 0.05, "coulomb_low": 0.04, "coulomb_high": 0.06},
                    {"viscous": 0.9, "dry": 0.8},
                    unit="1",
                    slips=(
                        ({"viscous": 1.2, "dry": 1.2}, UPPER_END),
                        ({"viscous": 1.1111111111111112, "dry": 1.25}, INVERTED),
                        ({"viscous": 0.8333333333333334, "dry": 0.8333333333333334}, INVERTED),
                        ({"viscous": 0.18, "dry": 0.04}, IN_NEWTONS),
                        ({"viscous": 0.95, "dry": 0.9}, HALF_WAY),
                        (
                            {"viscous": 0.75, "dry": 0.6666666666666667},
                            "You divided by the upper ends. The law multiplies the estimates.",
                        ),
                        ({"viscous": 1.0, "dry": 1.0}, "All of an estimate is too much for a device at the lower end."),
                    ),
                ),
            ),
            hint="For which device within the intervals is a given force of the motor most likely to be too much?",
            matters="A guarantee uses the end of an interval that is worst for it; an estimate is too high as often as too low.",
        ),
        Exercise(
            "stiffest_passive",
            points=1,
            asks="the largest passive stiffness [N/m] of Eq. (23.1), from b, b_added, B [N s/m], T [s]",
            cases=(
                Case(
                    {"b": 0.1, "b_added": 0.25, "B": -0.15, "T": 1e-3},
                    400.0,
                    unit="N/m",
                    slips={1000.0: NEGATIVE_HELPS, 700.0: NO_B, 200.0: HALF},
                ),
                Case(
                    {"b": 0.1, "b_added": 0.25, "B": 0.05, "T": 1e-3},
                    600.0,
                    unit="N/m",
                    slips={800.0: ADDED, 700.0: NO_B, 300.0: HALF},
                ),
                Case({"b": 0.1, "b_added": 0.0, "B": -0.2, "T": 1e-3}, 0.0, unit="N/m", slips={-200.0: NEGATIVE}),
            ),
            hint="Which dampers are real, and therefore part of b in Eq. (23.10)? Can the result become negative?",
            matters=(
                "In this bound only real damping helps; a virtual damper of either sign lowers the largest passive stiffness."
            ),
        ),
        Exercise(
            "free_air_wall",
            kind="scene",
            points=1,
            asks="a Scene with k [N/m], x_o [m], B [N s/m]: Eq. (23.1) where x(n) >= x_o, else B times the velocity",
            cases=(
                Case(
                    {
                        "x": [-1e-3, -4e-4, 0.0, 1e-3, 6e-4, -2e-4, -5e-4],
                        "T": 1e-3,
                        "values": {"k": 500.0, "x_o": 0.0, "B": -0.25},
                    },
                    [0.0, -0.15, 0.0, 0.5, 0.3, 0.2, 0.075],
                    unit="N",
                    slips=(
                        ((0.0, -0.15, -0.1, 0.25, 0.4, 0.2, 0.075), INSIDE_TOO),
                        ((0.0, 0.0, 0.0, 0.5, 0.3, 0.0, 0.0), NOT_OUTSIDE),
                        ((0.0, 0.15, 0.0, 0.5, 0.3, -0.2, -0.075), TURNED_DAMPER),
                        ((-0.5, -0.2, -0.1, -0.25, 0.1, -0.1, -0.25), LAWS_SWAPPED),
                        ((0.0, 0.0, 0.0, 0.5, 0.3, 0.1, 0.2), LATE_VELOCITY),
                    ),
                ),
                Case(
                    {
                        "x": [0.0, 8e-4, 1e-3, 1.6e-3, 9e-4, 5e-4],
                        "T": 5e-4,
                        "values": {"k": 600.0, "x_o": 1e-3, "B": -0.1},
                    },
                    [0.0, -0.16, 0.0, 0.36, 0.14, 0.08],
                    unit="N",
                    slips=(
                        ((0.0, -0.16, 0.6, 0.96, 0.14, 0.08), NO_BOUNDARY),
                        ((0.0, -0.16, -0.04, 0.36, 0.14, 0.08), STRICT),
                        ((0.0, -0.16, -0.04, 0.24, 0.14, 0.08), INSIDE_TOO),
                        ((0.0, 0.0, 0.0, 0.36, 0.0, 0.0), NOT_OUTSIDE),
                        ((0.0, -0.08, 0.0, 0.36, 0.07, 0.04), NOT_ALWAYS_1_MS),
                        ((-0.6, -0.12, -0.04, -0.12, -0.06, -0.3), LAWS_SWAPPED),
                        ((0.0, 0.0, 0.0, 0.36, -0.12, 0.14), LATE_VELOCITY),
                    ),
                ),
            ),
            hint="Which law acts where x(n) < x_o? How do you get the velocity at sample n from the last two positions?",
            matters="A virtual damper can help in one place and harm in another, so a rule about it must say where it acts.",
        ),
        Exercise(
            "which_design",
            kind="choice",
            points=1,
            asks="the design that is passive for every hand and moves as freely as possible in free air",
            options={
                "a": "80 % of the lower ends, everywhere",
                "b": "80 % of the lower ends, in free air only",
                "c": "100 % of the upper ends, in free air only",
                "d": "no compensation",
            },
            cases=(
                Case(
                    {},
                    "b",
                    slips={
                        "a": "Eq. (23.10): with b = 0.30 and |B| = 0.24 N s/m only 120 N/m are passive everywhere.",
                        "c": "Most handles within the intervals have less friction than the upper ends, so they run away.",
                        "d": "That wall is passive, but the handle could safely coast farther. Where may a compensation act?",
                    },
                ),
            ),
            hint="Which b must the guarantee assume? Which of the designs leave enough of it for 400 N/m?",
            matters="An interval, a place to act and a margin are a design; a single fraction is not.",
        ),
        Exercise(
            "discussion",
            kind="text",
            least_words=60,
            asks="your frictions with intervals, what you compensate and where, what happens at and below the lower end, and why",
        ),
    ),
)
