"""What a board measures of its own steps."""


class Timing:
    """One run's steps and periods [s].

    Parameters
    ----------
    state : dict
        Fields of a STATE message.
    clock_hz : float
        Of the board's clock.
    T : float
        [s]
    """

    def __init__(self, state, clock_hz, T):
        self.T = T
        self.period_min, self.period_max = (state[name] / clock_hz for name in ("period_min", "period_max"))
        self.worst, self.mean = state["step_worst"] / clock_hz, state["step_mean"] / clock_hz
        self.overruns, self.lost, self.damaged = state["overruns"], state["lost"], state["damaged"]

    @property
    def load(self):
        """Share of the period that a step takes, on average."""
        return self.mean / self.T

    def __str__(self):
        return (
            f"step {self.mean * 1e6:.0f} us, worst {self.worst * 1e6:.0f} us of T = {self.T * 1e6:.0f} us "
            f"({100 * self.load:.0f} %); period {self.period_min * 1e6:.1f} to {self.period_max * 1e6:.1f} us; "
            f"{self.overruns} overruns, {self.lost} samples lost"
        )

    __repr__ = __str__
