"""A mass pulled by a virtual coupler, Fig. 23.4, that meets a wall of its own.

Run it:  hapticlab run mass_on_coupler.py --set K=400

The handle feels the coupler alone. Behind it a mass z follows the handle and is stopped at z_o by a stiff spring.
"""

import sympy as sp

import hapticlab as hl
from hapticlab import t, v, x

z = hl.coordinate("z", unit="m")
m, b, K = hl.parameters("m b K", units="kg N*s/m N/m", values=(0.1, 2.0, 300.0))
k_w, z_o = hl.parameters("k_w z_o", units="N/m m", values=(2000.0, 0.005))

F_c = K * (x(t) - z) + b * (v(t) - z.diff(t))
F_w = hl.when(z >= z_o, k_w * (z - z_o))

scene = hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2), F_c - F_w)], watch=[z], name="mass on a coupler")
paddle = hl.SimulatedPaddle.from_profile("eth", hand=hl.Hand(m=0.02, b=1.0, k=200.0, push=2.0))
duration = 3.0
