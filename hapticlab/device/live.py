"""Parameters of a program on a board, set all between the same two ticks."""

import numpy as np

from ..errors import ParameterError
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
        For a name the program has not, a value out of its declared range or of float32's.
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
    return numbers


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
