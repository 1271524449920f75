"""What first cells got wrong, and what they are told: each call was a student's first guess, from README and completion alone."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab import n, v

PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch", push=0.5))


def test_one_name_takes_a_unit_with_a_blank():
    assert hl.parameters("B", units="N s/m").unit == "N s/m"
    assert hl.compile(hl.Scene(force=hl.parameters("B", units="N s/m") * v(n)), T=1e-3)
    with pytest.raises(hl.HapticlabError, match=r"2 names \(k B\) but 3 units .* a product with \*, such as units='N/m N\*s/m'"):
        hl.parameters("k B", units="N/m N s/m")


def test_a_sweep_says_which_comes_first():
    with pytest.raises(hl.HapticlabError, match=r"is not a scene; .*the scene comes first: hl\.sweep\(scene, paddle, \.\.\.\)"):
        hl.sweep(PADDLE, hl.wall(), k=[100, 200])


@pytest.mark.parametrize(
    ("made", "wrong", "words"),
    [
        (lambda: hl.passivity_limit(PADDLE), "k", r"Limit has no k; take \.K; it has K, "),
        (lambda: hl.stability_limit(PADDLE), "value", r"take \.K"),
        (
            lambda: hl.sweep(hl.wall(), PADDLE, 0.05, k=[50, 100], progress=False),
            "results",
            r"no results; take \.values",
        ),
    ],
)
def test_a_wrong_attribute_names_the_right_one(made, wrong, words):
    with pytest.raises(AttributeError, match=words):
        getattr(made(), wrong)


@pytest.mark.parametrize(("word", "name"), [("grip", "hl.Hand"), ("pinch", "hl.Hand"), ("hapkit", "hl.devices.profile")])
def test_a_word_of_the_description_finds_a_name(word, name):
    assert name in hl.find(word)


def test_the_work_on_a_damper_is_told_though_no_penetration_ends():
    log = PADDLE.run(hl.laws.virtual_damper()(B=0.5), 0.5, v=0.2)
    found = hl.energy(log)
    assert found.absorbed == found.W[-1] > 0
    assert f"the handle's work on the environment is {1e3 * found.W[-1]:.4g} mJ" in str(found)
    assert np.isfinite(found.absorbed)
