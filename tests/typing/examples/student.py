"""What students write, as in README.md and in labs 00 to 07; a type checker passes it, and it runs."""

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x

# README's first example
k, x_o = hl.parameters("k x_o", units="N/m m")
wall = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)))
paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0))
log = paddle.run(wall(k=150, x_o=0.01), duration=0.5)
hl.plot(log, "x", "F")
print(hl.chatter(log))

z = hl.coordinate("z", unit="m")
m, b, K = hl.parameters("m b K", units="kg N*s/m N/m")
F_c = K * (x(t) - z) + b * (v(t) - z.diff(t))
mass = hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2), F_c)])
program = hl.compile(mass, method="rk4", T=1e-3)
print(program, len(program), [channel.name for channel in program.outputs])

grid = hl.sweep(wall(x_o=0), paddle, k=np.geomspace(20, 2000, 5), T=[5e-4, 1e-3], progress=False)
print(hl.passivity_limit(hl.Device(b=0.1, T=1e-3)))
print(hl.stability_limit(paddle, law="zoh"))
grid.plot()

# lab 00: records are arrays, parameters a dict, a profile makes a paddle
held = hl.SimulatedPaddle.from_profile(
    "hapkit", hand=hl.Hand("grip", grip=4, intent=hl.people.MinimumJerk(end=0.015, duration=0.5))
)
spring = hl.Scene(force=hl.parameters("k", units="N/m") * x(n), name="centring spring")
felt = held.run(spring(k=300), duration=0.1)
print(f"x from {1e3 * felt.x.min():.2f} to {1e3 * felt.x.max():.2f} mm; asked for {felt.parameters['k']:g} N/m")
print(f"the fit: {np.dot(felt.x, felt.F) / np.dot(felt.x, felt.x):.0f} N/m, at the end {float(felt.F[-1]):.3f} N")

# lab 01: texts with units, a scene's values, a refusal
try:
    print(spring(k="0.3 N/mm").values)
except hl.HapticlabError as refusal:
    print("refused:", refusal)
k_c, b_c = hl.parameters("k_c b_c", units="N/m N*s/m", values=("200 N/m", 0.5), ranges=((0, 500), (0, 2)))
y = hl.coordinate("y", unit="m", initial=x(n))
coupled = hl.Scene(force=k_c * (x(t) - y), eom=[sp.Eq(b_c * y.diff(t), k_c * (x(t) - y))], watch=[y], name="a damper")
followed = paddle.run(coupled, duration=0.1, method="semi_implicit_euler", progress=False)
print(followed.y[-1], followed.channels["y"].mean())

# labs 02 and 03: energy, chatter, limits
thrown = hl.SimulatedPaddle(m=0.05, b=0, T=1e-3)
bounce = thrown.run(hl.wall()(k=500), duration=0.05, x=-0.25e-3, v=0.1)
stairs = hl.records.staircase(bounce)
print(f"generated {1e3 * hl.energy(bounce).generated:.4g} mJ in {stairs.bounces[0].last - stairs.bounces[0].first} periods")
stairs.plot()
for delay in (0.0, 0.5e-3):
    slow = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"), delay=delay)
    exact = hl.stability_limit(slow)
    print(f"{exact.K:9.1f} N/m at {exact.frequency:4.1f} Hz")

# lab 11: the laws of the chapter
for law in ("zoh", "backward_difference", "ellis"):
    print(
        f"{law:20} {hl.passivity_limit(hl.Device(b=0.1, T=1e-3), law=law).K:10.0f} N/m", hl.compile(hl.wall(law)(k=500), T=1e-3)
    )
print(hl.design.compare_laws(thrown, K=500, laws=["zoh", "ellis"], entries=2))
theta = np.linspace(1e-3, np.pi, 9)
print(hl.passivity.margin(hl.Device(b=0.1), hl.laws.LinearLaw.of("zoh", K=200, T=1e-3)).asked(theta).mean())

# labs 05 and 06: a passivity controller, a virtual coupler, the library
kept = thrown.run(hl.laws.passivity_controller(hl.wall(), alpha_max=5.0)(k=500), duration=0.05, v=0.2)
print(hl.energy(kept))
angle = hl.coordinate("angle", unit="rad", initial=0.3)
M, l, g = hl.parameters("M l g", units="kg m m/s^2", values=(0.05, 0.15, 9.81))
swing = hl.mechanics.lagrange(M * (z.diff(t) + l * angle.diff(t)) ** 2 / 2 + M * g * l * sp.cos(angle), forces={z: F_c})
print(hl.design.coupler(paddle, b_c=0.02), hl.passivity.port(paddle, mass(m=0.05, b=0.5, K=300)))
print(hl.library.cart_pole().values, hl.library.catalogue["detents"].title)

# lab 07: steps
for method in ("semi_implicit_euler", "verlet", "rk4"):
    print(f"{method:20s} {1e3 * hl.stability.step_limit(mass(m=0.05, b=0.5, K=300), method, T=1e-3).h_max:6.3f} ms")
motion = hl.methods.handle_motions()[1]
truth = hl.methods.reference(mass(m=0.05, b=0.5, K=300), motion)
print(hl.methods.force_error(hl.compile(mass(m=0.05, b=0.5, K=300), T=1e-3, live=()), truth).relative)
