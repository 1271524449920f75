"""No public call takes more than eight arguments, ``**options`` counted as one; records group the others."""

import inspect

from hapticlab import vocabulary

#: dataclasses that are themselves the record of a thing, and so have as many fields as the thing has
RECORDS = {
    "hl.SimulatedPaddle", "hl.Device", "hl.devices.PaddleProfile", "hl.records.Telemetry", "hl.mechanics.Mechanics",
    "hl.people.Task", "hl.design.CompensationLimit", "hl.methods.Method", "hl.devices.DriveTrain",
}  # fmt: skip
#: nine: keywords that pass through paddle.run, live and many tests as they are; and for hl.live and hl.share what a first view
#: needs, by the same names
NINE = {"hl.compile", "hl.sweep", "hl.live", "hl.share"}


def counts():
    for name, value in vocabulary.public().items():
        try:
            yield name, len(inspect.signature(value).parameters)
        except (TypeError, ValueError):  # no callable, or an error's class
            continue


def test_no_signature_is_past_eight():
    long = {name: many for name, many in counts() if many > 8}
    assert set(long) == RECORDS | NINE
    assert all(long[name] == 9 for name in NINE)
