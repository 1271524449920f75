"""Parameters of a program on a board, set all between the same two ticks."""

import numpy as np

from ..compiler.stable_values import SLOW, UNSTABLE, part_of_the_way
from ..errors import PaddleError, ParameterError
from ..scene.parameters import Parameter

#: parameters in one SET
MOST_AT_ONCE = 8


def named_values(program):
    """Return the values a program has, by name, in the order of its parameters."""
    return {c.name: value for c, value in zip(program.parameters, program.values, strict=True)}


def checked(program, values):
    """Return the values in SI, each within what its parameter was declared to be.

    Raises
    ------
    ParameterError
        For a name the program has not, a value out of its declared range or of float32's, and values with which, beside
        those that are set already, a step would be unstable.
    """
    names = named_values(program)
    unknown = sorted(set(values) - set(names))
    if unknown:
        why = next((f" ({note})" for note in program.notes if note.startswith(f"{unknown[0]}: ")), "")
        listed = ", ".join(names) or "none"
        raise ParameterError(f"{unknown[0]} is no live parameter of {program.name}{why}; it has {listed}.")
    if len(values) > MOST_AT_ONCE:
        raise ParameterError(f"{len(values)} parameters at once; a board takes {MOST_AT_ONCE} between two ticks: set fewer")
    declared = {c.name: Parameter(c.name, c.unit, c.low, c.high) for c in program.parameters}
    numbers = {name: _within(declared[name], value, program.notes) for name, value in values.items()}
    with np.errstate(over="ignore"):
        bad = [name for name, value in numbers.items() if not np.isfinite(np.float32(value))]
    if bad:
        raise ParameterError(f"{bad[0]} = {numbers[bad[0]]:g}; a board needs a finite float32, |{bad[0]}| < 3.4e38.")
    check_stable(program, numbers)
    return numbers


def check_stable(program, numbers):
    """Refuse values past what keeps a step stable: of one alone, or with what the others are set to.

    Each parameter takes a part of the way from the value it was bound to to its limit; the parts may add up to 1.
    """
    values, parts = named_values(program) | numbers, {}
    for name, (low, bound, high) in program.limits.items():
        toward = [part_of_the_way(values[name], bound, end) for end in (low, high) if np.isfinite(end)]
        parts[name] = max(toward, default=0.0)
    taken = {name: part for name, part in parts.items() if part > 1e-9}
    if sum(taken.values()) <= 1 + 1e-9 or taken.keys().isdisjoint(numbers):
        return
    how = "compile with these values bound, or with more substeps"
    for name in taken.keys() & numbers.keys():
        if taken[name] > 1 + 1e-9:
            low, bound, high = program.limits[name]
            need = f"<= {high:.4g}" if values[name] > bound else f">= {low:.4g}"
            raise ParameterError(f"{name} = {values[name]:g}: a step is stable for {name} {need}; {how}")
    shown = ", ".join(f"{name} = {values[name]:.4g} ({100 * part:.0f} %)" for name, part in taken.items())
    raise ParameterError(
        f"{shown}: a step may be unstable. Each takes a part of the way to its own limit, and the parts add up to "
        f"{100 * sum(taken.values()):.0f} %; needs 100 % at most: move one back, {how}"
    )


def check_margin(program):
    """Refuse a program whose steps are unstable as its values are bound, and grow within the time of a touch."""
    if program.facts.get("doubles_s", np.inf) < SLOW:
        why = next(note for note in program.notes if note.startswith(UNSTABLE))
        raise PaddleError(f"{program.name}: {why}. A motor would follow what grows; passive=True runs with the motor off.")


def _within(parameter, value, notes):
    """Return a value in SI; one past what a program can take is refused with the program's own reason."""
    try:
        return parameter.check(value)
    except ParameterError as problem:
        why = next((f" ({note})" for note in notes if note.startswith(f"{parameter.name}: ")), "")
        raise ParameterError(f"{problem}{why}") from None


def send(exchange, program, numbers):
    """Set parameters by name; return the tick after which they hold."""
    position = {name: k for k, name in enumerate(named_values(program))}
    rest = b"".join(bytes([position[name]]) + np.float32(value).tobytes() for name, value in numbers.items())
    return exchange.command("SET", len(numbers), rest=rest)


def in_portions(numbers):
    """Yield the numbers in as many as one SET takes."""
    names = list(numbers)
    for first in range(0, len(names), MOST_AT_ONCE):
        yield {name: numbers[name] for name in names[first : first + MOST_AT_ONCE]}
