"""What a type checker must refuse, a statement a line; each also ends in an error when it runs."""

import hapticlab as hl

paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
wall = hl.wall()(k=150)
log = paddle.run(wall, duration=0.01)

# a name that is not there
hl.wal()  # type: ignore[attr-defined]

# a word too few, or another word
hl.parameters("k", unit="N/m")  # type: ignore[call-arg]
hl.coordinate("z")  # type: ignore[call-arg]
paddle.run(wall)  # type: ignore[call-arg]
hl.Hand(pushes=2.0)  # type: ignore[call-arg]

# physical quantities go by name; mypy 2 gave this error another code
hl.passivity_limit(0.1, 1e-3)  # type: ignore
hl.SimulatedPaddle(0.05, 0.1, 1e-3)  # type: ignore
