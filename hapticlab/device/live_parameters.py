"""Parameters of a program on a board, set all between the same two ticks."""

import numpy as np

from ..compiler.ir.notes import UnstableNote, why_of
from ..compiler.tick.live_limits import part_of_the_way
from ..compiler.tick.live_stability import SLOW, SMALL_MOTIONS
from ..errors import PaddleError, ParameterError
from ..scene.notation.parameters import Parameter

#: parameters in one SET
MOST_AT_ONCE = 8
#: what to do about values with which a step would be unstable
HOW = "compile with these values bound, or with more substeps"


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
        listed, why = ", ".join(names) or "none", why_of(program.notes, unknown[0])
        raise ParameterError(f"{unknown[0]} is not a live parameter of {program.name}{why}. It has {listed}.")
    if len(values) > MOST_AT_ONCE:
        raise ParameterError(
            f"{len(values)} parameters at once; a board accepts at most {MOST_AT_ONCE} between two ticks. Set fewer"
        )
    declared = {c.name: Parameter(c.name, c.unit, c.low, c.high) for c in program.parameters}
    numbers = {name: _within(declared[name], value, program.notes) for name, value in values.items()}
    with np.errstate(over="ignore"):
        bad = [name for name, value in numbers.items() if not np.isfinite(np.float32(value))]
    if bad:
        raise ParameterError(f"{bad[0]} = {numbers[bad[0]]:g}; a board needs a finite float32, |{bad[0]}| < 3.4e38.")
    check_stable(program, numbers)
    return numbers


def check_stable(program, numbers):
    """Refuse values with which, beside what the others are set to, a step would be unstable.

    Of a program that was pickled, which has no steps to ask, each parameter takes a part of the way from the value it was
    bound to to its limit, and the parts may add up to 1.
    """
    values, steps = named_values(program) | numbers, getattr(program.limits, "steps", None)
    if steps is None:
        _check_parts(program, numbers, values)
        return
    if not steps.known_at(values) or numbers.keys().isdisjoint(steps.live):
        return
    growth = steps.growth(values)
    if growth <= steps.allowed or growth <= _growth_now(program, steps):
        return
    others = [name for name in values if name not in numbers and values[name] != steps.values.get(name)]
    changed = [name for name in (*numbers, *others) if name in steps.live]
    if steps.taylor:
        why = f"a step of {steps.h:g} s turns by {growth:.3g} rad; method='taylor' needs at most 1"
    else:
        why = f"an oscillation doubles in {steps.doubles(growth):.2g} s"
    why += "" if steps.linear else f" ({SMALL_MOTIONS})"
    past = next((one for one in (_past(program, name, values[name]) for name in changed) if one), None)
    shown = ", ".join(f"{name} = {values[name]:.4g}" for name in changed)
    back = "move one back" if len(changed) > 1 else "move it back"
    raise ParameterError(f"{past or f'{shown}: a step is unstable'}; {why}: {back}, {HOW}")


def _growth_now(program, steps):
    """Largest growth in a step with the values that are set: what grew before may grow less."""
    now = named_values(program)
    known = steps.known_at(now)
    growth = steps.growth(now) if known else 0.0
    return growth if growth > steps.allowed else 0.0


def _past(program, name, value):
    """Return in words that a value is past its own limit, or None."""
    low, bound, high = program.limits.get(name, (-np.inf, value, np.inf))
    if low * (1 - 1e-9 * np.sign(low)) <= value <= high * (1 + 1e-9 * np.sign(high)):
        return None
    return f"{name} = {value:g}: a step is stable for {name} {f'<= {high:.4g}' if value > bound else f'>= {low:.4g}'}"


def _check_parts(program, numbers, values):
    parts = {}
    for name, (low, bound, high) in program.limits.items():
        toward = [part_of_the_way(values[name], bound, end) for end in (low, high) if np.isfinite(end)]
        parts[name] = max(toward, default=0.0)
    taken = {name: part for name, part in parts.items() if part > 1e-9}
    if sum(taken.values()) <= 1 + 1e-9 or taken.keys().isdisjoint(numbers):
        return
    for name in taken.keys() & numbers.keys():
        past = _past(program, name, values[name])
        if past is not None:
            raise ParameterError(f"{past}; {HOW}")
    shown = ", ".join(f"{name} = {values[name]:.4g} ({100 * part:.0f} %)" for name, part in taken.items())
    raise ParameterError(
        f"{shown}: a step may be unstable. Each value uses a fraction of the distance to its own limit, and the fractions "
        f"add up to {100 * sum(taken.values()):.0f} %; needs at most 100 %. Move one back, {HOW}"
    )


def check_margin(program):
    """Refuse a program whose steps are unstable as its values are, and grow within the time of a touch."""
    doubles, steps = program.facts.get("doubles_s", np.inf), getattr(program.limits, "steps", None)
    values = named_values(program)
    if steps is not None and not steps.taylor and steps.known_at(values):
        growth = steps.growth(values)
        doubles = steps.doubles(growth) if growth > steps.allowed else np.inf
    if doubles < SLOW:
        otherwise = UnstableNote(f"an oscillation doubles in {doubles:.2g} s. Use more substeps")
        why = next((note for note in program.notes if isinstance(note, UnstableNote)), otherwise)
        raise PaddleError(
            f"{program.name}: {why}. The motor would follow the growing motion; passive=True runs with the motor off."
        )


def _within(parameter, value, notes):
    """Return a value in SI; one past what a program can take is refused with the program's own reason."""
    try:
        return parameter.check(value)
    except ParameterError as problem:
        raise ParameterError(f"{problem}{why_of(notes, parameter.name)}") from None


def send(exchange, program, numbers):
    """Set parameters by name; return the tick after which they hold."""
    return exchange.command("SET", len(numbers), rest=_as_bytes(program, numbers))


def tell(exchange, program, numbers):
    """Set parameters by name and wait for no answer; return whether they were sent."""
    return exchange.tell("SET", len(numbers), rest=_as_bytes(program, numbers))


def _as_bytes(program, numbers):
    position = {name: k for k, name in enumerate(named_values(program))}
    return b"".join(bytes([position[name]]) + np.float32(value).tobytes() for name, value in numbers.items())


def in_portions(numbers):
    """Yield the numbers in as many as one SET takes."""
    names = list(numbers)
    for first in range(0, len(names), MOST_AT_ONCE):
        yield {name: numbers[name] for name in names[first : first + MOST_AT_ONCE]}
