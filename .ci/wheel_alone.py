"""What an installed wheel must hold, run by .ci/run from another folder, with no compiler in reach and no cache."""

import json
import pathlib
import sys

import hapticlab
from hapticlab.cli.options import PAGES
from hapticlab.compiler.engines import engine, firmware_library
from hapticlab.device.wirings import BUILDS

package = pathlib.Path(hapticlab.__file__).parent
assert "site-packages" in str(package), package
assert list((package / "firmware").rglob("*.c")), "no firmware in the wheel"
for image in ("uno.hex", "pico.uf2"):
    assert (package / "firmware" / "prebuilt" / image).is_file(), f"no {image} in the wheel"
assert (package / "examples" / "mass_on_coupler.py").is_file()
assert not (package.parent / "tests").exists(), "the wheel holds tests"
labs, written = (
    sorted(notebook.name for notebook in (folder / "labs").glob("[0-9][0-9]_*/[0-9][0-9]_*.ipynb"))
    for folder in (package, pathlib.Path(__file__).parents[1])
)
assert labs == written != [], "labs are missing in the wheel"
for page in PAGES.values():
    assert (package / "docs" / page).is_file(), f"no {page} in the wheel"
assert len(list((package / "docs" / "images" / "wiring").glob("*.svg"))) == len(BUILDS), "drawings are missing in the wheel"
assert not list(package.rglob("solution*")), "the wheel holds solutions"
assert (package / "grading" / "pages" / "pages.css").is_file()
assert {"view.js", "view.css"} <= {file.name for file in (package / "widgets" / "browser").iterdir()}
assert (pathlib.Path(sys.prefix) / "etc/jupyter/jupyter_server_config.d/hapticlab.json").is_file()
for bits in (8, 16):
    assert firmware_library.prebuilt(bits), f"no library of {bits}-bit words of these sources in the wheel"
scene = hapticlab.wall()(k=150, x_o=0.01)
program = hapticlab.compile(scene, T=1e-3)
x = hapticlab.SimulatedPaddle(m=0.05, b=0.1, T=1e-3).run(scene, duration=0.1, v=1.0).x
vm, reference = (engine.load(program, name).run(len(x), x[:, None], program.values).outputs for name in ("vm", "interpreter"))
assert (vm == reference).all() and vm.max() > 1, vm.max()
shared = pathlib.Path("wall.html")
hapticlab.share(scene, hapticlab.SimulatedPaddle.from_profile("hapkit"), shared)
assert 100_000 < shared.stat().st_size < 500_000, shared.stat().st_size
facts = json.loads(pathlib.Path("facts.json").read_text())
assert all(hand["within_one_grid_step"] for hand in facts["hands"]), facts["hands"]
print("wheel: ok")
