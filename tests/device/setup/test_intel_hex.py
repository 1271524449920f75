"""Intel HEX, against files that a second encoder writes here."""

import random

import pytest

from hapticlab.device.setup.intel_hex import parse_hex
from hapticlab.errors import PaddleError

END = ":00000001FF"


def record(address, data, kind=0):
    raw = [len(data), address >> 8, address & 255, kind, *data]
    return ":" + "".join(f"{b:02X}" for b in [*raw, (256 - sum(raw)) % 256])


def test_bytes_come_back_from_lines_of_any_length_in_any_order():
    content = random.Random(1).randbytes(3000)
    cuts = [0, *sorted(random.Random(2).sample(range(1, 3000), 60)), 3000]
    lines = [record(a, content[a:b]) for a, b in zip(cuts, cuts[1:], strict=False)]
    random.Random(3).shuffle(lines)
    assert parse_hex("\r\n".join([*lines, END, ""])) == content
    assert parse_hex("\n".join([*(line.lower() for line in lines), END])) == content


def test_a_gap_is_erased_flash():
    assert parse_hex(f"{record(0, b'ab')}\n{record(5, b'c')}\n{END}") == b"ab\xff\xff\xffc"


def test_bases_are_added():
    """A segment's base is in sixteens, a linear one in 65536; a start address says nothing to a board."""
    text = [record(0, bytes.fromhex("0010"), 2), record(1, b"S"), record(0, bytes.fromhex("0001"), 4), record(2, b"L")]
    text += [record(0, bytes(4), 3), record(0, bytes(4), 5), END]
    content = parse_hex("\n".join(text))
    assert (content[0x101], content[0x10002], len(content)) == (ord("S"), ord("L"), 0x10003)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"{record(0, b'ab')[:-1]}0\n{END}", "line 1 has a wrong checksum"),
        (f"{record(0, b'ab')[:-2]}\n{END}", "line 1 does not have the length"),
        (f"{record(0, b'ab')}\n:00\n{END}", "line 2 does not have the length"),
        (f"{record(0, b'ab')[:-1]}\n{END}", "half a byte"),
        (f":0G{record(0, b'ab')[3:]}\n{END}", "not a hexadecimal digit"),
        (f"{record(0, b'ab')[1:]}\n{END}", "does not begin with a colon"),
        (record(0, b"ab"), "no end record"),
        (f"{END}\n{record(0, b'ab')}", "line 2 comes after the end"),
        (f"{record(0, b'ab')}\n{record(1, b'c')}\n{END}", "line 2 writes address 0x0001 a second time"),
        (f"{record(0, b'ab', 6)}\n{END}", "kind 6"),
        (END, "holds no data"),
        ("", "no end record"),
        (f"{record(0, bytes.fromhex('0810'), 4)}\n{record(0, b'a')}\n{END}", "a different chip"),
    ],
)
def test_a_damaged_file_is_refused(text, words):
    with pytest.raises(PaddleError, match=f"uno.hex.*{words}"):
        parse_hex(text, "uno.hex")


def test_every_single_changed_digit_is_noticed():
    line = record(0x1234, b"\x01\x23\xab")
    for at in range(1, len(line)):
        for digit in "0123456789ABCDEF":
            if digit != line[at]:
                with pytest.raises(PaddleError):
                    parse_hex(f"{line[:at]}{digit}{line[at + 1 :]}\n{END}")
