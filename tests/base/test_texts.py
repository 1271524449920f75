"""Every physical argument takes a text with its unit in the place of a number in SI."""

import pytest

import hapticlab as hl

TEXTS = [
    (lambda **a: hl.SimulatedPaddle(b=0.1, T=1e-3, **a), {"m": "50 g"}, {"m": 0.05}),
    (lambda **a: hl.SimulatedPaddle(m=0.05, b=0.1, **a), {"T": "1 ms", "delay": "0.5 ms"}, {"T": 1e-3, "delay": 5e-4}),
    (lambda **a: hl.SimulatedPaddle(m=0.05, T=1e-3, **a), {"b": "100 mN*s/m"}, {"b": 0.1}),
    (lambda **a: hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, **a), {"coulomb": "20 mN"}, {"coulomb": 0.02}),
    (lambda **a: hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, **a), {"counts_per_metre": "25 1/mm"}, {"counts_per_metre": 25000.0}),
    (
        lambda **a: hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, **a),
        {"force_max": "5 N", "noise": "0.25 m"},
        {"force_max": 5.0, "noise": 0.25},
    ),
    (hl.Hand, {"m": "20 g", "k": "0.2 N/mm", "push": "1500 mN"}, {"m": 0.02, "k": 200.0, "push": 1.5}),
    (hl.Hand, {"k": 200, "intent": "12 mm"}, {"k": 200, "intent": 0.012}),
    (hl.Device, {"b": "0.1 N*s/m", "T": "2 ms"}, {"b": 0.1, "T": 0.002}),
    (lambda **a: hl.wall(**a).values, {"k": "0.3 N/mm", "x_o": "1 cm"}, {"k": 300.0, "x_o": 0.01}),
    (lambda **a: hl.compile(hl.wall(k=1), **a), {"T": "1 ms"}, {"T": 1e-3}),
    (lambda **a: float(hl.passivity_limit(hl.Device(b=0.3, T=1e-3), **a)), {"B": "100 mN*s/m"}, {"B": 0.1}),
    (lambda **a: hl.people.MinimumJerk(**a), {"end": "2 cm", "duration": "500 ms"}, {"end": 0.02, "duration": 0.5}),
]


@pytest.mark.parametrize(("call", "texts", "numbers"), TEXTS)
def test_a_text_with_its_unit_is_the_number_in_si(call, texts, numbers):
    assert call(**texts) == call(**numbers)


def test_a_run_takes_its_duration_second_and_as_text():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2))
    assert len(paddle.run(hl.wall(k=150), 0.05)) == len(paddle.run(hl.wall(k=150), "50 ms")) == 50
    a, b = (paddle.run(hl.wall(k=150), 0.05, x=x, v=v) for x, v in ((0.002, -0.1), ("2 mm", "-100 mm/s")))
    assert (a.x == b.x).all() and a.x[0] == pytest.approx(0.002, rel=1e-6)


PADDLE = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand("pinch"))
FREE = hl.SimulatedPaddle(m=0.05, b=0.2, T=1e-3, counts_per_metre=1e5)
#: each with a text, and with the same in SI
CALLS = {
    "passivity_limit": (lambda B: hl.passivity_limit(PADDLE, B=B), "0.1 N*s/m", 0.1),
    "velocity_filter": (lambda tau: hl.passivity_limit(PADDLE, B=0.1, velocity_filter=tau), "4 ms", 0.004),
    "stability_limit": (lambda B: hl.stability_limit(PADDLE, B=B), "0.1 N*s/m", 0.1),
    "poles": (lambda K: hl.stability.poles(PADDLE, K=K), "0.5 N/mm", 500.0),
    "step_limit": (lambda T: hl.stability.step_limit(hl.library.mass_spring_damper(), T=T), "1 ms", 1e-3),
    "local_stiffness": (lambda low: hl.stability.local_stiffness(hl.wall(k=100), low, 1e-3), "-1 mm", -1e-3),
    "bounds": (lambda B: hl.bounds.table(PADDLE, B=B), "0.1 N*s/m", 0.1),
    "gil": (lambda B: hl.bounds.gil(PADDLE, B=B), "0.1 N*s/m", 0.1),
    "diolaiti_plane": (lambda K: hl.bounds.diolaiti_plane(PADDLE, K=K), "100 N/m", 100.0),
    "ledger": (lambda K: hl.passivity.ledger(PADDLE, K=K), "100 N/m", 100.0),
    "wall_damping": (lambda K: hl.passivity.wall_damping(PADDLE, K=K), "100 N/m", 100.0),
    "digital_gains": (lambda K: hl.design.digital_gains(PADDLE, K=K), "100 N/m", 100.0),
    "compare_laws": (lambda K: hl.design.compare_laws(PADDLE, K=K, laws="zoh", entries=1), "100 N/m", 100.0),
    "kalman": (lambda noise: hl.velocity.kalman(acceleration=10, noise=noise), "8 um", 8e-6),
    "window": (lambda deviation: hl.velocity.window(deviation=deviation), "20 um", 20e-6),
    "spin_down": (lambda m: hl.identify.spin_down(FREE.run(hl.wall(k=0), 0.2, v=0.1), m=m), "50 g", 0.05),
    "largest_stiffness": (
        lambda B: hl.measure.largest_stiffness(PADDLE, B=B, search=hl.measure.Search(first=1000.0, growth=10.0, tolerance=5.0)),
        "0.1 N*s/m",
        0.1,
    ),
    "reach": (lambda end: hl.people.reach(PADDLE, hl.wall(k=100, x_o=0.1), end=end), "20 mm", 0.02),
    "stiffness_task": (lambda standard: hl.people.stiffness_task(standard=standard).standard, "200 N/m", 200.0),
    "handle_motions": (lambda travel: [motion.name for motion in hl.methods.handle_motions(travel=travel)], "50 mm", 0.05),
    "requires": (lambda T: hl.mechanics.requires(hl.wall(k=1), T=T), "1 ms", 1e-3),
    "coordinate": (lambda q: type(hl.coordinate("q", unit="m", initial=q, range=("-1 cm", "1 cm"))).initial, "5 mm", 0.005),
    "sweep": (lambda d: hl.sweep(hl.wall(k=[100, 200][0]), PADDLE, d, B=[0, 0.1], progress=False).values.tolist(), "50 ms", 0.05),
}


@pytest.mark.parametrize("call", CALLS)
def test_a_call_with_a_text_says_what_it_says_with_a_number(call):
    made, text, number = CALLS[call]
    assert str(made(text)) == str(made(number))
