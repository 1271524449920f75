"""Public checks of lab 14: numbers to compare with, the letter of the choice, and the feedback to typical mistakes."""

from hapticlab.course.exercise import Case, Exercise, Lab

NO_ROOT = "That is felt/count, as if the whole jump were the amplitude. Compare the root mean squares of both shapes."
HALF = "You compared the amplitudes of both shapes. Compare their root mean squares, because the power decides."
TURNED = "The square root of 2 is on the wrong side: the sinusoid is larger than half the jump, so the wall may be stiffer."
NOT_LATE = "Your damper acts at once: the lag is missing. Only the part in phase with the velocity damps."
NO_TURN = "The angle needs radians: in the time of the lag, f times lag is a part of one turn."
SINE = "That is the part in phase with the position, which acts as a spring. A damper needs the part in phase with the velocity."
TWICE = "Half a period is already in late, so the 2 of 2/T must not stand there again."
DEGREES = "You converted to degrees or back. cos takes radians, and 2 pi f lag already is in radians."
LEAST_NOISE = "That is the one with the least noise. Of those that are quiet and cheap enough, return the one with the least lag."
RMS = "The root mean square of the force is not its amplitude: a sinusoid of that power has an amplitude sqrt(2) times as large."
BUDGET = "That one takes more cycles than the budget allows."
RENUMBERED = "You counted among those that are left. Return the number in the list that was given."
THE_LAG = "That is the lag itself. Return the number of the estimator, 0 for the first."
SIGN = "The sign is wrong: 1/j is -j, so a spring has a negative imaginary part."
HERTZ = "You used f for omega. Multiply by 2 pi."
SIZE = "You used the magnitude of Z, which mixes spring and damper. The spring is in the imaginary part alone."
GAP = "You took the last value inside. A value at a lower frequency is outside already, so the hand has noticed by then."
OUTSIDE = "That is the first frequency outside. Return the one before it, or 0 if there is none."
ALL = "At that stiffness all damping is lost. A hand notices a part of it, the Weber fraction."
VIRTUAL = "The ideal wall has its own damping B, and the hand compares with the sum of both."
COMPLEMENT = "That loses all but the Weber fraction. The loss itself may be the Weber fraction."

LAGS, NOISES, CYCLES = [0.0005, 0.0044, 0.002, 0.0011], [0.0082, 0.0013, 0.0021, 0.003], [933.0, 1387.0, 6405.0, 1965.0]

LAB = Lab(
    number="14",
    title="How good is your paddle?",
    minutes=120,
    exercises=(
        Exercise("prediction_stiffest", kind="prediction", asks="the stiffest wall without oscillation and buzz [N/m]"),
        Exercise("prediction_first", kind="prediction", asks="which border comes first, oscillation or buzz"),
        Exercise("prediction_filter", kind="prediction", asks="whether a filter makes the range wider or narrower, and when"),
        Exercise(
            "buzz_border",
            points=1,
            asks="the stiffness [N/m] at which one count [m] buzzes with the amplitude felt [N]",
            cases=(
                Case(
                    {"count": 2e-5, "felt": 0.05},
                    3535.53391,
                    unit="N/m",
                    slips={2500.0: NO_ROOT, 5000.0: HALF, 1767.76695: TURNED},
                ),
                Case(
                    {"count": 1e-4, "felt": 0.1},
                    1414.21356,
                    unit="N/m",
                    slips={1000.0: NO_ROOT, 2000.0: HALF, 707.106781: TURNED},
                ),
            ),
            hint="How large is the jump of the force over one count? Which root mean square has it, and which has a sinusoid?",
            matters="This border depends on the encoder alone: neither damping nor a faster computer moves it.",
        ),
        Exercise(
            "border",
            points=2,
            asks="the stiffness [N/m] at which the total damping is zero",
            cases=(
                Case(
                    {"b": 1.1, "B": 2.0, "late": 5e-4, "f": 40.0, "gain": 0.7, "lag": 5e-3},
                    3065.24758,
                    unit="N/m",
                    slips={
                        5000.0: NOT_LATE,
                        4944.18642: NO_TURN,
                        4862.95825: SINE,
                        6130.4951684994: TWICE,
                        4999.3265814: DEGREES,
                        3578.92511: "The gain is missing: the estimate has gain times the amplitude of the true velocity.",
                    },
                ),
                Case(
                    {"b": 1.1, "B": 1.0, "late": 1e-3, "f": 25.0, "gain": 0.8, "lag": 0.015},
                    534.314575,
                    unit="N/m",
                    slips={1900.0: NOT_LATE, 1068.62915: TWICE},
                ),
            ),
            hint="Which part of the damper's force points against the velocity after the handle has turned on by 2 pi f lag?",
            matters="A late damper damps less, and one that is late by more than a quarter of a cycle drives the oscillation.",
        ),
        Exercise(
            "choose",
            points=2,
            asks="the number of the estimator with the smallest lag [s] that is quiet and cheap enough, or -1",
            cases=(
                Case(
                    {"lag": LAGS, "noise": NOISES, "cycles": CYCLES, "B": 10.0, "felt": 0.05, "most_cycles": 16000.0},
                    3.0,
                    slips={1.0: LEAST_NOISE, 2.0: RENUMBERED, 0.0011: THE_LAG, 0.0: "That one is felt: its noise is too large."},
                ),
                Case(
                    {"lag": LAGS, "noise": NOISES, "cycles": CYCLES, "B": 15.0, "felt": 0.05, "most_cycles": 4000.0},
                    1.0,
                    slips={3.0: RMS, 2.0: BUDGET, 0.0: RENUMBERED},
                ),
                Case(
                    {"lag": LAGS[:2], "noise": NOISES[:2], "cycles": CYCLES[:2], "B": 40.0, "felt": 0.05, "most_cycles": 4000.0},
                    -1.0,
                ),
            ),
            hint="Which estimators are quiet and cheap enough? Which of these has the smallest lag, and which number has it?",
            matters="No estimator is best for all paddles: encoder, damping and board decide together.",
        ),
        Exercise(
            "when_a_filter_helps",
            kind="choice",
            points=1,
            asks="when a filtered velocity widens the Z-width: a, b, c or d",
            options={
                "a": "always, because less noise is more stable",
                "b": "where the buzz of the damper is the lower border",
                "c": "never, because a lag takes away damping",
                "d": "where the paddle has much dry friction",
            },
            cases=(
                Case(
                    {},
                    "b",
                    slips={
                        "a": "Look at the damping at which nothing buzzes: no filtered wall is stiffer there, as it is late.",
                        "c": "Look at a damping at which the backward difference buzzes: what is the lower border there?",
                        "d": "Friction holds a handle between two counts, so it removes the buzz that a filter would remove.",
                    },
                ),
            ),
            hint="Which border is the lower one at small damping, and which at large damping? Which one does a filter raise?",
            matters="Measure first which border limits you: a remedy for the other border only costs.",
        ),
        Exercise(
            "effective",
            points=2,
            asks='{"stiffness": [N/m], "damping": [N s/m]} from the parts of Z [N s/m] at f [Hz]',
            cases=(
                Case(
                    {"f": [2.0, 20.0], "real": [1.0, -0.5], "imaginary": [-12.0, -1.2]},
                    {"stiffness": (150.796447, 150.796447), "damping": (1.0, -0.5)},
                    slips=(
                        ({"stiffness": (-150.796447, -150.796447)}, SIGN),
                        ({"stiffness": (24.0, 24.0)}, HERTZ),
                        ({"stiffness": (151.319159, 163.362818)}, SIZE),
                    ),
                ),
            ),
            hint="Write Z of the ideal wall as a real and an imaginary part. Which constant is in which part?",
            matters="With these two numbers you can compare a rendered wall with a spring and a damper that you know.",
        ),
        Exercise(
            "same_up_to",
            points=1,
            asks="the highest frequency [Hz] up to which no value is outside the Weber fraction, or 0",
            cases=(
                Case(
                    {"f": [2.0, 5.0, 10.0, 20.0, 50.0], "off": [0.02, 0.05, 0.25, 0.1, 0.4], "weber": 0.23},
                    5.0,
                    unit="Hz",
                    slips={20.0: GAP, 10.0: OUTSIDE},
                ),
                Case({"f": [3.0, 6.0], "off": [0.3, 0.1], "weber": 0.23}, 0.0, unit="Hz", slips={6.0: GAP, 3.0: OUTSIDE}),
                Case({"f": [3.0, 6.0], "off": [0.03, 0.1], "weber": 0.23}, 6.0, unit="Hz"),
            ),
            hint="Where is the first value outside? What do you return if it is the first of all, or if there is none?",
            matters="This frequency says how fast a motion may be before a hand feels the computer in the wall.",
        ),
        Exercise(
            "same_damping",
            points=1,
            asks="the stiffness [N/m] whose loss of damping is just not noticed",
            cases=(
                Case(
                    {"b": 0.1, "B": 0.2, "late": 5e-4, "weber": 0.34},
                    204.0,
                    unit="N/m",
                    slips={600.0: ALL, 68.0: VIRTUAL, 396.0: COMPLEMENT},
                ),
                Case({"b": 0.15, "B": 0.0, "late": 1e-3, "weber": 0.2}, 30.0, unit="N/m", slips={150.0: ALL, 120.0: COMPLEMENT}),
            ),
            hint="How much damping does a wall of stiffness K take away? Which part of all the damping may be lost?",
            matters="For damping, a hand is stricter than the guarantee of Eq. (23.10), by the Weber fraction.",
        ),
        Exercise("discussion", kind="text", least_words=80, asks="your discussion, 80 words or more"),
    ),
)
