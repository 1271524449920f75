"""The parts of the view that are plain arithmetic, run in the browser they are written for."""

import json

import pytest
from lab import REPOSITORY

from hapticlab.widgets.browser_view import SCRIPTS

FOLDER = REPOSITORY / "hapticlab" / "widgets" / "browser"
PARTS = ("Playback", "Bins", "Scale", "between", "decode", "niceStep", "onDark", "tidy", "shown", "number", "unitWords")


@pytest.fixture(scope="module")
def page(browser):
    scripts = (FOLDER / name for name in SCRIPTS)
    source = "\n".join(script.read_text("utf-8") for script in scripts).replace("export default { render }", "")
    page = browser.new_page()
    page.add_script_tag(content=f"(() => {{ {source}\n window.parts = {{ {', '.join(PARTS)} }} }})()")
    yield page
    page.close()


def play(page, arrivals):
    """Show frames made at 60 Hz that arrive at these moments [s]; return what each of the screen's frames shows."""
    return page.evaluate(
        """(arrivals) => {
            const playback = new parts.Playback(), seen = []
            let next = 0
            for (let now = 0; now < arrivals.at(-1); now += 1 / 60) {
                for (; next < arrivals.length && arrivals[next] <= now; next++)
                    playback.push({ sent: 100 + next / 60, points: new Float32Array([next]) }, arrivals[next])
                const { frame, next: after, part } = playback.at(now)
                if (frame) seen.push([now, parts.between(frame, after, part)[0]])
            }
            return seen
        }""",
        arrivals,
    )


@pytest.mark.wide
def test_frames_that_arrive_evenly_are_shown_at_once(page):
    arrivals = [0.005 + k / 60 + 0.004 * (k % 3) for k in range(240)]
    for now, shown in play(page, arrivals)[120:]:
        newest = max(k for k, arrived in enumerate(arrivals) if arrived <= now)
        assert shown == newest


def test_frames_held_back_in_bunches_are_played_as_evenly_as_they_were_made(page):
    arrivals = [0.005 + (k // 3 * 3 + 2) / 60 for k in range(360)]  # three at a time: 20 bunches a second
    seen = play(page, arrivals)[180:]
    steps = [b[1] - a[1] for a, b in zip(seen, seen[1:], strict=False)]
    assert min(steps) > 0.9 and max(steps) < 1.1  # one frame's way at each of the screen's, by interpolation
    delays = [now - (shown / 60 + 0.005) for now, shown in seen]
    assert max(delays) < 0.075  # the longest wait of a bunch, and one frame


def test_a_column_keeps_what_was_least_and_greatest(page):
    column, drawn = page.evaluate(
        """() => {
            const bins = new parts.Bins(100, 0.01, 2)
            for (const [t, value] of [[0.501, 1], [0.503, -4], [0.506, 7], [0.509, 2]]) bins.add(t, 1, value)
            const slot = bins.slot(1, 50)
            return [[bins.first, bins.low, bins.high, bins.latest].map((kept) => kept[slot]), bins.range([1], 50, 90)]
        }"""
    )
    assert column == [1, -4, 7, 2] and drawn == [-4, 7]


def test_an_axis_grows_at_once_and_shrinks_late(page):
    axes = page.evaluate(
        """() => {
            const scale = new parts.Scale(), found = []
            for (const high of [0.9, 1.3, 5.2, 3.0, 1.0]) found.push([scale.reach(0, high), scale.low, scale.high])
            return found
        }"""
    )
    assert [changed for changed, *_ in axes] == [True, True, True, False, True]
    for (_, low, high), reached in zip(axes, [0.9, 1.3, 5.2, 5.2, 1.0], strict=True):
        assert low == 0 and reached <= high <= 2.1 * reached


@pytest.mark.parametrize(("least", "step"), [(0.7, 1), (1.2, 2), (2.5, 5), (0.031, 0.05), (60, 100)])
def test_steps_of_an_axis_are_round(page, least, step):
    assert page.evaluate("(least) => parts.niceStep(least)", least) == pytest.approx(step)


def test_colours_turn_over_for_a_dark_page(page):
    turned = page.evaluate(
        """(colours) => {
            const context = document.createElement("canvas").getContext("2d")
            return colours.map((colour) => parts.onDark(new Map(), context, colour).match(/[0-9.]+/g).map(Number))
        }""",
        ["#000000", "#ffffff", "#c1440e"],
    )
    black, white, red = turned
    assert black[:3] == [255, 255, 255] and white[:3] == [40, 40, 40]
    assert red[0] > red[1] > red[2]  # still red


def test_numbers_read_well(page):
    said = page.evaluate("() => [0.1 + 0.2, -0.00004, 12.345, 123.4].map((x) => [parts.tidy(x), parts.shown(x)])")
    assert json.dumps(said) == '[["0.3", "0.30"], ["-0.00004", "0.00"], ["12.345", "12.3"], ["123.4", "123"]]'


def test_a_number_may_have_a_comma_but_not_two_meanings(page):
    typed = ["12,5", " -.5 ", "1e3", "0,005", "1,000", "1,234.5", "", "-", "12x"]
    assert page.evaluate("(typed) => typed.map(parts.number).map((x) => (isNaN(x) ? null : x))", typed) == [
        12.5, -0.5, 1000, 0.005, None, None, None, None, None,
    ]  # fmt: skip
    assert page.evaluate("() => ['N*s/m', '1', 'm'].map(parts.unitWords)") == ["N s/m", "", "m"]
