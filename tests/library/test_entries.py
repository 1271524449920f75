"""Every scene of the library: it is listed, it runs, it is as passive as it says, and fits an Uno where it says so."""

from pathlib import Path

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.cli.main import main
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines import engine
from hapticlab.library.entries import CATALOGUE, NOMINAL

ASKED = (
    "mass_spring_damper two_masses pendulum_on_the_handle cart_pole ball_on_the_paddle rolling gears slider_crank four_bar "
    "tuned_absorber buckling_beam detents texture stick_slip virtual_fixture"
).split()
ENTRIES = list(CATALOGUE.values())
SCENES = {e.name: e.scene() for e in ENTRIES}
STATES = [e for e in ENTRIES if SCENES[e.name].coordinates]
FIELDS = [e for e in ENTRIES if e not in STATES]
names = "{0.name}".format


def quiet(scene):
    """Return a scene without what shakes it: that source feeds energy by design."""
    return scene(F_0=0) if "F_0" in scene.values else scene


def test_the_library_lists_what_it_holds():
    assert set(ASKED) <= set(CATALOGUE)
    assert set(CATALOGUE) == set(hl.library.__all__) - {"catalogue", "nominal"}
    assert all(getattr(hl.library, name) is entry.scene for name, entry in CATALOGUE.items())
    assert set(dir(hl.library)) == set(hl.library.__all__)
    assert str(hl.library) == str(CATALOGUE)
    assert str(CATALOGUE).count("\n") == 2 * len(CATALOGUE) - 1


def test_an_unknown_scene_is_refused_with_the_nearest():
    with pytest.raises(AttributeError, match="'cartpole'; did you mean cart_pole"):
        hl.library.cartpole  # noqa: B018
    with pytest.raises(hl.errors.SceneError, match="'gear'; did you mean gears"):
        CATALOGUE["gear"]
    assert "gear" not in CATALOGUE


@pytest.mark.parametrize("entry", ENTRIES, ids=names)
def test_a_docstring_says_equation_lesson_source_damping_and_rate(entry):
    text = " ".join(entry.scene.__doc__.split())
    for part in ("Teaches", "Needs b >=", "Returns ---", "Examples ---", ">>> import hapticlab as hl"):
        assert part in text, part
    assert any(str(year) in text for year in range(1900, 2030)) or "ch. " in text or "sec. " in text  # a source
    assert f"{1 / entry.uno['T']:.0f} Hz" in text if entry.uno else "not fit an Uno" in text


@pytest.mark.parametrize("entry", ENTRIES, ids=names)
@pytest.mark.always(
    "mass_spring_damper", "two_masses", "gears", "rolling", "stick_slip", "detents", "texture", "virtual_fixture", "buckling_beam"
)
def test_it_compiles_runs_and_opens_live_as_it_comes(entry):
    scene, paddle = entry.scene(), hl.SimulatedPaddle.from_profile(hl.library.nominal)
    program = hl.compile(scene, T=1e-3)
    assert paddle.run(scene, duration=0.02, progress=False).fault is None
    hl.live(paddle, scene).close()
    located = [c for model in scene.explicit().models for c in model.contacts]
    told = [note for note in program.notes if "chosen automatically" in note]
    assert program.facts.get("method") == ("taylor" if located else "rk4" if scene.coordinates else None)
    assert len(told) == bool(scene.coordinates) and all(note in str(program) for note in told)


@pytest.mark.parametrize("entry", ENTRIES, ids=names)
@pytest.mark.always("mass_*", "two_*", "gears", "rolling", "stick_slip", "detents", "texture", "buckling_beam")
def test_it_runs_on_the_nominal_paddle_within_its_travel_and_force(entry):
    hand = hl.Hand(m=0.02, b=1, k=150, intent=lambda t: 0.025 * np.sin(2 * np.pi * t))
    paddle = hl.SimulatedPaddle.from_profile(NOMINAL, T=entry.options["T"], force_max=None, hand=hand)
    options = {name: value for name, value in entry.options.items() if name != "T"}
    log = paddle.run(SCENES[entry.name], duration=2, **options)
    assert log.fault is None
    assert 0.05 < np.abs(log.F).max() < NOMINAL.force_max
    assert np.abs(log.x).max() < 0.05
    assert set(SCENES[entry.name].watch) <= set(log.channels)


@pytest.mark.parametrize("entry", ENTRIES, ids=names)
def test_it_fits_an_uno_at_the_rate_it_says_or_not_at_all(entry):
    taken = cost(hl.compile(SCENES[entry.name], **(entry.uno or entry.options)))
    print(taken)
    assert taken.fits == (entry.uno is not None), str(taken)


def felt_on_a_board(entry):
    options = dict(entry.uno)
    hand = hl.Hand(m=0.02, b=1, k=150, intent=lambda t: 0.02 * np.sin(2 * np.pi * t))
    paddle = hl.SimulatedPaddle.from_profile(NOMINAL, T=options.pop("T"), b=0.8, counts_per_metre=78_125, hand=hand)
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        return board.run(SCENES[entry.name], duration=0.5, **options)


def test_it_runs_on_a_board():
    assert np.abs(felt_on_a_board(CATALOGUE["gears"]).F).max() > 0.1


@pytest.mark.slow
@pytest.mark.parametrize("entry", [e for e in ENTRIES if e.uno], ids=names)
def test_every_one_runs_on_a_board(entry):
    log = felt_on_a_board(entry)
    assert log.fault is None
    assert 0.1 < np.abs(log.F).max() < NOMINAL.force_max


def test_the_example_runs(tmp_path, capsys):
    example = Path(hl.__file__).parent / "examples" / "from_the_library.py"
    assert main(["run", str(example), "--set", "Omega=25", "--duration", "0.2", "--out", str(tmp_path)]) == 0
    assert "tuned absorber" in capsys.readouterr().out


def journeys(T, ticks):
    """Yield handle paths [m] that start at rest at 0: sinusoids up to half the sampling rate, random walks."""
    n, random = np.arange(ticks), np.random.default_rng(7)
    for f in [*np.geomspace(1, 0.49 / T, 16), 0.5 / T]:
        yield 0.01 * min(1, 20 / f) * (np.sin(2 * np.pi * f * n * T) if f < 0.5 / T else 1 - (-1.0) ** n)
    for _ in range(2):
        yield np.cumsum(1e-4 * random.standard_normal(ticks))
        yield 1e-3 * random.standard_normal(ticks)


@pytest.mark.parametrize("entry", STATES, ids=names)
@pytest.mark.always("mass_spring_damper", "gears")
def test_led_anywhere_it_gives_back_no_more_than_its_damping_takes(entry):
    # cheapest motion through the samples: the paddle's damper takes b D^2/T a period, walls.md 3.1 is Colgate's condition
    T = entry.options["T"]
    scene = quiet(SCENES[entry.name])
    program = hl.compile(scene, dtype="float64", velocity="backward_difference", **entry.options)
    loaded, most = engine.load(program), 0.0
    for path in journeys(T, 1500):
        x = path - path[0]
        F, D = loaded.run(len(x), x, program.values).outputs[:-1, 0, 0], np.diff(x)
        given, taken = np.cumsum(-F * D) - entry.stored, np.cumsum(D**2) / T
        most = max(most, np.max(given / np.maximum(taken, 1e-12)))
    assert most <= entry.b
    assert entry.stored or most > 0.5 * entry.b  # and it is not declared far too high


@pytest.mark.parametrize("entry", FIELDS, ids=names)
def test_a_force_field_is_no_steeper_than_its_damping_allows(entry, led):
    # U(x + D) - U(x) <= F D + b D^2/T for every x and D is passivity with U stored; U is bounded below
    x, T = np.linspace(-0.05, 0.05, 10_001), entry.options["T"]
    F = led(SCENES[entry.name], x, T=T).F
    U = np.r_[0, np.cumsum((F[1:] + F[:-1]) / 2 * np.diff(x))]
    assert -1e-9 <= entry.stored - (U[5000] - U.min()) < 1e-4 + 1e-9  # at x = 0, rounded up
    most = 0.0
    for step in (1, 2, 5, 10, 20, 50, 100, 200, 500):
        D = x[step] - x[0]
        rise = np.concatenate([U[step:] - U[:-step] - F[:-step] * D, U[:-step] - U[step:] + F[step:] * D])
        most = max(most, T * rise.max() / D**2)
    assert 0.9 * entry.b <= most <= entry.b * (1 + 1e-6)
