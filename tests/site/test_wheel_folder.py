"""`hapticlab wheels`: a folder from which several systems install without a network."""

import hashlib
import os
import shutil
import subprocess
import sys

import pytest

from hapticlab.cli import options
from hapticlab.cli.main import main
from hapticlab.compiler.engines import toolchain
from hapticlab.errors import CourseError, EngineMissingError
from hapticlab.site import wheel_folder, wheels
from hapticlab.site.wheel_folder import HERE, PLATFORMS, SYSTEMS, collect_wheels

NEEDS = """Metadata-Version: 2.1
Name: hapticlab
Version: 1
Provides-Extra: notebook
Requires-Dist: springs>=2
Requires-Dist: screens; sys_platform == 'win32' and extra == 'notebook'
"""


@pytest.fixture
def index(tmp_path, monkeypatch):
    """Instead of an index of packages, a folder: ``springs`` for Linux and Windows, ``screens``, which Windows alone needs."""
    folder = tmp_path / "index"
    folder.mkdir()

    def put(name, version, *tags):
        for tag in tags:
            metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n".encode()
            files = {f"{name}/__init__.py": b"", f"{name}-{version}.dist-info/METADATA": metadata}
            wheels.write_wheel(folder, files).rename(folder / f"{name}-{version}-{tag}.whl")

    tag = f"cp{HERE.replace('.', '')}"
    put("springs", "1", "py3-none-any")
    put("springs", "2", f"{tag}-{tag}-manylinux_2_17_x86_64", f"{tag}-{tag}-win_amd64")
    put("screens", "3", "py3-none-any")
    own = wheels.write_wheel(folder, {"hapticlab/__init__.py": b"", "hapticlab-1.dist-info/METADATA": NEEDS.encode()})
    monkeypatch.setattr(wheels, "_library", lambda target, bits: toolchain.stamp(wheels.firmware_folder(), bits))
    for name, value in {"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": folder, "UV_OFFLINE": "1", "UV_FIND_LINKS": folder}.items():
        monkeypatch.setenv(name, str(value))
    return own.rename(tmp_path / own.name)


def test_another_system_gets_what_it_needs_and_is_told_how_to_install(index, tmp_path, capsys):
    folder, tag = tmp_path / "room", f"cp{HERE.replace('.', '')}"
    assert main(["wheels", str(folder), "--for", "windows", "--wheel", str(index)]) == 0
    found = {path.name for path in folder.glob("*.whl")}
    assert found == {"hapticlab-1-py3-none-any.whl", f"springs-2-{tag}-{tag}-win_amd64.whl", "screens-3-py3-none-any.whl"}
    text = (folder / "README.txt").read_text("utf-8")
    assert 'pip install --no-index --find-links . "hapticlab[notebook]"' in text
    assert f"py -{HERE}" in text and "Linux:" not in text
    assert all(f"MB  {name}" in text for name in found)
    assert "llvmlite has no wheel there" in text and "missing: windows-x86_64" in capsys.readouterr().out
    digests = dict(line.split("  ")[::-1] for line in (folder / "SHA256SUMS").read_text().splitlines())
    assert digests == {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in found}


@pytest.mark.wide
def test_what_has_no_wheel_is_named_and_another_call_replaces_only_what_it_wrote(index, tmp_path, capsys):
    folder = tmp_path / "room"
    assert main(["wheels", str(folder), "--for", "linux", "macos", "--wheel", str(index)]) == 1
    said = capsys.readouterr().out
    assert "missing: macos-aarch64" in said and "not collected" in said and "springs" in said.partition("not collected")[2]
    assert "springs" in (folder / "README.txt").read_text("utf-8").partition("Missing:")[2]
    first = {path.name for path in folder.iterdir()}
    collect_wheels(folder, systems=["windows"], wheel=index, say=lambda step: None)
    second = {path.name for path in folder.iterdir()}
    assert any("manylinux" in name for name in first) and not any("manylinux" in name for name in second)
    (folder / "marks.csv").write_text("mine")
    with pytest.raises(CourseError, match=r"marks.csv, which `hapticlab wheels` did not write; name a new or an empty folder"):
        collect_wheels(folder, wheel=index)
    with pytest.raises(CourseError, match=r"nothing was collected. macos-aarch64.*springs"):
        collect_wheels(tmp_path / "none", systems=["macos"], wheel=index, say=lambda step: None)


def without_pip(name):
    raise wheel_folder.importlib.metadata.PackageNotFoundError(name)


def test_what_is_missing_to_begin_with_is_told(index, tmp_path, monkeypatch):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").touch()
    with pytest.raises(CourseError, match=r"mine holds thesis.txt"):
        collect_wheels(tmp_path / "mine", wheel=index)
    with pytest.raises(CourseError, match="notebok is not an extra of hapticlab; its extras are notebook"):
        collect_wheels(tmp_path / "room", extras=["notebok"], wheel=index)
    with pytest.raises(CourseError, match="notebok is not an extra of hapticlab; its extras are .*notebook"):
        collect_wheels(tmp_path / "other", extras=["notebok"])  # before minutes of compiling
    assert not (tmp_path / "other").exists()
    monkeypatch.setattr(wheel_folder.shutil, "which", lambda *_, **__: None)
    with pytest.raises(EngineMissingError, match=r'pip install "hapticlab\[wheels\]"'):
        collect_wheels(tmp_path / "room", wheel=index)
    monkeypatch.setattr(wheel_folder.importlib.metadata, "version", without_pip)
    with pytest.raises(EngineMissingError, match="has no pip.*ensurepip"):
        collect_wheels(tmp_path / "room", wheel=index)


def test_without_a_network_the_cure_is_said(index, tmp_path, monkeypatch):
    monkeypatch.delenv("UV_OFFLINE")
    monkeypatch.delenv("UV_FIND_LINKS")
    monkeypatch.setenv("UV_DEFAULT_INDEX", "http://127.0.0.1:9/simple")  # nothing listens there
    monkeypatch.setenv("UV_HTTP_RETRIES", "0")
    with pytest.raises(CourseError, match="could not be reached.*needs a network; the room does not"):
        collect_wheels(tmp_path / "room", wheel=index, say=lambda step: None)


def test_the_command_names_every_system_once():
    assert {SYSTEMS.get(name, name) for name in options.ROOM_SYSTEMS} == set(PLATFORMS) <= set(toolchain.TARGETS)
    assert (*SYSTEMS,) == options.ROOM_SYSTEMS[:3]


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_a_real_folder_installs_and_runs_without_a_network(tmp_path):
    """The real packages of this computer's system, into an empty environment in a process that has no network at all."""
    if not sys.platform.startswith("linux"):
        pytest.skip("a process without a network is made by Linux")
    machine = toolchain.running_target()
    made = collect_wheels(tmp_path / "room", systems=[machine], say=lambda step: None)
    assert not made.missing
    line = next(line for line in (made.folder / "README.txt").read_text("utf-8").splitlines() if line.startswith("  python3"))
    home, path = tmp_path / "home", os.pathsep.join([os.path.dirname(sys.executable), os.environ["PATH"]])
    home.mkdir()
    alone = {"HOME": str(home), "PATH": path, "PIP_CONFIG_FILE": os.devnull, "PIP_NO_CACHE_DIR": "1"}
    offline = ["unshare", "--net", "--map-root-user"] if shutil.which("unshare") else pytest.fail("unshare is missing")
    reach = "import socket; socket.create_connection(('1.1.1.1', 53), 3)"
    assert subprocess.run([*offline, sys.executable, "-c", reach], capture_output=True, check=False).returncode
    for command in (line, "~/hapticlab/bin/hapticlab demo --quick", "~/hapticlab/bin/hapticlab labs --no-open ~/labs"):
        subprocess.run([*offline, "bash", "-c", command], cwd=made.folder, env=alone, check=True)
    sees = "import hapticlab as hl; hl.SimulatedPaddle; print(hl.connect('sim://hapkit').close())"
    subprocess.run([*offline, "bash", "-c", f'~/hapticlab/bin/python -c "{sees}"'], env=alone, check=True)
