"""Public checks of lab 17: numbers to compare with, the letter of the choice, and the feedback to typical mistakes."""

from hapticlab.course.exercise import Case, Exercise, Lab

RATIO_ONCE = "You used N once. The lever multiplies the motion of m_2 by N and its reaction on m_1 by N again."
NO_RATIO = "You added the masses as if the lever had the ratio 1. The mass m_2 moves N times as far as m_1."
INVERSE_RATIO = "You used 1/N. The mass m_2 moves N times as far as m_1, not 1/N times."
ON_FIRST = "That is the reaction on m_1. The question is the reaction on m_2."
SLOW_SECOND = "You multiplied m_2 by the acceleration of m_1. The mass m_2 accelerates N times as much."
BALANCE = "That is F/N, as in a lever at rest. Here a part of F accelerates m_1 itself."
FIRST_ALONE = "You left out m_2, but the lever moves it with m_1."
FIRST_FIXED = "That is right if m_1 is fixed. The spring also moves m_1, which makes the stretch oscillate faster."
SPRING_RATIO_ONCE = (
    "You used N once. The spring pushes m_1 with N times its force, and the stretch counts the motion of m_1 N times."
)
SPRING_NO_RATIO = "Your masses are joined directly. The spring acts on z_2 - N z_1, and pushes m_1 through the lever."
SUM = "You added the masses. But two masses on one spring oscillate faster than the lighter one alone."
FELT_MASS = "You used the mass that F feels while the lever holds. On a spring the two masses move against each other."
OMEGA_ONE = "Your condition is omega T < 1. The square of the limit is 4, not 1."
OMEGA_ROOT = "You used 2 in place of 4. The condition omega T < 2 contains the square root of k."
THROUGH = "Your proxy enters the plate. It must stop at x_o."
ONE_SIDED = "Your plate is felt from one side only. A handle that starts behind the plate is held there."
NEAREST = "Your proxy changes sides. Decide the side at the first sample and keep it, whatever the handle does."
STUCK = "Your proxy stays on the plate. When the handle comes back, the proxy comes back with it."
DEPTH = "Those are the penetrations x - z. The question is the position of the proxy itself."
OTHER_SIDE = "Your proxy is on the wrong side. It starts at the handle and stays on that side."
NO_SLIP_MEMORY = (
    "Your spring always starts from the first position. The proxy has moved since then, so a reversal begins at the new position."
)
BY_SIGN = "That is friction by the sign of the motion. The proxy sticks: after a reversal the force changes gradually."
JUMPS = "Your proxy jumps to the handle when it slips, and the force falls to zero. It follows until the spring pulls with F_c."
HOLDS_THEN_JUMPS = "Your force is F_c in the sample of the slip, but then your proxy jumps to the handle. It stays F_c/K behind."
FORCE_SIGN = "The sign is wrong. The force on the environment is K (x - z), positive if the handle is ahead of the proxy."
ALL_SPRING = "Your proxy never slips. The force may not exceed F_c."
TRUE_FREQUENCY = "That is v/p, the frequency of the grating in the hand. Samples cannot show a frequency above 1/(2T)."
CLIPPED = "You limited the frequency to 1/(2T). A higher frequency does not stay at this limit. It comes out as a lower one."
MODULO = "You subtracted whole multiples of 1/T. The rest may still lie above 1/(2T)."
NYQUIST_MODULO = "You subtracted multiples of 1/(2T). The spectrum of samples repeats every 1/T."
FOLDED_ONCE = "You folded once, at 1/T. At this speed another multiple of 1/T is nearer."
SLOPE_OF_LINE = "You took A/p as the slope. A sine is steeper than that where it crosses zero."
DOUBLE = "Your condition is b = K T/4. The passive limit is K = 2b/T."
HALF = "Your condition is b = K T. The passive limit is K = 2b/T, with a factor of 2."
STIFFNESS = "That is the stiffness 2b/T. The question is the amplitude of the force."
NO_PITCH = "The pitch is missing. The slope of a finer grating is steeper."
NO_VIRTUAL = "The virtual body is missing. The impedance display adds its force to that of the device."
NO_DEVICE = "The mass of the device is missing. The impedance display does not hide it."
WITHOUT_FRICTION = "The dry friction is missing. The hand of an impedance display feels it."
FRICTION_SIGN = "Friction resists the motion. At v > 0 the hand must overcome it, so it is added."
DEVICE_SHOWN = "The servo supplies the force that the device needs, so the hand of an admittance display feels M a only."

LAB = Lab(
    number="17",
    title="Beyond the penalty",
    minutes=120,
    exercises=(
        Exercise("prediction_through", kind="prediction", asks="the force [N] at which you fall through the plate"),
        Exercise("prediction_cheaper", kind="prediction", asks='"constraint" or "spring"'),
        Exercise("prediction_grating", kind="prediction", asks='"fine" or "coarse"'),
        Exercise(
            "lever",
            points=2,
            asks='{"acceleration": of m_1 [m/s^2], "reaction": on m_2 [N]}',
            cases=(
                Case(
                    {"F": 2.0, "m_1": 0.05, "m_2": 0.1, "N": 2.0},
                    {"acceleration": 4.444444444, "reaction": 0.888888889},
                    slips=(
                        ({"acceleration": 8.0}, RATIO_ONCE),
                        ({"acceleration": 13.33333333}, NO_RATIO),
                        ({"acceleration": 26.66666667}, INVERSE_RATIO),
                        ({"acceleration": 40.0}, FIRST_ALONE),
                        ({"reaction": 1.777777778}, ON_FIRST),
                        ({"reaction": 0.444444444}, SLOW_SECOND),
                        ({"reaction": 1.0}, BALANCE),
                    ),
                ),
                Case(
                    {"F": 1.5, "m_1": 0.08, "m_2": 0.02, "N": 3.0},
                    {"acceleration": 5.769230769, "reaction": 0.346153846},
                    slips=(
                        ({"acceleration": 10.71428571}, RATIO_ONCE),
                        ({"acceleration": 15.0}, NO_RATIO),
                        ({"acceleration": 18.24324324}, INVERSE_RATIO),
                        ({"acceleration": 18.75}, FIRST_ALONE),
                        ({"reaction": 1.038461538}, ON_FIRST),
                        ({"reaction": 0.115384615}, SLOW_SECOND),
                        ({"reaction": 0.5}, BALANCE),
                    ),
                ),
            ),
            hint="Insert the third equation into the second one. Which reaction does m_1 then feel?",
            matters="A multiplier is not a mathematical trick. It is the force in the joint, and you can feel it.",
        ),
        Exercise(
            "stiffest_spring",
            points=1,
            asks="the largest stiffness [N/m] that the step allows",
            cases=(
                Case(
                    {"m_1": 0.05, "m_2": 0.1, "N": 2.0, "T": 1e-3},
                    44444.4444444,
                    unit="N/m",
                    slips={
                        8e4: SPRING_RATIO_ONCE,
                        133333.333333: SPRING_NO_RATIO,
                        4e5: FIRST_FIXED,
                        6e5: SUM,
                        1.8e6: FELT_MASS,
                        11111.1111111: OMEGA_ONE,
                        22222.2222222: OMEGA_ROOT,
                    },
                ),
                Case(
                    {"m_1": 0.03, "m_2": 0.02, "N": 0.5, "T": 2e-3},
                    17142.8571429,
                    unit="N/m",
                    slips={
                        15e3: SPRING_RATIO_ONCE,
                        12e3: SPRING_NO_RATIO,
                        2e4: FIRST_FIXED,
                        5e4: SUM,
                        35e3: FELT_MASS,
                        4285.71428571: OMEGA_ONE,
                        8571.42857143: OMEGA_ROOT,
                    },
                ),
            ),
            hint="What is the second derivative of the stretch if only the spring acts? Which omega follows?",
            matters="A stiff spring ties the step of the whole scene to its lightest part. A constraint does not.",
        ),
        Exercise(
            "proxy",
            points=1,
            asks="the positions of the proxy [m], an array as long as x",
            cases=(
                Case(
                    {"x": [0.0, 0.004, 0.009, 0.013, 0.03, 0.012, 0.007, 0.002], "x_o": 0.01},
                    (0.0, 0.004, 0.009, 0.01, 0.01, 0.01, 0.007, 0.002),
                    unit="m",
                    slips={
                        (0.0, 0.004, 0.009, 0.013, 0.03, 0.012, 0.007, 0.002): THROUGH,
                        (0.0, 0.0, 0.0, 0.003, 0.02, 0.002, 0.0, 0.0): DEPTH,
                        (0.0, 0.004, 0.009, 0.01, 0.01, 0.01, 0.01, 0.01): STUCK,
                        (0.01, 0.01, 0.01, 0.013, 0.03, 0.012, 0.01, 0.01): OTHER_SIDE,
                        (0.0, 0.004, 0.009, 0.01, 0.03, 0.012, 0.01, 0.01): NEAREST,
                    },
                ),
                Case(
                    {"x": [0.02, 0.014, 0.006, -0.01, 0.008, 0.015, 0.02], "x_o": 0.01},
                    (0.02, 0.014, 0.01, 0.01, 0.01, 0.015, 0.02),
                    unit="m",
                    slips={
                        (0.01, 0.01, 0.006, -0.01, 0.008, 0.01, 0.01): ONE_SIDED,
                        (0.02, 0.014, 0.006, -0.01, 0.008, 0.015, 0.02): THROUGH,
                        (0.02, 0.014, 0.01, 0.01, 0.01, 0.01, 0.01): STUCK,
                        (0.02, 0.014, 0.01, -0.01, 0.008, 0.01, 0.01): NEAREST,
                    },
                ),
            ),
            hint="On which side does the handle start? Can the proxy ever change this side?",
            matters="A proxy has a memory. So a plate may be thinner than one step of a fast hand, and it still stops the hand.",
        ),
        Exercise(
            "rubbed",
            points=2,
            asks="the force on the environment [N], an array as long as x",
            atol=1e-9,
            cases=(
                Case(
                    {"x": [0, 0.001, 0.002, 0.004, 0.006, 0.005, 0.003, 0, -0.002, -0.002, -0.001], "K": 200.0, "F_c": 0.5},
                    (0.0, 0.2, 0.4, 0.5, 0.5, 0.3, -0.1, -0.5, -0.5, -0.5, -0.3),
                    unit="N",
                    slips={
                        (0.0, 0.2, 0.4, 0.5, 0.5, 0.5, 0.5, 0.0, -0.4, -0.4, -0.2): NO_SLIP_MEMORY,
                        (0.0, 0.5, 0.5, 0.5, 0.5, -0.5, -0.5, -0.5, -0.5, 0.0, 0.5): BY_SIGN,
                        (0.0, 0.2, 0.4, 0.0, 0.4, 0.2, -0.2, 0.0, -0.4, -0.4, -0.2): JUMPS,
                        (0.0, 0.2, 0.4, 0.5, 0.4, 0.2, -0.2, -0.5, -0.4, -0.4, -0.2): HOLDS_THEN_JUMPS,
                        (0.0, -0.2, -0.4, -0.5, -0.5, -0.3, 0.1, 0.5, 0.5, 0.5, 0.3): FORCE_SIGN,
                        (0.0, 0.2, 0.4, 0.8, 1.2, 1.0, 0.6, 0.0, -0.4, -0.4, -0.2): ALL_SPRING,
                    },
                ),
                Case(
                    {"x": [0.005, 0.004, 0.004, 0.0045, 0.007, 0.006], "K": 100.0, "F_c": 0.1},
                    (0.0, -0.1, -0.1, -0.05, 0.1, 0.0),
                    unit="N",
                    slips={
                        (0.0, -0.1, -0.1, -0.05, 0.1, 0.1): NO_SLIP_MEMORY,
                        (0.0, -0.1, 0.0, 0.1, 0.1, -0.1): BY_SIGN,
                        (0.0, -0.1, -0.1, -0.05, 0.0, -0.1): JUMPS,
                        (0.0, -0.1, -0.1, -0.05, 0.1, -0.1): HOLDS_THEN_JUMPS,
                    },
                ),
            ),
            hint="Between which two positions, around the handle, may the proxy stay? Where does it go if it is outside?",
            matters="This friction sticks and slides without any estimate of the velocity, so it is quiet at rest.",
        ),
        Exercise(
            "sampled_frequency",
            points=1,
            asks="the frequency [Hz] that the samples show",
            atol=1e-6,
            cases=(
                Case(
                    {"v": 0.7, "p": 0.001, "T": 1e-3},
                    300.0,
                    unit="Hz",
                    slips={700.0: TRUE_FREQUENCY, 500.0: CLIPPED, 200.0: NYQUIST_MODULO},
                ),
                Case(
                    {"v": 1.9, "p": 0.001, "T": 1e-3},
                    100.0,
                    unit="Hz",
                    slips={1900.0: TRUE_FREQUENCY, 900.0: MODULO, 500.0: CLIPPED, 400.0: NYQUIST_MODULO},
                ),
                Case(
                    {"v": 2.3, "p": 0.001, "T": 1e-3},
                    300.0,
                    unit="Hz",
                    slips={2300.0: TRUE_FREQUENCY, 1300.0: FOLDED_ONCE},
                ),
                Case({"v": 0.3, "p": 0.002, "T": 2e-3}, 150.0, unit="Hz"),
            ),
            hint="Which multiple of 1/T is nearest to v/p? How far away is it?",
            matters="A grating that is passed too fast does not vanish. You feel another one, or at v = p/T none at all.",
        ),
        Exercise(
            "largest_amplitude",
            points=1,
            asks="the largest passive amplitude [N]",
            cases=(
                Case(
                    {"b": 0.1, "T": 1e-3, "p": 1e-3},
                    0.0318309886,
                    unit="N",
                    slips={
                        0.2: SLOPE_OF_LINE,
                        0.0159154943: HALF,
                        0.0636619772: DOUBLE,
                        200.0: STIFFNESS,
                        31.8309886: NO_PITCH,
                    },
                ),
                Case(
                    {"b": 0.5, "T": 2e-3, "p": 4e-3},
                    0.318309886,
                    unit="N",
                    slips={2.0: SLOPE_OF_LINE, 0.159154943: HALF, 0.636619772: DOUBLE, 500.0: STIFFNESS, 79.5774715: NO_PITCH},
                ),
            ),
            hint="Where is A sin(2 pi x/p) steepest? Which stiffness is passive at most?",
            matters="Fine textures are stiff, although they are weak. This is why they buzz.",
        ),
        Exercise(
            "hand_force",
            points=1,
            asks='{"impedance": [N], "admittance": [N]}, the force of the hand with each display',
            cases=(
                Case(
                    {"a": 1.5, "v": 0.2, "m": 0.5, "b": 5.0, "f_c": 0.5, "M": 0.2},
                    {"impedance": 2.55, "admittance": 0.3},
                    slips=(
                        ({"impedance": 2.25}, NO_VIRTUAL),
                        ({"impedance": 1.8}, NO_DEVICE),
                        ({"impedance": 2.05}, WITHOUT_FRICTION),
                        ({"impedance": 1.55}, FRICTION_SIGN),
                        ({"admittance": 1.05}, DEVICE_SHOWN),
                        ({"admittance": 1.8}, DEVICE_SHOWN),
                        ({"admittance": 2.55}, DEVICE_SHOWN),
                    ),
                ),
                Case(
                    {"a": 0.8, "v": 0.1, "m": 0.03, "b": 0.1, "f_c": 0.05, "M": 0.1},
                    {"impedance": 0.164, "admittance": 0.08},
                    slips=(
                        ({"impedance": 0.084}, NO_VIRTUAL),
                        ({"impedance": 0.14}, NO_DEVICE),
                        ({"impedance": 0.114}, WITHOUT_FRICTION),
                        ({"admittance": 0.104}, DEVICE_SHOWN),
                        ({"admittance": 0.164}, DEVICE_SHOWN),
                    ),
                ),
            ),
            hint="Which forces does the motor supply in each display? What remains for the hand?",
            matters="The device is always felt on an impedance display. This is why a paddle has to be light.",
        ),
        Exercise(
            "displays",
            kind="choice",
            points=1,
            asks="the display for each device: a, b, c or d",
            options={
                "a": "impedance for both, because only a passive display is safe",
                "b": "impedance for the paddle, admittance for the arm",
                "c": "admittance for the paddle, impedance for the arm",
                "d": "admittance for both, because a servo always hides the device",
            },
            cases=(
                Case(
                    {},
                    "b",
                    slips={
                        "a": "On the arm the hand would feel 2 kg and 5 N of friction in addition to the tool of 200 g.",
                        "c": "The paddle is light and needs no servo. The arm would be felt with all its mass and friction.",
                        "d": "A spring has no mass, but an admittance display needs a least one, and the paddle has no sensor.",
                    },
                ),
            ),
            hint="What would the hand feel of the device in each task? Which limit does each display have?",
            matters="The device decides which variable to measure: light ones measure motion, heavy ones measure force.",
        ),
        Exercise("discussion", kind="text", least_words=80, asks="your discussion, 80 words or more"),
    ),
)
