"""The part of a distribution of Pyodide that goes into a site."""

import json
import tarfile
from pathlib import Path

import pytest

from hapticlab.errors import CourseError
from hapticlab.site.pyodide_archive import CORE, LOCK, opened


def names(folder):
    return {path.name for path in folder.iterdir()}


@pytest.mark.parametrize("packed", [False, True])
def test_python_and_the_packages_that_are_needed_are_copied_with_a_lock_file_of_these(distribution, tmp_path, packed):
    given = distribution
    if packed:
        given = tmp_path / "pyodide-314.0.6.tar.bz2"
        with tarfile.open(given, "w:bz2") as archive:
            archive.add(distribution, "pyodide")
    opened(given, tmp_path / "aside").copy(["arrays"], tmp_path / "site")
    wheels = {path.name for path in distribution.glob("*.whl") if not path.name.startswith("other")}
    assert names(tmp_path / "site") == {*CORE, LOCK, *wheels} and len(wheels) == 2
    lock = json.loads((tmp_path / "site" / LOCK).read_text())
    assert set(lock["packages"]) == {"arrays", "half-floats"} and lock["info"] == {"python": "3.14.0"}
    for name in wheels | set(CORE):
        assert (tmp_path / "site" / name).read_bytes() == (distribution / name).read_bytes()


def test_a_package_whose_file_is_missing_is_not_there(distribution):
    assert set(opened(distribution, None).packages) == {"arrays", "half-floats", "other"}
    with pytest.raises(CourseError, match="has no absent, which the labs need; give the whole distribution"):
        opened(distribution, None).closure(["absent"])


def test_a_file_that_is_not_the_one_of_the_lock_file_is_refused(distribution, tmp_path):
    next(distribution.glob("half_floats*")).write_text("changed")
    with pytest.raises(CourseError, match="half_floats-2.0.* is not the file that pyodide-lock.json names"):
        opened(distribution, None).copy(["arrays"], tmp_path / "site")


def test_what_is_no_distribution_of_pyodide_for_this_kernel_is_refused(distribution, tmp_path):
    with pytest.raises(CourseError, match="has no pyodide.mjs, so that it is not a distribution .* pyodide-VERSION.tar.bz2"):
        opened(Path(__file__).parent, None)
    with pytest.raises(CourseError, match="nowhere.tar.bz2 is not there; give a folder, or an archive such as"):
        opened(tmp_path / "nowhere.tar.bz2", None)
    (tmp_path / "half.tar.bz2").write_bytes(b"BZh9 and no more")
    with pytest.raises(CourseError, match="half.tar.bz2 could not be unpacked: .*; give a folder, or a whole .tar.bz2"):
        opened(tmp_path / "half.tar.bz2", tmp_path / "aside")
    lock = json.loads((distribution / LOCK).read_text())
    (distribution / LOCK).write_text(json.dumps(lock | {"info": {"python": "3.12.1"}}))
    with pytest.raises(CourseError, match="is Pyodide with Python 3.12.1; JupyterLite's kernel needs Python 3.14"):
        opened(distribution, None)
