"""``uno://name``: an emulated Uno as a serial port in virtual time. ``offer(name, loop)`` makes the name known."""

import serial

BOARDS = {}
HANDLERS = "ports"


def offer(name, loop):
    """Let ``uno://name`` open this ClosedLoop, and return the URL."""
    if HANDLERS not in serial.protocol_handler_packages:
        serial.protocol_handler_packages.append(HANDLERS)
    BOARDS[name] = loop
    return f"uno://{name}"
