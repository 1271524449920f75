"""Programs and settings onto a board, in pieces, whole or not at all."""

import math
import zlib

from ...errors import PaddleError
from ..link.messages import LARGEST_PAYLOAD, SENSORS, SETTINGS_STRUCT, TARGETS
from .settings import Settings

#: of one piece; the offset takes two bytes
PIECE = LARGEST_PAYLOAD - 2
#: a small board writes 300 bytes a second into its store [s]
STORE_PATIENCE = 6.0


def upload(exchange, target, data):
    """Send bytes to a target, "PROGRAM", "SETTINGS" or "STANDALONE"; the board verifies before it takes them into use.

    Every piece has its place, so that repeats and reorder do no harm; a missing piece fails the CRC-32 of the whole. That
    is the one that data ends with: a CRC-32 over data and its own CRC-32 is the same for all data of one length.

    Raises
    ------
    LinkError
        With the board's reason.
    """
    number = TARGETS[target]
    exchange.command("BEGIN", number, len(data))
    for offset in range(0, len(data), PIECE):
        exchange.command("DATA", offset, rest=data[offset : offset + PIECE])
    patience = {} if target == "PROGRAM" else {"patience": STORE_PATIENCE, "tries": 2}
    exchange.command("COMMIT", number, len(data), zlib.crc32(data[:-4]), **patience)


def check_room(board, settings, program):
    """Refuse a program whose period, watched channels or parameters a board cannot take.

    Parameters
    ----------
    board : dict
        Its WELCOME.
    settings : Settings or None
    program : Program
    """
    check_period(board, program.T, settings)
    watched, room = len(program.outputs) - 1, board["channels"] - 3
    if watched > room:
        raise PaddleError(f"{program.name} watches {watched} channels; this board transmits at most {room}. Watch fewer.")
    odd = [c.name for c in program.parameters if c.type != "f32"]
    if odd:
        raise PaddleError(f"{program.name}: {odd[0]} is not a float32, which a board needs. Compile with dtype='float32'.")


def check_period(board, T, settings=None):
    """Refuse a period [s] that the board's timer cannot do, or, by its settings, its sensor; name the nearest it can."""
    low, high, why = board["period_min"] * 1e-6, board["period_max"] * 1e-6, ""
    if settings is not None and settings.sensor != SENSORS["QUADRATURE"]:
        # the sensor is read once a period; 3/8 of its counts a period are what the firmware still tells from a turn over
        unseen = 0.375 * settings.wrap * abs(settings.metres_per_count) / settings.speed_max
        if T > unseen and high > unseen:
            high = math.floor(unseen * 1e6) * 1e-6
            why = f", because at speed_max = {settings.speed_max:g} m/s its magnet must not make half a turn between two samples"
        # it trusts no reading in flight, and decides with the next one: two of one flight would be taken for a motion
        if T < settings.sensor_flight * (1 - 1e-6):  # kept as a float32
            low = max(low, math.ceil(settings.sensor_flight * 1e6 - 1e-3) * 1e-6)
            why = f", because its sensor takes {settings.sensor_flight:g} s from its last count back to its first"
    if not low * (1 - 1e-9) <= T <= high * (1 + 1e-9):
        nearer = low if T < low else high
        raise PaddleError(f"T = {T:g} s; this board needs {low:g} to {high:g} s{why}. Use T={nearer:g}")


def read_settings(exchange):
    """Return the board's Settings, or None where it was never given any."""
    data = b""
    while len(data) < SETTINGS_STRUCT.size:
        reply = exchange.ask("READ", len(data), min(PIECE, SETTINGS_STRUCT.size - len(data))).fields
        if not reply["rest"]:
            return None
        data += reply["rest"]
    return Settings.from_bytes(data)
