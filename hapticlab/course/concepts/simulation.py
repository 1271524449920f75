"""Questions on simulated bodies: methods, their order and their steps, and the coupler to the handle."""

from .question import Concept, Question

CONCEPT = Concept(
    "simulation",
    "Simulated bodies",
    (
        Question(
            "forward_euler",
            about="The energy of an undamped oscillator under forward Euler",
            asks=(
                "A mass of {m:g} g on a spring of {K:g} N/m, without damping, is simulated by the explicit (forward) Euler "
                "method. What does the energy of the simulated mass and spring do?"
            ),
            right="It grows at every step size; with a smaller step it only grows more slowly.",
            wrong={
                "small_step_conserves": "It remains constant if the step is below a certain limit.",
                "every_method_damps": "It decreases, because every numerical method loses some energy.",
                "error_is_rounding": "It varies a little at random, because numbers are rounded.",
            },
            draws={"m": (20, 50, 100), "K": (50, 100, 200)},
        ),
        Question(
            "order_of_a_method",
            about="What the order of a method says about its error",
            asks=(
                "A smooth motion is simulated for one second by a method of order {p:g}. The error at the end is {e:g} µm. "
                "How large is it, approximately, if the step is {r:g} times as small?"
            ),
            right="{right:g} µm",
            wrong={
                "error_follows_step": "{step:g} µm",
                "local_for_global": "{local:g} µm",
                "order_multiplies": "{factor:g} µm",
            },
            draws={"p, r, e": ((2, 3, 54), (2, 4, 64), (4, 2, 64), (3, 2, 48))},
            computes={
                "right": lambda p, r, e: e / r**p,
                "step": lambda p, r, e: e / r,
                "local": lambda p, r, e: e / r ** (p + 1),
                "factor": lambda p, r, e: e / (p * r),
            },
        ),
        Question(
            "stiffer_contact",
            about="The longest stable step of a stiffer contact",
            asks=(
                "A mass on a spring, without damping, is simulated by an explicit method, which is stable up to a step of "
                "{h:g} ms. The spring becomes {s:g} times as stiff, and nothing else changes. Up to which step is the method "
                "stable now?"
            ),
            right="{right:.3g} ms",
            wrong={
                "limit_follows_stiffness": "{follows:.3g} ms",
                "limit_is_the_methods": "{h:g} ms",
                "stiffer_is_steadier": "{steadier:.3g} ms",
            },
            draws={"h": (6, 12, 18), "s": (4, 9, 16)},
            computes={
                "right": lambda h, s: h / s**0.5,
                "follows": lambda h, s: h / s,
                "steadier": lambda h, s: h * s**0.5,
            },
        ),
        Question(
            "wall_behind_a_coupler",
            about="A wall that is felt through a virtual coupler",
            asks=(
                "A virtual coupler, a spring of {K_c:g} N/m with a damper, joins the handle and a simulated body. The body "
                "rests against a simulated wall of {K:g} N/m. You push the handle slowly. Which stiffness does your hand "
                "feel?"
            ),
            right="{right:g} N/m",
            wrong={
                "series_as_parallel": "{sum:g} N/m",
                "coupler_invisible": "{K:g} N/m",
                "coupler_alone": "{K_c:g} N/m",
            },
            draws={"K_c, K": ((200, 600), (300, 600), (400, 1200), (600, 1200), (600, 300), (1200, 400))},
            computes={
                "right": lambda K_c, K: K * K_c / (K + K_c),
                "sum": lambda K_c, K: K + K_c,
            },
        ),
    ),
)
