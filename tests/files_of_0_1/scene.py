"""A scene file as one wrote it for version 0.1."""

import hapticlab as hl

z = hl.coordinate("z", unit="m")
K, m = hl.parameters("K m", units="N/m kg", values=(300, 0.05))
motion = hl.lagrange(m * z.diff(hl.t) ** 2 / 2 - K * (hl.x(hl.t) - z) ** 2 / 2)
scene = hl.Scene(force=K * (hl.x(hl.t) - z), eom=motion)
