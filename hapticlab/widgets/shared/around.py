"""What stands around the view in a shared file: what it is in a sentence, equations, the code to copy, what the file is not."""

from html import escape

from ...errors import ParameterError
from ...library.entries import CATALOGUE
from .equations import equations
from .scene_code import library_name

NO_CODE = (
    "This scene is not written out as Python here, since it holds contacts, shapes or models of its author's own. Ask the author "
    "for the Python file."
)
ABOUT = (
    "This file holds all that it needs: it asks for no network, keeps nothing about you and never opens a port, so no motor can "
    "move. The scene runs on a simulated paddle. What you change stands in the address of the page, in the words of "
    "<code>hapticlab run --set</code>: a link with <code>#k=150N/m;x_o=10mm</code> after its name opens with these values."
)


def lead(scene):
    """Return a sentence on a scene, for its page's head and for search engines.

    Examples
    --------
    >>> import hapticlab as hl
    >>> lead(hl.library.stick_slip())
    "A block on a rough floor, pulled by the handle through the coupler's spring."
    >>> lead(hl.wall()(k=300, x_o=0.01))
    'A simulated paddle with the scene zoh wall: drag its handle, or move it with the arrow keys.'
    """
    known = library_name(scene)
    own = f"A simulated paddle with the scene {scene.name}: drag its handle, or move it with the arrow keys."
    if not known:
        return own
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


def body(scene, code):
    """Return the HTML below the view.

    Parameters
    ----------
    scene : Scene
    code : (str, str) or None
        Python before and after a visitor's values; None where the author gives none.
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
<p>{ABOUT}</p>
</section>
"""


def _code(code):
    if code is None:
        return f"<p>{NO_CODE}</p>"
    text = escape("".join(code), quote=False)
    return f"""<p>Where hapticlab is installed, this makes the scene, its paddle and this page again.
<button type="button" id="hl-copy" hidden>Copy</button> <span id="hl-copied" role="status"></span></p>
<pre class="hl-python" tabindex="0" role="group" aria-labelledby="hl-python"><code id="hl-code">{text}</code></pre>"""
