"""Public checks of lab 10: numbers to compare with, the letter of the choice, and the feedback to typical mistakes."""

from hapticlab.course.exercise import Case, Exercise, Lab

ONE_LOOK = "That is Phi(d'), as if only one presentation had noise. The noise of two presentations is sqrt(2) times as large."
LINEAR = (
    "You divided the difference of k by the first k, which depends on the order. The level is the logarithm of the ratio, "
    "larger over smaller."
)
TWO_IN_A_ROW = "Your staircase goes down after every right answer, but the rule requires two in a row."
ANEW = "After a step down, two more right answers are required, because the count begins again."
BROKEN = "A wrong answer ends the row, so the next right answer is the first of a new row."
LATE = "Your list begins with the second level. The first answer is given at the level start."
SOFTEST = "You counted steps of 0.23 times the softest wall. Each step is a fraction of the wall before it."
STIFFEST = "You counted steps of 0.23 times the stiffest wall. Each step is a fraction of the wall before it."
ROOT = "That is the result for one right answer. A step down requires several in a row, with the probability P^down."

LAB = Lab(
    number="10",
    title="How stiff is stiff? A psychophysics experiment",
    minutes=120,
    exercises=(
        Exercise("prediction_weber", kind="prediction", asks="how much stiffer the other wall must be [%]"),
        Exercise("prediction_trials", kind="prediction", asks="how many trials you need"),
        Exercise("prediction_walls", kind="prediction", asks="how many walls you can tell apart between 20 and 200 N/m"),
        Exercise(
            "part_right",
            points=2,
            rtol=1e-5,
            asks="the proportion of trials, 0.5 to 1, in which the stiffer of k_1 and k_2 [N/m] is picked",
            cases=(
                Case(
                    {"k_1": 200.0, "k_2": 246.0, "weber": 0.23},
                    0.760249939,
                    slips={
                        0.841344746: ONE_LOOK,
                        0.737755053: "Divide by sigma = ln(1 + w), not by w, because noise and level are both logarithms.",
                        1.0: "That is d' itself. Return how often the observer is right at this d'.",
                        0.921350396: "The noise is sqrt(2) sigma, so divide d' by sqrt(2).",
                        0.691462461: "The variances add, not the standard deviations: sqrt(2) sigma, not 2 sigma.",
                    },
                ),
                Case(
                    {"k_1": 150.0, "k_2": 120.0, "weber": 0.2},
                    0.806598249,
                    slips={
                        0.193401751: (
                            "Here the first wall is the stiffer one. The level is the larger stiffness over the smaller."
                        ),
                        0.760249939: LINEAR,
                        0.889505228: ONE_LOOK,
                        0.784924005: "Divide by sigma = ln(1 + w), not by w.",
                    },
                ),
                Case({"k_1": 100.0, "k_2": 100.0, "weber": 0.3}, 0.5),
            ),
            hint=(
                "What is the level of the two walls, whichever comes first? How large is it compared with the noise "
                "of two presentations?"
            ),
            matters="This curve connects the proportion of right answers to the difference between two walls.",
        ),
        Exercise(
            "staircase",
            points=2,
            asks="the level [1] at which each of the answers was given",
            cases=(
                Case(
                    {"answers": [1, 1, 1, 0, 1, 1, 0, 1, 1, 1, 1, 0], "start": 0.4, "factor": 2.0},
                    (0.4, 0.4, 0.2, 0.2, 0.4, 0.4, 0.2, 0.4, 0.4, 0.2, 0.2, 0.1),
                    slips={
                        (0.4, 0.2, 0.1, 0.05, 0.1, 0.05, 0.025, 0.05, 0.025, 0.0125, 0.00625, 0.003125): TWO_IN_A_ROW,
                        (0.4, 0.4, 0.2, 0.1, 0.2, 0.2, 0.1, 0.2, 0.2, 0.1, 0.05, 0.025): ANEW,
                        (0.4, 0.4, 0.2, 0.2, 0.4, 0.2, 0.2, 0.4, 0.2, 0.2, 0.1, 0.1): BROKEN,
                        (0.4, 0.2, 0.2, 0.4, 0.4, 0.2, 0.4, 0.4, 0.2, 0.2, 0.1, 0.2): LATE,
                    },
                ),
                Case({"answers": [0, 1], "start": 0.5, "factor": 1.25}, (0.5, 0.625)),
            ),
            hint="At which level was the first answer given? Which earlier answers have changed the level before a given answer?",
            matters="A staircase spends most of its trials near the threshold, where answers carry most information.",
        ),
        Exercise(
            "converges_to",
            points=1,
            asks="the proportion of right answers at which a staircase settles",
            cases=(
                Case({"down": 2, "weight": 1.0}, 0.707106781, slips={0.5: ROOT}),
                Case(
                    {"down": 1, "weight": 3.0},
                    0.75,
                    slips={
                        0.25: (
                            "The weight is applied the wrong way round: long steps up keep the staircase at easy "
                            "levels, where most answers are right."
                        )
                    },
                ),
                Case(
                    {"down": 2, "weight": 0.5},
                    0.577350269,
                    slips={
                        0.333333333: ROOT,
                        0.816496581: (
                            "The weight is applied the wrong way round: P^down is weight/(1 + weight), and short "
                            "steps up lead to hard levels."
                        ),
                    },
                ),
            ),
            hint="How likely is a step down, and how likely is a step up? How long is each of them?",
            rtol=1e-5,
            matters=("The rule sets the proportion of right answers at which a staircase settles; the person sets the level."),
        ),
        Exercise(
            "log_likelihood",
            points=2,
            asks="the natural log-likelihood of the answers",
            rtol=1e-5,
            cases=(
                Case(
                    {"threshold": 0.2, "levels": [0.5, 0.4, 0.3, 0.2, 0.2, 0.1], "right": [1, 1, 1, 0, 1, 0]},
                    -2.99603407,
                    slips={
                        -3.28807258: "The sqrt(2) is missing: P is Phi(a / (sqrt(2) threshold)).",
                        -1.30116106: "That is the logarithm to base 10. Return the natural logarithm, np.log.",
                        -0.551313775: "You used only the right answers. A wrong answer has the probability 1 - P.",
                        0.0499849125: (
                            "That is the likelihood itself. Return its logarithm, which is a sum. (With 1000 answers "
                            "the "
                            "product is too small for a computer.)"
                        ),
                        -0.499339012: "That is the mean. Return the sum, because twice as many answers are twice the evidence.",
                        2.99603407: "That is the negative log-likelihood. The logarithm of a probability is negative.",
                    },
                ),
                Case({"threshold": 0.3, "levels": [0.3], "right": [1]}, -0.274108039),
            ),
            hint="How likely is a right answer, and how likely is a wrong one? What is the logarithm of a product?",
            matters="The likelihood uses every answer of the experiment, not only the turning points of a staircase.",
        ),
        Exercise(
            "at_d_prime_1",
            points=1,
            asks="the level at which d' = 1",
            rtol=1e-5,
            cases=(
                Case(
                    {"level": 0.16, "part": 0.707106781},
                    0.207609215,
                    slips={
                        0.293603767: "The sqrt(2) of two presentations is missing: P = Phi(d'/sqrt(2)).",
                        0.123308592: (
                            "The ratio is the wrong way round. At 70.7 % right d' is below 1, so d' = 1 lies at a larger level."
                        ),
                        0.172024915: "The proportion of right answers is not proportional to the level. Only d' is.",
                    },
                ),
                Case(
                    {"level": 0.3, "part": 0.9},
                    0.165527506,
                    slips={
                        0.234091244: "The sqrt(2) of two presentations is missing: P = Phi(d'/sqrt(2)).",
                        0.543716281: (
                            "The ratio is the wrong way round. At 90 % right d' is above 1, so d' = 1 lies at a smaller level."
                        ),
                    },
                ),
            ),
            hint=(
                "d' is proportional to the level. What is d' at this proportion of right answers? "
                "(NormalDist().inv_cdf is the inverse of cdf.)"
            ),
            matters="On a common scale you can compare thresholds from experiments with different rules.",
        ),
        Exercise(
            "standard_first",
            kind="choice",
            points=1,
            asks="what 82 % say about the hand: a, b, c or d",
            options={
                "a": "the hand is a sensitive one",
                "b": "nothing yet: a lapse rate is missing",
                "c": "the hand improved by practice",
                "d": "nothing yet: the order must be drawn",
            },
            cases=(
                Case(
                    {},
                    "d",
                    slips={
                        "a": (
                            "Look at the three lines above the exercise: if the order is drawn, the same hand is "
                            "right in 60 % at "
                            "the same difference. The preference for 'second' causes the rest."
                        ),
                        "c": "Nobody practised here, because the simulated observer is the same in every trial.",
                        "b": "Lapses reduce the number of right answers. They cannot explain 82 %.",
                    },
                ),
            ),
            hint="How often is an observer right who feels nothing and always says 'second'?",
            matters=("A habit of answering can look like a sharp sense of touch, so the procedure must exclude the habit."),
        ),
        Exercise(
            "steps_between",
            points=1,
            asks="how many steps of one Weber fraction lie between k_low and k_high [N/m]",
            rtol=1e-5,
            cases=(
                Case(
                    {"k_low": 20.0, "k_high": 200.0, "weber": 0.23},
                    11.1228381,
                    slips={
                        39.1304348: SOFTEST,
                        10.0112395: "That is close, but a step multiplies by 1 + w, so its logarithm is ln(1 + w), not w.",
                        3.91304348: STIFFEST,
                        4.34782609: "Both logarithms must have the same base.",
                    },
                ),
                Case({"k_low": 50.0, "k_high": 50.0, "weber": 0.1}, 0.0),
            ),
            hint="How many factors of 1 + weber give k_high/k_low?",
            matters="This number estimates how many walls of a device a person can tell apart.",
        ),
        Exercise("discussion", kind="text", least_words=80, asks="your discussion, 80 words or more"),
    ),
)
