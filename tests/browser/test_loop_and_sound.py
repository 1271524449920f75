"""The loop of force over position and the sound of chatter, from numbers that are known in closed form."""

import numpy as np
import pytest
from scripts import add_scripts

from hapticlab.widgets.frame import COLUMNS
from hapticlab.widgets.traces import Traces

K, T = 500.0, 1e-3


@pytest.fixture(scope="module")
def page(browser):
    page = browser.new_page()
    add_scripts(page)
    page.add_script_tag(content=STROKES)
    yield page
    page.close()


def rows(x, F, contact, t=None, **more):
    """Rows of frames of a wall, as the kernel makes them."""
    samples = {"t": np.arange(len(x)) * T if t is None else t, "x": x, "F": F, **more}
    return Traces(T).add(samples, contact).ravel().tolist()


LOOP = """([rows, columns, touches, given = {}]) => {
  const canvas = document.body.appendChild(document.createElement("canvas"))
  const samples = Object.assign(new parts.Samples(columns), { T: 1e-3, apart: 1e-3, ...given })
  const loop = new parts.Loop(canvas, { touches, kind: given.kind }, samples)
  loop.resize(300, 200)
  if (given.speed) loop.speed = given.speed
  const theme = { ink: "#000", quiet: "#555", grid: "#ddd", given: "rgb(255, 0, 0)", taken: "rgb(0, 0, 255)" }
  const chunk = samples.width * 1000 // as frames come
  for (let k = 0; k < rows.length; k += chunk) {
    samples.add(new Float32Array(rows.slice(k, k + chunk)))
    loop.draw(k, theme)
  }
  const last = loop.latest()
  if (!last) return { words: loop.words() }
  const pixels = () => loop.context.getImageData(0, 0, canvas.width, canvas.height).data
  const colours = pixels()
  loop.context.clearRect(0, 0, 300, 200)
  loop.path(last.from, last.to)
  loop.context.closePath()
  loop.context.fillStyle = "#000"
  loop.context.fill()
  const ratio = window.devicePixelRatio
  const covered = pixels().reduce((sum, value, k) => sum + (k % 4 === 3 ? value / 255 : 0), 0) / ratio ** 2
  const area = covered * (1 / (loop.x(1) - loop.x(0))) * (1 / (loop.y(0) - loop.y(1))) // [m] and [N] of a pixel
  const some = (k) => colours.some((value, i) => i % 4 === k && value > 200 && colours[i + 2 - 2 * k] < 90)
  canvas.remove()
  return { energy: last.energy, area, strokes: strokes(loop), words: loop.words(), isRed: some(0), isBlue: some(2) }
}"""


# How many strokes draw all that is kept.
STROKES = """const strokes = (loop) => {
  let count = 0
  const context = { beginPath() {}, lineTo() {}, moveTo: () => count++ }
  Object.assign(Object.create(loop), { context }).path(loop.samples.oldest, loop.samples.count - 1)
  return count
}"""


@pytest.mark.parametrize("sign", [1, -1])
def test_the_shaded_loop_of_a_contact_is_the_energy_of_the_held_force(page, sign):
    """A held spring gives back K D^2 / 2 in each period more than an ideal one; one that looks a period ahead takes it."""
    x = np.concatenate([np.full(5, -0.002), 0.008 * np.sin(np.pi * np.arange(13) / 12), np.full(5, -0.002)])
    x[abs(x) < 1e-9] = 0.0
    at = x if sign > 0 else np.append(x[1:], x[-1])
    F = K * np.maximum(at, 0)
    given = sign * K * np.sum(np.diff(x[5:18]) ** 2) / 2
    found = page.evaluate(LOOP, [rows(x, F, F > 0), list(COLUMNS), True])
    assert found["energy"] == pytest.approx(given, rel=1e-4)
    assert found["area"] == pytest.approx(abs(given), rel=0.04)  # pixels
    assert found["words"][0] == f"{'+' if sign > 0 else '−'}{1e3 * abs(given):.2f} mJ in the last contact"
    assert (found["isRed"], found["isBlue"]) == (sign > 0, sign < 0)


def press(samples=40, depth=0.01, rest=5):
    """Into a wall at 0 and out again, from and to 2 mm before it."""
    way = np.sin(np.pi * np.arange(samples) / samples) ** 2
    return np.concatenate([np.full(rest, -0.002), depth * way - 0.002, np.full(rest, -0.002)])


def held(x, F):
    """Return the energy that forces give which are held from sample to sample [J]."""
    return -np.sum(F[:-1] * np.diff(x))


@pytest.mark.parametrize("delay", [0.4, 1.7])  # samples
def test_under_any_delay_the_shaded_area_is_the_energy_beside_it(page, delay):
    """Each force acts from where the handle is when it comes: x(t + delay)."""
    fine = np.interp(np.arange(4900) / 100, np.arange(50), press())
    x, later = fine[::100], np.roll(fine, -round(100 * (delay % 1)))[::100]
    F = K * np.maximum(x, 0)
    F_applied = np.roll(F, int(delay))
    given = held(later, F_applied)
    found = page.evaluate(LOOP, [rows(x, F, F > 0, F_applied=F_applied, x_switch=later), list(COLUMNS), True])
    assert found["energy"] == pytest.approx(given, rel=1e-3)
    assert found["area"] == pytest.approx(given, rel=0.04)  # pixels
    assert found["isRed"]


def test_a_contact_longer_than_what_is_kept_has_its_energy_and_is_not_drawn(page):
    short, long = press(), np.concatenate([press()[:25], np.full(10_000, 0.008), press()[25:]])
    x = np.concatenate([*[short] * 4, long])  # the energy before it is far from 0
    F = K * np.maximum(x, 0)
    found = page.evaluate(LOOP, [rows(x, F, F > 0), list(COLUMNS), True])
    assert found["energy"] == pytest.approx(held(long, K * np.maximum(long, 0)), rel=2e-3)
    assert found["words"][1] == "more given back than taken; too long to draw"


@pytest.mark.parametrize(("kind", "told"), [("board", "samples are missing: loop not counted"), ("simulated", "")])
def test_what_samples_are_missing_from_is_no_loop(page, kind, told):
    x = np.concatenate([press(), press(depth=0.007)])
    t, F = np.arange(len(x)) * T, K * np.maximum(x, 0)
    cut = np.r_[0:20, 25 : len(x)]  # within the first contact
    found = page.evaluate(LOOP, [rows(x[cut], F[cut], F[cut] > 0, t[cut]), list(COLUMNS), True, {"kind": kind}])
    assert found["energy"] == pytest.approx(held(x[50:], F[50:]), rel=1e-3)  # of the second
    assert found["strokes"] == 2 and found["words"][1] == (told or "more given back than taken")
    alone = cut[cut < 50]
    found = page.evaluate(LOOP, [rows(x[alone], F[alone], F[alone] > 0, t[alone]), list(COLUMNS), True])
    assert found["words"][0] == "No whole contact yet"
    sine = np.sin(2 * np.pi * np.arange(1000) / 600)
    cut = np.r_[0:650, 660:1000]  # each half has one rise through the mean
    found = page.evaluate(LOOP, [rows(sine[cut], sine[cut], np.full(len(cut), np.nan), cut * T), list(COLUMNS), False])
    assert found["words"][0] == "No whole cycle yet"


def test_a_loop_says_what_it_is_where_that_is_less_than_it_seems(page):
    x = np.concatenate([press(20)] * 5)
    F = K * np.maximum(x, 0)
    thinned = {"T": 4e-4, "apart": 8e-4}
    found = page.evaluate(LOOP, [rows(x, F, F > 0, np.arange(len(x)) * 8e-4), list(COLUMNS), True, {**thinned, "speed": 0.1}])
    assert not found["isRed"] and found["words"][1] == "more given back than taken; not to scale"
    assert found["words"][0].endswith("per contact (5 in 1 s of t)")
    nothing = page.evaluate(LOOP, [rows(x, 0 * F, F > 0), list(COLUMNS), True])["words"]
    assert nothing == ["0.00 mJ per contact (5 in 1 s)", "as much given back as taken"]


def test_where_nothing_is_touched_the_loop_is_a_cycle(page):
    """A damper takes pi b w A^2 in each cycle, and the hold gives a little back."""
    A, w, b = 0.01, 2 * np.pi * 2.0, 2.0
    t = np.arange(2000) * T
    x, F = A * np.sin(w * t), b * A * w * np.cos(w * t)
    found = page.evaluate(LOOP, [rows(x, F, np.full(len(t), np.nan)), list(COLUMNS), False])
    assert found["energy"] == pytest.approx(-np.pi * b * w * A**2, rel=0.01)
    assert found["area"] == pytest.approx(np.pi * b * w * A**2, rel=0.03)
    assert found["words"][1] == "more taken than given back" and found["isBlue"]


def test_no_loop_is_told_before_there_is_one(page):
    said = page.evaluate(
        """(columns) => [true, false].map((touches) => {
            const loop = new parts.Loop(document.createElement("canvas"), { touches }, new parts.Samples(columns))
            loop.resize(300, 200)
            loop.draw(1, {})
            return loop.words()[0]
        })""",
        list(COLUMNS),
    )
    assert said == ["No whole contact yet", "No whole cycle yet"]


# Feeds a voice as a view does, a frame at a time, and renders what a loudspeaker would play.
RENDER = """async ([forces, speed, opens]) => {
  const rate = 24000, seconds = (forces.length * 1e-3) / speed
  const context = new OfflineAudioContext(1, Math.round((seconds + 0.2) * rate), rate)
  const voice = new parts.Voice(context)
  voice.open(opens)
  const frame = Math.round(17 * speed) || 1
  for (let k = 0; k * frame < forces.length; k++) {
    const when = (k * frame * 1e-3) / speed
    const feed = () => {
      if (k === 0) voice.tap(1)
      voice.feed(forces.slice(k * frame, (k + 1) * frame), 1e-3, speed)
    }
    if (when) context.suspend(when).then(() => (feed(), context.resume()))
    else feed()
  }
  return Array.from((await context.startRendering()).getChannelData(0))
}"""


def pitch(sound, rate=24000):
    """Return the frequency at which a sound repeats itself [Hz], by its autocorrelation."""
    spectrum = np.fft.rfft(sound - np.mean(sound), 2 * len(sound))
    repeats = np.fft.irfft(np.abs(spectrum) ** 2)[: rate // 15]
    lag = rate // 400 + np.argmax(repeats[rate // 400 :])
    return rate / lag


@pytest.mark.wide
@pytest.mark.parametrize(("frequency", "speed"), [(34.0, 1.0), (90.0, 1.0), (200.0, 0.5)])
def test_chatter_sounds_at_its_frequency_in_scene_time_and_softly(page, frequency, speed):
    force = 4.0 * np.maximum(np.sin(2 * np.pi * frequency * np.arange(1500) * T), 0)
    sound = np.array(page.evaluate(RENDER, [force.tolist(), speed, True]))[6000:-6000]
    assert pitch(sound) == pytest.approx(frequency * speed, rel=0.02)
    assert 0.01 < np.abs(sound).max() <= 0.2
    loudness = [np.std(part) for part in np.array_split(sound, len(sound) // 2400)]  # of 0.1 s: no frame is missing
    assert min(loudness) > 0.7 * max(loudness)


@pytest.mark.wide
def test_a_voice_that_was_not_asked_for_is_silent(page):
    force = 400.0 * np.sign(np.sin(2 * np.pi * 50 * np.arange(300) * T))
    assert np.abs(page.evaluate(RENDER, [force.tolist(), 1.0, False])).max() == 0
    assert np.abs(page.evaluate(RENDER, [force.tolist(), 1.0, True])).max() <= 0.25  # however large the force is
