"""Intel HEX: the file a compiler leaves for a microcontroller's flash. Source: Intel, Hexadecimal Object File Format, 1988."""

from ...errors import PaddleError

DATA, END, SEGMENT, START_SEGMENT, LINEAR, START_LINEAR = range(6)


def parse_hex(text, name="the image"):
    """Return a hex file's bytes, from address 0 to the last one it has; what it leaves out is 0xFF, as erased flash is.

    Parameters
    ----------
    text : str
    name : str
        Said in errors.

    Raises
    ------
    PaddleError
        If a line is damaged, two lines want the same byte, or the end is missing.

    Examples
    --------
    >>> parse_hex(":0300000002337A4E\\n:0100050042B8\\n:00000001FF").hex()
    '02337affff42'
    """
    content, base, ended = {}, 0, False
    for number, line in enumerate(text.split(), 1):
        here = f"{name}, line {number}"
        if ended:
            raise _damaged(here, "comes after the end record")
        address, kind, data = _record(line, here)
        if kind == DATA:
            for at, byte in enumerate(data, base + address):
                if at in content:
                    raise _damaged(here, f"writes address 0x{at:04x} a second time")
                content[at] = byte
        elif kind == END:
            ended = True
        elif kind in (SEGMENT, LINEAR):
            base = int.from_bytes(data, "big") << (4 if kind == SEGMENT else 16)
        elif kind not in (START_SEGMENT, START_LINEAR):  # where a PC would start it: nothing to a board
            raise _damaged(here, f"has kind {kind}; there are 0 to 5")
    if not ended:
        raise _damaged(name, "has no end record, so part of the file is missing")
    if not content:
        raise _damaged(name, "holds no data")
    return content_bytes(content, name)


def content_bytes(content, name):
    """Return bytes by address as one piece, 0xFF between."""
    size = max(content) + 1
    if size > 1 << 20:
        raise PaddleError(
            f"{name} reaches 0x{size - 1:x}; the flash memory of a board ends far below that. Is this the "
            "file of a different chip?"
        )
    return bytes(content.get(at, 0xFF) for at in range(size))


def _record(line, here):
    if not line.startswith(":"):
        raise _damaged(here, "does not begin with a colon")
    try:
        raw = bytes.fromhex(line[1:])
    except ValueError:
        raise _damaged(here, "has a character that is not a hexadecimal digit, or half a byte") from None
    if len(raw) < 5 or len(raw) != raw[0] + 5:
        raise _damaged(here, "does not have the length that it states")
    if sum(raw) % 256:
        raise _damaged(here, "has a wrong checksum")
    return int.from_bytes(raw[1:3], "big"), raw[3], raw[4:-1]


def _damaged(here, what):
    return PaddleError(f"{here} {what}; the file is damaged: build it or copy it again")
