"""The parts of the view that are plain arithmetic, run in the browser they are written for."""

import json

import numpy as np
import pytest
from scripts import add_scripts


@pytest.fixture(scope="module")
def page(browser):
    page = browser.new_page()
    add_scripts(page)
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
            return [[bins.first, bins.low, bins.high, bins.latest].map((kept) => kept[slot]), bins.span(1, 50, 90)]
        }"""
    )
    assert column == [1, -4, 7, 2] and drawn == {"low": -4, "high": 7}


@pytest.mark.parametrize(
    ("frequency", "noise", "turns"), [(30, 0.0, range(5, 7)), (2, 0.0, range(2)), (2, 0.02, range(2)), (0, 0.0, range(1))]
)
def test_a_signal_turns_round_as_often_as_it_swings_and_not_by_its_noise(page, frequency, noise, turns):
    """Columns of 8 ms over 100 ms: a sine has two turns a cycle."""
    t = np.arange(100) * 1e-3 + 0.3
    x = np.sin(2 * np.pi * frequency * t) + noise * np.random.default_rng(3).uniform(-1, 1, 100)
    counted = page.evaluate(
        """([t, x, size]) => {
            const bins = new parts.Bins(100, 0.008, 1)
            t.forEach((time, k) => bins.add(time, 0, x[k]))
            return bins.turns(0, 0, 99, size)
        }""",
        [t.tolist(), x.tolist(), 0.4 * float(np.ptp(x)) + 1e-9],
    )
    assert counted in turns


def test_an_axis_grows_at_once_and_shrinks_late(page):
    axes = page.evaluate(
        """() => {
            const scale = new parts.Scale(0.1), found = []
            for (const high of [0.9, 1.3, 5.2, 3.0, 1.0]) found.push([scale.reach(0, high, 2.5), scale.low, scale.high])
            return found
        }"""
    )
    assert [changed for changed, *_ in axes] == [True, True, True, False, True]
    for (_, low, high), reached in zip(axes, [0.9, 1.3, 5.2, 5.2, 1.0], strict=True):
        assert low == 0 and reached <= high <= 2.1 * reached


@pytest.mark.parametrize("value", [0.0, 1e15, -1e17, 3.4e38])
def test_an_axis_of_a_constant_has_few_lines_however_large_it_is(page, value):
    lines, low, high = page.evaluate(
        """(value) => {
            const scale = new parts.Scale(0.1)
            scale.reach(value, value, 4)
            const lines = []
            for (const line of scale.lines()) if (lines.push(line) > 1000) break
            return [lines, scale.low, scale.high]
        }""",
        value,
    )
    assert 2 <= len(lines) <= 12 and len(set(lines)) == len(lines)
    assert low <= value <= high and low < high


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
    assert page.evaluate("() => parts.shown(NaN)") == "–"
    assert json.dumps(said) == '[["0.3", "0.30"], ["-0.00004", "0.00"], ["12.345", "12.3"], ["123.4", "123"]]'


def test_a_number_may_have_a_comma_but_not_two_meanings(page):
    typed = ["12,5", " -.5 ", "1e3", "0,005", "1,000", "1,234.5", "", "-", "12x"]
    assert page.evaluate("(typed) => typed.map(parts.number).map((x) => (isNaN(x) ? null : x))", typed) == [
        12.5, -0.5, 1000, 0.005, None, None, None, None, None,
    ]  # fmt: skip


def test_a_vibration_is_met_with_what_shows_it(page):
    view = {"about": {"kind": "simulated"}, "flags": {"running": True, "held": True, "vibrates": True}, "touched": True}
    assert page.evaluate("parts.hint", view).startswith("M slows time down")
