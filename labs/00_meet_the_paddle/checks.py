"""Public checks of lab 00: numbers, the letter of the choice, and the sentences that teach; no formulas of an answer."""

from hapticlab.course.exercise import Case, Exercise, Lab

TOSSES = {"asked": [0.5, -0.4, 0.3, -0.5, 0.2, 0.45], "on": [1, 1, 0, 0, 1, 0]}
NO_COINS = "The signs of the coins are missing: e is +1 where the spring was on and -1 where it was off."
ONLY_ON = (
    "You left out the intervals without the spring. They count with e = -1; without them the work of the hand "
    "does not average out."
)
SCALE = {"duty": [0, 0.237, 0.335, 0.411, 0.474], "grams": [2, 42, 82, 122, 163]}
#: J = 3 mm/rad, 10 N/A, at most 2 A
DRIVE = {"drum": 0.004, "sector": 0.08, "handle": 0.06, "torque_constant": 0.03, "supply": 12.0, "resistance": 6.0}
UPSIDE_DOWN = (
    "The ratio of the radii is upside down. The drum is smaller than the sector, so it turns further than the handle and needs "
    "less torque."
)
RIM = "The fingers hold the handle at r_h, not at the rim of the sector. The Jacobian is r_d r_h/r_s."

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
                        (-0.043709571, 0.000290429, 0.01210121, 0.044290429): (
                            "You used the zero of the sensor, which is wherever the paddle was switched on. Measure "
                            "from the middle between the two stops."
                        ),
                        (0.0, 0.044, 0.055810781, 0.088): "That is the distance from the left stop. x = 0 is the middle.",
                        (-0.022, 0.0, 0.005905391, 0.022): (
                            "That is half as large as expected. Both travel and right - left are measured from stop "
                            "to stop, so one count is travel / (right - left)."
                        ),
                    },
                ),
                Case(
                    {"counts": [4100, 2600, 100], "left": 4100.0, "right": 100.0, "travel": 0.08},
                    [-0.04, -0.01, 0.04],
                    unit="m",
                    slips={
                        (0.04, 0.01, -0.04): (
                            "In this case the counts decrease to the right, but x must still grow to the right. "
                            "Keep the sign of right - left; do not take its absolute value."
                        ),
                        (0.0, 0.03, 0.08): "That is the distance from the left stop. x = 0 is the middle.",
                    },
                ),
            ),
            hint="How many metres is one count, with its sign? What does the sensor read in the middle?",
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
                "b": "in a direction that depends on how the handle moves",
                "c": "to the left, out of the wall",
            },
            cases=(
                Case(
                    {},
                    "c",
                    slips={
                        "a": (
                            "F is the force on the wall and points into the wall. The wall, and so the motor, "
                            "pushes the handle back."
                        ),
                        "b": "The force of a spring depends on the position alone, not on the velocity.",
                    },
                ),
            ),
            hint="What does F push, the wall or the handle? What does the motor stand for (Fig. 23.5)?",
            matters=(
                "Every lab uses this sign convention. With one sign wrong, the motor supplies energy where a wall should resist."
            ),
        ),
        Exercise(
            "sign_evidence",
            points=1,
            asks="Z, the sum of the signed work of all intervals over the root of the sum of its squares",
            rtol=1e-5,
            cases=(
                Case(
                    {**TOSSES, "moved": [0.0020, -0.0016, -0.0007, 0.0012, 0.0005, -0.0010]},
                    2.107560737,
                    slips={
                        0.337209718: NO_COINS,
                        1.222385227: ONLY_ON,
                        0.003: (
                            "That is W, in joules. Divide it by the root of the sum of squares, so that it can "
                            "be compared with chance."
                        ),
                        0.00122474487: (
                            "You divided by the root of the number of intervals. Divide by the root of the sum "
                            "of (asked*moved)^2."
                        ),
                    },
                ),
                Case(
                    {**TOSSES, "moved": [-0.0010, 0.0016, 0.0007, -0.0022, 0.0, 0.0012]},
                    -2.013433775,
                    slips={
                        0.478106348: NO_COINS,
                        -0.767663714: ONLY_ON,
                        2.013433775: (
                            "The sign is wrong. Z must be negative for a motor that pulls in the wrong "
                            "direction, so keep its sign."
                        ),
                    },
                ),
            ),
            hint="What is the work in one interval, and with which sign does it count? How large would such a sum be by chance?",
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
                        3.215756712: (
                            "That is the slope over the duty. With this driver the force grows with the square of the duty."
                        ),
                        715.16225: "That is still in grams. Convert the readings to newtons: 1 kg weighs 9.80665 N.",
                        0.71516225: "That is a mass in kg. Multiply it by 9.80665 N/kg to get a force.",
                        7.119022309: "The scale showed 2 g while the motor was off. Fit the offset F_0 as well.",
                        7013.345881: "The readings are in grams, not in kilograms, so a factor of 1e-3 is missing.",
                    },
                ),
            ),
            hint="Over which variable do the readings lie on a line? Which constant of this line does the question ask for?",
            matters="The program computes newtons, but the motor takes a duty. This number connects the two.",
        ),
        Exercise(
            "motor_current",
            points=1,
            asks="the current [A] for each force at the handle [N], within what the supply can drive",
            rtol=1e-5,
            cases=(
                Case(
                    {"force": [0.5, -2.0], **DRIVE},
                    [0.05, -0.2],
                    unit="A",
                    slips={
                        (2.0, -2.0): UPSIDE_DOWN,
                        (20.0, -80.0): UPSIDE_DOWN,
                        (0.088888889, -0.355555556): RIM,
                        (0.066666667, -0.266666667): RIM,
                        (1.0, -4.0): "That is the torque at the pivot. The drum is smaller than the sector: multiply by r_d/r_s.",
                        (1.0, -2.0): "That is the torque at the pivot. The drum is smaller than the sector: multiply by r_d/r_s.",
                        (0.0015, -0.006): "That is the torque in N m. The torque constant k_t is torque per ampere.",
                        (
                            4.5e-5,
                            -1.8e-4,
                        ): "You multiplied by k_t. The torque is k_t times the current, so divide the torque by k_t.",
                        (0.3, -1.2): "That is the voltage R i. The question asks for the current.",
                        (0.05, 0.2): "A negative force needs a negative current. Keep the sign.",
                    },
                ),
                Case(
                    {"force": [-40.0, 10.0, 25.0], **DRIVE},
                    [-2.0, 1.0, 2.0],
                    unit="A",
                    slips={
                        (
                            -4.0,
                            1.0,
                            2.5,
                        ): "The supply drives at most V/R through the winding, however large the force is that you ask for.",
                        (-4.0, 1.0, 2.0): "The limit V/R holds for both signs of the current.",
                        (-12.0, 1.0, 12.0): "A current is limited by V/R, in amperes. V is a voltage.",
                    },
                ),
            ),
            hint="Which torque does the force need at the drum, and which current makes this torque? What limits the current?",
            matters="Every force that you feel is a current. Where the current ends, the wall ends.",
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
                        311.987178977: (
                            "That is the mean of F/x. It gives the sample next to x = 0 the same weight, although a "
                            "small error of F there is a large error of F/x. Least squares gives more weight to "
                            "large x."
                        ),
                        298.68522602: "That is the slope of a line with an offset. The line F = k x goes through the origin.",
                        0.003346261747: "That is upside down: metres per newton is a compliance.",
                        317.142857143: (
                            "In the sums of F and of x, the samples on the left and on the right cancel. "
                            "Multiply each sample by its x first."
                        ),
                    },
                ),
            ),
            hint="Which k makes sum((F - k x)^2) smallest? What is its derivative with respect to k there?",
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
                        (
                            {"reach": 90.909090909},
                            "That is upside down: reach is the x at which k x equals the largest force of the motor.",
                        ),
                        ({"speed_step": 1.28e-8}, "A speed is a distance divided by a time: one count divided by one period T."),
                    ),
                ),
                Case(
                    {"k": 1200.0, "metres_per_count": 742e-6, "force_max": 5.0, "T": 5e-4},
                    {"reach": 0.00416666667, "force_step": 0.8904, "speed_step": 1.484},
                ),
            ),
            hint=(
                "Where does k x reach force_max, and by how much does one more count change k x? What speed is "
                "one count per period?"
            ),
            matters=(
                "These three numbers limit every wall on this paddle: its depth, and how coarse its force and velocity are."
            ),
        ),
        Exercise(
            "discussion",
            kind="text",
            asks="what the handle does at a wall with swapped wires, and which protections end it, in 40 words or more",
            least_words=40,
        ),
    ),
)
