"""One contract for every engine, and a sentence where it is broken or an engine is missing."""

import builtins
import subprocess
import sys
from typing import get_args

import numpy as np
import pytest

from hapticlab.base import annotations
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.table import ENGINES
from hapticlab.compiler.ir.program import Block, Channel, Program
from hapticlab.compiler.ir.trace import Builder, select
from hapticlab.errors import EngineMissingError, ProgramError

pytestmark = pytest.mark.interpreter


def filtered_wall():
    """Return a float64 wall with a first-order filter: s' = s + a (x - s), F = k s where s > 0."""
    b, real = Builder("f64"), "f64"
    x, s, k, a = b.leaf("input", 0, real), b.leaf("state", 0, real), b.leaf("param", 0, real), b.leaf("param", 1, real)
    tick = b.block([select(s > 0, k * s, 0.0)], [s + a * (x - s)])
    b = Builder("f64")
    init = b.block((), [b.leaf("input", 0, real)])
    channel = lambda name, unit="m": Channel(name, unit, real)  # noqa: E731
    return Program(
        "filtered", (channel("x"),), (channel("k", "N/m"), channel("a", "1")), (channel("s"),), (channel("F", "N"),),
        init, tick, 1e-3, (150.0, float("nan")),
    )  # fmt: skip


WASM = pytest.param("wasm", marks=pytest.mark.machine_code)
BROUGHT_BY = {"llvm": "llvmlite", "wasm": "wasmtime"}


@pytest.fixture(params=["interpreter", "llvm", WASM])
def engine(request):
    if request.param in BROUGHT_BY:
        pytest.importorskip(BROUGHT_BY[request.param])
    return load(filtered_wall(), request.param)


def test_a_run_follows_the_closed_form(engine):
    # a unit step from rest: s_n = 1 - (1 - a)^n
    x = np.r_[0.0, np.ones(49)]
    for inputs in (x, x[:, None]):
        outputs, states = engine.run(50, inputs, [150.0, 0.25])
        expected = 150 * (1 - 0.75 ** np.maximum(np.arange(50) - 1, 0))
        assert outputs.shape == (50, 1, 1) and np.allclose(outputs[:, 0, 0], expected, rtol=1e-14)
        assert np.allclose(states, 1 - 0.75**49, rtol=1e-14)


def test_lanes_are_parameter_points(engine):
    a = np.linspace(0.1, 0.9, 7)
    run = engine.run(10, np.r_[0.0, np.ones(9)], np.array([np.full(7, 20.0), a]), every=10)
    assert run.outputs.shape == (1, 1, 7) and run.states.shape == (1, 7)
    assert np.allclose(run.outputs[0, 0], 20 * (1 - (1 - a) ** 8), rtol=1e-14)


def test_what_does_not_fit_the_program_is_refused(engine):
    x = np.ones((4, 1))
    for given, complaint in (
        (dict(ticks=0, inputs=x[:0], parameters=[1, 1]), "at least one tick"),
        (dict(ticks=4, inputs=x, parameters=[1, 1], every=0), "at least one tick"),
        (dict(ticks=4, inputs=x), "no value for a; bind it"),
        (dict(ticks=4, inputs=x, parameters=[1]), r"parameters of shape \(1, 1\); needs \(2, 1\)"),
        (dict(ticks=4, inputs=x, parameters=np.ones((2, 0))), "at least one lane"),
        (dict(ticks=4, parameters=[1, 1]), r"inputs of shape \(4, 0\); needs \(4, 1\)"),
        (dict(ticks=5, inputs=x, parameters=[1, 1]), r"inputs of shape \(4, 1\); needs \(5, 1\)"),
        (
            dict(ticks=4, inputs=x, parameters=[1, 1], states=np.ones((1, 2))),
            r"states of shape \(1, 2\); needs \(1, 1\)",
        ),
    ):
        with pytest.raises(ProgramError, match=complaint):
            engine.run(**given)


@pytest.mark.parametrize(
    "given, complaint",
    [
        (dict(inputs=["a", "b"]), r"filtered: inputs = \['a', 'b'\]; needs an array of real numbers"),
        (dict(inputs=[1j, 2.0]), "inputs = .*; needs an array of real numbers"),
        (dict(inputs=[None, "1"]), "inputs = .*; needs an array of real numbers"),
        (dict(inputs=[[1.0], [1.0, 2.0]]), "inputs = .*; needs an array of real numbers"),
        (dict(parameters=["k", 1]), "parameters = .*; needs an array of real numbers"),
        (dict(states=[[1j]]), "states = .*; needs an array of real numbers"),
        (dict(ticks="2"), "ticks = '2'; needs a whole number"),
        (dict(ticks=2.0), "ticks = 2.0; needs a whole number"),
        (dict(every=1.5), "every = 1.5; needs a whole number"),
    ],
)
def test_what_is_no_number_is_refused_in_words(engine, given, complaint):
    good = dict(ticks=2, inputs=[1.0, 1.0], parameters=[1, 1])
    assert engine.run(**good, every=np.int64(2)).outputs.shape == (1, 1, 1)
    with pytest.raises(ProgramError, match=complaint):
        engine.run(**{**good, **given})


@pytest.mark.parametrize("name", ["interpreter", "llvm", WASM, "vm"])
def test_a_whole_number_must_be_an_int32_on_every_engine(name):
    b = Builder("f32")
    tick, one = b.leaf("state", 0, "i32"), b.const(1, "i32")
    next = b.emit("iadd", tick, one)
    block = b.block([b.emit("itof", tick, type="f32")], [next])
    b = Builder("f32")
    init = b.block((), [b.const(0, "i32")])
    program = Program("count", (), (), (Channel("tick", "1", "i32"),), (Channel("F"),), init, block, 1e-3)
    if name in BROUGHT_BY:
        pytest.importorskip(BROUGHT_BY[name])
    count = load(program, name)
    for most in (2**31 - 2, -(2**31)):
        assert count.run(1, states=[[most]]).states[0, 0] == most + 1
    for wrong in (2.0**31, -(2.0**31) - 1, 1.5, np.nan, np.inf):
        with pytest.raises(ProgramError, match=f"count: states hold tick = {wrong:g}; needs an int32".replace("+", r"\+")):
            count.run(1, states=[[wrong]])


def test_auto_takes_llvm_where_it_is_installed():
    pytest.importorskip("llvmlite")
    assert load(filtered_wall()).name == "llvm"


@pytest.mark.machine_code
def test_auto_takes_wasm_where_only_wasmtime_is_installed(monkeypatch):
    pytest.importorskip("wasmtime")
    monkeypatch.setitem(sys.modules, "llvmlite", None)
    assert load(filtered_wall()).name == "wasm"


def test_with_neither_auto_interprets_and_each_says_what_to_do(monkeypatch):
    for engine, package in BROUGHT_BY.items():
        monkeypatch.setitem(sys.modules, package, None)
        with pytest.raises(EngineMissingError, match=f'"{engine}" needs {package}, .*do: pip install {package}, or use engine='):
            load(filtered_wall(), engine)
    assert load(filtered_wall()).name == "interpreter"


@pytest.mark.parametrize("problem", [OSError("no library for this system"), RuntimeError("unsupported platform")])
def test_a_wasmtime_without_its_library_is_not_here(monkeypatch, problem):
    def refuse(name, *rest, whole=builtins.__import__):
        if name == "wasmtime":
            raise problem
        return whole(name, *rest)

    monkeypatch.setattr(builtins, "__import__", refuse)
    assert not ENGINES["wasm"].is_here()


def test_the_names_of_public_signatures_are_those_of_the_table():
    automatic = [name for name, record in ENGINES.items() if record.automatic]
    assert get_args(annotations.Engine) == ("auto", *ENGINES)
    assert get_args(annotations.PlantEngine) == ("auto", *(name for name, record in ENGINES.items() if record.float64))
    assert automatic == ["llvm", "wasm", "interpreter"]
    for name, record in ENGINES.items():
        assert record.kernel.name == record.name == name


def test_an_unknown_engine_is_refused():
    with pytest.raises(ProgramError, match="engine = 'fast'; needs one of auto, llvm, wasm, interpreter, vm"):
        load(filtered_wall(), "fast")


def test_a_damaged_program_is_refused_before_it_runs():
    good = filtered_wall()
    bad = Program("bad", good.inputs, good.parameters, good.states, good.outputs, Block(), good.tick, good.T, good.values)
    with pytest.raises(ProgramError, match="init: gives 0 states, needs 1"):
        load(bad)


def test_importing_the_engines_does_not_import_what_brings_them():
    code = f"import sys, hapticlab.compiler.engines.engine; sys.exit(any(p in sys.modules for p in {[*BROUGHT_BY.values()]}))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
