"""Wheels of installed packages, and of hapticlab in a checkout and installed."""

import hashlib
import os
import subprocess
import sys
import zipfile
from base64 import urlsafe_b64decode

import pytest

from hapticlab.errors import CourseError
from hapticlab.site import wheels
from hapticlab.site.wheels import hapticlab_wheel, installed_wheel, zipped_files

FILES = {
    "springs/__init__.py": "",
    "springs/law.py": "k = 3",
    "springs/law.cpython-311-x86_64-linux-gnu.so": "machine code of law",
    "1a2b__mypyc.cpython-311-x86_64-linux-gnu.so": "machine code of all",
    "springs/__pycache__/law.cpython-311.pyc": "compiled",
    "springs/data/table.csv": "1,2",
    "../bin/springs": "a script for this computer",
    "springs-1.5.dist-info/licenses/LICENSE": "Do what you like.",
}


def test_a_wheel_has_all_of_a_package_but_what_is_of_this_computer(install, tmp_path):
    install("springs", FILES)
    wheel = installed_wheel("springs", tmp_path)
    assert wheel.name == "springs-1.5-py3-none-any.whl"
    with zipfile.ZipFile(wheel) as packed:
        found = {name: packed.read(name) for name in packed.namelist()}
    info = "springs-1.5.dist-info"
    assert set(found) == {
        "springs/__init__.py", "springs/law.py", "springs/data/table.csv",
        *(f"{info}/{name}" for name in ("METADATA", "WHEEL", "RECORD", "licenses/LICENSE")),
    }  # fmt: skip
    assert b"Root-Is-Purelib: true\nTag: py3-none-any\n" in found[f"{info}/WHEEL"]
    rows = [row.split(",") for row in found[f"{info}/RECORD"].decode().splitlines()]
    assert {name for name, _, _ in rows} == set(found)
    for name, digest, size in rows[:-1]:
        assert urlsafe_b64decode(digest.removeprefix("sha256=") + "=") == hashlib.sha256(found[name]).digest()
        assert int(size) == len(found[name])


def test_the_same_files_give_the_same_bytes(install, tmp_path):
    install("springs", FILES)
    first = installed_wheel("springs", tmp_path).read_bytes()
    assert installed_wheel("springs", tmp_path).read_bytes() == first


@pytest.mark.parametrize(
    ("files", "words"),
    [
        (
            {"springs/law.cpython-311-x86_64-linux-gnu.so": "code"},
            "springs has machine code, such as springs/law.*Install it from PyPI",
        ),
        ({"__editable__.springs.pth": "/src"}, "springs was not installed from a wheel so that no wheel"),
    ],
)
def test_a_package_of_which_no_wheel_can_be_made_is_named(install, tmp_path, files, words):
    install("springs", files)
    with pytest.raises(CourseError, match=words):
        installed_wheel("springs", tmp_path)


def test_what_is_given_instead_must_be_a_wheel_of_hapticlab(install, tmp_path):
    install("springs", FILES)
    other, text = installed_wheel("springs", tmp_path), tmp_path / "text.whl"
    text.write_text("no archive")
    for given, words in ((other, "is not a wheel of hapticlab"), (text, "text.whl is not a wheel; give a file such as")):
        with pytest.raises(CourseError, match=words):
            hapticlab_wheel(tmp_path, given)


@pytest.fixture
def small(install, tmp_path, monkeypatch):
    """A wheel of a hapticlab of one module, with a library for this computer and perhaps the browser's."""

    def made(libraries):
        files = {f"hapticlab/prebuilt/{path}": text for path, text in libraries.items()} | {"hapticlab/__init__.py": ""}
        found = wheels.write_wheel(
            tmp_path, {k: v.encode() for k, v in (files | {"hapticlab-1.dist-info/METADATA": "Name: hapticlab"}).items()}
        )
        return found.rename(tmp_path / "given.whl")

    return made


def test_the_browsers_library_is_compiled_where_a_wheel_has_none_of_these_sources(small, tmp_path, monkeypatch):
    monkeypatch.setattr(wheels, "_library", lambda target, bits: f"compiled for {bits}".encode())
    browser = "emscripten-wasm32-32/libhapticlab_core"
    fresh = wheels.toolchain.stamp(wheels.firmware_folder(), 16).decode()
    given = small({"linux-x86_64/libhapticlab_core8.so": "code", f"{browser}8.so": "of older sources", f"{browser}16.so": fresh})
    found = zipped_files(hapticlab_wheel(tmp_path, given))
    libraries = {name.removeprefix("hapticlab/prebuilt/"): text for name, text in found.items() if "prebuilt" in name}
    assert libraries == {f"{browser}8.so": b"compiled for 8", f"{browser}16.so": fresh.encode()}


def test_without_a_compiler_the_cure_is_said(small, tmp_path, monkeypatch):
    def refused(*_, **__):
        raise wheels.toolchain.CompileError("no C compiler")

    monkeypatch.setattr(wheels.toolchain, "build_library", refused)
    with pytest.raises(CourseError, match="which sim:// and lab 00 need.* pip install ziglang; or give a release"):
        wheels.hapticlab_wheel(tmp_path, small({}))


@pytest.mark.wide
def test_an_installed_hapticlab_makes_the_wheel_that_its_checkout_makes(tmp_path, own_wheel):
    (tmp_path / "again").mkdir()
    pip = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--no-deps",
        "--no-index",
        "--target",
        tmp_path / "installed",
        own_wheel,
    ]
    subprocess.run(pip, check=True)  # pip also compares every digest of RECORD
    code = "import sys; from hapticlab.site.wheels import hapticlab_wheel; hapticlab_wheel(sys.argv[1])"
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "installed")}
    subprocess.run([sys.executable, "-c", code, tmp_path / "again"], check=True, env=environment, cwd=tmp_path)
    again = zipped_files(tmp_path / "again" / own_wheel.name)
    # data goes outside the package when pip installs it: Jupyter's setting, which a browser has no use for
    assert again == {name: content for name, content in zipped_files(own_wheel).items() if ".data/" not in name}
