"""How far the bounds on a wall's stiffness lie apart, and what each assumes: writes docs/explanation/passivity_bounds.md.

    python tests/benchmarks/passivity_bounds.py [--write]

Theory only, no simulation: the same numbers on every computer. Some 5 s.
"""

import sys
from pathlib import Path

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import t
from hapticlab.errors import AnalysisError

PAGE = Path(__file__).parents[2] / "docs" / "explanation" / "passivity_bounds.md"
T = 1e-3
LAWS = {"zoh": "(23.1)", "backward_difference": "(23.5)", "ellis": "(23.7)"}
DELAYS = (0.0, 0.25, 0.5, 1.0, 2.0, 3.0)
DEVICES = {
    "hobby paddle": {"m": 0.03, "b": 0.1, "coulomb": 0.02, "counts_per_metre": 4000},
    "heavy paddle": {"m": 0.166, "b": 0.057, "coulomb": 0.05, "counts_per_metre": 20000},
    "braked feather-weight": {"m": 0.005, "b": 2.0},
}
PINCH = hl.Hand(m=0.02, b=1.0, k=200)


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def place(margin):
    """Return in words which frequencies ask for the most."""
    ends = margin.asked([1e-4, np.pi / 2, np.pi]) > margin.required * (1 - 1e-6)
    if ends.all():
        return "everywhere"
    return "at 0 and 1" if ends[0] and ends[2] else f"at {2 * margin.frequency * T:.2f}"


def laws():
    rows = []
    for law, equation in LAWS.items():
        asked = [hl.passivity.margin(hl.Device(b=1, delay=d * T), hl.laws.LinearLaw.of(law, K=1 / T, T=T)) for d in DELAYS]
        rows.append([f"{law} {equation}", *(f"{m.required:.4f} {place(m)}" for m in asked)])
    return table(["law, b/(K T) at part of Nyquist", *(f"delay {d:g} T" for d in DELAYS)], rows)


def filtered():
    rows = []
    for tau in (0.0, 0.5, 1.0, 3.0, 10.0):
        limits = [hl.passivity_limit(hl.Device(b=0.1, T=T), B=B, velocity_filter=tau * T).K for B in (0.05, -0.05)]
        rows.append([f"{tau:g} T", *(f"{K:.1f}" for K in limits)])
    return table(["time constant", "B = +b/2: K [N/m]", "B = -b/2: K [N/m]"], rows)


def named():
    rows = []
    for name, device in DEVICES.items():
        for words, hand, delay in (("", None, 0.0), (", pinched", PINCH, 0.0), (", T/2 late", None, T / 2)):
            found = hl.bounds.table(hl.SimulatedPaddle(T=T, hand=hand, delay=delay, **device))
            cells = ["-" if isinstance(limit, str) else f"{limit.K:.4g}" for limit in found.found.values()]
            rows.append([name + words, *cells])
    return table(["K [N/m]", *found.found], rows)


def between():
    fractions = (0.1, 0.25, 0.5, 0.75, 0.9)
    ratio = [
        hl.bounds.diolaiti(hl.Device(b=1, T=T, delay=f * T)).K / hl.passivity_limit(hl.Device(b=1, T=T, delay=f * T)).K
        for f in fractions
    ]
    return table(["delay", *(f"{f:g} T" for f in fractions)], [["Diolaiti over exact", *(f"{r:.4f}" for r in ratio)]])


def gil():
    """Ratios to the exact limit over a grid of plants, by e, the size of what the formula leaves out."""
    found = []
    for m in (0.01, 0.05, 0.3):
        for b in (0.01, 0.1, 1.0):
            for B in (-0.9, -0.5, 0.0, 1.0, 3.0):
                for delay in (0.0, 0.7, 2.0):
                    paddle = hl.SimulatedPaddle(m=m, b=b, T=T, delay=delay * T)
                    tau = T / 2 + paddle.delay
                    K = (b + B * b) / tau
                    exact = hl.stability_limit(paddle, B=B * b).K
                    factor = (1 + abs(B)) / (1 + B)
                    found.append(((K * tau**2 / m + abs(B * b) * tau / m) * factor, K / exact))
    left_out, ratio = np.array(found).T
    rows = []
    for low, high in ((0, 0.01), (0.01, 0.1), (0.1, 0.5), (0.5, np.inf)):
        here = ratio[(left_out >= low) & (left_out < high)]
        rows.append([f"{low:g} to {high:g}", len(here), f"{here.min():.3f}", f"{here.max():.3f}"])
    return table(["e", "plants", "least Gil/exact", "largest"], rows)


def couplers():
    rows = []
    for delay in DELAYS:
        paddle = hl.SimulatedPaddle(m=0.05, b=0.2, T=T, delay=delay * T)
        best, bare = hl.design.coupler(paddle), hl.design.coupler(paddle, b_c=0.0)
        wall = hl.passivity_limit(hl.Device(b=0.2, T=T, delay=delay * T)).K
        cells = [f"{K * T / 0.2:.4f}" for K in (best.k_c, best.b_c / T, bare.k_c, wall)]
        cells.insert(2, f"{2 * best.frequency * T:.3f}" if delay else "everywhere")
        rows.append([f"{delay:g} T", *cells])
    head = ["delay", "k_c T/b", "b_c/b", "stopped at, of Nyquist", "k_c T/b without b_c", "fixed wall K T/b"]
    return table(head, rows)


def compiled():
    z = hl.coordinate("z", unit="m")
    K, B, m = hl.parameters("K B m", units="N/m N*s/m kg", values=(300, 0.05, 0.05))
    F = hl.laws.virtual_coupler(z, K=K, b=B)
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)])
    paddle, rows = hl.SimulatedPaddle(m=0.05, b=0.2, T=T), []
    for method, hold in (("semi_implicit_euler", "zoh"), ("exact", "zoh"), ("exact", "soh"), ("rk4", "soh")):
        row = [f"{method}, {hold}"]
        for k_c, b_c in ((300, 0.05), (360, 0.02)):
            for mass in (0.002, 0.05, 0.5):
                row.append(f"{hl.passivity.port(paddle, scene(K=k_c, B=b_c, m=mass), method=method, hold=hold).b_req:.4f}")
        rows.append(row)
    return table(["method, hold", "b_c = 0.05: 2 g", "50 g", "500 g", "b_c = 0.02: 2 g", "50 g", "500 g"], rows)


def admittance():
    rows = []
    for part in (0.1, 0.3, 0.5, 0.7, 0.9, 1.1, 100.0):
        cells = []
        for b, delay in ((0.5, 0.0), (0.5, 0.2), (2.0, 0.0), (2.0, 0.2)):
            paddle = hl.SimulatedPaddle(m=0.05, b=b, T=T, delay=delay * T)
            try:
                cells.append(f"{1e3 * hl.design.admittance(paddle, servo=part * b).m_a:.0f}")
            except AnalysisError as refused:
                cells.append("diverges alone" if "diverges" in str(refused) else "active in some hand")
        rows.append([f"{part:g}", *cells])
    return table(["b_s/b", "b = 0.5 N s/m: body [g]", "0.2 T late", "b = 2 N s/m: body [g]", "0.2 T late"], rows)


TEXT = """# Bounds on the stiffness of a wall: what each guarantees, and how far apart they are

Written by `tests/benchmarks/passivity_bounds.py`; theory only. T = 1 ms where a number has a unit.

## The device damping that each law needs

Passivity in any passive hand, the spring always acting (Colgate and Schenkel 1997; `hl.passivity.margin`):

{laws}

If x(n) and v(n) are exact at the samples, Eq. (23.3) is passive on no device, because the velocity jumps there.
`hl.bounds.table` rejects the formulas below for Eq. (23.3), because they are for laws in position; on a paddle with an
encoder Eq. (23.3) becomes Eq. (23.5), in every row.

**No linear law is passive with K > 2 b/T.** Averaged over frequency, every stable law of stiffness K at rest needs K T/2,
and the plain spring without delay needs this amount at every frequency. A predictor that needs less for slow motion needs
more near the Nyquist frequency. So without delay, prediction helps with one hand and one handle (`hl.stability_limit`), but
not with all hands. With delay, the plain spring needs most for slow motion, and prediction helps with all hands: of the
delays above, Eq. (23.5) helps from half a period, and Eq. (23.7) from two periods.

**The condition does not account for switching.** With `gate` and one period of delay, the cycle x = 0 (just outside),
0.7865, 1, 0.1739 makes the law of Eq. (23.7) draw energy up to b = 1.5331 K T, above the 1.5282 of the table; with half a
period, a cycle of three samples draws energy up to 1.3306 K T, above 1.3150. Without delay, a search over cycles of up to
12 samples found no value above the table, for any law, `gate` or `clip`; for the plain law this is proved.
`hl.passivity.worst_motion` searches such cycles.

## A damper on a filtered velocity

b = 0.1 N s/m, first-order filter by backward mapping. A positive damper needs most at the Nyquist frequency, where a filter
makes the damper small: b > K T/2 + B/(1 + 2 tau/T). A negative damper needs most for slow motion, which no filter changes:
b > K T/2 + |B|.

{filtered}

## The bounds of the field by name

`hl.bounds.table(paddle)`; a dash shows that an assumption fails, and the object then contains the sentence that says which
one.

{named}

* **Colgate, Schenkel**: passivity, any passive hand; viscous damping alone.
* **Abbott, Okamura** (2005): passivity with an encoder, min(2 b/T, 2 f_c/Delta); no delay, no virtual damping, Eq. (23.1).
* **Diolaiti** (2006): the same with delay, passivity for whole periods. With a fraction of a period (T/2 late above) it is
  a limit for slow sinusoids, and its kind says so. `hl.bounds.diolaiti_plane` shows in which region of its plane a wall
  lies.
* **Gil** (2004, 2009): stability of this plant to first order in the delay. It does not guarantee passivity, and it is not
  a bound in the strict sense, because it errs in both directions.
* **exact stability**: eigenvalues of the sampled loop.

Minsky et al. (1990) is not in the list, because their inequality was not available in print, and the forms quoted from it
differ.

### Diolaiti between whole periods of delay

The formula is exact for whole periods. Between them a hand may move faster before the force changes than after, and the
formula is up to (1 + sqrt(4/3))/2 = 1.0774 times the passive limit, at a quarter of a period:

{between}

### Gil against the exact limit

135 plants without a hand, B from -0.9 b to 3 b; e = ((K + k_h) tau^2/M + |B| tau/M) (b + |B|)/(b + B) with tau = T/2 +
delay. The formula neglects an amount of stiffness, so a negative damper that leaves little of b makes this amount large
compared with K. `hl.bounds.gil` raises an error above e = 0.1.

{gil}

## Virtual couplers for an impedance display

The stiffest spring in parallel with the best damper that is absolutely stable, with every passive hand and every
environment that is passive at the sample rate (Llewellyn's criterion; `hl.design.coupler`):

{couplers}

Without delay the pairs are k_c T/2 + b_c <= b. With a delay of d + f periods, slow motion limits a spring alone, at
2/((1-f) (d+1)^2 + f (d+2)^2) b/T, because an environment stores and returns energy, which a fixed wall does not. A damper
in parallel with the spring compensates for that: at one period the best is 4/sqrt(27) b/T with b_c = 0.282 b, more than the
fixed wall, which has no damper.

### The damping that the compiled scene needs

The criterion needs an environment that is passive at the sample rate in F[n] and (z[n] - z[n-1])/T. Bodies that are stepped
by backward Euler together with their coupler are passive in this sense. A compiled scene is not, not even one that is solved
without error: a sampled force acts after its sample, and a spring that is solved exactly lacks the damping k_c T/2 that one of
backward differences shows to its environment. Where a body resonates on the coupler, only b_c dissipates energy. Of all
lossless bodies together, the impedance is a circle of diameter 1/Re(1/Z_c), and a force that is late by tau turns it by the
angle w tau. In slow motion the scene therefore needs

    b = k_c^2 tau^2/(4 b_c)

of the device, where tau = T/2 without delay, and tau^2 = T^2 ((1-f) (d + 1/2)^2 + f (d + 3/2)^2) with one of d + f periods. The
larger of this and of the criterion counts: without delay it is this one where k_c T/2 > 4.83 b_c. With a delay it is nearly
always this one. `hl.passivity.port` finds the need of a scene exactly. Two couplers that the criterion allows on a device of
0.2 N s/m, k_c = 300 N/m with b_c = 0.05 N s/m and 360 N/m with 0.02 N s/m, where the line above gives 0.1125 and 0.4050 N s/m.
One body on each; with the exact map, a handle that is taken as resting (zoh) makes the force later still, by T/2:

{compiled}

## Virtual couplers for an admittance display

The dual problem: find the lightest body that can be shown, instead of the stiffest spring (`hl.design.admittance`; a device
of 50 g, simulated only, because a paddle has no force sensor). It is a continuous approximation for frequencies below the
Nyquist frequency, with the servo late by half a period of hold, by the delay, and by half a period more for its velocity,
which is a backward difference. The servo alone, with the environment at rest, must satisfy Eq. (23.10) exactly: b >= k_s
T/2 + b_s without delay. In the columns with a delay, both the sensor and the servo are late.

{admittance}

No body in the table is lighter than the device itself, because the servo lags, and only inertia compensates for a lag. A
servo firmer than the device's own damping is unstable in the hand of some spring even without an environment, although many
human hands keep it stable; a much firmer servo diverges alone (`hl.stability.damper_limit`). The approximation was found to
fail on a device of 50 g and 10 N s/m, m/b = 5 T: there, sampled loops of springs and bodies grow by up to 1 % per sample
with the mass that it gives.
"""


def page():
    parts = (laws, filtered, named, between, gil, couplers, compiled, admittance)
    return TEXT.format(**{part.__name__: part() for part in parts})


if __name__ == "__main__":
    text = page()
    if "--write" in sys.argv:
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(text, "utf-8")
    print(text)
