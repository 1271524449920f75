"""The proxy: what a wall with memory does that one of nearest surfaces cannot, and curves against their equilibria."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import SceneError
from hapticlab.scene.laws.proxy import proxy_curve, proxy_wall


def drawn(scene, x):
    """Return what the scene outputs while the handle goes through x, (force, watched ...) as columns."""
    program = hl.compile(scene, T=1e-3, dtype="float64")
    return load(program).run(len(x), np.asarray(x)[:, None]).outputs[:, :, 0].T


def test_the_proxy_stays_on_the_surface():
    x = np.r_[np.linspace(0, 0.03, 31), np.linspace(0.03, -0.01, 41)]
    force, z = drawn(proxy_wall()(K=500, x_o=0.01), x)
    assert z == pytest.approx(np.minimum(x, 0.01), abs=1e-15)
    assert force == pytest.approx(500 * np.maximum(x - 0.01, 0), abs=1e-12)


def test_a_plate_is_felt_from_both_sides_and_does_not_pop_through():
    """Pushed 20 mm through, it still pushes back; a plate of nearest surfaces would push on instead."""
    into = np.linspace(0, 0.03, 31)
    force, z = drawn(proxy_wall("both")(K=500, x_o=0.01), np.r_[into, into[::-1]])
    assert force.min() >= 0 and force.max() == pytest.approx(500 * 0.02)
    assert z.max() == 0.01
    # started behind it, the same from the other side
    force, z = drawn(proxy_wall("both")(K=500, x_o=0.01), np.r_[into[::-1], into])
    assert force.max() <= 0 and force.min() == pytest.approx(-500 * 0.01)
    assert z.min() == 0.01


def test_a_jump_across_the_plate_within_one_sample_is_caught():
    force, z = drawn(proxy_wall("both")(K=500, x_o=0.01), [0.0, 0.0, 0.5])
    assert z[-1] == 0.01 and force[-1] == pytest.approx(245)


def test_the_damper_never_pulls():
    x = np.r_[np.linspace(0, 0.03, 31), np.linspace(0.03, -0.01, 11)]
    force, _ = drawn(proxy_wall()(K=500, B=5, x_o=0.01), x)
    assert force.min() == 0 and force[15] == pytest.approx(500 * 0.005 + 5 * 1.0)
    assert (force[31:36] < 500 * np.maximum(x[31:36] - 0.01, 0)).all()


A, W = hl.parameters("A w", units="m m")


def ridges(mu):
    curve = proxy_curve(lambda z: A * sp.cos(2 * sp.pi * z / W), load="1 N", mu=mu, steps=4)
    return curve(A=2e-4, w=5e-3, K=2000)


def test_slopes_are_felt_as_height():
    """Without friction K (x - z) = P h'(z), at every sample of a slow draw; around a ridge no energy is kept."""
    x = np.linspace(0, 0.015, 1501)
    force, z, h = drawn(ridges(0), x)
    w = 2 * np.pi / 5e-3
    assert force == pytest.approx(-2e-4 * w * np.sin(w * z), abs=1e-9)
    assert h == pytest.approx(2e-4 * np.cos(w * z), abs=1e-15)
    assert np.trapezoid(force, x) == pytest.approx(0.0, abs=1e-8)


def test_friction_holds_within_its_cone_and_drags_at_its_edge():
    there = np.linspace(0, 0.015, 1501)
    force, z, _ = drawn(ridges(0.2), np.r_[there, there[::-1]])
    slope = -2e-4 * 2 * np.pi / 5e-3 * np.sin(2 * np.pi * z / 5e-3)
    low, high = (slope - 0.2) / (1 + 0.2 * slope), (slope + 0.2) / (1 - 0.2 * slope)
    assert (force <= high + 1e-6).all() and (force >= low - 1e-6).all()
    # dragged at the upper edge all the way there, once it has slipped; it stays while the handle turns back.
    # A Newton step that passes the edge by its own error comes to rest inside the cone
    assert force[200:1501] == pytest.approx(high[200:1501], abs=5e-5)
    assert (np.diff(z[1501:1510]) == 0).all()
    assert force[1800:] == pytest.approx(low[1800:], abs=5e-5)


def test_what_is_no_proxy_is_refused():
    with pytest.raises(SceneError, match=r"sides = 'two'; needs 'one'"):
        proxy_wall("two")
    with pytest.raises(SceneError, match=r"load = \(-1 N\); needs the force > 0 N"):
        proxy_curve(lambda z: z, load="-1 N")
    with pytest.raises(SceneError, match=r"mu = -0.1; friction opposes the slip"):
        proxy_curve(lambda z: z, load="1 N", mu=-0.1)
