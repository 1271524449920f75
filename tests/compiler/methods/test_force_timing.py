"""When the force is evaluated: against the states of the same program a period on, and against momentum."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.methods.method_table import METHODS
from hapticlab.errors import ProgramError

T, TICKS = 1e-3, 240
M_, K_, B_ = 0.05, 500.0, 1.0
m, K, B, g = hl.parameters("m K B g", units="kg N/m N*s/m m/s^2", values=(M_, K_, B_, 9.81))
z = hl.coordinate("z", unit="m")
F = hl.laws.virtual_coupler(z, K=K, b=B)
BODY = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)], watch={"z": z, "w": z.diff(t)}, name="body")
SPRUNG = hl.Scene(
    force=K * (x(t) - z), eom=[sp.Eq(m * z.diff(t, 2), K * (x(t) - z))], watch={"z": z, "w": z.diff(t)}, name="sprung"
)
time = np.arange(TICKS) * T
X, V = 0.01 * (1 - np.cos(31 * time)), 0.31 * np.sin(31 * time)


def ran(scene, method, force_at, **options):
    """Return columns F, then the channels."""
    made = {"T": T, "dtype": "float64", "live": (), "velocity": "measured", **options}
    program = hl.compile(scene, method, force_at=force_at, **made)
    inputs = np.array([X, V][: len(program.inputs)]).T
    return load(program).run(TICKS, inputs).outputs[:, :, 0]


@pytest.mark.parametrize("method", [*sorted(set(METHODS) - {"nystrom4"}), "taylor", "exact"])
@pytest.mark.always("euler", "rk4", "verlet", "taylor", "exact")
def test_after_is_the_force_of_the_next_states_with_this_sample(method):
    out = ran(BODY, method, "after")
    at_the_end = K_ * (X[:-1] - out[1:, 1]) + B_ * (V[:-1] - out[1:, 2])
    np.testing.assert_allclose(out[:-1, 0], at_the_end, rtol=0, atol=1e-13)
    assert np.abs(out[:, 0] - ran(BODY, method, "before")[:, 0]).max() > 0.05  # and it is another force


@pytest.mark.parametrize(
    ("scene", "method", "options"),
    [
        *((BODY, method, {}) for method in [*sorted(set(METHODS) - {"nystrom4"}), "taylor", "exact"]),
        (SPRUNG, "nystrom4", {}), (BODY, "verlet", {"substeps": 3, "hold": "foh"}), (BODY, "exact", {"hold": "zoh"}),
        (BODY, "adams_bashforth2", {"substeps": 2}), (BODY, "semi_implicit_euler_damped", {"velocity": "backward_difference"}),
    ],
)  # fmt: skip
def test_the_impulse_of_the_mean_force_is_what_the_body_gains(scene, method, options):
    """The coupler is the only force on the body, so T F(n) is m (w(n+1) - w(n)), to rounding: 1e-16 of m w / T is 1e-15 N."""
    out = ran(scene, method, "mean", **options)
    assert np.abs(out[:, 0]).max() > 0.3
    np.testing.assert_allclose(T * out[:-1, 0], M_ * np.diff(out[:, 2]), rtol=0, atol=2e-17)


def test_the_impulse_is_kept_where_what_is_not_linear_is_left_to_rk4():
    u, k_3 = hl.coordinate("u", unit="m"), hl.parameters("k_3", units="N/m^3", values=1e5)
    pull = K * (x(t) - z)
    scene = hl.Scene(
        force=pull + k_3 * (z - u) ** 3 * 0, watch={"w": z.diff(t), "u": u},
        eom=[sp.Eq(m * z.diff(t, 2), pull), sp.Eq(m * u.diff(t, 2), K * (z - u) - k_3 * u**3)],
    )  # fmt: skip
    out = ran(scene, "exact+rk4", "mean")
    np.testing.assert_allclose(T * out[:-1, 0], M_ * np.diff(out[:, 1]), rtol=0, atol=2e-17)
    with pytest.raises(ProgramError, match="slope changes with"):
        ran(hl.Scene(force=k_3 * (x(t) - z) ** 3, eom=[sp.Eq(m * z.diff(t, 2), pull)]), "exact", "mean")


def test_a_contact_that_is_located_gives_the_mean_of_its_reaction():
    """A ball that has come to rest on the ground: its weight, whatever the instant; while it flies, nothing."""
    high = hl.coordinate("z", unit="m", initial=hl.parameters("h", units="m", values=0.01))
    lands = hl.contact.Contact(high, hl.contact.impulse(e=0.4), name="lands")
    falls = hl.mechanics.lagrange(m * high.diff(t) ** 2 / 2 - m * g * high, contacts=[lands])
    scene = hl.Scene(force=lands.force, eom=[falls], watch={"z": high})
    for force_at in ("before", "after", "mean"):
        force = ran(scene, "taylor", force_at)[:, 0]
        assert force[-1] == pytest.approx(M_ * 9.81, rel=1e-9) and force[5] == 0.0


def test_the_mean_of_a_wall_that_is_entered_within_the_period():
    """x(t) is the line x + v tau of "foh": the mean of k max(0, x - x_o) is k v (T - tau_c)^2/(2 T), tau_c the crossing."""
    k, x_o = hl.parameters("k x_o", units="N/m m", values=(300.0, 0.01))
    scene = hl.Scene(force=hl.when(x(t) > x_o, k * (x(t) - x_o)))
    program = hl.compile(scene, "taylor", T=T, hold="foh", velocity="measured", dtype="float64", force_at="mean")
    (force, *_), *_ = load(program).run(1, [[0.0099, 0.3]]).outputs[:, :, 0]
    assert force == pytest.approx(300.0 * 0.3 * (T - 0.0001 / 0.3) ** 2 / (2 * T), rel=1e-12)
    held = hl.Scene(force=hl.when(x(n) > x_o, k * (x(n) - x_o)))
    assert len(hl.compile(held, T=T, force_at="mean")) == len(hl.compile(held, T=T))  # samples are their own mean


def test_the_reaction_of_a_constraint_on_average():
    """A body on a spring that the handle carries, x = t^2: F = 2 m + k x, and k x has the mean k (x + v T/2 + T^2/3)."""
    q = hl.coordinate("q", unit="m")
    image = hl.mechanics.device_image(q - x(t))
    carried = hl.mechanics.lagrange(m * q.diff(t) ** 2 / 2 - K * q**2 / 2, constraints=[image.constraint])
    s = np.arange(40) * T
    for force_at, expected in (("before", s**2), ("after", s**2), ("mean", s**2 + s * T + T**2 / 3)):
        scene = hl.Scene(force=image.force, eom=[carried])
        program = hl.compile(scene, T=T, force_at=force_at, dtype="float64", velocity="measured")
        out = load(program).run(40, np.array([s**2, 2 * s]).T).outputs[:, 0, 0]
        np.testing.assert_allclose(out[2:], (2 * M_ + K_ * expected)[2:], rtol=1e-12)


@pytest.mark.parametrize("damping", [0.5, 1.0])
def test_the_damping_a_device_needs_is_the_closed_form(damping):
    """Semi-implicit Euler on a coupler, sample held: b = b0/(1 - m0/m) before, b0 (1 - 2 m0/m)/(1 - m0/m) after the step,

    with b0 = K T/2 + B and m0 = b0 T/2. What is felt on average is what is felt before, for the step adds h F(n) alone.
    """
    b_0 = K_ * T / 2 + damping
    ratio = b_0 * T / 2 / M_
    closed = {"before": b_0 / (1 - ratio), "after": b_0 * (1 - 2 * ratio) / (1 - ratio), "mean": b_0 / (1 - ratio)}
    for force_at, needed in closed.items():
        found = hl.passivity.port_damping(
            hl.Device(T=T), BODY(B=damping), method="semi_implicit_euler", hold="zoh", force_at=force_at
        )
        assert found == pytest.approx(needed, rel=1e-12)


def test_a_sweep_and_a_paddle_take_it():
    paddle = hl.SimulatedPaddle(m=0.05, b=1.0, T=T, hand=hl.Hand(push=1.0))
    log = paddle.run(BODY, duration=0.05, force_at="mean", progress=False)
    np.testing.assert_allclose(T * log.F[:-1], M_ * np.diff(log.w), rtol=0, atol=1e-7)
    grid = hl.sweep(BODY, paddle, duration=0.1, metric="peak_force", force_at="after", K=[100.0, 500.0], progress=False)
    assert np.isfinite(grid.values).all()


def test_it_is_told_and_checked():
    assert hl.compile(BODY, T=T, force_at="mean").facts["force_at"] == "mean"
    assert "force_at" not in hl.compile(BODY, T=T).facts
    with pytest.raises(ProgramError, match="force_at = 'late'; needs one of before, after, mean"):
        hl.compile(BODY, T=T, force_at="late")


def test_what_goes_badly_together_is_said():
    """After with a hold that foresees asks for more of a lightly damped body; under zoh substeps leave the error as it is."""
    light = BODY(B=0.05)
    asked = {
        (force_at, hold): hl.passivity.port_damping(hl.Device(T=T), light, force_at=force_at, hold=hold)
        for force_at in ("before", "after") for hold in ("zoh", "foh", "soh")
    }  # fmt: skip
    for (force_at, hold), b in asked.items():
        notes = str(hl.compile(light, T=T, force_at=force_at, hold=hold).notes)
        worse = force_at == "after" and b > 1.5 * max(asked["before", hold], asked["after", "zoh"])
        assert ("more device damping" in notes) == worse == (force_at == "after" and hold != "zoh")
    exact = hl.compile(light, "exact", T=T, force_at="after", live=())
    assert "more device damping" in str(exact.notes)
    F = {n: ran(BODY, "rk4", "before", hold="zoh", substeps=n)[:, 0] for n in (1, 2, 8)}
    assert np.abs(F[2] - F[1]).max() < 1e-3 * np.abs(F[1] - ran(BODY, "rk4", "before", hold="soh")[:, 0]).max()
    for substeps, hold in ((1, "zoh"), (2, "zoh"), (2, "foh")):
        said = "substeps shorten the step" in str(hl.compile(BODY, T=T, substeps=substeps, hold=hold).notes)
        assert said == (substeps > 1 and hold == "zoh")


def test_a_micro_impulse_has_no_mean():
    high = hl.coordinate("z", unit="m", initial=hl.parameters("h", units="m", values=0.01))
    hovers = hl.contact.Contact(high, hl.contact.micro_impulse(e=0.4), name="hovers")
    falls = hl.mechanics.lagrange(m * high.diff(t) ** 2 / 2 - m * g * high, contacts=[hovers])
    with pytest.raises(ProgramError, match=r"N_hovers\(t\) acts only at the instants where steps end. Use force_at='before'"):
        hl.compile(hl.Scene(force=hovers.force, eom=[falls]), T=T, force_at="mean")


@pytest.mark.parametrize("force_at", ["after", "mean"])
@pytest.mark.always("mean")
def test_the_modes_of_a_chain_are_put_together_for_it(force_at):
    """exact advances a long chain by its modes where that is cheaper; RK4 in sixteen steps a period finds the same force."""
    places = [hl.coordinate(f"z{k}", unit="m") for k in range(4)]
    pulls = [K * (a - b) for a, b in zip([x(t), *places], [*places, places[-1]], strict=False)]
    eom = [sp.Eq(m * q.diff(t, 2), pulls[k] - pulls[k + 1]) for k, q in enumerate(places)]
    scene = hl.Scene(force=pulls[0], eom=eom, name="chain")
    exact = ran(scene, "exact", force_at, hold="foh")[:, 0]
    np.testing.assert_allclose(exact, ran(scene, "rk4", force_at, hold="foh", substeps=16)[:, 0], rtol=0, atol=1e-9)
    assert np.abs(exact).max() > 1.0
