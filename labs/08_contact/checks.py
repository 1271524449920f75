"""Public checks of lab 08: numbers and the sentences that teach; no answers."""

from hapticlab.course.exercise import Case, Exercise, Lab

PULLS = "On the way out the damper asks for a pull, and the contact would stick: N is never below 0."
FROM_AFAR = "The gap is open there, and its rate alone makes a force: a contact acts where it is closed only."
NEITHER = "Two conditions are missing: no force where the gap is open, and never a pull."
DAMPER_SIGN = "While the bodies approach, the gap's rate is negative and the damper adds to the force: -k gap - b rate."
NO_DAMPER = "The damper is missing: -b rate."
ONE_STEP = "That contact would last a single step; ten are needed."
BALL_ALONE = "That is for a plate that is held. A free one gives way: take the effective mass m M/(m + M)."
TOGETHER = "The two swing against each other, not as one lump: the effective mass is m M/(m + M), not m + M."
FULL_SWING = "A contact lasts half a period of the swing, pi sqrt(mu/k), not a whole one."
TEN_OUTSIDE = "The time goes with 1/sqrt(k), so that the ten is squared with the step."
NO_SQUARE = "The square is missing: a time goes with 1/sqrt(k), so that k goes with (pi/(10 h))^2."
ONLY_EQUAL = "That makes the velocities equal, as if nothing sprang back: the impulse is 1 + e times that."
HELD = "That is the rebound from a plate that does not move away; here it takes up momentum."
PLASTIC = "The impulse is 1 + e times the one that makes the velocities equal: that first, then the rebound."
HEAVY = "That is the impulse on a plate that is held, (1 + e) m (w - v); a free one gives way: take m M/(m + M)."
IMPULSE_SIGN = "The ball falls and is thrown up: the impulse on it is positive, upwards."
PLATE_SIGN = "What the ball gains upwards the plate loses: w' = w - p/M."
RELATIVE = "It is the *relative* velocity that turns round: v' - w' = -e (v - w)."
NO_E = "At s = tau the pulse is p/(e tau), with Euler's e = 2.718..."
TRIANGLE = "That is the width of a triangle with that peak; the pulse p s/tau^2 exp(-s/tau) peaks at p/(e tau)."
INVERSE_E = "Solve p/(e tau) = F_max for tau: the e stands below."
WEIGHT = "That is the weight alone; a plate that accelerates upwards by a has to give m (g + a)."
DOWN = "a counts upwards: a plate that moves off downwards, a < 0, makes the ball lighter."
PULLED = "A reaction never pulls: where m (g + a) is negative the contact is open, and N = 0."
CLOSED = "While the plate pushes the gap stays closed: its acceleration is 0, not negative."
NO_WEIGHT = "The weight is missing: even on a plate at rest, a = 0, the ball presses with m g. N is m (g + a), where that pushes."
FALLS = "Gravity is missing: the free ball falls with g, the plate moves with a, and the gap opens with -g - a."
OTHER_SIGN = "The free ball falls with g and the plate falls faster: the gap opens with -g - a > 0."
SUM = "That is the trace, the sum of both eigenvalues; the larger one decides (numpy.linalg.eigvals)."
PRODUCT = "That is the determinant, the product of both eigenvalues; the larger one decides."
SMALL = "That is the smaller one; the larger decides what remains."
REAL_PART = "Take the magnitude of each eigenvalue (numpy.abs), of complex and negative ones too, and then the largest."

LAB = Lab(
    number="08",
    title="Contact",
    minutes=120,
    exercises=(
        Exercise("prediction", kind="prediction", asks="the force that gives the impact's impulse in 1 ms [N]"),
        Exercise(
            "penalty_force",
            points=2,
            asks="the normal force [N] of a penalty contact, an array as long as gap",
            cases=(
                Case(
                    {
                        "gap": [0.001, 0.0001, -0.001, -0.002, -0.001, -0.0005, 0.002],
                        "rate": [-0.5, -0.5, -0.4, 0.0, 0.3, 0.6, 0.7],
                        "k": 500.0,
                        "b": 1.0,
                    },
                    [0.0, 0.0, 0.9, 1.0, 0.2, 0.0, 0.0],
                    unit="N",
                    slips={
                        (0.0, 0.0, 0.9, 1.0, 0.2, -0.35, 0.0): PULLS,
                        (0.0, 0.45, 0.9, 1.0, 0.2, 0.0, 0.0): FROM_AFAR,
                        (0.0, 0.45, 0.9, 1.0, 0.2, -0.35, -1.7): NEITHER,
                        (0.0, 0.0, 0.1, 1.0, 0.8, 0.85, 0.0): DAMPER_SIGN,
                        (0.0, 0.0, 0.5, 1.0, 0.5, 0.25, 0.0): NO_DAMPER,
                        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0): "gap is negative inside: the spring's force is -k gap.",
                    },
                ),
                Case(
                    {"gap": [-0.003, -0.001, 0.004], "rate": [0.2, -0.1, -0.3], "k": 1000.0, "b": 0.0},
                    [3.0, 1.0, 0.0],
                    unit="N",
                    slips={(3.0, 1.0, -4.0): NEITHER},
                ),
            ),
            hint="where may it act at all, and which sign may it never have, whatever the damper asks for?",
            matters="A contact can push but never pull. A law without this condition makes bodies stick together.",
        ),
        Exercise(
            "stiffest_penalty",
            points=1,
            asks="the largest contact stiffness [N/m] with which a contact lasts ten steps",
            cases=(
                Case(
                    {"m": 0.02, "M": 0.1, "h": 1e-3},
                    1644.9340668482264,
                    unit="N/m",
                    slips={
                        164493.4066848226: ONE_STEP,
                        1973.9208802178719: BALL_ALONE,
                        11843.525281307231: TOGETHER,
                        6579.736267392906: FULL_SWING,
                        16449.340668482262: TEN_OUTSIDE,
                        5.235987755982989: NO_SQUARE,
                    },
                ),
                Case(
                    {"m": 0.05, "M": 0.05, "h": 5e-4},
                    9869.60440108936,
                    unit="N/m",
                    slips={986960.4401089359: ONE_STEP, 19739.20880217872: BALL_ALONE, 98696.0440108936: TEN_OUTSIDE},
                ),
            ),
            hint="how long does a contact last, and how long are ten steps?",
            matters=("A contact that lasts only a few steps bounces differently each time, so the step limits the stiffness."),
        ),
        Exercise(
            "two_springs",
            kind="choice",
            points=1,
            asks='"a", "b", "c" or "d"',
            options={
                "a": "for both at the passivity of the device",
                "b": "for K at the steps that a contact lasts, for k_b at Eq. (23.10)",
                "c": "for k_b at the steps that a contact lasts, for K at Eq. (23.10)",
                "d": "at neither",
            },
            cases=(
                Case(
                    {},
                    "c",
                    slips={
                        "a": "The handle meets the coupler alone; k_b acts between two bodies that the solver moves.",
                        "b": "It is the other way round: which of the two springs is tied to the sampled handle?",
                        "d": "Springs of steel create none. A sampled one does, and one in too coarse steps as well.",
                    },
                ),
            ),
            hint="which spring sees the sampled handle, and which one only the solver?",
            matters="Each spring has a limit of its own, so you can tell which of them you may still make stiffer.",
        ),
        Exercise(
            "impact",
            points=2,
            asks='{"v": and "w": velocities of ball and plate after the impact [m/s], "p": impulse on the ball [N s]}',
            cases=(
                Case(
                    {"v": -0.767, "w": 0.0, "m": 0.02, "M": 0.1, "e": 0.8},
                    {"v": 0.3835, "w": -0.2301, "p": 0.02301},
                    slips=(
                        ({"v": 0.6136}, HELD),
                        ({"v": -0.2556666666666667}, PLASTIC),
                        ({"v": -0.12783333333333333}, ONLY_EQUAL),
                        ({"w": 0.2301}, PLATE_SIGN),
                        ({"p": 0.027612}, HEAVY),
                        ({"p": -0.02301}, IMPULSE_SIGN),
                    ),
                ),
                Case(
                    {"v": -0.4, "w": 0.2, "m": 0.1, "M": 0.1, "e": 1.0},
                    {"v": 0.2, "w": -0.4, "p": 0.06},
                    slips=(
                        ({"v": 0.4}, RELATIVE),
                        ({"v": -0.1}, ONLY_EQUAL),
                        ({"v": 0.8}, HELD),
                        ({"p": 0.12}, HEAVY),
                        ({"p": 0.04}, "The plate moves as well: the impulse goes with the relative velocity w - v."),
                    ),
                ),
                Case(
                    {"v": -1.0, "w": 0.5, "m": 0.05, "M": 1e5, "e": 0.5},
                    {"v": 1.2499988750005624, "w": 0.4999988750005625, "p": 0.11249994375002813},
                    slips=(({"v": 0.5}, RELATIVE), ({"v": -0.25}, PLASTIC), ({"p": 0.075}, RELATIVE)),
                ),
            ),
            hint="three unknowns need three equations: what does p do to each body, and what does restitution say?",
            matters="An impact that is solved as an event needs neither a stiff spring nor a short step.",
        ),
        Exercise(
            "pulse_time",
            points=1,
            asks="tau [s] of the pulse that peaks at F_max",
            cases=(
                Case(
                    {"p": 0.0276, "F_max": 3.3},
                    0.0030768098716156995,
                    unit="s",
                    slips={0.008363636363636365: NO_E, 0.01672727272727273: TRIANGLE, 0.022734720747112015: INVERSE_E},
                ),
                Case(
                    {"p": 0.005, "F_max": 2.0},
                    0.0009196986029286058,
                    unit="s",
                    slips={0.0025: NO_E, 0.005: TRIANGLE, 0.006795704571147613: INVERSE_E},
                ),
            ),
            hint="where does the pulse peak, and how large is F(s) there?",
            matters=(
                "No motor applies an impulse in zero time. A pulse delivers the same impulse with a force that "
                "the motor can produce."
            ),
        ),
        Exercise(
            "reaction",
            points=2,
            asks='{"N": the reaction [N], "gap_acceleration": [m/s^2]} of a ball at rest on a plate',
            cases=(
                Case(
                    {"a": 2.0, "m": 0.02, "g": 9.81},
                    {"N": 0.2362, "gap_acceleration": 0.0},
                    slips=(
                        ({"N": 0.1962}, WEIGHT),
                        ({"N": 0.1562}, DOWN),
                        ({"N": 0.04}, NO_WEIGHT),
                        ({"gap_acceleration": -11.81}, CLOSED),
                    ),
                ),
                Case(
                    {"a": -15.0, "m": 0.02, "g": 9.81},
                    {"N": 0.0, "gap_acceleration": 5.19},
                    slips=(
                        ({"N": -0.1038}, PULLED),
                        ({"N": 0.1962}, WEIGHT),
                        ({"N": 0.4962}, DOWN),
                        ({"gap_acceleration": -5.19}, OTHER_SIGN),
                        ({"gap_acceleration": 15.0}, FALLS),
                    ),
                ),
                Case({"a": -9.81, "m": 0.05, "g": 9.81}, {"N": 0.0, "gap_acceleration": 0.0}),
            ),
            hint="which N would keep the gap closed? And what if that N would have to pull?",
            matters="One condition decides between resting and taking off, without any stiffness of the contact.",
        ),
        Exercise(
            "largest_multiplier",
            points=1,
            asks="the largest magnitude of the eigenvalues of the map from one impact to the next",
            cases=(
                Case(
                    {"a": -5.0, "e": 0.8, "g": 9.81},
                    0.8,
                    slips={0.64: PRODUCT, -0.011376146788991055: SUM, -0.005688073394495528: REAL_PART},
                ),
                Case(
                    {"a": 2.0, "e": 0.8, "g": 9.81},
                    1.9767938941646706,
                    slips={0.64: PRODUCT, 2.3005504587155965: SUM, 0.32375656455092583: SMALL},
                ),
                Case(
                    {"a": -12.0, "e": 0.8, "g": 9.81},
                    2.0039303796270667,
                    slips={0.64: PRODUCT, -2.323302752293578: SUM, 0.319372372666511: SMALL, -0.319372372666511: REAL_PART},
                ),
            ),
            hint="which eigenvalue decides in the long run? They may be complex or negative (numpy.linalg.eigvals).",
            matters="It shows whether a small deviation dies out or grows from one impact to the next.",
        ),
        Exercise("discussion", kind="text", least_words=60, asks="your comparison, at least 60 words"),
    ),
)
