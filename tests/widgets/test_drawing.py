"""Pictures that move without Python: what a page draws from a recording is what the picture draws, to 1e-9 of its size."""

import json
import math
import subprocess
from functools import cache

import core_in_node
import numpy as np
import pytest
import sympy as sp
from recorded_values import items_of

import hapticlab as hl
from hapticlab import n, x
from hapticlab.analysis.pictures.array_functions import ELEMENTWISE
from hapticlab.analysis.pictures.recording import recorded, recorded_picture
from hapticlab.library.entries import CATALOGUE
from hapticlab.library.sketch import Sketch
from hapticlab.widgets.browser_view import BROWSER, take_apart
from hapticlab.widgets.picture import moving_picture

needs_node = pytest.mark.skipif(core_in_node.missing() is not None, reason=str(core_in_node.missing()))
#: recorded here in README's line: rods and what turns, a slope, a track, what cannot be put together
FEW = ("cart_pole", "rolling", "virtual_fixture", "four_bar")
k, K, c, m, J = hl.parameters("k K c m J", units="N/m N/m N*s/m kg kg*m^2", values=(300, 200, 0.5, 0.1, 1e-4))
x_o, x_l, p = hl.parameters("x_o x_l p", units="m m m", values=(0.01, -0.02, 0.01))
r = hl.parameters("r", units="m", values=0.004, ranges=(0, 0.02))
A, kappa = hl.parameters("A kappa", units="N N*m/rad", values=(0.5, 0.01))
z, theta = hl.coordinate("z", unit="m"), hl.coordinate("theta", unit="rad")


def own_drawing(axes, *, x, x_o, **_):
    s = Sketch(axes, -0.06, 0.06, -0.02, 0.02)
    s.handle(x)
    s.wall(x_o, np.maximum(x, x_o), 1, 0.01, "$x_o$")
    if x > x_o:
        s.text((x, 0), "inside", color="#cc5a1a")
    at = np.linspace(-0.06, x_o, 60)
    axes.plot(at, 0.01 * np.sin(at / x_o), linestyle=":")
    axes.fill_between(at, 0.01 * np.cos(at / x_o), -0.01, color="#dbe6f0")
    axes.annotate("F", (x, 0.01), (x + 0.1 * np.sqrt(x), 0.01), arrowprops={"color": "#000000"})


def on_the_ground():
    """A box that turns, a bar whose ends a parameter rounds, a floor."""
    return [
        hl.shapes.Box("20 mm", "6 mm").at(x=z, y="10 mm", angle=z / x_o, name="box"),
        hl.shapes.Capsule("10 mm", r).at(x=x(hl.t), y="-5 mm", name="bar"),
        hl.shapes.ground("-10 mm"),
    ]


def own_scenes():
    wall, tie = hl.when(x(n) >= x_o, k * (x(n) - x_o)), K * (x(n) - z)
    body = sp.Eq(m * z.diff(hl.t, 2), tie - k * z - c * z.diff(hl.t))
    dial = sp.Eq(J * theta.diff(hl.t, 2), -kappa * theta)
    bumps = A * sp.sin(2 * sp.pi * x(n) / p) + A * hl.when(x(n) >= x_o, sp.tanh((x(n) - x_o) / p), sp.Min(x(n) / p, 0))
    return {
        "wall": (hl.wall()(k=300, x_o=0.01), None),
        "two walls": (hl.Scene(force=wall + hl.when(x(n) <= x_l, k * (x(n) - x_l))), None),
        "tie and dial": (hl.Scene(force=tie, eom=[body, dial]), None),
        "field": (hl.Scene(force=bumps), None),
        "shapes": (hl.Scene(force=tie * (1 + r / x_o), eom=[body]), on_the_ground()),
        "own drawing": (hl.wall()(k=300, x_o=0.01), own_drawing),
    }


def moments(scene, picture, count, seed=3):
    """Yield values: the scene's own parameters and others, zeros, signs both ways, a force or an aim that is hidden."""
    random = np.random.default_rng(seed)
    for number in range(count):
        values = {"x": random.uniform(-0.05, 0.05), "F": random.uniform(-6, 6), "intent": random.uniform(-0.05, 0.05)}
        for name, q in picture.channels.items():
            values[name] = random.uniform(-0.05, 0.05) if q.unit == "m" else random.uniform(-4, 4)
        if number % 2:
            values |= {name: value * random.uniform(0.3, 2.5) for name, value in scene.values.items()}
            values |= {name: random.uniform(-0.4, 0.4) for name in scene.values if name == "alpha"}
        if number % 4 == 3:
            values |= {"F": math.nan, "x": 0.0}
        if number % 5 == 4:
            values = {**dict.fromkeys(values, 0.0), "intent": math.nan} | dict(scene.values)
        if number % 7 == 6:
            del values["F"], values["intent"]
        yield values


def assert_same(found, wanted, size, name):
    assert [kind for kind, *_ in found] == [kind for kind, *_ in wanted], name
    for (_, points, style), (kind, places, wanted_style) in zip(found, wanted, strict=True):
        np.testing.assert_allclose(points, places, rtol=0, atol=1e-9 * size, err_msg=f"{name}: {kind}")
        assert style.keys() == wanted_style.keys()
        for key, value in json.loads(json.dumps(wanted_style)).items():
            if isinstance(value, str) or value is None:
                assert style[key] == value
            else:
                np.testing.assert_allclose(style[key], value, rtol=1e-9, atol=1e-9 * size, err_msg=f"{name}: {kind}'s {key}")


@cache
def case(name, count):
    """Return a picture as data, some moments, and what it draws then."""
    scene, picture = own_scenes().get(name) or (CATALOGUE[name].scene(), None)
    picture = moving_picture(scene, picture=picture)
    values = list(moments(scene, picture, count))
    return picture.recording(), values, [picture.draw(one) for one in values]


def in_node(asked):
    words = {
        name: [data, [{key: _word(value) for key, value in one.items()} for one in many]] for name, (data, many) in asked.items()
    }
    command = ["node", "tests/widgets/drawing_in_node.mjs", BROWSER / "page" / "drawing.js"]
    root = BROWSER.parents[2]
    done = subprocess.run(command, input=json.dumps(words), capture_output=True, text=True, check=False, cwd=root)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def _word(value):
    return float(value) if math.isfinite(value) else {math.inf: "Infinity", -math.inf: "-Infinity"}.get(value, "NaN")


def hold_data_to_pictures(names, count):
    for name in names:
        data, values, drawn = case(name, count)
        for one, items in zip(values, drawn, strict=True):
            assert_same(items_of(data, one), items, width(items), name)


def hold_page_to_pictures(names, count):
    answers = in_node({name: case(name, count)[:2] for name in names})
    for name in names:
        for (shape, points), items in zip(answers[name], case(name, count)[2], strict=True):
            ends, places = np.cumsum([0, *(number for _, number, _ in shape)]), np.reshape(points, (-1, 2))
            found = [(kind, places[at : at + number], style) for (kind, number, style), at in zip(shape, ends, strict=False)]
            assert_same(found, items, width(items), name)
            assert [one[:2] for one in shape] == [one[:2] for one in take_apart(items)[0]]


def width(items):
    (left, _), (right, _) = items[-1][1]
    return right - left


SOME = (*FEW, *own_scenes())


def test_data_give_what_the_picture_draws():
    hold_data_to_pictures(SOME, 5)
    for name in ("four_bar", "rolling", "own drawing"):  # not the same items each time
        assert len({len(items) for items in case(name, 5)[2]}) > 1, name


@needs_node
def test_a_page_draws_what_the_picture_draws():
    hold_page_to_pictures(SOME, 5)


@pytest.mark.wide
def test_data_give_what_each_picture_of_the_library_draws():
    hold_data_to_pictures(CATALOGUE, 60)


@needs_node
@pytest.mark.wide
def test_a_page_draws_what_each_picture_of_the_library_draws():
    hold_page_to_pictures(CATALOGUE, 60)


@needs_node
def test_functions_of_a_page_are_those_of_numpy():
    ends = [0.0, -0.0, 0.3, 1.5, -2.5, 2.0, -3.7, 1.0, math.inf, -math.inf, math.nan, 1e-9]
    pairs = [{"a": a, "b": b} for a in ends for b in ends]
    functions = {name: getattr(np, name) for name in ELEMENTWISE - {"where"}}
    given = {"a": 0.0, "b": 0.0}
    asked = {
        name: (recorded(lambda known, f=f: f(*(known[one] for one in "ab"[: f.nin])), given), pairs)
        for name, f in functions.items()
    }
    answers = in_node(asked)
    assert set(answers["functions"]) == ELEMENTWISE
    for name, f in functions.items():
        with np.errstate(all="ignore"):
            wanted = [float(f(*(np.float64(pair[one]) for one in "ab"[: f.nin]))) for pair in pairs]
        np.testing.assert_allclose([float(found) for (found,) in answers[name]], wanted, rtol=1e-14, atol=1e-300, err_msg=name)


def test_a_recording_is_small_and_plain():
    for name in ("virtual_fixture", "cart_pole"):
        assert len(json.dumps(case(name, 10)[0], allow_nan=False, separators=(",", ":"))) < 12_000, name


def test_what_a_drawing_of_ones_own_may_not_use_is_named():
    def draw_by_math(axes, *, x, **_):
        axes.plot([0, math.cos(x)], [0, math.sin(x)])

    picture = moving_picture(hl.wall()(k=300, x_o=0.01), picture=draw_by_math)
    with pytest.raises(hl.errors.AnalysisError, match=r"draw_by_math uses float\(\), int\(\), a function of math"):
        picture.recording()


def test_an_item_that_is_not_shown_is_in_no_picture():
    def draw(drawn, values):
        drawn.add("line", [(0.0, 0.0), (values["x"], 0.0)], shown=values["x"] > 0)
        drawn.add("line", [(0.0, 0.0), (math.nan, 0.0)])
        drawn.add("line", [(0.0, 0.0), (1.0, 0.0)], shown=False)
        return drawn.items

    data = recorded_picture(draw, {"x": 0.0}, "draw")
    assert [len(items_of(data, {"x": value})) for value in (-1.0, 1.0)] == [0, 1] and len(data["items"]) == 1
