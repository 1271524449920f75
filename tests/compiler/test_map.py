"""The page that follows a scene through the compiler names files that exist; its example runs with the others."""

import re
from pathlib import Path

from hapticlab import compiler

FOLDER = Path(compiler.__file__).parent


def test_every_module_named_exists():
    named = set(re.findall(r"``([a-z_.]+)``", compiler.__doc__))
    assert {"lower", "dynamics", "scene.mechanics", "pairs", "touch"} <= named
    for name in named:
        folder = FOLDER.parent if "." in name else FOLDER
        assert folder.joinpath(*name.split(".")).with_suffix(".py").exists(), name
