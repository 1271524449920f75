"""hl.check: what it says of right, wrong, missing and hostile answers; it never raises, and a wrong one earns nothing."""

import builtins
import math
import sys

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, x
from hapticlab.course.check import checked
from hapticlab.course.exercise import Case, Exercise, Lab
from hapticlab.course.marks import marks

CASES = (
    Case({"x": 0.012, "v": -0.1, "k": 200.0}, 2.4, unit="N", slips={2.0: "Here the wall begins at x_o."}),
    Case({"x": -0.01, "v": 0.0, "k": 200.0}, -2.0, unit="N"),
)
FORCE = Exercise("force", points=2, asks="the force [N] at x [m]", cases=CASES, hint="Eq. (23.1)")
FOUR = Case({"x": [0.0, 0.01, 0.02, 0.04]}, [0.0, 2.0, 4.0, 8.0], unit="N")
TABLE = Exercise("table", points=1, asks="forces [N]", cases=[FOUR])
WALL = Exercise(
    "wall", kind="scene", points=3, asks="a wall",
    cases=[Case({"x": [0, 0.005, 0.012], "values": {"k": 150.0, "x_o": 0.01}}, [0, 0, 0.3], unit="N")],
)  # fmt: skip
LAB = Lab("98", "Tests", 1, (FORCE, TABLE, WALL))


def right(x, v, k):
    return k * x


def look(exercise, answer):
    result = checked(f"98.{exercise.name}", exercise, answer)
    earned = sum(m.earned for m in marks(LAB, {exercise.name: answer}))
    assert earned == (exercise.points if result.passed else 0)
    return result


def test_a_right_answer_passes_and_earns():
    result = look(FORCE, right)
    assert result.passed and result.answered
    assert result.text == (
        "98.force: right in the public cases (worth 2 points)\n"
        "  right: 2.4 N (x = 0.012, v = -0.1, k = 200)\n"
        "  right: -2 N (x = -0.01, v = 0, k = 200)"
    )  # fmt: skip
    result.require()


def test_a_wrong_answer_names_the_case_the_slip_and_the_hint():
    result = look(FORCE, lambda x, v, k: 2.0)
    assert result.text == (
        "98.force: not right yet (worth 2 points)\n"
        "  wrong: 2 N, expected 2.4 N (x = 0.012, v = -0.1, k = 200)\n"
        "  likely slip: Here the wall begins at x_o.\n"
        "  hint: Eq. (23.1)\n"
        "  also wrong: 2 N, expected -2 N (x = -0.01, v = 0, k = 200)"
    )  # fmt: skip
    with pytest.raises(AssertionError, match="not right yet"):
        result.require()


@pytest.mark.parametrize("open_answer", [None, ..., "", "  "])
def test_what_is_not_answered_is_told_so(open_answer):
    for exercise in (FORCE, TABLE, WALL):
        assert look(exercise, open_answer).text == f"98.{exercise.name}: not answered yet: {exercise.asks}"


def test_a_body_that_is_still_missing_is_not_answered():
    def force(x, v, k):
        raise NotImplementedError

    assert not look(FORCE, force).answered
    assert not look(WALL, lambda: None).answered


def test_one_case_of_two_answered_is_not_right():
    def half(x, v, k):
        if x < 0:
            raise NotImplementedError
        return k * x

    assert [v.right for v in look(FORCE, half).verdicts] == [True, False]


class Hostile:
    """Raises whatever is asked of it."""

    def __getattribute__(self, name):
        raise SystemExit(f"no {name}")


class LikesEverything(float):
    """A number that claims to be near every other."""

    def __sub__(self, other):
        return 0.0

    __rsub__ = __sub__

    def __float__(self):
        return 99.0

    def __eq__(self, other):
        return True

    __hash__ = float.__hash__


class Array(np.ndarray):
    def __array_ufunc__(self, *_, **__):
        return np.array(0.0)


def exits(x, v, k):
    sys.exit(0)


def loops(x, v, k):
    return loops(x, v, k)


def closes(x, v, k):
    sys.stdout.close()
    return 0


def floods(x, v, k):
    for line in range(1000):
        print("line", line)
    return 0


def changes(x, v, k):
    builtins_print, builtins.print = builtins.print, None
    builtins.print = builtins_print
    raise ValueError("  two\nlines " + 1000 * "!")


def itself():
    nested = []
    nested.append(nested)
    return nested


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (lambda x, v, k: math.nan, "likely slip: NaN (not a number) or infinity comes from 0/0"),
        (lambda x, v, k: math.inf, "inf N, expected"),
        (
            lambda position, v, k: 200 * position,
            "it takes (position, v, k), but is called with x=, v=, k=; keep the argument names of the notebook",
        ),
        (lambda: 2.4, "it takes (), but is called with x=,"),
        (lambda x, v, k, b: 2.4, "it takes (x, v, k, b)"),
        (lambda x, v, k: None, "it returns None; is its `return` missing?"),
        (lambda x, v, k: "2.4 N", "a text, needs one number, without quotes and unit"),
        (lambda x, v, k: True, "True or False, needs one number"),
        (lambda x, v, k: [], "0 numbers, needs one number"),
        (lambda x, v, k: 100 * k * x, "100 times too large: is it in percent"),
        (lambda x, v, k: np.full((2, 3), 2.4), "an array of shape (2, 3), needs one number"),
        (lambda x, v, k: [[1], [2, 3]], "its parts are not all numbers,"),
        (lambda x, v, k: np.array(["a"]), "needs an array of real numbers"),
        (lambda x, v, k: 2.4 + 1j, "2.4+1j is a complex number"),
        (lambda x, v, k: 10**400, "is not a number;"),
        (lambda x, v, k: {"F": 2.4}, "a dict, needs one number"),
        (lambda x, v, k: iter([2.4]), "a list_iterator is not a number;"),
        (lambda x, v, k: (yield 2.4), "a generator is not a number;"),
        (lambda x, v, k: sp.Symbol("k") * x, "it still contains k: substitute numbers"),
        (lambda x, v, k: np.zeros(2_000_000), "more than 1000000"),
        (lambda x, v, k: itself(), ""),
        (lambda x, v, k: LikesEverything(1.0), "99 N, expected"),
        (lambda x, v, k: np.array(1.0).view(Array), "1 N, expected"),
        (lambda x, v, k: Hostile(), "it raises SystemExit"),
        (lambda x, v, k: 1 / 0, "it raises ZeroDivisionError: division by zero"),
        (lambda x, v, k: -k * x, "The sign is wrong."),
        (lambda x, v, k: 1e3 * k * x, "1000 times too large"),
        (lambda x, v, k: 1.002 * k * x, "within one percent"),
        (exits, "it raises SystemExit: 0"),
        (loops, "it raises RecursionError"),
        (closes, "0 N, expected"),
        (floods, "0 N, expected"),
        (changes, "it raises ValueError: two lines !!!"),
        (2.4, "it is a float, needs a function of (x, v, k)"),
        (Hostile, "it takes (), but is called with x=,"),
        (max, "it raises TypeError"),
    ],
)
def test_no_answer_breaks_a_check_or_earns_what_it_should_not(answer, words):
    result = look(FORCE, answer)
    assert result.answered and not result.passed
    assert words in result.text
    assert max(map(len, result.text.splitlines())) < 500


def test_an_object_that_refuses_every_question_is_refused():
    for exercise in (FORCE, TABLE, WALL, Exercise("p", "prediction"), Exercise("k", "value", 1, cases=[Case({}, 1.0)])):
        result = checked("98.x", exercise, Hostile())
        assert not result.passed and "it raises SystemExit: no __" in result.text


def test_the_line_of_a_cell_is_named_where_it_raises():
    names = {"__name__": "__main__"}
    exec("def force(x, v, k):\n    y = 0\n    return 1 / y", names)
    assert "it raises ZeroDivisionError in line 3 of its cell: division by zero" in look(FORCE, names["force"]).text


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("97.force", "97.force: there is no lab 97; there are 00_"),
        ("00.force", "00.force: lab 00 has no exercise force; it has "),
        ("force", 'force: needs lab and exercise first, such as hl.check("01.wall_force", wall_force)'),
        (right, "hl.check: needs lab and exercise first"),
        (None, "hl.check: needs lab and exercise first"),
        ("../01.x", "../01.x: needs lab and exercise first"),
        (".q", ".q: needs lab and exercise first"),
        ("00.", "00.: needs lab and exercise first"),
        (" 97.force", "there is no lab 97; there are 00_"),
    ],
)
def test_a_misspelt_check_is_told_and_raises_nothing(name, words, capsys):
    result = hl.check(name, 1.0)
    assert not result.passed
    assert words in capsys.readouterr().out


def test_a_check_prints_what_the_code_printed_its_first_lines_and_the_verdict(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(make(tmp_path, "LAB = Lab('98', '', 1, [Exercise('force', points=2, cases=[Case({'x': 1}, 2.0)])])"))

    def force(x):
        for line in range(12):
            print("line", line)
        return 2 * x

    result = hl.check("98.force", force)
    out = capsys.readouterr().out.splitlines()
    assert out[:3] == ["98.force: right in the public cases (worth 2 points)", "  right: 2 (x = 1)", "  printed: line 0"]
    assert out[-1] == "  printed: 2 lines more"
    assert result._ipython_display_() is None
    assert str(result).splitlines() == out


def test_a_mistake_of_an_author_is_told_as_such(capsys, tmp_path, monkeypatch):
    case = "Case({}, 2.0, slips={'two': 'A word is not a number.'})"
    monkeypatch.chdir(make(tmp_path, f"LAB = Lab('98', '', 1, [Exercise('k', 'value', 1, cases=[{case}])])"))
    assert not hl.check("98.k", 3.0).passed
    assert "98.k: the check itself failed, which is not your mistake: ValueError" in capsys.readouterr().out
    (tmp_path / "98_tests" / "checks.py").write_text("LAB =")
    assert not hl.check("98.k", 3.0).passed
    assert "checks.py failed: SyntaxError" in capsys.readouterr().out


def make(tmp_path, lab):
    folder = tmp_path / "98_tests"
    folder.mkdir()
    (folder / "checks.py").write_text(f"from hapticlab.course.exercise import Case, Exercise, Lab\n{lab}\n")
    return folder


def test_a_person_who_interrupts_is_obeyed():
    def interrupted(x, v, k):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        checked("98.force", FORCE, interrupted)


def test_an_answer_cannot_change_what_it_is_given():
    def spoils(x):
        x *= 0
        return [0.0, 2.0, 4.0, 8.0]

    assert look(TABLE, spoils).passed
    assert TABLE.cases[0].given["x"] == [0.0, 0.01, 0.02, 0.04]
    assert look(TABLE, lambda x: 200 * x).passed  # lists come as arrays


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (lambda x: 200 * x[:-1], "3 numbers, needs 4 numbers"),
        (lambda x: 100 * x, "3 of 4 numbers differ, first [1]: 1 N, expected 2 N"),
        (lambda x: 200 * np.append(0.0, x[:-1]), "It is one sample late."),
        (lambda x: 200 * np.append(x[1:], 0.0), "It is one sample early."),
    ],
)
def test_arrays_are_compared_number_by_number(answer, words):
    assert words in look(TABLE, answer).text


def scene(force=None, **given):
    k, x_o = hl.parameters("k x_o", units="N/m m")
    return hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)) if force is None else force(k, x_o), **given)


def test_scenes_are_compared_by_what_they_do():
    assert look(WALL, hl.wall()).passed
    assert look(WALL, scene).passed  # a function that makes it
    assert look(WALL, scene()).passed
    k, x_o = hl.parameters("k x_o", units="N/m m")
    assert look(WALL, hl.Scene(force=k * sp.Max(x(n) - x_o, 0))).passed  # another way to write it


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (lambda: scene(lambda k, x_o: hl.when(x(n) >= x_o, -k * (x(n) - x_o))), "The sign is wrong."),
        (lambda: scene(lambda k, x_o: k * (x(n) - x_o)), "2 of 3 numbers differ"),
        (lambda: hl.Scene(force=hl.parameters("k", units="N/m") * x(n)), "the scene has no parameter x_o"),
        (lambda: scene(lambda k, x_o: k * sp.sqrt(x(n) - x_o)), "in m^(1/2)*kg*s^-2 but (force, in N) is in N"),
        (lambda: scene(lambda k, x_o: k * x_o * sp.sqrt(x(n) / x_o - 1)), "NaN (not a number) or infinity comes from 0/0,"),
        (3.0, "needs a Scene"),
        (lambda: 1 / 0, "ZeroDivisionError"),
    ],
)
def test_wrong_scenes_are_told_why(answer, words):
    result = look(WALL, answer)
    assert not result.passed and result.answered
    assert words in result.text


def test_a_scene_with_motion_is_run_as_asked():
    z = hl.coordinate("z", unit="m")
    m, K, b = hl.parameters("m K b", units="kg N/m N*s/m", values=(0.05, 300.0, 0.5))
    F = hl.laws.virtual_coupler(z, K=K, b=b)
    body = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)], watch=[z])
    time = np.arange(20) * 1e-3
    given = {"x": list(1e-3 * np.sin(60 * time)), "v": list(0.06 * np.cos(60 * time)), "method": "exact", "channels": ["z"]}
    program = hl.compile(body, "exact", T=1e-3, dtype="float64", velocity="measured", live=())
    rows = np.array([given[c.name] for c in program.inputs]).T
    out = hl.compiler.engines.engine.load(program).run(20, rows).outputs[:, :, 0]
    names = [c.name for c in program.outputs]
    exercise = Exercise(
        "body", kind="scene", points=1, cases=[Case(given, {name: out[:, names.index(name)].tolist() for name in ("F", "z")})]
    )
    assert checked("98.body", exercise, body).passed
    still = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F / 2)], watch=[z])
    assert "F: 1" in checked("98.body", exercise, still).text
    unwatched = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)])
    assert "does not watch z" in checked("98.body", exercise, unwatched).text


def test_what_is_noted_is_never_judged():
    prediction, text = Exercise("p", "prediction", asks="a number"), Exercise("t", "text", least_words=3, asks="why")
    assert checked("98.p", prediction, 12).text == "98.p: saved; compare it with your result"
    assert checked("98.p", prediction, "more").passed
    assert not checked("98.p", prediction, Hostile()).passed
    assert checked("98.t", text, "two words").text == "98.t: 2 words; needs at least 3: why"
    assert checked("98.t", text, "these are three").passed
    assert marks(Lab("98", "", 1, (prediction, text)), {"p": 1}) == ()


def test_a_value_or_a_choice_never_tells_its_answer():
    value = Exercise("k", "value", 1, asks="k", cases=[Case({}, 151.5, unit="N/m")])
    case = Case({}, "motor", slips={"hand": "Look again."})
    choice = Exercise("w", "choice", 1, options={"hand": "A", "motor": "B"}, cases=[case])
    assert checked("98.k", value, 151.5).passed
    assert all(checked("98.w", choice, same).passed for same in (" Motor ", "(motor)", "motor)", "Motor."))
    for exercise, wrong, words in (
        (value, 3.0, "3 N/m: not yet"), (value, "B", "needs one number"), (value, -151.5, "The sign is wrong."),
        (choice, "hand", "hand: not this one\n  likely slip: Look again."), (choice, "x", "'x', needs one of 'hand', 'motor'"),
        (choice, 2, "a number, needs a text"),
    ):  # fmt: skip
        result = checked("98.x", exercise, wrong)
        assert words in result.text and not result.passed
        assert "151" not in result.text.replace("-151.5 N/m", "") and "motor:" not in result.text


def test_parts_of_a_dict_are_judged_one_by_one():
    slips = [({"F": 2.4}, "Hooke, not Coulomb."), ({"fits": True}, "It overflows.")]
    both = Exercise("b", points=1, cases=[Case({}, {"F": -2.4, "fits": False, "T": [1.0, 2.0]}, unit="N", slips=slips)])
    good = {"F": -2.4, "fits": False, "T": (1, 2)}
    assert checked("98.b", both, lambda: good | {"more": 1}).passed
    for change, words in (
        ({"F": 2.4}, "F: 2.4 N, expected -2.4 N\n  likely slip: Hooke, not Coulomb."), ({"fits": np.True_}, "It overflows."),
        ({"fits": 1}, "fits: a number, needs True or False"), ({"T": 1}, "T: one number, needs 2 numbers"),
    ):  # fmt: skip
        assert words in checked("98.b", both, lambda change=change: good | change).text
    assert "T is missing" in checked("98.b", both, lambda: {"F": 1, "fits": False}).text
    assert "needs a dict with F, fits, T" in checked("98.b", both, lambda: 1).text


def test_what_is_right_is_printed_as_the_student_gave_it_and_what_is_wrong_with_the_digits_that_tell():
    near = Exercise("f", "value", 1, cases=[Case({}, 30.5, unit="Hz")], rtol=0.02)
    assert checked("98.f", near, 30.0).text.endswith("right: 30 Hz")
    root = Exercise("g", points=1, cases=[Case({}, 1.00250313)], rtol=1e-7)
    assert "1.0025, expected 1.002503" in checked("98.g", root, lambda: 1.0025).text
    pair = Exercise("g", cases=[Case({}, [1.0, 2.0000001])], rtol=1e-9)
    assert "[1]: 2, expected 2.0000001" in checked("98.g", pair, lambda: [1, 2]).text


@pytest.mark.parametrize("one", [np.array([2.4]), np.array([[2.4]]), [2.4]])
def test_an_array_of_one_number_is_that_number_and_a_column_its_numbers(one):
    number, pair = (Exercise("f", points=1, cases=[Case({}, expected)]) for expected in (2.4, [1.0, 2.0]))
    assert checked("98.f", number, lambda: one).passed
    assert checked("98.f", pair, lambda: np.linalg.solve(np.eye(2), [[1.0], [2.0]])).passed
    assert not checked("98.f", number, lambda: -np.asarray(one)).passed
    assert not checked("98.f", pair, lambda: [[2.0], [1.0]]).passed


def test_checks_beside_count_by_the_number_in_them_whatever_the_folder_is_called(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    head = "from hapticlab.course.exercise import Exercise, Lab\n"
    (tmp_path / "checks.py").write_text(head + "LAB = Lab('02', '', 1, [Exercise('mine', 'prediction')])")
    assert hl.check("02.mine", 1).passed
    assert "lab 03 has no exercise mine" in hl.check("03.mine", 1).text
    (tmp_path / "checks.py").write_text("raise RuntimeError('of something else, not run')")
    assert "lab 02 has no exercise mine" in hl.check("02.mine", 1).text
    (tmp_path / "checks.py").write_text("LAB = exit(3)")
    assert "checks.py failed: SystemExit: 3" in hl.check("02.mine", 1).text


def test_a_guess_that_fits_any_exercise_is_silent_where_the_lab_knows_the_slip():
    twice = Case({"x": 0.02}, 4.0, slips={8.0: "Both walls act at once."})
    exercise = Exercise("walls", points=1, cases=[Case({"x": 0.01}, 2.0), twice])
    text = checked("98.walls", exercise, lambda x: 400 * x).text
    assert "Both walls act at once." in text and "It is twice" not in text
    assert (
        "It is twice" in checked("98.walls", Exercise("walls", points=1, cases=[Case({"x": 0.01}, 2.0)]), lambda x: 400 * x).text
    )
