"""Public checks of lab 02."""

from hapticlab.course.exercise import Case, Exercise, Lab

HELD = "Which force acts in this period, and does it change while the handle is on its way?"
MEAN = "That is the work at the mean force, which is what a spring takes that is not sampled. The motor holds the first force."
END = "That is the force of the end of the period. It is computed at the beginning, and held."
FULL = "The square is right. What the held force leaves out is the corner below the spring line: a triangle, not a square."
TAKEN = "That is what the held spring took less what the spring stored: the leak with its sign turned."
WRONG_WAY = (
    "F(n) was paired with the way from x(n-1) to x(n). It is computed from x(n) and acts after "
    "it, while the handle goes on to "
    "x(n+1). Paired the wrong way round, a wall that generates energy looks like one that takes it."
)
MEAN_FORCE = "That is nearly zero: the mean of two forces is the spring that is not sampled. The motor holds F(n) all the way."
TAKES = "That is the work of the handle on the wall. What the wall generated is minus that."
EVERYWHERE = (
    "The wall acts outside too. F is zero where x < 0, and in the periods that cross the boundary the leak is less than k D^2/2."
)
SECOND = (
    "That is the next order too, e^(pi w T/2) - 1, and nearer to what is measured. Asked "
    "for is the first order: v of the "
    "undisturbed bounce put into the integral."
)
WHOLE = "That is twice too much: the handle is inside for half a period of its oscillation, pi/w, not for a whole one."
NO_HALF = "Half of what is expected: the energy that came in is m v0^2/2, and the mean of cos^2 is 1/2."
NO_MASS = "The share depends on w = sqrt(k/m), the square root."
SWAPPED = "k and m are swapped in w = sqrt(k/m): a stiffer spring throws the handle out sooner, a heavier handle later."
PERCENT = "That is in percent. Asked for is the share itself: half of it would be 0.5."
GATES = (
    "Both conditions are the wrong way round: each wall pulls while the handle is outside it, and exerts no force on a "
    "handle inside it. Write >= where you wrote <=, and <= where you wrote >=."
)

LAB = Lab(
    number="02",
    title="The virtual wall, and where its energy comes from",
    minutes=90,
    exercises=(
        Exercise("prediction", kind="prediction", asks="the energy that comes out on top of what came in [%]"),
        Exercise(
            "held_work",
            points=1,
            asks="the work of the handle on the wall [J] in one period, at x [m], moving by D [m]",
            cases=(
                Case({"k": 500.0, "x": 2e-3, "D": 1e-4}, 1e-4, unit="J", slips={1.025e-4: MEAN, 1.05e-4: END}),
                Case({"k": 300.0, "x": 1e-3, "D": -2e-4}, -6e-5, unit="J", slips={-5.4e-5: MEAN, -4.8e-5: END}),
            ),
            hint=HELD,
            matters=(
                "The motor holds each force while the handle moves on. The energy that a sampled wall generates comes from this."
            ),
        ),
        Exercise(
            "period_leak",
            points=1,
            asks="the energy [J] the wall gives away in a period in which the handle moves by D [m]",
            cases=(
                Case({"k": 500.0, "D": 1e-4}, 2.5e-6, unit="J", slips={5e-6: FULL, -2.5e-6: TAKEN}),
                Case({"k": 300.0, "D": -2e-4}, 6e-6, unit="J", slips={1.2e-5: FULL, -6e-6: TAKEN}),
            ),
            hint="Have you taken what the handle paid from what the spring holds more? Does x go from it?",
            matters="The leaks of the way in and of the way out do not cancel, so energy builds up in every contact.",
        ),
        Exercise(
            "bounce_gain",
            points=2,
            asks="the energy generated in one bounce over that which came in, to first order in T",
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
            hint="For how long is the handle inside, and what is the mean of v^2 over that time? Does v0 go from the share?",
            matters="The speed is not in this share, so a gentle knock gains as large a share as a hard one.",
        ),
        Exercise(
            "energy_generated",
            points=2,
            asks="the energy [J] the wall F = k x (x >= 0) generated over positions x [m] that begin and end outside",
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
            hint="Which force was held while the handle went from x(n) to x(n+1)? And whose work is asked for?",
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
                            "The left wall pulls: there the handle presses towards -x, so F_e < 0.",
                        ),
                        ((0.0, 0.0, 0.0, 0.0, 1.0), "Only the right wall is there."),
                        (
                            (-2.5, -1.0, 0.0, 0.0, 2.0),
                            "Each spring begins at its own wall, not at x = 0: beyond x_o it is pressed by x - x_o.",
                        ),
                        (
                            (-2.5, -1.0, 0.0, 0.0, 1.0),
                            "The left spring begins at x = 0: beyond -x_o it is pressed by x + x_o.",
                        ),
                        (
                            (-3.5, -2.0, 0.0, 0.0, 1.0),
                            "The left wall is at -x_o, so the handle is beyond it by x - (-x_o) = x + x_o, which is < 0.",
                        ),
                        ((-3.5, -2.0, 0.0, 1.0, 3.0), GATES),
                        (
                            (-3.5, -2.0, 0.0, 0.0, 3.0),
                            "Each spring has the boundary of the other wall: beyond x_o it is pressed by x - x_o.",
                        ),
                        (
                            (1.5, 0.0, 0.0, 0.0, -1.0),
                            "Both signs are turned: force is F_e, the force ON the environment.",
                        ),
                    ),
                ),
            ),
            hint="Where does each wall begin, how far is the handle beyond it, and which way does it press there?",
            matters=("Each boundary has a condition of its own. In this way you can build a box, a channel or a button."),
        ),
        Exercise(
            "damping_that_pays",
            kind="value",
            points=1,
            asks="the damper b [N s/m] of the device that takes what a held spring of K_OWN gives at T_OWN",
            cases=(
                Case(
                    {},
                    0.25,
                    unit="N s/m",
                    slips={
                        0.5: "k T is a whole sample of delay; the hold is late by half a sample in the mean.",
                        -0.25: "That is the damper the hold puts beside the spring. The device needs one that takes as much.",
                        250.0: "T = 1 ms is 0.001 s.",
                    },
                ),
            ),
            rtol=1e-3,
            hint="Leak and damper are both a number times the integral of v^2. Which number is each?",
            matters=(
                "One bounce leads to the passivity condition, Eq. (23.10): how stiff a wall may be depends on the "
                "damping of the device."
            ),
        ),
        Exercise(
            "who_pays",
            kind="choice",
            points=1,
            asks="who supplies the energy that the staircase shows",
            options={"a": "the hand", "b": "the sensor", "c": "the wall's spring", "d": "the motor's supply"},
            cases=(
                Case(
                    {},
                    "d",
                    slips={
                        "a": "The record says what the hand gave: the work on the way in. More than that came out.",
                        "b": "The sensor's supply never reaches the handle.",
                        "c": "Before the contact the handle was outside and the wall's spring at rest: it held nothing.",
                    },
                ),
            ),
            hint="Who does work on the handle when it is thrown out?",
            matters="If you know where the energy comes from, you know what must dissipate it.",
        ),
        Exercise("discussion", kind="text", least_words=60, asks="the wrong pairing, and why a still hand meets chatter"),
    ),
)
