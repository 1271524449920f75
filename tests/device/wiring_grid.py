"""Wirings over a grid of pins, possible and not: what Python says of them and what a board's firmware says must agree."""

from itertools import product

from hapticlab.device.wiring import DRIVE_ROLES, SENSOR_ROLES, Wiring


def grid(pins, carriers=(7_812,)):
    """Yield wirings on a board of some hundred combinations per carrier, at the edges of what it can do."""
    edges = sorted(
        {*list(pins.names)[:4], *list(pins.names)[-3:], *pins.busy, *pins.spi.values(), *pins.register.values(), 5, 9, 40}
    )
    for sensor, drive in product(SENSOR_ROLES, DRIVE_ROLES):
        for a, b in product(edges, repeat=2):
            fixed = [pins.register.get(role, 1) for role in ("LATCH", "CLK", "DATA")]
            motor = {1: (a,), 2: (a, 8), 3: (4, 7, a), 4: (a, *fixed)}[len(DRIVE_ROLES[drive])]
            own = (b,) if len(SENSOR_ROLES[sensor]) == 1 else (2, b)
            yield from (Wiring(sensor, drive, motor, own, carrier) for carrier in carriers)
