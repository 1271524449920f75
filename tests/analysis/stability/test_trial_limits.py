"""What a setting of a trade-off asks of a device, beside what the library says and closed forms."""

import math

import pytest

import hapticlab as hl
from hapticlab.analysis.accuracy.tradeoff_trials import Setting
from hapticlab.analysis.stability.trial_limits import Limits

RK4 = Setting("rk4", 1e-3, 1, "soh", "before", "float32")


def damping(scene, delay=0.0, setting=RK4):
    program = hl.compile(scene, setting.method, T=setting.T, hold=setting.hold, live=())
    return Limits(scene, delay=delay).damping(setting, program)


@pytest.mark.parametrize("name", ["detents", "texture", "virtual_fixture", "buckling_beam", "mass_spring_damper"])
def test_scenes_of_the_library_ask_for_what_it_says(name):
    """Over the travel that it is made for; it says a little more, in two digits."""
    (b_req, where), said = damping(getattr(hl.library, name)()), hl.library.catalogue[name].b
    assert 0.93 * said < b_req < 1.005 * said
    assert bool(where) == (name in ("detents", "texture", "buckling_beam"))


def test_a_delay_asks_for_as_much_as_it_is_late():
    k = hl.parameters("k", units="N/m", values=200)
    b_req, where = damping(hl.Scene(force=k * hl.x(hl.n)), delay=1e-3)
    assert b_req == pytest.approx(200 * (1e-3 / 2 + 1e-3), rel=1e-6) and not where


def test_no_damping_is_enough_for_a_negative_spring():
    k = hl.parameters("k", units="N/m", values=200)
    assert damping(hl.Scene(force=-k * hl.x(hl.n))) == (math.inf, "")
