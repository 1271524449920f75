"""The command line as a user meets it: real processes, exit codes, what goes to stdout and what to stderr."""

import csv
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import workbench
from commands import run_command

import hapticlab as hl
from hapticlab.analysis.accuracy.tradeoff import PC
from hapticlab.cli import board as board_command
from hapticlab.cli import main, options, scenes
from hapticlab.cli.scene_file import load_scene
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.serial_ports import Port
from hapticlab.device.setup.calibrate import STEPS
from hapticlab.device.setup.practice import TROUBLES
from hapticlab.device.wirings import build

pytestmark = pytest.mark.interpreter

EXAMPLE = Path(hl.__file__).parent / "examples" / "mass_on_coupler.py"
PNG = b"\x89PNG\r\n\x1a\n"


def command(*arguments, folder):
    return run_command(arguments, folder)


def from_nothing(*arguments, folder):
    """Run it as a shell does: a new Python."""
    call = [sys.executable, "-m", "hapticlab", *map(str, arguments)]
    environment = {"PYTHONPATH": str(Path(hl.__file__).parents[1])}
    return subprocess.run(call, cwd=folder, capture_output=True, text=True, env=os.environ | environment)


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo")
    return command("demo", "--quick", "--json", folder=folder), folder


@pytest.mark.wide
def test_demo_prints_json_and_nothing_else(tmp_path):
    done = from_nothing("demo", "--quick", "--json", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    facts = json.loads(done.stdout)
    # 2 b/T of the published set, m = 0.166 kg, b = 0.057 N s/m, T = 1 ms
    assert facts["passivity"]["K_N_per_m"] == pytest.approx(114.0, rel=1e-12)
    assert facts["chatters_below_passivity_limit"] is False
    assert facts["profile"]["nominal"] is True


def test_demo_finds_the_exact_limits_in_simulation(demo):
    facts = json.loads(demo[0].stdout)
    for hand, m, b, k in zip(facts["hands"], (0.166, 0.186), (0.057, 1.057), (0.0, 200.0), strict=True):
        limit = hand["stability_K_N_per_m"]
        assert limit == pytest.approx(highest_stable(m, b, k, 1e-3), rel=1e-6)
        low, high = hand["chatter_begins_between_N_per_m"]
        assert low <= limit <= high
        assert hand["inside_bracket"] is True
        assert hand["within_one_grid_step"] is True


def test_demo_gives_the_hands_as_numbers(demo):
    alone, fingers = json.loads(demo[0].stdout)["hands"]
    assert alone["hand"] == {"m_kg": 0.0, "b_N_s_per_m": 0.0, "k_N_per_m": 0.0, "push_N": 2.0}
    assert fingers["hand"] == {"m_kg": 0.02, "b_N_s_per_m": 1.0, "k_N_per_m": 200.0, "push_N": 2.0}


UNITS = ("_m", "_s", "_kg", "_N", "_Hz", "_J", "_per_s", "_per_m")
COUNTS = {"margin", "points", "samples", "instructions", "substeps", "contacts"}


def nameless(facts, name=""):
    """Return the names of numbers that tell no unit; check that units stand beside parameters, and what `paddle` is."""
    if isinstance(facts, list):
        return [bad for one in facts for bad in nameless(one, name)]
    if isinstance(facts, dict):
        if "parameters" in facts:
            assert facts["units"].keys() == facts["parameters"].keys()
        assert isinstance(facts.get("paddle", ""), str)
        return [bad for key, one in facts.items() if key != "parameters" for bad in nameless(one, key)]
    number = isinstance(facts, int | float) and not isinstance(facts, bool)
    return [name] if number and not name.endswith(UNITS) and name not in COUNTS else []


def test_demo_names_every_number_with_its_unit(demo):
    facts = json.loads(demo[0].stdout)
    assert nameless(facts) == []
    assert facts["own_scene"]["units"] == {"m": "kg", "b": "N*s/m", "K": "N/m", "k_w": "N/m", "z_o": "m"}


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


@pytest.mark.wide
def test_demo_in_words_names_both_limits_and_its_files(tmp_path):
    done = command("demo", "--quick", "--out", tmp_path / "here", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    for phrase in ("Eq. (23.10)", "114 N/m", "exact linear limit", "not measured on this device", "tick"):
        assert phrase in done.stdout
    assert str((tmp_path / "here" / "demo.png").resolve()) in done.stdout
    assert [p.name for p in tmp_path.iterdir()] == ["here"]


@pytest.mark.wide
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


@pytest.mark.wide
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


@pytest.mark.wide
def test_run_names_every_number_with_its_unit(tmp_path):
    facts = json.loads(command("run", EXAMPLE, "--json", folder=tmp_path).stdout)
    assert nameless(facts) == []
    found = facts["chatter"]
    # the statics of test_run_settles_where_statics_say, solved for x: the handle rests there
    assert found["rest_m"] == pytest.approx(0.0071698, rel=1e-4)
    assert found["travel_m"] == pytest.approx(0, abs=1e-8)
    assert found["locked"] is False
    assert found["dither"] is False


def test_a_scene_file_imports_what_lies_beside_it(tmp_path):
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes" / "my_own_law.py").write_text("import hapticlab as hl\nwall = hl.wall()\n")
    file = tmp_path / "scenes" / "own.py"
    file.write_text("from my_own_law import wall\nscene, duration = wall(k=50), 0.1\n")
    before = sys.path[:]
    assert load_scene(file).scene.values["k"] == 50
    assert sys.path == before
    file.write_text("import my_own_law\nmy_own_law.absent\n")
    with pytest.raises(AttributeError):
        load_scene(file)
    assert sys.path == before
    sys.modules.pop("my_own_law")
    done = command("run", Path("scenes") / "own.py", folder=tmp_path)
    assert "AttributeError" in done.stderr


def test_an_error_beside_the_scene_file_shows_where(tmp_path):
    (tmp_path / "law.py").write_text("import hapticlab as hl\n\nwall = hl.wall()(k=-5)\n")
    (tmp_path / "own.py").write_text("from law import wall\n")
    done = command("run", "own.py", folder=tmp_path)
    assert done.returncode == 1
    where, own, _, said, _, more = done.stderr.strip().splitlines()
    assert where == "hapticlab: ParameterError in law.py, line 3"
    assert own == "    wall = hl.wall()(k=-5)"
    assert said.startswith("k = -5 N/m; a stiffness needs k >= 0.")
    assert more == "python -X dev law.py shows the whole traceback."


BAD = {
    "duration_0": ("import hapticlab as hl\nscene = hl.wall()(k=1)\nduration = 0\n", ["duration_0.py: duration = 0 s"]),
    "exits": ("import sys\nsys.exit()\n", ["exits.py ended itself by sys.exit()", "define scene"]),
    "exits_3": ("raise SystemExit(3)\n", ["ended itself by sys.exit(3)"]),
    "null": ("scene = 1\0\n", ["null.py holds null bytes", "plain text"]),
    "no_scene": ("x = 1\n", ["no variable `scene`", "hl.Scene(force=...)"]),
    "not_a_scene": ("scene = 3\n", ["scene = 3"]),
    "unbound": (
        "import hapticlab as hl\nk = hl.parameters('k', units='N/m')\nscene = hl.Scene(force=k*hl.x(hl.n))\n",
        ["no value for k [N/m]"],
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


def test_a_run_that_left_events_out_says_so_in_its_report(tmp_path):
    file = tmp_path / "thrown.py"
    file.write_text(
        "import hapticlab as hl\nh = hl.coordinate('h', unit='m', initial='2 mm', rate=20)\n"
        "m, W, K = hl.parameters('m W K', units='kg m N/m', values=(0.05, 0.004, 0))\n"
        "walls = [hl.contact.Contact(gap, hl.contact.impulse(e=1), name=name) for gap, name in ((h, 'floor'), (W - h, 'roof'))]\n"
        "motion = hl.mechanics.lagrange(m * h.diff(hl.t) ** 2 / 2, contacts=walls)\nscene = hl.Scene(force=K * h, eom=[motion])\n"
    )
    done = command("run", file, "--duration", "0.1", folder=tmp_path)
    assert done.returncode == 0 and "Warning" not in done.stderr
    assert "missed   100 of 100 samples left an event unlocated" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "Begin here"),
        (("lbs",), "'lbs' is not a command; did you mean labs? `hapticlab -h` lists the commands"),
        (("xyzzy",), "'xyzzy' is not a command. `hapticlab -h` lists the commands"),
        (("labs", "one", "two"), "one and two are several folders"),
        (("labs", "123"), "123 is not a lab; labs have two digits. For a folder of that name, give ./123"),
        (("--foo",), "unrecognized arguments: --foo. `hapticlab -h` lists"),
        (("run",), "FILE.py"),
        (("run", "nowhere.py"), "no such file"),
        (("run", "."), "is a folder, needs a file"),
        (("run", "nowhere.py"), "usage: hapticlab run"),
        (("run", EXAMPLE, "--T", "0"), "usage: hapticlab run"),
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


def test_a_wrong_method_lists_all_that_there_are(capsys):
    with pytest.raises(SystemExit, match="2"):
        main.main(["run", str(EXAMPLE), "--method", "magic"])
    told = capsys.readouterr().err
    assert [name for name in hl.methods.table() if name not in told] == []


@pytest.mark.parametrize("arguments", [("demo", "--quick"), ("run", str(EXAMPLE))])
def test_a_folder_that_cannot_be_is_told_before_anything_is_computed(tmp_path, monkeypatch, capsys, arguments):
    (tmp_path / "taken").write_text("a file")
    for owner, name in ((scenes.demonstration, "study"), (scenes, "run_scene")):
        monkeypatch.setattr(owner, name, lambda *_, **__: pytest.fail("computed"))
    assert main.main([*arguments, "--out", str(tmp_path / "taken")]) == 1
    told = capsys.readouterr().err
    assert str(tmp_path / "taken") in told
    assert "--out" in told
    assert main.main([*arguments, "--out", str(tmp_path / "taken" / "below")]) == 1
    assert "None" not in told + capsys.readouterr().err


def test_a_wrong_command_leaves_no_folder(tmp_path):
    command("run", EXAMPLE, "--set", "q=1", folder=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_an_error_without_a_file_names_none(tmp_path, monkeypatch, capsys):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(scenes, "run_scene", full)
    assert main.main(["run", str(EXAMPLE), "--out", str(tmp_path)]) == 1
    assert capsys.readouterr().err == "hapticlab: No space left on device\n"


@pytest.mark.wide
@pytest.mark.skipif(sys.platform == "win32", reason="Windows reports a closed pipe in another way")
def test_a_closed_pipe_ends_it_quietly(tmp_path):
    call = [sys.executable, "-m", "hapticlab", "run", str(EXAMPLE), "--json", "--duration", "0.1"]
    environment = os.environ | {"PYTHONPATH": str(Path(hl.__file__).parents[1])}
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(call, cwd=tmp_path, stdout=writer, stderr=subprocess.PIPE, text=True, env=environment)
    os.close(writer)
    assert done.returncode == 128 + 13  # as a shell reports SIGPIPE
    assert done.stderr == ""


def test_an_unwritable_folder_is_one_line(tmp_path):
    (tmp_path / "taken").write_text("a file")
    done = command("run", EXAMPLE, "--out", "taken", "--duration", "0.1", folder=tmp_path)
    assert done.returncode == 1
    assert "--out" in done.stderr
    assert "Traceback" not in done.stderr


def test_version_and_help(tmp_path):
    assert from_nothing("--version", folder=tmp_path).stdout.strip() == f"hapticlab {hl.__version__}"
    helped = command("-h", folder=tmp_path)
    assert helped.returncode == 0
    assert "demo" in helped.stdout
    for name, other in (("demo", "run"), ("run", "demo"), ("tradeoff", "run")):
        told = command(name, "-h", folder=tmp_path).stdout
        assert f"(default:hapticlab-{name})" in "".join(told.split())  # it breaks lines at a hyphen too
        assert f"hapticlab-{other}" not in told
    assert "run" in helped.stdout


CONSTANT = (
    "import hapticlab as hl\nf = hl.parameters('f', units='N')\n"
    "scene, duration = hl.Scene(force=f + 0*hl.x(hl.n), name='constant')(f=0.02), 0.2\n"
)


@pytest.fixture
def answering(monkeypatch):
    """Somebody at the terminal, who types these lines."""

    def types(*lines):
        rest = iter(lines)
        monkeypatch.setattr("builtins.input", lambda question: next(rest))
        monkeypatch.setattr(sys, "stdin", type("Terminal", (), {"isatty": staticmethod(lambda: True)})())

    return types


@pytest.mark.wide
def test_run_on_a_board_in_place_of_the_files_paddle(tmp_path):
    done = command("run", EXAMPLE, "--port", "sim://hapkit", "--T", "5e-4", "--duration", "0.3", "--json", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    facts = json.loads(done.stdout)
    assert facts["paddle"].startswith("host 0000, firmware")
    assert (facts["samples"], facts["program"]["T_s"]) == (600, 5e-4)
    assert facts["loop"]["period_max_s"] == 5e-4
    assert nameless({**facts, "loop": {k: a for k, a in facts["loop"].items() if k not in ("overruns", "lost")}}) == []
    assert all(Path(path).is_file() for path in facts["files"].values())
    told = command("run", EXAMPLE, "--port", "sim://hapkit", "--duration", "0.3", folder=tmp_path)
    assert "loop     step" in told.stdout
    assert "paddle is not used" not in told.stdout


def test_the_files_own_paddle_is_what_a_simulated_board_moves(tmp_path, capsys):
    """A push of 2 N against a spring of 100 N/m rests at 20 mm; the paddle that sim:// has of itself has no hand."""
    file = tmp_path / "pushed.py"
    file.write_text(
        "import hapticlab as hl\nscene = hl.wall()(k=100, x_o=0)\nduration = 2.0\n"
        "paddle = hl.SimulatedPaddle(m=0.05, b=2.0, T=2e-3, hand=hl.Hand(push=2.0))\n"
    )
    there = ["--port", "sim://hapkit", "--out", str(tmp_path), "--json"]
    assert main.main(["run", str(file), *there]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["program"]["T_s"] == 2e-3
    assert facts["chatter"]["rest_m"] == pytest.approx(0.02, rel=1e-3)
    assert facts["left_open"] == {}
    assert main.main(["run", str(file), *there, "--every", "5"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert (facts["samples"], facts["duration_s"], facts["energy"]) == (200, 2.0, None)
    assert "one sample in 5" in facts["left_open"]["energy"]


def test_the_paddle_of_a_profiles_file_in_the_hand_of_the_scene_file(tmp_path, capsys):
    """Held by a spring of 50 N/m at rest 20 mm inside a wall of 50 N/m, any paddle rests at 10 mm, a heavy one as well."""
    heavy = hl.devices.PaddleProfile("bench 7", m=0.2, b=2.0, T=2e-3).save(tmp_path / "bench7.json")
    (tmp_path / "held.py").write_text(
        "import hapticlab as hl\nscene = hl.wall()(k=50, x_o=0)\nduration = 2.0\n"
        "paddle = hl.SimulatedPaddle(m=0.05, b=2.0, T=1e-3, hand=hl.Hand(m=0.1, b=3, k=50, intent=0.02))\n"
    )
    there = ["--out", str(tmp_path), "--json"]
    for given, period in (["--paddle", heavy], 2e-3), (["--port", f"sim://{heavy}"], 1e-3):
        assert main.main(["run", str(tmp_path / "held.py"), *map(str, given), *there]) == 0
        facts = json.loads(capsys.readouterr().out)
        assert facts["program"]["T_s"] == period and facts["chatter"]["rest_m"] == pytest.approx(0.01, rel=1e-3)
        assert "m = 0.2 kg" in facts["paddle"] or facts["paddle"].startswith("host")
    assert (
        main.main(["share", str(tmp_path / "held.py"), "--paddle", str(heavy), "--out", str(tmp_path / "a.html"), "--code"]) == 0
    )
    assert "# shared with --paddle bench7.json" in (tmp_path / "a.html").read_text("utf-8")
    with pytest.raises(SystemExit):
        main.main(["run", str(tmp_path / "held.py"), "--paddle", "falcon"])
    assert "no profile 'falcon'; there are hapkit" in capsys.readouterr().err


def test_on_another_board_the_files_paddle_is_not_used_and_that_is_said(tmp_path, monkeypatch, capsys):
    simulated = board_command.connect
    monkeypatch.setattr(board_command, "connect", lambda port, T, paddle: simulated("sim://hapkit", T=T, paddle=paddle))
    assert main.main(["run", str(EXAMPLE), "--port", "COM3", "--yes", "--duration", "0.1", "--out", str(tmp_path)]) == 0
    told = "The scene file's paddle is not used, but for its T = 0.001 s: COM3 has its own.\n"
    assert told in capsys.readouterr().out


@pytest.mark.parametrize("option", [("--yes",), ("--every", "5")])
def test_what_is_for_a_board_needs_one(capsys, option):
    with pytest.raises(SystemExit) as wrong:
        main.main(["run", str(EXAMPLE), *option])
    assert wrong.value.code == 2
    assert f"{option[0]} is for a board; name its port with --port" in capsys.readouterr().err


def test_a_number_of_ticks_is_whole(capsys):
    for text in ("0", "-2", "1.5", "all"):
        with pytest.raises(SystemExit):
            main.main(["run", str(EXAMPLE), "--port", "sim://hapkit", f"--every={text}"])
        assert f"{text!r} is not a number of ticks" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("/dev/no-such-port", "no such port"),
        ("sim://nobody", "no such paddle"),
        ("socket://127.0.0.1:1", "no program answers there"),
        ("magic://x", "the scheme 'magic' is not known"),
    ],
)
def test_a_board_that_is_not_there_is_one_sentence(tmp_path, url, words):
    done = command("run", EXAMPLE, "--port", url, "--yes", folder=tmp_path)
    assert done.returncode == 1
    assert words in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr


def test_a_motor_is_not_moved_unasked(tmp_path, monkeypatch, capsys, answering):
    monkeypatch.setattr(board_command, "connect", lambda *_, **__: pytest.fail("connected"))
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    there = ["--out", str(tmp_path), "--port", "/dev/ttyACM0"]
    for arguments in (["run", str(EXAMPLE), *there], ["calibrate"]):
        assert main.main(arguments) == 1
        assert "Nobody can be asked here: give --yes" in capsys.readouterr().err
    answering("no")
    assert main.main(["run", str(EXAMPLE), *there]) == 1
    told = capsys.readouterr()
    assert "The motor of /dev/ttyACM0 will move the handle for 3 s" in told.out
    assert told.err == "hapticlab: nothing was done\n"


def test_ctrl_c_leaves_the_motor_off_and_says_so(tmp_path, monkeypatch, capsys):
    file, boards = tmp_path / "constant.py", []
    file.write_text(CONSTANT)
    connected = board_command.connect

    def interrupted(*arguments, **options):
        paddle = connected(*arguments, **options)
        wait = paddle.exchange.wait

        def by_a_person(condition, seconds):
            if paddle.exchange.port.board.duty == 0:
                return wait(condition, 0.02)
            boards.append((paddle.exchange.port.board, paddle.exchange.port.board.duty))
            raise KeyboardInterrupt

        paddle.exchange.wait = by_a_person
        return paddle

    monkeypatch.setattr(board_command, "connect", interrupted)
    assert main.main(["run", str(file), "--port", "sim://hapkit", "--out", str(tmp_path)]) == 130
    told = capsys.readouterr().err
    assert told.startswith("hapticlab: interrupted; the motor is off. No samples are kept")
    ((board, duty),) = boards
    assert duty != 0
    assert board.duty == 0


def test_ports_says_which_are_asked(monkeypatch, capsys):
    found = [Port("COM3", known="Arduino Uno R3"), Port("COM9", "a mill")]
    monkeypatch.setattr(board_command, "available_ports", lambda: found)
    assert main.main(["ports"]) == 0
    uno, mill = capsys.readouterr().out.splitlines()
    assert "Arduino Uno R3" in uno and "asked by connect()" in uno
    assert "a mill" in mill and "left alone" in mill
    assert main.main(["ports", "--json"]) == 0
    assert [port["device"] for port in json.loads(capsys.readouterr().out)] == ["COM3", "COM9"]


def test_doctor_walks_without_a_board_and_with_one(capsys):
    assert main.main(["doctor", "--port", "/dev/no-such-port"]) == 1
    assert "no such port" in capsys.readouterr().out
    assert main.main(["doctor", "--port", "sim://hapkit", "--no-person"]) == 0
    told = capsys.readouterr().out
    assert "ok         firmware" in told
    assert "what needs a person at the handle was skipped" in told
    assert main.main(["doctor", "--port", "sim://hapkit", "--json"]) == 0
    assert {check["state"] for check in json.loads(capsys.readouterr().out)} <= {"ok", "attention", "skipped"}
    assert main.main(["doctor", "--port", "sim://xx", "--json"]) == 1
    assert [check["state"] for check in json.loads(capsys.readouterr().out)][-2:] == ["ok", "fault"]


def test_doctor_asks_nobody_to_move_a_simulated_handle(answering, capsys):
    answering()  # whoever is asked finds no line to type
    assert main.main(["doctor", "--port", "sim://hapkit"]) == 0
    assert "what needs a person at the handle was skipped" in capsys.readouterr().out


def test_flash_takes_the_only_board_or_the_one_named(monkeypatch, capsys):
    written, found = [], [Port("COM3", known="Arduino Uno R3"), Port("COM9", "a mill")]
    monkeypatch.setattr(board_command, "available_ports", lambda: found)

    def writes(port, image, board, tell):
        tell(port)
        written.append((port, image, board))
        return "written"

    asked = []
    monkeypatch.setattr(board_command, "before_flash", lambda *given, tell: asked.append(given))
    monkeypatch.setattr(board_command, "write_firmware", writes)
    assert main.main(["flash"]) == 0
    assert main.main(["flash", "--board", "uno", "--port", "COM9", "--image", "own.hex"]) == 0
    assert written == [("COM3", None, "uno"), ("COM9", "own.hex", "uno")]
    assert asked == [("COM3", "uno", None), ("COM9", "uno", None)]  # nobody is at this terminal
    assert capsys.readouterr() == ("written\nwritten\n", "COM3\nCOM9\n")
    found.append(Port("COM4", known="Arduino Uno R3"))
    assert main.main(["flash"]) == 1
    assert "known boards: COM3, COM4; say which" in capsys.readouterr().err
    assert main.main(["flash", "--board", "mill"]) == 1
    assert "board = 'mill'; this package has firmware for uno, pico." in capsys.readouterr().err


PICO_PORT = Port("COM7", known="Raspberry Pi Pico", vid=0x2E8A, pid=0x000A)


@pytest.mark.parametrize(
    ("found", "given", "drives", "board", "port"),
    [
        ([PICO_PORT], [], [], "pico", "COM7"),
        ([PICO_PORT, Port("COM8", known="Raspberry Pi Pico", vid=0x2E8A, pid=0x000A)], ["--port", "COM7"], [], "pico", "COM7"),
        ([PICO_PORT, Port("COM3", known="Arduino Uno R3")], ["--port", "COM3"], [], "uno", "COM3"),
        ([], [], ["/media/RPI-RP2"], "pico", None),  # a new one, with its button held
        ([Port("COM3", known="Arduino Uno R3")], [], ["/media/RPI-RP2"], "uno", "COM3"),
    ],
)
def test_flash_knows_a_pico_by_its_port_or_its_drive(monkeypatch, found, given, drives, board, port):
    written = []
    monkeypatch.setattr(board_command, "available_ports", lambda: found)
    monkeypatch.setattr(board_command, "waiting_boards", lambda name: drives)
    monkeypatch.setattr(board_command, "before_flash", lambda *given, tell: None)
    monkeypatch.setattr(board_command, "write_firmware", lambda port, image, board, tell: written.append((board, port)))
    monkeypatch.setattr(board_command, "copy_firmware", lambda image, board, port, tell: written.append((board, port)))
    assert main.main(["flash", *given]) == 0
    assert written == [(board, port)]


def test_calibrate_is_rehearsed_without_a_board(capsys):
    assert main.main(["calibrate", "--practice", "loose wire", "--only", "wiring"]) == 0
    told = capsys.readouterr().out
    assert "only one line of the encoder arrives. Check A on D2 and B on D3" in told and "Confirmed." in told


def test_the_drawing_of_a_wiring_is_a_file_for_a_person_at_a_terminal(tmp_path, monkeypatch):
    monkeypatch.setattr(board_command.tempfile, "gettempdir", lambda: str(tmp_path))
    where = board_command.PersonWithPictures().picture(build("l298"))
    assert "ENA" in Path(where).read_text("utf-8") and Path(where).parent == tmp_path


def test_calibrate_stores_what_the_person_agreed_to(monkeypatch, capsys):
    paddle = workbench.paddle(store=nominal("hapkit", ident=9).to_bytes())
    person = workbench.Scripted(paddle, workbench.STOPS | {"Store these settings": "yes", "Go on?": "yes"})
    monkeypatch.setattr(board_command, "connect", lambda port: paddle)
    monkeypatch.setattr(board_command, "PersonWithPictures", lambda: person)
    monkeypatch.setattr(sys, "stdin", type("Terminal", (), {"isatty": staticmethod(lambda: True)})())
    assert main.main(["calibrate", "--only", "stops"]) == 0
    assert paddle.settings.date >= 20261121
    assert "The motor will pull the handle" in person.words
    with pytest.raises(SystemExit) as wrong:
        main.main(["calibrate", "--only", "mass"])
    assert wrong.value.code == 2


def test_calibrate_refuses_a_simulated_board(answering, capsys):
    answering()
    assert main.main(["calibrate", "--port", "sim://hapkit", "--only", "stops"]) == 1
    told = capsys.readouterr().err
    assert told == (
        "hapticlab: sim://hapkit has no handle to lead. Calibrate a board that is plugged in, or rehearse it on a simulated "
        "one: hapticlab calibrate --practice\n"
    )


# ---------------------------------------------------------------- speed against accuracy

SPRING = """
import hapticlab as hl
k = hl.parameters("k", units="N/m", values=150)
scene = hl.Scene(force=k * hl.x(hl.n), name="spring")
paddle = hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3, counts_per_metre=1e5)
"""


@pytest.mark.parametrize("given", [["--tolerance", "0"], ["--load", "nan"], ["--tolerance", "much"]])
def test_tradeoff_wants_parts(given, capsys):
    with pytest.raises(SystemExit):
        main.main(["tradeoff", "spring.py", *given])
    assert f"{given[1]!r} is not a fraction; give a number greater than 0" in capsys.readouterr().err


@pytest.mark.wide
def test_tradeoff_prints_what_it_chose_and_draws_it(tmp_path):
    (tmp_path / "spring.py").write_text(SPRING)
    done = command("tradeoff", "spring.py", "--T", "2e-3", "1e-3", "--targets", "uno", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "hl.compile(scene, method='rk4', T=0.002," in done.stdout and "rows that no other row beats" in done.stdout
    assert (tmp_path / "hapticlab-tradeoff" / "spring-tradeoff.png").read_bytes().startswith(PNG)
    with open(tmp_path / "hapticlab-tradeoff" / "spring-tradeoff.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(float(row["T"]), row["passive"]) for row in rows] == [(2e-3, "True"), (1e-3, "True")]


@pytest.mark.wide
def test_tradeoff_says_as_json_what_to_relax(tmp_path, capsys):
    path = tmp_path / "stiff.py"
    path.write_text(SPRING.replace("150", "900"))
    there = ["--T", "1e-3", "--targets", "uno", "--json", "--out", str(tmp_path)]
    assert main.main(["tradeoff", str(path), *there]) == 0
    facts = json.loads(capsys.readouterr().out)
    answer = facts["chosen"]["uno"]
    assert answer["feasible"] is False and facts["rows"] == 1
    assert "b >= 0.45 N s/m (this one has 0.3 N s/m)" in answer["relax"][0]  # k T/2
    assert main.main(["tradeoff", str(path), "--any-hand", *there]) == 0
    assert json.loads(capsys.readouterr().out)["chosen"]["uno"]["options"]["T"] == 1e-3


# ---------------------------------------------------------------- what the parser names without opening it


def test_the_names_that_options_offer_are_those_that_the_modules_define():
    assert options.TARGETS[0] == PC
    assert options.STEPS == STEPS and options.TROUBLES == TROUBLES


def test_every_command_is_a_function_that_is_there():
    commands = options.parser().commands
    assert {name: callable(main._command(one.get_default("command"))) for name, one in commands.items()} == dict.fromkeys(
        [
            "demo",
            "labs",
            "lab",
            "assign",
            "grade",
            "concepts",
            "run",
            "tradeoff",
            "share",
            "ports",
            "doctor",
            "flash",
            "calibrate",
            "bench",
            "site",
            "wheels",
            "guide",
        ],
        True,
    )
