"""Notes print as sentences, are equal to them, and stay what they are in a copy."""

import copy
import pickle

import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.analysis.accuracy.tradeoff_rows import Status
from hapticlab.compiler.ir.notes import ParameterNote, UndefinedForceNote, UnstableNote, why_of


@pytest.mark.parametrize(
    ("note", "sentence", "said"),
    [
        (UnstableNote("it grows"), "unstable as bound: it grows", {"why": "it grows"}),
        (UndefinedForceNote("z left 0 to 1"), "F is nan where z left 0 to 1", {"where": "z left 0 to 1"}),
        (ParameterNote("k", "at most 3: N/m"), "k: at most 3: N/m", {"parameter": "k", "words": "at most 3: N/m"}),
        (Status("chaotic", "after 3 s"), "chaotic after 3 s", {"name": "chaotic"}),
        (Status("does not fit"), "does not fit", {"name": "does not fit"}),
    ],
)
def test_a_copy_says_the_same(note, sentence, said):
    for one in (note, copy.deepcopy(note), pickle.loads(pickle.dumps(note))):
        assert one == sentence and str(one) == sentence and type(one) is type(note) and vars(one) == said


def test_a_note_on_a_parameter_is_found_by_its_name_alone():
    notes = ("k: a plain sentence", ParameterNote("kappa", "live"), ParameterNote("k", "held"))
    assert why_of(notes, "k") == " (k: held)" and why_of(notes, "ka") == ""


def test_what_exact_makes_constants_of_is_told_by_name():
    z = hl.coordinate("z", unit="m")
    m, K = hl.parameters("m K", units="kg N/m", values=(0.1, 200))
    scene = hl.Scene(force=K * (hl.x(hl.t) - z), eom=[sp.Eq(m * z.diff(hl.t, 2), K * (hl.x(hl.t) - z))])
    with pytest.raises(hl.errors.ProgramError, match="computes constants for the motion of z, but K in it is live.") as refused:
        hl.compile(scene, "exact", T=1e-3, live="K")
    assert refused.value.live == ("K",)
    assert pickle.loads(pickle.dumps(refused.value)).live == ("K",)
