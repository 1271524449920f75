"""What lab 17 says of a paddle, and the words that it prints where that is not true."""

import numpy as np


def light_only(lab):
    return list(lab.port_mass) == [0.1 * lab.my_paddle.m] and "Put a coupler between the handle and the body" in lab.printed


def lets_go(lab):
    thick, thin = lab.through, lab.stopped
    return thick.F.min() < -0.9 * thick.F.max() < 0 and thick.x[-1] > 0.021 and thin.F.min() >= 0 and thin.z.max() < 0.01 + 1e-6


def length_kept(lab):
    return max(lab.drift["embedded"], lab.drift["appended"]) < 1e-7


def fifty_grams(lab):
    return [lab.lightest[M].state for M in (0.05, 0.02)] == ["at rest", "unstable"]


def peaks_as_sampled(lab):
    return all(abs(lab.peaks[part] - abs(part - round(part)) / lab.T) < 5 for part in lab.peaks)


CLAIMS = [
    ("so this works for light bodies only", light_only, ""),
    ("The embedded rod keeps its length to within rounding", length_kept, ""),
    ("**The spring needs the fewest cycles**", lambda lab: min(lab.cycles, key=lab.cycles.get) == "spring", ""),
    ("its length changes the most", lambda lab: max(lab.drift, key=lab.drift.get) == "spring", ""),
    ("**A tenth of the safe stiffness is enough for the hand.", lambda lab: not lab.tenth.noticed, ""),
    ("At 1.5 times the safe stiffness the simulation diverges.**", lambda lab: lab.diverged, ""),
    ("**The thick plate lets go at its middle and then throws the handle out on the far side. The thin", lets_go, ""),
    ("In each cycle the surface dissipates", lambda lab: 0.95 < lab.work / lab.predicted < 1.02, ""),
    ("gives a force with a clear peak in its spectrum", peaks_as_sampled, ""),
    ("To be passive, the amplitude must fall with the pitch.", lambda lab: np.all(np.diff(lab.most) > 0), ""),
    ("At twice this limit the grating shakes a hand", lambda lab: lab.shaken[2.0] > 0.3, "dry friction of your"),
    ("In this hand 50 g remain stable", fifty_grams, ""),
    ("so the height is felt as the force", lambda lab: lab.apart < 0.02 * 0.3, ""),
]
