"""Public checks of lab 09: numbers to compare with, letters of the choices, and the feedback to typical mistakes."""

from hapticlab.course.exercise import Case, Exercise, Lab

#: a handle that coasts, one sample every 2 ms [m]; counts of 12.8 um
COASTING = (
    0.0, 0.0007936, 0.0015872, 0.0023424, 0.0030848, 0.00384, 0.0045568, 0.0052736, 0.0059648, 0.006656, 0.0073344, 0.008,
    0.00864, 0.00928, 0.0098816, 0.0105216, 0.0110976, 0.0116992, 0.0122624, 0.0128256, 0.013376, 0.0139264, 0.0144512,
    0.014976, 0.015488, 0.0159616, 0.0164608, 0.0169216, 0.0173952, 0.0178304, 0.0182912, 0.0187264, 0.019136, 0.0195584,
    0.0199552, 0.020352, 0.020736, 0.0210944, 0.0214656, 0.0218112, 0.0221696, 0.0225024, 0.0228096, 0.0231296, 0.0234368,
    0.0237312, 0.0240256, 0.0243072, 0.0245888, 0.024832, 0.025088, 0.025344, 0.0255616, 0.0258048, 0.0260224, 0.02624,
    0.026432, 0.0266368, 0.026816, 0.0269952, 0.0271744, 0.0273408, 0.0274944, 0.027648, 0.0277888, 0.0279168, 0.0280448,
    0.0281728, 0.0282752, 0.0283776, 0.0284928, 0.0285696,
)  # fmt: skip
TIMES = tuple(round(0.002 * i, 3) for i in range(len(COASTING)))

TWICE = (
    "That is the result of differentiating twice. Each difference divides the counts by T, so the noise decides the answer. "
    "Integrate the equation of motion instead."
)
OTHER_END = (
    "That is the upper end. A guarantee must hold for every b in the interval, and the smallest b guarantees the least stiffness."
)
DEVICE = "That is the constant of handle and hand together. Subtract that of the handle."

LAB = Lab(
    number="09",
    title="Identify the paddle and your own hand",
    minutes=120,
    exercises=(
        Exercise("prediction_coasts", kind="prediction", asks="how far the handle coasts [mm]"),
        Exercise("prediction_slows", kind="prediction", asks="damping or friction, at 0.4 m/s and at 0.1 m/s"),
        Exercise("prediction_grip", kind="prediction", asks="the stiffness of your grip [N/m]"),
        Exercise(
            "coasting_speed",
            points=2,
            asks="the speed [m/s] of a coasting handle at the times t [s]",
            cases=(
                Case(
                    {"t": [0, 0.05, 0.1, 0.15, 0.3], "v0": 0.4, "m": 0.03, "b": 0.15, "coulomb": 0.05},
                    (0.4, 0.2377872, 0.1114558, 0.01306881, 0.0),
                    unit="m/s",
                    slips={
                        (0.4, 0.2377872, 0.1114558, 0.01306881, -0.1697045): (
                            "Your handle turns back and accelerates. Friction stops the handle and then holds it, so after the "
                            "stop the speed is 0."
                        ),
                        (0.4, 0.3115203, 0.2426123, 0.1889466, 0.08925206): (
                            "That is damping alone, which never stops a handle. The Coulomb friction is missing."
                        ),
                        (
                            0.4,
                            0.3166667,
                            0.2333333,
                            0.15,
                            0.0,
                        ): "That is friction alone, a straight line. The damping b is missing.",
                        (0.4, 0.3852534, 0.3737687, 0.3648244, 0.3482087): (
                            "Your speed approaches +coulomb/b. With v' = -(b v + coulomb)/m, v' = 0 at a negative speed."
                        ),
                    },
                ),
                Case(
                    {"t": [0, 0.1, 0.2], "v0": 0.3, "m": 0.166, "b": 0.057, "coulomb": 0.0},
                    (0.3, 0.2898736, 0.2800891),
                    unit="m/s",
                ),
            ),
            hint=(
                "Which speed does the handle approach, and how does the difference from this speed decay? What happens to the "
                "handle before it reaches this speed?"
            ),
            matters="Damping and dry friction slow a handle differently, so one coasting motion can separate them.",
        ),
        Exercise(
            "coast_fit",
            points=2,
            rtol=0.03,
            asks='{"b/m": [1/s], "coulomb/m": [m/s^2]} of a handle that coasts at positions x [m] at times t [s]',
            cases=(
                Case(
                    {"t": TIMES, "x": COASTING},
                    {"b/m": 5.000717, "coulomb/m": 1.499087},
                    slips=[
                        ({"b/m": 6.6043961, "coulomb/m": 1.2158733}, TWICE),
                        ({"b/m": 1.70638593, "coulomb/m": 2.22145303}, TWICE),
                        ({"b/m": 4.18624176, "coulomb/m": 1.71873286}, TWICE),
                        ({"b/m": 3.22725529, "coulomb/m": 1.87218129}, TWICE),
                        (
                            {"b/m": 0.01000143},
                            "The sum of positions is not an integral yet, because each trapezoid has the width t[1] - t[0].",
                        ),
                        ({"coulomb/m": 0.7495436}, "The factor 1/2 is missing. The column of gamma is -t^2/2."),
                    ],
                ),
            ),
            hint="What multiplies each of the four unknowns? How large is the integral at the first time?",
            matters=(
                "A fit of the integrated equation does not differentiate the counts, so the encoder disturbs the result far less."
            ),
        ),
        Exercise(
            "mass_and_friction",
            points=1,
            asks='{"m": [kg], "coulomb": [N]} from the force A [N] and the two accelerations [m/s^2]',
            cases=(
                Case(
                    {"A": 0.2, "rising": 8.0, "falling": 5.0},
                    {"m": 0.030769231, "coulomb": 0.046153846},
                    slips=[
                        (
                            {"m": 0.025},
                            (
                                "A/rising assumes that the motor is the only force. While the handle rises, friction "
                                "also slows it down."
                            ),
                        ),
                        (
                            {"m": 0.04},
                            (
                                "A/falling assumes that the motor is the only force. While the handle falls, friction "
                                "acts against the motor."
                            ),
                        ),
                        (
                            {"coulomb": 0.3},
                            "A (rising - falling)/2 is not a force. Multiply an acceleration by m, not by A, to get newtons.",
                        ),
                    ],
                ),
                Case({"A": 0.3, "rising": 10.0, "falling": 10.0}, {"m": 0.03, "coulomb": 0.0}),
            ),
            hint=(
                "Friction changes sides. In which combination of the two accelerations does friction cancel, and in "
                "which the motor?"
            ),
            matters="A known force gives the scale. Without it a recording shows only ratios such as b/m.",
        ),
        Exercise(
            "what_95_means",
            kind="choice",
            points=1,
            asks="what the interval states: a, b, c or d",
            options={
                "a": "b is inside with a probability of 95 %",
                "b": "95 % of the samples lie between the ends",
                "c": "b is known to 5 %",
                "d": "about 95 % of the intervals of many repetitions contain b",
            },
            cases=(
                Case(
                    {},
                    "d",
                    slips={
                        "a": (
                            "b does not vary: it is inside this interval, or it is not. The interval is random. Look at the "
                            "figure of 100 sensors again."
                        ),
                        "b": "The interval is a statement about b, in N s/m. The samples are positions, in m.",
                        "c": (
                            "95 % states how often the method contains the true value. The width of the interval "
                            "states how well b is known."
                        ),
                    },
                ),
            ),
            hint="What differs from bar to bar in the figure, and what stays the same?",
            matters="A limit on stiffness is only as certain as the damping from which you computed it.",
        ),
        Exercise(
            "promised_stiffness",
            points=1,
            asks="the largest K [N/m] that Eq. (23.10) guarantees for every b between b_low and b_high",
            cases=(
                Case(
                    {"b_low": 0.14, "b_high": 0.16, "T": 1e-3, "B": 0.0},
                    280.0,
                    unit="N/m",
                    slips={
                        320.0: OTHER_END,
                        300.0: "That is the middle of the interval. In half of all cases the true b guarantees less.",
                    },
                ),
                Case(
                    {"b_low": 0.14, "b_high": 0.16, "T": 1e-3, "B": -0.05},
                    180.0,
                    unit="N/m",
                    slips={
                        380.0: "A negative B does not add to the damping. Eq. (23.10) contains |B|.",
                        280.0: "B is missing. Eq. (23.10) is b > KT/2 + |B|.",
                        220.0: OTHER_END,
                    },
                ),
                Case(
                    {"b_low": 0.03, "b_high": 0.05, "T": 1e-3, "B": 0.04},
                    0.0,
                    unit="N/m",
                    slips={
                        -20.0: "No stiffness is guaranteed here, and a negative stiffness is not an answer. Return 0.",
                        20.0: OTHER_END,
                    },
                ),
            ),
            hint=(
                "Which b in the interval is the safe choice, and how much damping does B need, whatever its sign? "
                "What if nothing remains?"
            ),
            matters=(
                "A guarantee must hold for every value that the measurement allows, so a better measurement "
                "permits a stiffer wall."
            ),
        ),
        Exercise(
            "hand_constants",
            points=2,
            asks='{"m": [kg], "b": [N s/m], "k": [N/m]} of the hand alone',
            cases=(
                Case(
                    {"M": 0.05, "sigma": 11.0, "omega": 62.0, "m": 0.03, "b": 0.1},
                    {"m": 0.02, "b": 1.0, "k": 198.25},
                    slips=[
                        ({"m": 0.05}, DEVICE),
                        ({"b": 1.1}, DEVICE),
                        ({"b": 0.45}, "A factor 2 is missing: sigma = (b + b_h)/(2 M)."),
                        (
                            {"b": 0.34},
                            "The damper slows handle and hand together, so use M and not the mass of the hand.",
                        ),
                        (
                            {"k": 192.2},
                            (
                                "M omega^2 is slightly too small, because the damper lowers the frequency: omega^2 = "
                                "k_h/M - sigma^2."
                            ),
                        ),
                        ({"k": 79.3}, "The spring moves handle and hand together, so use M and not the mass of the hand."),
                    ],
                ),
            ),
            hint=(
                "Which mass oscillates, and which dampers slow it: of the hand, or of hand and handle? To which of "
                "them does the spring belong?"
            ),
            matters="Your hand is part of the loop, so its constants decide which walls are stable for you.",
        ),
        Exercise(
            "which_window",
            kind="choice",
            points=1,
            asks="which window to choose: a, b, c or d",
            options={"a": "40 ms", "b": "60 ms", "c": "100 ms", "d": "20 ms"},
            cases=(
                Case(
                    {},
                    "a",
                    slips={
                        "c": (
                            "A narrow interval can be wrong. At 100 ms the fit itself says that it does not explain "
                            "the recording."
                        ),
                        "b": (
                            "The fit explains the recording and is still wrong: compare its interval with the "
                            "true k. Residuals that "
                            "look like noise are no proof. You know from another source that the reflex begins at 40 ms."
                        ),
                        "d": (
                            "Before the reflex the model is right for every window, and each further sample adds "
                            "information. At "
                            "20 ms the interval for k is about ten times as wide as at 40 ms."
                        ),
                    },
                ),
            ),
            hint="Until when does the model describe the hand? Until then, what does a longer recording improve?",
            matters="The choice of the data is part of the measurement: another window gives another hand.",
        ),
        Exercise("discussion", kind="text", least_words=80, asks="your discussion, 80 words or more"),
    ),
)
