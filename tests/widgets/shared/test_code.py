from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.device.simulated.stepping import with_grip
from hapticlab.library.entries import CATALOGUE
from hapticlab.scene.laws.taps import TAPS
from hapticlab.widgets.shared import scene_code as written
from hapticlab.widgets.shared.code import LONG, shared_code, why_private
from hapticlab.widgets.shared.scene_code import scene_code

CONTACTS = ("ball_on_the_paddle", "stick_slip")
PADDLE = hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3, force_max=5.0, hand=hl.Hand("pinch", intent=lambda t: 0 * t))


def made_by(code):
    names = {}
    exec(code, names)
    return names


def own_scene():
    """With all that a scene can have but contacts: a model, a signal, ranges, starts, a name that needs quotation marks."""
    k, m, c, x_o, F_c = hl.parameters("k m c x_o F_c", units="N/m kg N*s/m m N", values={"c": 0.1}, ranges={"x_o": (-0.03, 0.03)})
    z = hl.coordinate("z", unit="m", initial=x(n), range=(-0.2, 0.2))
    y = hl.signal("y", unit="m")
    model = hl.mechanics.lagrange(m * z.diff(t) ** 2 / 2 - k * (z - x(t)) ** 2 / 2, dissipation=c * z.diff(t) ** 2 / 3)
    filtered = hl.Scene(
        force=hl.when((x(n) > x_o) & (z > x_o), k * (x(n) - y(n)), 0) + F_c * hl.laws.delay(x(n) / (x_o + 1e-3 * x(n))) / 7,
        eom=[model, sp.Eq(y(n), 0.9 * y(n - 1) + 0.1 * x(n))],
        watch=[z], name='a "filter" \\ Körper',
    )  # fmt: skip
    return filtered(k=200, m=0.02, x_o=0.01, F_c=0.1)


@pytest.mark.parametrize("name", [name for name in CATALOGUE if name not in CONTACTS])
@pytest.mark.always("two_masses", "virtual_fixture")
def test_a_scene_written_out_compiles_to_the_same_program(name):
    scene = CATALOGUE[name].scene()
    made = made_by(written._written_out(scene))["scene"]
    assert made == scene
    program, again = (hl.compile(each, **CATALOGUE[name].options) for each in (scene, made))
    assert (program.init, program.tick, program.values) == (again.init, again.tick, again.values)


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.always("stick_slip", "detents")
def test_a_scene_of_the_library_is_a_call_of_the_library(name):
    scene = CATALOGUE[name].scene()
    first = next(iter(scene.values))
    changed = scene(**{first: 0.9 * scene.values[first]})
    code = scene_code(changed)
    assert f"hl.library.{name}()" in code
    assert made_by(code)["scene"] == changed


@pytest.mark.parametrize("law", TAPS)
def test_a_wall_is_a_call_of_its_law(law):
    scene = hl.wall(law, k=300, x_o="10 mm")
    assert f'hl.wall("{law}")' in scene_code(scene) and made_by(scene_code(scene))["scene"] == scene


def test_a_scene_of_ones_own_is_written_out():
    scene = own_scene()
    assert made_by(scene_code(scene))["scene"] == scene


def test_a_scene_that_cannot_be_written_out_gives_no_code():
    with_contact = CATALOGUE["ball_on_the_paddle"].scene()
    other = hl.Scene(force=with_contact.force, eom=with_contact.eom, watch=with_contact.watch, name="of my own")
    assert scene_code(other) is None
    assert shared_code(other, PADDLE) is None
    _, after = shared_code(own_scene(), PADDLE, picture=np.sin)
    assert after.endswith("hl.share(scene, paddle)  # picture=... was given as well\n")


PADDLES = [PADDLE, hl.SimulatedPaddle.from_profile("hapkit", b=0.5), hl.SimulatedPaddle(m=0.05, b=0, T=1e-3)]


@pytest.mark.parametrize("paddle", PADDLES)
def test_the_code_makes_the_paddle_and_the_same_run(paddle, monkeypatch):
    calls = []
    monkeypatch.setattr(hl, "share", lambda *given, **options: calls.append((given, options)), raising=False)
    before, after = shared_code(hl.library.gears()(K=300), paddle, time_scale=0.1, sliders={"K": (100, 400)})
    made_by(before + after)
    (((scene, made), options),) = calls
    assert scene == hl.library.gears()(K=300)
    assert options == {"time_scale": 0.1, "sliders": {"K": (100, 400)}}
    made, led = with_grip(made), with_grip(paddle)  # by a visitor, not by the intent of the paddle's own hand
    assert replace(made, profile=None) == replace(led, profile=None)


@pytest.mark.parametrize(
    "text", ["open('/home/ada/x.csv')", 'read("C:\\\\Users\\\\ada")', "p = '/Users/ada/lab'", "#" * (LONG + 1)]
)
def test_a_text_that_names_a_place_or_is_long_is_not_shown_unasked(text):
    assert why_private(text)
    assert not why_private("scene = hl.wall(k=300 / 2)  # N/m/s, see /docs\npath = 'runs/wall.csv'")
