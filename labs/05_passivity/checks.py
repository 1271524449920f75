"""Public checks of lab 05: numbers and the sentences that teach; no answers."""

from hapticlab.course.exercise import Case, Exercise, Lab

STORED = "That is what the spring stores more at the end; the leak is that less what the held force took in, F_e(n) D."
TAKEN = "That is what the held force took in; the leak is what the spring holds more at the end, less that."
NEXT = "F_e(n+1) acts in the next period. In this one the motor holds F_e(n) = K x(n)."
NO_T = "The loss is b v times the way D, with v = D/T: one division by T is missing."
FORCE = "That is the damper's force b D/T; the loss is that force times the way D."
NO_HALF = "The half belongs to a spring, whose force grows on the way; this force is held all the way."
TAKES = "The force on the environment times the way is what the damper takes in; what it gives is less than nothing."
HELD = "The held force is that of the last period's velocity, -D/T: it goes the other way than this period's motion."
SIGNED = "Keep the sign of B: below zero it turns which of the two motions is paid for."
LATE = (
    "F[n] is paired with the way that led to x[n]. It acts after that sample: from x[n] to x[n+1]. Paired so, a wall "
    "that leaks looks like one that dissipates."
)
MEAN = "The mean of two forces is right for a spring of steel; the motor holds F[n] all the way to the next sample."
PERIODS = "Those are the works of single periods; W adds them up."
NO_HALF_T = "The factor T/2 is missing."
ADVANCED = "H belongs to z = e^(j theta), and a past sample x(n-i) to z^-i: e^(-j i theta)."
NO_TURN = "That is only K times the radius: the map divides by |1 + H c|."
TWICE = "c is twice too large: with r = -(T/2)(1 + j cot(theta/2)), the disk is about r/(2b)."
REAL = "c is complex; its imaginary part, -(T/4b) cot(theta/2), belongs into 1 + H c as well."
REAL_RADIUS = "The radius is |c|, its imaginary part included, and the map divides by |1 + H c|."
MINUS = "The loop is 1 + H G with G about +c, and c is negative in its real part: 1 + H c."

LAB = Lab(
    number="05",
    title="Passivity, a promise about every hand",
    minutes=120,
    exercises=(
        Exercise("prediction", kind="prediction", asks="the stiffest wall that is stable under the light finger [N/m]"),
        Exercise(
            "period_energy",
            points=2,
            asks='{"leak": what the spring could give back beyond what it took, "loss": least loss of the damper} [J]',
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
            hint="what does the spring hold before and after, and what did the held force take in? What does friction cost?",
            matters=(
                "Where the loss is at least as large as the leak in every period, no motion of the handle gains "
                "energy."
            ),
        ),
        Exercise(
            "damper_gives",
            points=2,
            asks='{"slow": and "alternating": energy [J] that the held virtual damper gives in a period}',
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
            hint="which force is held from x(n) on, and does the handle go on with it or against it? Who gives then?",
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
            hint="which sample's force does the motor hold on the way to x[n]? How many such ways are there until then?",
            matters="A controller can compute this sum while the wall runs, without a model of the hand.",
        ),
        Exercise(
            "damping_asked",
            points=1,
            asks="the damping [N s/m] that motion at theta asks of the device",
            cases=(
                Case({"taps": [100.0], "theta": 1.0, "T": 1e-3}, 0.05, unit="N s/m", slips={100.0: NO_HALF_T}),
                Case({"taps": [150.0, -50.0], "theta": 3.141592653589793, "T": 1e-3}, 0.1, unit="N s/m"),
                Case(
                    {"taps": [200.0, -150.0, 50.0], "theta": 2.356194490192345, "T": 1e-3},
                    0.12071067811865475,
                    unit="N s/m",
                    slips={
                        0.18535533905932738: ADVANCED,
                        0.15303300858899108: "Take the real part of the product, not the product of the real parts.",
                    },
                ),
            ),
            hint="which power of e^(j theta) belongs to a sample that is i periods old? (Python writes j as 1j.)",
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
            hint="c is complex: how large is it, and what does the map divide by? (Python writes j as 1j.)",
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
                        0.98: "The damper adds to F, the force on the environment: going in, the handle must pay more.",
                        1.00002: "The damper's force is alpha times the velocity D/T, not times D.",
                        1.5: "alpha = -credit T/D^2: without the T it is too large, and alpha_max hides it.",
                    },
                ),
                Case(
                    {"f": 0.5, "credit": -2e-4, "D": -2e-4, "T": 1e-3, "alpha_max": 1.0},
                    0.3,
                    unit="N",
                    slips={
                        -0.5: "alpha is to stay below alpha_max; what it cannot take back at once waits.",
                        0.7: "On the way out D < 0, and the damper lowers the force that pushes out: keep D's sign.",
                    },
                ),
                Case(
                    {"f": 0.8, "credit": 1e-4, "D": 1e-4, "T": 1e-3, "alpha_max": 5.0},
                    0.8,
                    unit="N",
                    slips={
                        -0.2: "Nothing is owed: with credit >= 0 the controller does nothing.",
                        0.3: "Nothing is owed: with credit >= 0 the controller does nothing.",
                        1.3: "Nothing is owed: with credit >= 0 the controller does nothing.",
                    },
                ),
                Case({"f": 0.8, "credit": -1e-4, "D": 0.0, "T": 1e-3, "alpha_max": 5.0}, 0.8, unit="N"),
            ),
            hint="in which two cases does it do nothing? What bounds alpha in all others?",
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
                "b": "the honey's damper, held for a period, generates the energy of the chatter",
                "c": "alpha_max is too small",
                "d": "the encoder hides the energy",
            },
            cases=(
                Case(
                    {},
                    "a",
                    slips={
                        "b": "b = 0.1 pays for a honey of 0.05; and while it leans the finger is not in the honey.",
                        "c": "The same alpha_max settled the same wall where nobody had stirred: look at the credits.",
                        "d": "The same encoder was there in the first run, which settled: look at the credits.",
                    },
                ),
            ),
            hint="compare the credit on arrival in the three runs; when does the controller act?",
            matters="A guarantee about the total energy does not mean that the wall behaves well at each moment.",
        ),
        Exercise("discussion", kind="text", least_words=60, asks="your comparison, at least 60 words"),
    ),
)  # fmt: skip
