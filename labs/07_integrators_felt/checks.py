"""Public checks of lab 07: numbers and the sentences that teach; no answers."""

from hapticlab.course.exercise import Case, Exercise, Lab

EXPLICIT = "That is forward Euler. In semi-implicit Euler z moves with the new velocity."
DAMPED_TOO = "The new velocity moves z and contains the damper, so the damper also appears in the upper row."
LATE = "The acceleration belongs to the start of the step: first the new velocity from the old z, then the new z."
PULL = "The coupler pulls the mass towards the handle: K (x - z), not K (z - x)."
NO_DAMPER = "The damper is missing: -b u, with the handle at rest."
FEEDING = "The sign of the damper is wrong: it acts against u."
SWAPPED = "Rows and columns are exchanged: each row gives one new value from both old ones."
DETERMINANT = "That is the determinant, which multiplies the square of the amplitude. Take its square root."
UNDAMPED = "That is the growth without the damper: 1 - h b/m also belongs to the determinant."
TRACE = "That is the trace, the sum of the eigenvalues. The squared magnitude of a pair is its product, the determinant."
ALONG = "The eigenvalues are complex: 1 + j h omega without damping. The magnitude is a root of squares, not 1 + h omega."
LESS = "The exercise asks for the factor itself, slightly above 1, not for the excess over 1."
NO_B = "That is the step without damping, 2/omega. The damper shortens it: 4 - 2 h b/m - h^2 K/m = 0."
TWO_OMEGA = "That is 2 omega. Without damping the step is 2/omega."
OTHER_ROOT = "The equation for h has two roots. The other root is negative, and this is its magnitude: check the sign of b."
HALF = "Check the 2 in the denominator: h^2 K/m + 2 h b/m - 4 = 0 has the roots (-b +- sqrt(b^2 + 4 K m))/K."
INVERSE = "That is the slope of log(h) against log(error). The order is the slope of log(error) against log(h)."
STRAIGHT = "That is the slope of the errors themselves. A power law is a straight line if both axes are logarithmic."
CONSTANT = "That is log(C): numpy.polyfit returns the slope first."
TWO_POINTS = "That is the slope between two of the points. Fit the line to all of them."
FULL = "That period is used completely. Only the fraction load of it may be used."
TIMES = "To leave some of the period free, it must be longer: divide by load."
NO_REST = "Sensor, motor and link also need their cycles in every tick: add rest."
RATE = "That is the rate in Hz. The period is its reciprocal."
FREE = "load is the fraction that is used, not the fraction that stays free."

LAB = Lab(
    number="07",
    title="Integrators, felt",
    minutes=120,
    exercises=(
        Exercise("prediction", kind="prediction", asks="error of semi-implicit Euler divided by that of RK4"),
        Exercise(
            "step_matrix",
            points=2,
            asks="the 2x2 array that takes (z - x, u) over one step of semi-implicit Euler",
            cases=(
                Case(
                    {"m": 0.05, "K": 200.0, "b": 0.5, "h": 0.01},
                    [[0.6, 0.009], [-40.0, 0.9]],
                    slips={
                        ((1.0, 0.01), (-40.0, 0.9)): EXPLICIT,
                        ((0.6, 0.01), (-40.0, 0.9)): DAMPED_TOO,
                        ((0.6, 0.01), (-40.0, 1.0)): NO_DAMPER,
                        ((0.6, 0.011), (-40.0, 1.1)): FEEDING,
                        ((1.4, 0.009), (40.0, 0.9)): PULL,
                        ((0.6, -40.0), (0.009, 0.9)): SWAPPED,
                        ((1.0, 0.01), (-40.0, 0.5)): LATE,
                    },
                ),
                Case(
                    {"m": 0.1, "K": 500.0, "b": 2.0, "h": 0.01},
                    [[0.5, 0.008], [-50.0, 0.8]],
                    slips={
                        ((1.0, 0.01), (-50.0, 0.8)): EXPLICIT,
                        ((0.5, 0.01), (-50.0, 0.8)): DAMPED_TOO,
                        ((0.5, 0.01), (-50.0, 1.0)): NO_DAMPER,
                        ((1.5, 0.008), (50.0, 0.8)): PULL,
                    },
                ),
            ),
            hint="What does one step make of z - x = 1, u = 0? This is one column of the matrix; which start gives the other?",
            matters="The eigenvalues of this matrix describe every motion that the method can produce.",
        ),
        Exercise(
            "euler_growth",
            points=2,
            asks="the factor by which the amplitude grows in a step of forward Euler",
            cases=(
                Case(
                    {"m": 0.05, "K": 800.0, "b": 0.3, "h": 0.002},
                    1.0256705123966467,
                    slips={
                        1.052: DETERMINANT,
                        1.0315037566582101: UNDAMPED,
                        1.988: TRACE,
                        0.02567051239664675: LESS,
                        1.2529822128134704: ALONG,
                    },
                ),
                Case(
                    {"m": 0.1, "K": 500.0, "b": 1.0, "h": 0.002},
                    1.0,
                    slips={1.0099504938362078: UNDAMPED, 1.98: TRACE},
                ),
                Case(
                    {"m": 0.05, "K": 200.0, "b": 0.0, "h": 0.005},
                    1.0488088481701516,
                    slips={1.1: DETERMINANT, 2.0: TRACE, 0.04880884817015163: LESS, 1.316227766016838: ALONG},
                ),
            ),
            hint="What is the product of a complex pair? What is the product of all eigenvalues of a matrix?",
            matters=(
                "A method can generate energy that the equations of motion do not contain, and you feel it as a "
                "growing oscillation."
            ),
        ),
        Exercise(
            "longest_step",
            points=2,
            asks="the longest stable step [s] of semi-implicit Euler",
            cases=(
                Case(
                    {"m": 0.1, "K": 400.0, "b": 4.0},
                    0.023166247903553996,
                    unit="s",
                    slips={0.03162277660168379: NO_B, 0.043166247903554: OTHER_ROOT, 0.011583123951776998: HALF},
                ),
                Case(
                    {"m": 0.2, "K": 300.0, "b": 0.0},
                    0.051639777949432225,
                    unit="s",
                    slips={0.025819888974716113: HALF, 77.45966692414834: TWO_OMEGA},
                ),
                Case(
                    {"m": 0.05, "K": 800.0, "b": 0.1},
                    0.015686882399006133,
                    unit="s",
                    slips={0.015811388300841896: NO_B, 0.015936882399006133: OTHER_ROOT, 0.007843441199503066: HALF},
                ),
            ),
            hint="What are the trace and the determinant of your matrix? Which of the two roots can be a step?",
            matters="Stiff couplers and light bodies need short steps, so this limit bounds what a board can render.",
        ),
        Exercise(
            "order_seen",
            points=2,
            asks="the order p of error = C h^p, the slope of the best line in logarithms",
            cases=(
                Case(
                    {"h": [4e-3, 2e-3, 1e-3, 5e-4], "error": [0.16, 0.04, 0.01, 0.0025]},
                    2.0,
                    slips={0.5: INVERSE, 46.304347826086946: STRAIGHT, 9.210340371976164: CONSTANT},
                ),
                Case(
                    {"h": [4e-3, 2e-3, 1e-3], "error": [25.0, 7.0, 2.5]},
                    1.660964047443683,
                    slips={
                        0.5998268171717914: INVERSE,
                        7714.285714285714: STRAIGHT,
                        12.349266189030837: CONSTANT,
                        1.8365012677171209: TWO_POINTS,
                        1.4854268271702415: TWO_POINTS,
                    },
                ),
            ),
            rtol=1e-5,
            hint="numpy.polyfit(x, y, 1) fits a straight line. What are x and y here?",
            matters=(
                "The order shows how much a shorter step gains. A measured order that is too low reveals an error "
                "elsewhere."
            ),
        ),
        Exercise(
            "why_order_one",
            kind="choice",
            points=1,
            asks='"a", "b", "c" or "d"',
            options={
                "a": "one step per period is too few",
                "b": "float32 has too few digits",
                "c": "the coupler is too stiff",
                "d": "it solves a problem whose handle stands still during each step, half a period late on average",
            },
            cases=(
                Case(
                    {},
                    "d",
                    slips={
                        "a": "Try substeps=4 in the cell below: the error does not change.",
                        "b": "Try dtype='float64' in the cell below: the error does not change. float32 is accurate to 1e-7.",
                        "c": "With hold='soh' the same coupler and the same RK4 have an error that is many times smaller.",
                    },
                ),
            ),
            hint="What is different between the two rows of RK4 in the table?",
            matters="A more accurate method cannot correct an error that is made elsewhere in the loop.",
        ),
        Exercise(
            "shortest_period",
            points=1,
            asks="the shortest period [s] of which a tick uses at most the fraction load",
            cases=(
                Case(
                    {"cycles": 4570.0, "rest": 7000.0, "load": 0.5, "hz": 16e6},
                    0.00144625,
                    unit="s",
                    slips={0.000723125: FULL, 0.0003615625: TIMES, 0.00057125: NO_REST, 691.4433880726016: RATE},
                ),
                Case(
                    {"cycles": 13899.0, "rest": 7000.0, "load": 0.8, "hz": 16e6},
                    0.001632734375,
                    unit="s",
                    slips={
                        0.0013061875: FULL,
                        0.00104495: TIMES,
                        0.001085859375: NO_REST,
                        0.0065309375: FREE,
                    },
                ),
            ),
            hint="How many cycles does a period T have? How many of them may a tick use?",
            matters="The cost of a method limits the sampling rate, and the sampling rate limits the stiffness.",
        ),
        Exercise("discussion", kind="text", least_words=60, asks="your comparison, in 60 words or more"),
    ),
)  # fmt: skip
