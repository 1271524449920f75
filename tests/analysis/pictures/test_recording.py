"""Functions recorded as data: each gives what NumPy gives, and what cannot be recorded says so."""

import json
import math

import numpy as np
import pytest
from recorded_values import value_of

import hapticlab as hl
from hapticlab.analysis.pictures.recording import WAYS, recorded
from hapticlab.analysis.pictures.touching import recorded_touching, touching

NAMES = ("a", "b", "c")


def given(seed=0):
    return dict(zip(NAMES, np.random.default_rng(seed).uniform(-2, 2, 3).tolist(), strict=True))


def line(known, count=6):
    """Numbers that depend on the inputs, shape (count,)."""
    return np.stack([known[NAMES[k % 3]] * (k + 1) for k in range(count)])


def summed_up(value, more):
    value += more
    return value


GRID, LEVELS = np.array([-3.0, -1.0, 0.5, 4.0]), np.array([1.0, 2.0, -1.0, 0.5])
FUNCTIONS = {
    "arithmetic": lambda k: (k["a"] + 2) * k["b"] - 3 / k["c"] + abs(-k["a"]) ** 1.5 + 2 ** k["b"] - k["a"] // 0.3 + k["b"] % 0.7,
    "truths": lambda k: ((k["a"] > 0) & (k["b"] <= 1) | ~(k["c"] < 0)).astype(float),
    "broadcast": lambda k: line(k).reshape(6, 1) * np.arange(4.0) - line(k, 4),
    "many": lambda k: np.cos(np.linspace(0, 1, 50) * 2) * k["a"],
    "matmul": lambda k: line(k).reshape(3, 2) @ np.array([[1.0, 2.0], [3.0, 4.0]]) @ np.stack([k["a"], 1.0]),
    "dot": lambda k: np.dot(np.arange(3.0), line(k, 3)),
    "dot of a number": lambda k: np.dot(k["a"], np.arange(3.0)) + np.dot(line(k, 3), k["b"]),
    "stack": lambda k: np.column_stack([line(k, 3), np.arange(3.0), np.full(3, k["b"])]).T[::-1],
    "concatenate": lambda k: np.concatenate([np.zeros(2), line(k)[1:], [k["c"]]]),
    "moves": lambda k: np.roll(np.flip(np.transpose(line(k).reshape(2, 3))), 1, axis=0)[..., 0],
    "picked": lambda k: line(k)[[4, 0, 0]] + line(k).reshape(2, 3)[1, ::-1],
    "objects": lambda k: np.array([k["a"], 1.0]) * [2.0, k["b"]] + line(k, 2),
    "lists": lambda k: np.stack(line(k).reshape(3, 2).tolist()[1]),
    "reductions": lambda k: np.stack([f(line(k)) for f in (np.max, np.min, np.sum, np.prod, np.mean, np.ptp)]),
    "axes": lambda k: np.max(line(k).reshape(2, 3), axis=0) + np.sum(line(k).reshape(3, 2), axis=1),
    "reduce": lambda k: np.maximum.reduce(line(k).reshape(2, 3)) + np.add.accumulate(line(k, 3)),
    "along": lambda k: np.cumsum(line(k).reshape(2, 3), axis=0) + np.cumprod(line(k)).reshape(2, 3),
    "any": lambda k: np.stack([np.any(line(k) > 3), np.all(line(k) > -99)]).astype(float),
    "interp": lambda k: np.interp(line(k), GRID, LEVELS * k["a"]),
    "linspace": lambda k: np.concatenate([np.linspace(k["a"], 3.0, 7), np.linspace(k["b"], 3.0, 1)]),
    "kinds": lambda k: line(k).astype(int) + (k["a"] * 7).astype("int32") + line(k).astype(bool) * k["b"].astype(np.float64),
    "rounded": lambda k: np.round(line(k), 1) + np.clip(line(k), -1, k["a"]),
    "where": lambda k: np.where(line(k) > 0, k["a"], np.arange(6.0)),
    "diff": lambda k: np.diff(np.square(line(k))) + np.deg2rad(k["b"]) + np.reciprocal(k["c"]),
    "shapes": lambda k: np.zeros_like(line(k)) + np.ones_like(line(k)) * np.size(line(k)) + len(line(k)),
    "constant": lambda k: np.arange(3.0) ** 2,
    "not finite": lambda k: np.stack([k["a"], np.nan, np.inf, -np.inf]),
    "ways": lambda k: k["a"] * 2 if k["a"] > k["b"] else max(k["b"], k["c"]),
    "own steps": lambda k: sum(n * k["a"] for n in range(4)),
    "summed up": lambda k: summed_up(k["a"], k["b"]),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_recorded_function_gives_what_it_gives(name):
    function = FUNCTIONS[name]
    data = recorded(function, dict.fromkeys(NAMES, 0.0))
    assert json.loads(json.dumps(data, allow_nan=False)) == data
    for seed in range(6):
        with np.errstate(all="ignore"):
            wanted = np.ravel(function({key: np.float64(value) for key, value in given(seed).items()})).astype(float)
        np.testing.assert_allclose(value_of(data, given(seed)), wanted, rtol=1e-13, atol=1e-13)


def test_what_is_the_same_is_done_once_and_what_is_not_needed_never():
    data = recorded(
        lambda k: np.cos(k["a"]) + np.stack([np.cos(k["a"]), k["b"]])[0] + 0 * len(line(k)), {"a": 1.0, "b": 2.0, "c": 3.0}
    )
    assert data["inputs"] == [["a", 1]]
    assert [node for node in data["nodes"] if isinstance(node, list)] == [["cos", 0], ["add", 1, 1], ["add", 2, 3]]


def test_a_line_of_known_numbers_is_as_short_as_what_makes_it():
    at = np.linspace(-0.058, 0.058, 401)
    data = recorded(lambda k: np.sin(2 * np.pi * at / k["a"]), {"a": 0.01})
    assert len(json.dumps(data)) < 200
    np.testing.assert_allclose(value_of(data, {"a": 0.02}), np.sin(2 * np.pi * at / 0.02), atol=1e-13)


def or_nothing(k):
    """A function whose own except would hide that it was not recorded, and draw something else."""
    try:
        return math.cos(k["a"])
    except Exception:
        return 0.0


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (
            lambda k: math.cos(k["a"]),
            r"f uses float\(\), int\(\), a function of math, .* with a value that changes. .* Use np.cos",
        ),
        (lambda k: float(k["a"]), r"f uses float\(\)"),
        (or_nothing, r"f uses float\(\)"),
        (lambda k: [1.0] * int(k["a"]), r"f uses float\(\)"),
        (lambda k: f"{k['a']:.1f}", "f uses .* a label's text"),
        (lambda k: f"{k['a']}", "f uses .* a label's text"),
        (lambda k: f"{[k['a']]}", "f uses .* a label's text"),
        (lambda k: 1.0 if k["a"] in {0.0, 1.0} else 2.0, "f uses .* a set or dict with"),
        (lambda k: np.linalg.norm(line(k)), "f uses np.norm with"),
        (lambda k: np.divmod(k["a"], 2), "f uses np.divmod with"),
        (lambda k: np.multiply.outer(line(k), np.arange(2.0)), "f uses np.multiply.outer with"),
        (lambda k: np.add(np.zeros(3), k["a"], out=np.zeros(3)), "f uses .* or out=, on an array with"),
        (lambda k: summed_up(np.zeros(6)[1:], k["a"]), "f uses .= or another change in place"),
        (lambda k: summed_up(line(k), 1.0), "f uses .= or another change in place"),
        (lambda k: k["a"].astype(str), "f uses astype.. of what is not a number with"),
        (lambda k: 1.0 if line(k) > 0 else 0.0, "f uses if or a comparison of a whole array"),
        (lambda k: np.cos(np.array([k["a"], 1.0])), r"f stops with TypeError: .* Use .* np.stack\(\[x, y\]\) instead"),
        (lambda k: sum(1 for n in range(2 * WAYS) if k["a"] * n > k["b"]), f"f goes more than {WAYS} ways .* Use np.where"),
    ],
)
def test_what_cannot_be_recorded_says_what_to_do(function, said):
    with pytest.raises(hl.errors.AnalysisError, match=said):
        recorded(function, dict.fromkeys(NAMES, 0.0), "f")


def test_as_many_ways_as_are_taken():
    data = recorded(lambda k: sum(2.0**n for n in range(6) if k["a"] > n or (n < 0 and k["b"])), {"a": 0.0, "b": 0.0})
    assert [value_of(data, {"a": a}).item() for a in (-1.0, 0.5, 5.5)] == [0.0, 1.0, 63.0]


def test_a_drawing_that_catches_every_exception_goes_both_ways():
    def cautious(known):
        try:
            return 1.0 if known["a"] > 0 else 2.0
        except Exception:
            return 3.0

    data = recorded(cautious, {"a": 0.0})
    assert [value_of(data, {"a": a}).item() for a in (1.0, -1.0)] == [1.0, 2.0]


def scenes():
    x, n = hl.x, hl.n
    k, x_o, x_l = hl.parameters("k x_o x_l", units="N/m m m", values=(300, 0.01, -0.01))
    wall = hl.when(x(n) >= x_o, k * (x(n) - x_o))
    return [
        hl.wall()(k=300, x_o=0.01),
        hl.Scene(force=wall + hl.when(x(n) <= x_l, k * (x(n) - x_l))),
        hl.library.ball_on_the_paddle(),
    ]


@pytest.mark.parametrize("scene", scenes(), ids=lambda scene: scene.name)
def test_contact_of_a_sample_is_recorded(scene):
    data, touched, random = recorded_touching(scene, scene.watch), touching(scene, scene.watch), np.random.default_rng(4)
    names = ["x", *scene.watch]
    samples = {name: random.uniform(-0.03, 0.03, 200) for name in names} | {"F": random.choice([0.0, 1.5], 200)}
    wanted = touched(samples, dict(scene.values))
    found = [value_of(data, {name: values[k] for name, values in samples.items()}).item() for k in range(200)]
    assert 0 < sum(found) < 200 and found == wanted.tolist()


def test_a_scene_without_a_boundary_has_no_contact_to_record():
    assert recorded_touching(hl.Scene(force=hl.parameters("k", units="N/m", values=1) * hl.x(hl.n))) is None
