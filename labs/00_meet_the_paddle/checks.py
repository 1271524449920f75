"""Public checks of lab 00: numbers, the letter of the choice, and the sentences that teach; no formulas of an answer."""

from hapticlab.course.exercise import Case, Exercise, Lab

TOSSES = {"asked": [0.5, -0.4, 0.3, -0.5, 0.2, 0.45], "on": [1, 1, 0, 0, 1, 0]}
NO_COINS = "The coins are missing: e is +1 where the spring was on and -1 where it was off."
ONLY_ON = "Intervals without the spring count, too, with e = -1: without them the work of the hand does not average out."
SCALE = {"duty": [0, 0.237, 0.335, 0.411, 0.474], "grams": [2, 42, 82, 122, 163]}

LAB = Lab(
    number="00",
    title="Meet the paddle",
    minutes=60,
    exercises=(
        Exercise("prediction", kind="prediction", asks="the force that the pinching hand feels in the end [N]"),
        Exercise(
            "handle_position",
            points=2,
            asks="the position [m] of the handle from counts, 0 in the middle of its travel, growing to the right",
            rtol=1e-5,
            cases=(
                Case(
                    {"counts": [-3612, 24, 1000, 3660], "left": -3612.0, "right": 3660.0, "travel": 0.088},
                    [-0.044, 0.0, 0.011810781, 0.044],
                    unit="m",
                    slips={
                        (-0.043709571, 0.000290429, 0.01210121, 0.044290429): "Count from the middle of the two stops: "
                        "the sensor's own zero is wherever it was switched on.",
                        (0.0, 0.044, 0.055810781, 0.088): "That is the distance from the left stop; x = 0 is the middle.",
                        (-0.022, 0.0, 0.005905391, 0.022): "The travel is the whole way from stop to stop, and so is "
                        "right - left; a count is travel / (right - left).",
                    },
                ),
                Case(
                    {"counts": [4100, 2600, 100], "left": 4100.0, "right": 100.0, "travel": 0.08},
                    [-0.04, -0.01, 0.04],
                    unit="m",
                    slips={
                        (0.04, 0.01, -0.04): "Here counts fall to the right, and x must still grow to the right: keep "
                        "the sign of right - left, take no abs().",
                        (0.0, 0.03, 0.08): "That is the distance from the left stop; x = 0 is the middle.",
                    },
                ),
            ),
            hint="two questions: how many metres is a count, with its sign? And what does the sensor read in the middle?",
            matters=(
                "Every force is computed from this position, so an error in its scale or sign is an error in "
                "every wall that you feel."
            ),
        ),
        Exercise(
            "which_way",
            kind="choice",
            points=1,
            asks='"a", "b" or "c"',
            options={
                "a": "to the right, deeper into the wall",
                "b": "that depends on which way the handle moves",
                "c": "to the left, out of the wall",
            },
            cases=(
                Case(
                    {},
                    "c",
                    slips={
                        "a": "F is the force on the wall, which points into it; the wall, and so the motor, pushes back.",
                        "b": "A spring does not ask for the velocity: its force follows from the position alone.",
                    },
                ),
            ),
            hint="Which of the two does F push, the wall or the handle? And whom does the motor stand for (Fig. 23.5)?",
            matters=(
                "Every lab uses this sign convention. With one sign wrong, the motor supplies energy where a wall should resist."
            ),
        ),
        Exercise(
            "sign_evidence",
            points=2,
            asks="Z, the signed work of all intervals over the root of the sum of its squares",
            rtol=1e-5,
            cases=(
                Case(
                    {**TOSSES, "moved": [0.0020, -0.0016, -0.0007, 0.0012, 0.0005, -0.0010]},
                    2.107560737,
                    slips={
                        0.337209718: NO_COINS,
                        1.222385227: ONLY_ON,
                        0.003: "That is W, in joules; divide by the root of the sum of squares, so that chance has a size.",
                        0.00122474487: "Divide by the root of the sum of the squares of asked*moved, not of their number.",
                    },
                ),
                Case(
                    {**TOSSES, "moved": [-0.0010, 0.0016, 0.0007, -0.0022, 0.0, 0.0012]},
                    -2.013433775,
                    slips={
                        0.478106348: NO_COINS,
                        -0.767663714: ONLY_ON,
                        2.013433775: "The sign is what it is all about: a motor that pulls the wrong way gives Z < 0.",
                    },
                ),
            ),
            hint="What is the work of one interval, and with which sign does it count? How large would such a sum be by chance?",
            matters="A test with random signs finds a swapped motor wire even while a hand moves the handle.",
        ),
        Exercise(
            "force_full",
            points=2,
            asks="the force at full duty [N], by least squares of F = F_0 + F_full duty^2",
            rtol=1e-4,
            cases=(
                Case(
                    SCALE,
                    7.013345881,
                    unit="N",
                    slips={
                        3.215756712: "That is the slope over the duty. On this driver the force grows with its square.",
                        715.16225: "The scale shows grams: a kilogram weighs 9.80665 N.",
                        0.71516225: "That is a mass, in kg: times 9.80665 it is a force.",
                        7.119022309: "The scale showed 2 g with the motor off: fit the offset F_0 as well.",
                        7013.345881: "Grams are not kilograms: a factor of 1e-3 is missing.",
                    },
                ),
            ),
            hint="Against which variable do the readings lie on a line? Which of its two numbers is asked for, in newtons?",
            matters="The program computes newtons, but the motor takes a duty. This number connects the two.",
        ),
        Exercise(
            "felt_stiffness",
            points=1,
            asks="the stiffness [N/m] of the best line F = k x through the origin",
            rtol=1e-5,
            cases=(
                Case(
                    {"x": [-0.012, -0.004, 0.0005, 0.006, 0.013], "F": [-3.55, -1.22, 0.18, 1.79, 3.91]},
                    298.809034908,
                    unit="N/m",
                    slips={
                        311.987178977: "The mean of F/x trusts the sample next to x = 0 most, where a small error of F "
                        "is a large one of F/x. Least squares trusts the samples far out.",
                        298.68522602: "That is the slope of a line with an offset; this one goes through the origin.",
                        0.003346261747: "Upside down: metres per newton is a compliance.",
                        317.142857143: "Sums of F and of x cancel from left to right; weigh each sample by its x.",
                    },
                ),
            ),
            hint="the k that makes sum((F - k x)^2) least",
            matters="A measured stiffness tests the sensor, the sign and the scale of the force together.",
        ),
        Exercise(
            "limits",
            points=2,
            asks="a dict with reach [m], force_step [N] and speed_step [m/s]",
            rtol=1e-5,
            cases=(
                Case(
                    {"k": 300.0, "metres_per_count": 12.8e-6, "force_max": 3.3, "T": 1e-3},
                    {"reach": 0.011, "force_step": 0.00384, "speed_step": 0.0128},
                    slips=(
                        ({"reach": 90.909090909}, "Upside down: reach is the x at which k x is the motor's largest force."),
                        ({"speed_step": 1.28e-8}, "A speed is a distance over a time: one count, in one period T."),
                    ),
                ),
                Case(
                    {"k": 1200.0, "metres_per_count": 742e-6, "force_max": 5.0, "T": 5e-4},
                    {"reach": 0.00416666667, "force_step": 0.8904, "speed_step": 1.484},
                ),
            ),
            hint="where does k x reach force_max? What does one count more do to k x? What speed is one count in one period?",
            matters=(
                "These three numbers limit every wall on this paddle: how deep it works, and how coarse its force "
                "and velocity are."
            ),
        ),
        Exercise(
            "discussion",
            kind="text",
            asks="what a wall does with swapped wires, and which protections end it, in 40 words or more",
            least_words=40,
        ),
    ),
)
