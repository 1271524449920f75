"""The archive holds what its lock file lists, all that hapticlab needs, and no test reaches beyond it."""

import hashlib
import json
import re
from importlib.metadata import requires

import pyodide_archive
import pytest
from packaging.utils import canonicalize_name
from pyodide_archive import CORE, LOCK, NAMED, OFFICIAL, PINS, NoPyodideError, archive, needed


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


def test_a_folder_that_is_no_whole_pyodide_is_named(fresh, tmp_path, monkeypatch):
    monkeypatch.setenv(NAMED, str(tmp_path))
    with pytest.raises(NoPyodideError, match=f"no whole folder of Pyodide: {LOCK}, pyodide.mjs.* is missing .* in {NAMED}"):
        archive()
    for name in (LOCK, *CORE, "numpy.whl"):
        (tmp_path / name).write_bytes(b"given")
    with pytest.raises(NoPyodideError, match=f": {LOCK} is missing or damaged. A folder in the user's cache is made again"):
        archive()
    (tmp_path / LOCK).write_text('{"packages": {"numpy": {}}}')
    with pytest.raises(NoPyodideError, match=f"has a {LOCK} that does not list anywidget, .* scipy, .*. Add these packages"):
        archive()
    listed = [*OFFICIAL, *re.findall(r"^([\w-]+)==", PINS[2].read_text("utf-8"), re.M)]
    entry = {"file_name": "numpy.whl", "sha256": hashlib.sha256(b"given").hexdigest()}
    (tmp_path / LOCK).write_text(json.dumps({"packages": dict.fromkeys(listed, entry)}))
    assert archive() == tmp_path.resolve()
    archive.cache_clear()
    (tmp_path / "numpy.whl").write_bytes(b"giv")
    with pytest.raises(NoPyodideError, match=": numpy.whl, .* is missing or damaged"):
        archive()


def test_a_kept_folder_that_was_damaged_is_named(fresh, tmp_path, monkeypatch):
    monkeypatch.delenv(NAMED, raising=False)
    monkeypatch.setattr(pyodide_archive, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(pyodide_archive, "_make", lambda aside: (aside / "archive").mkdir() or aside / "archive")
    with pytest.raises(NoPyodideError, match=f"{tmp_path}/pyodide-.* is no whole folder of Pyodide"):
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
