"""The lines of the theory on a wall map: what is known of a law of the chapter, and of a scene whose linear part is given."""

from functools import lru_cache

from ...errors import AnalysisError
from ...limits.affine_law import affine_law
from ...limits.bounds import abbott_okamura_limit, diolaiti_limit, gil_limit
from ...limits.passivity import passivity_limit
from ...limits.stability import stability_limit

#: of a paddle, a damper and a law: the limits by their authors' names
BOUNDS = {
    "abbott_okamura": lambda paddle, B, law: abbott_okamura_limit(B=B, law=law, delay=paddle.delay, **_device(paddle)),
    "diolaiti": lambda paddle, B, law: diolaiti_limit(B=B, law=law, delay=paddle.delay, **_device(paddle)),
    "gil": lambda paddle, B, law: gil_limit(paddle, B=B, law=law),
}


class ChapterLimits:
    """Limits of a law of the chapter: passivity, exact stability, and bounds by name.

    Parameters
    ----------
    law : str
    bounds : tuple of str
        Of BOUNDS.
    """

    def __init__(self, law, bounds):
        wrong = [name for name in bounds if name not in BOUNDS]
        if wrong:
            raise AnalysisError(f"bounds = {bounds}; {wrong[0]} is none of {', '.join(BOUNDS)}")
        self.law, self.bounds, self.name = law, tuple(bounds), f"law {law}"

    def at(self, paddle, B):
        """Return the limits of a paddle by name; None where a bound assumes what is not so."""
        law = self.law
        if law == "half_sample" and paddle.velocity == "backward_difference":
            law = "backward_difference"  # Eq. (23.3) with the estimate is Eq. (23.5)
        found = {
            "passivity": _passivity(paddle.b, paddle.T, B, paddle.delay, law),
            "stability": stability_limit(paddle, law=self.law, B=B),
        }
        for name in self.bounds:
            try:
                found[name] = BOUNDS[name](paddle, B, self.law)
            except AnalysisError:
                found[name] = None
        return found


class SceneLimits:
    """Exact stability of a scene, from its linear part: nothing without one.

    Parameters
    ----------
    scene, linear : Scene
        Felt, and the same without its boundary; None where that is not known.
    parameter : str
        The stiffness.
    """

    def __init__(self, scene, linear, parameter):
        self.linear, self.parameter, self.name, self._laws = linear, parameter, scene.name, {}

    def at(self, paddle, B):
        """Return the limit of a paddle by name."""
        if self.linear is None:
            return {}
        key = paddle.T, paddle.velocity, B
        if key not in self._laws:  # a scene is compiled for it
            bound = self.linear(B=B) if "B" in self.linear.parameters else self.linear
            self._laws[key] = affine_law(bound, T=paddle.T, parameter=self.parameter, velocity=paddle.velocity)
        return {"stability": stability_limit(paddle, law=self._laws[key])}


def _device(paddle):
    resolution = 1 / paddle.counts_per_metre if paddle.counts_per_metre else 0.0
    return {"b": paddle.b, "T": paddle.T, "coulomb": paddle.coulomb, "resolution": resolution}


@lru_cache(maxsize=4096)
def _passivity(b, T, B, delay, law):
    return passivity_limit(b=b, T=T, B=B, delay=delay, law=law)
