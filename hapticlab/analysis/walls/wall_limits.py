"""The lines of the theory on a wall map: what is known of a law of the chapter, and of a scene whose linear part is given."""

from functools import lru_cache

from ...device.device import Device, total_delay
from ...errors import AnalysisError
from ...limits.affine_law import affine_law
from ...limits.bounds import abbott_okamura_limit, diolaiti_limit, gil_limit
from ...limits.passivity import passivity_limit
from ...limits.stability import stability_limit

#: of a paddle, with a damper B and a law: the limits by their authors' names
BOUNDS = {
    "abbott_okamura": abbott_okamura_limit,
    "diolaiti": diolaiti_limit,
    "gil": gil_limit,
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
            raise AnalysisError(f"bounds = {bounds}; {wrong[0]} is not one of {', '.join(BOUNDS)}")
        self.law, self.bounds, self.name = law, tuple(bounds), f"law {law}"

    def at(self, paddle, B):
        """Return the limits of a paddle by name; None where a bound assumes what is not so."""
        law = self.law
        if law == "half_sample" and paddle.velocity == "backward_difference":
            law = "backward_difference"  # Eq. (23.3) with the estimate is Eq. (23.5)
        found = {
            "passivity": _passivity(Device(b=paddle.b, T=paddle.T, delay=total_delay(paddle)), B, law),
            "stability": stability_limit(paddle, law=self.law, B=B),
        }
        for name in self.bounds:
            try:
                found[name] = BOUNDS[name](paddle, B=B, law=self.law)
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


@lru_cache(maxsize=4096)
def _passivity(device, B, law):
    return passivity_limit(device, B=B, law=law)
