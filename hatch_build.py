"""The wheel's library of the firmware, so that a student's machine needs no compiler.

`pip install .` and `pip wheel .` compile it for this computer, by its own C compiler or, where there is none that works,
by ziglang, which is then asked for as a build requirement. An editable install builds it on first use instead.

HAPTICLAB_TARGETS=all builds for every target by ziglang, into one wheel for all: a release.
HAPTICLAB_TARGETS=emscripten-wasm32-32, or another name of a target, builds for that target alone.
HAPTICLAB_TARGETS=none ships no library.
"""

import importlib.util
import os
import platform
import re
import shutil
import sys
import sysconfig
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from packaging.tags import platform_tags

ROOT = Path(__file__).resolve().parent
FIRMWARE = ROOT / "firmware"
ZIGLANG = "ziglang>=0.13"
#: machines with a wheel of ziglang; asking for it elsewhere would fail an install that can do without
ZIGLANG_MACHINES = {"x86_64", "amd64", "aarch64", "arm64", "i686"}


def load(path):
    """Return a module of the package by its path: the package itself cannot be imported where its needs are missing."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


toolchain = load(ROOT / "hapticlab" / "compiler" / "engines" / "toolchain.py")


class Library(BuildHookInterface):
    def dependencies(self):
        chosen = os.environ.get("HAPTICLAB_TARGETS", "")
        editable = "get_requires_for_build_editable" in sys.argv  # as pip calls it; elsewhere ziglang comes for nothing
        has_wheel = sys.platform in ("linux", "darwin", "win32") and platform.machine().lower() in ZIGLANG_MACHINES
        if chosen == "none" or not has_wheel or (editable and not chosen):
            return []
        return [] if not chosen and self._system_compiler_works() else [ZIGLANG]

    def _system_compiler_works(self):
        """A compiler may be there without the headers of its C library: so it is tried."""
        target, compiler = toolchain.running_target(), toolchain.system_compiler()
        with tempfile.TemporaryDirectory() as folder:
            try:
                toolchain.build_library(FIRMWARE, folder, target, 16, tried=[compiler] if compiler else [])
            except toolchain.CompileError:
                return False
        return True

    def initialize(self, version, build_data):
        chosen = os.environ.get("HAPTICLAB_TARGETS", "")
        if chosen not in ("", "all", "none", *toolchain.TARGETS):
            names = ", ".join(toolchain.TARGETS)
            raise ValueError(f"HAPTICLAB_TARGETS={chosen}; it is all, none, one of {names}, or not set for this computer alone")
        if version == "editable" or chosen == "none":
            return
        self.folder = tempfile.mkdtemp()
        targets = list(toolchain.TARGETS) if chosen == "all" else [chosen or toolchain.running_target()]
        libraries = []
        for target in targets:
            try:
                libraries += self._build(target)
            except toolchain.CompileError as error:
                if chosen:  # asked for
                    raise
                self.app.display_warning(f"The firmware did not compile; this wheel is without its library.\n{error}")
                return
        for path in libraries:
            build_data["force_include"][str(path)] = f"hapticlab/prebuilt/{path.parent.name}/{path.name}"
        if not chosen:
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{platform_tag(targets[0], libraries)}"

    def _build(self, target):
        folder = Path(self.folder, target)
        folder.mkdir()
        return [toolchain.build_library(FIRMWARE, folder, target, bits) for bits in toolchain.WORD_BITS]

    def finalize(self, version, build_data, artifact_path):
        shutil.rmtree(getattr(self, "folder", ""), ignore_errors=True)


def platform_tag(target, libraries):
    """Return the oldest platform that loads the libraries, in the words of a wheel's name."""
    system, machine = target.split("-", 1)
    tag = own = re.sub(r"[-.]", "_", sysconfig.get_platform())
    if system == "linux" and target in toolchain.TARGETS:
        # each function of glibc that is called says since which version it is there
        minors = [int(n) for path in libraries for n in re.findall(rb"GLIBC_2\.(\d+)", path.read_bytes())]
        tag = f"manylinux_2_{max([17, *minors])}_{machine}"
    elif system == "macos":
        tag = f"macosx_11_0_{'arm64' if machine == 'aarch64' else machine}"
    return tag if tag in platform_tags() else own
