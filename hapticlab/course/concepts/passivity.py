"""Questions on passivity: who dissipates, stability against passivity, virtual damping of either sign."""

from .question import Concept, Question

CONCEPT = Concept(
    "passivity",
    "Passivity and stability",
    (
        Question(
            "damping_required",
            about="The damping that a sampled wall requires from the device",
            asks=(
                "A virtual wall of {K:g} N/m is sampled every {T:g} ms, and nothing else is late. The handle has a mass of "
                "{m:g} g. What is the smallest viscous damping of the *device* with which no passive hand can make the wall "
                "unstable?"
            ),
            right="{right:.3g} N s/m",
            wrong={
                "whole_period_delay": "{whole:.3g} N s/m",
                "spring_conserves": "none, because a spring with a positive stiffness generates no energy",
                "critical_damping": "{critical:.3g} N s/m",
            },
            draws={"K": (200, 400, 600, 800), "T": (0.5, 1, 2), "m": (30, 50, 80)},
            computes={
                "right": lambda K, T, m: K * T / 1000 / 2,
                "whole": lambda K, T, m: K * T / 1000,
                "critical": lambda K, T, m: 2 * (K * m / 1000) ** 0.5,
            },
        ),
        Question(
            "stable_in_many_hands",
            about="What the experience of many hands says about passivity",
            asks="{n:g} people press a virtual wall of {K:g} N/m with a firm grip, and it never oscillates. Is the wall passive?",
            right="Not known: another passive hand, such as a light finger, may make it unstable.",
            wrong={
                "stable_is_passive": "Yes: a wall that was stable in so many hands is passive.",
                "firm_hand_worst": "Yes: a firm grip is the hardest case for a wall, so it is stable in every hand.",
                "program_never_passive": "No: a wall that a program computes is never passive, on any device.",
            },
            draws={"n": (12, 20, 30), "K": (300, 500, 700)},
        ),
        Question(
            "virtual_damper_in_the_wall",
            about="A virtual damper in a wall, and the stiffest passive wall",
            asks=(
                "The viscous damping of a device is {b:g} N s/m, and the period is {T:g} ms. In addition to the spring, the "
                "wall contains a virtual damper of {B:g} N s/m, whose velocity is the difference of the last two samples "
                "divided by the period. Up to which stiffness is the wall passive?"
            ),
            right="{right:.4g} N/m",
            wrong={
                "virtual_damping_as_real": "{as_real:.4g} N/m",
                "virtual_damping_free": "{free:.4g} N/m",
                "whole_period_delay": "{whole:.4g} N/m",
            },
            draws={"b": (0.3, 0.4, 0.5), "B": (0.1, 0.2), "T": (0.5, 1)},
            computes={
                "right": lambda b, B, T: 2000 * (b - B) / T,
                "as_real": lambda b, B, T: 2000 * (b + B) / T,
                "free": lambda b, B, T: 2000 * b / T,
                "whole": lambda b, B, T: 1000 * (b - B) / T,
            },
        ),
        Question(
            "compensation_everywhere",
            about="Damping compensation everywhere, and the stiffest passive wall",
            asks=(
                "Without compensation a wall is passive up to {K:g} N/m on a paddle. Now a negative virtual damper "
                "compensates {p:g} % of the damping of the paddle *everywhere*, also inside the wall. Up to which stiffness "
                "is the wall passive now?"
            ),
            right="{right:.4g} N/m",
            wrong={
                "compensation_buys_stiffness": "{buys:.4g} N/m",
                "virtual_damping_free": "{K:g} N/m",
                "negative_never_passive": "No wall is passive: negative damping is never passive.",
            },
            draws={"K": (400, 600, 800, 1200), "p": (25, 50, 75)},
            computes={
                "right": lambda K, p: K * (1 - p / 100),
                "buys": lambda K, p: K * (1 + p / 100),
            },
        ),
    ),
)
