"""Small stand-ins: a package that is installed, and a distribution of Pyodide."""

import hashlib
import json

import pytest

from hapticlab.site.wheels import hapticlab_wheel

METADATA = "Metadata-Version: 2.1\nName: {}\nVersion: 1.5\n"


@pytest.fixture(scope="session")
def own_wheel(tmp_path_factory):
    """This hapticlab as a wheel for a browser."""
    return hapticlab_wheel(tmp_path_factory.mktemp("wheel"))


@pytest.fixture
def install(tmp_path, monkeypatch):
    """A function that installs a package of given files, RECORD and all, where Python finds it."""
    monkeypatch.syspath_prepend(tmp_path / "installed")

    def installed(name, files, metadata=""):
        info = f"{name.replace('-', '_')}-1.5.dist-info"
        files = files | {f"{info}/METADATA": METADATA.format(name) + metadata, f"{info}/INSTALLER": "pip\n"}
        for path, text in files.items():
            place = tmp_path / "installed" / path
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(text)
        rows = [*files, f"{info}/RECORD"]
        (tmp_path / "installed" / info / "RECORD").write_text("".join(f"{path},,\n" for path in rows))
        return tmp_path / "installed"

    return installed


@pytest.fixture
def distribution(tmp_path):
    """A folder like a distribution of Pyodide, whose packages are ``arrays``, which needs ``half-floats``, and ``other``."""
    folder = tmp_path / "pyodide"
    folder.mkdir()
    for name in ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide.d.ts"):
        (folder / name).write_text(f"content of {name}")
    packages = {}
    for name, needs in (("arrays", ["Half_Floats"]), ("half-floats", []), ("other", [])):
        file = f"{name.replace('-', '_')}-2.0-cp314-cp314-pyemscripten_2026_0_wasm32.whl"
        (folder / file).write_text(name)
        digest = hashlib.sha256(name.encode()).hexdigest()
        packages[name] = {"name": name, "file_name": file, "sha256": digest, "depends": needs, "imports": [name]}
    packages["absent"] = packages["other"] | {"name": "absent", "file_name": "absent-2.0-py3-none-any.whl"}
    (folder / "pyodide-lock.json").write_text(json.dumps({"info": {"python": "3.14.0"}, "packages": packages}))
    return folder
