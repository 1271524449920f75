"""Public checks of lab 15: numbers to compare with, the letter of the choice, and the feedback to typical mistakes."""

from hapticlab.course.exercise import Case, Exercise, Lab

TURNED = "The sign is wrong: your handle pushes the spring in +x where your handle is ahead of the other one."
NO_OTHER = "You used your own position alone. That spring is fixed to the table, and your partner is not in it."
SUM = "You added the two positions. A spring between two handles is stretched by their difference."
ADDED = "You added the two velocities. The damper is at rest when both handles move together, so use the difference."
DAMPER_TURNED = "The damper has the wrong sign. Like the spring, it resists where your handle moves faster than the other one."
ONE_MOTION = "Your two dampings are equal. The heard position has the sign + in one motion and - in the other."
SIGNS = "Both signs of k d are wrong: together, your handle runs ahead of the late position and is held back."
SWAPPED = "These are the right two dampings in the wrong order."
ONCE = "Against each other, your damper sees your own velocity and the other's, which is opposite: its force is 2 b v."
ALSO_TOGETHER = "Together, both handles have the same velocity, and your damper sees only what changed within d, an acceleration."
ROUND_TRIP = "You counted the delay there and back. One message is late by d, and your force contains one message."
NO_COUPLING = "The damper of the coupling is missing. In the motion against each other it helps too."
HAND_ONCE = "Against each other, the damper of the coupling counts twice, as in Exercise 2."
PRODUCT = "You multiplied by the delay. A longer delay must give a lower limit."
ONE_WAY = "You counted one way. Your position travels to the follower, and the answer travels back: 2 d."
BOTH_PLUS = "Position-force is a late spring, K x(t-2d). Its first-order term is -2 d K v: a negative damper."
BOTH_TURNED = "Both signs are wrong: expand x(t-2d) = x - 2d v, and mind the minus sign in the bracket."
FELT_SWAPPED = "These are the right two dampers in the wrong order."
NO_SERIES = "You left out the follower's part k/(k+K). It only moves freely, x_2 = x_1, where K = 0."
ONE_FIRM = "You took the full stiffness of one spring. In contact, k and K are in series: k K/(k+K)."
WAVE_PLUS = "The sign of the wave that arrives is wrong: solve w = (b v - F)/sqrt(2b) for F."
ROOT = "You used sqrt(b). The waves are defined with sqrt(2b), so that u^2/2 is a power."
PAIR_SWAPPED = "These are the right two values in the wrong order: first F, then u."
ECHO = "You send back the wave that arrived. Solve w for F first, then insert F into u."
ALWAYS = "You always use the largest damping. Take back what is owed in this period, and no more."
NO_PERIOD = "That is owed/dx^2, which lacks T: the damper's force is alpha dx/T, and its energy alpha dx^2/T."
GIVEN_ALONE = "You took back everything that this side gave. Only what it gave above the energy that it heard of is owed."
HEARD_FIRST = "The sign is wrong: owed is given - heard. A damper must not be negative."
NOT_LIMITED = "Your damper has no limit. A larger one than alpha_max makes the sampled handle unstable."
AT_REST = "At rest, a damper dissipates nothing, however large it is. Return 0 there."
RISES = "Your factor rises with the silence. It has to fall from 1 to 0."
NO_HOLD = "Your factor falls from the last message on. It has to stay 1 during hold."
NOT_CLIPPED = "Your line continues beyond 0 or 1. A negative factor pushes, and a factor above 1 stiffens the spring."
SUDDEN = "Your factor jumps to 0 after hold. A force that jumps is a kick: let it fall in a straight line."

LAB = Lab(
    number="15",
    title="Two paddles",
    minutes=120,
    exercises=(
        Exercise("prediction_felt", kind="prediction", asks="what a delay of 50 ms adds to a slow, free motion"),
        Exercise("prediction_factor", kind="prediction", asks="by which factor the limit falls from 5 to 50 ms"),
        Exercise(
            "one_side",
            kind="scene",
            points=1,
            asks="a Scene with k [N/m], b [N s/m], x_other [m], v_other [m/s]: a spring and a damper to the other handle",
            cases=(
                Case(
                    {
                        "x": [0.001, 0.003, -0.002],
                        "v": [0.1, -0.2, 0.0],
                        "values": {"k": 100.0, "b": 0.0, "x_other": 0.001, "v_other": 0.0},
                    },
                    [0.0, 0.2, -0.3],
                    unit="N",
                    slips={(0.0, -0.2, 0.3): TURNED, (0.1, 0.3, -0.2): NO_OTHER, (0.2, 0.4, -0.1): SUM},
                ),
                Case(
                    {
                        "x": [0.0, 0.0, 0.01],
                        "v": [0.1, 0.3, 0.1],
                        "values": {"k": 50.0, "b": 2.0, "x_other": 0.0, "v_other": 0.1},
                    },
                    [0.0, 0.4, 0.5],
                    unit="N",
                    slips={(0.4, 0.8, 0.9): ADDED, (0.0, -0.4, 0.5): DAMPER_TURNED, (0.0, -0.4, -0.5): TURNED},
                ),
            ),
            hint="By how much is the spring stretched if your handle is ahead of the other? When is the damper at rest?",
            matters="Only positions and velocities travel, so each board can limit its own force, whatever the other side does.",
        ),
        Exercise(
            "two_dampers",
            points=2,
            asks="the damping of the coupling [N s/m] for a handle, [together, against each other]",
            cases=(
                Case(
                    {"k": 100.0, "b": 0.0, "d": 0.01},
                    (1.0, -1.0),
                    unit="N s/m",
                    slips={
                        (1.0, 1.0): ONE_MOTION,
                        (-1.0, -1.0): ONE_MOTION,
                        (-1.0, 1.0): SIGNS,
                        (2.0, -2.0): ROUND_TRIP,
                    },
                ),
                Case(
                    {"k": 40.0, "b": 0.5, "d": 0.05},
                    (2.0, -1.0),
                    unit="N s/m",
                    slips={
                        (2.0, -1.5): ONCE,
                        (2.5, -1.5): ONCE,
                        (2.0, -2.0): NO_COUPLING,
                        (3.0, -1.0): ALSO_TOGETHER,
                        (-1.0, 2.0): SWAPPED,
                        (-2.0, 3.0): SIGNS,
                        (4.0, -3.0): ROUND_TRIP,
                    },
                ),
            ),
            hint="What is the heard position in each of the two motions? Which terms contain the velocity of your handle?",
            matters="A delay makes free motion sluggish and a push against each other unstable. Both come from the same k d.",
        ),
        Exercise(
            "highest_stiffness",
            points=1,
            asks="the stiffness [N/m] at which the total damping in the motion against each other is zero",
            cases=(
                Case(
                    {"b_h": 1.1, "b": 0.0, "d": 0.01},
                    110.0,
                    unit="N/m",
                    slips={55.0: ROUND_TRIP, 0.011: PRODUCT},
                ),
                Case(
                    {"b_h": 1.0, "b": 0.25, "d": 0.02},
                    75.0,
                    unit="N/m",
                    slips={50.0: NO_COUPLING, 62.5: HAND_ONCE, 37.5: ROUND_TRIP, 0.03: PRODUCT},
                ),
            ),
            hint="Which three dampers act on a handle in the motion against each other? When is their sum zero?",
            matters="Twice the delay allows half the stiffness, until the delay is as long as an oscillation.",
        ),
        Exercise(
            "felt_damping",
            points=2,
            asks="the damping that your hand feels [N s/m], [position-position, position-force]",
            cases=(
                Case(
                    {"k": 40.0, "K": 0.0, "d": 0.05},
                    (4.0, 0.0),
                    unit="N s/m",
                    slips={(2.0, 0.0): ONE_WAY, (-4.0, 0.0): BOTH_TURNED, (0.0, 4.0): FELT_SWAPPED},
                ),
                Case(
                    {"k": 50.0, "K": 200.0, "d": 0.05},
                    (1.0, -4.0),
                    unit="N s/m",
                    slips={
                        (0.5, -2.0): ONE_WAY,
                        (1.0, 4.0): BOTH_PLUS,
                        (-1.0, 4.0): BOTH_TURNED,
                        (-4.0, 1.0): FELT_SWAPPED,
                        (5.0, -4.0): NO_SERIES,
                        (5.0, -5.0): NO_SERIES,
                        (1.0, -5.0): ONE_FIRM,
                        (1.0, -20.0): ONE_FIRM,
                    },
                ),
            ),
            hint="How late is your own position when it comes back to you? Which terms of F contain the velocity?",
            matters="What is transparent in free motion generates energy in contact, and what is safe in contact is sluggish.",
        ),
        Exercise(
            "wave_side",
            points=1,
            asks="[F, u]: your force [N] and the wave that leaves, from b [N s/m], v [m/s] and the wave w that arrives",
            cases=(
                Case(
                    {"b": 2.0, "v": 0.1, "w": 0.05},
                    (0.1, 0.15),
                    slips={
                        (0.3, 0.25): WAVE_PLUS,
                        (0.3, 0.15): WAVE_PLUS,
                        (0.15, 0.1): PAIR_SWAPPED,
                        (0.1, 0.05): ECHO,
                        (0.12928932188134526, 0.09142135623730951): ROOT,
                    },
                ),
                Case(
                    {"b": 0.5, "v": 0.3, "w": 0.2},
                    (-0.05, 0.1),
                    slips={
                        (0.35, 0.5): WAVE_PLUS,
                        (0.35, 0.1): WAVE_PLUS,
                        (0.1, -0.05): PAIR_SWAPPED,
                        (-0.05, 0.2): ECHO,
                        (0.008578643762690508, 0.012132034355964239): ROOT,
                    },
                ),
            ),
            hint="Which of the two formulas contains only one unknown? What is u + w?",
            matters="Two numbers that are sums of force and velocity make a late link passive, whatever its constant delay is.",
        ),
        Exercise(
            "repaying_damper",
            points=1,
            asks="the damping [N s/m] that takes back in one period what this side gave above what it heard of",
            cases=(
                Case(
                    {"heard": 2e-3, "given": 5e-3, "dx": 1e-3, "T": 1e-3, "alpha_max": 5000.0},
                    3.0,
                    unit="N s/m",
                    slips={3000.0: NO_PERIOD, 5000.0: ALWAYS, 5.0: GIVEN_ALONE, -3.0: HEARD_FIRST, 0.0: HEARD_FIRST},
                ),
                Case(
                    {"heard": 5e-3, "given": 2e-3, "dx": -1e-3, "T": 1e-3, "alpha_max": 8.0},
                    0.0,
                    unit="N s/m",
                    slips={3.0: HEARD_FIRST, -3.0: HEARD_FIRST, 8.0: ALWAYS, 2.0: GIVEN_ALONE},
                ),
                Case(
                    {"heard": 0.0, "given": 1e-2, "dx": 1e-4, "T": 1e-3, "alpha_max": 10.0},
                    10.0,
                    unit="N s/m",
                    slips={1000.0: NOT_LIMITED},
                ),
                Case(
                    {"heard": 0.0, "given": 1e-2, "dx": 0.0, "T": 1e-3, "alpha_max": 10.0},
                    0.0,
                    unit="N s/m",
                    slips={10.0: AT_REST},
                ),
            ),
            hint="How much energy is owed? How much does a damper dissipate in one period?",
            matters="Nothing in this count depends on the delay, so it also holds where the delay changes.",
        ),
        Exercise(
            "gain",
            points=1,
            asks="the factor of the force, 0 to 1, from the silence, hold and fade [s]",
            cases=(
                Case(
                    {"silence": 0.03, "hold": 0.05, "fade": 0.1},
                    1.0,
                    slips={1.2: NOT_CLIPPED, 0.8: NO_HOLD, 0.7: NO_HOLD, 0.0: RISES},
                ),
                Case(
                    {"silence": 0.075, "hold": 0.05, "fade": 0.1},
                    0.75,
                    slips={0.25: RISES, 0.5: NO_HOLD, 0.0: SUDDEN},
                ),
                Case({"silence": 0.2, "hold": 0.05, "fade": 0.1}, 0.0, slips={-0.5: NOT_CLIPPED, 1.0: RISES}),
            ),
            hint="What is the factor at the end of hold, and what at the end of fade? What is it before and after?",
            matters="The time after which a silent link is harmless is stated, hold + fade, and can be tested.",
        ),
        Exercise(
            "which_coupling",
            kind="choice",
            points=1,
            asks="the coupling for a delay that changes, messages that are lost, and forty pairs of hands",
            options={
                "a": "position-position near the limit of a pinch",
                "b": "position-force",
                "c": "waves",
                "d": "soft, with a passivity controller and a fade on each side",
            },
            cases=(
                Case(
                    {},
                    "d",
                    slips={
                        "a": "That limit holds for two pinching hands and one delay. See the column for any two hands.",
                        "b": "In contact it feels a negative damper, which grows with the delay: see your dampers.",
                        "c": "The energy in the line was derived for a constant delay. A delay that changes, and a lost message, "
                        "stretch or remove a wave that was paid for.",
                    },
                ),
            ),
            hint="What does each coupling assume of the hands and of the delay? Which of these assumptions hold here?",
            matters="A guarantee is worth as much as its assumptions. Energy that is counted needs the fewest.",
        ),
        Exercise(
            "discussion",
            kind="text",
            least_words=60,
            asks="the coupling for a box that two people lift over 100 ms, what each feels, and who lets go",
        ),
    ),
)
