"""Public checks of lab 13: numbers to compare with, the letter of the choice, and the feedback to typical mistakes."""

from hapticlab.course.exercise import Case, Exercise, Lab

ONE_ROUND = "You stopped after one round. A state that was just added may use further states, so repeat until nothing is added."
BACKWARDS = (
    "You followed the table in the other direction and found the states that use those in the force. Ask instead which states "
    "the equation of a needed state contains."
)
ONLY_FORCE = "Those are only the states in the force itself. Their equations use other states, which are needed too."
NOT_ITSELF = "You left out the states in the force itself. They are needed first of all."
WHOLE = "You compared the whole recording as one window. A difference that lasts a tenth of a second is lost in a long mean."
MEANS = "You compared means. In a motion back and forth the mean is near zero, so use the root mean square."
SUMS = "You added both thresholds. The larger of the two decides: max(least, weber*rms(full))."
NO_LEAST = "The least force is missing. Where the full force is small, a hand does not notice a fraction of almost nothing."
NO_WEBER = "You divided by the least force alone. Where the full force is large, the difference must exceed a fraction of it."
SMALLER = "Weber's fraction is a fraction of the full force. You used the force of the smaller scene."
REMAINS = "The samples at the end that do not fill a window must be left out."
MEAN_OF_ALL = "That is the mean over all windows. One window in which the hand notices is enough, so return the largest."
FIRST = "That is the ratio of the first window. Return the largest of all windows."
PEAKS = "You compared peaks. The rule compares the root mean square over a window."
HERTZ = "Your omega is in hertz. It is 2 pi times the number of grooves per second."
STATIC = "That is the displacement by a constant force, A/k. At this frequency the mass resists far more than the spring."
SIGN = "The mass acts against the spring: k - m omega^2, with a minus sign."
MAGNITUDE = "Damper and mass are a quarter of a cycle apart. Take the magnitude of the complex number, not the sum of its parts."
NO_DAMPER = "The damping is missing in the denominator."
TWICE = "That is from peak to peak. The amplitude is half of it."
ONLY_LEAST = "You used only the least force. The difference must also be larger than the fraction weber of the full force."
ONLY_WEBER = "You used only Weber's fraction. The difference must also be larger than the least force that a hand feels."
LOWER = "Both conditions must hold, so the higher of the two speeds counts, not the lower one."
OF_DAMPER = "You compared with the force of the damper alone. The full force contains the drag as well: b v + c v^2."
LINEAR_DRAG = "The drag grows with the square of the speed: c v^2 = least, so take the square root."
BOTH_SPEEDS = "You added the two speeds. The higher of the two counts."
RESONANCE = "That is the resonance of the second mass on its spring. The difference is noticed long before it."
SECOND_ALONE = (
    "You compared the difference with the force of the second mass alone. Weber's fraction is a fraction of the force of both "
    "masses."
)
RADIANS = "That is in rad/s. Divide by 2 pi to get hertz."
OF_RIGID = "You compared with the force of the rigid scene. Weber's fraction is a fraction of the full force."
R_SQUARED = "You used r^2 in place of r. Take the square root first."
SMALL_R = "You left out 1 - r^2. Keep it in both forces; the result is as short."
FRONT_ONLY = "Your mass is the front one alone. One rigid mass has to be as heavy as both: m_1 + m_2."
BEHIND_ONLY = "Your mass is the second one alone. One rigid mass has to be as heavy as both: m_1 + m_2."
SERIES = "You combined the masses as if they were springs in series. Masses that move together add up."
NOTHING_LEFT_OUT = "This is still the scene with two masses. Write one coordinate, z, and one equation."
FROM_ZERO = "Your mass does not begin at the handle. Use the coordinate z that is defined above, with initial=x(n)."

LAB = Lab(
    number="13",
    title="Only what a scene requires",
    minutes=110,
    exercises=(
        Exercise("prediction_noticed", kind="prediction", asks="the letters of the scenes in which the hand notices it"),
        Exercise("prediction_saved", kind="prediction", asks="how much the cost of scene A falls [%]"),
        Exercise(
            "needed",
            points=2,
            asks="1 for each state that the force needs, 0 for each other",
            cases=(
                Case(
                    {
                        "uses": [[0, 1, 0, 0, 0], [0, 0, 1, 0, 0], [0, 0, 0, 0, 0], [1, 0, 0, 0, 1], [0, 0, 0, 1, 0]],
                        "force": [1, 0, 0, 0, 0],
                    },
                    (1, 1, 1, 0, 0),
                    slips={
                        (1, 1, 0, 0, 0): ONE_ROUND,
                        (1, 0, 0, 1, 1): BACKWARDS,
                        (1, 0, 0, 0, 0): ONLY_FORCE,
                        (0, 1, 1, 0, 0): NOT_ITSELF,
                    },
                ),
                Case(
                    {"uses": [[1, 0, 1], [1, 0, 0], [0, 0, 0]], "force": [0, 1, 0]},
                    (1, 1, 1),
                    slips={(1, 1, 0): ONE_ROUND, (0, 1, 0): ONLY_FORCE, (1, 0, 1): NOT_ITSELF},
                ),
            ),
            hint="Which states does the force contain? Which states do the equations of these states contain?",
            matters="What has no path to the force can be left out, and not one bit of the force changes.",
        ),
        Exercise(
            "felt_ratio",
            points=2,
            asks="the largest difference over its threshold, of all windows",
            rtol=1e-5,
            cases=(
                Case(
                    {
                        "full": [0.0, 0.1, 0.2, 0.1, 1.0, 1.2, 1.1, 0.9, -0.1, -0.2, 0.1, 0.0, 3.0],
                        "smaller": [0.02, 0.1, 0.25, 0.05, 1.05, 1.3, 1.0, 0.9, -0.05, -0.3, 0.1, 0.05, 1.0],
                        "least": 0.03,
                        "weber": 0.07,
                        "rows": 4,
                    },
                    2.041241452,
                    slips={
                        7.7946851: WHOLE,
                        0.170068027: MEANS,
                        1.587558751: SUMS,
                        7.142857143: NO_LEAST,
                        2.5: NO_WEBER,
                        9.523809524: REMAINS,
                        1.42688620: MEAN_OF_ALL,
                        1.22474487: FIRST,
                        3.33333333: PEAKS,
                    },
                ),
                Case(
                    {"full": [1.0, -1.0], "smaller": [1.2, -1.2], "least": 0.03, "weber": 0.1, "rows": 2},
                    2.0,
                    slips={0.0: MEANS, 1.538461538: SUMS, 6.666666667: NO_WEBER, 1.666666667: SMALLER},
                ),
            ),
            hint="What is the root mean square of one window? Which of the two thresholds is larger there?",
            matters="With this number a smaller model is a decision that you can defend, and not a matter of taste.",
        ),
        Exercise(
            "shaken",
            points=1,
            asks="the amplitude [m] with which the grooves shake handle and hand",
            rtol=1e-4,
            cases=(
                Case(
                    {"A": 0.012, "p": 1e-3, "speed": 0.05, "m": 0.05, "b": 1.1, "k": 200.0},
                    2.5277012e-6,
                    unit="m",
                    slips={
                        1.290248e-4: HERTZ,
                        6.0e-5: STATIC,
                        2.33171898e-6: SIGN,
                        2.36202925e-6: MAGNITUDE,
                        2.53442477e-6: NO_DAMPER,
                        5.0554024e-6: TWICE,
                    },
                ),
                Case(
                    {"A": 0.03, "p": 2e-3, "speed": 0.02, "m": 0.08, "b": 2.0, "k": 400.0},
                    1.983477963e-4,
                    unit="m",
                    slips={
                        7.64311986e-5: HERTZ,
                        7.5e-5: STATIC,
                        4.12783182e-5: SIGN,
                        1.42968546e-4: MAGNITUDE,
                        3.56410266e-4: NO_DAMPER,
                        3.96695593e-4: TWICE,
                    },
                ),
            ),
            hint="How many grooves pass in a second? What is omega at this frequency?",
            matters="A force that is too small to be felt as a force can be felt clearly as a vibration.",
        ),
        Exercise(
            "speed_noticed",
            points=1,
            asks="the speed [m/s] above which the missing drag is noticed",
            rtol=1e-5,
            cases=(
                Case(
                    {"b": 2.0, "c": 3.0, "least": 0.03, "weber": 0.07},
                    0.1,
                    unit="m/s",
                    slips={0.0501792115: LOWER, 0.0466666667: ONLY_WEBER, 0.01: LINEAR_DRAG, 0.150179211: BOTH_SPEEDS},
                ),
                Case(
                    {"b": 8.0, "c": 2.0, "least": 0.03, "weber": 0.1},
                    0.444444444,
                    unit="m/s",
                    slips={0.122474487: ONLY_LEAST, 0.4: OF_DAMPER, 0.566918932: BOTH_SPEEDS},
                ),
            ),
            hint="At which speed is c v^2 equal to the least force? At which speed is it the fraction weber of the full force?",
            matters="A term that grows faster than the others matters above some speed, so the motion of the hand decides.",
        ),
        Exercise(
            "highest_frequency",
            points=2,
            asks="the frequency [Hz] up to which one rigid mass is enough",
            rtol=1e-5,
            cases=(
                Case(
                    {"m_1": 0.08, "m_2": 0.1, "k": 200.0, "weber": 0.07},
                    2.458603202,
                    unit="Hz",
                    slips={
                        7.117625434: RESONANCE,
                        1.883146682: SECOND_ALONE,
                        15.44785952: RADIANS,
                        2.380955107: OF_RIGID,
                        0.849262126: R_SQUARED,
                        2.526506396: SMALL_R,
                    },
                ),
                Case(
                    {"m_1": 0.05, "m_2": 0.2, "k": 80.0, "weber": 0.1},
                    1.11158634,
                    unit="Hz",
                    slips={
                        3.183098862: RESONANCE,
                        1.006584242: SECOND_ALONE,
                        6.984302958: RADIANS,
                        1.061033034: OF_RIGID,
                        0.388182788: R_SQUARED,
                        1.125395395: SMALL_R,
                    },
                ),
            ),
            hint="What is the difference of the two forces? For which r^2 is it the fraction weber of the full force?",
            matters="Whether a stiff part may be rigid depends on a ratio of frequencies, not on the stiffness alone.",
        ),
        Exercise(
            "rigid",
            kind="scene",
            points=1,
            asks="a scene of one rigid mass m_1 + m_2 on the coupler K, b_c",
            cases=(
                Case(
                    {
                        "x": [0.01, 0.012, 0.012, 0.01, 0.006, 0.0, -0.004, -0.006],
                        "T": 0.01,
                        "method": "semi_implicit_euler",
                        "values": {"K": 150.0, "b_c": 0.3},
                    },
                    (0.0, 0.36, 0.2532, -0.172584, -0.86959392, -1.76270425, -2.03868195, -1.8094719),
                    unit="N",
                    slips={
                        (0.0, 0.36, 0.1596, -0.364056, -1.03807584, -1.65123174, -1.30322876, -0.297737333): FRONT_ONLY,
                        (0.0, 0.36, 0.2298, -0.224664, -0.92729448, -1.76525187, -1.88878276, -1.43159031): BEHIND_ONLY,
                        (0.0, 0.36, 0.0894, -0.478176, -1.06599096, -1.40770664, -0.651699923, 0.610631156): SERIES,
                        (0.0, 0.36, 0.1596, -0.299472, -0.84527928, -1.40024743, -1.2860586, -0.975698211): NOTHING_LEFT_OUT,
                        (1.5, 1.68, 1.2648, 0.435624, -0.71753088, -2.07286957, -2.77081454, -2.88191915): FROM_ZERO,
                    },
                ),
                Case(
                    {
                        "x": [0, 0.001, 0.003, 0.006, 0.01, 0.014, 0.017, 0.019],
                        "T": 0.01,
                        "method": "semi_implicit_euler",
                        "values": {"K": 200.0, "b_c": 0.5},
                    },
                    (0.0, 0.25, 0.654166667, 1.15430556, 1.68053241, 1.91181404, 1.63131109, 0.946816748),
                    unit="N",
                    slips={(0.0, 0.25, 0.5625, 0.80875, 0.896875, 0.5574375, -0.21853125, -1.01699063): FRONT_ONLY},
                ),
            ),
            hint="Which coordinate is left? Which mass moves with it?",
            matters="A smaller scene that you wrote is one that you can compare with the full one.",
        ),
        Exercise(
            "hides",
            kind="choice",
            points=1,
            asks="what follows for the grooves: a, b, c or d",
            options={
                "a": "leave them out for both handles: 12 mN is below the least force",
                "b": "keep them for both handles: the force differs at every sample",
                "c": "leave them out for the coarse handle in this motion, keep them for the fine one",
                "d": "the coarse handle is the better one: its scene is cheaper",
            },
            cases=(
                Case(
                    {},
                    "c",
                    slips={
                        "a": "The least force belongs to slow forces. At the fine handle the grooves are noticed as a vibration.",
                        "b": (
                            "The question is what the hand notices. At the coarse handle the steps of the encoder shake the hand "
                            "more than the grooves do."
                        ),
                        "d": "The encoder does not remove the vibration. It adds a stronger one, which hides the grooves.",
                    },
                ),
            ),
            hint="Compare the vibration of the grooves with the encoder's own, for each handle.",
            matters="What a scene requires depends on the hand, on its motion and on the paddle.",
        ),
        Exercise("discussion", kind="text", least_words=80, asks="your discussion, 80 words or more"),
    ),
)
