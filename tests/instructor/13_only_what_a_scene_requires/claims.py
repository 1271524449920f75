"""What lab 13 says of a paddle, and the words that it prints where that is not true."""

import numpy as np

ENCODER, COARSE = "the encoder of your paddle shakes the handle more", "the steps of your coarse encoder are noticed"


def exact(lab):
    return all(found[letter].same_bits and found[letter].ratio == 0 for found in (lab.slow, lab.fast) for letter in "AB")


def only_fast(lab):
    return all(lab.fast[letter].noticed and not lab.slow[letter].noticed for letter in "CD")


def weak_but_noticed(lab):
    found = lab.slow["E"], lab.fast["E"]
    return all(one.noticed and one.force.max() < 1 for one in found)


def near_the_crossings(lab):
    crossings = [np.interp(1.0, R, frequency) for frequency, R, _ in lab.curves.values()]
    return np.allclose(crossings, list(lab.yours.values()), rtol=0.25)


def softer_is_closer(lab):
    rigid, softer = (lab.compared(name, lab.strokes(2.5)) for name in ("D", "softer"))
    return softer.force.max() < 0.5 * rigid.force.max() and softer.cycles == rigid.cycles


def twice_the_rate(lab):
    before, after = (price.T_needed() for price in lab.slow["A"].cost)
    return 1.9 < before / after < 2.2


CLAIMS = [
    ("Scenes A and B keep every bit of the force.", exact, ""),
    ("**B is not free**, however", lambda lab: lab.past_stops.noticed, ""),
    ("The tail takes most of the cycles of scene A", lambda lab: 0.6 < lab.saved["A"] < lab.saved["E"], ""),
    ("Scene A without its tail runs at twice the rate.", twice_the_rate, ""),
    ("**C and D are noticed in fast strokes only.**", only_fast, COARSE),
    ("**E is noticed although its force stays below the force threshold.**", weak_but_noticed, ENCODER),
    ("**Your limits lie within a quarter of the crossings.**", near_the_crossings, ""),
    ("but **on a softer coupler**", lambda lab: lab.offer.scene.values["k_1"] < 200, ""),
    ("This scene costs as much as yours and is much closer to the full one.", softer_is_closer, ""),
]
