"""A profile's file says the same when it is read, says nothing of the computer, and is refused in words when it is damaged."""

import dataclasses
import json

import pytest

import hapticlab as hl
from hapticlab.device.profiles import PROFILES
from hapticlab.device.variants import VARIANTS
from hapticlab.errors import PaddleError

B = hl.identify.Estimate("b", 0.1, 0.08, 0.12, "N s/m", "a swing, 95% interval, 2026-11-20")
TWIN = hl.devices.PaddleProfile("bench 7", m=0.03, b=0.1, estimates=(B,), nominal=False, source="µ", wiring="hapkit")


@pytest.mark.parametrize("kind", [*PROFILES, *(f"{name}_{word}" for name in PROFILES for word in VARIANTS)])
def test_every_profile_is_read_as_it_was_saved(kind, tmp_path):
    profile = hl.devices.profile(kind)
    assert hl.devices.profile(profile.save(tmp_path / kind)) == profile


def test_a_twin_is_read_by_path_and_makes_a_paddle(tmp_path):
    path = TWIN.save(tmp_path / "bench7")
    assert path.name == "bench7.json"
    assert hl.devices.profile(path) == hl.devices.profile(str(path)) == TWIN
    assert hl.SimulatedPaddle.from_profile(str(path)) == hl.SimulatedPaddle.from_profile(path).from_profile(TWIN)
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))  # as an editor may leave it
    assert hl.devices.profile(path) == TWIN


def test_the_file_has_units_and_nothing_of_the_computer(tmp_path):
    held = json.loads(TWIN.save(tmp_path / "a.json").read_text("utf-8"))
    assert held["constants"]["b [N s/m]"] == {"value": 0.1, "low": 0.08, "high": 0.12, "source": B.source}
    assert held["constants"]["T [s]"] == {"value": 0.001} and "force_max [N]" not in held["constants"]
    told = {"format", "version", "nominal", "name", "source", "rounding", "wiring", "constants"}
    assert set(held) == told and str(tmp_path) not in json.dumps(held)


def test_what_could_not_be_read_again_is_not_written(tmp_path):
    with pytest.raises(PaddleError, match="the profile two\nlines is not a profile: the name must be a text of one line"):
        dataclasses.replace(TWIN, name="two\nlines").save(tmp_path / "a.json")
    assert not list(tmp_path.iterdir())


def changed(**parts):
    """The bytes of a profile's file with some parts replaced, constants by their name; None leaves a part out."""

    def damage(held):
        for name, value in parts.items():
            into = held if name in held else held["constants"]
            key = next((key for key in into if key.split(" [")[0] == name), name)
            into[key] = value
            if value is None:
                del into[key]
        return json.dumps(held).encode()

    return damage


def renamed(old, new):
    return lambda held: json.dumps(held).replace(old, new).encode()


def driven(key, value):
    """The bytes of a file whose drive holds one quantity more."""
    radii = {"drum [m]": 0.005, "sector [m]": 0.075, "handle [m]": 0.08}
    return lambda held: json.dumps({**held, "drive": {**radii, key: value}}).encode()


HOSTILE = {
    "empty": (lambda held: b"", "it is damaged"),
    "cut": (lambda held: json.dumps(held).encode()[:200], "it is damaged"),
    "no text": (lambda held: b"\xff\xfe\x00", "is not text in UTF-8"),
    "large": (lambda held: b" " * 200_000, "has more than 100000 bytes"),
    "deep": (lambda held: b"[" * 50_000, "it is damaged"),
    "list": (lambda held: b"[]", 'it does not begin with "format"'),
    "of another kind": (changed(format="notebook"), 'it does not begin with "format"'),
    "newer": (changed(version=2), "version 2 of the format; this hapticlab reads version 1. Update hapticlab"),
    "no version": (changed(version=None), "version None of the format"),
    "version true": (changed(version=True), "version True of the format"),
    "unknown part": (renamed('"wiring"', '"wires"'), "'wires' is not known in the file"),
    "part missing": (changed(source=None), "'source' is missing in the file"),
    "nan": (renamed('"value": 0.03', '"value": NaN'), "NaN is not a number"),
    "overflow": (renamed('"value": 0.03', '"value": 1e999'), "m = inf kg"),
    "many digits": (renamed('"value": 0.03', '"value": ' + "9" * 5000), "bench.json"),
    "negative mass": (changed(m={"value": -0.03}), "m = -0.03 kg; the profile bench 7 needs m > 0"),
    "text": (changed(m={"value": "30 g"}), r"value of m \[kg\] is not a number"),
    "truth": (changed(m={"value": True}), r"value of m \[kg\] is not a number"),
    "null": (changed(m={"value": None}), r"value of m \[kg\] is not a number"),
    "no mass": (changed(m=None), "m is missing"),
    "half an interval": (changed(b={"value": 0.1, "low": 0.1}), "needs a value, or all of value, low, high, source"),
    "turned interval": (changed(b={"value": 0.1, "low": 0.12, "high": 0.08, "source": ""}), "its lower end first"),
    "beside the interval": (changed(b={"value": 0.1, "low": 0.2, "high": 0.3, "source": ""}), "must contain the value"),
    "other unit": (renamed("m [kg]", "m [g]"), r"'m \[g\]'; the unit must be \[kg\]"),
    "no unit": (renamed("m [kg]", "m"), r"'m'; the unit must be \[kg\]"),
    "misspelt": (renamed("coulomb [N]", "colomb [N]"), "'colomb' is not a constant of a paddle; did you mean coulomb?"),
    "twice": (renamed("coulomb [N]", "b [N s/m]"), r"'b \[N s/m\]' appears twice"),
    "no name": (changed(name=" "), "its name is empty"),
    "control letters": (changed(name="a\x1b[31m"), "the name must be a text of one line"),
    "long text": (changed(source="a" * 2000), "the source must be a text of one line with at most 1000 letters"),
    "number for a text": (changed(wiring=3), "the wiring must be a text"),
    "nominal as text": (changed(nominal="no"), '"nominal" must be true or false'),
    "constants as list": (changed(constants=[]), '"nominal" must be true or false'),
    "constant as number": (changed(m=0.03), "needs a value, or all of"),
    "rounding": (changed(rounding="up"), "rounding = 'up'"),
    "drive of another kind": (lambda held: json.dumps({**held, "drive": 3}).encode(), "what is not a list of quantities"),
    "drive without a radius": (lambda held: json.dumps({**held, "drive": {"drum [m]": 0.005}}).encode(), "has no sector"),
    "drive in another unit": (driven("drum [mm]", 5), r"its drive holds 'drum \[mm\]'; the quantities are drum \[m\]"),
    "drive turned round": (driven("drum [m]", -0.005), "drum = -0.005 m; a drive train needs drum > 0"),
    "drive as text": (driven("supply [V]", "12 V"), r"supply \[V\] of its drive is not a number"),
    "drive with a long source": (driven("source", "a" * 2000), "the source of the drive must be a text of one line"),
    "duties": (renamed('"duty_dead [1]": {"value": 0.0}', '"duty_dead [1]": {"value": 0.7}'), "duty_dead = 0.7"),
}


@pytest.mark.parametrize("case", HOSTILE)
def test_a_damaged_file_is_refused_in_words(case, tmp_path):
    damage, words = HOSTILE[case]
    path = TWIN.save(tmp_path / "bench.json")
    before = path.read_bytes()
    path.write_bytes(damage(json.loads(before)))
    assert path.read_bytes() != before
    with pytest.raises(PaddleError, match=words) as refused:
        hl.devices.profile(path)
    assert "bench.json" in str(refused.value) and str(tmp_path) not in str(refused.value)


def test_a_file_that_is_not_there_is_told(tmp_path):
    for path in (tmp_path / "none.json", tmp_path, tmp_path / "a\0b.json"):
        with pytest.raises(PaddleError, match=f"{path.name}: (the file cannot be read|there is no such file)"):
            hl.devices.profile(path)
