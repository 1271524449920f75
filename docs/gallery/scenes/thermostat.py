"""A thermostat that you feel

A relay heats a body until it is warm and lets it cool until it is cold. While the heater is on, the handle feels a small force.

What it teaches: a relay with a band, and a state of its own beside a differential equation. The band decides how often the
heater switches.

Labs: 16

* `low=19.9;high=20.1`: A tenth of the band: the heater switches more than eight times as often, and the handle vibrates.
* `tau=2s`: A body that takes four times as long to warm up: the heater switches a quarter as often.
"""

import sympy as sp

import hapticlab as hl
from hapticlab import n, t

theta = hl.coordinate("theta", unit="K", initial=20)  # above the room
on = hl.signal("on", unit="1")
tau, hot, low, high = hl.parameters("tau hot low high", units="s K K K", values=(0.5, 50, 19, 21))
F_r = hl.parameters("F_r", units="N", values=0.1)
relay = sp.Eq(on(n), hl.when(theta < low, 1, hl.when(theta > high, 0, on(n - 1))))
heats = sp.Eq(tau * theta.diff(t), hot * on(n) - theta)
scene = hl.Scene(force=F_r * on(n), eom=[relay, heats], watch={"theta": theta, "on": on(n)}, name="thermostat")

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "thermostat.html", sliders={"low": (15, 20), "high": (20, 25), "tau": (0.1, 3)})
