"""The page that follows a scene through the compiler names files that exist; its example runs with the others."""

import re
from pathlib import Path

from hapticlab import compiler

FOLDER = Path(compiler.__file__).parent
STEMS = {path.stem for path in FOLDER.rglob("*.py")}


def test_every_module_named_exists():
    named = set(re.findall(r"``([a-z_.]+)``", compiler.__doc__))
    assert {"compile_scene", "dynamics", "broad_phase", "touch"} <= named
    for name in named:
        assert name in STEMS or FOLDER.parent.joinpath(*name.split(".")).with_suffix(".py").exists(), name
