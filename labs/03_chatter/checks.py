"""Public checks of lab 03."""

from hapticlab.course.exercise import Case, Exercise, Lab

ONE_PERIOD = "That counts the hold as a delay of a whole period. On average, a force that is held for T is late by T/2."
HOLD_ALONE = "That leaves out the computational delay, which is added to the half period of the hold."
NO_HOLD = "That leaves out the hold, which adds half a period to the computational delay."
TAKEN_TWICE = (
    "The condition k tau <= b gives the limit b/tau. The factor 2 in 2b/T comes from tau = T/2, so do not apply it again."
)
DETERMINANT = "That is the determinant, |z|^2 of the two complex eigenvalues. The amplitude grows by its square root."
NO_HALF = (
    "You left out the term - k T^2/(2 m) x of the position. The handle moves on a parabola while the force is "
    "constant, so the force changes x within the same period."
)
FIRST_ORDER = "That is the first order in T^2. The parabola is exact, and so is the factor, which contains a square root."
TRACE = "That is half the trace, the real part of the eigenvalues. Their magnitude is the square root of the determinant."
EULER = (
    "That belongs to x(n+1) = x(n) + T v(n+1), a method that conserves energy. The handle itself moves on a "
    "parabola while the force is held, and gains energy."
)
OFF_ZERO = "You found no crossing, because x oscillates about 2 mm, not about zero. Subtract the mean first."
NO_GAIN = "The sign is wrong: k T/2 > b here, so the hold generates k T/2 - b more than the dampers dissipate."
BOTH_WAYS = "That is twice the frequency: you counted upward and downward crossings, but a cycle has only one upward crossing."
PER_TIME = (
    "You divided by the whole time, which contains a part of a cycle at each end. Count whole cycles, from the "
    "first crossing to the last."
)
NO_PI = "A factor pi is missing. It comes from the integral of cos^2 over a cycle: the hold generates pi w X^2 (k T/2 - b)."
ONE_QUARTER = "Friction acts over the whole distance of a cycle, 4 X, not over X. The integral also contributes a factor pi."
HALF_WAY = "In a cycle of amplitude X the handle moves 4 X, not 2 X: from one end to the other and back."
WHOLE_T = "The hold is a damper of -k T/2. It is late by half a period, not by a whole period."
NO_DAMPER = "You left out the damping b, which dissipates a part of what the hold generates. The remainder is k T/2 - b."
SUM = (
    "You added the two limits. The damper does not pay for the leak of the encoder, and friction does not pay "
    "for that of the hold. Each must pay for its own leak, so the smaller limit applies."
)
ENCODER_ALONE = (
    "That is the limit from friction. The damper must also pay for the hold, so the smaller of the two limits applies."
)
HOLD_ONLY = "That is the limit from the damper. Friction must also pay for the encoder, so the smaller of the two limits applies."
HALF_COUNT = "That is half as large as expected: over one count, there and back, friction dissipates 2 f_c Delta."

DELAYS = {"x": [0.0, 0.5e-3, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3], "x_unit": "s", "y_unit": "N/m"}
WHOLE_PERIOD = DELAYS | {"y": [1100.0, 733.333333, 550.0, 440.0, 366.666667, 314.285714, 275.0]}
SLOW_PERIOD = DELAYS | {"y": [250.0, 200.0, 166.666667, 142.857143, 125.0, 111.111111, 100.0]}
#: beginning at half a millisecond: without the hold there is no limit at delay 0
LATER = {"x": DELAYS["x"][1:], "x_unit": "s", "y_unit": "N/m"}

LAB = Lab(
    number="03",
    title="Chatter",
    minutes=110,
    exercises=(
        Exercise("prediction", kind="prediction", asks="the stiffness [N/m] above which the wall chatters in a pinching hand"),
        Exercise(
            "stability_estimate",
            points=1,
            asks="the largest stable stiffness [N/m] to first order, of damping b [N s/m], period T [s] and delay [s]",
            cases=(
                Case(
                    {"b": 1.1, "T": 1e-3, "delay": 0.0},
                    2200.0,
                    unit="N/m",
                    slips={1100.0: ONE_PERIOD, 4400.0: TAKEN_TWICE},
                ),
                Case(
                    {"b": 0.5, "T": 2e-3, "delay": 0.5e-3},
                    333.3333333333333,
                    unit="N/m",
                    slips={200.0: ONE_PERIOD, 500.0: HOLD_ALONE, 666.6666666666666: TAKEN_TWICE, 1000.0: NO_HOLD},
                ),
            ),
            hint="How late is the force in total? How does a late spring change the damping of the loop?",
            matters="Sampling and computation both make the force late, so a faster loop allows a stiffer wall.",
        ),
        Exercise(
            "limit_over_delay",
            kind="plot",
            points=1,
            asks="a function of b [N s/m] and T [s] that returns a figure: the limit in N/m over delays from 0 to 3 ms",
            rtol=0.02,
            cases=(
                Case(
                    {"b": 1.1, "T": 1e-3},
                    {"curve 1": DELAYS | {"y": [2200.0, 1100.0, 733.333333, 550.0, 440.0, 366.666667, 314.285714]}},
                    slips=(
                        ({"curve 1": WHOLE_PERIOD}, ONE_PERIOD),
                        ({"curve 1": DELAYS | {"y": [4400.0, 2200.0, 1466.66667, 1100.0, 880.0, 733.3, 628.6]}}, TAKEN_TWICE),
                        ({"curve 1": DELAYS | {"y": [2200.0] * 7}}, HOLD_ALONE),
                        ({"curve 1": LATER | {"y": [2200.0, 1100.0, 733.333333, 550.0, 440.0, 366.666667]}}, NO_HOLD),
                    ),
                ),
                Case(
                    {"b": 0.5, "T": 2e-3},
                    {"curve 1": DELAYS | {"y": [500.0, 333.333333, 250.0, 200.0, 166.666667, 142.857143, 125.0]}},
                    slips=(
                        ({"curve 1": SLOW_PERIOD}, ONE_PERIOD),
                        ({"curve 1": DELAYS | {"y": [1000.0, 666.666667, 500.0, 400.0, 333.333, 285.714, 250.0]}}, TAKEN_TWICE),
                        ({"curve 1": DELAYS | {"y": [500.0] * 7}}, HOLD_ALONE),
                        ({"curve 1": LATER | {"y": [1000.0, 500.0, 333.333333, 250.0, 200.0, 166.666667]}}, NO_HOLD),
                    ),
                ),
            ),
            hint="Is there one line through many points? Do both labels end in the unit of their numbers, such as [ms]?",
            matters="The curve shows how much stiffness each millisecond of delay costs.",
        ),
        Exercise(
            "growth_per_sample",
            points=1,
            asks="the factor by which the amplitude grows in one sample, of m [kg], k [N/m], T [s], without damping",
            cases=(
                Case(
                    {"m": 0.05, "k": 1000.0, "T": 5e-3},
                    1.118033988749895,
                    slips={1.25: DETERMINANT, 1.125: FIRST_ORDER, 1.224744871391589: NO_HALF, 0.875: TRACE, 1.0: EULER},
                ),
                Case(
                    {"m": 0.03, "k": 3000.0, "T": 2e-3},
                    1.0954451150103321,
                    slips={1.2: DETERMINANT, 1.1: FIRST_ORDER, 1.1832159566199232: NO_HALF, 0.9: TRACE, 1.0: EULER},
                ),
            ),
            rtol=1e-7,
            hint=(
                "Which matrix gives (x, v) at the next sample? What does its determinant tell you about two complex eigenvalues?"
            ),
            matters="Without damping every sampled wall chatters, however soft the wall and however fast the computer.",
        ),
        Exercise(
            "late_wall",
            kind="scene",
            points=1,
            asks="a Scene with k [N/m] and x_o [m]: Eq. (23.1) with x(n-1) in place of x(n)",
            cases=(
                Case(
                    {"x": [-1e-3, 1e-3, 3e-3, 5e-3, 2e-3, -1e-3], "values": {"k": 500.0, "x_o": 1e-3}},
                    [0.0, 0.0, 0.0, 1.0, 2.0, 0.5],
                    unit="N",
                    slips=(
                        ((0.0, 0.0, 1.0, 2.0, 0.5, 0.0), "That is the wall without delay. Replace x(n) by x(n-1) everywhere."),
                        (
                            (0.0, -1.0, 0.0, 1.0, 2.0, 0.0),
                            (
                                "Your condition still uses x(n). A late wall does not know yet whether the handle "
                                "is inside at sample n."
                            ),
                        ),
                        (
                            (0.0, 0.0, 1.0, 2.0, 0.5, -1.0),
                            "Your condition is late, but your spring is not. Use x(n-1) in both.",
                        ),
                        ((0.0, 0.0, 0.0, -1.0, -2.0, -0.5), "The sign is wrong: `force` is F_e, the force ON the environment."),
                        (
                            (0.0, 0.0, 0.5, 1.5, 2.5, 1.0),
                            ("The spring begins at the boundary, so the penetration depth is x(n-1) - x_o."),
                        ),
                    ),
                ),
            ),
            hint="Which samples can the condition and the spring use if x(n) is not known yet?",
            matters="A slow computer or a filter delays the force in the same way, so you can try their effect in one line.",
        ),
        Exercise(
            "chatter_frequency",
            points=2,
            asks="the frequency [Hz] of the oscillation in x [m] over t [s]",
            cases=(
                Case(
                    {
                        "t": [0.0, 0.005, 0.01, 0.015, 0.02, 0.025, 0.03, 0.035, 0.04, 0.045, 0.05, 0.055]
                        + [0.06, 0.065, 0.07, 0.075, 0.08, 0.085, 0.09, 0.095, 0.1, 0.105, 0.11, 0.115],
                        "x": [2.5e-3, 3.5e-3, 3.5e-3, 2.5e-3, 1.5e-3, 0.5e-3, 0.5e-3, 1.5e-3] * 3,
                    },
                    25.0,
                    unit="Hz",
                    slips={
                        0.0: OFF_ZERO,
                        50.0: BOTH_WAYS,
                        17.391304347826086: PER_TIME,
                        16.666666666666668: PER_TIME,
                        26.08695652173913: PER_TIME,
                        43.47826086956522: BOTH_WAYS,
                    },
                ),
            ),
            rtol=0.02,
            hint=(
                "Between which samples does x rise through its mean? How many cycles lie between the first and the last crossing?"
            ),
            matters="The frequency helps you to find the cause, because no hand can deliberately oscillate at tens of hertz.",
        ),
        Exercise(
            "threshold_speed",
            points=2,
            asks="the speed amplitude [m/s] above which an oscillation grows, of k [N/m], b [N s/m], T [s], f_c [N]",
            cases=(
                Case(
                    {"k": 4000.0, "b": 1.1, "T": 1e-3, "f_c": 0.03},
                    0.042441318157838762,
                    unit="m/s",
                    slips={
                        -0.042441318157838762: NO_GAIN,
                        0.13333333333333333: NO_PI,
                        0.033333333333333333: ONE_QUARTER,
                        0.02122065907891938: HALF_WAY,
                        0.013171443566225821: WHOLE_T,
                        0.01909859317102744: NO_DAMPER,
                    },
                ),
                Case(
                    {"k": 6000.0, "b": 0.5, "T": 1e-3, "f_c": 0.05},
                    0.025464790894703253,
                    unit="m/s",
                    slips={
                        -0.025464790894703253: NO_GAIN,
                        0.08: NO_PI,
                        0.02: ONE_QUARTER,
                        0.012732395447351627: HALF_WAY,
                        0.011574904952137845: WHOLE_T,
                        0.02122065907891938: NO_DAMPER,
                    },
                ),
            ),
            hint="How far does the handle move in a whole cycle? What is the integral of its squared speed over this cycle?",
            matters="Dry friction can hide an unstable wall. Whether the wall chatters then depends on how you touch it.",
        ),
        Exercise(
            "quantised_limit",
            points=1,
            asks="the largest passive stiffness [N/m], of b [N s/m], T [s], f_c [N] and the resolution, one count [m]",
            cases=(
                Case(
                    {"b": 0.1, "T": 1e-3, "f_c": 0.1, "resolution": 0.742e-3},
                    200.0,
                    unit="N/m",
                    slips={269.54177897574124: ENCODER_ALONE, 469.54177897574124: SUM, 134.77088948787062: HALF_COUNT},
                ),
                Case(
                    {"b": 0.1, "T": 1e-3, "f_c": 0.05, "resolution": 0.742e-3},
                    134.77088948787062,
                    unit="N/m",
                    slips={200.0: HOLD_ONLY, 334.77088948787062: SUM, 67.38544474393531: HALF_COUNT},
                ),
            ),
            hint="Which leak does the damper pay for, and which leak does friction pay for? Which of the two limits is smaller?",
            matters="The hold and the encoder are two separate causes of chatter, and each needs a remedy of its own.",
        ),
        Exercise(
            "culprit",
            kind="choice",
            points=1,
            asks="what drives the oscillation in the report",
            options={"a": "the hold", "b": "a delay", "c": "the encoder", "d": "tremor"},
            cases=(
                Case(
                    {},
                    "c",
                    slips={
                        "a": (
                            "Below the stability limit the damping pays for the hold, and half the stiffness or twice the "
                            "rate halves the leak. The oscillation remained."
                        ),
                        "b": (
                            "A delay drives an oscillation that grows until the handle leaves the wall, and that "
                            "decays on a softer wall. In this report the handle never leaves the wall, and the "
                            "oscillation remained."
                        ),
                        "d": (
                            "The frequency falls from 29 Hz to 16 Hz when the wall is softer, so it depends on the "
                            "wall. A tremor keeps its own frequency, 8 to 12 Hz."
                        ),
                    },
                ),
            ),
            hint="What does the sensed position do? Which changes did not stop the oscillation?",
            matters=(
                "A remedy for the wrong cause changes nothing. A recording can separate the causes before you change the device."
            ),
        ),
        Exercise("discussion", kind="text", least_words=60, asks="what you would double, why, and why not the others"),
    ),
)
