"""UF2, the format in which a board's drive takes firmware: 512 bytes a block, each with its own address.

Microsoft, github.com/microsoft/uf2: two magic numbers, flags, address, size of the data, number of the block, count of
blocks, family of the chip, 476 bytes of which 256 are used, a third magic number.
"""

import struct

from ....errors import PaddleError

BLOCK, PAGE = 512, 256
BEGIN, END = (0x0A324655, 0x9E5D5157), 0x0AB16F30
#: flags: the block is not for the chip's flash; the family is named
NOT_FLASH, HAS_FAMILY = 0x00000001, 0x00002000
HEAD = struct.Struct("<8I")


def as_uf2(pages, family):
    """Return the file of these pages.

    Parameters
    ----------
    pages : iterable of (int, bytes)
        Address and up to 256 bytes, which zeros fill up.
    family : int

    Returns
    -------
    bytes
    """
    pages = list(pages)
    blocks = []
    for k, (address, data) in enumerate(pages):
        head = HEAD.pack(*BEGIN, HAS_FAMILY, address, PAGE, k, len(pages), family)
        blocks.append(head + data.ljust(BLOCK - HEAD.size - 4, b"\0") + END.to_bytes(4, "little"))
    return b"".join(blocks)


def parse_uf2(content, name="file", family=None):
    """Return address and bytes of every block, in the order of the file.

    Parameters
    ----------
    content : bytes
    name : str
        Of the file, for errors.
    family : int, optional
        The chip that is asked for; another, or none, is refused.

    Raises
    ------
    PaddleError
        If the file is no UF2 file, is cut, lacks a block, or is for another chip.
    """
    if content[:8] != struct.pack("<2I", *BEGIN):
        raise PaddleError(f"{name} is not a UF2 file; give the .uf2 file of the firmware")
    if len(content) % BLOCK:
        raise PaddleError(f"{name} has {len(content)} bytes; needs a multiple of {BLOCK}. It is cut: download it again")
    pages = []
    for at in range(0, len(content), BLOCK):
        *magic, flags, address, size, number, count, chip = HEAD.unpack_from(content, at)
        end = int.from_bytes(content[at + BLOCK - 4 : at + BLOCK], "little")
        if tuple(magic) != BEGIN or end != END or size > BLOCK - HEAD.size - 4:
            raise PaddleError(f"{name}: block {at // BLOCK} is damaged; download the file again")
        if number != at // BLOCK or count != len(content) // BLOCK:
            raise PaddleError(f"{name}: block {number} of {count} is at place {at // BLOCK} of {len(content) // BLOCK}; "
                              "needs every block once. Download the file again")  # fmt: skip
        if family is not None and not (flags & HAS_FAMILY and chip == family):
            of = f"family 0x{chip:08x}" if flags & HAS_FAMILY else "a chip that it does not name"
            raise PaddleError(f"{name} is for {of}; needs 0x{family:08x}. Choose the image of this board")
        if not flags & NOT_FLASH:
            pages.append((address, content[at + HEAD.size : at + HEAD.size + size]))
    return pages
