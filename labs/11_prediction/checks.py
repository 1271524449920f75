"""Public checks of lab 11."""

from hapticlab.course.exercise import Case, Exercise, Lab

PLAIN = "That is Eq. (23.1), which does not predict."
WHOLE = "That is a whole sample ahead, 2 x(n) - x(n-1). Eq. (23.2) takes the mean of this prediction and x(n)."
BACK = "That is half a sample back: the mean of the last two samples makes the staircase later, not earlier."
ELLIS = "That is Ellis's law, Eq. (23.7), with its correction. This exercise asks for Eq. (23.5), without it."
STRICT = "The wall also acts at x(n) = x_o: use >=, not >."
CLIPPED = (
    "You clipped past samples at the boundary. That is also a wall (hl.wall calls it unilateral='clip'), but this "
    "exercise uses the past samples as they are, and the force is zero only where x(n) < x_o."
)
ALWAYS = "Your force also acts outside the wall. It must be zero where x(n) < x_o."
ONE_SHIFT = "Subtract x_o from each sample: with 1.5 x(n) - 0.5 x(n-1) - 1.5 x_o the boundary moves."
NO_BOUNDARY = "The spring is compressed by x - x_o, not by x."
FULL_WEIGHT = "You added the correction with its full weight. In Eq. (23.6) it is inside the bracket, multiplied by k/2."
ADAMS = (
    "Those are the weights of Adams-Bashforth, 23/12, -16/12, 5/12, for a parabola through three samples. "
    "Ellis corrects a straight line."
)
UNCORRECTED = "That is Eq. (23.5), without the correction."
DELAY_ALONE = "You compensated for the delay alone. The force is also held, and therefore half a period later on average."
HOLD_ALONE = "That is Eq. (23.5): it compensates for the hold, but the force also starts late by the delay."
WHOLE_PERIOD = "You counted a whole period for the hold. At its start a held force is not late, so its mean lateness is smaller."
PLUS = "The sign of c_1 is wrong: the bracket contains -x(n-1), and at rest the two weights must give one spring, c_0 + c_1 = 1."
WITHOUT_ONE = "The spring itself is missing: besides the bracket the law contains x(n) with the weight 1."
BACKWARD = "That looks back: with these weights the law follows the line into the past, and both dampers have the same sign."
SWAPPED_WEIGHTS = "These are the right two weights in the wrong order: c_0 belongs to x(n)."
SECONDS = "That is s in seconds. The bracket is a displacement in one period, so s counts periods: divide the time by T."
SUM_OF_TAPS = (
    "That is the sum of the weights, which is right for slow motion. At half the sampling rate the samples alternate, so "
    "their signs are +, -, +."
)
ABSOLUTE = (
    "You summed the weights without their own signs. The weight on x(n-1) meets a sample of the other sign: c_1 counts as -c_1."
)
TWICE = "That is twice as large as expected. The damper's force b 2a/T acts along 2a, so 4 b a^2/T must cover 2 k a^2 h."
ACCELERATION = "The sign is wrong: F is the force on the environment, and the handle feels -F."
SWAPPED = "These are the right two forces in the wrong order."
EULER = (
    "While a force is held, the handle moves on a parabola: x + T v - (T^2/2m) F in one period. The velocity that the first "
    "force causes also moves the handle in the second period."
)

LAB = Lab(
    number="11",
    title="Prediction against the hold",
    minutes=110,
    exercises=(
        Exercise(
            "prediction",
            kind="prediction",
            asks="the leak that is left under Eq. (23.5) [% of the incoming energy]",
        ),
        Exercise(
            "prediction_late",
            kind="prediction",
            asks="the same where the force arrives one period late [% of the incoming energy]",
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
                        ((0.0, 1.5, 2.0, 3.0, -1.0, 0.0), ELLIS),
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
                        ((0.0, 1.0, 0.0, 1.75, 3.25, 0.25, 0.0), NO_BOUNDARY),
                        ((0.0, 1.0, 0.0, 2.5, 2.75, -1.75, 0.0), ELLIS),
                    ),
                ),
            ),
            hint="How far beyond x_o is each sample that the law uses? Which sample decides whether the wall acts?",
            matters="A prediction of half a sample removes nearly all of the leak of a bounce, without any change to the device.",
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
                        ((0.0, 1.0, 2.0, 3.0, 0.25, 0.0), UNCORRECTED),
                    ),
                ),
                Case(
                    {"x": [0.0, 2e-3, 3e-3, 3e-3, 2.5e-3, 0.5e-3], "values": {"k": 1000.0, "x_o": 1e-3}},
                    [0.0, 3.0, 2.0, 1.5, 1.0, 0.0],
                    unit="N",
                    slips=(
                        ((0.0, 4.0, 3.0, 2.5, 2.0, 0.0), NO_BOUNDARY),
                        ((0.0, 2.0, 2.5, 2.0, 1.25, 0.0), UNCORRECTED),
                    ),
                ),
            ),
            hint="Which known samples does each hat stand for? A handle at rest feels k x, so what is the sum of the weights?",
            matters="A correction can improve a prediction, but its larger weights also amplify the steps of the encoder.",
        ),
        Exercise(
            "look_ahead",
            points=2,
            asks="the weights [c_0, c_1] of the law whose two dampers cancel, from T [s] and the delay [s]",
            cases=(
                Case({"T": 1e-3, "delay": 0.0}, [1.5, -0.5], slips=(((1.0, 0.0), DELAY_ALONE), ((2.0, -1.0), WHOLE_PERIOD))),
                Case(
                    {"T": 2e-3, "delay": 3e-3},
                    [3.0, -2.0],
                    slips=(
                        ((2.5, -1.5), DELAY_ALONE),
                        ((3.5, -2.5), WHOLE_PERIOD),
                        ((1.5, -0.5), HOLD_ALONE),
                        ((3.0, 2.0), PLUS),
                        ((2.0, -2.0), WITHOUT_ONE),
                        ((-1.0, 2.0), BACKWARD),
                        ((-2.0, 3.0), SWAPPED_WEIGHTS),
                        ((1.004, -0.004), SECONDS),
                    ),
                ),
                Case(
                    {"T": 1e-3, "delay": 2.5e-4},
                    [1.75, -0.75],
                    slips=(
                        ((1.25, -0.25), DELAY_ALONE),
                        ((1.5, -0.5), HOLD_ALONE),
                        ((2.25, -1.25), WHOLE_PERIOD),
                        ((1.00075, -0.00075), SECONDS),
                    ),
                ),
            ),
            hint="How late is a force that is held, and how late if it also starts late? In which unit is s?",
            matters="A law that compensates for the hold alone still leaks wherever a computer or a sensor is late.",
        ),
        Exercise(
            "nyquist_damping",
            points=2,
            asks="the device damping [N s/m] that pays for alternating samples, from taps c_0, c_1, ..., k [N/m], T [s]",
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
            hint="Which sign does each sample have? Does the damper dissipate all the energy that the law generates in a period?",
            matters="A law that removes the leak of a slow bounce can still need much damping in the fastest motion.",
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
            hint="How does each force change the last velocity and the last position? Which force has longer to act?",
            matters="Position and velocity are two numbers, so two held forces are the fewest that can set both.",
        ),
        Exercise(
            "which_law",
            kind="choice",
            points=1,
            asks="the law that suits an encoder, one period of delay and thirty different hands",
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
                        "b": "Ellis's law compensates for the hold, but not for the period of delay: see the figure of "
                        "the section on the remaining leak. It also amplifies each encoder count up to four times: see "
                        "the price of a prediction.",
                        "c": "Inside a plain wall the two dampers cancel in slow motion: see the row `damped` in the section on "
                        "the remaining leak.",
                        "d": "Its forces change with the position by m/T^2, so each encoder count is a kick. Its model also "
                        "describes one hand, not thirty.",
                    },
                ),
            ),
            hint="What does each law need to know? How does it react to the encoder, the delay and an unknown hand?",
            matters="No law is best in general. The sensor, the delay and the hands decide which law suits a device.",
        ),
        Exercise(
            "discussion",
            kind="text",
            least_words=60,
            asks="when the handle is furthest from a straight line, which laws are wrong then, and where you would spend effort",
        ),
    ),
)
