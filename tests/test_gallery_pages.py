"""What the generators of the gallery and of the labs write, as text."""

import re
from pathlib import Path

import pytest
from builder.pages import gallery, lab_pages
from builder.pages.library_code import library_code
from builder.running.frames import frame
from builder.running.lab_outcomes import Outcome

import hapticlab as hl
from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import read
from hapticlab.widgets.spans import spans

ROOT = Path(__file__).parents[1]
SCENES = gallery.sources(ROOT / "docs" / gallery.SCENES)
FIGURES = "".join(path.read_text("utf-8") for path in sorted((ROOT / "docs/gallery/figures").glob("*.md")))
#: class that has a figure -> what the pages of figures call to draw it
CALLS = {
    "AdmittanceDesign": "design.admittance(", "Assistance": "people.assistance(", "Balance": "records.balance(",
    "Bounds": "bounds.table(", "Chatter": "hl.chatter(", "CompensationLimit": "design.compensation(", "Cost": "cost(",
    "CoupledRun": "TwoPaddles(", "CouplerDesign": "design.coupler(", "DesignFront": "design.front(",
    "DiolaitiPoint": "diolaiti_plane(", "Displays": "compare_displays(", "Drawing": "devices.drawing(", "Energy": "hl.energy(",
    "FeltDifference": "felt_difference(", "Fitts": "people.fitts(", "ForcedChoice": "forced_choice(", "Found": "identify.paddle(",
    "HandleMotion": "handle_motions(", "HybridMotion": "hybrid_wall(", "Impedance": "passivity.impedance(",
    "Juggle": "people.juggle(",
    "LargestStiffness": "largest_stiffness(", "LawComparison": "compare_laws(", "LawLimits": "law_limits(",
    "Ledger": "passivity.ledger(", "Limit": "passivity_limit(", "LinearLaw": "LinearLaw.of(",
    "MeasuredImpedance": "measure.impedance(",
    "Methods": "methods.table(", "MotorCurve": "identify.motor(", "NyquistDisk": "nyquist_disk(",
    "OverCompensation": "over_compensation(", "PaddleQuality": "measure.quality(", "PassivityMargin": "passivity.margin(",
    "PassivityTrace": "passivity.trace(", "PortPassivity": "passivity.port(", "PsychometricFit": "people.psychometric(",
    "QualityComparison": "compare_qualities(", "Reach": "people.reach(", "Reduction": "mechanics.reduction(",
    "Reference": "methods.reference(", "Replay": "records.replay(", "RootLocus": "root_locus(", "Staircase": "records.staircase(",
    "StepLimit": "step_limit(", "Storage": "records.storage(", "Sweep": "hl.sweep(", "Tradeoff": "methods.tradeoff(",
    "TwoPort": "two_port.plot(", "VelocityErrors": "velocity.compare(", "WallMap": "wall_map(", "WorstMotion": "worst_motion(",
    "ZWidth": "z_width(",
}  # fmt: skip


def test_every_scene_of_the_library_has_a_page():
    assert list(SCENES)[: len(hl.library.catalogue)] == list(hl.library.catalogue)
    assert all(f"scene = hl.library.{name}()" in SCENES[name].code for name in hl.library.catalogue)


@pytest.mark.always("detents", "stick_slip")
@pytest.mark.parametrize("name", hl.library.catalogue)
def test_the_code_that_is_written_out_gives_the_scene_of_the_library(name):
    scene, names = hl.library.catalogue[name].scene, {}
    exec(library_code(scene), names)
    assert names["scene"] == scene()


@pytest.mark.always("wall", "detents", "pen", "thin_plate")
@pytest.mark.parametrize("name", SCENES)
def test_a_page_changes_values_that_the_scene_has(name):
    source, names = SCENES[name], {}
    code, paddle = source.code.split("paddle = ")
    exec(code, names)
    sliders = re.search(r"sliders=(\{.*\})", paddle)
    ends = {one.name: one for one in spans(hl.compile(names["scene"], T=1e-3), sliders and eval(sliders[1]))}
    assert source.changes and source.title and source.summary
    for address in source.changes:
        given = dict(part.split("=") for part in address.split(";"))
        assert not any(value.endswith("K") for value in given.values())  # a page reads no unit of temperature
        scene = names["scene"](**{key: float(value) if re.fullmatch(r"[\d.]+", value) else value for key, value in given.items()})
        assert scene != names["scene"], address
        for key in given:
            assert ends[key].low <= scene.values[key] <= ends[key].high * (1 + 1e-9), f"{name}: {address} is beyond its slider"


def test_a_card_shows_the_bodies_of_a_scene_or_the_force_of_a_law():
    assert gallery.thumbnail(hl.library.detents(), True).axes[0].get_title() == ""
    line = gallery.thumbnail(hl.wall()(k=100, x_o="5 mm"), False).axes[0].lines[0].get_xydata()
    assert line[:, 0].max() == pytest.approx(20) and line[:, 1].max() == pytest.approx(1.5)  # mm, and N of 15 mm


def test_a_scene_without_a_file_is_named(tmp_path):
    with pytest.raises(ValueError, match="no file for the library's mass_spring_damper"):
        gallery.sources(tmp_path)


def test_a_failing_scene_is_named(tmp_path, monkeypatch):
    broken = gallery.Source("wall", "A wall", "words", "1 / 0", (), {})
    monkeypatch.setattr(gallery, "sources", lambda folder: {"wall": broken})
    (tmp_path / "gallery").mkdir()
    with pytest.raises(gallery.ExampleError, match=r"docs/gallery/scenes/wall\.py: ZeroDivisionError"):
        gallery.write(tmp_path, quick=True)


def test_a_frame_has_a_title_and_a_link_and_one_file_has_one_content(tmp_path):
    of = {"folder": tmp_path, "page": "gallery/wall", "title": 'A wall of "steel"'}
    made = frame("wall", "<p>one", **of, address="#k=5N/m")
    assert 'src="../live/wall.html#k=5N/m" title="A wall of &quot;steel&quot;" loading="lazy"' in made
    assert '<a href="../live/wall.html#k=5N/m">' in made and (tmp_path / "live/wall.html").read_text() == "<p>one"
    with pytest.raises(ValueError, match="differs"):
        frame("wall", "<p>two", **of)


@pytest.mark.always("02")
@pytest.mark.parametrize("lab", find_labs(ROOT / "labs"), ids=lambda lab: lab.number)
def test_the_page_of_a_lab_has_all_its_text_and_code_and_no_answer(lab):
    cells = read(lab.notebook)["cells"]
    page = lab_pages.page(lab.name, cells, {}, None)
    texts = ["".join(cell["source"]).replace("```python", "```py").strip().split("\n", 1)[-1] for cell in cells]
    assert [text for text in texts if text not in page] == []
    assert page.count("raise NotImplementedError") == str(cells).count("raise NotImplementedError")
    assert f"<{lab.name}.ipynb>" in page


def test_a_page_of_a_lab_shows_what_cells_gave_and_nothing_of_a_check():
    cells = [{"cell_type": kind, "id": str(k), "source": text} for k, (kind, text) in enumerate([
        ("markdown", "# Lab 99: Title\n\nText"), ("code", "print(4)\nview"), ("code", "hl.check('99.a', a)")])]  # fmt: skip
    outcomes = {
        "1": Outcome("4\n", [("text/html", "<b>5</b>"), ("text/markdown", "$$6$$")], ["<p>view"]),
        "2": Outcome("", [("text/html", "<i>not answered</i>")]),
    }
    page = lab_pages.page("99_title", cells, outcomes, lambda html: f"<iframe of {html}>")
    for part in ("```py\nprint(4)\nview\n```", ":class: printed\n\n4\n```", "<iframe of <p>view>", "<b>5</b>", "\n$$6$$\n"):
        assert part in page
    assert "not answered" not in page


def test_every_kind_of_figure_is_shown():
    texts = [path.read_text("utf-8") for path in (ROOT / "hapticlab").rglob("*.py")]
    bodies = [body for text in texts if "    def plot(" in text for body in text.split("\nclass ")[1:]]
    classes = {re.match(r"\w+", body)[0] for body in bodies if "\n    def plot(" in body}
    classes -= {"DisplayList"}  # which lists the strokes of a drawing
    assert classes == set(CALLS)
    assert [name for name, call in CALLS.items() if call not in FIGURES] == []
