"""What the documents promise: README's code runs, and its two commands are the ones CI runs."""

import importlib
import re
import shlex
import subprocess
from pathlib import Path

import pytest

import hapticlab as hl
from hapticlab.cli.main import main
from hapticlab.cli.options import parser
from hapticlab.vocabulary import PAGES, public

pytestmark = pytest.mark.interpreter

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text("utf-8")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.M | re.S)


def test_readme_python_runs(capsys):
    names = {}
    for block in blocks("python"):
        exec(compile(block, "README.md", "exec"), names)
    assert names["log"].x.shape == (20_000,)
    assert names["grid"].values.shape == (200, 3)
    assert names["program"].outputs[0].name == "F"
    printed = capsys.readouterr().out
    assert "200 N/m" in printed  # 2 b/T of this paddle, Eq. (23.10)
    assert "200.067 N/m" in printed  # its eigenvalues: 2 b/T (1 + b T/(6 m)), within 1e-6
    # 2 N over 10 mm and on into 150 N/m: without damping 75 d^2 = 2 (0.01 + d), so 150 d = 5.16 N
    assert "at most 5.1 N" in printed
    assert names["felt"].F.max() > 0
    assert abs(hl.records.balance(names["bounced"]).leak).max() < 1e-6  # J of 20 mJ: the handle is known at samples only
    assert "theta  state" in printed  # what the pendulum requires


def test_readme_has_lines_that_fit_a_page_and_looks_before_it_pulls():
    assert [line for line in README.splitlines() if len(line) > 125 and line[:1] != "|"] == []
    assert README.index("hapticlab flash\n") < README.index("hapticlab doctor\n") < README.index("hapticlab calibrate\n")


def test_readme_begins_with_the_two_commands():
    demo, tests = (block.strip() for block in blocks("sh")[:2])
    assert demo.endswith("hapticlab demo")
    assert tests.endswith("pytest")
    assert "\n" not in demo + tests
    assert README.index(tests) < README.index("## ")


@pytest.mark.parametrize("ending", ["hapticlab demo", "pytest"])
def test_ci_runs_what_readme_says(ending):
    script = "".join((ROOT / ".ci" / name).read_text("utf-8") for name in ("prepare", "run"))
    (line,) = re.findall(rf"^\w+=\$\((grep .*{ending}\$.*README.md)\)$", script, re.M)
    found = subprocess.run(shlex.split(line), cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    assert found in (block.strip() for block in blocks("sh")[:2])
    name = re.search(rf"^(\w+)=.*{ending}\$", script, re.M)[1]
    halves = f'eval "${{{name}% && *}}"', f'eval "${{{name}##* && }}"'  # installed beside other steps, then run
    assert f'eval "${name}"' in script or all(half in script for half in halves)


def test_readme_command_of_a_scene_file_runs(tmp_path, capsys):
    (command,) = (shlex.split(line) for line in "".join(blocks("sh")).splitlines() if "run" in line and "--port" not in line)
    command = [str(ROOT / word) if word.endswith(".py") else word for word in command[1:]]
    assert main([*command, "--out", str(tmp_path)]) == 0
    assert "K = 500" in capsys.readouterr().out


@pytest.mark.parametrize("line", [line for line in "".join(blocks("sh")).splitlines() if "&&" not in line])
def test_readme_commands_are_understood(line):
    program, *arguments = shlex.split(line)
    assert Path(program).name == "hapticlab"
    module, _, function = parser().parse_args(arguments).command.rpartition(".")
    assert callable(getattr(importlib.import_module(f"hapticlab.{module}"), function))


def test_readme_runs_on_a_simulated_board(tmp_path, capsys):
    (command,) = (shlex.split(line) for line in "".join(blocks("sh")).splitlines() if "run" in line and "--port" in line)
    command = [str(ROOT / word) if word.endswith(".py") else word for word in command[1:]]
    command[command.index("--port") + 1] = "sim://hapkit"
    assert main([*command, "--duration", "0.2", "--out", str(tmp_path)]) == 0
    assert "host 0000, firmware" in capsys.readouterr().out


def test_public_names_are_documented_and_exist():
    assert sorted(hl.__all__) == hl.__all__
    assert len(hl.__all__) <= 45
    assert all(page.__all__ == sorted(page.__all__) for page in (getattr(hl, name) for name in PAGES if name != "library"))
    assert len(public()) > 180
    assert not [name for name, value in public().items() if callable(value) and not value.__doc__]
    assert f"Version {'.'.join(hl.__version__.split('.')[:2])}," in README


def test_files_named_in_the_documents_exist():
    contributing = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    named = set(re.findall(r"`((?:tests|firmware|hapticlab|docs|\.ci)/[\w/.]+)`", README + contributing))
    named = {path for path in named if "NAME" not in path and "NN_name" not in path}
    named |= {f"hapticlab/{path}" for path in re.findall(r"^\| `[^|]+\| `([\w/]+\.py)`", contributing, re.M)}
    assert len(named) >= 5
    assert [path for path in sorted(named) if not (ROOT / path).exists()] == []


def test_the_map_shows_every_room():
    contributing = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    table = contributing[contributing.index("| room of") : contributing.index("| question |")]
    rooms = {path.stem for path in (ROOT / "hapticlab").iterdir() if path.name[0] not in "_." and path.suffix in ("", ".py")}
    assert rooms - {"examples", "labs", "firmware"} == {
        name.rstrip("/") for row in re.findall(r"^\| (`[^|]+) \|", table, re.M) for name in re.findall("`([a-z_]+/?)`", row)
    }


def test_a_misspelt_name_is_answered_with_those_that_come_near():
    with pytest.raises(AttributeError, match=r"hapticlab has no Contac; did you mean hl.contact.Contact\?"):
        hl.Contac  # noqa: B018
    with pytest.raises(AttributeError, match=r"did you mean hl.mechanics.lagrange\?"):
        hl.Lagrange  # noqa: B018
    with pytest.raises(AttributeError, match=r"hapticlab has no zzzz; hl.find"):
        hl.zzzz  # noqa: B018
