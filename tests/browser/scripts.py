"""The browser's half of the live view in a page of its own: no notebook, no kernel."""

from hapticlab.widgets.browser_view import BROWSER, SCRIPTS

PARTS = """View, Kernel, Playback, Samples, Bins, Scale, Loop, Voice, Slider, between, lastCycle, niceStep, onDark, tidy, shown,
number, hint"""


def add_scripts(page):
    """Bring the scripts of the live view into a page; their classes are ``parts.View`` and so on."""
    source = "\n".join((BROWSER / script).read_text("utf-8") for script in SCRIPTS).replace("export default { render }", "")
    page.add_style_tag(content=(BROWSER / "view.css").read_text("utf-8"))
    page.add_script_tag(content=f"(() => {{ {source}\n window.parts = {{ {PARTS} }} }})()")
