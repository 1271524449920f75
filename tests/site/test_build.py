"""A whole site, and the folders in which none is built."""

import json
from importlib.metadata import PackageNotFoundError

import pytest
from pyodide_archive import archive

from hapticlab.cli.main import main
from hapticlab.course.labs import find_labs
from hapticlab.errors import EngineMissingError
from hapticlab.site import build, lite
from hapticlab.site.build import Site, build_site
from hapticlab.site.licences import parts, without_text
from hapticlab.site.pages import PAGES


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


def files(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.wide
def test_a_site_has_the_labs_what_they_need_and_a_licence_text_for_every_file(tmp_path, own_wheel):
    folder, said = tmp_path / "site", []
    (folder / ".git").mkdir(parents=True)
    (folder / ".git" / "HEAD").write_text("mine")
    (folder / "old.js").write_text("of an earlier build")
    (folder / "CNAME").write_text("mine")
    (folder / build.RECORD).write_text(json.dumps({"files": ["old.js", "index.html"]}))
    built = build_site(folder, pyodide=archive(), wheel=own_wheel, say=said.append)
    found = files(folder)
    assert "old.js" not in found and found["CNAME"] == found[".git/HEAD"] == b"mine"
    recorded = json.loads(found[build.RECORD])["files"]
    assert set(found) == {*recorded, build.RECORD, "CNAME", ".git/HEAD"} and built.files == len(recorded) + 1
    assert built.size == sum(len(found[name]) for name in (*recorded, build.RECORD))
    assert [words.partition(",")[0] for words in said] == [
        f"Pyodide of {archive()}", "hapticlab and 0 packages that it needs", "JupyterLite with 11 labs",
        f"{len(PAGES)} pages that need no Python",
    ]  # fmt: skip
    for lab in find_labs():
        for path in (lab.notebook, lab.path / "checks.py"):
            assert found[f"files/{lab.name}/{path.name}"] == path.read_bytes()
    assert not [name for name in found if "solution" in name or "hidden.py" in name or name.endswith(".map")]
    (folder / "CNAME").unlink()
    (folder / ".git" / "HEAD").unlink()
    assert without_text(parts(folder)) == []


@pytest.mark.wide
def test_the_kernel_loads_from_the_site_what_is_there(tmp_path, own_wheel, monkeypatch):
    """A site without Pyodide: packages that Pyodide lacks are in it, and everything else is asked for by name."""
    monkeypatch.setattr(build, "write_pages", lambda folder: None)  # the test above has them
    build_site(tmp_path / "site", wheel=own_wheel, say=lambda words: None)
    settings = json.loads((tmp_path / "site" / "jupyter-lite.json").read_text())["jupyter-config-data"]["litePluginSettings"]
    kernel = settings[lite.KERNEL]
    assert kernel["disablePyPIFallback"] and "pyodideUrl" not in kernel
    asked = kernel["loadPyodideOptions"]["packages"]
    worker = tmp_path / "site" / "extensions" / lite.EXTENSIONS["jupyterlite-pyodide-kernel"] / "static"
    assert list(worker.glob("comlink.worker.*.js"))
    wheels = {(worker / name).resolve() for name in asked if name.endswith(".whl")}
    assert wheels == {*(tmp_path / "site" / "pypi").glob("*.whl")} and {"numpy", "scipy", "sympy", "matplotlib"} <= set(asked)
    names = {path.name.partition("-")[0] for path in wheels}
    assert {"hapticlab", "pint", "pyserial", "anywidget", "ipywidgets", "comm"} <= names
