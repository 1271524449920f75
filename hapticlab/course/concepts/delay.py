"""Questions on delay and on prediction."""

from .question import Concept, Question

CONCEPT = Concept(
    "delay",
    "Delay and prediction",
    (
        Question(
            "damping_for_a_late_wall",
            about="The damping that a late wall requires",
            asks=(
                "A virtual wall of {K:g} N/m is sampled every {T:g} ms. In addition to the hold, the amplifier makes the "
                "force late by {tau:g} ms. At slow motion the wall acts as an ideal spring in parallel with a negative "
                "damper. How large is this negative damping?"
            ),
            right="{right:.4g} N s/m",
            wrong={
                "delay_free": "{hold:.4g} N s/m",
                "hold_free": "{late:.4g} N s/m",
                "whole_period_delay": "{whole:.4g} N s/m",
            },
            draws={"K": (200, 400, 600), "T": (1,), "tau": (1, 1.5, 2, 3)},
            computes={
                "right": lambda K, T, tau: K * (T / 2 + tau) / 1000,
                "hold": lambda K, T, tau: K * T / 2 / 1000,
                "late": lambda K, T, tau: K * tau / 1000,
                "whole": lambda K, T, tau: K * (T + tau) / 1000,
            },
        ),
        Question(
            "how_far_ahead",
            about="How far a prediction must look ahead if its force is late",
            asks=(
                "The force of a wall is computed at each sample, reaches the motor {j:g} sampling periods later, and is then "
                "held for one period. The handle moves at a constant speed. How far ahead must the program predict the "
                "position so that the wall generates no energy?"
            ),
            right="{right:g} periods",
            wrong={
                "hold_free": "{j:g} periods",
                "whole_period_delay": "{whole:g} periods",
                "delay_free": "0.5 periods",
            },
            draws={"j": (2, 3, 4)},
            computes={"right": lambda j: j + 0.5, "whole": lambda j: j + 1},
        ),
        Question(
            "price_of_prediction",
            about="The price of a prediction in counts",
            asks=(
                "A program predicts the position half a period ahead: $F = k\\,\\bigl(x(n) + \\tfrac12 (x(n) - "
                "x(n-1))\\bigr)$ with $k$ = {K:g} N/m. One count of the encoder is {q:g} µm. The reading was constant for a "
                "while, and now it increases by one count. By how much does the force change at this sample?"
            ),
            right="{right:.4g} mN",
            wrong={
                "prediction_free": "{plain:.4g} mN",
                "prediction_smooths": "{half:.4g} mN",
                "whole_period_delay": "{whole:.4g} mN",
            },
            draws={"K": (400, 600, 800, 1000), "q": (10, 12, 20)},
            computes={
                "right": lambda K, q: 1.5 * K * q / 1000,
                "plain": lambda K, q: K * q / 1000,
                "half": lambda K, q: 0.5 * K * q / 1000,
                "whole": lambda K, q: 2 * K * q / 1000,
            },
        ),
    ),
)
