"""A profile is what it says it is: units, ranges, intervals, and the ends that a design chooses."""

import dataclasses
import math

import pytest

import hapticlab as hl
from hapticlab.base.facts import documented
from hapticlab.base.profile.constants import CONSTANTS
from hapticlab.base.profile.paddle_profile import PaddleProfile
from hapticlab.errors import AnalysisError, PaddleError

B = hl.identify.Estimate("b", 0.1, 0.08, 0.12, "N s/m", "a swing")
M = hl.identify.Estimate("m", 0.05, 0.045, 0.06, "kg")


def toy(**more):
    return PaddleProfile("toy", **{"m": 0.05, "b": 0.1, **more})


def test_profile_says_what_it_is():
    nominal = toy(counts_per_metre=1e5, coulomb=0.2, force_max=3, source="a sketch")
    assert "10 um per count (floor)" in str(nominal) and "nominal, not measured" in str(nominal)
    assert "measured; source: lab" in str(dataclasses.replace(nominal, nominal=False, source="lab"))


def test_the_table_of_constants_is_that_of_the_page():
    texts = {"name", "rounding", "nominal", "source", "wiring", "estimates", "drive"}
    assert {field.name for field in dataclasses.fields(PaddleProfile)} - texts == set(CONSTANTS)
    told = documented(PaddleProfile)
    assert {name: unit for name, (unit, _) in CONSTANTS.items()} == {name: told[name][0] or "1" for name in CONSTANTS}


def test_a_twin_prints_value_interval_and_source_of_each_constant():
    lines = str(toy(estimates=(B, M), force_max=2.0, nominal=False, source="a sketch")).split("\n")
    assert lines[0].endswith("|F| <= 2 N (measured where listed; the others: a sketch)")
    assert [line.split()[0] for line in lines[1:]] == ["m", "b", "others"]
    assert "0.1 N s/m, 0.08 to 0.12; a swing" in lines[2] and "T, force_max: without an interval" in lines[3]
    one_line = str(hl.SimulatedPaddle.from_profile(toy(estimates=(B,)))).split("\n")[-1]
    assert one_line.startswith("  from paddle toy: m = 0.05 kg")


def test_a_simulated_paddle_and_a_limit_take_the_delay_of_a_profile():
    late = toy(delay="0.5 ms", sensor_delay=3e-4)
    assert late.delay == 5e-4 and hl.SimulatedPaddle.from_profile(late).delay == 5e-4
    own = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, delay=8e-4)
    assert hl.passivity_limit(late).K == pytest.approx(hl.passivity_limit(own).K)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"m": -0.05}, "m = -0.05 kg; the profile toy needs m > 0"),
        ({"m": math.nan}, "m = nan kg"),
        ({"b": -1.0}, "needs b >= 0"),
        ({"force_max": math.inf}, "force_max = inf N"),
        ({"T": 0}, "T = 0 s"),
        ({"m": None}, "m = None"),
        ({"m": "5 mm"}, "m = '5 mm'"),
        ({"rounding": "up"}, "rounding = 'up'; needs one of floor, nearest"),
        ({"duty_25": 0.3}, "three duties that rise"),
        ({"estimates": (dataclasses.replace(B, low=0.11),)}, "between 0.11 and 0.12; the interval must contain the value"),
        ({"estimates": (dataclasses.replace(B, low=0.12, high=0.08),)}, "its lower end first"),
        ({"estimates": (dataclasses.replace(B, low=-0.1),)}, "b = -0.1 N s/m; the profile toy needs b >= 0"),
        ({"estimates": (dataclasses.replace(B, high=math.nan),)}, "b = nan"),
        ({"estimates": (dataclasses.replace(B, unit="N"),)}, "b in 'N'; the unit must be 'N s/m'"),
        ({"estimates": (dataclasses.replace(B, name="k"),)}, "is not an estimate of a constant"),
        ({"estimates": (0.1,)}, "0.1 is not an estimate of a constant"),
        ({"estimates": (B, B)}, "two estimates of one constant"),
        ({"b": 0.2, "estimates": (B,)}, r"b = 0.2 N s/m, but its estimate is 0.1 N s/m. profile.at\(b=...\) changes both"),
    ],
)
def test_what_no_paddle_has_is_refused(given, words):
    with pytest.raises(PaddleError, match=words):
        toy(**given)


def test_ends_and_values_are_chosen_by_name():
    twin = toy(estimates=(B, M))
    chosen = twin.at(b="low", m="50 g", force_max=2.0)
    assert (chosen.b, chosen.m, chosen.force_max, chosen.T) == (0.08, 0.05, 2.0, 1e-3)
    assert all(one.low == one.high for one in chosen.estimates) and "low end of" in chosen["b"].source
    assert (twin["b"].low, twin.at(b="high")["m"]) == (0.08, M)
    with pytest.raises(AnalysisError, match="'coulomb' has no interval in the profile toy; with intervals: m, b"):
        twin.at(coulomb="low")
    with pytest.raises(PaddleError, match="mass is not a constant of a paddle; the constants are m, b, coulomb"):
        twin.at(mass=1)
    with pytest.raises(PaddleError, match="b = -1 N s/m"):
        twin.at(b=-1)


def test_a_profile_can_be_a_key():
    assert len({toy(estimates=(B, M)), toy(estimates=(M, B)), toy()}) == 2
