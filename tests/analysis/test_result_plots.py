"""Every result draws itself in one call: what is drawn is what was found, and is read in grey print too."""

import inspect
import re
import sys

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.base.drawing import STYLES, new_figure
from hapticlab.base.figure_words import describe
from hapticlab.base.telemetry import Telemetry
from hapticlab.compiler.boards.cost import cost as cost_of
from hapticlab.vocabulary import public

pytest.importorskip("matplotlib")

#: results that are a number or two, a text, or the parts of something that is drawn elsewhere
WITHOUT = {
    "Order", "PassivityIndices", "ForceError", "SensorFloor", "DigitalGains", "DeadbeatGains", "Requirements",
    "Report", "CheckResult", "Settings", "Contacts", "Found", "PaddleProfile", "LimitCycle", "MeasuredDesign",
}  # fmt: skip
#: what is run, felt or shown, and is no result
OTHERS = {
    "Telemetry",
    "Scene",
    "SerialPaddle",
    "SimulatedPaddle",
    "MapView",
    "LiveView",
    "BoardWall",
    "WallLaw",
    "Hand",
    "Task",
    "BlindComparison",
    "SharedFile",
}


def oscillation(frequency=20.0, amplitude=1e-3):
    t = np.arange(2000) * 1e-3
    x = amplitude * np.sin(2 * np.pi * frequency * t)
    return Telemetry(t=t, x=x, v=0 * t, F=np.maximum(100 * x, 0), T=1e-3)


def test_every_public_result_plots_itself():
    bare = set()
    for made in public().values():
        returned = re.search(r"Returns\n-+\n(.*)", inspect.getdoc(made) or "")
        if inspect.isfunction(made) and returned and not made.__module__.startswith("hapticlab.scene"):  # parts of scenes
            known = vars(sys.modules[made.__module__])
            kinds = (known[word] for word in re.findall(r"[A-Z]\w+", returned[1]) if inspect.isclass(known.get(word)))
            bare |= {kind.__name__ for kind in kinds if not hasattr(kind, "plot")}
    assert bare <= WITHOUT | OTHERS, bare - WITHOUT - OTHERS


def test_lines_differ_in_grey_and_stand_out_from_white():
    def grey(colour):
        return sum(weight * int(colour[k : k + 2], 16) for weight, k in ((0.299, 1), (0.587, 3), (0.114, 5)))

    def luminance(colour):  # WCAG 2.2
        parts = (int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
        linear = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
        return sum(weight * c for weight, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))

    colours = [style["color"] for style in STYLES]
    assert all(abs(grey(a) - grey(b)) > 0.19 * 255 for a, b in zip(colours, colours[1:], strict=False))
    assert all(1.05 / (luminance(colour) + 0.05) > 3 for colour in colours)
    assert len({str(style["linestyle"]) for style in STYLES}) == len(STYLES)


def line(axes, label):
    return next(one for one in axes.lines if one.get_label().startswith(label))


def test_chatter_is_drawn_with_its_amplitude_and_frequency():
    above, below = hl.chatter(oscillation()).plot().axes
    band = line(above, "amplitude, 0.998 mm to either side").get_ydata()
    np.testing.assert_allclose(band, 1.0, rtol=5e-3)  # 25 samples to half a cycle miss its crest by 0.2 %
    spectrum = line(below, "amplitude in the last half")
    peak = spectrum.get_ydata().argmax()
    assert spectrum.get_xdata()[peak] == pytest.approx(20.0, abs=0.125)  # eight points to a bin of 1 Hz
    assert spectrum.get_ydata()[peak] == pytest.approx(1.0, rel=1e-3)  # leakage of the window
    assert line(below, "found: 20 Hz").get_xdata()[0] == pytest.approx(20.0, rel=1e-4)


def test_a_limit_is_drawn_with_what_it_promises():
    found = hl.passivity_limit(hl.Device(b=0.1, T=1e-3))
    figure = found.plot()
    promised, beyond = (bars.patches[0] for bars in figure.axes[0].containers)
    assert (promised.get_width(), beyond.get_x()) == pytest.approx((200.0, 200.0))  # 2 b/T
    assert figure.alt.startswith(str(found)) and all(note in figure.get_supxlabel() for note in found.assumptions)
    none = hl.passivity_limit(hl.Device(b=0.1, T=1e-3), B=1.0).plot()
    assert none.legends[0].get_texts()[0].get_text() == "guaranteed: nothing"


def test_energy_is_drawn_and_what_was_given_is_hatched():
    x = 1e-3 * np.array([0, 2, 4, 6, 4, 2, 0, -2])
    log = Telemetry(t=np.arange(8) * 1e-3, x=x, v=0 * x, F=np.maximum(100 * x, 0), T=1e-3)
    (axes,) = hl.energy(log).plot().axes
    held = np.maximum(100 * x, 0)[:-1] * np.diff(x)
    np.testing.assert_allclose(axes.lines[0].get_ydata(), 1e3 * np.r_[0, np.cumsum(held)], atol=1e-12)
    (given,) = axes.collections
    assert given.get_hatch() == "///" and given.get_label() == "returned beyond the energy taken, at most 1.2 mJ"


def test_energy_books_are_drawn_so_that_they_add_up():
    m, K, c = hl.parameters("m K c", units="kg N/m N*s/m", values=(0.05, 200, 0.3))
    z = hl.coordinate("z", unit="m")
    L = m * z.diff(hl.t) ** 2 / 2 - K * (hl.x(hl.t) - z) ** 2 / 2
    motion = hl.mechanics.lagrange(L, dissipation=c * z.diff(hl.t) ** 2 / 2)
    books = hl.records.energy_books(hl.Scene(force=K * (hl.x(hl.t) - z), eom=[motion]))
    paddle = hl.SimulatedPaddle(m=0.05, b=1.0, T=1e-3, hand=hl.Hand(push=1.0))
    found = hl.records.balance(paddle.run(books, duration=0.05, progress=False))
    above, below = found.plot().axes
    top = above.collections[1].get_paths()[0].vertices[:, 1].max()
    supplied = line(above, "supplied").get_ydata()
    assert top == pytest.approx(supplied[-1], abs=1e3 * abs(found.leak).max() + 1e-12)
    np.testing.assert_array_equal(line(below, "returned at the port").get_ydata(), 1e3 * found.sampling)


def test_a_reference_is_drawn_with_the_errors_of_programs():
    scene, motion = hl.library.mass_spring_damper(), hl.methods.handle_motions()[1]
    reference, program = hl.methods.reference(scene, motion), hl.compile(scene, T=1e-3, hold="zoh")
    assert len(reference.plot().axes) == 2
    errors = reference.plot(program).axes[2].lines[0].get_ydata()
    assert np.nanmax(errors) == pytest.approx(hl.methods.force_error(program, reference).max, rel=1e-12)


def test_an_impedance_is_drawn_and_told_by_what_it_is_like():
    m, k = hl.parameters("m k", units="kg N/m", values=(0.1, 50.0))
    z = hl.coordinate("z", unit="m", initial=hl.x(hl.n))
    F = hl.laws.virtual_coupler(z, K=k, b=hl.parameters("b", units="N*s/m", values=0.0))
    curve = hl.passivity.impedance(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)], name="mass on a spring"))
    s = 2j * np.pi * curve.frequency
    np.testing.assert_allclose(curve.Z, 1 / (1 / (m.value * s) + s / k.value), rtol=1e-9)  # near resonance digits are lost
    above, below = curve.plot().axes
    np.testing.assert_array_equal(above.lines[0].get_ydata(), abs(curve.Z))
    assert below.lines[0].get_ydata()[0] == pytest.approx(90, abs=1e-6)
    assert str(curve).endswith("at 200 Hz, like a spring") and "like a mass" in str(curve)


def test_a_law_is_drawn_as_a_sinusoid_feels_it():
    law = hl.laws.LinearLaw.of("ellis", K=300.0, T=1e-3)
    above, below = law.plot().axes
    assert above.lines[0].get_ydata()[0] == pytest.approx(300.0, rel=1e-6)
    theta = 2 * np.pi * 1e-3 * below.lines[0].get_xdata()
    np.testing.assert_allclose(
        below.lines[0].get_ydata(), hl.passivity.equivalent_damper(hl.Device(), law, theta), rtol=1e-9, atol=1e-9
    )


def test_a_two_port_is_drawn_with_its_verdict():
    design = hl.design.coupler(hl.SimulatedPaddle(m=0.05, b=0.2, T=1e-3))
    (axes,) = design.two_port.plot().axes
    assert axes.get_title().endswith("absolutely stable") and axes.lines[0].get_ydata().min() >= -1e-9


def test_a_cost_is_drawn_part_by_part():
    cost = cost_of(hl.compile(hl.wall()(k=300), T=1e-3), "uno")
    (axes,) = cost.plot().axes
    ends = [max(bars.patches[row].get_x() + bars.patches[row].get_width() for bars in axes.containers) for row in (0, 1)]
    assert ends[0] == pytest.approx(1e3 * cost.share * cost.T, rel=1e-12)
    assert ends[1] == pytest.approx(1e3 * cost.longest(True) / cost.board.hz, rel=1e-12)
    assert line(axes, "period, 1 ms").get_xdata()[0] == 1.0


def test_a_motion_is_drawn():
    position, velocity = hl.methods.handle_motions()[2].plot().axes
    t, x = position.lines[0].get_data()
    np.testing.assert_allclose(np.gradient(x, t)[5:-5], velocity.lines[0].get_ydata()[5:-5], atol=1.0)  # of 322 mm/s


def test_figures_in_words():
    said = describe(hl.chatter(oscillation()).plot())
    assert "Panel 1 of 2" in said and "Handle position x [mm] over time t [s], 0 to 2" in said
    assert "found: 20 Hz: x at 20" in said
    assert "Amplitude [mm] over frequency [Hz], 0 to 100:" in said  # as the axis ends, not the spectrum at 500 Hz
    ledger = describe(hl.bounds.table(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)).plot())
    assert "Largest stiffness K [N/m]" in ledger and "Colgate, Schenkel 200" in ledger
    drawing = describe(hl.mechanics.picture("detents"))
    assert drawing == "Detents. A drawing: handle, x, U(x), pitch p."


def test_a_paddle_without_dry_friction_shows_the_one_part_it_has():
    found = hl.design.compensation(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3))
    (axes,) = found.plot().axes
    assert axes.lines[0].get_xdata()[0] == found.viscous and "runs away" in {text.get_text() for text in axes.texts}


def hatched(axes):
    """The place of what is hatched, by its label."""
    return {patch.get_label(): patch.get_bbox() for patch in axes.patches if patch.get_hatch()}


def test_the_forbidden_side_of_a_limit_is_hatched_and_named():
    law = hl.laws.LinearLaw.of("backward_difference", K=100, T=1e-3)
    ((words, place),) = hatched(hl.passivity.margin(hl.Device(b=0.06), law).plot().axes[0]).items()
    assert "not passive" in words and place.y0 == 0.06 < 0.1 < place.y1  # the law asks for K T = 0.1
    port = hl.design.coupler(hl.SimulatedPaddle(m=0.05, b=0.2, T=1e-3), b_c=0.05).two_port
    ((words, place),) = hatched(port.plot().axes[0]).items()
    assert "not absolutely stable" in words and place.y0 < 0 == place.y1


LAW = hl.laws.LinearLaw.of("ellis", K=300, T=1e-3)


@pytest.mark.parametrize(
    "draw",
    [
        lambda: hl.passivity.nyquist_disk(hl.Device(b=0.1), LAW).plot(),
        lambda: hl.passivity.margin(hl.Device(b=0.06), LAW).plot(),
        lambda: hl.stability.root_locus(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)).plot(),
        lambda: hl.design.coupler(hl.SimulatedPaddle(m=0.05, b=0.2, T=1e-3), b_c=0.05).plot(),
    ],
    ids=["disk", "margin", "locus", "coupler"],
)
@pytest.mark.always("coupler")
def test_titles_legends_and_labels_lie_within_the_picture(draw):
    figure = draw()
    figure.canvas.draw()
    texts = [text for axes in figure.axes for text in (axes.title, axes.xaxis.label, axes.yaxis.label)]
    for shown in [*texts, *figure.legends]:
        inner = shown.get_window_extent()
        assert not inner.width or (inner.x0 >= 0 and inner.y0 >= 0 and inner.x1 <= figure.bbox.x1 and inner.y1 <= figure.bbox.y1)
    legends = [legend.get_window_extent() for legend in figure.legends]
    labels = [axes.xaxis.label.get_window_extent() for axes in figure.axes]
    assert not any(legend.overlaps(label) for legend in legends for label in labels)


def test_over_a_map_the_words_give_the_extent_of_the_map_and_not_of_the_lines_over_it():
    figure = new_figure(height=3)
    axes = figure.subplots()
    axes.pcolormesh([100.0, 200.0, 300.0], [1.0, 2.0], np.zeros((2, 3)), shading="nearest")
    axes.plot([100, 200], [1, 2], label="a limit")
    axes.set(xlim=(50, 350), xlabel="stiffness K [N/m]", ylabel="x [mm]")
    assert describe(figure).startswith("x [mm] over stiffness K [N/m], 50 to 350: ")


def test_words_begin_with_a_capital_and_symbols_and_names_of_laws_as_they_are():
    for title, said in {"speed of a wall": "Speed", "y' = \u03bb y": "y'", "zoh against soh": "zoh", "x over t": "x"}.items():
        figure = new_figure(height=2)
        figure.subplots().set(title=title, xlabel="t", ylabel="y")
        assert describe(figure).split()[0] == said


def test_a_table_of_facts_agrees_with_the_sentence_above_it():
    law = hl.laws.LinearLaw.of("zoh", K=100.0, T=1e-3)
    alike = hl.passivity.margin(hl.Device(b=0.15, T=1e-3), law)
    assert "at every frequency alike" in str(alike) and "frequency" not in [fact.name for fact in alike._facts()]
    peak = hl.passivity.margin(hl.Device(b=0.15, T=1e-3), hl.laws.LinearLaw.of("backward_difference", K=100.0, T=1e-3))
    assert {fact.name: fact.value for fact in peak._facts()}["frequency"] == pytest.approx(500)
    worst = hl.passivity.worst_motion(hl.Device(b=0.2, T="1 ms"), hl.wall()(k=500), samples=2)
    assert "draws 0.4999 mJ per cycle" in str(worst) and ">0.4999 mJ<" in worst._repr_html_()
