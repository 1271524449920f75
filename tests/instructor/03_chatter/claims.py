"""What lab 03 says of the paddle in use; see tests/labs/test_on_paddles.py."""

import math

import hapticlab as hl


def chatters(lab, stiffness, push=1.0, **start):
    """Return the amplitude [m] of a handle that leaves the wall under this push, 0 where it does not."""
    pressed = hl.SimulatedPaddle.from_profile(lab.my_paddle, hand=hl.Hand("pinch", push=push))
    found = hl.chatter(pressed.run(lab.wall(k=stiffness), duration=4.0, **start))
    return found.amplitude if found.contacts_per_second > 0 else 0.0


def begins_by_itself(lab):
    """A hand that presses while the stiffness comes from the exact limit to above the second one."""
    return chatters(lab, 1.1 * lab.onset, x=1 / (lab.limit + lab.k_h)) > 0


def begins_after_a_knock(lab):
    return chatters(lab, 1.1 * lab.onset, x=1 / (1.1 * lab.onset + lab.k_h), v=0.2) > 0


def begins_at_a_stiffness(lab):
    at = [(push, part) for push in (0.5, 1.0, 2.0) for part in (0.9, 1.1)]
    return all((chatters(lab, part * lab.limit, push) > 0) == (part > 1) for push, part in at)


def leaves_in_each_cycle(lab):
    found = [hl.chatter(lab.records[k]) for k in list(lab.records)[2:]]
    return all(one.frequency and abs(one.contacts_per_second / one.frequency - 1) < 0.02 for one in found)


def is_slower(lab):
    linear = {k: ((k + lab.k_h) / lab.M) ** 0.5 / (2 * math.pi) for k in lab.bounces}
    return len(linear) >= 3 and all(hl.chatter(lab.records[k]).frequency < linear[k] for k in linear)


def winds_inwards(lab):
    ends = [max(abs(record.v_true[-100:])) for record in (lab.small, lab.large)]
    return abs(ends[1] / ends[0] - 1) < 0.12 and lab.thrown > 2 * ends[0]


def bends_like(lab):
    """The first order is within 5 % of the exact limit at every delay of the map, the lag of the sensor included."""
    for delay in (0.0, 1e-3, 3e-3):
        late = hl.SimulatedPaddle.from_profile(lab.my_paddle, hand=lab.pressed.hand, delay=delay)
        first = lab.stability_estimate(lab.total, late.T, delay + late.sensor_delay)
        if abs(first / hl.stability_limit(late).K - 1) > 0.05:
            return False
    return True


CLAIMS = [
    (
        "keep still: the force is about 1 N, and the handle is calm",
        lambda lab: lab.trials.buzz.lowest > lab.limit * 2 / 3,
        "um make the handle buzz above",
    ),
    (
        "Chatter begins at a certain *stiffness*, not at a certain force",
        begins_at_a_stiffness,
        "stops small oscillations",
    ),
    ("the handle vibrates", begins_by_itself, "stops small oscillations"),
    ("after a knock", begins_after_a_knock, ""),
    (
        "If you press harder, the chatter becomes larger",
        lambda lab: chatters(lab, 1.1 * lab.onset, 2.0) > 1.1 * chatters(lab, 1.1 * lab.onset, 1.0) > 0,
        "",
    ),
    (
        "an oscillation that remains there never leaves the wall",
        lambda lab: all(hl.chatter(lab.records[k]).contacts_per_second == 0 for k in (lab.softest, lab.soft)),
        "",
    ),
    ("the handle leaves the wall in each cycle", leaves_in_each_cycle, ""),
    (
        "(On the stiffest of these walls the motor's limit contributes",
        lambda lab: max(lab.records[lab.stiffest].F) >= lab.my_paddle.force_max,
        "",
    ),
    ("Why is chatter slower than", is_slower, ""),
    ("a larger oscillation shrinks down to it", winds_inwards, ""),
    ("the limit is little more than half as high", lambda lab: 0.5 < lab.limits[0.5] / lab.limits[1.0] < 0.6, ""),
    (
        "the exact limit is close to the passivity limit",
        lambda lab: 1 <= hl.stability_limit(lab.hung).K / hl.passivity_limit(lab.hung).K < 1.1,
        "",
    ),
    ("it is the curve that bends like", bends_like, ""),
]
