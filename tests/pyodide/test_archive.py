"""The archive holds what its lock file lists, all that hapticlab needs, and no test reaches beyond it."""

import hashlib
import json
from importlib.metadata import requires

import pyodide_archive
import pytest
from packaging.utils import canonicalize_name
from pyodide_archive import CORE, LOCK, NAMED, NoPyodideError, archive, needed


@pytest.fixture
def fresh():
    """Nothing is remembered before or after."""
    archive.cache_clear()
    yield
    archive.cache_clear()


@pytest.mark.wide
def test_a_folder_that_is_named_is_used_as_it_is(fresh, monkeypatch):
    made = archive()
    archive.cache_clear()
    monkeypatch.setattr(pyodide_archive, "_make", None)
    monkeypatch.setenv(NAMED, str(made))
    assert archive() == made


@pytest.mark.wide
def test_the_archive_holds_what_its_lock_file_lists_and_what_hapticlab_needs():
    folder = archive()
    packages = json.loads((folder / LOCK).read_text("utf-8"))["packages"]
    assert {e["file_name"] for e in packages.values()} == {path.name for path in folder.iterdir()} - {LOCK, *CORE}
    for entry in packages.values():
        assert hashlib.sha256((folder / entry["file_name"]).read_bytes()).hexdigest() == entry["sha256"]
        assert {canonicalize_name(name) for name in entry["depends"]} <= set(packages)
    asked = needed(requires("hapticlab"))
    assert "numpy" in {need.name for need in asked} and "llvmlite" not in {need.name for need in asked}
    assert all(need.specifier.contains(packages[canonicalize_name(need.name)]["version"]) for need in asked)


def test_a_folder_that_is_no_pyodide_is_named(fresh, tmp_path, monkeypatch):
    monkeypatch.setenv(NAMED, str(tmp_path))
    with pytest.raises(NoPyodideError, match=f"{NAMED} is .*, which has no {LOCK}, pyodide.mjs.* Give a folder of Pyodide"):
        archive()
    for name in CORE:
        (tmp_path / name).touch()
    (tmp_path / LOCK).write_text('{"packages": {"numpy": {}}}')
    with pytest.raises(NoPyodideError, match=f"whose {LOCK} does not list anywidget, .* scipy, .*. Add these packages"):
        archive()


def test_without_a_network_one_sentence_says_what_to_do(fresh, tmp_path, monkeypatch):
    monkeypatch.delenv(NAMED, raising=False)
    monkeypatch.setattr(pyodide_archive, "cache_folder", lambda: tmp_path)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(NoPyodideError, match=f"cannot be fetched from npm. Connect to npm and PyPI, or name .* in {NAMED}"):
        archive()
    assert list(tmp_path.iterdir()) == []


def test_another_file_than_the_pinned_one_is_refused():
    with pytest.raises(NoPyodideError, match="a.whl has the sha256 .*; Pyodide's lock file requires 0000"):
        pyodide_archive._check("a.whl", b"something else", "0000")
