"""Public checks of lab 10: numbers to compare with, the letter of the choice, and what a typical slip gives."""

from hapticlab.course.exercise import Case, Exercise, Lab

ONE_LOOK = "That is Phi(d'), as if one look had noise and the other none: two looks bring sqrt(2) times as much."
LINEAR = (
    "That takes the difference of k over the first one, which depends on the order. The level is the logarithm of the ratio, "
    "larger over smaller."
)
TWO_IN_A_ROW = "That goes down after every right answer; the rule asks for two in a row."
ANEW = "After a step down two more right answers are needed: the count begins anew."
BROKEN = "A wrong answer breaks the row: the next right one is the first again."
LATE = "The first answer is given at the level start; your list begins with what comes after it."
SOFTEST = "That counts steps of 0.23 times the softest wall. Each step is a fraction of the wall before it."
STIFFEST = "That counts steps of 0.23 times the stiffest wall. Each step is a fraction of the wall before it."
ROOT = "That is what one right answer would need; a step down takes several in a row, P^down."

LAB = Lab(
    number="10",
    title="How stiff is stiff? A psychophysics experiment",
    minutes=120,
    exercises=(
        Exercise("prediction_weber", kind="prediction", asks="how much stiffer the other wall must be [%]"),
        Exercise("prediction_trials", kind="prediction", asks="how many trials that takes"),
        Exercise("prediction_walls", kind="prediction", asks="how many walls you tell apart between 20 and 200 N/m"),
        Exercise(
            "part_right",
            points=2,
            rtol=1e-5,
            asks="the part of trials, 0.5 to 1, in which the stiffer of k_1 and k_2 [N/m] is picked",
            cases=(
                Case(
                    {"k_1": 200.0, "k_2": 246.0, "weber": 0.23},
                    0.760249939,
                    slips={
                        0.841344746: ONE_LOOK,
                        0.737755053: "Divide by sigma = ln(1 + w), not by w: noise and level are both logarithms.",
                        1.0: "That is d'. How often is the observer right at d' = 1?",
                        0.921350396: "The noise is sqrt(2) sigma, so divide d' by sqrt(2).",
                        0.691462461: "The variances add, not the standard deviations: sqrt(2) sigma, not 2 sigma.",
                    },
                ),
                Case(
                    {"k_1": 150.0, "k_2": 120.0, "weber": 0.2},
                    0.806598249,
                    slips={
                        0.193401751: "Here the first is the stiffer one, and is picked all the same: larger over smaller.",
                        0.760249939: LINEAR,
                        0.889505228: ONE_LOOK,
                        0.784924005: "Divide by sigma = ln(1 + w), not by w.",
                    },
                ),
                Case({"k_1": 100.0, "k_2": 100.0, "weber": 0.3}, 0.5),
            ),
            hint="Which level do the walls make, whichever comes first? How many sigmas is that, of two looks?",
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
            hint="At which level was the very first answer given? And which answers in a row have changed the level by then?",
            matters="A staircase spends most of its trials near the threshold, where answers carry most information.",
        ),
        Exercise(
            "converges_to",
            points=1,
            asks="the part of right answers at which a staircase stays",
            cases=(
                Case({"down": 2, "weight": 1.0}, 0.707106781, slips={0.5: ROOT}),
                Case(
                    {"down": 1, "weight": 3.0},
                    0.75,
                    slips={0.25: "Turned round: long steps up keep it at easy levels."},
                ),
                Case(
                    {"down": 2, "weight": 0.5},
                    0.577350269,
                    slips={
                        0.333333333: ROOT,
                        0.816496581: "Turned round: P^down is weight/(1 + weight); short steps up let it sink to hard levels.",
                    },
                ),
            ),
            hint="How likely is a step down, and how likely a step up, and how long is each? Where do they balance?",
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
                        -3.28807258: "P is Phi(a / (sqrt(2) threshold)): the sqrt(2) is missing.",
                        -1.30116106: "That is the logarithm to base 10; asked for is the natural one, np.log.",
                        -0.551313775: "Only the right answers are in it. A wrong one has the probability 1 - P.",
                        0.0499849125: "That is the likelihood itself; its logarithm is asked for, as a sum. (Of 1000 answers the "
                        "product would be too small for a computer.)",
                        -0.499339012: "That is the mean. The sum is asked for: twice the answers, twice the evidence.",
                        2.99603407: "A logarithm of a probability is negative; this is the negative log-likelihood.",
                    },
                ),
                Case({"threshold": 0.3, "levels": [0.3], "right": [1]}, -0.274108039),
            ),
            hint="How likely was each answer, a right one and a wrong one? And what does a logarithm make of a product?",
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
                        0.293603767: "The sqrt(2) of two looks is missing: P = Phi(d'/sqrt(2)).",
                        0.123308592: "Turned round: at 70.7 % right d' is below 1, so d' = 1 lies at a larger level.",
                        0.172024915: "Parts of right answers are not proportional to levels: go through d'.",
                    },
                ),
                Case(
                    {"level": 0.3, "part": 0.9},
                    0.165527506,
                    slips={
                        0.234091244: "The sqrt(2) of two looks is missing: P = Phi(d'/sqrt(2)).",
                        0.543716281: "Turned round: at 90 % right d' is above 1, so d' = 1 lies at a smaller level.",
                    },
                ),
            ),
            hint="d' is proportional to the level. What is d' where this part is right? NormalDist().inv_cdf undoes cdf.",
            matters="On a common scale you can compare thresholds from experiments with different rules.",
        ),
        Exercise(
            "standard_first",
            kind="choice",
            points=1,
            asks="what 82 % say about the hand: a, b, c or d",
            options={
                "a": "it is a sharp one",
                "b": "nothing yet: a lapse rate is missing",
                "c": "it got better by practice",
                "d": "nothing yet: the order has to be drawn",
            },
            cases=(
                Case(
                    {},
                    "d",
                    slips={
                        "a": "Look at the three lines above: the same hand, at the same difference, is right in 59 % once the "
                        "order is drawn. A habit of saying 'second' did the rest.",
                        "c": "Nobody practised here: the simulated observer is the same in every trial.",
                        "b": "Lapses make right answers fewer, not more.",
                    },
                ),
            ),
            hint="What would somebody score who feels nothing and always says 'second'?",
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
                        10.0112395: "Close: a step multiplies by 1 + w, so its logarithm is ln(1 + w), not w.",
                        3.91304348: STIFFEST,
                        4.34782609: "Both logarithms must have the same base.",
                    },
                ),
                Case({"k_low": 50.0, "k_high": 50.0, "weber": 0.1}, 0.0),
            ),
            hint="How often must 1 + weber be multiplied with itself to make k_high/k_low?",
            matters="This number estimates how many walls of a device a person can tell apart.",
        ),
        Exercise("discussion", kind="text", least_words=80, asks="your discussion, 80 words or more"),
    ),
)
