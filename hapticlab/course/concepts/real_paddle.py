"""Questions on what a real paddle adds: an encoder and friction."""

from .question import Concept, Question

#: a cell that shows a wall with and without dry friction
LEANING = """\
hand, curves = hl.Hand(m=0.005, b=0.02, k=60, push=2.0), {}
for name, friction in (("no dry friction", 0), ("dry friction of 20 mN", 0.02)):
    handle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, coulomb=friction, hand=hand)
    log = handle.run(hl.wall()(k=1000, x_o=0), duration=0.3, x=1.887e-3, v=0.02)
    curves[name] = log.t, 1e3 * log.x
hl.show(
    hl.plot(curves, xlabel="time [s]", ylabel="handle position x [mm]"),
    alt="Without dry friction the oscillation grows; with it, the handle rests.",
)"""

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
                "A wall of 1000 N/m is far stiffer than the damping of the handle allows, and a light hand leans on it. "
                "The picture shows the handle after a touch: without dry friction it oscillates, with 20 mN of dry "
                "friction it comes to rest. What is true of this wall on the handle *with* dry friction?"
            ),
            right="Friction stops a small oscillation, but a hard knock can start an oscillation that does not stop.",
            wrong={
                "stable_is_passive": "It is passive on this handle, because it does not oscillate.",
                "friction_lowers_leak": (
                    "It generates less energy in a given motion than without friction, because friction reduces the leak."
                ),
                "dry_is_viscous": "Friction stops large oscillations as it stops small ones, as damping would.",
            },
            picture=LEANING,
        ),
        Question(
            "too_much_compensation",
            about="Compensation of more than all of the dry friction",
            asks=(
                "A motor pushes the handle in its direction of motion with {p:g} % of the dry friction, so it compensates more "
                "than all of this friction. The handle also has "
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
