"""What a site is made of, and the folders in which none is built; tests/browser/test_site.py has a whole one."""

import json
import shutil
import subprocess
from importlib.metadata import PackageNotFoundError
from pathlib import Path
from unittest import mock

import pytest

from hapticlab.cli.main import main
from hapticlab.course.labs import find_labs
from hapticlab.errors import CourseError, EngineMissingError
from hapticlab.site import build, lite
from hapticlab.site.build import Site, build_site
from hapticlab.site.needs import needed


def test_a_folder_that_holds_anything_else_is_refused_before_anything_is_written(tmp_path, capsys):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "notes").mkdir()
    (tmp_path / "notes" / "notes.txt").write_text("mine")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / build.RECORD).write_text("[]")
    refused = {
        "file": "is a file; name a folder",
        "notes": "holds notes.txt and is not a site of an earlier build",
        "other": f"holds {build.RECORD} and is not",
    }
    for folder, words in refused.items():
        assert main(["site", str(tmp_path / folder)]) == 1
        assert words in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["file", build.RECORD, "notes", "notes.txt", "other"]


def test_a_folder_inside_the_labs_is_refused():
    labs = find_labs()[0].path.parent
    for folder in (labs / "site", find_labs()[2].path / "new" / "site"):
        with pytest.raises(CourseError, match="is inside .*, so that the next build would copy the site into itself"):
            build.written_before(folder)
    assert build.written_before(labs.parent / "no-such-site") == set()


def test_a_folder_with_hidden_files_alone_is_taken_and_no_record_names_files_elsewhere(tmp_path):
    (tmp_path / ".git").mkdir()
    assert build.written_before(tmp_path) == set() == build.written_before(tmp_path / "new")
    (tmp_path / build.RECORD).write_text(json.dumps({"files": ["index.html", "../mine.txt", "/etc/passwd", "a/../../b"]}))
    assert build.written_before(tmp_path) == {"index.html", build.RECORD}


def test_without_jupyterlite_the_cure_is_said(tmp_path, monkeypatch):
    def missing(name):
        raise PackageNotFoundError(name)

    monkeypatch.setattr(lite, "distribution", missing)
    with pytest.raises(EngineMissingError, match=r'jupyterlite-core is not installed.*pip install "hapticlab\[site\]"; then'):
        build_site(tmp_path / "site")
    assert not (tmp_path / "site").exists()


def test_the_command_says_size_and_time_and_what_to_do_next(tmp_path, monkeypatch, capsys):
    given = {}

    def built(folder, **options):
        given.update(options)
        options["say"]("a step")
        return Site(tmp_path / folder, 600, 76_400_000, 8.2)

    monkeypatch.setattr("hapticlab.cli.site.build_site", built)
    monkeypatch.chdir(tmp_path)
    assert main(["site", "my site", "--pyodide", "pyodide.tar.bz2", "--wheel", "one.whl"]) == 0
    out = capsys.readouterr().out
    assert "  a step\n" in out and f"site in {tmp_path / 'my site'}: 600 files, 76 MB, built in 8 s" in out
    assert "http.server" in out and "http://127.0.0.1:8000" in out and "web server with https" in out
    assert {name: given[name] for name in ("pyodide", "wheel")} == {"pyodide": "pyodide.tar.bz2", "wheel": "one.whl"}


def test_the_kernel_is_told_of_every_package_and_never_asks_pypi(tmp_path):
    """Without a distribution of Pyodide: what Pyodide lacks is in the site, and everything else is asked for by name."""
    theirs, ours = needed()
    (tmp_path / "pypi").mkdir()
    made = [tmp_path / "pypi" / f"{name}-1-py3-none-any.whl" for name in ours]
    lite.prepare(tmp_path, theirs, made)
    settings = json.loads((tmp_path / "jupyter-lite.json").read_text())["jupyter-config-data"]["litePluginSettings"]
    kernel = settings["@jupyterlite/pyodide-kernel-extension:kernel"]
    assert kernel["disablePyPIFallback"] and "pyodideUrl" not in kernel
    asked = kernel["loadPyodideOptions"]["packages"]
    worker = tmp_path / "extensions" / "@jupyterlite" / "pyodide-kernel-extension" / "static"
    assert [(worker / name).resolve() for name in asked if name.endswith(".whl")] == made
    assert {"numpy", "scipy", "sympy", "matplotlib", "micropip"} <= set(asked)
    assert {"hapticlab", "pint", "pyserial", "anywidget", "ipywidgets", "comm"} <= {*asked, *ours}
    (listed,) = json.loads((tmp_path / "jupyter_lite_config.json").read_text())["LiteBuildConfig"]["contents"]
    assert files(Path(listed)).keys() == {
        "README.md", *(f"{lab.name}/{path}" for lab in find_labs() for path in (lab.notebook.name, "checks.py")),
    }  # fmt: skip


@pytest.mark.parametrize(("code", "said"), [(0, "TaskError - taskid:static"), (1, "no space left")])
def test_a_builder_that_fails_is_told_also_where_it_returns_0(tmp_path, monkeypatch, code, said):
    monkeypatch.setattr(lite.subprocess, "run", lambda command, **_: subprocess.CompletedProcess(command, code, said, ""))
    with pytest.raises(CourseError, match=f"JupyterLite's builder failed; it said:\n{said}"):
        lite.build(tmp_path, tmp_path / "made")


def files(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_site_that_is_cut_off_is_replaced_by_the_next_build(tmp_path, monkeypatch):
    made, folder = tmp_path / "made", tmp_path / "site"
    for path in (made / "b.js", folder / "old.js", folder / "mine.txt"):
        path.parent.mkdir(exist_ok=True)
        path.write_text(path.name)
    full = shutil.Error([("b.js", "b.js", "No space left on device"), ("c.js", "c.js", "No space left on device")])
    record = {"hapticlab": "1", "files": {"b.js": "digest"}}
    monkeypatch.setattr(build.shutil, "copytree", mock.Mock(side_effect=full))
    with pytest.raises(CourseError, match=f"could not be written to {folder}: No space left on device; then do") as raised:
        build._replace(folder, made, {"old.js", build.RECORD}, record)
    assert "c.js" not in str(raised.value)
    monkeypatch.undo()
    assert build.written_before(folder) == {"b.js", "old.js", build.RECORD}
    build._replace(folder, made, build.written_before(folder), record)
    assert (
        files(folder).keys() == {"b.js", "mine.txt", build.RECORD} and json.loads((folder / build.RECORD).read_text()) == record
    )
