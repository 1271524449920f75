"""A site of the labs in Chromium: a lab opens and runs, a view moves, and a downloaded notebook earns what it should.

Nothing but the site may be asked: every request beyond its address is refused and fails the test.
"""

import json
import os
import re
import time
from functools import partial
from pathlib import Path
from zipfile import ZipFile

import pytest
from axe import findings
from lab import ask, grab, picture, run_all, run_cell, see, until
from pyodide_archive import archive
from sites import Open, Quiet, open_lab, served, serving, visited, watched

import hapticlab as hl
from hapticlab.cli.main import main
from hapticlab.course.instructor import solved_notebook
from hapticlab.course.labs import find_labs
from hapticlab.site.build import RECORD, build_site
from hapticlab.site.front_page import front_page
from hapticlab.site.licences import parts, without_text
from hapticlab.site.pages import PAGES
from hapticlab.widgets.session import A_CELL_RUNS

STATUS = ".hl-status"
ANSWERS = Path(__file__).parents[1] / "instructor"
FIRST = "import numpy as np"
# Counts the pictures that differ from the one before, from now on.
COUNT = """() => {
  const canvas = document.querySelector("canvas.hl-stage"), context = canvas.getContext("2d")
  window.shown = { pictures: 0, from: performance.now() }
  let before = 0
  canvas.parentElement.addEventListener("painted", () => {
    const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data
    let sum = 0
    for (let i = 0; i < pixels.length; i += 52) sum = (31 * sum + pixels[i]) | 0
    if (sum !== before) window.shown.pictures += 1
    before = sum
  })
}"""


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A site in a folder with files of somebody else, and with one of an earlier site; and what the build says."""
    folder, said = tmp_path_factory.mktemp("site") / "site", []
    before = {".git/HEAD": "mine", "CNAME": "mine", "old.js": "old", RECORD: json.dumps({"files": ["old.js", "index.html"]})}
    for name, text in before.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return build_site(folder, pyodide=archive(), say=said.append), said


@pytest.fixture(scope="module")
def site(built):
    with served(built[0].folder) as address:
        yield address


@pytest.fixture
def page(complete, browser, site):
    with visited(browser) as opened:
        yield opened


def cells(page):
    """The source of every cell of the open notebook."""
    return page.evaluate(
        "() => window.jupyterapp.shell.currentWidget.content.widgets.map((c) => c.model.sharedModel.getSource())"
    )


def download(page, folder):
    """Save the notebook and download it, by the menu; return the file."""
    for entry in ("docmanager:save", "docmanager:download"):
        page.locator("li.lm-MenuBar-item:has-text('File')").click()
        item = page.locator(f"li.lm-Menu-item[data-command='{entry}']")
        if entry == "docmanager:save":
            item.click()
        else:
            with page.expect_download() as coming:
                item.click()
    path = folder / coming.value.suggested_filename
    coming.value.save_as(path)
    return path


def begin(page, code):
    """Have the kernel run code, and wait for nothing."""
    page.evaluate(
        "(code) => void window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.requestExecute({ code })", code
    )


def points(path, capsys):
    """What `hapticlab grade` says of a notebook of lab 02."""
    assert main(["grade", str(path), "--instructor", str(ANSWERS), "--sandbox", "namespaces"]) == 0
    return re.search(r"(\S+) of 10 points", capsys.readouterr().out)[1]


def compiled(folder):
    """The folders of compiled libraries in the wheels of a site."""
    found = (ZipFile(path).namelist() for path in folder.glob("static/pyodide/*.whl"))
    return {name.partition("/")[0] for names in found for name in names if name.endswith(".so")}


@pytest.mark.wide
@pytest.mark.long
def test_a_site_has_the_labs_what_they_need_and_a_licence_text_for_every_file(built):
    made, said = built
    found = {path.relative_to(made.folder).as_posix(): path for path in made.folder.rglob("*") if path.is_file()}
    others = {".git/HEAD", "CNAME"}
    assert "old.js" not in found and {found.pop(name).read_text() for name in others} == {"mine"}
    recorded = json.loads(found[RECORD].read_text("utf-8"))["files"]
    assert set(found) == {*recorded, RECORD} and made.files == len(found)
    assert [words.partition(",")[0] for words in said] == [
        f"Pyodide of {archive()}", "hapticlab and 0 packages that it needs", f"JupyterLite with {len(find_labs())} labs",
        f"{len(PAGES)} pages that need no Python",
    ]  # fmt: skip
    for lab in find_labs():
        for path in (lab.notebook, lab.path / "checks.py"):
            assert found[f"files/{lab.name}/{path.name}"].read_bytes() == path.read_bytes()
    assert not [name for name in found if "solution" in name or "hidden.py" in name or name.endswith(".map")]
    assert [name for name in without_text(parts(made.folder)) if name not in others] == []
    texts = {path.stem.rstrip("-0123456789"): path.read_text("utf-8") for path in (made.folder / "licences").glob("*.txt")}
    inside = {
        "scipy": "OpenBLAS",
        "matplotlib": "Bitstream Vera",
        "pillow": "Independent JPEG Group",
        "numpy": "Max-Planck-Society",
    }
    assert all(words in texts[name] for name, words in inside.items())
    assert all("The FreeType Project" in " ".join(texts[name].split()) for name in ("matplotlib", "pillow"))
    assert {name for name in compiled(made.folder) if name.endswith(".libs")} == {"scipy.libs"}  # licences.LIBRARIES has its text


@pytest.mark.wide
def test_a_lab_opens_from_the_first_page(page, site):
    open_lab(page, site, "02")
    assert page.locator(".jp-Notebook h1").first.text_content().startswith("Lab 02: The virtual wall")


@pytest.mark.slow
@pytest.mark.parametrize("lab", find_labs(), ids=lambda lab: lab.number)
def test_the_first_cell_of_every_lab_runs_as_it_is(page, site, lab):
    open_lab(page, site, lab.number)
    first = next(source for source in cells(page) if "import hapticlab as hl" in source)
    assert "Error" not in run_cell(page, first)
    seen = ask(page, "import os; print(os.getcwd(), *sorted(os.listdir()), hl.__version__)")
    assert seen == f"/drive/{lab.name} {lab.notebook.name} checks.py {hl.__version__}"  # so that a check reads the lab's own


@pytest.mark.wide
def test_no_request_beyond_the_site_stays_unseen(complete, browser, site):
    with watched(browser) as (page, asked):
        page.goto(f"{site}/index.html")
        page.evaluate("() => fetch('http://elsewhere.example/a').catch(() => {})")
        worker = "fetch(`https://elsewhere.example/b`).catch(() => postMessage(1))"
        page.evaluate(
            """(code) => new Promise((done) => {
                new Worker(URL.createObjectURL(new Blob([code]))).onmessage = () => done()
            })""",
            worker,
        )
    assert asked[0] == "http://elsewhere.example/a" and set(asked[1:]) == {"elsewhere.example:443"}


@pytest.mark.slow
def test_by_default_python_comes_from_an_address_of_its_own_and_the_rest_from_the_site(complete, browser, tmp_path):
    """Another server plays the address of Pyodide, which no test asks; it has more packages than a page may ask for."""
    build_site(tmp_path / "site", say=lambda words: None)
    asked = []

    class Pyodide(Open):
        def do_GET(self):
            asked.append(self.path)
            super().do_GET()

    with serving(partial(Pyodide, directory=archive())) as other:
        pyodide = f"http://127.0.0.1:{other.server_port}"
        with served(tmp_path / "site", pyodide) as address, visited(browser) as page:
            open_lab(page, address, "02")
            assert "m = 0.03 kg" in run_cell(page, FIRST)
    assert {"/pyodide.mjs", "/pyodide.asm.wasm", "/pyodide-lock.json"} <= set(asked)
    assert {"numpy", "scipy", "sympy"} <= {path[1:].partition("-")[0] for path in asked}
    assert not {path for path in asked if path.startswith(("/pint-", "/anywidget-", "/hapticlab-"))}


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_view_moves_in_the_browser(complete, browser, site, scheme):
    with visited(browser, color_scheme=scheme) as page:
        open_lab(page, site, "02")
        for beginning in (FIRST, "wall = hl.wall()", "view = hl.live(paddle"):
            run_cell(page, beginning)
        page.wait_for_selector(".hl-stage")
        see(page, ".hl-stage")
        x, y = grab(page, ".hl-stage")
        page.evaluate(COUNT)
        for k in range(240):
            page.mouse.move(x + 60 * (1 - abs(k % 80 - 40) / 20), y)
            page.wait_for_timeout(16)
        shown = page.evaluate("() => ({ ...window.shown, until: performance.now() })")
        page.mouse.up()
        picture(page, f"site_lab_{scheme}")
        assert page.evaluate("() => document.body.dataset.jpThemeLight") == ("true" if scheme == "light" else "false")
        print(f"{1000 * shown['pictures'] / (shown['until'] - shown['from']):.1f} frames/s")
        assert shown["pictures"] >= 60  # in about 4 s; a view that hangs has 1


@pytest.mark.slow
def test_a_view_and_cells_take_turns(page, site):
    """A scene goes on while a cell awaits, which holds the pointer back; a cell that computes is told, meanwhile and after it."""
    open_lab(page, site, "02")
    for beginning in (FIRST, "wall = hl.wall()", "view = hl.live(paddle"):
        run_cell(page, beginning)
    page.wait_for_selector(".hl-stage")
    see(page, ".hl-stage")
    until(page, STATUS, "Running")
    ticks = "view._session.source.ticks"
    begin(page, f"import asyncio, time\nbefore = {ticks}\nawait asyncio.sleep(4)\nran = {ticks} - before")
    until(page, STATUS, A_CELL_RUNS)
    assert ask(page, "print(ran > 1000)") == "True"
    begin(page, "until = time.monotonic() + 4\nwhile time.monotonic() < until:\n    pass")
    until(page, STATUS, "It is busy with a cell. Nothing moves until it answers.")
    until(page, STATUS, "A cell computed for 4.")
    until(page, STATUS, "Running")


@pytest.mark.slow
def test_a_solved_lab_that_is_downloaded_earns_in_the_grader_what_it_earns_on_a_desktop(page, site, tmp_path, capsys):
    open_lab(page, site, "02")
    untouched = download(page, tmp_path)
    assert untouched.name.endswith("02_virtual_wall.ipynb") and points(untouched, capsys) == "0"
    lab = next(lab for lab in find_labs() if lab.number == "02")
    solved = solved_notebook(lab, ANSWERS / lab.name)
    page.evaluate("(given) => window.jupyterapp.shell.currentWidget.context.model.fromJSON(given)", solved)
    run_all(page)
    last = [k for k, cell in enumerate(solved["cells"]) if cell["cell_type"] == "code"][-1]
    page.wait_for_function(
        "(k) => window.jupyterapp.shell.currentWidget.content.widgets[k].model.executionCount", arg=last, timeout=240_000
    )
    handed_in = download(page, tmp_path)
    assert points(handed_in, capsys) == "10"
    ran = json.loads(handed_in.read_text("utf-8"))
    failed = [output for cell in ran["cells"] for output in cell.get("outputs", ()) if output["output_type"] == "error"]
    assert not failed
    page.reload()  # what was saved is there again, in this browser
    page.wait_for_function("() => window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel")
    assert cells(page) == ["".join(cell["source"]) for cell in ran["cells"]]


@pytest.mark.slow
def test_a_twin_lies_beside_its_notebook_where_another_lab_reads_it(page, site):
    twin = 'import hapticlab as hl\ntwin = hl.devices.PaddleProfile("bench 7", m=0.034, b=0.125)\n'
    open_lab(page, site, "09")
    told = run_cell(page, FIRST, f'{twin}print(twin.save("bench7.json"), hl.devices.profile("bench7.json") == twin)')
    assert told.split() == ["bench7.json", "True"]
    open_lab(page, site, "10")
    file = "../09_identify/bench7.json"
    asked = f'{twin}print(hl.devices.profile("{file}") == twin, hl.connect("sim://{file}").settings.m)'
    same, mass = run_cell(page, "from math import", asked).split()
    assert same == "True" and float(mass) == pytest.approx(0.034)


@pytest.mark.slow
def test_the_simulated_board_answers_in_lab_00(page, site):
    open_lab(page, site, "00")
    run_cell(page, FIRST)
    found = run_cell(page, 'print(hl.doctor("sim://hapkit"))').splitlines()
    expected = str(hl.doctor("sim://hapkit")).splitlines()
    assert [line.split()[:1] for line in found] == [line.split()[:1] for line in expected]


@pytest.mark.wide
def test_a_scene_of_the_first_page_moves_at_once_without_python(page, site):
    asked = []
    page.on("request", lambda request: asked.append(request.url.removeprefix(site)))
    page.goto(f"{site}/index.html")
    page.get_by_role("link", name="A virtual wall").click()
    x, y = grab(page, "canvas.hl-stage")
    page.evaluate(COUNT)
    page.mouse.move(x + 60, y, steps=10)
    page.wait_for_function("() => window.shown.pictures > 10")
    page.mouse.up()
    assert {name for name in asked if not name.startswith("data:")} <= {
        "/index.html",
        "/wall.html",
        "/notebooks/favicon.ico",
        f"/{RECORD}",
    }


@pytest.fixture
def front(tmp_path):
    """A site of its first page and one package, both a week old, and a function that builds it with another package."""

    def build(content):
        (tmp_path / "index.html").write_text(front_page(find_labs(), local=1, wheels=1), "utf-8")
        (tmp_path / "one.whl").write_text(content)
        (tmp_path / RECORD).write_text(json.dumps({"files": {"one.whl": content}}))
        week_ago = time.time() - 7 * 86400
        for path in tmp_path.iterdir():
            os.utime(path, (week_ago, week_ago))  # so that a browser keeps it for hours: RFC 9111, 4.2.2

    build("old")
    with serving(partial(Quiet, directory=tmp_path)) as server:
        yield f"http://127.0.0.1:{server.server_port}", build


@pytest.mark.wide
def test_after_a_new_build_a_link_of_the_first_page_leads_to_the_new_files(complete, browser, front):
    address, build = front
    loaded = "() => fetch('one.whl').then((answer) => answer.text())"
    with visited(browser) as page:
        page.goto(f"{address}/index.html")
        page.wait_for_function("() => renewing === null")
        assert page.evaluate(loaded) == "old"
        build("new")
        assert page.evaluate(loaded) == "old"  # what the first page is there to mend
        page.goto(f"{address}/index.html?again")
        page.locator("a[href^='licences']").click()  # at once
        page.wait_for_url("**/licences/index.html")
        page.goto(f"{address}/missing.html")
        assert page.evaluate(loaded.replace("'one", "'/one")) == "new"


@pytest.mark.wide
def test_the_first_page_says_so_where_nothing_can_be_stored(complete, browser, front):
    with visited(browser) as page:
        page.goto(f"{front[0]}/index.html")
        assert not page.get_by_role("alert").is_visible()
        page.add_init_script(
            "Object.defineProperty(window, 'localStorage', { get() { throw new DOMException('', 'SecurityError') } })"
        )
        page.reload()
        assert page.get_by_role("alert").is_visible()
        page.locator("a[href^='licences']").click()
        page.wait_for_url("**/licences/index.html")


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [390, 1280])
def test_the_first_page_is_usable_by_everybody(complete, browser, site, width, scheme):
    with visited(browser, width=width, color_scheme=scheme) as page:
        page.goto(f"{site}/index.html")
        assert findings(page, "body") == []
        assert page.evaluate("() => document.documentElement.scrollWidth <= window.innerWidth")
        picture(page, f"site_first_page_{width}_{scheme}")
        for address in page.evaluate("() => [...document.links].map((a) => a.href)"):
            assert page.request.get(address).ok, address
