"""Read libraries of Linux, Windows, macOS and Pyodide by their published formats, no matter which computer this is."""

from struct import unpack_from

ELF_MACHINES = {62: "x86_64", 183: "aarch64"}
PE_MACHINES = {0x8664: "x86_64", 0xAA64: "aarch64"}
MACH_O_MACHINES = {0x01000007: "x86_64", 0x0100000C: "aarch64"}


def target(data):
    """Return which system and machine a library is for, as linux-x86_64."""
    if data[:4] == b"\x7fELF":
        return f"linux-{ELF_MACHINES[unpack_from('<H', data, 18)[0]]}"
    if data[:4] == b"\0asm":
        assert data[10:19] == b"\x08dylink.0", "a library for Pyodide says first what it needs"
        return "emscripten-wasm32-32"
    if data[:2] == b"MZ":
        return f"windows-{PE_MACHINES[unpack_from('<H', data, _pe_header(data) + 4)[0]]}"
    assert unpack_from("<I", data)[0] == 0xFEEDFACF, data[:4]
    return f"macos-{MACH_O_MACHINES[unpack_from('<I', data, 4)[0]]}"


def exports(data):
    """Return the names that a library defines for others."""
    readers = {"linux": _elf_exports, "windows": _pe_exports, "macos": _mach_o_exports, "emscripten": _wasm_exports}
    return readers[target(data).split("-")[0]](data)


def elf_sections(data):
    """Return (type, flags, offset, size, link) of each section."""
    (start,), (size, number) = unpack_from("<Q", data, 40), unpack_from("<HH", data, 58)
    found = [unpack_from("<IIQQQQI", data, start + k * size) for k in range(number)]
    return [(kind, flags, offset, length, link) for _, kind, flags, _, offset, length, link in found]


def mach_o_commands(data):
    """Yield (command, its offset) of each load command."""
    at = 32
    for _ in range(unpack_from("<I", data, 16)[0]):
        command, size = unpack_from("<II", data, at)
        yield command, at
        at += size


def _text(data, at):
    return data[at : data.index(b"\0", at)].decode()


def _elf_exports(data):
    sections = elf_sections(data)
    ((_, _, offset, size, link),) = (s for s in sections if s[0] == 11)  # SHT_DYNSYM
    names, found = sections[link][2], set()
    for at in range(offset, offset + size, 24):
        name, info, _, section = unpack_from("<IBBH", data, at)
        if section and info >> 4 == 1:  # defined here, STB_GLOBAL
            found.add(_text(data, names + name))
    return found


def _pe_header(data):
    (at,) = unpack_from("<I", data, 0x3C)
    assert data[at : at + 4] == b"PE\0\0"
    return at


def _pe_exports(data):
    header = _pe_header(data)
    sections, optional = unpack_from("<H", data, header + 6)[0], unpack_from("<H", data, header + 20)[0]
    parts = [unpack_from("<IIII", data, header + 24 + optional + 40 * k + 8) for k in range(sections)]

    def offset(address):
        return next(raw + address - start for size, start, _, raw in parts if start <= address < start + size)

    table = offset(unpack_from("<I", data, header + 24 + 112)[0])
    (number,), (names,) = unpack_from("<I", data, table + 24), unpack_from("<I", data, table + 32)
    addresses = unpack_from(f"<{number}I", data, offset(names))
    return {_text(data, offset(a)) for a in addresses}


def _mach_o_exports(data):
    (at,) = (at for command, at in mach_o_commands(data) if command == 2)  # LC_SYMTAB
    symbols, number, strings, _ = unpack_from("<IIII", data, at + 8)
    found = set()
    for k in range(number):
        name, kind = unpack_from("<IB", data, symbols + 16 * k)
        if kind & 0x0F == 0x0F:  # N_SECT | N_EXT
            found.add(_text(data, strings + name).removeprefix("_"))
    return found


def _leb(data, at):
    """Return an unsigned LEB128 number and where it ends."""
    value = shift = 0
    while True:
        value |= (data[at] & 127) << shift
        at, shift = at + 1, shift + 7
        if data[at - 1] < 128:
            return value, at


def _wasm_exports(data):
    at, found = 8, set()
    while at < len(data):
        kind, (size, at) = data[at], _leb(data, at + 1)
        end = at + size
        if kind == 7:
            number, at = _leb(data, at)
            for _ in range(number):
                length, at = _leb(data, at)
                found.add(data[at : at + length].decode())
                _, at = _leb(data, at + length + 1)
        at = end
    return found
