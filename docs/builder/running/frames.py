"""Live frames: a shared file (``hl.share``) inside a page, which the reader moves."""

from html import escape
from pathlib import Path

#: folder of the site that holds one shared file for each frame
LIVE = "live"


def frame(name: str, html: str, *, folder: Path, page: str, title: str, address: str = "") -> str:
    """Write a shared file into the site, and return the HTML of a frame that shows it.

    The frame is loaded when a reader scrolls near it. Without scripts it shows the first picture of the scene, its equations and
    its code, which are part of the shared file.

    Parameters
    ----------
    name : str
        Of the file, without its ending, and of the frame, so that ``<a target=name>`` gives it other values.
    html : str
        Text of the shared file.
    folder : Path
        The file is written into ``folder/live``.
    page : str
        The page on which the frame stands, such as "gallery/detents", without an ending.
    title : str
        What the frame shows, for who does not see it.
    address : str
        Values other than those of the file, such as "#k=4000N/m".

    Examples
    --------
    >>> import tempfile
    >>> made = frame("wall", "<p>...", folder=Path(tempfile.mkdtemp()), page="gallery/wall", title="A wall")
    >>> made.splitlines()[1][:74]
    '<iframe name="wall" src="../live/wall.html" title="A wall" loading="lazy" '
    """
    path = Path(folder, LIVE, f"{name}.html")
    path.parent.mkdir(exist_ok=True)
    if path.is_file() and path.read_text("utf-8") != html:
        raise ValueError(f"the frame {name!r} of page {page} differs from the frame of this name on another page; rename one")
    path.write_text(html, "utf-8", newline="\n")
    link = escape(f"{'../' * page.count('/')}{LIVE}/{name}.html{address}")
    return f"""<div class="hl-frame">
<iframe name="{name}" src="{link}" title="{escape(title)}" loading="lazy" sandbox="allow-scripts allow-downloads"></iframe>
<p><a href="{link}">Open alone</a></p>
</div>"""
