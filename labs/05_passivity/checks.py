"""Public checks of lab 05: numbers and the sentences that teach; no answers."""

from hapticlab.course.exercise import Case, Exercise, Lab

STORED = "That is what the spring stores more at the end; the leak is that less what the held force took in, F_e(n) D."
TAKEN = "That is what the held force took in; the leak is what the spring holds more at the end, less that."
NEXT = "F_e(n+1) acts in the next period. In this one the motor holds F_e(n) = K x(n)."
NO_T = "The loss is b v times the way D, with v = D/T: one division by T is missing."
FORCE = "That is the damper's force b D/T; the loss is that force times the way D."
NO_HALF = "The spring leaks K D^2/2, half of K D^2: so K is 2 (b - |B|)/T."
SIGNED = "|B| counts, of either sign: a negative virtual damper feeds slow motion, a positive one fast motion."
LATE = (
    "F[n] is paired with the way that led to x[n]. It acts after that sample: from x[n] to x[n+1]. Paired so, a wall "
    "that leaks looks like one that dissipates."
)
MEAN = "The mean of two forces is right for a spring of steel; the motor holds F[n] all the way to the next sample."
PERIODS = "Those are the works of single periods; W adds them up."
NEGATIVE = "b does not even pay for |B|: no wall is passive, and the largest K is 0, not negative."
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
        Exercise("prediction", kind="prediction", asks="the stiffest wall that no hand can set chattering [N/m]"),
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
            hint="insert W(x) = K x^2/2 and F_e(n) = K x(n); x drops out. The damper's force at v = D/T acts along D.",
        ),
        Exercise(
            "passive_stiffness",
            points=2,
            asks="the largest K [N/m] that Eq. (23.10) allows",
            cases=(
                Case({"b": 0.1, "B": 0.0, "T": 1e-3}, 200.0, unit="N/m", slips={100.0: NO_HALF}),
                Case({"b": 0.3, "B": 0.1, "T": 1e-3}, 400.0, unit="N/m", slips={200.0: NO_HALF, 800.0: SIGNED}),
                Case({"b": 0.5, "B": -0.3, "T": 2e-3}, 200.0, unit="N/m", slips={100.0: NO_HALF, 800.0: SIGNED}),
                Case(
                    {"b": 0.1, "B": -0.25, "T": 1e-3},
                    0.0,
                    unit="N/m",
                    slips={
                        -300.0: NEGATIVE,
                        -150.0: NEGATIVE,
                        700.0: SIGNED,
                    },
                ),
            ),
            hint="solve b = K T/2 + |B| for K; below zero there is none.",
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
            hint="W[0] = 0, then W[n] = W[n-1] + F[n-1] (x[n] - x[n-1]); see numpy.diff and numpy.cumsum.",
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
            hint="numpy.exp(-1j * theta * numpy.arange(len(taps))) holds all powers of 1/z; .real takes the real part.",
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
            hint="c is a complex number in Python: -T/(4*b) * (1 + 1j/np.tan(theta/2)); abs() of it is the radius.",
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
            hint="first the two cases in which it does nothing (credit >= 0, D = 0); then alpha, then f + alpha D/T.",
        ),
        Exercise(
            "why_it_failed",
            kind="choice",
            points=1,
            asks='"a", "b", "c" or "d"',
            options={
                "a": "the honey is itself not passive",
                "b": "stirring filled the credit, and the controller waits until the chatter has spent it",
                "c": "alpha_max is too small",
                "d": "the encoder hides the energy",
            },
            cases=(
                Case(
                    {},
                    "b",
                    slips={
                        "a": "While it leans the finger is not in the honey; and what honey takes is credit, not debt.",
                        "c": "The same alpha_max settled the same wall where nobody had stirred: look at the credits.",
                        "d": "The same encoder was there in the first run, which settled: look at the credits.",
                    },
                ),
            ),
            hint="compare the credit on arrival in the three runs; when does the controller act?",
        ),
        Exercise("discussion", kind="text", least_words=60, asks="your comparison, at least 60 words"),
    ),
)  # fmt: skip
