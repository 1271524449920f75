"""Public checks of lab 12: numbers and the sentences that teach; no answers."""

from hapticlab.course.exercise import Case, Exercise, Lab

FRACTION = "That is a fraction of the period. Multiply it by 100 to get percent."
NO_REST = "Sensor, motor and link also need their cycles in every period: add rest."
INVERSE_LOAD = "That is the inverse: the cycles of a period divided by those of a tick."
TIMES_T = "A period has hz T cycles. Divide by both hz and T."
LINEAR = "That is right for order 1 only. Solve error = C h^p for h: the ratio of the errors needs the power 1/p."
POWER = "That is the power p of the ratio. Solve for h: the power is 1/p."
TURNED = "The ratio is the wrong way round: a smaller error needs a smaller step."
NO_FILTER = "That is the margin without a filter. The filter divides B by 1 + 2 tau/T."
HALF_FILTER = "In the worst case v(n-1) = -v(n), so the denominator is 2 tau + T, not tau + T."
SIGN = "The sign is wrong: the margin is the damping of the paddle minus the damping that is required."
NO_HOLD = "The hold is missing: the spring requires K T/2."
WHOLE_T = "The hold delays the force by T/2 on average, so the spring requires K T/2, not K T."
FILTERED_SPRING = "The filter is in the path of the velocity. The spring uses the position, so its K T/2 stays."
ALL_BETTER = "A figure may be equal. Only one of the three must be better."
SAME = "A design does not dominate its equal: at least one figure must be better."
MARGIN_TOO = "Of the margin more is better; of error and load less is better."
ANY = "No figure may be worse. One better figure alone is not enough."
JITTER = "The backward difference turns each count into a jump of the force, and B counts fully in the required damping."
WINDOW = "The window computes four slopes in every tick. Is its lower error worth twice the cycles?"
FAR = "Ellis's law looks furthest ahead and amplifies what the encoder adds. Its margin is the smallest of all laws."
SMOOTH = "A long filter is late: the velocity is tau old when it acts. Try a tau of a few periods."
SLOW_WALL = "A long period is cheap, but the hold alone costs K T/2 of margin, and the error grows with T."
MILLI = "T is in seconds: 1 ms is 0.001."
LATE = "The solver takes the handle as resting during the step, so it is half a period late (lab 07). Change the hold."
EULER = "Forward Euler feeds energy into an oscillation: it needs more than K h of damping (lab 07)."
FOUR = "Four evaluations leave little of the board. The error of the hold and of the encoder stays in any case."
SHORT = "The contact needs at least ten steps. A substep is cheaper than a shorter period."
LARGE = "A method that locates events or solves exactly needs a program of many kilobytes here."

LAB = Lab(
    number="12",
    title="Speed against accuracy under a budget",
    minutes=120,
    exercises=(
        Exercise("prediction", kind="prediction", asks="load of RK4 at 1 kHz divided by load of semi-implicit Euler at 4 kHz"),
        Exercise(
            "load_percent",
            points=1,
            asks="the load of the board [%] for a period T [s]",
            cases=(
                Case(
                    {"cycles": 6000.0, "rest": 2000.0, "T": 1e-3, "hz": 16e6},
                    50.0,
                    unit="%",
                    slips={0.5: FRACTION, 37.5: NO_REST, 200.0: INVERSE_LOAD, 0.05: TIMES_T},
                ),
                Case(
                    {"cycles": 9000.0, "rest": 3000.0, "T": 2e-3, "hz": 48e6},
                    12.5,
                    unit="%",
                    slips={0.125: FRACTION, 9.375: NO_REST, 800.0: INVERSE_LOAD, 0.025: TIMES_T},
                ),
            ),
            hint="How many cycles does one period have? How many of them does a tick take?",
            matters="A part of the load comes in every period, whatever the method does.",
        ),
        Exercise(
            "step_for",
            points=1,
            asks="the step [s] at which the error is the wanted one",
            cases=(
                Case(
                    {"wanted": 0.5, "h": 2e-3, "error": 8.0, "order": 2},
                    5e-4,
                    unit="s",
                    slips={1.25e-4: LINEAR, 7.8125e-6: POWER, 8e-3: TURNED},
                ),
                Case(
                    {"wanted": 0.1, "h": 1e-3, "error": 1.6, "order": 4},
                    5e-4,
                    unit="s",
                    slips={6.25e-5: LINEAR, 1.52587890625e-8: POWER, 2e-3: TURNED},
                ),
            ),
            hint="By which factor must the error fall? Which factor of the step does that need?",
            matters="Of a method of order 1, half the error costs twice the cycles.",
        ),
        Exercise(
            "wall_margin",
            points=1,
            asks="the passivity margin [N s/m] of a wall with a filtered velocity",
            cases=(
                Case(
                    {"b": 1.0, "K": 500.0, "B": 2.0, "T": 1e-3, "tau": 2e-3},
                    0.35,
                    unit="N s/m",
                    slips={
                        -1.25: NO_FILTER,
                        0.0833333333333334: HALF_FILTER,
                        -0.35: SIGN,
                        0.6: NO_HOLD,
                        0.1: WHOLE_T,
                        0.55: FILTERED_SPRING,
                    },
                ),
                Case(
                    {"b": 1.5, "K": 400.0, "B": 1.5, "T": 2e-3, "tau": 5e-3},
                    0.85,
                    unit="N s/m",
                    slips={
                        -0.4: NO_FILTER,
                        0.6714285714285714: HALF_FILTER,
                        -0.85: SIGN,
                        1.25: NO_HOLD,
                        0.45: WHOLE_T,
                        1.1833333333333333: FILTERED_SPRING,
                    },
                ),
                Case({"b": 0.6, "K": 300.0, "B": 0.2, "T": 1e-3, "tau": 0.0}, 0.25, unit="N s/m", slips={-0.25: SIGN}),
            ),
            hint="What does v(n) become when x(n) = -x(n-1)? Compare it with 2 x(n)/T.",
            matters="A filter buys margin and pays with error, because it is late.",
        ),
        Exercise(
            "dominates",
            points=1,
            asks="whether mine dominates other, each (error [%], load [%], margin [N s/m])",
            cases=(
                Case({"mine": [1.0, 40.0, 0.2], "other": [1.5, 45.0, 0.1]}, True, slips={False: MARGIN_TOO}),
                Case({"mine": [1.0, 40.0, 0.2], "other": [1.0, 45.0, 0.2]}, True, slips={False: ALL_BETTER}),
                Case({"mine": [1.0, 40.0, 0.2], "other": [1.0, 40.0, 0.2]}, False, slips={True: SAME}),
                Case({"mine": [1.0, 40.0, 0.2], "other": [1.5, 45.0, 0.3]}, False, slips={True: MARGIN_TOO}),
                Case({"mine": [1.0, 40.0, 0.2], "other": [2.0, 35.0, 0.1]}, False, slips={True: ANY}),
            ),
            hint="Which of the three figures may be equal? Of which figure is more better?",
            matters="Which design of the front is chosen, no formula decides.",
        ),
        Exercise(
            "wall_design",
            kind="design",
            points=2,
            full=4,
            asks="a design of the wall: T [s], law, velocity, and tau [s] of a filter",
            cases=(
                Case(
                    {"task": "wall"},
                    {
                        "A": [0.345, 32.9, -0.45],
                        "B": [0.274, 44.7, -0.182],
                        "C": [0.25, 57.0, -0.237],
                        "D": [0.491, 57.1, -1.625],
                        "E": [0.521, 59.0, -1.125],
                        "F": [0.295, 63.7, -0.01],
                        "G": [0.224, 64.6, 0.475],
                        "H": [0.539, 65.7, -1.25],
                    },
                    slips=(
                        ({"T": 1.0}, MILLI),
                        ({"law": "ellis", "velocity": "backward"}, FAR),
                        ({"velocity": "window"}, WINDOW),
                        ({"velocity": "backward"}, JITTER),
                        ({"T": 4e-3}, SLOW_WALL),
                        ({"tau": 2e-2}, SMOOTH),
                    ),
                ),
            ),
            hint="Which of the three figures keeps your design from the nearest point? Which name changes that figure most?",
            matters="A filter and a predictor cost a few percent of load and move the other two figures.",
        ),
        Exercise(
            "mass_design",
            kind="design",
            points=2,
            full=4,
            asks="a design of the mass behind a coupler: method, T [s], substeps, hold",
            cases=(
                Case(
                    {"task": "mass"},
                    {
                        "A": [4.61, 20.9, -2.181],
                        "B": [4.14, 22.3, -3.806],
                        "C": [10.5, 32.7, -2.316],
                        "D": [10.1, 33.4, -1.991],
                        "E": [9.26, 37.3, -3.024],
                        "F": [10.2, 62.2, -2.015],
                        "G": [1.33, 65.8, 0.611],
                        "H": [2.75, 78.9, 0.6],
                    },
                    slips=(
                        ({"method": "euler"}, EULER),
                        ({"method": "rk4", "hold": "zoh"}, LATE),
                        ({"method": "verlet", "hold": "zoh"}, LATE),
                        ({"method": "exact", "hold": "zoh"}, LATE),
                        ({"method": "rk4", "hold": "soh"}, FOUR),
                        ({"method": "rk4", "hold": "foh"}, FOUR),
                    ),
                ),
            ),
            hint="What does the hold assume of the handle? Does the board do something useful with its cycles?",
            matters="The cheapest method at a shorter period may beat a better one that has to wait.",
        ),
        Exercise(
            "bumper_design",
            kind="design",
            points=2,
            full=4,
            asks="a design of the mass that strikes a bumper: method, T [s], substeps, hold",
            cases=(
                Case(
                    {"task": "bumper"},
                    {
                        "A": [2.7, 42.2, -0.045],
                        "B": [2.13, 44.7, 0.236],
                        "C": [4.02, 45.2, -2.012],
                        "D": [2.99, 48.9, -0.423],
                        "E": [2.48, 50.8, -0.15],
                        "F": [1.66, 64.0, 0.503],
                        "G": [0.812, 68.4, 0.7],
                        "H": [0.747, 78.3, 0.749],
                    },
                    slips=(
                        ({"method": "taylor"}, LARGE),
                        ({"method": "exact"}, LARGE),
                        ({"method": "euler"}, EULER),
                        ({"T": 2e-3, "substeps": 1.0}, SHORT),
                        ({"T": 4e-3}, SHORT),
                        ({"method": "verlet", "hold": "zoh"}, LATE),
                    ),
                ),
            ),
            hint="How many steps lie in the shortest contact? Is a substep or a shorter period cheaper?",
            matters="A contact sets the step, and the board sets the period.",
        ),
        Exercise("discussion", kind="text", least_words=60, asks="one of your designs, defended, in at least 60 words"),
    ),
)
