"""Write widgets/browser/board/messages.js: what a page must know of boards, from the tables and constants of Python.

Run ``python -m hapticlab.device.board.message_scripts FOLDER`` after changing a table; a test proves the committed file fresh.
"""

import json
import sys
from pathlib import Path

from ...compiler.boards.board_records import BOARDS, Drive
from ..link import exchange, messages, serial_ports
from ..live_parameters import MOST_AT_ONCE
from . import greeting, host_board, serial_paddle, streaming, upload

NOTICE = "// Written by hapticlab/device/board/message_scripts.py: change the Python tables, not this file.\n"


def generate():
    """Return the generated files, name to text."""
    lines = [f"  {name}: {_text(table)}," for name, table in tables().items()]
    return {"messages.js": "\n".join([NOTICE, "const TABLES = {", *lines, "}", ""])}


def tables():
    """Return all that a page takes from here, name to what JSON can carry; times are in seconds."""
    return {
        "protocol": messages.PROTOCOL,
        "firmware": messages.FIRMWARE,
        "table": messages.table_hash(),
        "settings_layout": messages.settings_hash(),
        **_messages(),
        **{name.lower(): getattr(messages, name) for name in _PLAIN},
        "settings": [row[:3] for row in messages.SETTINGS],
        "host_silence": messages.HOST_SILENCE_MS / 1000,
        "unchecked_force": messages.UNCHECKED_FORCE_N,
        "baudrate": serial_ports.BAUDRATE,
        "usb": [{"vendor": usb.vendor, "product": usb.product, "words": usb.words} for b in BOARDS.values() for usb in b.usb],
        "drives": [name for name, board in BOARDS.items() if isinstance(board.flashing, Drive)],
        "heartbeat": exchange.HEARTBEAT,
        "patience": exchange.PATIENCE,
        "tries": exchange.TRIES,
        "hello_again": greeting.AGAIN,
        "hello_patience": greeting.HELLO,
        "silence": serial_paddle.PATIENCE,
        "leash": streaming.LEASH,
        "lead": streaming.LEAD,
        "piece": upload.PIECE,
        "set_at_once": MOST_AT_ONCE,
        "store_bytes": host_board.STORE_BYTES,
        "duty_full": host_board.DUTY_FULL,
    }


#: tables and numbers of messages.py that go as they are
_PLAIN = (
    "RESULTS", "FAULTS", "STATES", "TARGETS", "FLAGS", "SAMPLE_FLAGS", "RESET_CAUSES", "SENSORS",
)  # fmt: skip


def _messages():
    rows = {
        name: {"number": m.number, "fields": m.fields, "guarded": m.guarded, "open": m.open}
        for name, m in messages.MESSAGES.items()
    }
    return {"messages": rows, "answers": exchange.ANSWERS}


def _text(table):
    """A table as JavaScript, a row a line."""
    if not isinstance(table, dict | list) or not table:
        return json.dumps(table)
    opening, closing = "{}" if isinstance(table, dict) else "[]"
    rows = [f"{json.dumps(k)}: {json.dumps(v)}" for k, v in table.items()] if opening == "{" else map(json.dumps, table)
    return "\n".join([opening, *(f"    {row}," for row in rows), f"  {closing}"])


if __name__ == "__main__":
    for name, text in generate().items():
        Path(sys.argv[1], name).write_text(text, "utf-8")
