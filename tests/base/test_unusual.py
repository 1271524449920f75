"""Values that no paddle has are told, once, at the user's own line; what a course uses is not."""

import warnings

import pytest

import hapticlab as hl
from hapticlab.errors import UnusualValueWarning


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: hl.wall(k=300, x_o=10), "x_o = 10 m: .* If you mean 10 mm, write x_o='10 mm'"),
        (lambda: hl.wall()(k=300, x_o="-2 m"), "x_o = -2 m: .* If you mean -2 mm"),
        (lambda: hl.wall(k=5e7), "k = 5e\\+07 N/m: the stiffest virtual walls"),
        (lambda: hl.SimulatedPaddle(m=50, b=0.1, T=1e-3), "m = 50 kg: .* If you mean 50 g, write m='50 g'"),
        (lambda: hl.SimulatedPaddle(m=0.05, b=0.1, T=1), "T = 1 s: .* If you mean 1 ms, write T='1 ms'"),
        (lambda: hl.Device(b=0.1, T=2, delay=0), "T = 2 s"),
        (lambda: hl.Hand(m=20, k=100), "m = 20 kg: an arm"),
        (lambda: hl.SimulatedPaddle(m=0.05, b=0.1, T=0.01).ticks(5000), "duration = 5000 s"),
        (lambda: hl.library.mass_spring_damper()(m=60), "m = 60 kg"),
    ],
)
def test_a_value_that_no_paddle_has_is_told_once_at_the_line_that_gave_it(call, words):
    with pytest.warns(UnusualValueWarning, match=words) as caught:
        call()
    assert len(caught) == 1
    assert caught[0].filename == __file__


def test_what_a_course_uses_is_not_told():
    with warnings.catch_warnings():
        warnings.simplefilter("error", UnusualValueWarning)
        for name in hl.library.catalogue:
            getattr(hl.library, name)()(**getattr(hl.library, name)().values)
        paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("arm"))
        assert len(paddle.run(hl.wall(k=2e4, x_o="50 mm"), "20 ms")) == 20


def test_a_run_may_take_the_velocity_of_a_board():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2))
    damper = hl.laws.virtual_damper()(B=0.2)
    exact, estimated = (paddle.run(damper, 0.05, **given).F for given in ({}, {"velocity": "backward_difference"}))
    assert abs(exact[20:] - estimated[20:]).max() > 1e-3
    with pytest.raises(hl.errors.PaddleError, match="needs a measured v; this paddle has only its backward difference"):
        hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=1e4).run(damper, 0.05, velocity="measured")
