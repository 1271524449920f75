"""The quality of a paddle: its record, its file, its page, and the page of a class."""

import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError, PaddleError
from hapticlab.measurement.quality.page import quality_page
from hapticlab.measurement.quality.record import PaddleQuality, Rendered, Velocity, Width

f = (2.0, 10.0, 50.0)
DAY = "2026-11-20"


def made(name="bench 7", *, K=(800.0, 1500.0), profile="hapkit_rough", frequency=f, late=1e-3):
    """A record without a measurement: a spring of 100 N/m, its force late by so much."""
    s = 2j * np.pi * np.array(frequency)
    Z = 100 / s * np.exp(-s * late)
    rendered = Rendered(100.0, 0.0, frequency, tuple(Z.real), tuple(Z.imag), (0.01,) * len(frequency))
    width = Width("backward difference", (0.0, 2.0), K, (900.0, 1600.0), K)
    velocity = Velocity("backward difference", 5e-4, 5e-3, 933, True)
    return PaddleQuality(name, DAY, "simulated paddle", "a pinch", hl.devices.profile(profile), (width,), rendered, (velocity,))


def test_what_a_record_derives_is_what_the_formulas_say():
    one = made(late=1e-3)
    assert one.rendered.stiffness == pytest.approx(100 * np.cos(2 * np.pi * np.array(f) * 1e-3))
    assert one.rendered.off == pytest.approx(2 * np.sin(np.pi * np.array(f) * 1e-3))
    assert one.rendered.same_up_to == 10.0  # 31 % off at 50 Hz
    assert made(late=0.1).rendered.same_up_to == 0.0 and made(late=0.0).rendered.same_up_to == 50.0
    assert one.stiffest == (1500.0, 2.0, "backward difference") and made(K=(math.nan, 700.0)).stiffest[0] == 700.0
    profile = one.profile
    assert one.one_count == pytest.approx(0.05 * math.sqrt(2) * profile.counts_per_metre)
    assert one.same_damping == pytest.approx(0.34 * profile.b / (profile.T / 2 + profile.delay + profile.sensor_delay))
    assert one.passive == hl.passivity_limit(profile).K
    for words in ("1500 N/m, with B = 2", "within 23 % of the ideal up to 10 Hz"):
        assert words in str(one)


@pytest.mark.wide
def test_measured_results_are_joined():
    paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
    quick = {"starts": hl.measure.Starts(run_ups=0, pushes=1.0, within_count=1), "search": hl.measure.Search(tolerance=0.3)}
    width = hl.measure.z_width(paddle, hl.wall(velocity=hl.velocity.filtered(tau="4 ms")), B=[0.0, 1.0], **quick)
    short = hl.measure.Averaging(blocks=2, realizations=1, settle=0.2)
    shaken = hl.measure.impedance(
        paddle, hl.wall(unilateral=None)(k=150, B=0.3), excitation=hl.measure.Excitation(drive="motor"), averaging=short
    )
    found = hl.measure.quality("bench 7", paddle, width, shaken)
    assert found.widths[0].velocity == "filtered difference" and found.widths[0].rest == tuple(width.unstable[:, 0])
    assert (found.rendered.K, found.rendered.B) == pytest.approx((150, 0.3))
    assert found.rendered.Z == pytest.approx(shaken.rendered)
    assert found.rendered.off == pytest.approx(abs(shaken.transparency - 1))
    assert found.profile == hl.devices.profile("hapkit") and found.on == "simulated paddle"
    with pytest.raises(AnalysisError, match="2 impedances"):
        hl.measure.quality("bench 7", paddle, shaken, shaken)


def test_what_is_no_measurement_is_refused():
    paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
    assert hl.measure.quality("bench 7", paddle).profile == hl.devices.profile("hapkit")
    with pytest.raises(AnalysisError, match=r"needs what hl\.measure\.z_width"):
        hl.measure.quality("bench 7", paddle, 3)
    with pytest.raises(AnalysisError, match="^name = ' '; a paddle needs a name of one line"):
        hl.measure.quality(" ", paddle)
    with pytest.raises(AnalysisError, match="^date = 'today'; needs a day such as"):
        hl.measure.quality("bench 7", paddle, date="today")
    with pytest.raises(PaddleError, match="profile=my_paddle"):
        hl.measure.quality("bench 7", hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3))


def test_a_simulated_board_says_so():
    with hl.connect("sim://hapkit") as board:
        found = hl.measure.quality("bench 7", board, profile=hl.devices.profile("hapkit"))
    assert (found.on, found.held) == ("simulated board", "nobody")


@pytest.mark.wide
def test_a_simulated_board_is_measured():
    """Its handle is free: of its own 0.1 N s/m a spring of 100 N/m takes half away, and it rests up to 200 N/m."""
    starts = hl.measure.Starts(run_ups=0, pushes=0.5, within_count=1)
    options = {"search": hl.measure.Search(tolerance=0.3), "judged": hl.measure.Judgement(longest=2)}
    shake = hl.measure.Excitation(drive="motor", frequency=[5, 15, 40], amplitude=0.1)
    with hl.connect("sim://hapkit") as board:
        width = hl.measure.z_width(board, B=0, starts=starts, **options)
        shaken = hl.measure.impedance(
            board,
            hl.wall(unilateral=None)(k=100),
            excitation=shake,
            averaging=hl.measure.Averaging(blocks=2, realizations=1, settle=0.5),
            safety=hl.measure.Safety(force_max=2.0),
        )
        found = hl.measure.quality("bench 7", board, width, shaken, profile=hl.devices.profile("hapkit"))
    assert 80 < found.widths[0].rest[0] < 210
    assert found.rendered.Z.real == pytest.approx([-0.05] * 3, abs=5e-3)
    assert found.rendered.stiffness == pytest.approx([100] * 3, rel=0.03)


def test_a_file_holds_the_record_and_nothing_of_the_computer(tmp_path):
    one = made(K=(math.nan, 700.0))
    path = one.save(tmp_path / "bench7")
    again = hl.measure.read_quality(path)
    assert path.name == "bench7.json" and str(again) == str(one) and again.rendered == one.rendered
    assert again.profile == one.profile and math.isnan(again.widths[0].K[0])
    assert str(tmp_path) not in path.read_text("utf-8")


DAMAGED = {
    "widths of another shape": (lambda held: held["widths"][0]["K [N/m]"].append(3.0), "differ in length"),
    "a text as a number": (lambda held: held["rendered"].update({"K [N/m]": "100"}), "must hold numbers"),
    "a huge number": (lambda held: held["rendered"].update({"K [N/m]": 1e300}), "below 1e\\+12"),
    "a turned name": (lambda held: held.update(name="bench\u202e7"), "one line"),
    "no name": (lambda held: held.update(name=""), "one line"),
    "a day that is none": (lambda held: held.update(date="2026-13-01"), "not a day"),
    "a part too many": (lambda held: held.update(computer="mine"), "'computer' is not known"),
    "a part too few": (lambda held: held.pop("widths"), "'widths' is missing"),
    "another version": (lambda held: held.update(version=2), "reads version 1"),
    "a profile without mass": (lambda held: held["profile"]["constants"].pop("m [kg]"), "m is missing"),
    "many rows": (lambda held: held.update(velocities=held["velocities"] * 50), "at most 12"),
    "an unknown frequency": (lambda held: held["rendered"]["frequency [Hz]"].__setitem__(0, None), "must hold numbers"),
    "a wall that is none": (lambda held: held["rendered"].update({"K [N/m]": 0}), "no impedance to compare with"),
    "frequencies that fall": (lambda held: held["rendered"]["frequency [Hz]"].reverse(), "the frequencies must rise"),
    "a frequency of 0": (lambda held: held["rendered"]["frequency [Hz]"].__setitem__(0, 0), "above 0 Hz"),
}  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGED)
def test_a_damaged_file_is_refused_by_its_name(damage, tmp_path):
    change, words = DAMAGED[damage]
    path = made().save(tmp_path / "bench7.json")
    held = json.loads(path.read_text("utf-8"))
    change(held)
    path.write_text(json.dumps(held), "utf-8")
    with pytest.raises(AnalysisError, match=words) as refusal:
        hl.measure.read_quality(path)
    assert str(refusal.value).startswith("bench7.json")


def test_a_class_leaves_out_what_is_damaged_and_says_why(tmp_path):
    made("softer", K=(100.0, 200.0)).save(tmp_path / "a.json")
    made("stiffer", K=(100.0, 5000.0)).save(tmp_path / "b.json")
    (tmp_path / "c.json").write_text("{", "utf-8")
    (tmp_path / "notes.txt").write_text("no json", "utf-8")
    found = hl.measure.compare_qualities(tmp_path)
    assert [one.name for one in found.qualities] == ["stiffer", "softer"]
    assert str(found).startswith("2 paddles side by side, 1 file left out\n")
    alone = replace(found, qualities=tuple(replace(one, rendered=None) for one in found.qualities))
    assert [len(one.plot().axes) for one in (found, alone)] == [2, 1], "no panel for what nobody measured"
    assert list(found.skipped) == ["c.json"] and "left out: c.json is not the quality" in str(found)
    page = found.page(tmp_path / "class.html").read_text("utf-8")
    assert "c.json is not the quality of a paddle" in page and page.index("stiffer") < page.index("softer")
    with pytest.raises(AnalysisError, match="cannot be read"):
        hl.measure.compare_qualities(tmp_path / "nowhere")
    (tmp_path / "none").mkdir()
    with pytest.raises(AnalysisError, match="0 files"):
        hl.measure.compare_qualities(tmp_path / "none")


class Tags(HTMLParser):
    """Every element with its attributes, and the text of the page."""

    def __init__(self, page):
        super().__init__()
        self.tags, self.text = [], ""
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.text += data


@pytest.mark.parametrize("pages", ["one", pytest.param("class", marks=pytest.mark.wide)])
def test_a_page_requests_nothing_runs_nothing_and_escapes_every_name(pages, tmp_path):
    name = '<script>alert("x")</script> $\\frac & \'q'
    one = made(name)
    if pages == "class":
        for k in range(40):
            made(name if k == 3 else f"bench {k}", K=(100.0, 500.0 + 40 * k)).save(tmp_path / f"{k}.json")
        one = hl.measure.compare_qualities(tmp_path)
    page = one.page(tmp_path / "page.html").read_text("utf-8")
    seen = Tags(page)
    assert name in seen.text and "<script" not in page
    assert {tag for tag, _ in seen.tags}.isdisjoint({"script", "link", "iframe", "object", "form", "a"})
    sources = [attributes["src"] for _, attributes in seen.tags if "src" in attributes]
    assert len(sources) == 2 and all(source.startswith("data:image/svg+xml;base64,") for source in sources)
    assert all(len(attributes["alt"]) > 60 for tag, attributes in seen.tags if tag == "img")
    assert not re.search(r"https?://|url\(", re.sub(r'src="[^"]*"', "", page))
    assert "default-src 'none'; img-src data:" in page
    heads = [attributes.get("scope") for tag, attributes in seen.tags if tag == "th"]
    assert heads and set(heads) <= {"col", "row"}
    if pages == "class":
        assert sum(tag == "tr" for tag, _ in seen.tags) == 41


def test_a_page_says_what_is_nominal():
    nominal, rough = (quality_page(replace(made(profile=one), widths=(), rendered=None)) for one in ("hapkit", "hapkit_rough"))
    assert "Its constants are nominal" in nominal and "No real paddle was measured" in nominal
    assert "0.02 to 0.08 N" in rough and "Its constants are nominal" not in rough
