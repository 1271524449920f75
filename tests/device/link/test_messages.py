"""The tables that the firmware and the package share, and the header made of them."""

import struct
from dataclasses import replace

import pytest

from hapticlab.compiler.engines import firmware_library
from hapticlab.device.link import message_headers, messages
from hapticlab.device.link.messages import LOOP_SETTINGS, MESSAGES, SETTINGS, WIRING, Message, fields


def test_the_committed_header_is_fresh():
    for name, text in message_headers.generate().items():
        assert (firmware_library.firmware_folder() / "generated" / name).read_text() == text


def test_numbers_are_unique_and_on_their_side():
    numbers = [m.number for m in MESSAGES.values()]
    assert len(set(numbers)) == len(numbers) and max(numbers) < 32 and min(numbers) > 0
    said = {"ACK", "WELCOME", "PONG", "STATE", "BYTES", "SAMPLE", "FAULTED"}
    assert {name for name, m in MESSAGES.items() if m.number >= 16} == said
    for table in (messages.RESULTS, messages.FAULTS, messages.RESET_CAUSES):
        assert len({row[0] for row in table.values()}) == len(table)
    for table in (messages.FLAGS, messages.SAMPLE_FLAGS, messages.OPTIONS):
        assert sorted(table.values()) == [1 << k for k in range(len(table))]


def test_what_can_move_the_motor_is_guarded_and_the_host_can_always_say_stop():
    assert {name for name, m in MESSAGES.items() if m.guarded} >= {"START", "SET", "COMMIT", "HOME", "CLEAR", "ARM"}
    assert MESSAGES["STOP"].fields == ()


def test_no_payload_is_larger_than_the_frames():
    for name, m in MESSAGES.items():
        assert m.struct.size <= messages.LARGEST_PAYLOAD, name


def test_fields_are_read_in_order_and_without_padding():
    m = Message(1, fields("B a, I b, h c"), open=True)
    assert m.struct.size == 7
    assert m.unpack(bytes([1, 2, 0, 0, 0, 0xFF, 0xFF, 9])) == {"a": 1, "b": 2, "c": -1, "rest": b"\x09"}


def test_every_offset_of_the_header_is_where_python_packs():
    text = message_headers.generate()["messages.h"]
    for name, m in MESSAGES.items():
        for k, (type, field) in enumerate(m.fields):
            at = struct.calcsize("<" + "".join(t for t, _ in m.fields[:k]))
            assert f"HL_AT_{name}_{field.upper()} = {at}, /* {message_headers.C_TYPES[type]} */" in text


def test_settings_are_packed_as_a_compiler_lays_them_out_and_end_with_their_crc():
    for rows in (LOOP_SETTINGS, SETTINGS):
        types = "".join(type for type, *_ in rows)
        assert struct.calcsize("<" + types) == struct.calcsize("=" + types) == struct.calcsize("@" + types) and "x" not in types
        assert struct.calcsize("<" + types) % 4 == 0
    assert SETTINGS[0][1] == "layout" and SETTINGS[-1][1] == "crc" and SETTINGS[1 : 1 + len(LOOP_SETTINGS)] == LOOP_SETTINGS
    names = [name for _, name, *_ in LOOP_SETTINGS]
    first = names.index(WIRING[0])
    assert names[first : first + len(WIRING)] == list(WIRING)  # in one piece


#: (table, what to make of it): every table that a board must agree on
CHANGES = {
    "PROTOCOL": lambda a: a + 1,
    "LARGEST_PAYLOAD": lambda a: a + 1,
    "HOST_SILENCE_MS": lambda a: a + 1,
    "UNCHECKED_FORCE_N": lambda a: 2 * a,
    "OVERRUNS_IN_A_ROW": lambda a: a + 1,
    "OVERRUNS_PER_SECOND": lambda a: a + 1,
    "RESULTS": lambda a: a | {"BUSY": (99, "")},
    "FAULTS": lambda a: a | {"SENSOR": (99, "", "")},
    "RESET_CAUSES": lambda a: a | {"POWER": (99, "")},
    "SETTINGS": lambda a: (*a[:3], ("I", "other", "1", ""), *a[3:]),
} | {name: lambda a: a | {"NEW": 64} for name in "STATES TARGETS FLAGS SAMPLE_FLAGS OPTIONS SENSORS DRIVES MOTOR_LAWS".split()}


@pytest.mark.parametrize("table", CHANGES)
def test_the_hash_changes_with_every_table(monkeypatch, table):
    before = messages.table_hash()
    monkeypatch.setattr(messages, table, CHANGES[table](getattr(messages, table)))
    assert messages.table_hash() != before


@pytest.mark.parametrize("change", [
    {"number": 14}, {"fields": fields("I session, B more")}, {"guarded": True}, {"open": True}])  # fmt: skip
def test_the_hash_changes_with_every_part_of_a_message(monkeypatch, change):
    before = messages.table_hash()
    monkeypatch.setitem(MESSAGES, "HELLO", replace(MESSAGES["HELLO"], **change))
    assert messages.table_hash() != before


def test_the_hash_does_not_change_with_words(monkeypatch):
    before = messages.table_hash()
    monkeypatch.setattr(messages, "FAULTS", {name: (row[0], "other", "words") for name, row in messages.FAULTS.items()})
    assert messages.table_hash() == before
