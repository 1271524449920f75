"""Public checks of lab 04."""

from hapticlab.course.exercise import Case, Exercise, Lab

PLAIN = "That is Eq. (23.1), which does not look ahead."
WHOLE = "That is a whole sample ahead, 2 x(n) - x(n-1). Eq. (23.2) takes the mean of it and of x(n)."
BACK = "That looks half a sample back: the mean of the last two samples makes the staircase later, not earlier."
STRICT = "At x(n) = x_o the wall acts: >=, not >."
CLIPPED = (
    "The past was clipped at the boundary. It is a wall too (hl.wall calls it unilateral='clip'); "
    "asked for is the raw past, with "
    "zero only where x(n) < x_o."
)
ALWAYS = "It acts outside as well: zero where x(n) < x_o."
ONE_SHIFT = "Each sample is taken from x_o on: with 1.5 x(n) - 0.5 x(n-1) - 1.5 x_o the boundary moves."
FULL_WEIGHT = "The correction was added with its full weight. In Eq. (23.6) it stands within the bracket, behind k/2."
ADAMS = (
    "Those are the weights of Adams-Bashforth, 23/12, -16/12, 5/12: a parabola through three "
    "samples. Ellis corrects a straight line."
)
SUM_OF_TAPS = (
    "That sums the weights, which is what slow motion finds. At half the sampling rate the samples alternate: signs +, -, +."
)
ABSOLUTE = (
    "That sums the weights without their signs; a weight on x(n-1) meets a sample of the other sign, so c_1 counts as -c_1."
)
TWICE = "Twice too much: the damper's force b 2a/T acts along 2a, and that is 4 b a^2/T against 2 k a^2 h."
ADDED = "A virtual damper of either sign costs: Eq. (23.10) has |B|. A negative one feeds slow motion."
NEGATIVE_HELPS = "B < 0 was counted as if it helped: it takes away from what b gives, so it is b + b_added - |B| that is left."
NO_B = "Eq. (23.10) asks for K T/2 + |B|: the virtual damper has its share."
HALF = "K T/2 is to be paid: K = 2 (...)/T."
NEGATIVE = "Below zero there is no stiffness at all: return 0."
INSIDE_TOO = "B acts inside the wall as well. It is the whole point that it acts only where x(n) < x_o."
NOT_OUTSIDE = "Nothing acts outside: hl.when(condition, inside, outside) takes the virtual damper as its third argument."
TURNED_DAMPER = "The damper's sign is wrong: a damper's force on the environment is B v, and here B itself is negative."
ACCELERATION = "The sign is turned: F is on the environment, the handle feels -F."
SWAPPED = "These are the right two forces in the wrong order."
EULER = (
    "The handle moves on a parabola while the force is held: x + T v - (T^2/2m) F in one "
    "period, and the first force goes on "
    "moving it in the second."
)

LAB = Lab(
    number="04",
    title="Damping compensation",
    minutes=120,
    exercises=(
        Exercise(
            "prediction",
            kind="prediction",
            asks="what is left of the leak under Eq. (23.5) [% of the energy that came in]",
        ),
        Exercise(
            "half_sample_wall",
            kind="scene",
            points=2,
            asks="a Scene with k [N/m] and x_o [m]: Eq. (23.5) where x(n) >= x_o, else 0",
            cases=(
                Case(
                    {"x": [-1e-3, 1e-3, 3e-3, 5e-3, 2e-3, -1e-3], "values": {"k": 500.0, "x_o": 0.0}},
                    [0.0, 1.0, 2.0, 3.0, 0.25, 0.0],
                    unit="N",
                    slips=(
                        ((0.0, 0.5, 1.5, 2.5, 1.0, 0.0), PLAIN),
                        ((0.0, 1.5, 2.5, 3.5, -0.5, 0.0), WHOLE),
                        ((0.0, 0.0, 1.0, 2.0, 1.75, 0.0), BACK),
                        ((0.0, 0.75, 2.0, 3.0, 0.25, 0.0), CLIPPED),
                        ((0.0, 0.75, 2.0, 3.0, 0.25, -0.5), CLIPPED),
                        ((-0.5, 1.0, 2.0, 3.0, 0.25, -1.25), ALWAYS),
                    ),
                ),
                Case(
                    {"x": [-1e-3, 1e-3, -1e-3, 2e-3, 5e-3, 2e-3, -1e-3], "values": {"k": 500.0, "x_o": 1e-3}},
                    [0.0, 0.5, 0.0, 1.25, 2.75, -0.25, 0.0],
                    unit="N",
                    slips=(
                        ((0.0, 0.0, 0.0, 0.5, 2.0, 0.5, 0.0), PLAIN),
                        ((0.0, 0.25, 0.0, 1.0, 2.5, -0.5, 0.0), ONE_SHIFT),
                        ((0.0, 0.0, 0.0, 1.25, 2.75, -0.25, 0.0), STRICT),
                        ((0.0, 0.0, 0.0, 0.75, 2.75, -0.25, 0.0), CLIPPED),
                        ((0.0, 0.0, 0.0, 0.75, 2.75, -0.25, -0.25), CLIPPED),
                        ((0.0, 1.0, 0.0, 1.75, 3.25, 0.25, 0.0), "The spring is pressed by x - x_o, not by x."),
                    ),
                ),
            ),
            hint="How far beyond x_o is each sample that the law uses? Which sample decides whether the wall acts?",
            matters=("A look half a sample ahead removes nearly all of the leak of a bounce, without any change to the device."),
        ),
        Exercise(
            "ellis_wall",
            kind="scene",
            points=1,
            asks="a Scene with k [N/m] and x_o [m]: Eq. (23.6), both predictions inserted, where x(n) >= x_o, else 0",
            cases=(
                Case(
                    {"x": [-1e-3, 1e-3, 3e-3, 5e-3, 2e-3, -1e-3], "values": {"k": 500.0, "x_o": 0.0}},
                    [0.0, 1.5, 2.0, 3.0, -1.0, 0.0],
                    unit="N",
                    slips=(
                        ((0.0, 2.0, 2.0, 3.0, -2.25, 0.0), FULL_WEIGHT),
                        ((0.0, 1.4166666666666667, 2.0, 3.0, -0.79166666666666667, 0.0), ADAMS),
                        ((0.0, 1.0, 2.0, 3.0, 0.25, 0.0), "That is Eq. (23.5), without the correction."),
                    ),
                ),
                Case(
                    {"x": [0.0, 2e-3, 3e-3, 3e-3, 2.5e-3, 0.5e-3], "values": {"k": 1000.0, "x_o": 1e-3}},
                    [0.0, 3.0, 2.0, 1.5, 1.0, 0.0],
                    unit="N",
                    slips=(
                        ((0.0, 4.0, 3.0, 2.5, 2.0, 0.0), "The spring is pressed by x - x_o, not by x."),
                        ((0.0, 2.0, 2.5, 2.0, 1.25, 0.0), "That is Eq. (23.5), without the correction."),
                    ),
                ),
            ),
            hint="What does each hat stand for in samples you know? A handle at rest feels k x: what do the weights sum to?",
            matters=("A correction can improve a prediction, but its larger weights also amplify the steps of the encoder."),
        ),
        Exercise(
            "nyquist_damping",
            points=2,
            asks="the device damping [N s/m] that pays for samples that alternate, of taps c_0, c_1, ..., k [N/m], T [s]",
            cases=(
                Case({"taps": [1.0], "k": 200.0, "T": 1e-3}, 0.1, unit="N s/m", slips={0.2: TWICE}),
                Case(
                    {"taps": [1.5, -0.5], "k": 200.0, "T": 1e-3},
                    0.2,
                    unit="N s/m",
                    slips={0.1: SUM_OF_TAPS, 0.4: TWICE},
                ),
                Case(
                    {"taps": [2.0, -1.5, 0.5], "k": 300.0, "T": 2e-3},
                    1.2,
                    unit="N s/m",
                    slips={0.3: SUM_OF_TAPS, 2.4: TWICE},
                ),
                Case({"taps": [0.5, 0.5], "k": 200.0, "T": 1e-3}, 0.0, unit="N s/m", slips={0.1: ABSOLUTE, 0.2: TWICE}),
            ),
            hint="Which sign has each sample that the law sees? Does the damper take all that is given away in a period?",
            matters="A law that removes the leak of a slow bounce can still need much damping in the fastest motion.",
        ),
        Exercise(
            "stiffest_passive",
            points=1,
            asks="the largest passive stiffness [N/m] of Eq. (23.1), of b, b_added, B [N s/m], T [s]",
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
            hint="In Eq. (23.10) b is all the real damping there is. Is there a stiffness left?",
            matters=(
                "In this bound only real damping helps; a virtual damper of either sign lowers the largest passive stiffness."
            ),
        ),
        Exercise(
            "prediction_free_air",
            kind="prediction",
            asks="the stiffness up to which the wall chatters in no light hand, B in free air only [N/m]",
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
                        ((0.0, -0.16, 0.6, 0.96, 0.14, 0.08), "The spring is pressed by x - x_o, not by x."),
                        ((0.0, -0.16, -0.04, 0.36, 0.14, 0.08), STRICT),
                        ((0.0, -0.16, -0.04, 0.24, 0.14, 0.08), INSIDE_TOO),
                        ((0.0, 0.0, 0.0, 0.36, 0.0, 0.0), NOT_OUTSIDE),
                        (
                            (0.0, -0.08, 0.0, 0.36, 0.07, 0.04),
                            "The period is not always 1 ms: divide by hl.T, which is the period that the scene runs at.",
                        ),
                    ),
                ),
            ),
            hint="Which law acts where x(n) < x_o, and what is the velocity there, from the last two positions?",
            matters=("A virtual damper can help in one place and harm in another, so a rule about it must say where it acts."),
        ),
        Exercise(
            "deadbeat_forces",
            points=2,
            asks="the forces [F_0, F_1] [N] that take (x, v) to (x_goal, v_goal) in two periods T [s]; m in kg",
            cases=(
                Case(
                    {"m": 0.05, "T": 1e-3, "x": 0.0, "v": 0.1, "x_goal": 2e-4, "v_goal": 0.1},
                    [0.0, 0.0],
                    unit="N",
                ),
                Case(
                    {"m": 0.05, "T": 1e-3, "x": 5e-5, "v": 0.1, "x_goal": 2.45e-4, "v_goal": 0.094},
                    [0.1, 0.2],
                    unit="N",
                    slips=(
                        ((-0.1, -0.2), ACCELERATION),
                        ((0.2, 0.1), SWAPPED),
                        ((-0.05, 0.35), EULER),
                        ((0.25, 0.05), EULER),
                    ),
                ),
            ),
            rtol=1e-6,
            atol=1e-9,
            hint="What does each force do to the last velocity, what to the last position? Which has longer to work?",
            matters="Position and velocity are two numbers, so two held forces are the fewest that can set both.",
        ),
        Exercise(
            "which_law",
            kind="choice",
            points=1,
            asks="the law for an encoder, a period of delay and thirty different hands",
            options={
                "a": "model-based half sample",
                "b": "Ellis",
                "c": "damper and compensation, inside and outside",
                "d": "dead-beat",
            },
            cases=(
                Case(
                    {},
                    "a",
                    slips={
                        "b": "Ellis pays for the hold, and nobody pays for the period of delay: the second table of section 5. "
                        "And each count of the encoder is felt up to four times: section 6.",
                        "c": "Inside a plain wall the two dampers cancel in slow motion: section 7, "
                        "and the row `damped` of section 5.",
                        "d": "Its forces follow the position with m/T^2, so each count of the "
                        "encoder is a kick, and its model is of "
                        "one hand, not of thirty.",
                    },
                ),
            ),
            hint="What does each law need to know, and what does it do with what it does not know?",
            matters="No law is best in general. The sensor, the delay and the hands decide which law suits a device.",
        ),
        Exercise(
            "discussion",
            kind="text",
            least_words=60,
            asks="for which law, and where, the directive holds and why, and where a predictor errs",
        ),
    ),
)
