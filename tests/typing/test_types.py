"""What a type checker is told: every public signature is annotated, students' code passes, wrong calls are refused."""

import ast
import inspect
import re
import runpy
import subprocess
import sys
from functools import cached_property
from pathlib import Path

import pytest

import hapticlab as hl

EXAMPLES, PACKAGE = Path(__file__).parent / "examples", Path(hl.__file__).parent
# a container or a callable that does not say of what
BARE = re.compile(r"\b(tuple|dict|list|set|callable|Callable|Mapping|Sequence|Iterable|Iterator)\b(?!\[)")


def public():
    """Public names and what they stand for, those of hl.library among them."""
    for module, prefix in ((hl, ""), (hl.library, "library.")):
        yield from ((prefix + name, getattr(module, name)) for name in module.__all__)


def members(thing):
    """(qualified name, function) of every signature of the package's own that this name leads to."""
    if inspect.isroutine(thing):
        yield thing.__qualname__, inspect.unwrap(thing)
    for owner in thing.__mro__ if isinstance(thing, type) else ():
        for name, member in vars(owner).items():
            if name.startswith("_") and not name.endswith("__"):
                continue
            if isinstance(member, property | cached_property):
                member = member.func if isinstance(member, cached_property) else member.fget
            function = inspect.unwrap(getattr(member, "__func__", member))
            # what dataclass writes has no file
            if inspect.isfunction(function) and Path(function.__code__.co_filename).is_relative_to(PACKAGE):
                yield f"{owner.__qualname__}.{name}", function


def untyped(thing):
    """The signatures and fields of a public name that do not say their types."""
    for name, function in members(thing):
        signature = inspect.signature(function)
        own = list(signature.parameters.values())
        given = own[1:] if "." in name and own and own[0].name in ("self", "cls") else own
        said = [*(one.annotation for one in given), signature.return_annotation]
        if any(one is inspect.Parameter.empty or BARE.search(inspect.formatannotation(one)) for one in said):
            yield name
    for owner in thing.__mro__ if isinstance(thing, type) else ():
        if owner.__module__.startswith("hapticlab"):
            fields = inspect.get_annotations(owner).items()
            yield from (f"{owner.__qualname__}.{name}" for name, one in fields if BARE.search(inspect.formatannotation(one)))


def test_every_public_signature_says_its_types():
    faults = {name: found for name, thing in public() if (found := list(untyped(thing)))}
    assert faults == {}


def test_an_untyped_signature_is_found():
    class Half:
        kept: dict

        def one(self, k: float, x_o) -> float: ...

        def two(self, k: float): ...

        def three(self, k: dict) -> None: ...

        def whole(self, k: dict[str, float]) -> None: ...

        def _own(self, k): ...

    for member in vars(Half).values():
        if inspect.isfunction(member):
            member.__code__ = member.__code__.replace(co_filename=str(PACKAGE / "half.py"))
    Half.__module__ = "hapticlab.half"
    assert [name.rpartition(".")[2] for name in untyped(Half)] == ["one", "two", "three", "kept"]


def test_the_package_says_that_it_is_typed():
    assert (PACKAGE / "py.typed").exists()


@pytest.mark.wide
@pytest.mark.long
def test_a_type_checker_passes():
    """The package, students' code, and wrong calls: warn_unused_ignores fails where one of these is no longer refused."""
    done = subprocess.run([sys.executable, "-m", "mypy"], cwd=PACKAGE.parent, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.wide
def test_readme_and_the_manual_pass(tmp_path):
    """The examples of each page, one after the other in one file."""
    pages = "how_to/scenes", "how_to/live", "how_to/measuring", "explanation/methods", "explanation/people", "paddle/boards"
    names = ("README", *(f"docs/{page}" for page in pages))
    files = [tmp_path / f"page_{Path(name).name}.py" for name in names]
    for name, file in zip(names, files, strict=True):
        examples = re.findall(r"```python\n(.*?)```", (PACKAGE.parent / f"{name}.md").read_text("utf-8"), re.S)
        assert examples, name
        file.write_text("\n".join(examples), "utf-8")
    command = [sys.executable, "-m", "mypy", "--allow-redefinition", *map(str, files)]
    done = subprocess.run(command, cwd=PACKAGE.parent, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.wide
def test_what_passes_also_runs(capsys):
    runpy.run_path(str(EXAMPLES / "student.py"))
    assert "asked for 300 N/m" in capsys.readouterr().out


def test_what_is_refused_also_fails():
    """Every statement of wrong.py that a type checker must refuse."""
    source = (EXAMPLES / "wrong.py").read_text("utf-8")
    names, lines = {}, source.splitlines()
    for statement in ast.parse(source).body:
        code = compile(ast.Module([statement], []), "wrong.py", "exec")
        if "type: ignore" not in lines[statement.end_lineno - 1]:
            exec(code, names)
            continue
        with pytest.raises((hl.HapticlabError, AttributeError, TypeError)):
            exec(code, names)
