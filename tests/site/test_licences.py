"""Every file of a site has a licence text."""

import json
import zipfile

import pytest

from hapticlab.site import licences, pages
from hapticlab.site.licences import owner, parts, without_text, write

HAPTICLAB = "hapticlab-1.0-py3-none-any.whl"


def wheel(path, **files):
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w") as packed:
        packed.writestr("one.py", "")
        for name, text in files.items():
            packed.writestr(f"one-1.dist-info/{name}", text)


@pytest.fixture
def site(tmp_path):
    """A small site: a file of each kind, all with their texts."""
    folder = tmp_path / "site"
    scripts = [
        {"name": "mathjax-full", "extractedText": "Apache"}, {"name": "@fortawesome/fontawesome-free", "extractedText": "OFL"},
        {"name": "@lumino/widgets", "extractedText": ""}, {"name": "other", "extractedText": "ISC"},
    ]  # fmt: skip
    names = [
        "index.html", "files/02_wall/02_wall.ipynb", "api/contents/all.json", "pypi/all.json", "build/1.js",
        "build/fa-solid.woff2", "build/MathJax_Main.woff", "lab/index.html", "tree/index.html", "jupyter-lite.json",
        "static/pyodide/pyodide.mjs", "static/favicons/favicon.ico", "extensions/anywidget/static/main.js", "service-worker.js",
    ]  # fmt: skip
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("content")
    (folder / "build" / "third-party-licenses.json").write_text(json.dumps({"packages": scripts}))
    wheel(folder / "pypi" / HAPTICLAB, LICENSE="BSD of hapticlab", METADATA="")
    wheel(folder / "static/pyodide/arrays-2.0-cp314-cp314-pyemscripten_2026_0_wasm32.whl", **{"licenses/COPYING": "of arrays"})
    wheel(folder / "pypi" / "pyserial-3.5-py3-none-any.whl", METADATA="")
    return folder


def test_each_part_has_its_text_in_a_file_that_the_list_links(site):
    assert write(site) == []
    listed = (site / "licences" / "index.html").read_text()
    expected = {
        "arrays-2-0.txt": "of arrays", "hapticlab.txt": "BSD of hapticlab", "fonts-of-mathjax.txt": "Apache",
        "font-awesome.txt": "OFL", "pyodide-and-python.txt": "Mozilla Public License Version 2.0",
        "pyserial-3-5.txt": "Chris Liechti", "anywidget.txt": "Trevor Manz", "jupyterlab-and-jupyterlite.txt": "ISC",
    }  # fmt: skip
    for file, words in expected.items():
        assert words in (site / "licences" / file).read_text() and f'href="{file}"' in listed
    both = (site / "licences" / "jupyterlab-and-jupyterlite.txt").read_text()
    assert "JupyterLite Contributors" in both and "Project Jupyter Contributors" in both.partition("@lumino/widgets")[2]


def test_pyodides_text_names_the_c_libraries_inside(site):
    write(site)
    text = (site / "licences" / "pyodide-and-python.txt").read_text()
    for words in (
        "PYTHON SOFTWARE FOUNDATION",
        "Emscripten",
        "musl",
        "libffi",
        "Expat",
        "zlib",
        "libbzip2",
        "Zstandard",
        "Stefan Krah",
    ):
        assert words in text, words


def test_a_file_of_no_known_part_has_none(site):
    for name in ("stray.js", "static/other/code.js", "extensions/strange/main.js", "build.js", "static/pyodide/more.wasm"):
        (site / name).parent.mkdir(parents=True, exist_ok=True)
        (site / name).write_text("content")
        assert without_text(parts(site)) == [name] and owner(name) == ""
        (site / name).unlink()


def test_packages_and_fonts_without_a_text_are_named(site):
    wheel(site / "pypi" / "bare-1.0-py3-none-any.whl", METADATA="License: unknown")
    (site / "build" / "third-party-licenses.json").write_text(json.dumps({"packages": [{"name": "new", "extractedText": ""}]}))
    assert set(without_text(parts(site))) == {
        "pypi/bare-1.0-py3-none-any.whl",
        "new",
        "build/fa-solid.woff2",
        "build/MathJax_Main.woff",
    }


def test_a_wheel_brings_the_texts_of_fonts_and_compiled_libraries_in_it_too(site):
    folder = site / "static" / "pyodide"
    with zipfile.ZipFile(folder / "scipy-1.0-cp314-cp314-wasm32.whl", "w") as packed:
        for name in ("scipy/qhull/COPYING.txt", "scipy/license.py", "scipy-1.0.dist-info/LICENSE", "scipy.libs/libopenblas.so"):
            packed.writestr(name, f"text of {name}")
    write(site)
    text = (site / "licences" / "scipy-1-0.txt").read_text()
    assert "text of scipy/qhull/COPYING.txt" in text and "text of scipy-1.0.dist-info/LICENSE" in text and ".py" not in text
    assert "The OpenBLAS Project" in text and "The University of Tennessee" in text  # LAPACK is inside
    wheel(site / "pypi" / "scipy-2.0-py3-none-any.whl", LICENSE="of Python alone")
    assert "OpenBLAS" not in next(part.text for part in parts(site) if part.name == "scipy 2.0")


def test_a_page_that_is_added_is_hapticlabs(site, monkeypatch):
    (site / "more.html").write_text("page")
    assert without_text(parts(site)) == ["more.html"]
    monkeypatch.setattr(licences, "PAGES", (pages.Page("more.html", "More", "", "site.none"),))
    assert write(site) == []
