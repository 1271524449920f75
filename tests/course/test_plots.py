"""Answers that are plots: curves are read in SI by their labels, compared by their numbers, and what is mixed up is named."""

import json

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

import hapticlab as hl
from hapticlab.course.check import checked
from hapticlab.course.exercise import Case, Exercise
from hapticlab.course.match import plot_fault
from hapticlab.course.plain_values import NotPlain
from hapticlab.course.plotted_curves import curves

TIME = np.linspace(0, 0.2, 21)
#: by hand: half a period of 2.5 Hz, sampled at every tenth of it and not where an answer samples it
SWING = {"x": [0.0, 0.1, 0.2], "y": [0.0, 0.005, 0.0], "x_unit": "s", "y_unit": "m"}
PLOT = Exercise("swing", "plot", points=1, asks="x(t)", rtol=0.02, cases=[Case({}, {"curve 1": SWING})])
#: a loop turns back along x: it is compared point by point
LOOP = {"x": [0.0, 0.01, 0.0, -0.01], "y": [0.5, 0.0, -0.5, 0.0], "x_unit": "m", "y_unit": "m/s"}
PHASE = Exercise("phase", "plot", points=1, rtol=1e-3, cases=[Case({"A": 0.01}, {"curve 1": LOOP})])


def swing(x=TIME, y=None, xlabel="time t [s]", ylabel="position x [m]", draw="plot", axes=None):
    axes = Figure().subplots() if axes is None else axes
    getattr(axes, draw)(x, 0.005 * np.sin(5 * np.pi * TIME) if y is None else y)
    axes.set(xlabel=xlabel, ylabel=ylabel)
    return axes


Y = 0.005 * np.sin(5 * np.pi * TIME)


@pytest.mark.parametrize(
    "drawn",
    [
        swing(),
        swing().figure,
        swing(1e3 * TIME, 1e3 * Y, "$t$ (ms)", "$x$ / mm"),
        swing(TIME, 1e6 * Y, r"t [s]", r"x [$\mathrm{\mu m}$]"),
        swing(TIME[::-1], Y[::-1]),
        swing(draw="scatter"),
        swing(np.append(TIME, 0.3), np.append(Y, 9.0)),
        swing(np.linspace(0, 0.2, 999), 0.005 * np.sin(np.linspace(0, np.pi, 999))),
        (swing().figure, "axes"),
        swing(xlabel="[s] time t, of one swing", ylabel="x[n] (m)"),
        swing(ylabel="position [m] (of the handle)"),
        swing(1e3 * TIME, Y, "time [s⁻¹ ms s]", "x [m² m⁻¹]"),
        swing(np.linspace(0, 0.2, 100)[1:-1], 0.005 * np.sin(np.linspace(0, np.pi, 100)[1:-1])),  # a step short at both ends
        swing(np.append(TIME[:5], np.append(np.inf, TIME[5:])), np.append(Y[:5], np.append(np.nan, Y[5:]))),
        lambda: swing(),
    ],
)
def test_the_same_curve_drawn_another_way_is_right(drawn):
    assert checked("98.swing", PLOT, drawn).passed


def test_lines_to_guide_the_eye_and_other_panels_do_no_harm():
    figure = Figure()
    left, right = figure.subplots(1, 2)
    swing(axes=right)
    right.axhline(0.001), right.axvspan(0.1, 0.2), right.fill_between(TIME, Y)
    left.plot([0, 1], [0, 1])
    assert checked("98.swing", PLOT, figure).passed
    assert [curve["x_unit"] for curve in curves(figure).values()] == ["", "s"]
    assert checked("98.swing", PLOT, np.array([left, right])).passed


@pytest.mark.parametrize(
    ("drawn", "words"),
    [
        (swing(Y, TIME, "position [m]", "time [s]"), "The axes are swapped: s belongs along x."),
        (swing(1e3 * TIME), "Along x: It is 1000 times too large"),
        (swing(y=1e3 * Y), "Along y: It is 1000 times too large"),
        (swing(y=1e3 * Y), "the unit in its label match its numbers?"),
        (swing(y=-Y), "Along y: The sign is wrong."),
        (swing(y=2 * Y), "Along y: It is twice as large as expected: is a factor 1/2 missing,"),
        (swing(xlabel="time"), "The x axis has no unit: end its label with one, such as [s]."),
        (swing(ylabel=""), "The y axis has no unit: end its label with one, such as [m]."),
        (swing(ylabel="force F [N]"), "The y axis is in N; it should be a quantity in m"),
        (swing(ylabel="share [-]"), "The y axis is in a number without unit"),
        (swing(ylabel="x [parsnip]"), "the y axis is labelled 'x [parsnip]'"),
        (swing(TIME[:11], Y[:11]), "curve 1 goes from 0 to 0.1 s; needs from 0 to 0.2 s"),
        (swing(y=Y + 0.001), "expected"),
        (swing(y=np.where(TIME > 0.155, np.nan, Y)), "from 0 to 0.15 s; needs from 0 to 0.2 s (5 of its points are nan or inf)"),
        (swing(TIME[:1], Y[:1]), "curve 1"),
        (swing(y=np.nan * Y), "no curve of finite numbers"),
        (swing(TIME[:-1], Y[:-1]), "curve 1 goes from 0 to 0.19 s"),  # a step is 5 % of the range
        (swing(xlabel="t [parsnip], for long"), "'parsnip' is not defined in the unit registry"),
        (swing(np.linspace(0, 0.2, 3), [0, 1.0, 0]).get_lines(), "it is a silent_list, needs a matplotlib Figure or Axes"),
        (Figure(), "it contains no curve;"),
        (Figure().subplots(), "it contains no curve;"),
        (swing().get_lines()[0], "needs a matplotlib Figure or Axes"),
        ([1.0, 2.0], "it is a list, needs a matplotlib Figure or Axes"),
        (pyplot, "it is a module, needs a matplotlib Figure or Axes"),
        ("figure", "it is a str, needs"),
        (lambda t: swing(), "it takes (t), but is called with no argument;"),
        (lambda: None, "is its `return` missing?"),
        (lambda: 1 / 0, "ZeroDivisionError"),
    ],
)
def test_what_is_wrong_with_a_plot_is_named(drawn, words):
    result = checked("98.swing", PLOT, drawn)
    assert not result.passed and result.answered
    assert words in result.text


def test_curves_of_very_many_are_refused():
    axes = swing()
    for height in range(16):
        axes.plot(TIME, Y + height)
    with pytest.raises(NotPlain, match="it contains 17 curves; needs at most 16"):
        curves(axes)


@pytest.mark.parametrize("guesses", [[2 * Y, 3 * Y], [Y + 0.001], [-Y, 0.9 * Y, Y**2]])
def test_one_of_several_guesses_is_no_answer(guesses):
    axes = swing()
    for guess in guesses:
        axes.plot(TIME, guess)
    words = f"{len(guesses)} curve{'s' * (len(guesses) > 1)} too many. Plot only the curves that are asked for"
    assert words in checked("98.swing", PLOT, axes).text


def test_what_cannot_be_meant_as_the_answer_is_no_guess():
    axes = swing()
    axes.plot(TIME, 0 * TIME + 0.001), axes.plot([0, 0.2], [0, 0.005]), axes.plot(TIME, 0.01 * TIME)
    axes.plot(TIME, Y, "o"), axes.plot(TIME[:11], 2 * Y[:11]), axes.plot(0.1, 0.004, "x")
    beside = axes.twinx()
    beside.plot(TIME, 200 * Y), beside.set_ylabel("force [N]")
    assert checked("98.swing", PLOT, axes.figure).passed


def test_of_straight_lines_each_may_be_a_guess():
    ramp = Exercise("ramp", "plot", points=1, rtol=0.02, cases=[Case({}, {"curve 1": SWING | {"y": [0.0, 1.0, 2.0]}})])
    axes = swing([0, 0.2], [0, 2.0])
    assert checked("98.ramp", ramp, axes).passed
    axes.plot([0, 0.2], [0, 1.0]), axes.plot(TIME, 0 * TIME)
    assert "2 curves too many" in checked("98.ramp", ramp, axes).text


def hyperbola(points):
    """The limit b/(T/2 + d) of lab 03 over the delay, at points of a student's."""
    d = np.asarray(points)
    return swing(1e3 * d, 1.1 / (5e-4 + d), "delay [ms]", "stiffness [N/m]")


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (np.linspace(0, 3e-3, 7), "right"),
        (np.linspace(0, 3e-3, 10), "right"),
        (np.linspace(0, 3e-3, 15), "right"),
        (np.arange(0, 3e-3, 5e-5), "right"),
        (np.geomspace(1e-6, 3e-3, 50), "right"),
        (np.linspace(0, 3e-3, 6), "curve 1 has points up to 0.0006 s apart; needs more points, at most 0.0005 s apart"),
        (np.array([0, 3e-3]), "up to 0.003 s apart"),
        (np.append(np.linspace(0, 1e-3, 40), 3e-3), "up to 0.002 s apart"),
    ],
)
def test_points_that_lie_on_a_finely_sampled_curve_are_right(points, words):
    fine = curves(hyperbola(np.linspace(0, 3e-3, 200)))
    exercise = Exercise("limit", "plot", points=1, rtol=0.02, cases=[Case({}, fine)])
    result = checked("98.limit", exercise, hyperbola(points))
    assert words in result.text and result.passed == (words == "right")


def test_few_points_off_the_curve_are_told_where_they_are():
    fine = curves(hyperbola(np.linspace(0, 3e-3, 200)))
    exercise = Exercise("limit", "plot", points=1, rtol=0.02, cases=[Case({}, fine)])
    d = np.linspace(0, 3e-3, 10)
    coarse = Exercise("limit", "plot", points=1, rtol=0.02, cases=[Case({}, curves(hyperbola(np.linspace(0, 3e-3, 7))))])
    assert checked("98.limit", coarse, hyperbola(np.linspace(4e-5, 3e-3, 75))).passed
    drawn = swing(1e3 * d, np.where(d == d[3], 1000.0, 1.1 / (5e-4 + d)), "delay [ms]", "stiffness [N/m]")
    assert "at 0.001 s it is 1000 N/m, expected 733." in checked("98.limit", exercise, drawn).text


def by_pyplot(A):
    pyplot.plot(TIME, A * np.sin(5 * np.pi * TIME))
    pyplot.xlabel("t [s]"), pyplot.ylabel("x [m]")
    return pyplot.gcf()


def test_the_figure_that_pyplot_holds_is_a_new_one_in_each_case():
    swings = [Case({"A": A}, {"curve 1": SWING | {"y": [0.0, A, 0.0]}}) for A in (0.005, 0.01, 0.02, 0.03)]
    exercise = Exercise("swing", "plot", points=1, rtol=0.02, cases=swings)
    own = pyplot.figure()
    try:
        assert checked("98.swing", exercise, by_pyplot).text.endswith("right: 1 curve (in 4 cases)")
        assert checked("98.swing", exercise, lambda A: by_pyplot(A).axes[0]).passed
        assert pyplot.get_fignums() == [own.number] and pyplot.gcf() is own and not own.axes
    finally:
        pyplot.close(own)
    assert checked("98.swing", exercise, by_pyplot).passed
    assert not pyplot.get_fignums()


def phase(x, y):
    return lambda A: swing(1e3 * np.array(x), y, "x [mm]", "v [m/s]")


@pytest.mark.parametrize(
    ("drawn", "words"),
    [
        (phase(LOOP["x"], LOOP["y"]), "right: 1 curve (A = 0.01)"),
        (phase(LOOP["x"], -np.array(LOOP["y"])), "Along y: The sign is wrong."),
        (phase(LOOP["x"][:3], LOOP["y"][:3]), "it has 3 points, needs 4"),
        (phase(np.array(LOOP["x"]) * 1e-3, LOOP["y"]), "Along x: It is 1000 times too small"),
        (phase(LOOP["x"], np.array(LOOP["y"]) + 0.1), "curve 1 is not there"),
    ],
)
def test_a_loop_is_compared_point_by_point(drawn, words):
    result = checked("98.phase", PHASE, drawn)
    assert words in result.text and result.passed == words.startswith("right")


def test_each_of_several_curves_is_looked_for():
    other = SWING | {"y": [0.0, 0.1, 0.4]}
    both = Exercise("both", "plot", points=1, rtol=0.02, cases=[Case({}, {"x": SWING, "square": other})])
    axes = swing()
    assert "1 curve, needs 2" in checked("98.both", both, axes).text
    (line,) = axes.plot(TIME, 5 * TIME**2 + 1)
    assert "at 0 s it is 0 m" not in checked("98.both", both, axes).text
    line.set_ydata(10 * TIME**2)
    assert checked("98.both", both, axes).passed
    axes.plot(TIME, 5 * TIME**2)
    assert "1 curve too many" in checked("98.both", both, axes).text


def test_slips_of_a_plot_are_curves_too():
    late = SWING | {"y": [0.0, 0.0025, 0.005]}
    case = Case({}, {"curve 1": SWING}, slips=[({"curve 1": late}, "It is a straight line.")])
    result = checked("98.s", Exercise("s", "plot", points=1, rtol=0.02, cases=[case]), swing(y=0.025 * TIME))
    assert result.text.endswith("It is a straight line.") and result.verdicts[0].slip == "It is a straight line."


def test_what_the_package_plots_itself_is_read():
    log = hl.records.Telemetry(t=TIME, x=Y, v=0 * Y, F=200 * Y, T=1e-2)
    found = list(curves(hl.plot(log, "x", "F")).values())
    assert [(curve["x_unit"], curve["y_unit"]) for curve in found] == [("s", "m"), ("s", "N")]
    np.testing.assert_allclose(found[0]["y"], Y, atol=1e-15)
    np.testing.assert_allclose(found[1]["x"], TIME, atol=1e-15)
    assert json.loads(json.dumps(found)) == found


@pytest.mark.parametrize("found", [None, 1.0, {}, {"c": 1.0}, {"c": {"x": "a"}}, {"c": {"x": [], "y": []}},
                                   {"c": {"x": [[1]], "y": [1], "x_unit": "s", "y_unit": "m"}}])  # fmt: skip
def test_no_forged_reply_is_a_curve(found):
    assert plot_fault({"curve 1": SWING}, found, 1.0, 1.0) == (
        "no curve of finite numbers; needs a matplotlib Figure or Axes with one",
        "",
    )
