"""Questions on signs and units: who pushes whom, and in which numbers."""

from .question import Concept, Question

CONCEPT = Concept(
    "signs",
    "Signs and units",
    (
        Question(
            "motor_force",
            about="The force of the motor on a handle inside a wall",
            asks=(
                "Positive is to the right. A virtual wall of {K:g} N/m fills the space to the right of $x = 0$. The handle is "
                "at rest {d:g} mm inside the wall. Which force does the motor apply to the handle?"
            ),
            right="{F:.3g} N to the left",
            wrong={
                "force_on_wrong_body": "{F:.3g} N to the right",
                "millimetres_as_metres": "{F_mm:.4g} N to the left",
                "half_in_the_force": "{F_half:.3g} N to the left",
            },
            draws={"K": (200, 300, 400, 500, 600), "d": (2, 3, 4, 5, 6)},
            computes={
                "F": lambda K, d: K * d / 1000,
                "F_mm": lambda K, d: K * d,
                "F_half": lambda K, d: K * d / 1000 / 2,
            },
        ),
        Question(
            "number_for_newtons_per_metre",
            about="The number for a stiffness in a program that works in metres",
            asks=(
                "A program reads the position $x$ in metres and computes the force in newtons as $F = k\\,x$, with plain "
                "numbers. The wall shall have {k:g} N/mm. Which number must the program use for $k$?"
            ),
            right="{right:g}",
            wrong={
                "units_by_themselves": "{k:g}",
                "unit_inverted": "{inverted:g}",
                "unit_twice": "{twice:.0f}",
            },
            draws={"k": (0.2, 0.3, 0.4, 0.5, 0.6, 0.8)},
            computes={
                "right": lambda k: 1000 * k,
                "inverted": lambda k: k / 1000,
                "twice": lambda k: 1e6 * k,
            },
        ),
        Question(
            "larger_drum",
            about="A larger drum on the motor of the paddle",
            asks=(
                "A cable runs from the drum on the shaft of the motor to the sector that carries the handle. The encoder is "
                "on the shaft of the motor. You replace the drum by one whose diameter is {r:g} times as large; nothing "
                "else changes. What happens to the force at the handle at the same motor current, and to the counts per metre "
                "of handle travel?"
            ),
            right="The force and the counts per metre are both divided by {r:g}.",
            wrong={
                "larger_drum_more_force": "The force is multiplied by {r:g}, and the counts per metre are divided by {r:g}.",
                "force_is_torque": "The force stays the same, and the counts per metre are divided by {r:g}.",
                "sensor_apart": "The force is divided by {r:g}, and the counts per metre stay the same.",
            },
            draws={"r": (1.5, 2, 2.5, 3)},
            picture='hl.devices.drawing("paddle")',
        ),
    ),
)
