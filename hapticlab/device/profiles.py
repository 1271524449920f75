"""Published constants of paddles, marked as what they are."""

from __future__ import annotations

from ..base.telemetry import PaddleProfile
from ..errors import PaddleError

#: nothing here was measured by this package on anyone's device: a lab identifies m, b and friction
hapkit = PaddleProfile(
    name="hapkit",
    m=0.03,
    b=0.10,
    counts_per_metre=1 / 12.8e-6,
    force_max=3.3,
    nominal=True,
    source=(
        "published Hapkit sketches and dimensions for 12.8 um per count and 3.3 N (the lower of the published peaks, "
        "3.3 to 8 N); m and b are published nowhere: round, illustrative values"
    ),
)
eth = PaddleProfile(
    name="eth",
    m=0.166,
    b=0.057,
    nominal=True,
    source=(
        "ETH Zurich teaching paddle, published inertias, motor damping and pulley ratio (github.com/WilliamLinxw/"
        "Physical-Human-Robot-Interaction-Lab) reflected to the handle at 65 mm; encoder, friction and force limit "
        "not included"
    ),
)
PROFILES = {p.name: p for p in (hapkit, eth)}


def profile(name: str) -> PaddleProfile:
    """Return the profile of a kind of paddle by its name.

    Parameters
    ----------
    name : {"hapkit", "eth"}

    Examples
    --------
    >>> from hapticlab.device.profiles import profile
    >>> profile("eth").m
    0.166
    """
    if name not in PROFILES:
        raise PaddleError(
            f"no profile {name!r}; there are {', '.join(PROFILES)}. For a profile of your own write hl.devices.PaddleProfile(...)"
        )
    return PROFILES[name]
