"""What the command line says of a site of the labs: its steps, its size, how to look at it and how to publish it."""

from ..site.build import build_site
from .labs import words_of


def site(parser, options):
    """Build the site, and say how to look at it and how to publish it."""
    built = build_site(
        options.folder, pyodide=options.pyodide, wheel=options.wheel, say=lambda step: print(f"  {step}", flush=True)
    )
    print(f"site in {built.folder.resolve()}: {built.files} files, {built.size / 1e6:.0f} MB, built in {built.seconds:.0f} s")
    look = words_of(["python", "-m", "http.server", "--bind", "127.0.0.1", "--directory", str(built.folder), "8000"])
    print(f"\nto look at it: {look}\nthen open http://127.0.0.1:8000; from a file, without a server, it does not run")
    print("to publish it: copy the whole folder to a web server with https. Licences of all parts are in licences/index.html")
    return 0
