"""Public checks of lab 01: numbers, the letter of the choice, and the sentences that teach; no formulas of an answer."""

from hapticlab.course.exercise import Case, Exercise, Lab

DAMPER_SIGN = (
    "Your damper supplies energy. Its power F v must be positive, so its force points in the direction of v, as "
    "that of a spring points in the direction of x."
)
TURNED = "The sign is wrong: F_e is the force ON the environment, Eq. (23.1). The motor applies -F_e to the handle."
RUNS_AWAY = (
    "Your mass runs away from the handle. The coupler must pull it TOWARDS the handle, so m z'' = +F_c with F_c = K (x - z) + ..."
)
DAMPER_RELATIVE = "The damper of the coupler has the wrong sign: it must resist the relative velocity x' - z'."
SPRING_AWAY = "The spring has the wrong sign: its force on the mass is K (x - z), towards the handle."
DIFFERENCES = (
    "You used sums. The force of a spring depends on the distance between its ends, x - z, and that of a damper "
    "on the rate of this distance, v - z'."
)
SPRING_ALONE = "That is the spring alone. The coupler also has a damper in parallel with the spring."
DAMPER_BETWEEN = "The damper connects the handle and the mass, so its force depends on x' - z', not on z' alone."
STEPS = {
    "x": [0, 0.002, 0.005, 0.008, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01],
    "T": 5e-3,
    "values": {"m": 0.1, "K": 160.0, "b_c": 0.2},
}
LED_FROM_THERE = {**STEPS, "x": [0.01, 0.012, 0.015, 0.018, 0.02, 0.02], "channels": ["z"]}

LAB = Lab(
    number="01",
    title="From equations of motion to force",
    minutes=90,
    exercises=(
        Exercise("prediction", kind="prediction", asks="the frequency at which the mass oscillates in your hand [Hz]"),
        Exercise(
            "spring_damper_force",
            points=1,
            asks="the force on the environment F_e [N] at x [m], v [m/s]",
            cases=(
                Case(
                    {"x": 0.012, "v": -0.1, "k": 200.0, "b": 1.5},
                    2.25,
                    unit="N",
                    slips={
                        -2.25: TURNED,
                        2.55: DAMPER_SIGN,
                        2.4: "That is the spring alone. Add the force of the damper.",
                        -0.15: "That is the damper alone. Add the force of the spring.",
                        2399.85: "The force of the spring is 1000 times as large as expected: x is in metres and k in N/m.",
                    },
                ),
                Case(
                    {"x": 0.0, "v": 0.2, "k": 200.0, "b": 1.5},
                    0.3,
                    unit="N",
                    slips={
                        -0.3: (
                            "The sign is wrong. A damper that moves to the right is pushed to the right: it absorbs "
                            "power, F v > 0."
                        )
                    },
                ),
            ),
            hint=(
                "In which direction do you pull the end of a spring where x > 0? In which direction do you push a "
                "damper where v > 0?"
            ),
            matters="Every environment in these labs is a force like this one, and one sign convention keeps them consistent.",
        ),
        Exercise(
            "spring_damper",
            kind="scene",
            points=1,
            asks="a scene with force=..., a formula of k, b, x(n) and v(n)",
            cases=(
                Case(
                    {"x": [0, 0.001, 0.003, 0.003], "T": 1e-3, "values": {"k": 200.0, "b": 0.5}},
                    [0.0, 0.7, 1.6, 0.6],
                    unit="N",
                    slips={(0.0, -0.7, -1.6, -0.6): TURNED, (0.0, -0.3, -0.4, 0.6): DAMPER_SIGN},
                ),
            ),
            hint="What does your spring_damper_force return? Which of k, b, x(n) and v(n) replaces which of its arguments?",
            matters="You wrote only the physics. The same scene runs in the simulation and on a board.",
        ),
        Exercise(
            "thousand",
            kind="choice",
            points=1,
            asks='"a", "b" or "c"',
            options={"a": "1/T", "b": "from metres to millimetres", "c": "from newtons to duty"},
            cases=(
                Case(
                    {},
                    "a",
                    slips={
                        "b": "A program computes in SI units; only plots show millimetres. Compile with T=5e-4 and look again.",
                        "c": "The board converts F into a duty after the program has ended. Compile with T=5e-4 and look again.",
                    },
                ),
            ),
            hint="Compile the same scene with T=5e-4. Which number replaces the 1000?",
            matters="If you can read the compiled program, you can find out where each number in a force comes from.",
        ),
        Exercise(
            "spring_and_damper",
            points=2,
            asks='{"k": [N/m], "b": [N s/m]} of the best F = k x + b v',
            rtol=1e-4,
            cases=(
                Case(
                    {
                        "x": [0.012, 0.008, -0.002, -0.01, -0.004],
                        "v": [0.05, -0.2, -0.1, 0.02, 0.15],
                        "F": [2.47, 1.31, -0.54, -1.97, -0.56],
                    },
                    {"k": 199.723785812, "b": 1.480876092},
                    slips=(
                        (
                            {"k": 192.5},
                            (
                                "You fitted the spring alone, so a part of the damper's force is counted as the "
                                "spring's. Fit both at once."
                            ),
                        ),
                        (
                            {"b": -2.757294430},
                            (
                                "You fitted the damper alone, so a part of the spring's force is counted as the "
                                "damper's. Fit both at once."
                            ),
                        ),
                        ({"k": 1.480876092}, "k and b are swapped: k is the coefficient of the column of x."),
                        ({"k": 199.676498}, "You also fitted a constant force. The model has none: use two columns, x and v."),
                    ),
                ),
            ),
            hint="Each sample is one equation for k and b. What is the factor of k in it, and what is the factor of b?",
            matters="The same fit measures stiffness and damping from the recording of a real device.",
        ),
        Exercise(
            "count_step",
            points=1,
            asks="the jump of the force [N] at one count",
            cases=(
                Case(
                    {"m": 0.1, "metres_per_count": 12.8e-6, "T": 1e-3},
                    1.28,
                    unit="N",
                    slips={
                        0.00128: (
                            "You divided by T. A second difference is divided by T squared; divided by T, it would "
                            "belong to a velocity."
                        ),
                        2.56: "The factor 2 belongs to the middle sample, which has not changed yet. Only x(n) has changed.",
                        12.8: "That is the acceleration. Multiply it by m to get the force.",
                    },
                ),
                Case(
                    {"m": 0.05, "metres_per_count": 1e-4, "T": 2e-3},
                    1.25,
                    unit="N",
                    slips={
                        0.0025: (
                            "You divided by T. A second difference is divided by T squared; divided by T, it would "
                            "belong to a velocity."
                        )
                    },
                ),
            ),
            hint="Which of x(n), x(n-1) and x(n-2) has changed at that sample, and which have not changed yet?",
            matters="A force from a second difference jumps at every encoder count, so a virtual mass needs another approach.",
        ),
        Exercise(
            "mass_equation",
            kind="expression",
            points=1,
            asks="Newton's law of the mass on its coupler, sp.Eq(..., ...), with z, z', z'', x(t), v(t), m, K and b_c",
            cases=(
                Case(
                    {
                        "at": {
                            "m": [0.1, 0.2, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1],
                            "K": [160.0, 160.0, 80.0, 160.0, 160.0, 160.0, 160.0, 160.0],
                            "b_c": [0.2, 0.2, 0.2, 0.5, 0.2, 0.2, 0.2, 0.2],
                            "x(t)": [0.01, 0.01, 0.01, 0.01, 0.0, 0.01, 0.01, 0.01],
                            "v(t)": [0.3, 0.3, 0.3, 0.3, 0.3, 0.0, 0.3, 0.3],
                            "z": [0.004, 0.004, 0.004, 0.004, 0.004, 0.004, 0.012, 0.004],
                            "z'": [-0.1, -0.1, -0.1, -0.1, -0.1, -0.1, -0.1, 0.3],
                        },
                        "solve_for": "z''",
                    },
                    [10.4, 5.2, 5.6, 11.6, -5.6, 9.8, -2.4, 9.6],
                    unit="m/s^2",
                    slips={
                        (-10.4, -5.2, -5.6, -11.6, 5.6, -9.8, 2.4, -9.6): RUNS_AWAY,
                        (8.8, 4.4, 4.0, 7.6, -7.2, 9.4, -4.0, 9.6): DAMPER_RELATIVE,
                        (9.8, 4.9, 5.0, 10.1, -6.2, 9.8, -3.0, 9.0): DAMPER_BETWEEN,
                        (9.6, 4.8, 4.8, 9.6, -6.4, 9.6, -3.2, 9.6): SPRING_ALONE,
                        (-8.8, -4.4, -4.0, -7.6, 7.2, -9.4, 4.0, -9.6): SPRING_AWAY,
                        (22.8, 11.4, 11.6, 23.4, 6.8, 22.2, 35.6, 23.6): DIFFERENCES,
                        (23.2, 11.6, 12.0, 24.4, 7.2, 22.6, 36.0, 22.4): DIFFERENCES,
                        (11.2, 5.6, 6.4, 13.6, -4.8, 10.0, -1.6, 9.6): "Your damper has twice its force: b_c appears twice.",
                        (-6.2, -3.1, -3.0, -5.9, -6.2, -6.2, -19.0, -7.0): (
                            "You left out the handle, which is the other end of the coupler and moves. Use x(t) and "
                            "v(t) in the force."
                        ),
                        (640.012, 320.006, 320.012, 640.03, 639.992, 160.012, 639.996, 0.012): (
                            "K and b_c are swapped: K multiplies the difference of the positions, b_c that of the velocities."
                        ),
                        (0.59, -4.61, -4.21, 1.79, -15.41, -0.01, -12.21, -0.21): (
                            "You included a weight. This model has none: only the force of the coupler acts on the mass."
                        ),
                    },
                ),
            ),
            hint=(
                "Which forces act ON the mass? If the handle is to the right of the mass, in which direction is the mass pulled?"
            ),
            matters="The acceleration of the mass now follows from forces, so the position is not differentiated twice.",
        ),
        Exercise(
            "mass_on_coupler",
            kind="scene",
            points=2,
            asks="a scene of a mass m with coordinate z, connected to the handle by K and b_c; force, eom, watch=[z]",
            rtol=1e-5,
            cases=(
                Case(
                    STEPS,
                    [
                        0.0,
                        0.4,
                        0.89934168,
                        1.314201618,
                        1.47108638,
                        1.208461989,
                        0.983042509,
                        0.724304734,
                        0.439410422,
                        0.139920776,
                    ],
                    unit="N",
                    slips={
                        (
                            0.0,
                            0.4,
                            0.94094232,
                            1.489167668,
                            1.904716781,
                            2.040872419,
                            2.338173781,
                            2.729270253,
                            3.234379173,
                            3.875019361,
                        ): RUNS_AWAY,
                        (
                            0.0,
                            -0.4,
                            -0.89934168,
                            -1.314201618,
                            -1.47108638,
                            -1.208461989,
                            -0.983042509,
                            -0.724304734,
                            -0.439410422,
                            -0.139920776,
                        ): TURNED,
                        (
                            0.0,
                            -0.4,
                            -0.94094232,
                            -1.489167668,
                            -1.904716781,
                            -2.040872419,
                            -2.338173781,
                            -2.729270253,
                            -3.234379173,
                            -3.875019361,
                        ): (
                            "Both signs are wrong, as if you had used K (z - x). The force on the mass points "
                            "towards the handle, and the force on the environment is the same force."
                        ),
                        (
                            0.0,
                            0.24,
                            0.677321953,
                            1.131772137,
                            1.424247649,
                            1.380335491,
                            1.197347694,
                            0.966940288,
                            0.695476377,
                            0.393419815,
                        ): DAMPER_RELATIVE,
                        (
                            0.0,
                            0.32,
                            0.783841097,
                            1.209456947,
                            1.421673848,
                            1.255526064,
                            1.042697965,
                            0.793003254,
                            0.514336953,
                            0.218041227,
                        ): DAMPER_BETWEEN,
                        (
                            0.0,
                            0.4,
                            0.903785333,
                            1.329011063,
                            1.500056826,
                            1.251435499,
                            1.034390461,
                            0.77850388,
                            0.491581859,
                            0.185062796,
                        ): (
                            "The damper acts on the hand but not on the mass. Use the same F_c as the force of the scene "
                            "and as the force on the mass."
                        ),
                        (
                            0.0,
                            0.4,
                            0.908099734,
                            1.345452737,
                            1.534619763,
                            1.306593283,
                            1.107417624,
                            0.86629578,
                            0.59320974,
                            0.299310094,
                        ): (
                            "In an equation of motion, x(n) is a handle that stays still for the whole period. "
                            "Write x(t) and v(t), the handle that moves between the samples."
                        ),
                        (
                            0.0,
                            0.32,
                            0.787002593,
                            1.214042313,
                            1.425906273,
                            1.257660422,
                            1.041089729,
                            0.790914967,
                            0.511856227,
                            0.215270371,
                        ): (
                            "The damper acts on the mass but not on the hand. Use the same F_c as the force of the scene "
                            "and as the force on the mass."
                        ),
                    },
                ),
                Case(
                    LED_FROM_THERE,
                    {
                        "F": [0.0, 0.4, 0.89934168, 1.314201618, 1.47108638, 1.208461989],
                        "z": [0.01, 0.01, 0.010081234, 0.010412236, 0.011088086, 0.012139622],
                    },
                    slips=(
                        (
                            {"F": (1.6, 1.952398934, 2.343034014, 2.593001917, 2.535909069, 2.019197785)},
                            (
                                "The mass begins at 0, far from the handle, so the coupler jerks it. Use "
                                "hl.coordinate with initial=x(n)."
                            ),
                        ),
                    ),
                ),
            ),
            hint=(
                "Which force does the hand feel, and which force does the mass feel? In which direction does F_c "
                "pull each of them?"
            ),
            matters=("A force law with equations of motion describes any virtual body, such as the pendulum of lab 06."),
        ),
        Exercise(
            "resonance",
            points=1,
            asks='{"f": natural frequency [Hz], "zeta": damping ratio}',
            rtol=1e-4,
            cases=(
                Case(
                    {"m": 0.1, "K": 160.0, "b_c": 0.02},
                    {"f": 6.366197724, "zeta": 0.0025},
                    slips=(
                        ({"f": 40.0}, "That is in rad/s. Divide by 2 pi to get hertz."),
                        ({"zeta": 0.005}, "You divided by sqrt(K m). The critical damping is 2 sqrt(K m)."),
                        ({"zeta": 0.1}, "That is a decay rate, b_c/(2m) in 1/s. Divide it by the natural frequency in rad/s."),
                    ),
                ),
                Case(
                    {"m": 0.05, "K": 300.0, "b_c": 1.5},
                    {"f": 12.328088881, "zeta": 0.193649167},
                    slips=(
                        (
                            {"f": 12.094728558},
                            ("That is the frequency with the damper. The natural frequency is that without the damper."),
                        ),
                    ),
                ),
            ),
            hint="What does Newton's law of the mass become for x = 0? What are its natural frequency and its damping ratio?",
            matters="You can feel this frequency in your hand and find it in a recording, so it tests theory and simulation.",
        ),
        Exercise(
            "discussion",
            kind="text",
            asks="what the second difference does, and what disadvantage the coupler has, in 40 words or more",
            least_words=40,
        ),
    ),
)
