"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

WRONG = [
    ("handle_position", lambda counts, left, right, travel: counts * travel / (right - left)),
    ("handle_position", lambda counts, left, right, travel: (counts - (left + right) / 2) * travel / abs(right - left)),
    ("sign_evidence", lambda asked, moved, on: np.sum(asked * moved) / np.sqrt(np.sum((asked * moved) ** 2))),
    ("force_full", lambda duty, grams: np.polyfit(duty, grams * 9.80665e-3, 1)[0]),
    ("force_full", lambda duty, grams: np.polyfit(duty**2, grams * 9.80665, 1)[0]),
    ("motor_current", lambda force, drum, sector, handle, torque_constant, supply, resistance:
        np.clip(force * handle * sector / drum / torque_constant, -supply / resistance, supply / resistance)),
    ("motor_current", lambda force, drum, sector, handle, torque_constant, supply, resistance:
        force * drum * handle / sector / torque_constant),
    ("motor_current", lambda force, drum, sector, handle, torque_constant, supply, resistance: force * drum / torque_constant),
    ("felt_stiffness", lambda x, F: np.mean(F / x)),
    ("limits", lambda k, metres_per_count, force_max, T: {
        "reach": k / force_max, "force_step": k * metres_per_count, "speed_step": metres_per_count / T}),
    ("which_way", "a"),
]  # fmt: skip
