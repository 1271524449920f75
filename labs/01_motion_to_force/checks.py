"""Public checks of lab 01: numbers, the letter of the choice, and the sentences that teach; no formulas of an answer."""

from hapticlab.course.exercise import Case, Exercise, Lab

DAMPER_SIGN = "The damper feeds the hand: its power F v must be positive, so its force points along v, as a spring's along x."
TURNED = "The sign is turned: F_e is the force ON the environment, Eq. (23.1); the motor applies -F_e."
RUNS_AWAY = (
    "The mass runs away from the handle: the coupler must pull it TOWARDS the handle, so m z'' = +F_c with F_c = K (x - z) + ..."
)
DAMPER_RELATIVE = "The coupler's damper has the wrong sign: it must resist the relative velocity x' - z'."
SPRING_AWAY = "The spring has the wrong sign: its force on the mass is K (x - z), towards the handle."
DIFFERENCES = "A spring feels how far apart its ends are, x - z, and a damper how fast they part, v - z': differences, not sums."
SPRING_ALONE = "That is the spring alone: the coupler has a damper beside it."
DAMPER_BETWEEN = "The damper lies between handle and mass: it sees x' - z', not z' alone."
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
        Exercise("prediction", kind="prediction", asks="the frequency at which the mass rings in your hand [Hz]"),
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
                        2.4: "That is the spring alone.",
                        -0.15: "The spring is missing.",
                        2399.85: "The spring's force is 1000 times too large: x is in metres already, and k in N/m.",
                    },
                ),
                Case(
                    {"x": 0.0, "v": 0.2, "k": 200.0, "b": 1.5},
                    0.3,
                    unit="N",
                    slips={-0.3: "Moved to the right, a damper is pushed to the right: it takes power in, F v > 0."},
                ),
            ),
            hint="stretch a spring with your hands: which way do you push it where x > 0? Then the same for the damper",
            matters=("Every environment in these labs is a force like this one, and one sign convention keeps them consistent."),
        ),
        Exercise(
            "spring_damper",
            kind="scene",
            points=1,
            asks="a scene with force=..., of k, b, x(n) and v(n)",
            cases=(
                Case(
                    {"x": [0, 0.001, 0.003, 0.003], "T": 1e-3, "values": {"k": 200.0, "b": 0.5}},
                    [0.0, 0.7, 1.6, 0.6],
                    unit="N",
                    slips={(0.0, -0.7, -1.6, -0.6): TURNED, (0.0, -0.3, -0.4, 0.6): DAMPER_SIGN},
                ),
            ),
            hint="What did spring_damper_force say? Which of k, b, x(n), v(n) stands for which of its arguments?",
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
                        "b": "Everything inside is in SI; only plots show millimetres. Compile with T=5e-4 and look again.",
                        "c": "The board makes a duty of F, after the program. Compile with T=5e-4 and look again.",
                    },
                ),
            ),
            hint="Compile the same scene with T=5e-4 and compare: what became of the 1000?",
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
                            "That is a spring fitted alone: it takes some of the damper's force for its own. Fit both at once.",
                        ),
                        (
                            {"b": -2.757294430},
                            "That is a damper fitted alone: it takes some of the spring's force for its own. Fit both at once.",
                        ),
                        ({"k": 1.480876092}, "k and b are swapped: what the column of x is multiplied by is k."),
                        ({"k": 199.676498}, "There is no constant force in this model: two columns, x and v."),
                    ),
                ),
            ),
            hint="Each sample is one equation for k and b: what stands beside k in it, and what beside b?",
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
                        0.00128: "A second difference is divided by T squared; by T it would be a velocity.",
                        2.56: "The middle sample has the weight 2, and it has not moved yet: only x(n) has.",
                        12.8: "That is the acceleration; the force is m times it.",
                    },
                ),
                Case(
                    {"m": 0.05, "metres_per_count": 1e-4, "T": 2e-3},
                    1.25,
                    unit="N",
                    slips={0.0025: "A second difference is divided by T squared; by T it would be a velocity."},
                ),
            ),
            hint="Which of x(n), x(n-1) and x(n-2) has moved at that sample, and which has not yet?",
            matters=("A force from a second difference jumps at every encoder count, so a virtual mass needs another approach."),
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
                        (11.2, 5.6, 6.4, 13.6, -4.8, 10.0, -1.6, 9.6): "The damper counts twice.",
                        (-6.2, -3.1, -3.0, -5.9, -6.2, -6.2, -19.0, -7.0): "The other end of the coupler is the handle, which "
                        "moves: x(t) and v(t) belong in its force.",
                        (640.012, 320.006, 320.012, 640.03, 639.992, 160.012, 639.996, 0.012): "K and b_c are swapped: K goes "
                        "with the positions, b_c with the velocities.",
                        (0.59, -4.61, -4.21, 1.79, -15.41, -0.01, -12.21, -0.21): "There is no weight in this model: the "
                        "coupler's force alone acts on the mass.",
                    },
                ),
            ),
            hint="Newton: m z'' is the sum of the forces ON the mass. With the handle to its right, which way is it pulled?",
            matters=("The acceleration of the mass now follows from forces, so nobody has to differentiate the encoder twice."),
        ),
        Exercise(
            "mass_on_coupler",
            kind="scene",
            points=2,
            asks="a scene of a mass m with coordinate z, tied to the handle by K and b_c; force, eom, watch=[z]",
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
                        ): "Both signs are turned, as with K (z - x): the force on the mass points "
                        "to the handle, and the force on the environment is that same force.",
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
                        ): "The mass does not feel the damper that the hand feels: action and reaction must be the same F_c.",
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
                        ): "x(n) in an equation of motion is a handle that stands still over the whole period; "
                        "write x(t) and v(t), the handle as it moves between the samples.",
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
                        ): "The hand does not feel the damper that the mass feels: action and reaction must be the same F_c.",
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
                            "The mass begins at 0, "
                            "far from the handle, and the coupler jerks it there: hl.coordinate with initial=x(n).",
                        ),
                    ),
                ),
            ),
            hint="What does the hand feel, and what the mass? How often does F_c appear, then, and which way does it pull?",
            matters=(
                "A force law with equations of motion describes any virtual body; the labs on pendulums and contact do the same."
            ),
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
                        ({"f": 40.0}, "That is in rad/s; a hertz is 2 pi of them."),
                        ({"zeta": 0.005}, "The critical damping is 2 sqrt(K m), not sqrt(K m)."),
                        ({"zeta": 0.1}, "That is a decay rate, b_c/(2m) in 1/s; divide it by the natural frequency in rad/s."),
                    ),
                ),
                Case(
                    {"m": 0.05, "K": 300.0, "b_c": 1.5},
                    {"f": 12.328088881, "zeta": 0.193649167},
                    slips=(({"f": 12.094728558}, "That is the frequency with the damper; the natural one is without."),),
                ),
            ),
            hint="What does Newton's law of the mass become with x = 0? And how does a first course write the same equation?",
            matters=("You can feel this frequency in your hand and find it in a recording, so it tests theory and simulation."),
        ),
        Exercise(
            "discussion",
            kind="text",
            asks="what the second difference does, and what the coupler costs, in 40 words or more",
            least_words=40,
        ),
    ),
)
