"""The Python that makes a shared file: its scene, its paddle, and the call of hl.share; for a reader to copy."""

import re
from dataclasses import fields, replace

from ...device.hand.hand import Hand
from ...device.hand.hand_presets import PRESETS
from ...device.profiles import kind_named
from ...device.simulated.simulated_paddle import SimulatedPaddle
from .scene_code import scene_code

#: longer texts [letters] of a scene file are not offered to readers unasked
LONG = 20_000
_PATHS = re.compile(r"""(?:^|["'\s=(])(?:/(?:home|Users|root|mnt|media|tmp|var)/\S|[A-Za-z]:\\|\\\\\w)""", re.MULTILINE)


def shared_code(scene, paddle, **options):
    """Return (Python before the visitor's values, Python after them), or None where the scene cannot be written out.

    Parameters
    ----------
    scene : Scene
    paddle : SimulatedPaddle
    **options
        Of ``hl.share``, as they were given; one that cannot be written, such as a function that draws, is named and left out.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle.from_profile("eth", T=5e-4, hand=hl.Hand(k=500, b=2))
    >>> print(*shared_code(hl.wall(k=300, x_o=0.01), paddle, time_scale=0.5), sep="", end="")
    import hapticlab as hl
    <BLANKLINE>
    scene = hl.wall("zoh")
    scene = scene(x_o=0.01, k=300.0)
    paddle = hl.SimulatedPaddle.from_profile("eth", T=0.0005, hand=hl.Hand(b=2.0, k=500.0))
    hl.share(scene, paddle, time_scale=0.5)
    """
    written = scene_code(scene)
    if written is None:
        return None
    call = "".join(f", {option}={value!r}" for option, value in options.items() if _is_plain(value))
    left_out = "".join(f"  # {option}=... was given as well" for option, value in options.items() if not _is_plain(value))
    return f"{written}\n", f"paddle = {_paddle(paddle)}\nhl.share(scene, paddle{call}){left_out}\n"


def why_private(text):
    """Return why the text of a scene file may not be meant for readers, in words, or nothing."""
    if len(text) > LONG:
        return f"it has {len(text)} letters"
    found = _PATHS.search(text)
    return f"it names a place on this computer, {found[0].strip()}..." if found else ""


def _paddle(paddle):
    named = kind_named(paddle.profile.name) if paddle.profile else None
    if named is not None and named == paddle.profile:
        of = f'hl.SimulatedPaddle.from_profile("{named.name}"'
        changes = _changes(paddle, SimulatedPaddle.from_profile(named), "profile")
        return f"{of}{''.join(f', {change}' for change in changes)})"
    return f"hl.SimulatedPaddle({', '.join(_changes(replace(paddle, profile=None), None))})"


def _changes(record, usual, *without):
    """Yield arguments that differ from another record, or from the defaults."""
    for field in fields(record):
        value, before = getattr(record, field.name), getattr(usual, field.name) if usual else field.default
        if field.name not in without and value != before:
            yield f"{field.name}={_hand(value) if field.name == 'hand' else repr(value)}"


def _hand(hand):
    """A hand, by its preset where it has the constants of one, without its intent: the visitor has one."""
    if hand is None:
        return "None"
    hand = replace(hand, intent=None)
    preset = next((name for name in PRESETS if not {"m", "b", "k"} & {change[0] for change in _changes(hand, Hand(name))}), None)
    named = [f'"{preset}"'] if preset else []
    return f"hl.Hand({', '.join([*named, *_changes(hand, Hand(preset))])})"


def _is_plain(value):
    return value is None or isinstance(value, (bool, int, float, str)) or (
        isinstance(value, dict) and all(isinstance(name, str) and isinstance(ends, tuple) for name, ends in value.items())
    )  # fmt: skip
