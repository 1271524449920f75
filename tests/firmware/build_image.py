"""firmware/build.py as a module: its folder is no package, and ``build`` is the name of one on PyPI."""

import importlib.util
from pathlib import Path

FIRMWARE = Path(__file__).resolve().parents[2] / "firmware"
_SPEC = importlib.util.spec_from_file_location("build_image_of_firmware", FIRMWARE / "build.py")
build_image = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(build_image)
build, symbols, sizes, tool = build_image.build, build_image.symbols, build_image.sizes, build_image.tool
FLASH, RAM = build_image.room("uno")
