"""Public checks of lab 16: numbers to compare with, the letter of the choice, and the feedback to typical mistakes."""

from hapticlab.course.exercise import Case, Exercise, Lab

NO_MEMORY = "Your machine has no memory: between x_off and x_on it must keep the state of the last sample, s(n-1)."
SWAPPED = "The thresholds are swapped. The switch goes down above x_on, the higher one, and comes up below x_off."
LATE = "Your force uses s(n-1), so it changes one sample late. The state of this sample, s(n), is known: use it in the force."
SIGN = "The sign of d is wrong. In the state 1 the force is k (x - d), less than before for d > 0."
TRIANGLE = "That is a triangle. The loop is a parallelogram: both of its sides jump by k d, at x_on and at x_off."
LOST_SIGN = (
    "The sign is wrong. The hand pays on the way in and is paid on the way out; for d > 0 the way in has the larger force."
)
NO_HYSTERESIS = "You took the whole way up to x_on. Below x_off both ways have the same force, so only x_on - x_off counts."
SPRING = "That is the energy of the spring between the thresholds. It is returned; only the difference of the two ways is lost."
TOO_EARLY = (
    "Your load moves too early. First the tooth crosses half the play, then it compresses the flank until the force is F_c."
)
ORDER = "Max and Min are exchanged, so your load always follows at a fixed distance. Write Max(x - w, Min(x + w, h(n-1)))."
RETURNS = "Your load goes back to 0 by itself. It stays where it was, so h(n-1) must be inside Min and Max."
WHOLE_GAP = "You used the whole play on each side. In its middle the tooth has g/2 to either side."
NO_PLAY = "The load does not move over the whole stroke: the play and the spring of the flanks take a part of it."
NO_WIND_UP = "You left out the compression of the flanks. It changes from -F_c/k to F_c/k before the load moves."
ONE_WIND_UP = (
    "You took F_c/k once. After a reversal the force goes from F_c to 0 and then to -F_c, so the tooth moves twice as far."
)
STUCK = "For a small stroke the load does not move and nothing is lost. The result cannot be negative."
ONE_WAY = "That is one direction. A cycle goes there and back."
HEATING = "That is the time of heating. Add the time of cooling."
COOLING = "That is the time of cooling. Add the time of heating."
FROM_ROOM = "You heated from the temperature of the room. In the cycle, heating begins at the lower threshold."
LOG_TEN = "Use the natural logarithm: an exponential solves the equation of first order."
SYMMETRIC = "You took heating to last as long as cooling. Heating goes towards hot and not away from 0."
LINEAR = "You took the rates as constant. They change within the band, so solve the exponential for the time."
SET_WINS = "In your latch the set wins where both inputs are 1. Ask for the reset first."
FORGETS = "Your latch forgets. If neither input is 1, it keeps its state."
TOGGLES = "A set input makes the state 1, whatever it was. Yours changes the state to the opposite one."
NOT_WHOLE = "The sensor reads whole counts only. Count the multiples of a count between the thresholds."
ROUNDED = "The width alone does not decide: where the thresholds lie between two counts matters too. Use floor and ceil."
ONE_SHORT = "One too few: from the count m to the count M there are M - m + 1 readings."
FLOORS = "The first reading in the band is the multiple at or above x_off, so round x_off / count up."

LAB = Lab(
    number="16",
    title="Machines that remember",
    minutes=110,
    exercises=(
        Exercise("prediction_gives", kind="prediction", asks="which button gives energy to the hand: A, B, both or none"),
        Exercise("prediction_rate", kind="prediction", asks="how often the relay without a band switches on per second"),
        Exercise(
            "switch",
            kind="scene",
            points=2,
            asks="a scene with the force k (x - d s), with k, d, x_on, x_off and the state s",
            cases=(
                Case(
                    {
                        "x": [0.0, 0.003, 0.006, 0.0075, 0.009, 0.0105, 0.0075, 0.0065, 0.0055, 0.007, 0.0079, 0.0085, 0.004],
                        "values": {"k": 200.0, "d": 0.003, "x_on": 0.008, "x_off": 0.006},
                    },
                    (0.0, 0.6, 1.2, 1.5, 1.2, 1.5, 0.9, 0.7, 1.1, 1.4, 1.58, 1.1, 0.8),
                    unit="N",
                    slips={
                        (0.0, 0.6, 1.2, 1.5, 1.2, 1.5, 1.5, 1.3, 1.1, 1.4, 1.58, 1.1, 0.8): NO_MEMORY,
                        (0.0, 0.6, 1.2, 0.9, 1.2, 1.5, 0.9, 0.7, 1.1, 0.8, 0.98, 1.1, 0.8): SWAPPED,
                        (0.0, 0.6, 1.2, 1.5, 1.8, 1.5, 0.9, 0.7, 0.5, 1.4, 1.58, 1.7, 0.2): LATE,
                        (0.0, 0.6, 1.2, 1.5, 2.4, 2.7, 2.1, 1.9, 1.1, 1.4, 1.58, 2.3, 0.8): SIGN,
                    },
                ),
                Case(
                    {
                        "x": [0.004, 0.0066, 0.005, 0.0071, 0.0066, 0.0064, 0.006, 0.0051, 0.0049, 0.006],
                        "values": {"k": 120.0, "d": -0.002, "x_on": 0.007, "x_off": 0.005},
                    },
                    (0.48, 0.792, 0.6, 1.092, 1.032, 1.008, 0.96, 0.852, 0.588, 0.72),
                    unit="N",
                    slips={
                        (0.48, 0.792, 0.6, 1.092, 0.792, 0.768, 0.72, 0.612, 0.588, 0.72): NO_MEMORY,
                        (0.48, 1.032, 0.6, 1.092, 1.032, 1.008, 0.96, 0.852, 0.588, 0.96): SWAPPED,
                        (0.48, 0.792, 0.6, 0.852, 1.032, 1.008, 0.96, 0.852, 0.828, 0.72): LATE,
                        (0.48, 0.792, 0.6, 0.612, 0.552, 0.528, 0.48, 0.372, 0.588, 0.72): SIGN,
                    },
                ),
            ),
            hint="In which state is the switch above x_on, below x_off and between them? What does it start with?",
            matters="State, transition and output: every machine in this lab has this form.",
        ),
        Exercise(
            "lost",
            points=1,
            asks="the energy [J] that the hand loses in one press and release",
            cases=(
                Case(
                    {"k": 200.0, "d": 0.003, "x_on": 0.008, "x_off": 0.006},
                    0.0012,
                    unit="J",
                    slips={0.0006: TRIANGLE, -0.0012: LOST_SIGN, 0.0048: NO_HYSTERESIS, 0.0028: SPRING},
                ),
                Case(
                    {"k": 120.0, "d": -0.002, "x_on": 0.007, "x_off": 0.004},
                    -0.00072,
                    unit="J",
                    slips={-0.00036: TRIANGLE, 0.00072: LOST_SIGN, -0.00168: NO_HYSTERESIS, 0.00198: SPRING},
                ),
            ),
            hint="Draw the force over the position, there and back. Between which positions do the ways differ, and how much?",
            matters="The sense of the loop decides whether a machine takes energy from a hand or gives energy to it.",
        ),
        Exercise(
            "gear",
            kind="scene",
            points=1,
            asks="a scene with the force of the flanks, with k, F_c, g and the load's position h, which starts at x(n)",
            cases=(
                Case(
                    {
                        "x": [0.0, 0.001, 0.0025, 0.004, 0.008, 0.007, 0.005, 0.0035, 0.002, -0.002, -0.001, 0.003, 0.006],
                        "values": {"k": 200.0, "F_c": 0.2, "g": 0.004},
                    },
                    (0.0, 0.0, 0.1, 0.2, 0.2, 0.0, 0.0, 0.0, -0.2, -0.2, 0.0, 0.0, 0.2),
                    unit="N",
                    slips={
                        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0): TOO_EARLY,
                        (0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2): ORDER,
                        (0.0, 0.0, 0.1, 0.2, 0.2, 0.2, 0.2, 0.2, 0.0, 0.0, 0.0, 0.2, 0.2): RETURNS,
                        (0.0, 0.0, 0.1, 0.4, 0.6, 0.4, 0.0, 0.0, 0.0, -0.6, -0.4, 0.0, 0.2): WHOLE_GAP,
                    },
                ),
                Case(
                    {
                        "x": [0.002, 0.0, -0.002, -0.004, -0.003, 0.0, 0.001, 0.002],
                        "values": {"k": 100.0, "F_c": 0.1, "g": 0.002},
                    },
                    (0.0, -0.1, -0.1, -0.1, 0.0, 0.1, 0.1, 0.1),
                    unit="N",
                    slips={
                        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0): TOO_EARLY,
                        (0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1): ORDER,
                        (0.1, 0.0, -0.1, -0.1, -0.1, 0.0, 0.0, 0.1): RETURNS,
                        (0.0, -0.1, -0.2, -0.2, -0.1, 0.0, 0.1, 0.2): WHOLE_GAP,
                    },
                ),
            ),
            hint="How far may the tooth be from the load, on either side, before the load moves?",
            matters="The state is a position here. Backlash needs one line, and no mass.",
        ),
        Exercise(
            "gear_lost",
            points=1,
            asks="the energy [J] that the hand loses per cycle",
            rtol=1e-5,
            cases=(
                Case(
                    {"F_c": 0.2, "k": 200.0, "g": 0.004, "X": 0.01},
                    0.0056,
                    unit="J",
                    slips={0.008: NO_PLAY, 0.0064: NO_WIND_UP, 0.006: ONE_WIND_UP, 0.0028: ONE_WAY},
                ),
                Case(
                    {"F_c": 0.3, "k": 100.0, "g": 0.004, "X": 0.004},
                    0.0,
                    unit="J",
                    slips={0.0048: NO_PLAY, 0.0024: NO_WIND_UP, 0.0006: ONE_WIND_UP, -0.0012: STUCK},
                ),
            ),
            hint="How far does the load move in each direction? Which force does friction need there?",
            matters="Play alone costs no energy. The friction of the load does, and play even makes the loss smaller.",
        ),
        Exercise(
            "period",
            points=2,
            asks="the period [s] of the thermostat",
            rtol=1e-5,
            cases=(
                Case(
                    {"tau": 0.5, "hot": 50.0, "low": 19.0, "high": 21.0},
                    0.0833874165,
                    unit="s",
                    slips={
                        0.0333456872: HEATING,
                        0.322405317: FROM_ROOM,
                        0.0500417293: COOLING,
                        0.0362146949: LOG_TEN,
                        0.100083459: SYMMETRIC,
                        0.0833333333: LINEAR,
                    },
                ),
                Case(
                    {"tau": 2.0, "hot": 40.0, "low": 20.0, "high": 30.0},
                    2.19722458,
                    unit="s",
                    slips={
                        1.38629436: HEATING,
                        3.58351894: FROM_ROOM,
                        0.810930216: COOLING,
                        0.954242509: LOG_TEN,
                        1.62186043: SYMMETRIC,
                        2.13333333: LINEAR,
                    },
                ),
            ),
            hint="Where does the temperature tend to while the heater is on? How long does it take from low to high?",
            matters="The band sets the period, and a band of zero would set it to zero: then the samples decide.",
        ),
        Exercise(
            "latch",
            points=1,
            asks="the states of the latch, one a sample, as a list of 0 and 1",
            cases=(
                Case(
                    {"set": [0, 1, 0, 0, 1, 0, 1, 1, 0, 1], "reset": [0, 0, 0, 1, 1, 0, 0, 1, 0, 0], "q": 1},
                    (1, 1, 1, 0, 0, 0, 1, 0, 0, 1),
                    slips={
                        (1, 1, 1, 0, 1, 1, 1, 1, 1, 1): SET_WINS,
                        (0, 1, 0, 0, 0, 0, 1, 0, 0, 1): FORGETS,
                        (1, 0, 0, 0, 1, 1, 0, 1, 1, 0): TOGGLES,
                    },
                ),
                Case(
                    {"set": [0, 1, 1, 0, 0], "reset": [1, 1, 0, 1, 0], "q": 1},
                    (0, 0, 1, 0, 0),
                    slips={(0, 1, 1, 0, 0): SET_WINS, (0, 1, 0, 0, 0): TOGGLES},
                ),
            ),
            hint="Which input do you ask for first? What is the state if neither is 1?",
            matters="Where two inputs disagree, the order of the questions is part of the design. For a motor, off must win.",
        ),
        Exercise(
            "remembered",
            points=1,
            asks="the number of readings at which the machine keeps its state",
            cases=(
                Case(
                    {"x_off": 0.00605, "x_on": 0.00641, "count": 0.0001}, 4, slips={3.6: NOT_WHOLE, 3.0: ONE_SHORT, 5.0: FLOORS}
                ),
                Case(
                    {"x_off": 0.00602, "x_on": 0.00608, "count": 0.0001}, 0, slips={0.6: NOT_WHOLE, 1.0: ROUNDED, -1.0: ONE_SHORT}
                ),
            ),
            hint="Which is the first multiple of a count at or above x_off, and which is the last one at or below x_on?",
            matters="A band that contains no reading is no memory, however exact its numbers look.",
        ),
        Exercise(
            "gives",
            kind="choice",
            points=1,
            asks="which machine gives energy to a slow hand: a, b, c or d",
            options={
                "a": "a magnet that pulls the handle in once it was beyond 8 mm, until it is back below 6 mm",
                "b": "a gear with play, whose load has dry friction",
                "c": "a guard that pushes the handle out once it was beyond 8 mm, until it is back below 6 mm",
                "d": "a cushion that pushes the handle out wherever it is beyond 8 mm",
            },
            cases=(
                Case(
                    {},
                    "c",
                    slips={
                        "a": "On the way from 6 to 8 mm the magnet does not help, and on the way back it pulls against the hand.",
                        "b": "Friction opposes the load in both directions. The hand pays in both.",
                        "d": "The cushion has no memory: both ways have the same force, so the loop has no area.",
                    },
                ),
            ),
            hint="Draw both ways. On which of them is the force larger?",
            matters="No viscous damper makes such a machine passive, because it takes nothing from a hand that is slow enough.",
        ),
        Exercise("discussion", kind="text", least_words=80, asks="your discussion, 80 words or more"),
    ),
)
