"""Public checks of lab 05: numbers and the sentences that teach; no answers."""

from hapticlab.course.exercise import Case, Exercise, Lab

STORED = "That is the increase in stored energy. The leak is this increase minus the work of the held force, F_e(n) D."
TAKEN = "That is the work of the held force. The leak is the increase in stored energy minus this work."
NEXT = "F_e(n+1) acts in the next period. In this period the motor holds F_e(n) = K x(n)."
NO_T = "The loss is b v times the displacement D, with v = D/T: one division by T is missing."
FORCE = "That is the damper's force b D/T. The loss is this force times the displacement."
NO_HALF = (
    "The factor 1/2 belongs to a spring, whose force grows with the displacement. Here the force is constant for the period."
)
TAKES = (
    "The force on the environment times the displacement is the energy that the damper takes in. It gives the negative of this."
)
HELD = "The held force uses the velocity of the last period, -D/T, so it acts opposite to the motion of this period."
SIGNED = "Keep the sign of B: a negative B changes which of the two motions draws energy."
LATE = (
    "You paired F[n] with the displacement that ends at x[n]. F[n] acts after this sample, from x[n] to x[n+1]. With your "
    "pairing a wall that leaks seems to dissipate."
)
MEAN = "The mean of two forces is right for a steel spring. The motor holds F[n] until the next sample."
PERIODS = "Those are the works of single periods. W is their running sum."
NO_HALF_T = "The factor T/2 is missing."
ADVANCED = "H is taken at z = e^(j theta), and a past sample x(n-i) belongs to z^-i, so its factor is e^(-j i theta)."
PRODUCT = "Take the real part of the product, not the product of the real parts."
NO_TURN = "That is only K times the radius. The map also divides by |1 + H c|."
TWICE = "Your c is twice as large as expected: its factor is T/(4b), not T/(2b)."
REAL = "c is complex: its imaginary part, -(T/4b) cot(theta/2), also belongs in 1 + H c."
REAL_RADIUS = "The radius is |c| with its imaginary part included, and the map divides by |1 + H c|."
MINUS = "The loop is 1 + H G, and the disk of G is about +c, whose real part is negative: use 1 + H c."
NOTHING_OWED = "The credit is not negative, so the controller must not act."

LAB = Lab(
    number="05",
    title="Passivity, a guarantee for every hand",
    minutes=120,
    exercises=(
        Exercise("prediction", kind="prediction", asks="the stiffest wall that is stable under the light finger [N/m]"),
        Exercise(
            "period_energy",
            points=2,
            asks='{"leak": energy that the wall can give back beyond its work, "loss": smallest loss of the damper} [J]',
            cases=(
                Case(
                    {"x": 0.003, "D": 4e-4, "K": 300.0, "b": 0.1, "T": 1e-3},
                    {"leak": 2.4e-5, "loss": 1.6e-5},
                    unit="J",
                    slips=(
                        ({"leak": 3.84e-4}, STORED),
                        ({"leak": 3.6e-4}, TAKEN),
                        ({"leak": -2.4e-5}, NEXT),
                        ({"loss": 1.6e-8}, NO_T),
                        ({"loss": 0.04}, FORCE),
                    ),
                ),
                Case(
                    {"x": 0.002, "D": -5e-4, "K": 120.0, "b": 0.25, "T": 2e-3},
                    {"leak": 1.5e-5, "loss": 3.125e-5},
                    unit="J",
                    slips=(
                        ({"leak": -1.05e-4}, STORED),
                        ({"leak": -1.2e-4}, TAKEN),
                        ({"leak": -1.5e-5}, NEXT),
                        ({"loss": 6.25e-8}, NO_T),
                        ({"loss": -0.0625}, FORCE),
                    ),
                ),
            ),
            rtol=1e-5,
            hint="How much energy does the spring store before and after? What are the work of the held force and the "
            "loss at v = D/T?",
            matters=(
                "Where the loss is at least as large as the leak in every period, no motion of the handle gains "
                "energy."
            ),
        ),
        Exercise(
            "damper_gives",
            points=2,
            asks='{"slow": ..., "alternating": ...}, the energy [J] that the held virtual damper gives in a period',
            cases=(
                Case(
                    {"D": 4e-4, "B": 0.25, "T": 1e-3},
                    {"slow": -4e-5, "alternating": 4e-5},
                    unit="J",
                    slips=(
                        ({"slow": 4e-5}, TAKES),
                        ({"alternating": -4e-5}, HELD),
                        ({"slow": -4e-8}, NO_T),
                        ({"alternating": 4e-8}, NO_T),
                        ({"slow": -0.1}, FORCE),
                        ({"alternating": 0.1}, FORCE),
                        ({"slow": -2e-5}, NO_HALF),
                        ({"alternating": 2e-5}, NO_HALF),
                    ),
                ),
                Case(
                    {"D": -5e-4, "B": -0.3, "T": 2e-3},
                    {"slow": 3.75e-5, "alternating": -3.75e-5},
                    unit="J",
                    slips=(
                        ({"slow": -3.75e-5}, SIGNED),
                        ({"alternating": 3.75e-5}, SIGNED),
                        ({"slow": 1.875e-5}, NO_HALF),
                        ({"alternating": -1.875e-5}, NO_HALF),
                    ),
                ),
            ),
            rtol=1e-5,
            hint="Which force is held after sample n? Does the handle move with that force or against it, and does the damper "
            "therefore take in energy or give it out?",
            matters="A virtual damper acts one period late, so it cannot replace a real damper in fast motion.",
        ),
        Exercise(
            "observed_energy",
            points=2,
            asks="W [J], the work done on the environment until each sample, an array as long as x",
            cases=(
                Case(
                    {"x": [0.0, 0.002, 0.001, 0.003], "F": [1.0, 2.0, -0.5, 0.25]},
                    [0.0, 0.002, 0.0, -0.001],
                    unit="J",
                    slips={
                        (0.0, 0.004, 0.0045, 0.005): LATE,
                        (0.0, 0.003, 0.00225, 0.002): MEAN,
                        (0.0, 0.002, -0.002, -0.001): PERIODS,
                    },
                ),
                Case(
                    {
                        "x": [-0.001, 0.001, 0.003, 0.005, 0.004, 0.002, -0.001],
                        "F": [0.0, 0.1, 0.3, 0.5, 0.4, 0.2, 0.0],
                    },
                    [0.0, 0.0, 0.0002, 0.0008, 0.0003, -0.0005, -0.0011],
                    unit="J",
                    slips={(0.0, 0.0002, 0.0008, 0.0018, 0.0014, 0.001, 0.001): LATE},
                ),
            ),
            hint="Which sample's force does the motor hold while the handle moves to x[n]? Which displacements come before x[n]?",
            matters="A controller can compute this sum while the wall runs, without a model of the hand.",
        ),
        Exercise(
            "damping_asked",
            points=1,
            asks="the damping [N s/m] that motion at theta requires from the device",
            cases=(
                Case({"taps": [100.0], "theta": 1.0, "T": 1e-3}, 0.05, unit="N s/m", slips={100.0: NO_HALF_T}),
                Case({"taps": [150.0, -50.0], "theta": 3.141592653589793, "T": 1e-3}, 0.1, unit="N s/m"),
                Case(
                    {"taps": [200.0, -150.0, 50.0], "theta": 2.356194490192345, "T": 1e-3},
                    0.12071067811865475,
                    unit="N s/m",
                    slips={
                        0.18535533905932738: ADVANCED,
                        0.15303300858899108: PRODUCT,
                    },
                ),
            ),
            hint="Which power of e^(j theta) belongs to a sample that is i periods old? (Python writes j as 1j.)",
            matters="The same calculation compares any two linear laws, whatever idea they were derived from.",
        ),
        Exercise(
            "disk_size",
            points=1,
            asks="|M| of the plain wall at theta",
            cases=(
                Case({"K": 150.0, "theta": 3.141592653589793, "b": 0.1, "T": 1e-3}, 0.6, slips={0.375: NO_TURN}),
                Case(
                    {"K": 300.0, "theta": 1.5707963267948966, "b": 0.1, "T": 1e-3},
                    1.3416407864998736,
                    slips={
                        1.0606601717798214: NO_TURN,
                        0.24576957615571218: TWICE,
                        4.242640687119286: REAL,
                        0.5570860145311556: MINUS,
                        0.75: REAL_RADIUS,
                    },
                ),
                Case(
                    {"K": 200.0, "theta": 0.3, "b": 0.1, "T": 1e-3},
                    1.0,
                    slips={
                        3.3458662238591175: NO_TURN,
                        0.5990558661790127: TWICE,
                        6.691732447718235: REAL,
                        0.5: REAL_RADIUS,
                    },
                ),
            ),
            hint="c is complex: what is its magnitude, and by what does the map divide? (Python writes j as 1j.)",
            matters="While this size stays below 1 at every frequency, no passive hand can make the loop unstable.",
        ),
        Exercise(
            "controlled_force",
            points=1,
            asks="the force [N] with the series passivity controller",
            cases=(
                Case(
                    {"f": 1.0, "credit": -2e-6, "D": 1e-4, "T": 1e-3, "alpha_max": 5.0},
                    1.02,
                    unit="N",
                    slips={
                        0.98: "Add the damper to F, the force on the environment: on the way in, the handle must do more work.",
                        1.00002: "The force of the damper is alpha times the velocity D/T, not times D.",
                        1.5: "alpha = -credit T/D^2: without the factor T it is too large, and alpha_max hides this.",
                    },
                ),
                Case(
                    {"f": 0.5, "credit": -2e-4, "D": -2e-4, "T": 1e-3, "alpha_max": 1.0},
                    0.3,
                    unit="N",
                    slips={
                        -0.5: "alpha must not exceed alpha_max. The controller takes back the rest in later periods.",
                        0.7: "On the way out D < 0, and the damper reduces the force on the handle: keep the sign of D.",
                    },
                ),
                Case(
                    {"f": 0.8, "credit": 1e-4, "D": 1e-4, "T": 1e-3, "alpha_max": 5.0},
                    0.8,
                    unit="N",
                    slips={
                        -0.2: NOTHING_OWED,
                        0.3: NOTHING_OWED,
                        1.3: NOTHING_OWED,
                    },
                ),
                Case({"f": 0.8, "credit": -1e-4, "D": 0.0, "T": 1e-3, "alpha_max": 5.0}, 0.8, unit="N"),
            ),
            hint="In which two cases does the controller do nothing? What limits alpha in all other cases?",
            matters=(
                "The controller adds damping only when the observed energy requires it, so a well-behaved wall "
                "feels unchanged."
            ),
        ),
        Exercise(
            "why_it_failed",
            kind="choice",
            points=1,
            asks='"a", "b", "c" or "d"',
            options={
                "a": "stirring filled the credit, and the controller waits until the chatter has spent it",
                "b": "the damper of the honey, held for a period, generates the energy of the chatter",
                "c": "alpha_max is too small",
                "d": "the encoder hides the energy",
            },
            cases=(
                Case(
                    {},
                    "a",
                    slips={
                        "b": "b = 0.1 pays for a honey of 0.05. Also, the finger is not in the honey while it leans.",
                        "c": "The same alpha_max was enough for the same wall without stirring: compare the credits.",
                        "d": "The first run had the same encoder and came to rest: compare the credits.",
                    },
                ),
            ),
            hint="What was the credit on arrival in the three runs? When does the controller act?",
            matters="A guarantee about the total energy does not mean that the wall behaves well at each moment.",
        ),
        Exercise("discussion", kind="text", least_words=60, asks="your comparison, in 60 words or more"),
    ),
)  # fmt: skip
