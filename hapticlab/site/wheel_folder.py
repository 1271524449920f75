"""Wheels for a lab room without a network: hapticlab's own and all that it needs, in one folder, for several systems.

uv resolves, because it evaluates the markers of requirements for another system than the one that it runs on; pip does not.
pip downloads.
"""

from __future__ import annotations

import email
import importlib.metadata
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import CourseError, EngineMissingError
from .room_readme import DIGESTS, README, describe
from .wheels import wheel_for

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..base.annotations import File

HERE = f"{sys.version_info.major}.{sys.version_info.minor}"
#: names of `hapticlab wheels --for`, beside those of single targets
SYSTEMS = {"windows": "windows-x86_64", "macos": "macos-aarch64", "linux": "linux-x86_64"}
#: target -> its name for uv, and the tags of its wheels for pip, which knows older ones of macOS by itself
PLATFORMS = {
    f"linux-{machine}": (f"{machine}-manylinux_2_28", (*(f"manylinux_2_{n}_{machine}" for n in range(28, 4, -1)),
                                                       *(f"manylinux{n}_{machine}" for n in ("2014", "2010", "1"))))
    for machine in ("x86_64", "aarch64")
} | {
    "windows-x86_64": ("x86_64-pc-windows-msvc", ("win_amd64",)),
    "windows-aarch64": ("aarch64-pc-windows-msvc", ("win_arm64",)),
    "macos-x86_64": ("x86_64-apple-darwin", ("macosx_13_0_x86_64",)),
    "macos-aarch64": ("aarch64-apple-darwin", ("macosx_13_0_arm64",)),
}  # fmt: skip


@dataclass(frozen=True)
class WheelFolder:
    """What was collected: the size of each file [bytes], and a sentence for each thing that a system lacks."""

    folder: Path
    files: dict[str, int]
    missing: tuple[str, ...]


def collect_wheels(
    folder: File,
    *,
    systems: Sequence[str] = (*SYSTEMS,),
    pythons: Sequence[str] = (HERE,),
    extras: Sequence[str] = ("notebook",),
    wheel: File | None = None,
    say: Callable[[str], object] = print,
) -> WheelFolder:
    """Collect the wheels from which hapticlab installs without a network.

    Parameters
    ----------
    folder : str or Path
        Made where it is missing. The wheels of an earlier call there are replaced.
    systems : sequence of str
        "windows", "macos", "linux", or a single target such as "linux-aarch64".
    pythons : sequence of str
        Versions of Python, such as "3.12"; by default the version that runs this.
    extras : sequence of str
        Extras of hapticlab.
    wheel : str or Path, optional
        Wheel of hapticlab, by default made of this one.
    say : callable
        Is told each step.

    Returns
    -------
    WheelFolder
        A target for which something has no wheel is in ``missing``, and the others are collected.

    Raises
    ------
    CourseError
        If the folder holds anything else, nothing could be collected, or a download failed.
    EngineMissingError
        If pip or uv is not installed.
    """
    uv, folder = _tools(), Path(folder)
    before = _written_before(folder)
    if wheel is None:
        _check_extras(importlib.metadata.metadata("hapticlab"), extras)
    targets = [*dict.fromkeys(SYSTEMS.get(name, name) for name in systems)]
    what = f"hapticlab[{','.join(extras)}]" if extras else "hapticlab"
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder, prefix=".") as aside:  # in the folder: moving is then renaming
        own, missing = wheel_for(aside, targets, wheel)
        _check_extras(_metadata(own), extras)
        say(f"hapticlab itself: {own.name}, {own.stat().st_size / 1e6:.1f} MB")
        served = []
        for python in pythons:
            for target in targets:
                name = f"{target}, Python {python}"
                chosen, why = _resolved(uv, what, own, target, python)
                if chosen is None:
                    missing.append(f"{name}: not collected. {why}")
                    continue
                _download(chosen, target, python, aside)
                again, why = _resolved(uv, what, own, target, python, "--no-index", "--find-links", aside)
                if again is None:
                    raise CourseError(f"{name}: the wheels that were collected do not suffice; do the same command again. {why}")
                served.append(name)
                if "llvmlite==" not in chosen:
                    missing.append(f"{name}: llvmlite has no wheel there, so that the interpreter runs every program, slowly")
                say(f"{name}: {len(chosen.splitlines())} packages")
        if not served:
            raise CourseError("nothing was collected. " + "\n".join(missing))
        files = {path.name: path.stat().st_size for path in sorted(Path(aside).glob("*.whl"))}
        for name in before - set(files):
            (folder / name).unlink(missing_ok=True)
        describe(Path(aside), files, what, served, missing)
        for path in Path(aside).iterdir():
            os.replace(path, folder / path.name)
    return WheelFolder(folder, files, tuple(missing))


def _tools():
    """Return uv's program; pip is there too."""
    try:
        importlib.metadata.version("pip")  # looking for the module itself, setuptools may warn of distutils
    except importlib.metadata.PackageNotFoundError:
        cure = f"do: {sys.executable} -m ensurepip"
        raise EngineMissingError(f"{sys.executable} has no pip, which downloads wheels; {cure}") from None
    if uv := shutil.which("uv", path=os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])):
        return uv
    raise EngineMissingError('uv, which finds the wheels of other systems, is not installed; do: pip install "hapticlab[wheels]"')


def _written_before(folder):
    """Return the wheels that an earlier call wrote into a folder; none where it is empty or missing."""
    if folder.exists() and not folder.is_dir():
        raise CourseError(f"{folder} is a file; name a new or an empty folder for the wheels")
    listed = folder / DIGESTS
    known = {line.partition("  ")[2] for line in listed.read_text("utf-8").splitlines()} if listed.is_file() else set()
    found = {path.name for path in folder.iterdir() if not path.name.startswith(".")} if folder.is_dir() else set()
    if strange := sorted(found - known - {README, DIGESTS} if listed.is_file() else found):
        raise CourseError(
            f"{folder} holds {strange[0]}, which `hapticlab wheels` did not write; name a new or an empty folder for the wheels"
        )
    return {name for name in known if name.endswith(".whl") and Path(name).name == name}


def _metadata(own):
    with zipfile.ZipFile(own) as packed:
        text = packed.read(next(name for name in packed.namelist() if name.endswith(".dist-info/METADATA")))
    return email.message_from_bytes(text)


def _check_extras(metadata, extras):
    known = metadata.get_all("Provides-Extra", [])
    if unknown := [name for name in extras if name not in known]:
        raise CourseError(f"{', '.join(unknown)} is not an extra of hapticlab; its extras are {', '.join(known)}")


def _resolved(uv, what, own, target, python, *sources):
    """Return what a target needs beside hapticlab, a pinned requirement on each line, or None, and why not."""
    command = [
        uv, "pip", "compile", "--quiet", "-", "--only-binary", ":all:", "--python-version", python, "--no-header",
        "--python-platform", PLATFORMS[target][0], "--no-annotate", "--no-emit-package", "hapticlab", "--color", "never",
        *sources,
    ]  # fmt: skip
    environment = os.environ | {"UV_PYTHON_DOWNLOADS": "never"}
    asked = f"{what} @ {own.resolve().as_uri()}"
    done = subprocess.run(command, input=asked, env=environment, capture_output=True, text=True, check=False)
    if done.returncode and any(word in done.stderr for word in ("error sending request", "dns error", "Failed to fetch")):
        raise CourseError(
            "the index of packages could not be reached. This command needs a network; the room does not. Connect this "
            f"computer, and do the same command again. uv said:\n{done.stderr.strip()}"
        )
    words = " ".join(done.stderr.split()).removeprefix("× ")
    return (None, f"uv said: {words}") if done.returncode else (done.stdout, "")


def _download(chosen, target, python, folder):
    """Download wheels by pip; the requirements name all, so that it resolves nothing."""
    listed = Path(folder, "requirements.txt")
    listed.write_text(chosen, "utf-8")
    tags = [word for tag in PLATFORMS[target][1] for word in ("--platform", tag)]
    command = [
        sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps", "--only-binary=:all:",
        "--python-version", python, "--implementation", "cp", *tags, "--dest", folder, "-r", listed,
    ]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    listed.unlink()
    if done.returncode:
        raise CourseError(
            f"pip could not download the wheels of {target}, Python {python}; check the network and do the same command again. "
            f"pip said:\n{done.stderr.strip()}"
        )
