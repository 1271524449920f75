"""The command line as a user meets it: real processes, exit codes, what goes to stdout and what to stderr."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import hapticlab as hl

EXAMPLE = Path(hl.__file__).parent / "examples" / "mass_on_coupler.py"
PNG = b"\x89PNG\r\n\x1a\n"


def command(*arguments, folder):
    call = [sys.executable, "-m", "hapticlab", *map(str, arguments)]
    environment = {"PYTHONPATH": str(Path(hl.__file__).parents[1])}
    return subprocess.run(call, cwd=folder, capture_output=True, text=True, env=os.environ | environment)


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo")
    return command("demo", "--quick", "--json", folder=folder), folder


def test_demo_prints_json_and_nothing_else(demo):
    done, _ = demo
    assert done.returncode == 0, done.stderr
    facts = json.loads(done.stdout)
    # 2 b/T of the published set, m = 0.166 kg, b = 0.057 N s/m, T = 1 ms
    assert facts["passivity"]["K_N_per_m"] == pytest.approx(114.0, rel=1e-12)
    assert facts["chatters_below_passivity_limit"] is False
    assert facts["paddle"]["nominal"] is True


def test_demo_finds_the_exact_limits_in_simulation(demo):
    facts = json.loads(demo[0].stdout)
    for hand, m, b, k in zip(facts["hands"], (0.166, 0.186), (0.057, 1.057), (0.0, 200.0), strict=True):
        limit = hand["stability_K_N_per_m"]
        assert limit == pytest.approx(highest_stable(m, b, k, 1e-3), rel=1e-6)
        low, high = hand["chatter_begins_between_N_per_m"]
        step = high / low
        assert low / step <= limit <= high * step
        assert hand["within_one_grid_step"] is True


def highest_stable(m, b, k, T):
    """Bisect the largest K whose sampled loop has no pole outside the unit circle, the map by a Taylor series."""

    def radius(K):
        A = np.array([[0, 1, 0], [-k / m, -b / m, -1 / m], [0, 0, 0]]) * T
        term, step = np.eye(3), np.eye(3)
        for order in range(1, 20):
            term = term @ A / order
            step = step + term
        return abs(np.linalg.eigvals(step[:2, :2] + np.outer(step[:2, 2], [K, 0]))).max()

    low, high = 1.0, 1e4
    while high - low > 1e-8 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if radius(middle) <= 1 else (low, middle)
    return low


def test_demo_walls_behave_on_either_side(demo):
    soft, stiff = json.loads(demo[0].stdout)["walls"]
    assert soft["chatter"]["growth_per_s"] < 0 < stiff["chatter"]["growth_per_s"]
    assert soft["chatter"]["contacts_per_s"] == 0
    assert stiff["chatter"]["contacts_per_s"] > 1
    assert stiff["energy"]["generated_J"] > 0


def test_demo_writes_its_files_where_it_says(demo):
    done, folder = demo
    files = {name: Path(path) for name, path in json.loads(done.stdout)["files"].items()}
    assert all(path.parent == (folder / "hapticlab-demo").resolve() for path in files.values())
    assert files["figure"].read_bytes().startswith(PNG)
    with open(files["own_scene_telemetry"], newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0][:5] == ["t [s]", "x [m]", "v [m/s]", "F [N]", "z [m]"]
    assert len(rows) == 3001


def test_demo_in_words_names_both_limits_and_its_files(tmp_path):
    done = command("demo", "--quick", "--out", tmp_path / "here", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    for phrase in ("Eq. (23.10)", "114 N/m", "exact linear limit", "not measured on this device", "tick"):
        assert phrase in done.stdout
    assert str((tmp_path / "here" / "demo.png").resolve()) in done.stdout
    assert [p.name for p in tmp_path.iterdir()] == ["here"]


def test_run_binds_and_overrides(tmp_path):
    options = ("--set", "K=500", "--set", "z_o=4 mm", "--duration", "0.5", "--T", "5e-4", "--method", "heun", "--json")
    done = command("run", EXAMPLE, *options, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    facts = json.loads(done.stdout)
    assert facts["parameters"]["K"] == 500
    assert facts["parameters"]["z_o"] == pytest.approx(0.004, rel=1e-12)
    assert facts["samples"] == 1000
    assert facts["program"]["T_s"] == 5e-4
    assert facts["program"]["method"] == "heun"
    assert all(Path(path).is_file() for path in facts["files"].values())


def test_run_settles_where_statics_say(tmp_path):
    done = command("run", EXAMPLE, "--json", folder=tmp_path)
    facts = json.loads(done.stdout)
    with open(facts["files"]["telemetry"], newline="") as file:
        last = {name: float(a) for name, a in list(csv.DictReader(file))[-1].items()}
    # push = K (x - z) + k_h x and K (x - z) = k_w (z - z_o): two linear equations
    K, k_h, k_w, z_o, push = 300.0, 200.0, 2000.0, 0.005, 2.0
    x, z = np.linalg.solve([[K + k_h, -K], [K, -K - k_w]], [push, -k_w * z_o])
    assert last["x [m]"] == pytest.approx(x, rel=1e-5)  # single precision, and a decay of 3 s
    assert last["z [m]"] == pytest.approx(z, rel=1e-5)
    assert last["F [N]"] == pytest.approx(K * (x - z), rel=1e-4)


BAD = {
    "no_scene": ("x = 1\n", ["no variable `scene`", "hl.Scene(force=...)"]),
    "not_a_scene": ("scene = 3\n", ["scene = 3"]),
    "unbound": (
        "import hapticlab as hl\nk = hl.parameters('k', units='N/m')\nscene = hl.Scene(force=k*hl.x(hl.n))\n",
        ["no value for k [N/m]"],
    ),
    "units": (
        "import hapticlab as hl\nk = hl.parameters('k', units='N')\nscene = hl.Scene(force=k*hl.x(hl.n))\n",
        [", line 3: ", "N"],
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_wrong_with_a_scene_is_one_line(tmp_path, name):
    source, words = BAD[name]
    file = tmp_path / f"{name}.py"
    file.write_text(source)
    done = command("run", file, folder=tmp_path)
    assert done.returncode == 1
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert all(word in done.stderr for word in words), done.stderr


def test_an_error_of_their_own_shows_their_lines_only(tmp_path):
    file = tmp_path / "own.py"
    file.write_text("def half(a):\n    return a / 0\n\nscene = half(1)\n")
    done = command("run", file, folder=tmp_path)
    assert done.returncode == 1
    assert "ZeroDivisionError" in done.stderr
    assert "line 2" in done.stderr
    assert "line 4" in done.stderr
    assert "runpy" not in done.stderr
    assert "scenefile" not in done.stderr


def test_a_syntax_error_is_theirs(tmp_path):
    file = tmp_path / "own.py"
    file.write_text("scene = (\n")
    done = command("run", file, folder=tmp_path)
    assert done.returncode == 1
    assert "SyntaxError" in done.stderr
    assert "runpy" not in done.stderr


def test_a_fault_fails_the_run(tmp_path):
    file = tmp_path / "fault.py"
    file.write_text(
        "import sympy as sp, hapticlab as hl\nL, k = hl.parameters('L k', units='m N/m', values=(0.0, 1.0))\n"
        "scene = hl.Scene(force=k*sp.sqrt(L*hl.x(hl.n) - hl.x(hl.n)**2))\n"
    )
    done = command("run", file, "--json", folder=tmp_path)
    assert done.returncode == 1
    assert "not finite" in done.stderr
    assert "not finite" in json.loads(done.stdout)["fault"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "usage"),
        (("run",), "FILE.py"),
        (("run", "nowhere.py"), "no such file"),
        (("run", EXAMPLE, "--set", "K"), "NAME=VALUE"),
        (("run", EXAMPLE, "--set", "q=1"), "no parameter q"),
        (("run", EXAMPLE, "--set", "K=-50"), "needs K >= 0"),
        (("run", EXAMPLE, "--T", "0"), "T = 0"),
        (("run", EXAMPLE, "--duration", "-1"), "duration = -1"),
        (("run", EXAMPLE, "--method", "magic"), "rk4"),
    ],
)
def test_a_wrong_command_is_told_and_ends_with_2(tmp_path, arguments, words):
    done = command(*arguments, folder=tmp_path)
    assert done.returncode == 2
    assert words in done.stdout + done.stderr
    assert "Traceback" not in done.stderr


def test_an_unwritable_folder_is_one_line(tmp_path):
    (tmp_path / "taken").write_text("a file")
    done = command("run", EXAMPLE, "--out", "taken", "--duration", "0.1", folder=tmp_path)
    assert done.returncode == 1
    assert "--out" in done.stderr
    assert "Traceback" not in done.stderr


def test_version_and_help(tmp_path):
    assert command("--version", folder=tmp_path).stdout.strip() == f"hapticlab {hl.__version__}"
    helped = command("-h", folder=tmp_path)
    assert helped.returncode == 0
    assert "demo" in helped.stdout
    assert "run" in helped.stdout
