"""Python asks a condition for one yes or no, where it has one for each sample or each number: who asked, and what to write."""

from __future__ import annotations

import ast
import re

from .own_line import OwnLine, code_of

WHEN, WHERE = "hl.when", "np.where"
WHY_ARRAY = "whether a condition holds, but for an array it holds for some numbers and not for others"


def decided(own: OwnLine, match: re.Match[str]) -> str:
    """The sentence on a condition of samples, or of an array, whose truth Python wanted at once."""
    of_samples, choice = (True, WHEN) if match.lastindex else (False, WHERE)
    around = own.nodes()
    running = around[: sum(own.same_place(one, around[0]) for one in around)] if around else []
    for node in sorted(around, key=lambda one: isinstance(one, ast.Compare) and len(one.ops) == 1):  # a plain one at last
        asked = _asked(node, choice, of_samples) if any(one in running for one in (node, *_tested(node))) else None
        if asked:
            who, cure = asked
            why = f"whether {match[1]} holds, which changes from sample to sample" if of_samples else WHY_ARRAY
            return f"{who} has to know at once {why}. Write {cure}."
    return ""


def _tested(node):
    """Return the parts of a node whose truth it asks for."""
    return [getattr(node, "test", None), *getattr(node, "values", []), getattr(node, "operand", None)]


def _asked(node, choice, of_samples):
    """Return who asks for a truth, and what to write in its place; None of a node that asks for none."""
    text = code_of
    match node:
        case ast.If(test=test):
            return "`if`", f"{choice}({text(test)}, a, b): a where it holds, b elsewhere"
        case ast.IfExp(test=test, body=a, orelse=b):
            return "`if`", f"{choice}({text(test)}, {text(a)}, {text(b)})"
        case ast.While(test=test):
            return "`while`", f"{choice}({text(test)}, a, b) without a loop, as a scene runs once for every sample"
        case ast.Assert(test=test):
            return "`assert`", f"{choice}({text(test)}, a, b), or test the numbers of a record, such as (log.x < 0.01).all()"
        case ast.BoolOp(op=op, values=parts):
            word, sign = ("and", "&") if isinstance(op, ast.And) else ("or", "|")
            return f"`{word}`", f" {sign} ".join(f"({text(part)})" for part in parts)
        case ast.UnaryOp(op=ast.Not(), operand=part):
            return "`not`", f"~({text(part)})"
        case ast.Compare(left=left, ops=ops, comparators=others):
            sides = [left, *others]
            pairs = (text(ast.Compare(a, [op], [b])) for a, op, b in zip(sides, ops, others, strict=False))
            if len(ops) > 1:
                return "A chain of comparisons", " & ".join(f"({pair})" for pair in pairs)
            return "A comparison with an array", f"one condition for one number, such as {WHEN}(x(n) > 0.01, a, b)"
        case ast.Call(func=func, args=args):
            return _asked_by(text(func), [text(a) for a in args], of_samples)
    return None


def _asked_by(function, given, of_samples):
    """Return the same of a function that compares what it is given."""
    largest, smallest = ("sp.Max", "sp.Min") if of_samples else ("np.maximum", "np.minimum")
    listed, name = ", ".join(given), function.rpartition(".")[2]
    cures = {
        "max": f"{largest}({listed})", "maximum": f"{largest}({listed})", "fmax": f"{largest}({listed})",
        "min": f"{smallest}({listed})", "minimum": f"{smallest}({listed})", "fmin": f"{smallest}({listed})",
        "where": f"hl.when({listed})", "sign": f"sp.sign({listed})", "bool": f"hl.when({listed}, 1, 0)",
        "logical_and": " & ".join(f"({one})" for one in given), "logical_or": " | ".join(f"({one})" for one in given),
        "logical_not": f"~({listed})",
    }  # fmt: skip
    if name == "clip" and len(given) == 3:
        cures["clip"] = f"{smallest}({largest}({given[0]}, {given[1]}), {given[2]})"
    cure = cures.get(name, f"{largest}(a, b) or {smallest}(a, b), or {WHEN if of_samples else WHERE}(condition, a, b)")
    return f"`{function}`", cure
