"""Public checks of lab 02."""

from hapticlab.course.exercise import Case, Exercise, Lab

HELD = "Which force acts during this period, and does it change while the handle moves?"
MEAN = (
    "That is the work of the mean force, as of a spring that is not sampled. The motor holds the first force "
    "for the whole period."
)
END = "That uses the force at the end of the period. The force is computed at the beginning of the period and then held."
FULL = "The square is right. The held force leaves out the area below the spring line, which is a triangle, not a rectangle."
TAKEN = "That is the work of the held force minus the increase in stored energy, so the sign of the leak is wrong."
WRONG_WAY = (
    "You paired F(n) with the displacement from x(n-1) to x(n). F(n) is computed from x(n) and acts after it, "
    "while the handle moves to x(n+1). With the wrong pairing, a wall that generates energy seems to absorb it."
)
MEAN_FORCE = (
    "That is nearly zero: the mean of two successive forces is the force of a spring that is not sampled. The "
    "motor holds F(n) during the whole displacement."
)
TAKES = "That is the work of the handle on the wall. The energy that the wall generated is minus that work."
EVERYWHERE = (
    "Your wall also acts outside. F is zero where x < 0, so in the periods in which the handle crosses the "
    "boundary the leak is less than k D^2/2."
)
SECOND = (
    "That is e^(pi w T/2) - 1, which includes the next order and is nearer to the measurement. The question "
    "asks for the first order: insert v of the undisturbed bounce into the integral."
)
WHOLE = (
    "That is twice as large as expected: the handle is inside for half a cycle of its oscillation, pi/w, not for a whole cycle."
)
NO_HALF = "That is half as large as expected: the energy that went in is m v0^2/2, and the mean of cos^2 is 1/2."
NO_MASS = "The fraction depends on w = sqrt(k/m); the square root is missing."
SWAPPED = (
    "k and m are swapped in w = sqrt(k/m): a stiffer spring throws the handle out sooner, and a heavier handle leaves later."
)
PERCENT = "That is in percent. The question asks for the fraction itself: half of the energy would be 0.5."
GATES = (
    "Both conditions are the wrong way round: each wall pulls while the handle is outside it, and exerts no "
    "force on a handle inside it. Write >= where you wrote <=, and <= where you wrote >=."
)

LAB = Lab(
    number="02",
    title="The virtual wall, and where its energy comes from",
    minutes=90,
    exercises=(
        Exercise("prediction", kind="prediction", asks="the energy that comes out in excess of the energy that went in [%]"),
        Exercise(
            "held_work",
            points=1,
            asks="the work of the handle on the wall [J] in one period that begins at x [m], for a displacement D [m]",
            cases=(
                Case({"k": 500.0, "x": 2e-3, "D": 1e-4}, 1e-4, unit="J", slips={1.025e-4: MEAN, 1.05e-4: END}),
                Case({"k": 300.0, "x": 1e-3, "D": -2e-4}, -6e-5, unit="J", slips={-5.4e-5: MEAN, -4.8e-5: END}),
            ),
            hint=HELD,
            matters=(
                "The motor holds each force while the handle moves on. This is where the energy of a sampled wall comes from."
            ),
        ),
        Exercise(
            "period_leak",
            points=1,
            asks="the energy [J] that the wall generates in a period in which the handle moves by D [m]",
            cases=(
                Case({"k": 500.0, "D": 1e-4}, 2.5e-6, unit="J", slips={5e-6: FULL, -2.5e-6: TAKEN}),
                Case({"k": 300.0, "D": -2e-4}, 6e-6, unit="J", slips={1.2e-5: FULL, -6e-6: TAKEN}),
            ),
            hint="Did you subtract the work done by the handle from the increase in the energy of the spring? Does x cancel?",
            matters="The leaks on the way in and on the way out do not cancel, so energy builds up in every contact.",
        ),
        Exercise(
            "bounce_gain",
            points=2,
            asks="the energy generated in one bounce over the energy that went in, to first order in T",
            cases=(
                Case(
                    {"k": 800.0, "m": 0.05, "T": 1e-3},
                    0.19869176531592203,
                    slips={
                        0.39738353063184406: WHOLE,
                        0.09934588265796102: NO_HALF,
                        0.2198059214550434: SECOND,
                        25.132741228718345: NO_MASS,
                        19.869176531592203: PERCENT,
                        1.2418235332245126e-05: SWAPPED,
                    },
                ),
                Case({"k": 1200.0, "m": 0.03, "T": 5e-4}, 0.15707963267948966, slips={0.17008878749642195: SECOND}),
                Case({"k": 2000.0, "m": 0.05, "T": 1e-3}, 0.3141592653589793, slips={0.36910718607437147: SECOND}),
            ),
            hint=(
                "For how long is the handle inside, and what is the mean of v^2? Does v0 cancel when you divide "
                "by the incoming energy?"
            ),
            matters="The speed does not appear in this fraction, so a gentle knock gains as large a fraction as a hard knock.",
        ),
        Exercise(
            "energy_generated",
            points=2,
            asks="the energy [J] that the wall F = k x (x >= 0) generates over positions x [m] that begin and end outside",
            cases=(
                Case(
                    {"x": [-1e-3, 1e-3, 3e-3, 5e-3, 4e-3, 2e-3, -1e-3], "k": 100.0},
                    1.1e-3,
                    unit="J",
                    slips={-1e-3: WRONG_WAY, 5e-5: MEAN_FORCE, -1.1e-3: TAKES, 1.3e-3: EVERYWHERE},
                ),
                Case(
                    {"x": [-5e-4, 2e-4, 6e-4, 7e-4, 5e-4, -1e-4, -4e-4, 3e-4, 1e-4, -2e-4], "k": 800.0},
                    3.12e-4,
                    unit="J",
                    slips={
                        -4.32e-4: WRONG_WAY,
                        -6e-5: MEAN_FORCE,
                        -3.12e-4: TAKES,
                        7.92e-4: EVERYWHERE,
                        7.08e-4: EVERYWHERE,
                    },
                ),
            ),
            hint="Which force was held while the handle moved from x(n) to x(n+1)? Whose work does the question ask for?",
            matters="With the right pairing of force and motion, any recording shows whether a wall generates energy.",
        ),
        Exercise(
            "two_walls",
            kind="scene",
            points=2,
            asks="a Scene with parameters k [N/m] and x_o [m] that pushes back beyond +x_o and beyond -x_o",
            cases=(
                Case(
                    {"x": [-5e-3, -2e-3, 0.0, 1e-3, 4e-3], "values": {"k": 500.0, "x_o": 2e-3}},
                    [-1.5, 0.0, 0.0, 0.0, 1.0],
                    unit="N",
                    slips=(
                        (
                            (1.5, 0.0, 0.0, 0.0, 1.0),
                            "Your left wall pulls. There the handle presses in the direction of -x, so F_e < 0.",
                        ),
                        ((0.0, 0.0, 0.0, 0.0, 1.0), "Only the right wall acts. Add the wall at -x_o."),
                        (
                            (-2.5, -1.0, 0.0, 0.0, 2.0),
                            "Each spring begins at its own boundary, not at x = 0. Beyond x_o the penetration depth is x - x_o.",
                        ),
                        (
                            (-2.5, -1.0, 0.0, 0.0, 1.0),
                            (
                                "Your left spring begins at x = 0. Beyond -x_o, at the left, the handle is "
                                "inside by x + x_o, which is negative."
                            ),
                        ),
                        (
                            (-3.5, -2.0, 0.0, 0.0, 1.0),
                            "The left boundary is at -x_o, so the handle is inside by x - (-x_o) = x + x_o, which is negative.",
                        ),
                        ((-3.5, -2.0, 0.0, 1.0, 3.0), GATES),
                        (
                            (-3.5, -2.0, 0.0, 0.0, 3.0),
                            "Each spring uses the boundary of the other wall. Beyond x_o the penetration depth is x - x_o.",
                        ),
                        (
                            (1.5, 0.0, 0.0, 0.0, -1.0),
                            "Both signs are wrong: `force` is F_e, the force ON the environment.",
                        ),
                    ),
                ),
            ),
            hint="How deep is the handle inside each wall? In which direction does the handle press there?",
            matters="Each boundary has its own condition. In this way you can build a box, a channel or a button.",
        ),
        Exercise(
            "damping_that_pays",
            kind="value",
            points=1,
            asks="the damper b [N s/m] of the device that dissipates what a held spring of K_OWN generates at T_OWN",
            cases=(
                Case(
                    {},
                    0.25,
                    unit="N s/m",
                    slips={
                        0.5: "k T belongs to a delay of a whole period. On average the hold is late by half a period.",
                        -0.25: (
                            "That is the negative damper that the hold adds in parallel with the spring. The "
                            "device needs a damper that dissipates as much."
                        ),
                        250.0: "T is in seconds: 1 ms is 0.001 s.",
                    },
                ),
            ),
            rtol=1e-3,
            hint="Leak and damper are both a constant times the integral of v^2. What are the two constants?",
            matters=(
                "One bounce leads to the passivity condition, Eq. (23.10): the damping of the device limits the "
                "stiffness of the wall."
            ),
        ),
        Exercise(
            "who_pays",
            kind="choice",
            points=1,
            asks="who supplies, on a real paddle, the energy that the staircase shows",
            options={"a": "the hand", "b": "the sensor", "c": "the wall's spring", "d": "the motor's supply"},
            cases=(
                Case(
                    {},
                    "d",
                    slips={
                        "a": (
                            "The recording shows the energy that the hand supplied: the work on the way in. "
                            "More energy than that came out."
                        ),
                        "b": "The sensor only reads the position. Its supply does no work on the handle.",
                        "c": (
                            "Before the contact the handle was outside and the spring of the wall was relaxed, "
                            "so it stored no energy."
                        ),
                    },
                ),
            ),
            hint="Who does work on the handle while the wall throws it out?",
            matters="If you know where the energy comes from, you know where it must be dissipated.",
        ),
        Exercise(
            "discussion",
            kind="text",
            least_words=60,
            asks="why the wrong pairing misleads, and why a wall chatters in a hand that keeps still",
        ),
    ),
)
