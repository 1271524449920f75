"""Questions on measurement and load: intervals, what a motion shows, and the load of a board."""

from .question import Concept, Question

CONCEPT = Concept(
    "measurement",
    "Measurement and load",
    (
        Question(
            "what_an_interval_states",
            about="What a confidence interval states",
            asks=(
                "An experiment with a paddle gives: damping $b$ between {low:g} and {high:g} N s/m, 95 % confidence. What "
                "does this mean?"
            ),
            right="If many people repeat the whole experiment, about 95 % of their intervals contain the true $b$.",
            wrong={
                "interval_of_samples": "95 % of the recorded samples show a damping in this interval.",
                "interval_of_devices": "95 % of all paddles of this type have a damping in this interval.",
                "interval_of_estimates": (
                    "If many people repeat the whole experiment, about 95 % of their estimates lie in this interval."
                ),
            },
            draws={"low, high": ((0.12, 0.16), (0.14, 0.18), (0.2, 0.26))},
        ),
        Question(
            "value_for_a_guarantee",
            about="The value of a measured damping that a guarantee needs",
            asks=(
                "The damping of a paddle was measured: {b:g} N s/m, with a 95 % interval from {low:g} to {high:g} N s/m. The "
                "period is 1 ms, and nothing else is late. Up to which stiffness would you guarantee that a wall is passive?"
            ),
            right="{right:g} N/m",
            wrong={
                "estimate_is_truth": "{estimate:g} N/m",
                "upper_end_is_safe": "{upper:g} N/m",
                "whole_period_delay": "{whole:g} N/m",
            },
            draws={"b, low, high": ((0.2, 0.15, 0.25), (0.3, 0.25, 0.35), (0.4, 0.3, 0.5))},
            computes={
                "right": lambda b, low, high: round(2000 * low, 6),
                "estimate": lambda b, low, high: round(2000 * b, 6),
                "upper": lambda b, low, high: round(2000 * high, 6),
                "whole": lambda b, low, high: round(1000 * low, 6),
            },
        ),
        Question(
            "one_constant_speed",
            about="What a motion at one constant speed shows",
            asks=(
                "A motor moves a free handle to the right at a constant {v:g} mm/s, and its force is recorded {n:g} times. "
                "The handle has a mass $m$, a viscous damping $b$ and a dry friction $f_c$. What does this recording "
                "determine?"
            ),
            right="only the sum $f_c + b\\,v$",
            wrong={
                "more_samples_suffice": "$m$, $b$ and $f_c$, if the recording is long enough",
                "one_speed_separates": "$b$ and $f_c$, but not $m$",
                "force_shows_mass": "$m$, but neither $b$ nor $f_c$",
            },
            draws={"v": (50, 80, 100), "n": (500, 1000, 2000)},
        ),
        Question(
            "load_of_a_cheaper_method",
            about="The load of a cheaper method at a higher rate",
            asks=(
                "The method RK4 evaluates the equations of motion four times in each step, and semi-implicit Euler once. With "
                "one step per sample these evaluations take nearly all the time of a board. At 1 kHz the load of the board is "
                "{L:g} % with RK4. How large is it with semi-implicit Euler at {r:g} kHz?"
            ),
            right="{right:g} %",
            wrong={
                "load_is_rate": "{rate:g} %",
                "load_is_method": "{method:g} %",
                "load_of_the_scene": "{L:g} %",
            },
            draws={"L": (8, 12), "r": (2, 3, 8)},
            computes={
                "right": lambda L, r: L * r / 4,
                "rate": lambda L, r: L * r,
                "method": lambda L, r: L / 4,
            },
        ),
    ),
)
