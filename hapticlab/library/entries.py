"""What the library holds: each scene with its picture, the settings it is meant for, and what a paddle must have."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches

from ..base.grid import Grid
from ..base.profile.paddle_profile import PaddleProfile
from ..base.shows_itself import ShowsItself, Tabular
from ..errors import SceneError
from ..scene.scene import Scene
from . import bodies, contacts, mechanisms, pendulums, surfaces

#: the paddle that the default values are made for
NOMINAL = PaddleProfile(
    "library", m=0.05, b=0.3, force_max=5.0, T=1e-3, source="round numbers of a one-axis paddle with +-50 mm of travel"
)


@dataclass(frozen=True)
class Entry(ShowsItself):
    """One scene of the library.

    Attributes
    ----------
    scene : callable -> Scene
        ``hl.library.<name>``.
    draw : callable (axes, *, x, ...) or None
        Draws the mechanism in a state; None where its equations tell all that is to be drawn.
    b : float
        Damping at the handle [N s/m] with which it is passive for any hand with ``options``: K T/2 + b_c of its coupler and
        a little for the velocity that is estimated, or T/2 times the steepest slope of its force. A longer T needs more.
    options : dict
        Of hapticlab.compile, for a computer.
    uno : dict or None
        Of hapticlab.compile, T [s] among them, for an Arduino Uno; None where it does not fit.
    stored : float
        Energy that it holds at the start and can give [J].
    """

    scene: Callable[..., Scene]
    draw: Callable[..., None] | None
    b: float
    options: dict = field(default_factory=lambda: {"T": NOMINAL.T})
    uno: dict | None = None
    stored: float = 0.0

    @property
    def name(self):
        """The scene's name in the library."""
        return self.scene.__name__

    @property
    def title(self):
        """What it is, in one line."""
        return self.scene.__doc__.splitlines()[0]

    def __str__(self):
        rate = f"{1 / self.uno['T']:.0f} Hz" if self.uno else "does not fit"
        return f"{self.name}: {self.title}\n  passive on a paddle with b >= {self.b:g} N s/m; on an Uno: {rate}"


class Catalogue(Tabular, Mapping):
    """Name -> :class:`Entry`; printing it lists them."""

    def __init__(self, entries):
        self._entries = {entry.name: entry for entry in entries}

    def __getitem__(self, name):
        if name not in self._entries:
            raise SceneError(unknown(name, self._entries))
        return self._entries[name]

    def __contains__(self, name):
        return name in self._entries

    def __iter__(self):
        return iter(self._entries)

    def __len__(self):
        return len(self._entries)

    def _sentence(self):
        return f"{len(self)} scenes, each made by hl.library.NAME()"

    def _tables(self):
        rates = [f"{1 / entry.uno['T']:.0f} Hz" if entry.uno else "does not fit" for entry in self.values()]
        columns = {
            "name": list(self),
            "what it is": [e.title for e in self.values()],
            "passive from b": [e.b for e in self.values()],
        }
        yield "", Grid({**columns, "on an Uno": rates}, {"passive from b": "N s/m"})

    def __str__(self):
        return "\n".join(map(str, self.values()))


def unknown(name, known):
    """The sentence about a name that the library does not have, with the nearest ones."""
    near = get_close_matches(str(name), known, 3, 0.5) or list(known)
    return f"the library has no scene {name!r}; did you mean {' or '.join(near)}?"


def _uno(method, rate):
    return {"method": method, "T": 1 / rate}


SEMI = "semi_implicit_euler"
CATALOGUE = Catalogue((
    Entry(bodies.mass_spring_damper, None, 0.21, uno=_uno(SEMI, 1000)),
    Entry(bodies.two_masses, None, 0.21, uno=_uno(SEMI, 800)),
    Entry(bodies.tuned_absorber, None, 0.21, uno=_uno(SEMI, 500)),
    Entry(
        pendulums.pendulum_on_the_handle, None, 0.21, uno=_uno(SEMI, 500), stored=0.0033
    ),
    Entry(pendulums.cart_pole, None, 0.21, uno=_uno(SEMI, 500), stored=0.2944),
    Entry(mechanisms.gears, mechanisms.draw_gears, 0.21, uno=_uno(SEMI, 800)),
    Entry(mechanisms.slider_crank, mechanisms.draw_slider_crank, 0.21, uno=_uno(SEMI, 500)),
    Entry(mechanisms.four_bar, mechanisms.draw_four_bar, 0.21, uno=_uno(SEMI, 400) | {"hold": "foh"}),
    Entry(mechanisms.rolling, mechanisms.draw_rolling, 0.21, uno=_uno(SEMI, 500)),
    Entry(contacts.ball_on_the_paddle, None, 0.21, stored=0.0236),
    Entry(contacts.stick_slip, None, 0.21),
    Entry(surfaces.detents, surfaces.draw_detents, 0.19, uno=_uno(SEMI, 1000)),
    Entry(surfaces.texture, surfaces.draw_texture, 0.28, uno=_uno(SEMI, 1000)),
    Entry(surfaces.virtual_fixture, surfaces.draw_virtual_fixture, 0.2, uno=_uno(SEMI, 1000)),
    Entry(surfaces.buckling_beam, surfaces.draw_buckling_beam, 0.17, uno=_uno(SEMI, 1000), stored=0.0102),
))  # fmt: skip
