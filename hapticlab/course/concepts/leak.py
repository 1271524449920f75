"""Questions on the energy of a sampled and held spring."""

from .question import Concept, Question

CONCEPT = Concept(
    "leak",
    "Energy of a held spring",
    (
        Question(
            "source_of_the_leak",
            about="Where the energy of a sampled wall comes from",
            asks=(
                "A handle without friction moves into a virtual wall and out again. The motor holds each force until the next "
                "sample. The handle leaves the wall faster than it entered. Where does the additional energy come from?"
            ),
            right=(
                "The held force belongs to the beginning of each period: it is too small on the way in and too large on the "
                "way out."
            ),
            wrong={
                "stiffer_on_exit": "The program computes a larger stiffness while the handle moves out than while it moves in.",
                "friction_supplies": "The bearings and the cable store energy on the way in and return it on the way out.",
                "encoder_makes_leak": "The encoder rounds the position, and the rounded position is too deep inside the wall.",
            },
        ),
        Question(
            "leak_of_one_period",
            about="The energy that the hold generates in one period",
            asks=(
                "A virtual wall of {K:g} N/m is sampled, and its force is held for one period. At a sample the handle is "
                "{d:g} mm inside the wall, and at the next sample {d_next:g} mm. The handle does work against this force. By "
                "how much does this work differ from the energy that an ideal spring of {K:g} N/m would absorb in the same "
                "motion?"
            ),
            right="It is {leak:.4g} µJ smaller.",
            wrong={
                "full_rectangle": "It is {full:.4g} µJ smaller.",
                "stored_for_leaked": "It is {stored:.5g} µJ smaller.",
                "spring_conserves": "It does not differ.",
            },
            draws={"K": (200, 400, 600, 800), "d": (2, 3, 4), "D": (0.1, 0.2, 0.3)},
            computes={
                "d_next": lambda K, d, D: d + D,
                "leak": lambda K, d, D: K * D**2 / 2,  # mm^2 and N/m make uJ
                "full": lambda K, d, D: K * D**2,
                "stored": lambda K, d, D: K * d**2 / 2,
            },
        ),
        Question(
            "leak_with_faster_sampling",
            about="The energy that a contact generates if the sampling is faster",
            asks=(
                "A machine moves a handle into a virtual wall and out again, always along the same path at the same speeds. "
                "The picture shows the position and the force of such a contact. With the period $T$ the wall generates "
                "{E:g} µJ in total. How much does it generate approximately if the period is $T/{r:g}$?"
            ),
            right="{right:.3g} µJ",
            wrong={
                "one_period_for_all": "{one:.3g} µJ",
                "each_sample_leaks_alike": "{each:.3g} µJ",
                "encoder_makes_leak": "{E:g} µJ, because the encoder is the same",
            },
            draws={"E": (36, 72, 144), "r": (2, 3, 4)},
            computes={
                "right": lambda E, r: E / r,
                "one": lambda E, r: E / r**2,
                "each": lambda E, r: E * r,
            },
            picture='hl.devices.drawing("sample_and_hold")',
        ),
    ),
)
