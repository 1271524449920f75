"""Public checks of lab 08: numbers and the sentences of the feedback; no answers."""

from hapticlab.course.exercise import Case, Exercise, Lab

PULLS = (
    "While the bodies separate, your damping term makes the force negative, and the bodies would stick together. The "
    "force is never below 0."
)
FROM_AFAR = "The gap is open there, but your damping term still produces a force. A contact may act only where the gap is closed."
NEITHER = "Two conditions are missing. The force is zero where the gap is open, and the force never pulls."
DAMPER_SIGN = (
    "The sign of the damping term is wrong. While the bodies approach, the rate of the gap is negative and the damper "
    "adds to the force: -k gap - b rate."
)
NO_DAMPER = "The damping term -b rate is missing."
ONE_STEP = "With that stiffness a contact lasts a single step, but ten steps are required."
BALL_ALONE = "That is the limit for a plate that is held. A free plate moves away, so use the effective mass m M/(m + M)."
TOGETHER = (
    "The two bodies oscillate against each other and do not move as one body. The effective mass is m M/(m + M), not m + M."
)
FULL_SWING = "You used a whole cycle of the oscillation. A contact lasts half a cycle, pi sqrt(mu/k)."
TEN_OUTSIDE = "The contact time is proportional to 1/sqrt(k), so the factor ten must be squared together with the step."
NO_SQUARE = "The square is missing. The contact time is proportional to 1/sqrt(k), so k is proportional to (pi/(10 h))^2."
ONLY_EQUAL = "That impulse makes the velocities equal, as if e were 0. The impulse is 1 + e times as large."
HELD = "That is the rebound from a plate that does not move. Here the plate takes up momentum."
PLASTIC = (
    "The impulse is too small. It is 1 + e times the impulse that makes the velocities equal, because the bodies also rebound."
)
HEAVY = (
    "That is the impulse on a plate that is held, (1 + e) m (w - v). A free plate moves away, so use m M/(m + M) instead of m."
)
IMPULSE_SIGN = "The sign of the impulse is wrong. The ball falls and is thrown up, so the impulse on the ball is positive."
PLATE_SIGN = "The plate loses the momentum that the ball gains: w' = w - p/M."
RELATIVE = "Restitution reverses the *relative* velocity: v' - w' = -e (v - w)."
NO_E = "Euler's number e = 2.718... is missing. At s = tau the pulse is p/(e tau)."
TRIANGLE = "That is the width of a triangle with this peak. The pulse p s/tau^2 exp(-s/tau) peaks at p/(e tau)."
INVERSE_E = "Solve p/(e tau) = F_max for tau: e belongs in the denominator."
WEIGHT = "That is the weight alone. A plate that accelerates upwards with a must push with m (g + a)."
DOWN = "The sign of a is wrong. a is positive upwards, so a plate that accelerates downwards, a < 0, reduces the reaction."
PULLED = "A reaction never pulls. Where m (g + a) is negative, the contact opens and N = 0."
CLOSED = "While the plate pushes, the gap stays closed, so its acceleration is 0 and not negative."
NO_WEIGHT = (
    "The weight is missing. Even on a plate at rest, a = 0, the ball presses with m g. N is m (g + a) where this is positive."
)
FALLS = "Gravity is missing. The free ball falls with g and the plate moves with a, so the gap opens with -g - a."
OTHER_SIGN = "The sign is wrong. The free ball falls with g and the plate falls faster, so the gap opens with -g - a > 0."
SUM = "That is the trace, the sum of both eigenvalues. The larger eigenvalue decides (numpy.linalg.eigvals)."
PRODUCT = "That is the determinant, the product of both eigenvalues. The larger eigenvalue decides."
SMALL = "That is the smaller eigenvalue. The larger eigenvalue decides whether errors die out."
REAL_PART = "Take the magnitude of each eigenvalue (numpy.abs), which may be complex or negative, and then the largest magnitude."

LAB = Lab(
    number="08",
    title="Contact",
    minutes=120,
    exercises=(
        Exercise("prediction", kind="prediction", asks="the force that applies the impulse of the impact within 1 ms [N]"),
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
                        (
                            0.0,
                            0.0,
                            0.0,
                            0.0,
                            0.0,
                            0.0,
                            0.0,
                        ): "The force is zero everywhere. The gap is negative inside, so the force of the spring is -k gap.",
                    },
                ),
                Case(
                    {"gap": [-0.003, -0.001, 0.004], "rate": [0.2, -0.1, -0.3], "k": 1000.0, "b": 0.0},
                    [3.0, 1.0, 0.0],
                    unit="N",
                    slips={(3.0, 1.0, -4.0): NEITHER},
                ),
            ),
            hint="Where may the contact act at all? Which sign may its force never have?",
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
            hint="How long does a contact last? How long are ten steps?",
            matters=(
                "A contact that lasts only a few steps returns a different energy each time, so the step limits the stiffness."
            ),
        ),
        Exercise(
            "two_springs",
            kind="choice",
            points=1,
            asks='"a", "b", "c" or "d"',
            options={
                "a": "for both, the passivity of the device",
                "b": "for K, the number of steps in a contact; for k_b, Eq. (23.10)",
                "c": "for k_b, the number of steps in a contact; for K, Eq. (23.10)",
                "d": "for neither",
            },
            cases=(
                Case(
                    {},
                    "c",
                    slips={
                        "a": (
                            "Only the coupler touches the handle. k_b acts between two bodies that the solver moves, "
                            "so k_b does not appear in Eq. (23.10)."
                        ),
                        "b": "You exchanged the two springs. Only one of them is connected to the sampled handle.",
                        "d": (
                            "A steel spring generates no energy, but a sampled spring does, and so does a spring that "
                            "is integrated in steps that are too large."
                        ),
                    },
                ),
            ),
            hint="Which spring is connected to the sampled handle, and which one only to bodies inside the solver?",
            matters="Each spring has its own limit, so you know which one you may still make stiffer.",
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
                        (
                            {"p": 0.04},
                            ("The plate moves as well, so the impulse is proportional to the relative velocity w - v."),
                        ),
                    ),
                ),
                Case(
                    {"v": -1.0, "w": 0.5, "m": 0.05, "M": 1e5, "e": 0.5},
                    {"v": 1.2499988750005624, "w": 0.4999988750005625, "p": 0.11249994375002813},
                    slips=(({"v": 0.5}, RELATIVE), ({"v": -0.25}, PLASTIC), ({"p": 0.075}, RELATIVE)),
                ),
            ),
            hint="Three unknowns need three equations. What does p do to each body, and what does restitution state?",
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
            hint="At which time does the pulse peak? How large is F(s) there?",
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
            hint="Which N keeps the gap closed? What happens if this N is negative?",
            matters="One condition decides whether the ball rests or leaves the plate, and the contact needs no stiffness.",
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
            hint="Which eigenvalue decides after many flights? Eigenvalues may be complex or negative (numpy.linalg.eigvals).",
            matters="The largest eigenvalue shows whether a small deviation dies out or grows from one impact to the next.",
        ),
        Exercise("discussion", kind="text", least_words=60, asks="your comparison, at least 60 words"),
    ),
)
