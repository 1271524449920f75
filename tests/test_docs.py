"""What the documents promise: the code of README and of docs/ runs, and README's two commands are the ones CI runs."""

import importlib.util
import re
import shlex
import subprocess
from pathlib import Path

import pytest
from builder.running.examples import run
from matplotlib.image import imread

import hapticlab as hl
from hapticlab.cli.main import main
from hapticlab.cli.options import parser
from hapticlab.vocabulary import PAGES, public

pytestmark = pytest.mark.interpreter

ROOT = Path(__file__).parents[1]
#: its searches take minutes where the interpreter is the only engine
LONG = "docs/how_to/measuring.md"
README = (ROOT / "README.md").read_text("utf-8")
#: the pages for users, which README held until version 0.2; their examples run one after the other
MANUAL = [
    f"docs/{folder}/{name}.md"
    for folder, names in {
        "how_to": ("scenes", "live", "sharing", "browser", "measuring", "systems"),
        "teaching": ("site",),
        "explanation": ("methods", "limits", "people", "engines"),
        "paddle": ("boards", "two_paddles", "owners_guide", "bring_up_card", "faults", "SAFETY"),
    }.items()
    for name in names
]
PAGES_THAT_RUN = ["README.md", *(path for path in MANUAL if "```python" in (ROOT / path).read_text("utf-8"))]


def blocks(language, *paths):
    texts = [(ROOT / path).read_text("utf-8") for path in paths]
    return [block for text in texts for block in re.findall(rf"^```{language}\n(.*?)^```", text, re.M | re.S)]


COMMANDS = "".join(blocks("sh", "README.md", *MANUAL)).splitlines()


def run_page(path):
    """A page whose examples ran, by what runs them for the site."""
    return run((ROOT / path).read_text("utf-8"), path)


def test_readme_python_runs(capsys):
    page = run_page("README.md")
    printed = page.printed
    assert printed.startswith("growing") and "9.479 contacts/s" in printed
    assert "\n200 N/m" in printed  # 2 b/T of this paddle, Eq. (23.10)
    assert "\n200.067 N/m" in printed  # its eigenvalues: 2 b/T (1 + b T/(6 m)), within 1e-6
    (example,) = blocks("python", "README.md")
    soft = example.replace("k=500", "k=150")  # "Change k to 150: the oscillation dies out."
    assert soft != example
    exec(compile(soft, "README.md", "exec"), page.names)
    assert capsys.readouterr().out.startswith("decaying")


def test_the_picture_of_readme_is_that_of_its_example(tmp_path):
    """Of this size, and the same to the eye: fonts differ by a pixel between releases of matplotlib."""
    spec = importlib.util.spec_from_file_location("readme_picture", ROOT / "tests" / "benchmarks" / "readme_picture.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    script.draw(tmp_path / "chatter.png")
    shown, drawn = (imread(path) for path in (script.PICTURE, tmp_path / "chatter.png"))
    assert shown.shape == drawn.shape
    assert abs(shown - drawn).mean() < 0.01
    assert script.PICTURE.stat().st_size < 60_000


def test_scenes_run():
    page = run_page("docs/how_to/scenes.md")
    names, printed = page.names, page.printed
    assert names["log"].x.shape == (20_000,)
    assert names["grid"].values.shape == (200, 3)
    assert names["program"].outputs[0].name == "F"
    assert "200 N/m" in printed  # 2 b/T of this paddle, Eq. (23.10)
    assert "200.067 N/m" in printed  # its eigenvalues: 2 b/T (1 + b T/(6 m)), within 1e-6
    assert abs(hl.records.balance(names["bounced"]).leak).max() < 1e-6  # J of 20 mJ: the handle is known at samples only
    assert names["lost"] == pytest.approx(150 * 3e-3 * 8e-3, rel=0.02)  # J: a spring shorter by d on the way back from x_on
    assert "latch, T = 1 ms: no motion was found" in printed and "pen, T = 1 ms: not passive" in printed
    assert "theta  state" in printed  # what the pendulum requires


def test_boards_run():
    page = run_page("docs/paddle/boards.md")
    # 2 N over 10 mm and on into 150 N/m: without damping 75 d^2 = 2 (0.01 + d), so 150 d = 5.16 N
    assert "at most 5.1 N" in page.printed
    assert page.names["felt"].F.max() > 0


@pytest.mark.parametrize(
    "path", [path for path in PAGES_THAT_RUN if path not in ("README.md", "docs/how_to/scenes.md", "docs/paddle/boards.md", LONG)]
)
@pytest.mark.always("docs/*/[!m]*")  # methods.md tries 396 settings, which takes two seconds
def test_pages_run(path):
    assert any(example.printed or example.figures or example.views for example in run_page(path).examples)


@pytest.mark.machine_code
def test_a_long_page_runs():
    assert run_page(LONG).printed


def test_pages_have_lines_that_fit_and_look_before_they_pull():
    lines = [line for path in ("README.md", "docs/README.md", *MANUAL) for line in (ROOT / path).read_text("utf-8").splitlines()]
    assert [line for line in lines if len(line) > 132 and line[:1] not in ("|", ">")] == []
    boards = (ROOT / "docs/paddle/boards.md").read_text("utf-8")
    order = [boards.index(f"hapticlab {command}\n") for command in ("flash", "doctor", "bench", "calibrate --only force")]
    assert order == sorted(order)  # every stop is tried before more force


def test_readme_is_two_screens():
    assert len(README.splitlines()) <= 85
    assert 10 <= len([line for line in blocks("python", "README.md")[0].splitlines() if line]) <= 14


def test_the_index_lists_every_page():
    index = (ROOT / "docs" / "README.md").read_text("utf-8")
    docs = ROOT / "docs"
    pages = {path.relative_to(docs).as_posix() for path in docs.rglob("*.md")} - {"README.md"}
    pages = {page for page in pages if not page.endswith("index.md")}
    pages -= {page for page in pages if page.startswith("papers/") and page != "papers/README.md"}  # listed there
    assert sorted(re.findall(r"^\| \[([\w./]+)\]\(\1\) \|", index, re.M)) == sorted(pages)


@pytest.mark.parametrize("path", ["README.md", "docs/README.md", *MANUAL])
def test_links_lead_somewhere(path):
    links = re.findall(r"\]\(([^)#]+)(?:#[\w-]*)?\)", (ROOT / path).read_text("utf-8"))
    assert [link for link in links if not (ROOT / path).parent.joinpath(link).exists()] == []


def test_readme_begins_with_the_two_commands():
    demo, tests = (block.strip() for block in blocks("sh", "README.md")[:2])
    assert demo.endswith("hapticlab demo")
    assert tests.endswith("pytest")
    assert "\n" not in demo + tests
    assert README.index(tests) < README.index("## ")


@pytest.mark.parametrize("ending", ["hapticlab demo", "pytest"])
def test_ci_runs_what_readme_says(ending):
    script = "".join((ROOT / ".ci" / name).read_text("utf-8") for name in ("prepare", "run"))
    (line,) = re.findall(rf"^\w+=\$\((grep .*{ending}\$.*README.md)\)$", script, re.M)
    found = subprocess.run(shlex.split(line), cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    assert found in (block.strip() for block in blocks("sh", "README.md")[:2])
    name = re.search(rf"^(\w+)=.*{ending}\$", script, re.M)[1]
    halves = f'eval "${{{name}% && *}}"', f'eval "${{{name}##* && }}"'  # installed beside other steps, then run
    assert f'eval "${name}"' in script or all(half in script for half in halves)


def test_the_command_of_a_scene_file_runs(tmp_path, capsys):
    (command,) = (shlex.split(line) for line in COMMANDS if "run" in line and "--port" not in line)
    command = [str(ROOT / word) if word.endswith(".py") else word for word in command[1:]]
    assert main([*command, "--out", str(tmp_path)]) == 0
    assert "K = 500" in capsys.readouterr().out


@pytest.mark.parametrize("line", [line for line in COMMANDS if "&&" not in line])
def test_commands_are_understood(line):
    program, *arguments = shlex.split(line)
    assert Path(program).name == "hapticlab"
    module, _, function = parser().parse_args(arguments).command.rpartition(".")
    assert callable(getattr(importlib.import_module(f"hapticlab.{module}"), function))


def test_the_command_of_a_board_runs_on_a_simulated_one(tmp_path, capsys):
    (command,) = (shlex.split(line) for line in COMMANDS if "run" in line and "--port" in line)
    command = [str(ROOT / word) if word.endswith(".py") else word for word in command[1:]]
    command[command.index("--port") + 1] = "sim://hapkit"
    assert main([*command, "--duration", "0.2", "--out", str(tmp_path)]) == 0
    assert "host 0000, firmware" in capsys.readouterr().out


def test_public_names_are_documented_and_exist():
    assert sorted(hl.__all__) == hl.__all__
    assert len(hl.__all__) <= 46
    pages = [getattr(hl, name).__all__ for name in PAGES]  # ruff keeps them in order, constants first
    assert all(len(set(names)) == len(names) for names in pages)
    assert len(public()) > 180
    assert not [name for name, value in public().items() if callable(value) and not value.__doc__]
    for text in (README, (ROOT / "docs/how_to/systems.md").read_text("utf-8")):
        assert f"Version {'.'.join(hl.__version__.split('.')[:2])}, emulated only" in text
    assert f'version: "{hl.__version__}"' in (ROOT / "CITATION.cff").read_text("utf-8")


def test_files_named_in_the_documents_exist():
    contributing = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    texts = [contributing, *((ROOT / path).read_text("utf-8") for path in ("README.md", *MANUAL))]
    named = set(re.findall(r"`((?:tests|firmware|hapticlab|docs|\.ci)/[\w/.]+)`", "".join(texts)))
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
