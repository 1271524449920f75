"""What the page's tests run on: scenes for the host's board, what its store keeps, and what each fault must lead to."""

from faults import FAULTS
from host_driver import SETTINGS, settings

import hapticlab as hl
from hapticlab.device.board.streaming import LEASH
from hapticlab.device.link.messages import SENSORS
from hapticlab.widgets.board_page.programs import Choice, labs, page_data

w, y = hl.parameters("w y", units="N*m m")
QUOTIENT = hl.Scene(force=w / y, name="quotient")(w=0.01, y=0.02)
SILENT = FAULTS["host silent"].within
#: what a page's test brings about: the time until the motor is off [s], and what the page says then; a fault of the board's by
#: the time that tests/firmware/faults.py states
STATED = {
    **{name: (FAULTS[name].within, FAULTS[name].says) for name in (
        "over-speed", "over-travel", "sensor's wire", "sensor frozen", "heat", "division by zero", "program damaged in memory",
        "stack overflow",
    )},
    "press Stop": (0.002, "Motor off"), "page closed": (0.002, None), "another program": (0.002, "Another program connected"),
    "board reset": (0.002, "The board was reset"), "power lost with the cable": (0.002, "disconnected during use"),
    "laptop asleep": (SILENT, "this page was stopped or too busy, for 10 s"),
    "page blocked": (SILENT, "this page was stopped or too busy"), "nobody looks": (LEASH + SILENT, None),
    "port closed": (SILENT, "did not answer"), "unplugged": (SILENT, "disconnected during use"),
    "device accepts no data": (SILENT, "accepted no data"), "garbage": (SILENT, "did not answer"),
}  # fmt: skip


def request(**more):
    """Return what ``in_node.mjs`` is asked."""
    data = page_data(("host",), [labs()[0], Choice("quotient", "A quotient", QUOTIENT, {"y": (0, 0.05)})])
    stores = {
        "usual": settings(ident=0xBEEF, date=20261120),
        "hot": settings(force_continuous=0.8, heating_time=1.0, force_max=0.9),
        "slow": settings(sensor=SENSORS["MAGNETORESISTIVE"], wrap=920, metres_per_count=1e-4, sensor_flight=2e-3),
        "unwired": settings(wired=0, checked=0),
        "unchecked": settings(checked=0),
    }
    known = {name: SETTINGS[name] for name in ("metres_per_count", "force_full", "travel_max")}
    return {"data": data, "known": known, "stores": {name: kept.to_bytes().hex() for name, kept in stores.items()}, **more}
