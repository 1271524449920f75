"""Write firmware/generated/messages.h: the tables of messages.py as C99.

Run ``python -m hapticlab.device.link.message_headers FOLDER`` after changing a table; a test proves the committed file fresh.
"""

import sys
from pathlib import Path

from . import messages as tables

NOTICE = "/* Written by hapticlab/device/link/message_headers.py: change the Python tables, not this file. */\n"
C_TYPES = {"B": "uint8_t", "H": "uint16_t", "I": "uint32_t", "i": "int32_t", "b": "int8_t", "f": "float", "8s": "bytes"}


def generate():
    """Return the generated files, name to text."""
    lines = [NOTICE, "#ifndef HL_MESSAGES_H", "#define HL_MESSAGES_H", "", "#include <stdint.h>", ""]
    lines += [
        f"#define HL_PROTOCOL {tables.PROTOCOL}",
        f"#define HL_FIRMWARE_MAJOR {tables.FIRMWARE[0]}",
        f"#define HL_FIRMWARE_MINOR {tables.FIRMWARE[1]}",
        f"#define HL_PROTOCOL_HASH 0x{tables.table_hash():08x}UL",
        f"#define HL_SETTINGS_HASH 0x{tables.settings_hash():08x}UL",
        f"#define HL_LARGEST_PAYLOAD {tables.LARGEST_PAYLOAD}",
        f"#define HL_HOST_SILENCE_MS {tables.HOST_SILENCE_MS}",
        f"#define HL_UNCHECKED_FORCE_N {tables.UNCHECKED_FORCE_N}f",
        f"#define HL_OVERRUNS_IN_A_ROW {tables.OVERRUNS_IN_A_ROW}",
        f"#define HL_OVERRUNS_PER_SECOND {tables.OVERRUNS_PER_SECOND}",
        "",
    ]
    lines += ["/* X(name, number, bytes of the fields, guarded, more bytes may follow) */", "#define HL_MESSAGES(X) \\"]
    rows = [(name, m.number, m.struct.size, int(m.guarded), int(m.open)) for name, m in tables.MESSAGES.items()]
    lines += [f"    X({', '.join(map(str, row))}) \\" for row in rows]
    lines[-1] = lines[-1].removesuffix(" \\")
    lines += [""]
    lines += _enum("HL_MESSAGE_", {name: m.number for name, m in tables.MESSAGES.items()})
    lines += _offsets()
    own = {name: number for name, (number, _) in tables.RESULTS.items() if number >= 32}
    lines += _enum("HL_RESULT_", own)
    lines += _enum("HL_FAULT_", {"NONE": 0} | {name: row[0] for name, row in tables.FAULTS.items()})
    for prefix, table in (
        ("HL_STATE_", tables.STATES), ("HL_TARGET_", tables.TARGETS), ("HL_FLAG_", tables.FLAGS),
        ("HL_SAMPLE_", tables.SAMPLE_FLAGS), ("HL_OPTION_", tables.OPTIONS), ("HL_SENSOR_", tables.SENSORS),
        ("HL_DRIVE_", tables.DRIVES), ("HL_MOTOR_", tables.MOTOR_LAWS),
        ("HL_RESET_", {name: number for name, (number, _) in tables.RESET_CAUSES.items()}),
    ):  # fmt: skip
        lines += _enum(prefix, table)
    lines += _settings()
    return {"messages.h": "\n".join(lines) + "\n#endif\n"}


def _enum(prefix, numbers):
    return ["enum {", *(f"    {prefix}{name} = {number}," for name, number in numbers.items()), "};", ""]


def _offsets():
    """Return where each field of a payload begins."""
    lines = ["/* where the fields of a payload begin */", "enum {"]
    for name, message in tables.MESSAGES.items():
        at = 0
        for type, field in message.fields:
            lines.append(f"    HL_AT_{name}_{field.upper()} = {at}, /* {C_TYPES[type]} */")
            at += tables.struct.calcsize("<" + type)
    return [*lines, "};", ""]


def _settings():
    """Return the settings as structs: what the loop works with, and the whole record around it."""
    loop = [name for _, name, *_ in tables.LOOP_SETTINGS]
    paths = {name: f"loop.{name}" if name in loop else name for name in tables.SETTING_RANGES}
    ranges = [f"    X({paths[name]}, {low!r}f, {high!r}f) \\" for name, (low, high) in tables.SETTING_RANGES.items()]
    wiring = tables.struct.calcsize("<" + "".join(type for type, name, *_ in tables.LOOP_SETTINGS if name in tables.WIRING))
    return [
        "/* what the loop works with */", "typedef struct {", *_members(tables.LOOP_SETTINGS), "} hl_settings;", "",
        "/* what survives power-off */", "typedef struct {", *_members(tables.SETTINGS[:1]), "    hl_settings loop;",
        *_members(tables.SETTINGS[1 + len(loop) :]), "} hl_record;", "",
        f"#define HL_RECORD_BYTES {tables.SETTINGS_STRUCT.size} /* on the wire and in the store: no compiler may pad it */",
        f"#define HL_NO_PIN {tables.NO_PIN}",
        f"#define HL_METRES_PER_COUNT_MIN {tables.METRES_PER_COUNT_MIN}f", f"#define HL_COUNTS_MAX {tables.COUNTS_MAX}f",
        f"#define HL_WRAP_MIN {tables.WRAP_MIN}", f"#define HL_WRAP_MAX {tables.WRAP_MAX}", "",
        f"#define HL_WIRING_BYTES {wiring} /* what a person confirms, from {tables.WIRING[0]} on */", "",
        "/* X(member of the record, lowest, highest) */", "#define HL_SETTING_RANGES(X) \\", *ranges[:-1],
        ranges[-1].removesuffix(" \\"), "",
    ]  # fmt: skip


def _members(rows):
    return [f"    {C_TYPES[type]} {name}; /* [{unit}] {meaning} */" for type, name, unit, meaning in rows]


if __name__ == "__main__":
    for name, text in generate().items():
        Path(sys.argv[1], name).write_text(text)
