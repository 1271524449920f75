"""What a public call returns shows itself: one line for repr, all words as text, HTML in one house style."""

import ast
import importlib
import importlib.util
import inspect
import json
import re
import sys
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache, cached_property
from html import escape
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from IPython.core.formatters import DisplayFormatter

import hapticlab as hl
from hapticlab.base.facts import documented, facts, in_words
from hapticlab.base.grid import Grid
from hapticlab.base.shows_itself import ROWS, ShowsItself, Tabular

PACKAGE = Path(hl.__file__).parent
PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
LOG = PADDLE.run(hl.wall(k=500), 0.1, v=0.2)
#: other ways in which an object shows itself in a notebook
DISPLAYS = ("_repr_html_", "_repr_markdown_", "_repr_mimebundle_", "_ipython_display_")
#: what a student never asks to see: it stands inside a result, or prints at a terminal
INSIDE = {"Run", "Person", "Block", "Bench", "Setting", "Traffic", "Board", "Problem", "Sequence"}


def public():
    """Every public name, those of the pages too, with what it stands for."""
    for name in hl.__all__:
        thing = getattr(hl, name)
        pages = thing.__all__ if inspect.ismodule(thing) else ()
        yield from ((f"{name}.{one}", getattr(thing, one)) for one in pages)
        if not pages:
            yield name, thing


@cache
def imported(module):
    """The names of a module, with those that it imports from the package for a type checker only."""
    known = dict(vars(module))
    for node in ast.walk(ast.parse(inspect.getsource(module))):
        if isinstance(node, ast.ImportFrom):
            path = importlib.util.resolve_name("." * node.level + (node.module or ""), module.__package__)
            found = vars(importlib.import_module(path)) if path.startswith("hapticlab.") else {}
            known |= {alias.asname or alias.name: found[alias.name] for alias in node.names if alias.name in found}
    return known


def returned(function):
    """The classes of ours that the annotation of a function names."""
    function = inspect.unwrap(function)
    annotation = inspect.get_annotations(function).get("return", "")
    words = {annotation.__name__} if isinstance(annotation, type) else set(re.findall(r"[A-Za-z_]\w*", str(annotation)))
    known = imported(sys.modules[function.__module__])
    return {known[word] for word in words if isinstance(known.get(word), type) and known[word].__module__.startswith("hapticlab")}


def methods(owner):
    """The public methods and properties of a class of ours."""
    for base in owner.__mro__:
        for name, member in vars(base).items() if base.__module__.startswith("hapticlab") else ():
            member = member.fget if isinstance(member, property) else member
            member = member.func if isinstance(member, cached_property) else getattr(member, "__func__", member)
            if inspect.isfunction(member) and not name.startswith("_"):
                yield member


def reached():
    """Every class that a public call, or a method of what it returns, gives."""
    found, waiting = set(), {thing if isinstance(thing, type) else type(thing) for _, thing in public()}
    for _, thing in public():
        waiting |= returned(thing) if inspect.isfunction(thing) else set()
    while waiting := {one for one in waiting - found if one.__module__.startswith("hapticlab")}:
        found |= waiting
        waiting = {one for owner in waiting for method in methods(owner) for one in returned(method)}
    return found


def lacks(kind):
    """What a class does not do of what a notebook needs; nothing where it does all."""
    if issubclass(kind, (sp.Basic, Exception)) or kind.__name__ in INSIDE or isinstance(kind, sp.core.function.FunctionClass):
        return ""
    if issubclass(kind, ShowsItself):
        own = kind.__repr__.__module__ == "hapticlab.base.shows_itself" or "__repr__" in vars(kind)
        arrays = [f.name for f in fields(kind) if f.repr and re.match(r"(ND)?Array", str(f.type))] if is_dataclass(kind) else []
        written = not Path(kind.__repr__.__code__.co_filename).is_relative_to(PACKAGE)  # by dataclass
        return f"repr dumps {', '.join(arrays)}" if arrays and written else "" if own else "no repr in one line"
    return "" if any(hasattr(kind, name) for name in DISPLAYS) else "no display"


def test_every_class_that_a_public_call_returns_shows_itself():
    kinds = reached()
    assert len(kinds) > 120
    assert {f"{kind.__module__}.{kind.__name__}": said for kind in kinds if (said := lacks(kind))} == {}


def test_every_public_name_and_every_method_that_it_leads_to_is_described():
    assert [name for name, thing in public() if not inspect.getdoc(thing)] == []
    known = [(kind, method.__name__) for kind in reached() for method in methods(kind)]
    assert len(known) > 300
    assert [f"{kind.__name__}.{name}" for kind, name in known if not inspect.getdoc(getattr(kind, name))] == []


def test_a_new_result_without_a_display_is_found():
    @dataclass
    class Plain:
        K: float

    @dataclass
    class Dumped(ShowsItself):
        K: "Array"  # noqa: F821

    assert lacks(Plain) == "no display" and lacks(Dumped) == "repr dumps K"


SHOWN = {
    "scene": lambda: hl.wall(k=300),
    "program": lambda: hl.compile(hl.library.mass_spring_damper(), T=1e-3),
    "paddle": lambda: PADDLE,
    "record": lambda: LOG,
    "energy": lambda: hl.energy(LOG),
    "chatter": lambda: hl.chatter(LOG),
    "staircase": lambda: hl.records.staircase(LOG),
    "limit": lambda: hl.stability_limit(PADDLE),
    "bounds": lambda: hl.bounds.table(PADDLE),
    "methods": lambda: hl.methods.table(),
    "method": lambda: hl.methods.RK4,
    "hold": lambda: hl.methods.SecondOrderHold,
    "law": lambda: hl.laws.EllisSpring,
    "hand": lambda: hl.Hand("grip", push=1),
    "sweep": lambda: hl.sweep(hl.wall(k=300), PADDLE, k=[100, 300], v=0.1, duration=0.2),
    "port": lambda: hl.passivity.port(PADDLE, hl.wall(k=200)),
    "step limit": lambda: hl.stability.step_limit(hl.library.mass_spring_damper(), method="rk4", T=1e-3),
    "margin": lambda: hl.passivity.margin(PADDLE, hl.laws.LinearLaw.of("zoh", K=100, T=1e-3)),
    "profile": lambda: hl.library.nominal,
    "library": lambda: hl.library.catalogue,
    "search": lambda: hl.measure.Search(first="1 kN/m"),
    "reach": lambda: hl.people.MinimumJerk(end=0.02, duration=0.4),
    "equations": lambda: hl.library.stick_slip().models[0],
    "explicit": lambda: hl.library.mass_spring_damper().explicit(),
    "velocity": lambda: hl.velocity.filtered(tau="4 ms"),
    "requires": lambda: hl.mechanics.requires(hl.library.mass_spring_damper()),
    "shape": lambda: hl.shapes.Circle("5 mm").at(name="ball"),
    "contact": lambda: hl.contact.penalty(k="1 kN/m"),
}


class House(HTMLParser):
    """What may not stand in a result: scripts, names, and what a page would load; style sheets only within a figure."""

    def __init__(self, html):
        super().__init__()
        self.tags, self.faults, self.words = [], [], []
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.faults += [tag] * (tag in ("script", "link", "iframe"))
        self.faults += [name for name, _ in attrs if name in ("id", "name") or name.startswith("on")]
        self.faults += [value for name, value in attrs if name == "src" and not value.startswith("data:image/png")]

    def handle_data(self, data):
        self.words.append(data)


def html_of(result):
    return result._repr_markdown_() if result._repr_html_ is None else result._repr_html_()


@pytest.mark.parametrize("name", SHOWN)
def test_a_result_shows_its_sentence_its_facts_and_all_its_words(name, monkeypatch):
    result = SHOWN[name]()
    monkeypatch.setattr(type(result), "_figure", lambda self: None)
    assert "\n" not in repr(result) and len(repr(result)) < 240
    house = House(html_of(result))
    assert house.faults == [] and house.tags.count("strong") == 1 and "style" not in house.tags
    assert "table" in house.tags or name in ("equations", "explicit", "shape")
    sentence = next(words for words in house.words if words.strip())
    assert sentence[1:] == result._sentence()[1:]
    text = DisplayFormatter().format(result)[0]["text/plain"]
    assert text == str(result) or (name == "program" and text == result._text())


def test_a_long_listing_is_kept_once_in_a_notebook():
    program = hl.compile(hl.library.ball_on_the_paddle(), T=1e-3)
    text, listing = DisplayFormatter().format(program)[0]["text/plain"].split("\n"), str(program).split("\n")
    assert len(listing) > 500 and text[:60] == listing[:60]
    assert text[60:] == [f"... and {len(listing) - 60} more lines: print(program) shows all"]
    assert all(escape(line) in program._repr_html_().split("Listing</summary>")[1] for line in listing[-20:])


def test_a_repr_that_a_base_writes_by_hand_stays():
    class Marked(type(LOG)):
        def __str__(self):
            return repr(self)

    @dataclass
    class Named(ShowsItself):
        K: float

        def __str__(self):
            return f"K = {self.K:g}"

    class Stiff(Named):
        def __str__(self):
            return "stiff"

    marked = Marked(t=[0], x=[0], v=[0], F=[0], T=1e-3)
    assert str(marked) == repr(marked) == "Telemetry(1 sample, 0.001 s at T = 0.001 s: t, x, v, F)"
    assert marked._sentence() == "1 sample, 0.001 s at T = 1 ms"
    assert (repr(Named(2.0)), repr(Stiff(2.0))) == ("Named(K = 2)", "Stiff(stiff)")


def test_one_run_over_one_value_is_no_plural():
    swept = hl.sweep(hl.wall(), PADDLE, metric="energy", k=[100.0], v=0.1, duration=0.05, progress=False)
    assert swept._sentence() == "energy over k (1 value): 1 run of 0.05 s"


def test_a_name_of_several_lines_stays_within_its_html():
    scene = hl.Scene(force=hl.parameters("k", units="N/m", values=300) * hl.x(hl.n), name="one\n\ntwo")
    head = scene._repr_markdown_().split("$$")[0]
    assert "one two" in head and head.count("\n\n") == 1


def test_no_title_folds_a_single_line():
    """A staircase has nine numbers, one more than stand open."""
    html = hl.people.UpDown(first=0.4)._repr_html_()
    assert "More facts" not in html and "<code>done</code>" in html


def test_a_list_of_results_has_a_line_for_each():
    text = DisplayFormatter().format([hl.stability_limit(PADDLE), LOG])[0]["text/plain"]
    assert text.startswith("[Limit(K=200.066689 N/m, ") and text.count("\n") == 1 and "Telemetry(100 samples" in text


@pytest.mark.wide
@pytest.mark.parametrize("name", ["record", "energy", "chatter", "staircase", "limit", "bounds", "sweep", "margin"])
def test_a_figure_comes_with_its_words(name):
    html = SHOWN[name]()._repr_html_()
    assert re.search(r'<img [^>]*src="data:image/png;base64,[^"]{500,}"', html) and re.search(r'<img [^>]*alt="[^"]{10,}"', html)
    assert House(html).faults == []


def test_nothing_is_drawn_where_no_notebook_asks(monkeypatch):
    monkeypatch.setattr("hapticlab.base.drawing.new_figure", lambda **_: pytest.fail("drawn"))
    for result in (LOG, hl.energy(LOG), hl.stability_limit(PADDLE)):
        assert str(result) and repr(result)


def test_a_figure_that_cannot_be_drawn_is_a_sentence():
    rests = PADDLE.run(hl.wall(k=0), 0.01)
    html = hl.records.staircase(rests)._repr_html_()
    assert "No figure: " in html and "<img" not in html


def test_a_figure_that_fails_hides_no_result(monkeypatch):
    monkeypatch.setattr(type(LOG), "_figure", lambda self: np.linspace(0, 1, -1))
    html = LOG._repr_html_()
    assert re.search(r"<p[^>]*>No figure: ValueError: Number of samples", html) and "100 samples of " in html and "<table" in html


def test_an_attribute_that_refuses_is_no_fact():
    @dataclass
    class Spring(ShowsItself):
        """A spring.

        Attributes
        ----------
        K, energy : float
            Stiffness [N/m] and energy [J].
        """

        K: float

        @property
        def energy(self):
            raise hl.HapticlabError("no position yet")

    assert [fact.name for fact in facts(Spring(200.0))] == ["K"] and "200 N/m" in Spring(200.0)._repr_html_()


@pytest.mark.wide
def test_names_cannot_run_as_code():
    name = "<script>alert(1)</script><img src=x onerror=alert(2)>"
    scene = hl.Scene(force=hl.v(hl.n) * hl.parameters("b", units="N*s/m"), name=name)
    record = PADDLE.run(scene(b=1), 0.01, v=0.1)
    limits = hl.passivity.margin(PADDLE, hl.laws.LinearLaw.of("zoh", K=10, T=1e-3).named(name))
    for result in (scene, record, limits, hl.compile(scene(b=1), T=1e-3), hl.energy(record)):
        house = House(html_of(result))
        assert house.faults == [] and "script" not in house.tags


def test_equations_stand_in_the_order_of_a_hand():
    k, x_o, b = hl.parameters("k x_o b", units="N/m m N*s/m")
    z, x, n = hl.coordinate("z", unit="m"), hl.x, hl.n
    shown = hl.Scene(force=k * (x(n) - x_o))._repr_latex_()
    assert r"F_e = k \left(x(n) - x_{o}\right)" in shown
    shown = hl.Scene(force=k * (2 * x(n) - 1.5 * x(n - 1) + 0.5 * x(n - 2) - x_o))._repr_latex_()
    assert r"k \left(2 x(n) - 1.5 x(n-1) + 0.5 x(n-2) - x_{o}\right)" in shown
    shown = hl.Scene(force=k * (x(hl.t) - z) + b * (hl.v(hl.t) - z.diff(hl.t)), eom=[sp.Eq(z.diff(hl.t) * b, k * (x(hl.t) - z))])
    assert r"F_e = k \left(x - z\right) + b \left(v - \dot{z}\right) \\" in shown._repr_latex_()
    assert r"b \dot{z} = k \left(x - z\right)" in shown._repr_markdown_()


def test_values_and_units_stand_below_the_equations():
    shown = hl.wall(k=300, x_o="10 mm")._repr_markdown_()
    words = " ".join(House(shown).words)
    assert "300 N/m" in words and "10 mm" in words
    unbound = " ".join(House(hl.wall()._repr_markdown_()).words)
    assert "without a value yet: k" in unbound and "no value yet" in unbound and "In N/m" in unbound


def test_a_program_says_its_cost_and_folds_its_listing():
    program = hl.compile(hl.wall(k=300), T=2e-3)
    grid = dict(program._tables())["on boards"]
    assert grid.columns["board"] == ["uno", "pico", "cortex-m4f"] and grid.columns["verdict"][0].startswith("fits")
    html = program._repr_html_()
    assert html.index("<summary>Listing</summary>") < html.index("tick:") and "Instruction(" not in html


def test_a_long_table_is_cut_with_a_sentence():
    @dataclass(frozen=True)
    class Row:
        """A row.

        Attributes
        ----------
        K : float
            Stiffness [N/m].
        """

        K: float

    @dataclass(frozen=True)
    class Many(Tabular):
        """Many rows."""

        rows: tuple

        def __str__(self):
            return f"{len(self.rows)} rows"

    many = Many(tuple(Row(float(K)) for K in range(ROWS + 7)))
    html = many._repr_html_()
    assert html.count("<tr") == ROWS + 1 and "K [N/m]" in html
    assert f"The first {ROWS} of {ROWS + 7} rows; <code>.rows</code> has all." in html

    class Called(Many):
        _hidden = ("rows",)

        def _tables(self):
            yield "left out", Grid.of(self.rows)
            yield "right out", Grid.of(self.rows)

    html = Called(many.rows)._repr_html_()
    assert f"The first {ROWS} of {ROWS + 7} rows; <code>.to_pandas()</code> has all.</p><p" in html
    assert html.count(f"The first {ROWS} of {ROWS + 7} rows.</p>") == 1 and "out</code>" not in html


def test_units_come_from_the_docstring():
    class Handle:
        """A handle.

        Attributes
        ----------
        m, b : float
            Mass [kg] and damping [N s/m] of the handle.
        t, x : array, shape (N,)
            [s], [m]
        reached : bool
            Whether it is there: at the wall.
        T, delay : float
            Sampling period and computational delay [s].
        v_in, v_out : float
            Speeds at those samples [m/s]; exact where known.
        kept, dropped : int
            ``dropped`` is left out; ``other`` words.
        corner, K : array
            The corners [m], [N/m].
        """

    assert documented(Handle) == {
        "m": ("kg", "Mass"), "b": ("N s/m", "Damping"), "t": ("s", ""), "x": ("m", ""), "reached": ("", "Whether it is there"),
        "T": ("s", "Sampling period"), "delay": ("s", "Computational delay"),
        "v_in": ("m/s", "Speeds at those samples"), "v_out": ("m/s", "Speeds at those samples"),
        "kept": ("", ""), "dropped": ("", "Is left out"), "corner": ("m", "The corners"), "K": ("N/m", "The corners"),
    }  # fmt: skip
    known = {fact.name: fact for fact in facts(hl.stability_limit(PADDLE))}
    assert known["K"].unit == "N/m" and known["frequency"].unit == "Hz"


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        (0.0123, "m", ("12.3", "mm")), (2e-6, "s", ("2", "µs")), (0.25, "J", ("250", "mJ")), (300.0, "N/m", ("300", "N/m")),
        (float("nan"), "m", ("not known", "")), (True, "", ("yes", "")), (None, "m", ("", "")), (3, "", ("3", "")),
        ((0.01, 0.02), "m", ("10, 20", "mm")), (0.5, "N*s/m", ("0.5", "N s/m")), ({"k": 100.0}, "", ("k: 100", "")),
        (np.array([0.0, np.nan, 2e-3]), "m", ("3 values (1 not known), 0 to 2", "mm")), (np.array([]), "m", ("none", "")),
        (np.array([True, False]), "", ("1 of 2", "")),
        (np.array([0.0, np.nan, np.nan]), "N", ("3 values (2 not known), 0 to 0", "N")),
        (np.full(3, np.nan), "N", ("3 values, not known anywhere", "")),
        (np.array([np.inf, 1.0]), "", ("2 values (1 infinite), 1 to 1", "")),
        ([float("nan")] + [1.0] * 7, "N", ("8 values (1 not known), 1 to 1", "N")),
        ([float("nan"), 2.0], "N", ("not known, 2", "N")),
        ([float("nan")] * 8, "N", ("8 values, not known anywhere", "")), (np.array([0.25]), "m", ("1 value, 250 to 250", "mm")),
        (9999.6, "N/m", ("10000", "N/m")), (-0.0, "N", ("0", "N")), (-4e6, "1/m", ("-4000000", "1/m")),
    ],
)  # fmt: skip
def test_a_value_in_words(value, unit, words):
    assert in_words(value, unit) == words


@pytest.mark.wide  # both take seconds to import
class TestPandasAndXarray:
    def test_a_record(self):
        table = LOG.to_pandas()
        assert table.index.name == "t" and np.array_equal(table["F"], LOG.F) and np.array_equal(table.index, LOG.t)
        assert table.attrs["units"] == {"t": "s", "x": "m", "v": "m/s", "F": "N"} and table.attrs["parameters"]["k"] == 500
        data = LOG.to_xarray()
        assert data["x"].attrs["units"] == "m" and data["t"].attrs["units"] == "s" and data.attrs["T"] == 1e-3
        assert np.array_equal(data["F"].sel(t=0.01, method="nearest"), LOG.F[10])

    def test_a_record_keeps_its_fault_its_flags_and_what_was_changed(self):
        import xarray

        told = {"delay": 2e-4, "every": 3, "fault": "tick 50: F was nan", "changes": ((0.05, {"k": 300.0}),)}
        log = replace(LOG, **told, gap=np.arange(100) == 7)
        table = log.to_pandas()
        assert {name: table.attrs[name] for name in told} == told
        data = xarray.load_dataset(bytes(log.to_xarray().to_netcdf()))
        assert data.attrs["parameter k"] == 500 and (data.attrs["every"], data.attrs["delay"]) == (3, 2e-4)
        assert data.attrs["fault"] == told["fault"] and json.loads(data.attrs["changes"]) == [[0.05, {"k": 300.0}]]
        for made in (table, data):
            assert np.flatnonzero(made["gap"]) == [7] and not made["saturated"].any() and not made["overrun"].any()
        assert LOG.to_xarray().attrs["fault"] == ""

    def test_a_sweep(self):
        found = hl.sweep(hl.wall(), PADDLE, metric="energy", k=[100, 200, 300], b=[0.1, 0.2], v=0.1, duration=0.05)
        table, data = found.to_pandas(), found.to_xarray()
        assert list(table.columns) == ["k", "b", "energy"] and table.attrs["units"]["energy"] == "J"
        one = table[(table["k"] == 200) & (table["b"] == 0.2)]
        assert one["energy"].item() == found.values[1, 1] == data["energy"].sel(k=200, b=0.2).item()
        assert data["k"].attrs["units"] == "N/m" and data["energy"].attrs["units"] == "J"

    def test_a_wall_map(self):
        found = hl.stability.wall_map(PADDLE, K=[100.0, 300.0], B=[0.0, 0.1], duration=0.2)
        data = found.to_xarray()
        assert data["regions"].sel(K=300.0, B=0.1) == found.regions[1, 1] and data["amplitude"].attrs["units"] == "m"
        flags = data["regions"].attrs
        named = dict(zip(flags["flag_values"], flags["flag_meanings"].split(), strict=True))
        assert named == dict(enumerate(["passive", "stable", "chatters", "unusable"]))

    def test_nothing_found_is_an_empty_table(self):
        @dataclass
        class Nothing(Tabular):
            """Nothing."""

            rows: tuple = ()

        assert Nothing().to_pandas().empty

    def test_tables(self):
        assert hl.bounds.table(PADDLE).to_pandas().set_index("bound").loc["Gil", "K"] == pytest.approx(200)
        assert hl.methods.table().to_pandas()["order"].tolist()[:2] == [1, 1]
        bounces = hl.records.staircase(LOG).to_pandas()
        assert bounces["depth"].item() == hl.records.staircase(LOG).bounces[0].depth and bounces.attrs["units"]["depth"] == "m"


def test_whole_numbers_stand_in_the_unit_of_the_head():
    grid = Grid({"x": [0, 0.002], "K": [100, 20000], "bounces": [3, 4]}, {"x": "m", "K": "N/m"})
    assert grid.heads == ["x [mm]", "K [N/m]", "bounces"]
    assert list(grid.rows()) == [["0", "100", "3"], ["2", "20000", "4"]]


def test_parameters_and_limits_have_their_units():
    words = House(replace(LOG, changes=((0.05, {"k": 300.0}),))._repr_html_()).words
    assert any("B = 0 N s/m; k = 500 N/m; x_o = 0 m" in said for said in words)
    assert any("after 50 ms: k = 300 N/m" in said for said in words)
    meanings = {fact.name: fact.meaning for fact in SHOWN["program"]()._facts()}
    assert meanings["K"] == "Steps are stable up to 799110 N/m" and meanings["m"].endswith("e-05 kg")


def test_columns_share_a_unit_and_keep_texts():
    grid = Grid({"law": ["zoh", "ellis"], "lag": [5e-4, 2e-3], "fits": [True, False]}, {"lag": "s"})
    assert grid.heads == ["law", "lag [ms]", "fits"]
    assert list(grid.rows()) == [["zoh", "0.5", "yes"], ["ellis", "2", "no"]]


@pytest.mark.parametrize("name", ["pandas", "xarray"])
def test_a_missing_package_is_named_with_its_cure(name, monkeypatch):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(hl.HapticlabError, match=rf"to_{name}\(\) needs {name}, which is not installed\. .*pip install {name}"):
        getattr(LOG, f"to_{name}")()
