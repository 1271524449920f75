"""Public checks of lab 06: numbers, the letter of the choice, and the sentences that teach; no formulas of an answer."""

from hapticlab.course.exercise import Case, Exercise, Lab

OLD = (
    "In a semi-implicit step the position uses the NEW velocity. With the old velocity the step is explicit Euler, and it grows."
)
SMALL_ANGLES = "That holds for small angles only. Keep sine and cosine: the solver does not need small angles."
PRODUCT = "That is the product of both, in (N/m)^2, which is not a stiffness. By what must you divide it?"
SOFTER = "The softer spring bounds the result, but both springs give way, and their deflections add."
OWN_DAMPER = "The coupler's own damper is rendered with a delay as well, so b must also pay for b_c: K T/2 + b_c."
TWO_ONCE = "That is twice as large as expected. The condition K T/2 + b_c <= b gives the factor 2 once."
HALF_INVERTED = (
    "That is a quarter of the expected value. In K T/2 the stiffness is divided by 2, so solving for K multiplies by 2."
)
NO_PERIOD = "The period is missing: K T/2 is a damping, so divide the damping that is left by T."
TIMES_T = "You multiplied by T. K T/2 is a damping, so divide the damping that is left by T/2."
BRACKETS = "The division by T acts on b_c alone. Put b - b_c in brackets."
MEAN = "That is a mean of the two stiffnesses. In series the result is softer than either spring: their deflections add."
NOT_TWICE = "That is twice as large as expected: two equal springs in series have half the stiffness of one."
DIFFERENCE = "You divided by the difference of the stiffnesses. The deflections of both springs add."
STILL_CARRIAGE = "That is sqrt(g/l), the pendulum on a carriage that cannot move. The coupler gives way."
FASTER = "That is the faster mode, the carriage on the coupler. The pendulum swings in the slower mode."
FREE_CARRIAGE = "That is the pendulum on a carriage without a coupler, the limit for K to 0. Keep K z in the first equation."
NO_PENDULUM = "That is the carriage on the coupler without a swinging pendulum. Keep theta in both equations."
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
        Exercise("prediction", kind="prediction", asks="the frequency [Hz] of the pendulum after you let go of the handle"),
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
                        (
                            {"z": 0.0095652},
                            "The position uses the new velocity for the whole step, not the mean of both velocities.",
                        ),
                        ({"z": 0.0102}, "You moved the mass with the handle's velocity v. Its own velocity is w."),
                        ({"z": 0.0035304}, "The new position starts at the old position z of the mass, not at the handle's x."),
                        ({"w": -0.2384}, "The damper of the coupler is missing: b_c (v - w)."),
                        ({"w": -0.1964}, "The spring of the coupler is missing: K (x - z)."),
                        ({"w": -0.1652}, "The mass is pushed away from the handle: F_c = K (x - z) + ... pulls it there."),
                        ({"w": -0.158}, "The sign of the spring is wrong: it pulls the mass towards the handle with K (x - z)."),
                        ({"w": -0.242}, "The sign of the damper is wrong: it pulls the mass along with b_c (v - w)."),
                        ({"w": -0.236}, "The damper lies between handle and mass: it uses v - w, not w alone."),
                        ({"w": -0.20174}, "The acceleration is F_c over m."),
                        ({"w": -17.6}, "The period is missing: the acceleration changes the velocity by T times F_c/m."),
                        ({"w": -0.0348}, "The step adds to the old velocity: w + T F_c/m."),
                    ),
                ),
                Case(
                    {"z": 0.0, "w": 0.5, "x": 0.02, "v": 0.0, "m": 0.1, "K": 200.0, "b_c": 0.1, "T": 1e-3},
                    {"z": 0.0005395, "w": 0.5395},
                    slips=(({"z": 0.0005}, OLD),),
                ),
            ),
            hint="Which z and w determine the force? Which w moves the position, the one before the step or the one after it?",
            matters=("The order of two lines decides whether the virtual body keeps its energy or gains some in every step."),
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
                    [
                        0.0,
                        0.402192838,
                        0.593062574,
                        -0.036396408,
                        -0.976202977,
                        -1.190591263,
                        -0.501293686,
                        0.438634664,
                        0.348550123,
                        -0.061512887,
                        -0.074157944,
                        0.388594836,
                    ],
                    unit="N",
                    slips={
                        (
                            0.0,
                            0.518098323,
                            0.916205824,
                            0.44130183,
                            -0.540612745,
                            -1.015786319,
                            -0.633272899,
                            0.183679611,
                            0.278048336,
                            0.197397485,
                            0.37380441,
                            0.812216969,
                        ): "Gravity pushes the bob up: at theta = 0 it hangs "
                        "lowest, so its potential energy is -m g l cos(theta), and L = kinetic - potential.",
                        (
                            0.0,
                            0.46,
                            0.898065585,
                            0.674333668,
                            -0.129153293,
                            -0.89086754,
                            -1.228520251,
                            -1.075475357,
                            -1.103708672,
                            -0.766146406,
                            0.135982853,
                            1.378762323,
                        ): "Carriage and pendulum do not feel each other: "
                        "the square of the bob's velocity has a product of z' and theta'.",
                        (
                            0.0,
                            0.449318542,
                            0.858993984,
                            0.60008061,
                            -0.216584771,
                            -0.949681449,
                            -1.224371929,
                            -1.000432865,
                            -0.978423781,
                            -0.62940692,
                            0.242860414,
                            1.426756488,
                        ): "The product of z' and theta' has the factor "
                        "cosine: where the rod hangs straight down, the bob moves along the rail.",
                        (
                            0.0,
                            0.441296066,
                            0.818472572,
                            0.496825424,
                            -0.377481292,
                            -1.102004972,
                            -1.273782311,
                            -0.891006549,
                            -0.738595313,
                            -0.340078095,
                            0.473246914,
                            1.471154849,
                        ): "The product of z' and theta' appears twice in the square, (a + b)^2 = a^2 + 2 a b + b^2.",
                        (
                            0.0,
                            0.40568892,
                            0.619806108,
                            0.013708158,
                            -0.956273239,
                            -1.238724207,
                            -0.599911299,
                            0.339503396,
                            0.30881013,
                            -0.035522013,
                            -0.0425376,
                            0.371228055,
                        ): "The kinetic energy is half of m v^2, for the bob as well as for the carriage.",
                        (
                            0.0,
                            0.517807162,
                            0.909186472,
                            0.433786917,
                            -0.518643321,
                            -0.980471085,
                            -0.605001536,
                            0.233508414,
                            0.29969884,
                            0.117525387,
                            0.198956704,
                            0.539529573,
                        ): "The bob is at z + l sin(theta): it is to the right "
                        "where theta > 0. Your product of z' and theta' has the other sign.",
                        (
                            0.0,
                            0.402921121,
                            0.598573549,
                            -0.017050955,
                            -0.940141915,
                            -1.155763755,
                            -0.497271217,
                            0.400004101,
                            0.290888491,
                            -0.097990531,
                            -0.07061865,
                            0.419281936,
                        ): "Rayleigh's function is half the power lost, c theta'^2/2. Yours makes the bearing twice as strong.",
                        (
                            0.0,
                            0.38683385,
                            1.174397083,
                            2.727370286,
                            6.125847114,
                            13.21910969,
                            25.823707072,
                            47.737134681,
                            91.755287176,
                            176.807871307,
                            344.114836129,
                            670.987324904,
                        ): "The carriage runs away: the coupler pulls it towards the handle with +F_c, forces={z: F_c}.",
                        (
                            0.0,
                            -0.402192838,
                            -0.593062574,
                            0.036396408,
                            0.976202977,
                            1.190591263,
                            0.501293686,
                            -0.438634664,
                            -0.348550123,
                            0.061512887,
                            0.074157944,
                            -0.388594836,
                        ): "The sign is wrong: the force on the environment is the force on the carriage, force=F_c.",
                        (
                            0.0,
                            0.394243206,
                            0.555110242,
                            -0.091685517,
                            -0.993018889,
                            -1.149281644,
                            -0.432670189,
                            0.487902494,
                            0.345039405,
                            -0.107128482,
                            -0.117386441,
                            0.383497976,
                        ): SMALL_ANGLES,
                        (
                            0.0,
                            0.403363366,
                            0.595221845,
                            -0.034372184,
                            -0.976588785,
                            -1.195078641,
                            -0.508217605,
                            0.432990085,
                            0.34723273,
                            -0.058971958,
                            -0.071081422,
                            0.389153226,
                        ): SMALL_ANGLES,
                        (
                            0.0,
                            0.401328501,
                            0.590790569,
                            -0.039190905,
                            -0.97760978,
                            -1.189458909,
                            -0.498342695,
                            0.441493229,
                            0.349592336,
                            -0.062462648,
                            -0.075683647,
                            0.388133605,
                        ): SMALL_ANGLES,
                        (
                            0.0,
                            0.402288121,
                            0.595437382,
                            -0.021529536,
                            -0.944946259,
                            -1.161968821,
                            -0.494844203,
                            0.422920002,
                            0.325680536,
                            -0.074067751,
                            -0.068383287,
                            0.406565469,
                        ): "The bob's centrifugal force on the carriage, "
                        "m l theta'^2 sin(theta), is missing: differentiate theta' cos(theta) as a product.",
                        (
                            0.0,
                            0.394700161,
                            0.862744684,
                            0.981176619,
                            0.705639762,
                            0.296547241,
                            -0.140453221,
                            -0.59540842,
                            -1.616538211,
                            -2.643536863,
                            -3.370423332,
                            -3.596984852,
                        ): "Nothing moves the carriage: the coupler's force must also act on it, forces={z: F_c}.",
                    },
                ),
                Case(
                    LED_FROM_THERE,
                    {
                        "F": [0.0, -0.057807162, 0.072953372, 0.151111025, -0.000989807, -0.323498769],
                        "theta": [0.3, 0.293299743, 0.275994145, 0.24520215, 0.194507145, 0.134064576],
                    },
                    slips=(
                        (
                            {"F": (1.0, 0.518908738, -0.098038761, -0.549047431, -0.662341309, -0.466537137)},
                            "The carriage begins "
                            "at 0, far from the handle, and the coupler jerks it there: hl.coordinate with initial=x(n).",
                        ),
                    ),
                ),
            ),
            hint="What are the bob's velocities along the rail and upwards? What are both kinetic energies and its height?",
            matters=(
                "The paddle measures only its handle. The motion of the pendulum is computed, and you feel it through one force."
            ),
        ),
        Exercise(
            "coupler_stiffness",
            points=1,
            asks="the largest K [N/m] that b pays for, in addition to b_c",
            cases=(
                Case(
                    {"b": 0.1, "T": 1e-3, "b_c": 0.02},
                    160.0,
                    unit="N/m",
                    slips={
                        200.0: OWN_DAMPER,
                        80.0: "The hold delays by half a period on average, so b pays for K T/2, not K T.",
                        240.0: "A virtual damper does not help to pay: |B| stands on the other side of Eq. (23.10).",
                        320.0: TWO_ONCE,
                        40.0: HALF_INVERTED,
                        1.6e-4: TIMES_T,
                        -19.8: BRACKETS,
                    },
                ),
                Case(
                    {"b": 2.0, "T": 2e-3, "b_c": 0.5},
                    1500.0,
                    unit="N/m",
                    slips={
                        2000.0: OWN_DAMPER,
                        3000.0: TWO_ONCE,
                        375.0: HALF_INVERTED,
                        3.0: NO_PERIOD,
                        0.006: TIMES_T,
                        -246.0: BRACKETS,
                    },
                ),
            ),
            hint="How much of b is left for the spring after it has paid for b_c? How much damping does each N/m need?",
            matters="The hand meets the coupler first, so its stiffness limits how hard anything behind it can feel.",
        ),
        Exercise(
            "felt_wall",
            points=1,
            asks="the stiffness [N/m] that is felt of a wall k behind a coupler K",
            cases=(
                Case(
                    {"K": 160.0, "k": 500.0},
                    121.212121212,
                    unit="N/m",
                    slips={
                        80000.0: PRODUCT,
                        160.0: SOFTER,
                        660.0: "Stiffnesses add in parallel. These are in series, one behind the other: their deflections add.",
                        0.00825: "That is the compliance, in m/N. The stiffness is its inverse.",
                        500.0: "The coupler lies between handle and wall, and it gives way as well.",
                        330.0: MEAN,
                        282.842712475: MEAN,
                        242.424242424: NOT_TWICE,
                        235.294117647: DIFFERENCE,
                    },
                ),
                Case(
                    {"K": 300.0, "k": 100.0},
                    75.0,
                    unit="N/m",
                    slips={
                        30000.0: PRODUCT,
                        100.0: SOFTER,
                        200.0: MEAN,
                        173.205080757: MEAN,
                        150.0: NOT_TWICE,
                        -150.0: DIFFERENCE,
                    },
                ),
            ),
            hint="Do coupler and wall share the force or the deflection? Which quantities add up?",
            matters="A wall behind a coupler never feels stiffer than the coupler, however stiff you make the wall.",
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
                        1.5e-4: "b must also pay for the coupler's own damper b_c.",
                        2e-4: "That is for a coupler as stiff as K_FELT. In series with the wall it must be stiffer.",
                        8e-5: "That is for a coupler as stiff as K_WALL. The hand then feels only half of this stiffness.",
                        6e-5: "The hold needs K T/2, not K T.",
                        5.714285714e-5: "You added the two stiffnesses. Which K gives K_FELT in series with K_WALL?",
                        2.8e-4: "You put K_FELT in series with K_WALL. K_FELT is the result of the series, not a part of it.",
                        1.2e-7: "The period is in seconds: 1 ms is 1e-3 s.",
                    },
                ),
            ),
            rtol=1e-3,
            hint="Which K in series with K_WALL feels like K_FELT? For which T does b pay for this K?",
            matters="This is how to choose a sampling rate for a stiffness that users should feel.",
        ),
        Exercise(
            "swing_frequency",
            points=2,
            asks="the frequency [Hz] of the slower mode, the handle held still",
            rtol=1e-5,
            cases=(
                Case(
                    {"l": 0.15, "g": 9.81, "M": 0.05, "m": 0.05, "K": 150.0},
                    1.272990412,
                    unit="Hz",
                    slips={
                        1.287090266: STILL_CARRIAGE,
                        8.813829239: FASTER,
                        55.378922: "That is the faster mode, and in rad/s. Take the slower mode, and divide by 2 pi.",
                        1.82022051: FREE_CARRIAGE,
                        6.164044441: NO_PENDULUM,
                        8.717275247: NO_PENDULUM,
                        7.998434654: "That is in rad/s. Divide by 2 pi to get hertz.",
                        63.974956916: "That is omega squared. Take its square root, and divide by 2 pi to get hertz.",
                        10.181930627: "That is omega squared divided by 2 pi. Take the square root first.",
                        8.087026647: "That is sqrt(g/l) in rad/s. Divide by 2 pi to get hertz; the coupler also gives way.",
                    },
                ),
                Case(
                    {"l": 0.3, "g": 9.81, "M": 0.1, "m": 0.2, "K": 20.0},
                    0.777200302,
                    unit="Hz",
                    slips={
                        2.635701216: FASTER,
                        0.910110255: STILL_CARRIAGE,
                        1.576357202: FREE_CARRIAGE,
                        1.299494669: NO_PENDULUM,
                        2.25079079: NO_PENDULUM,
                    },
                ),
            ),
            hint="When do two homogeneous equations for two amplitudes have a nonzero solution? Which of the two frequencies "
            "goes to sqrt(g/l) for a stiff coupler?",
            matters=("The coupler changes what you feel of the pendulum. A good rendering keeps this change small and known."),
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
                        "a": "A mass stores energy and gives it back, so it dissipates nothing. Try a hand that is only a mass, "
                        "hl.Hand(m=0.02), at 640 N/m.",
                        "b": "This hand is a mass, a spring and a damper: it does not react. A real hand also reacts too late "
                        "for chatter of more than 10 Hz.",
                    },
                ),
            ),
            hint="What happens with hands that have only a mass, only a spring, or only a damper?",
            matters=("A stability limit holds for the hand that was assumed. In another hand the same scene may chatter."),
        ),
        Exercise(
            "discussion",
            kind="text",
            asks="two ways to a wall that feels like 2000 N/m, with numbers, in 60 words or more",
            least_words=60,
        ),
    ),
)
