"""The host library: shipped in the wheel for those without a compiler, never older than its sources, built elsewhere."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path
from struct import unpack_from

import pytest
from binaries import elf_sections, exports, mach_o_commands, target

from hapticlab.compiler.engines import firmware_library, toolchain
from hapticlab.errors import EngineMissingError

pytestmark = pytest.mark.machine_code

ROOT = Path(__file__).parents[3]
HERE = toolchain.running_target()
CALLED = {"hl_host_run", "hl_host_verify", "hl_host_new", "hl_host_tick"}
RUN_VM = """
import numpy as np, hapticlab, sys
from hapticlab.compiler.engines import engine, firmware_library
from hapticlab.compiler.ir.program import Block, Channel, Program
from hapticlab.compiler.ir.trace import Builder
b = Builder("f32")
x = b.leaf("input", 0, "f32")
program = Program("p", (Channel("x"),), (), (), (Channel("F"),), Block(), b.block([x * x + 0.1]), 1e-3)
inputs = np.array([[0.3], [-1.7]])
vm, reference = (engine.load(program, name).run(2, inputs, []).outputs for name in ("vm", "interpreter"))
assert (vm == reference).all() and vm[1] == np.float32(np.float32(1.7) * np.float32(1.7) + np.float32(0.1)), vm
assert firmware_library.load_library(8)
print(hapticlab.__file__)
"""


def child(*command, path=None, **environment):
    """Run a command; with a path, that is where it finds programs."""
    kept = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "HAPTICLAB_TARGETS")}
    if path is not None:
        kept["PATH"] = str(path)
    environment = kept | {k: str(v) for k, v in environment.items()}
    return subprocess.run([str(c) for c in command], cwd=ROOT, env=environment, capture_output=True, text=True)


def wheel_into(folder, **options):
    done = child(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    (wheel,) = folder.glob("*.whl")
    return wheel, done.stdout + done.stderr


def names(wheel):
    with zipfile.ZipFile(wheel) as opened:
        return opened.namelist()


def libraries(wheel):
    """Return target -> the bytes of its libraries."""
    found = {}
    with zipfile.ZipFile(wheel) as opened:
        for name in opened.namelist():
            if name.startswith("hapticlab/prebuilt/"):
                found.setdefault(name.split("/")[2], []).append(opened.read(name))
    return found


def installed(wheel, folder):
    """Install a wheel in an empty environment that borrows its dependencies from this one; return its Python."""
    venv.create(folder)
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    done = child(sys.executable, "-m", "pip", "--python", python, "install", "--no-deps", "--no-index", wheel)
    assert done.returncode == 0, done.stderr
    site = child(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").stdout.strip()
    Path(site, "borrowed.pth").write_text(sysconfig.get_path("purelib"), encoding="utf-8")
    return python, Path(site, "hapticlab")


def without_compiler(tmp_path):
    """Return surroundings in which nothing can be built: no program to find, no place to keep a library."""
    (tmp_path / "nothing").mkdir()
    (tmp_path / "file").write_text("in the way")
    blocked = tmp_path / "file" / "cache"
    return {"path": tmp_path / "nothing", "XDG_CACHE_HOME": blocked, "LOCALAPPDATA": blocked, "HOME": blocked}


def broken_compilers(tmp_path):
    """Return a PATH whose cc, and a PYTHONPATH whose ziglang, fail."""
    for name in ("cc", "gcc", "clang"):
        (tmp_path / name).write_text("#!/bin/sh\necho no headers here >&2\nexit 1\n")
        (tmp_path / name).chmod(0o755)
    (tmp_path / "broken" / "ziglang").mkdir(parents=True)
    (tmp_path / "broken" / "ziglang" / "__init__.py").touch()
    (tmp_path / "broken" / "ziglang" / "__main__.py").write_text("raise SystemExit('zig is out of order')")
    return tmp_path, tmp_path / "broken"


@pytest.fixture(scope="session")
def wheel(tmp_path_factory):
    return wheel_into(tmp_path_factory.mktemp("wheel"))[0]


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package folder with firmware and a library made of it."""
    package = tmp_path / "hapticlab"
    shutil.copytree(firmware_library.firmware_folder(), package / "firmware")
    (package / "prebuilt" / HERE).mkdir(parents=True)
    monkeypatch.setattr(firmware_library, "PACKAGE", package)
    for bits in toolchain.WORD_BITS:
        made = toolchain.build_library(package / "firmware", tmp_path, HERE, bits)
        shutil.move(made, package / "prebuilt" / HERE / made.name)
    return package


# ---------------------------------------------------------------- the wheel


@pytest.mark.wide
def test_the_wheel_runs_the_machine_where_nothing_can_be_built(wheel, tmp_path):
    python, package = installed(wheel, tmp_path / "empty")
    surroundings = without_compiler(tmp_path)
    ran = child(python, "-I", "-c", RUN_VM, **surroundings)
    assert ran.returncode == 0, ran.stderr
    assert Path(ran.stdout.strip()).parent == package
    with (package / "firmware" / "core" / "vm.h").open("a") as header:  # the library is now of other sources
        header.write("/* changed */\n")
    ran = child(python, "-I", "-c", RUN_VM, **surroundings)
    assert "EngineMissingError" in ran.stderr and "Set XDG_CACHE_HOME to a folder of your own;" in ran.stderr


@pytest.mark.wide
def test_the_wheel_names_the_platform_and_holds_its_library_alone(wheel):
    found = libraries(wheel)
    assert list(found) == [HERE]
    assert len(found[HERE]) == len(toolchain.WORD_BITS)
    assert all(target(data) == HERE and exports(data) >= CALLED for data in found[HERE])
    assert wheel.name.startswith("hapticlab-") and "-py3-none-" in wheel.name and not wheel.name.endswith("-any.whl")
    if HERE in ("linux-x86_64", "linux-aarch64"):
        assert re.search(r"-manylinux_2_\d+_" + HERE.partition("-")[2], wheel.name)


@pytest.mark.wide
def test_without_a_system_compiler_ziglang_makes_the_wheel(tmp_path):
    (tmp_path / "nothing").mkdir()
    made, _ = wheel_into(tmp_path / "dist", path=tmp_path / "nothing")
    assert list(libraries(made)) == [HERE]
    if HERE in ("linux-x86_64", "linux-aarch64"):
        assert f"-manylinux_2_17_{HERE.partition('-')[2]}" in made.name  # the glibc that zig was asked for
    python, _ = installed(made, tmp_path / "empty")
    ran = child(python, "-I", "-c", RUN_VM, **without_compiler(tmp_path / "empty"))
    assert ran.returncode == 0, ran.stderr


@pytest.mark.skipif(os.name == "nt", reason="the broken compilers are shell scripts")
def test_a_compiler_that_fails_leaves_a_wheel_without_library_that_says_so(tmp_path):
    path, broken = broken_compilers(tmp_path)
    made, said = wheel_into(tmp_path / "dist", path=path, PYTHONPATH=broken)
    assert made.name.endswith("-py3-none-any.whl")
    assert libraries(made) == {}
    assert "this wheel is without its library" in said and "zig is out of order" in said


@pytest.mark.wide
@pytest.mark.skipif(os.name == "nt", reason="the broken compilers are shell scripts")
@pytest.mark.parametrize(
    "kind, compiler, chosen, needed",
    [
        ("wheel", "works", "", False),
        ("wheel", "missing", "", True),
        ("wheel", "broken", "", True),
        ("wheel", "missing", "none", False),
        ("wheel", "works", "all", True),
        ("editable", "missing", "", False),  # built on first use
    ],
)
def test_ziglang_is_a_build_requirement_only_where_no_compiler_works(tmp_path, kind, compiler, chosen, needed):
    (tmp_path / "nothing").mkdir()
    path = {"missing": tmp_path / "nothing", "broken": broken_compilers(tmp_path)[0]}.get(compiler)
    if compiler == "works" and toolchain.system_compiler() is None:
        path = compiler_of_ziglang(tmp_path / "bin")
    hook = f"get_requires_for_build_{kind}"
    code = f"import hatchling.build; print(hatchling.build.{hook}())"
    done = child(sys.executable, "-c", code, hook, path=path, HAPTICLAB_TARGETS=chosen)  # as pip does, hook in argv
    assert done.returncode == 0, done.stderr
    assert ("ziglang" in done.stdout) == needed


def compiler_of_ziglang(folder):
    """Return a PATH with a cc, for a computer that has none."""
    folder.mkdir()
    (folder / "cc").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m ziglang cc "$@"\n')
    (folder / "cc").chmod(0o755)
    return f"{folder}{os.pathsep}{os.environ['PATH']}"


@pytest.mark.wide
def test_the_source_distribution_makes_the_same_wheel(wheel, tmp_path):
    done = child(sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", tmp_path)
    assert done.returncode == 0, done.stderr
    (archive,) = tmp_path.glob("*.tar.gz")
    shutil.unpack_archive(archive, tmp_path, filter="data")
    source = tmp_path / archive.name.removesuffix(".tar.gz")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(command, cwd=source, check=True, capture_output=True)
    (made,) = tmp_path.glob("*.whl")
    assert made.name == wheel.name
    assert sorted(names(made)) == sorted(names(wheel))


# ---------------------------------------------------------------- every target


def fused(library):
    """Return how many fused multiply-adds the code of an AArch64 library for Linux has."""
    words = []
    for kind, flags, offset, size, _ in elf_sections(library):
        if kind == 1 and flags & 4:  # SHT_PROGBITS, SHF_EXECINSTR
            words += unpack_from(f"<{size // 4}I", library, offset)
    scalar = sum(word >> 24 == 0x1F for word in words)  # FMADD, FMSUB, FNMADD, FNMSUB
    return scalar + sum(word & 0xBF20FC00 == 0x0E20CC00 for word in words)  # FMLA, FMLS of vectors


@pytest.mark.wide
def test_no_multiplication_is_fused_with_an_addition(tmp_path):
    firmware = firmware_library.firmware_folder()
    made = {}
    for flag in toolchain.FLAGS[-1], "-ffp-contract=fast":
        made[flag] = toolchain.build_library(firmware, tmp_path, "linux-aarch64", 16, flag).read_bytes()
    assert fused(made["-ffp-contract=off"]) == 0
    assert fused(made["-ffp-contract=fast"]) > 20


@pytest.mark.parametrize("name", ["linux-aarch64", "macos-x86_64", "macos-aarch64", "emscripten-wasm32-32"])
@pytest.mark.wide
def test_ziglang_compiles_for_another_computer(name, tmp_path):
    made = toolchain.build_library(firmware_library.firmware_folder(), tmp_path, name, 16)
    check_library(name, made.read_bytes(), 16)


def check_library(name, data, bits):
    assert target(data) == name
    assert exports(data) >= CALLED
    assert toolchain.stamp(firmware_library.firmware_folder(), bits) in data
    if name.startswith("linux"):
        assert max(map(int, re.findall(rb"GLIBC_2\.(\d+)", data)), default=0) <= 17
    if name.startswith("macos"):
        commands = dict(mach_o_commands(data))
        assert unpack_from("<I", data, commands[0x32] + 12)[0] == 11 << 16  # LC_BUILD_VERSION: from macOS 11.0 on
        assert name == "macos-x86_64" or 0x1D in commands  # LC_CODE_SIGNATURE: Apple silicon loads no other


@pytest.mark.slow
def test_a_release_is_one_wheel_for_every_target(tmp_path):
    """Two and a half minutes where ziglang has not compiled for Windows before; .ci/run hands one made beside."""
    given = os.environ.get("HAPTICLAB_RELEASE_WHEEL")
    made = Path(given) if given else wheel_into(tmp_path, HAPTICLAB_TARGETS="all")[0]
    assert made.name.endswith("-py3-none-any.whl")
    found = libraries(made)
    assert sorted(found) == sorted(toolchain.TARGETS)
    for name, both in found.items():
        assert len(both) == len(toolchain.WORD_BITS)
        for data, bits in zip(both, sorted(toolchain.WORD_BITS, key=str), strict=True):  # 16 before 8, as names sort
            check_library(name, data, bits)
    python, _ = installed(made, tmp_path / "empty")
    ran = child(python, "-I", "-c", RUN_VM, **without_compiler(tmp_path))
    assert ran.returncode == 0 or HERE not in toolchain.TARGETS, ran.stderr


# ---------------------------------------------------------------- which library is taken


@pytest.mark.wide
def test_a_library_of_other_sources_is_refused(package):
    path = firmware_library.prebuilt(16)
    assert path == package / "prebuilt" / HERE / toolchain.library_name(HERE, 16)
    other = package / "prebuilt" / HERE / toolchain.library_name(HERE, 8)
    kept = path.read_bytes()
    path.write_bytes(other.read_bytes())  # of these sources, but of the other word size
    assert firmware_library.prebuilt(16) is None
    path.write_bytes(kept)
    for name in ("core/vm.c", "core/vm.h", "generated/opcodes.h", "boards/board.h", "boards/host/run.c"):
        source = package / "firmware" / name
        text = source.read_bytes()
        source.write_bytes(text + b"\n")
        assert firmware_library.prebuilt(16) is None, name
        source.write_bytes(text)
    (package / "firmware" / "core" / "more.c").touch()
    assert firmware_library.prebuilt(16) is None
    (package / "firmware" / "core" / "more.c").unlink()
    assert firmware_library.prebuilt(16) == path
    path.unlink()
    assert firmware_library.prebuilt(16) is None


@pytest.mark.wide
def test_a_library_that_does_not_load_is_built_instead(package, monkeypatch, tmp_path):
    stamp = toolchain.stamp(package / "firmware", 16)
    (package / "prebuilt" / HERE / toolchain.library_name(HERE, 16)).write_bytes(stamp)  # right sources, no library
    monkeypatch.setattr(firmware_library, "cache_folder", lambda: tmp_path / "cache")
    assert firmware_library.load_library.__wrapped__(16).hl_host_verify
    assert len(list((tmp_path / "cache").iterdir())) == 1


@pytest.mark.wide
def test_flags_are_always_built_for(package, monkeypatch):
    monkeypatch.setattr(firmware_library, "built", lambda *asked: pytest.fail(f"built {asked}"))
    firmware_library.load_library.__wrapped__(16)
    with pytest.raises(pytest.fail.Exception, match=r"built \(16, '-DHL_NO_COMPUTED_GOTO'\)"):
        firmware_library.load_library.__wrapped__(16, "-DHL_NO_COMPUTED_GOTO")


def test_no_source_of_the_library_is_a_program():
    firmware = firmware_library.firmware_folder()
    listed = toolchain.sources(firmware)
    assert {"core/vm.c", "core/verify.c", "generated/elementary.c", "boards/host/run.c"} < set(listed)
    assert not [name for name in listed if re.search(r"\bmain\s*\(", (firmware / name).read_text("utf-8"))]
    assert not [name for name in listed if name.startswith("boards/host/tools") or "uno" in name]


def test_without_a_compiler_the_error_says_what_to_install(monkeypatch, tmp_path):
    monkeypatch.setattr(toolchain.shutil, "which", lambda name: None)
    monkeypatch.setattr(toolchain, "find_spec", lambda name: None)
    monkeypatch.setattr(firmware_library, "cache_folder", lambda: tmp_path)
    for cure in ("install a C compiler, or do: pip install ziglang", 'engine="interpreter"', "hl.SimulatedPaddle", "sim://"):
        with pytest.raises(EngineMissingError, match=rf"{re.escape(cure)}(.|\n)*no C compiler for "):
            firmware_library.built(16)


def test_apples_cc_without_its_tools_is_no_compiler(monkeypatch):
    monkeypatch.setattr(toolchain.sys, "platform", "darwin")
    monkeypatch.setattr(toolchain.shutil, "which", lambda name: f"/usr/bin/{name}")
    for code, found in (0, ["/usr/bin/cc"]), (2, None):
        done = subprocess.CompletedProcess([], code)
        monkeypatch.setattr(toolchain.subprocess, "run", lambda *command, done=done, **options: done)
        assert toolchain.system_compiler() == found


@pytest.mark.parametrize(
    "system, name, machine, libc, expected",
    [
        ("linux", "linux-x86_64", "x86_64", "glibc", "linux-x86_64"),
        ("linux", "linux-aarch64", "aarch64", "", "linux-aarch64-musl"),
        ("win32", "win-amd64", "ARM64", "", "windows-x86_64"),  # Python for x86-64 on an ARM machine
        ("win32", "win-arm64", "ARM64", "", "windows-aarch64"),
        ("darwin", "macosx-10.13-universal2", "arm64", "", "macos-aarch64"),
    ],
)
def test_the_target_is_what_this_python_runs_on(monkeypatch, system, name, machine, libc, expected):
    monkeypatch.setattr(toolchain.sys, "platform", system)
    monkeypatch.setattr(toolchain.sysconfig, "get_platform", lambda: name)
    monkeypatch.setattr(toolchain.platform, "machine", lambda: machine)
    monkeypatch.setattr(toolchain.platform, "libc_ver", lambda: (libc, ""))
    assert toolchain.running_target() == expected


# ---------------------------------------------------------------- the user's cache


@pytest.mark.wide
def test_a_build_that_fails_says_what_the_compiler_said(monkeypatch, tmp_path):
    monkeypatch.setattr(firmware_library, "cache_folder", lambda: tmp_path)
    with pytest.raises(EngineMissingError, match=r"did not compile(.|\n)*no_such_header"):
        firmware_library.built(16, "-include", "no_such_header.h")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.wide
def test_the_library_is_built_once_and_kept(monkeypatch, tmp_path):
    monkeypatch.setattr(firmware_library, "cache_folder", lambda: tmp_path)
    first = firmware_library.built(8)
    monkeypatch.setattr(toolchain.subprocess, "run", None)  # a second build would fail
    assert firmware_library.built(8) == first
    assert [p.name for p in tmp_path.iterdir()] == [first.name]


def test_a_cache_that_cannot_be_written_is_an_error_with_a_cure(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setattr(firmware_library, "cache_folder", lambda: tmp_path / "file" / "hapticlab")
    with pytest.raises(EngineMissingError, match="Set XDG_CACHE_HOME to a folder of your own;"):
        firmware_library.built(16)


def test_the_sources_are_found_in_a_checkout_and_in_an_installed_package(monkeypatch, tmp_path):
    monkeypatch.setattr(firmware_library, "PACKAGE", tmp_path / "hapticlab")
    with pytest.raises(EngineMissingError, match="reinstall hapticlab"):
        firmware_library.firmware_folder()
    for folder in (tmp_path / "firmware", tmp_path / "hapticlab" / "firmware"):  # the package's own goes first
        (folder / "core").mkdir(parents=True)
        (folder / "core" / "vm.c").touch()
        assert firmware_library.firmware_folder() == folder
