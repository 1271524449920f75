"""Questions on what a hand notices, and on what a scene may therefore leave out."""

from .question import Concept, Question

CONCEPT = Concept(
    "hand",
    "What a hand notices",
    (
        Question(
            "weber_fraction",
            about="The noticed difference at another stiffness",
            asks=(
                "A person just notices that a wall of {K_2:g} N/m is stiffer than one of {K:g} N/m. Which difference does "
                "this person just notice from a wall of {K_4:g} N/m, according to Weber's law?"
            ),
            right="{right:g} N/m",
            wrong={
                "threshold_constant": "{d:g} N/m",
                "threshold_square_root": "{root:g} N/m",
                "stiffer_is_easier": "{easier:g} N/m",
            },
            draws={"K": (100, 200, 300), "d": (20, 24, 32, 40)},
            computes={
                "K_2": lambda K, d: K + d,
                "K_4": lambda K, d: 4 * K,
                "right": lambda K, d: 4 * d,
                "root": lambda K, d: 2 * d,
                "easier": lambda K, d: d / 4,
            },
        ),
        Question(
            "below_the_threshold",
            about="Answers to differences below the threshold",
            asks=(
                "A person with a Weber fraction of {w:g} % compares walls whose stiffness differs by {half:g} %, and must say "
                "in each of 200 trials which wall is stiffer. How often is the person right?"
            ),
            right="in more than half of the trials, but not in all",
            wrong={
                "threshold_is_a_step": "in half of the trials, because a difference below the threshold is not noticed at all",
                "below_is_wrong": "in fewer than half of the trials, because such a difference misleads",
                "threshold_is_attention": "in all trials, if the person takes enough time",
            },
            draws={"w": (12, 16, 20, 24)},
            computes={"half": lambda w: w / 2},
        ),
        Question(
            "what_to_leave_out",
            about="Which part of a scene to leave out",
            asks=(
                "A simulated scene needs more cycles than the board has. Part A takes {a_cost:g} cycles, and without it the "
                "force changes by {a:g} % at most. Part B takes {b_cost:g} cycles, and without it the force changes by {b:g} "
                "%. A hand notices changes of {threshold:g} % and more. Either part alone would free enough cycles. Which "
                "part do you leave out?"
            ),
            right="part A only",
            wrong={
                "cost_decides": "part B only, because it takes more cycles",
                "model_everything": "neither part, because a model must contain all that exists",
                "only_the_whole": "both parts, because a hand feels only the whole and no single part",
            },
            draws={"a": (2, 3, 4), "b": (18, 20, 25), "threshold": (8, 10), "a_cost": (300, 400), "b_cost": (700, 900)},
        ),
        Question(
            "several_small_changes",
            about="Several changes that are each below the threshold",
            asks=(
                "A simulated scene has three small parts. If one of them is left out, whichever it is, the force changes by "
                "{a:g} %. A hand notices changes of {threshold:g} % and more. May you leave out all three parts?"
            ),
            right="Not without a test: together they may change the force by {sum:g} %.",
            wrong={
                "one_by_one": "Yes: each change of {a:g} % is below the threshold.",
                "errors_cancel": "Yes: three small changes cancel each other on average.",
                "model_everything": "No: a model must contain all that exists.",
            },
            draws={"a": (4, 5, 6), "threshold": (8, 9, 10)},
            computes={"sum": lambda a, threshold: 3 * a},
        ),
    ),
)
