"""What stands around the view in a shared file: its title, a sentence, equations, the code to copy, what the file is not."""

import re
from html import escape

from ...errors import ParameterError
from ...library.entries import CATALOGUE
from ...scene.laws.taps import TAPS
from .equations import equations
from .scene_code import library_name

NO_CODE = "The Python of this scene is not included. Ask the author of the page for it."
ABOUT = (
    "This file contains everything that it needs. It uses no network, stores nothing about you and never opens a port, so it "
    "cannot move a motor. The scene runs on a simulated paddle."
)
CHANGES = (
    "The values that you change are kept in the address of the page, in the notation of <code>hapticlab run --set</code>. If you "
    "add <code>#{example}</code> to a link to the page, it opens with this value."
)


#: names that hl.wall gives to its scenes
_WALL = re.compile(rf"({'|'.join(TAPS)}) wall(, .*)?")
OF_A_WALL = "A spring and a damper at the boundary x_o. Drag the handle, or move it with the arrow keys."
OF_ANY = "A simulated paddle. Drag its handle, or move it with the arrow keys."


def heading(scene):
    """Return the title of a scene's page.

    Examples
    --------
    >>> import hapticlab as hl
    >>> heading(hl.library.stick_slip()), heading(hl.wall("ellis"))
    ('Stick-slip', 'Virtual wall, law ellis')
    """
    wall = _WALL.fullmatch(scene.name)
    return f"Virtual wall, law {wall[1]}{wall[2] or ''}" if wall else scene.name[:1].upper() + scene.name[1:]


def lead(scene):
    """Return a sentence or two on a scene, for its page's head and for search engines.

    Examples
    --------
    >>> import hapticlab as hl
    >>> lead(hl.library.stick_slip())
    "A block on a rough floor, pulled by the handle through the coupler's spring."
    >>> lead(hl.wall()(k=300, x_o=0.01))
    'A spring and a damper at the boundary x_o. Drag the handle, or move it with the arrow keys.'
    """
    known = library_name(scene)
    if not known:
        return OF_A_WALL if _WALL.fullmatch(scene.name) else OF_ANY
    title = CATALOGUE[known].title.removesuffix(".")
    head, _, rest = title.partition(": ")
    said = rest if head.lower() == scene.name else title
    return f"{said[0].upper()}{said[1:]}."


def fixed(scene, source):
    """Return, of each parameter that a page cannot change, the sentence on why, name -> words.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.device.simulated.stepping import Stepping
    >>> paddle, gears = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), hl.library.gears()
    >>> fixed(gears, Stepping(paddle, gears))["N_1"]
    'N_1 is not a live parameter of gears (N_1: in a constraint, so not live). It has J_1, J_2, K, b_c, c, r.'
    """
    found = {}
    for name in scene.parameters:
        try:
            source.check(**{name: scene.values[name]})
        except ParameterError as why:
            found[name] = str(why)
    return found


def body(scene, code, fixed):
    """Return the HTML below the view.

    Parameters
    ----------
    scene : Scene
    code : (str, str) or None
        Python before and after a visitor's values; None where the author gives none.
    fixed : collection of str
        Parameters that a page cannot change.
    """
    lines = "".join(f"<p>{line}</p>" for line in equations(scene))
    return f"""<section class="hl-part" aria-labelledby="hl-equations">
<h2 id="hl-equations">Equations</h2>
<div class="hl-equations" tabindex="0" role="group" aria-labelledby="hl-equations">{lines}</div>
</section>
<section class="hl-part" aria-labelledby="hl-python">
<h2 id="hl-python">Python</h2>
{_code(code)}
</section>
<section class="hl-part" aria-labelledby="hl-about">
<h2 id="hl-about">About this file</h2>
<p>{ABOUT}{_changes(scene, fixed)}</p>
</section>
"""


def _changes(scene, fixed):
    """Say how an address carries values, with one of the scene's own, if it has any that can be changed."""
    free = [name for name in scene.values if name not in fixed]
    if not free:
        return ""
    name = next((name for name in free if scene.values[name]), free[0])  # B = 0 would say little
    unit = scene.parameters[name].unit
    return " " + CHANGES.format(example=f"{name}={scene.values[name]:g}{'' if unit == '1' else unit}")


def _code(code):
    if code is None:
        return f"<p>{NO_CODE}</p>"
    text = escape("".join(code), quote=False)
    return f"""<p>Where hapticlab is installed, this makes the scene, its paddle and this page again.
<button type="button" id="hl-copy" hidden>Copy</button> <span id="hl-copied" role="status"></span></p>
<pre class="hl-python" tabindex="0" role="group" aria-labelledby="hl-python"><code id="hl-code">{text}</code></pre>"""
