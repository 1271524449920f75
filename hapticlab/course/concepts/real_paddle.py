"""Questions on what a real paddle adds: an encoder and friction."""

from .question import Concept, Question

CONCEPT = Concept(
    "real_paddle",
    "Encoder and friction",
    (
        Question(
            "step_of_the_velocity",
            about="The smallest step of the velocity if the sampling is faster",
            asks=(
                "A velocity is computed from the last two samples of an encoder with {q:g} µm per count. At 1 kHz, the "
                "smallest step of this velocity is {q:g} mm/s. How large is this step if the sampling rate is {kHz:g} kHz?"
            ),
            right="{right:.3g} mm/s",
            wrong={
                "faster_is_finer": "{finer:.3g} mm/s",
                "encoder_alone": "{q:g} mm/s",
                "noise_averages": "{average:.3g} mm/s",
            },
            draws={"q": (10, 12, 20, 24), "kHz": (2, 4, 5)},
            computes={
                "right": lambda q, kHz: q * kHz,
                "finer": lambda q, kHz: q / kHz,
                "average": lambda q, kHz: q / kHz**0.5,
            },
        ),
        Question(
            "friction_hides_chatter",
            about="A wall that dry friction keeps quiet",
            asks=(
                "A wall of {K:g} N/m is far stiffer than the damping of the paddle allows. In a simulation without friction "
                "it oscillates. The real paddle has dry friction, and a hand that rests lightly on the wall feels no "
                "oscillation. What is true of this wall on the real paddle?"
            ),
            right="Friction stops a small oscillation, but a hard knock can start an oscillation that does not stop.",
            wrong={
                "stable_is_passive": "It is passive on this paddle, because it does not oscillate.",
                "friction_lowers_leak": (
                    "It generates less energy in a given motion than in the simulation, because friction reduces the leak."
                ),
                "dry_is_viscous": "Friction stops large oscillations as it stops small ones, as damping would.",
            },
            draws={"K": (800, 1000, 1200, 1500)},
        ),
        Question(
            "too_much_compensation",
            about="Compensation of more than all of the dry friction",
            asks=(
                "A motor compensates {p:g} % of the dry friction of a handle, so more than all of it. The handle also has "
                "some viscous damping, which is not compensated. A light finger holds the handle as a soft spring. What "
                "happens after a push?"
            ),
            right="The handle oscillates by itself, with an amplitude that soon remains the same.",
            wrong={
                "more_is_lighter": "The handle only feels lighter than at 100 %, and comes to rest at the finger.",
                "friction_stays_positive": (
                    "The handle behaves as at 100 %, because a program cannot remove more friction than there is."
                ),
                "instability_grows": "The handle oscillates, and the amplitude grows without end.",
            },
            draws={"p": (150, 160, 180)},
        ),
    ),
)
