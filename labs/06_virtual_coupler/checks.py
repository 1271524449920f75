"""Public checks of lab 06: numbers, the letter of the choice, and the sentences that teach; no formulas of an answer."""

from hapticlab.course.exercise import Case, Exercise, Lab

OLD = "Semi-implicit: the position takes the step with the NEW velocity. With the old one, it is explicit Euler, and grows."
LED = {
    "x": [0, 0.004, 0.01, 0.014, 0.015, 0.015, 0.015, 0.015, 0.01, 0.004, 0, 0],
    "T": 0.02,
    "values": {"M": 0.05, "m": 0.05, "l": 0.15, "g": 9.81, "c": 1e-3, "K": 100.0, "b_c": 0.3},
}
LED_FROM_THERE = {**LED, "x": [0.01, 0.01, 0.012, 0.015, 0.018, 0.02], "channels": ["theta"]}

LAB = Lab(
    number="06",
    title="A pendulum in the hand",
    minutes=120,
    exercises=(
        Exercise("prediction", kind="prediction", asks="how fast the pendulum swings when you let go of the handle [Hz]"),
        Exercise(
            "euler_step",
            points=1,
            asks='{"z": [m], "w": [m/s]} after one semi-implicit Euler step',
            cases=(
                Case(
                    {"z": 0.01, "w": -0.2, "x": 0.004, "v": 0.1, "m": 0.05, "K": 160.0, "b_c": 0.3, "T": 2e-3},
                    {"z": 0.0095304, "w": -0.2348},
                    slips=(
                        ({"z": 0.0096}, OLD),
                        ({"w": -0.2384}, "The damper of the coupler is missing: b_c (v - w)."),
                        ({"w": -0.1652}, "The mass is pushed away from the handle: F_c = K (x - z) + ... pulls it there."),
                        ({"w": -0.236}, "The damper lies between handle and mass: it sees v - w, not w alone."),
                        ({"w": -0.20174}, "The acceleration is F_c over m."),
                    ),
                ),
                Case(
                    {"z": 0.0, "w": 0.5, "x": 0.02, "v": 0.0, "m": 0.1, "K": 200.0, "b_c": 0.1, "T": 1e-3},
                    {"z": 0.0005395, "w": 0.5395},
                    slips=(({"z": 0.0005}, OLD),),
                ),
            ),
            hint="Which z, w make the force? And which w carries the position: the one before the step, or the one after it?",
        ),
        Exercise(
            "pendulum",
            kind="scene",
            points=3,
            asks="a scene of the pendulum on its carriage: force=F_c, its equations of motion, watch=[z, theta]",
            rtol=1e-5,
            cases=(
                Case(
                    LED,
                    [0.0, 0.402192838, 0.593062574, -0.036396408, -0.976202977, -1.190591263, -0.501293686, 0.438634664,
                     0.348550123, -0.061512887, -0.074157944, 0.388594836],
                    unit="N",
                    slips={
                        (0.0, 0.518098323, 0.916205824, 0.44130183, -0.540612745, -1.015786319, -0.633272899, 0.183679611,
                         0.278048336, 0.197397485, 0.37380441, 0.812216969): "Gravity pushes the bob up: at theta = 0 it hangs "
                        "lowest, so its potential energy is -m g l cos(theta), and L = kinetic - potential.",
                        (0.0, 0.46, 0.898065585, 0.674333668, -0.129153293, -0.89086754, -1.228520251, -1.075475357,
                         -1.103708672, -0.766146406, 0.135982853, 1.378762323): "Carriage and pendulum do not feel each other: "
                        "the square of the bob's velocity has a product of z' and theta'.",
                        (0.0, 0.449318542, 0.858993984, 0.60008061, -0.216584771, -0.949681449, -1.224371929, -1.000432865,
                         -0.978423781, -0.62940692, 0.242860414, 1.426756488): "The product of z' and theta' goes with the "
                        "cosine: where the rod hangs down, the bob moves along the rail.",
                        (0.0, 0.441296066, 0.818472572, 0.496825424, -0.377481292, -1.102004972, -1.273782311, -0.891006549,
                         -0.738595313, -0.340078095, 0.473246914, 1.471154849): "The product of z' and theta' appears twice in "
                        "the square, (a + b)^2 = a^2 + 2 a b + b^2.",
                        (0.0, 0.40568892, 0.619806108, 0.013708158, -0.956273239, -1.238724207, -0.599911299, 0.339503396,
                         0.30881013, -0.035522013, -0.0425376, 0.371228055): "Half of m v^2, for the bob as for the carriage.",
                        (0.0, 0.517807162, 0.909186472, 0.433786917, -0.518643321, -0.980471085, -0.605001536, 0.233508414,
                         0.29969884, 0.117525387, 0.198956704, 0.539529573): "The bob is at z + l sin(theta): it is to the right "
                        "where theta > 0. Your product of z' and theta' has the other sign.",
                        (0.0, 0.402921121, 0.598573549, -0.017050955, -0.940141915, -1.155763755, -0.497271217, 0.400004101,
                         0.290888491, -0.097990531, -0.07061865, 0.419281936): "Rayleigh's function is half the power lost, "
                        "c theta'^2/2: with all of it the bearing resists twice.",
                        (0.0, 0.38683385, 1.174397083, 2.727370286, 6.125847114, 13.21910969, 25.823707072, 47.737134681,
                         91.755287176, 176.807871307, 344.114836129, 670.987324904): "The carriage runs away: the coupler pulls "
                        "it towards the handle with +F_c, forces={z: F_c}.",
                        (0.0, -0.402192838, -0.593062574, 0.036396408, 0.976202977, 1.190591263, 0.501293686, -0.438634664,
                         -0.348550123, 0.061512887, 0.074157944, -0.388594836): "The sign is turned: the force on the "
                        "environment is the force on the carriage, force=F_c.",
                        (0.0, 0.394243206, 0.555110242, -0.091685517, -0.993018889, -1.149281644, -0.432670189, 0.487902494,
                         0.345039405, -0.107128482, -0.117386441, 0.383497976): "That holds for small angles only; keep sine "
                        "and cosine, the solver does not mind them.",
                        (0.0, 0.402288121, 0.595437382, -0.021529536, -0.944946259, -1.161968821, -0.494844203, 0.422920002,
                         0.325680536, -0.074067751, -0.068383287, 0.406565469): "The bob's centrifugal force on the carriage, "
                        "m l theta'^2 sin(theta), is missing: differentiate theta' cos(theta) as a product.",
                        (0.0, 0.394700161, 0.862744684, 0.981176619, 0.705639762, 0.296547241, -0.140453221, -0.59540842,
                         -1.616538211, -2.643536863, -3.370423332, -3.596984852): "Nothing moves the carriage: what the hand "
                        "feels must also act on it, forces={z: F_c}.",
                    },
                ),
                Case(
                    LED_FROM_THERE,
                    {
                        "F": [0.0, -0.057807162, 0.072953372, 0.151111025, -0.000989807, -0.323498769],
                        "theta": [0.3, 0.293299743, 0.275994145, 0.24520215, 0.194507145, 0.134064576],
                    },
                    slips=(
                        ({"F": (1.0, 0.518908738, -0.098038761, -0.549047431, -0.662341309, -0.466537137)}, "The carriage begins "
                         "at 0, far from the handle, and the coupler jerks it there: hl.coordinate with initial=x(n)."),
                    ),
                ),
            ),
            hint="How fast is the bob along the rail, and how fast up? What is each mass's kinetic energy? How high is the bob?",
        ),
        Exercise(
            "coupler_stiffness",
            points=1,
            asks="the stiffest K [N/m] that b pays for, beside b_c",
            cases=(
                Case(
                    {"b": 0.1, "T": 1e-3, "b_c": 0.02}, 160.0, unit="N/m",
                    slips={
                        200.0: "The coupler's own damper is rendered with a delay, too, and must be paid for: K T/2 + b_c.",
                        80.0: "The hold delays by half a period on the average, so it is K T/2 that b pays for, not K T.",
                        240.0: "A virtual damper does not help to pay, it costs: |B| stands on the other side of Eq. (23.10).",
                    },
                ),
                Case({"b": 2.0, "T": 2e-3, "b_c": 0.5}, 1500.0, unit="N/m",
                     slips={2000.0: "The coupler's own damper must be paid for, too: K T/2 + b_c."}),
            ),
            hint="What of b is left for the spring, once the coupler's damper is paid? What does each N/m cost?",
        ),
        Exercise(
            "felt_wall",
            points=1,
            asks="the stiffness [N/m] felt of a wall k behind a coupler K",
            cases=(
                Case(
                    {"K": 160.0, "k": 500.0}, 121.212121212, unit="N/m",
                    slips={
                        660.0: "Stiffnesses add side by side. These are one behind the other: their deflections add.",
                        0.00825: "That is the compliance, in m/N; its inverse is the stiffness.",
                        500.0: "The coupler lies between handle and wall, and gives way, too.",
                    },
                ),
                Case({"K": 300.0, "k": 100.0}, 75.0, unit="N/m"),
            ),
            hint="What do coupler and wall have in common, the force or the deflection? And what adds up?",
        ),
        Exercise(
            "longest_period",
            kind="value",
            points=1,
            asks="the longest period [s] at which a wall of K_WALL may feel like K_FELT, with b = 0.1 and b_c = 0.02 N s/m",
            cases=(
                Case(
                    {},
                    1.2e-4,
                    unit="s",
                    slips={
                        1.5e-4: "The coupler's own damper is to be paid as well.",
                        2e-4: "That is for a coupler as stiff as what is felt. In series with the wall it must be stiffer.",
                        8e-5: "That is for a coupler as stiff as the wall, and then half of that is felt.",
                        6e-5: "The hold costs K T/2, not K T.",
                    },
                ),
            ),
            rtol=1e-3,
            hint="Which K in series with the wall feels like that? What T does b pay for, with this K?",
        ),
        Exercise(
            "swing_frequency",
            points=2,
            asks="the frequency [Hz] of the slower mode, the handle held still",
            rtol=1e-5,
            cases=(
                Case(
                    {"l": 0.15, "g": 9.81, "M": 0.05, "m": 0.05, "K": 150.0}, 1.272990412, unit="Hz",
                    slips={
                        1.287090266: "That is sqrt(g/l): the pendulum on a carriage that cannot move. The coupler gives way.",
                        8.813829239: "That is the faster mode, the carriage on the coupler; the swing is the slower one.",
                        7.998434654: "That is in rad/s; a hertz is 2 pi of them.",
                        63.974956916: "That is omega squared.",
                        8.087026647: "That is sqrt(g/l) in rad/s; in hertz, and on a coupler that gives way, it is slower.",
                    },
                ),
                Case(
                    {"l": 0.3, "g": 9.81, "M": 0.1, "m": 0.2, "K": 20.0}, 0.777200302, unit="Hz",
                    slips={
                        2.635701216: "That is the faster mode; the swing is the slower one.",
                        0.910110255: "That is sqrt(g/l): the pendulum on a carriage that cannot move. The coupler gives way.",
                    },
                ),
            ),
            hint="When do two homogeneous equations for two amplitudes have a solution other than zero? Which of the two "
            "frequencies goes to sqrt(g/l) for a stiff coupler?",
        ),
        Exercise(
            "who_pays",
            kind="choice",
            points=1,
            asks='"a", "b" or "c"',
            options={"a": "the hand's mass", "b": "the hand's reaction", "c": "the hand's damping"},
            cases=(
                Case(
                    {},
                    "c",
                    slips={
                        "a": "Mass stores energy and gives it back; it pays for none. Try a hand that is only mass, "
                        "hl.Hand(m=0.02), at 640 N/m.",
                        "b": "This hand is a mass, a spring and a damper: it does not react. And a real one reacts too late "
                        "for a rattle of more than 10 Hz.",
                    },
                ),
            ),
            hint="run it with hands that have only a mass, only a spring, only a damper",
        ),
        Exercise(
            "discussion",
            kind="text",
            asks="two ways to a felt wall of 2000 N/m, with numbers, in 60 words or more",
            least_words=60,
        ),
    ),
)
