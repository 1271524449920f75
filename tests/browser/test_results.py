"""Results in a real notebook: equations are typeset, names run as no code, and what is folded opens."""

import pytest
from lab import picture

pytestmark = pytest.mark.wide

SCENE = """
import hapticlab as hl
k, x_o = hl.parameters("k x_o", units="N/m m")
name = "<script>document.title = 'run'</script><img src=x onerror=\\"document.title='run'\\"> wall"
scene = hl.Scene(force=hl.when(hl.x(hl.n) >= x_o, k * (hl.x(hl.n) - x_o)), name=name)
scene
"""
RECORD = "hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3).run(scene(k=500, x_o=0), 0.2, v=0.2)"
PROGRAM = "hl.compile(scene(k=500, x_o=0), T=1e-3)"


def test_results_in_a_notebook(lab):
    page = lab.open("results", SCENE, RECORD, PROGRAM)
    outputs = page.locator(".jp-OutputArea-output")
    outputs.nth(2).locator("summary", has_text="Listing").click()
    assert outputs.nth(2).locator("pre", has_text="tick:").is_visible()
    outputs.nth(0).locator("mjx-container").wait_for()  # typeset after it is shown; fails where there are two
    assert (
        outputs.nth(0).locator("strong").inner_text().endswith("wall: the force on the environment; without a value yet: k, x_o")
    )
    for number in range(2):
        assert "<script>" in outputs.nth(number).locator("strong").inner_text()
    assert outputs.nth(1).locator("img").count() == 1 and page.title() != "run"
    picture(page, "results")
