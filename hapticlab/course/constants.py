"""Numbers that stand under a name of their own in a source, ``K_OWN = 500.0``, and other numbers in their place."""

import ast

from ..errors import CourseError


def constants(source):
    """Return the lines ``NAME = number`` at the top level of a source: node to (name, number as written).

    Examples
    --------
    >>> [*constants("T_OWN = 1e-3  # [s]\\nk = None\\nb, c = 1, 2").values()]
    [('T_OWN', '0.001')]
    """
    try:
        body = ast.parse(source).body
    except SyntaxError:  # a magic, or a student's
        return {}
    return {node: (node.targets[0].id, ast.unparse(node.value)) for node in body if _is_constant(node)}


def _is_constant(node):
    if not isinstance(node, ast.Assign) or len(node.targets) != 1 or not isinstance(node.targets[0], ast.Name):
        return False
    value = node.value.operand if isinstance(node.value, ast.UnaryOp) else node.value
    return isinstance(value, ast.Constant) and type(value.value) in (int, float)


def with_constants(sources, numbers, where):
    """Return sources with other numbers in the constants ``NAME = number`` at their top level.

    Parameters
    ----------
    sources : list of str
        Cells, or a whole file.
    numbers : dict of str to int or float
    where : str or Path
        What the sources are of, for the error.

    Raises
    ------
    CourseError
        Where no source has such a constant, or one has it twice.

    Examples
    --------
    >>> with_constants(["import math\\nK_OWN = 500.0  # [N/m]"], {"K_OWN": 431.5}, "solution.py")
    ['import math\\nK_OWN = 431.5  # [N/m]']
    """
    places = [(number, *pair) for number, source in enumerate(sources) for pair in constants(source).items()]
    lines = [source.encode().split(b"\n") for source in sources]  # columns of an AST count bytes
    for name, value in numbers.items():
        here = [(number, node.value) for number, node, (its_name, _) in places if its_name == name]
        if len(here) != 1:
            raise CourseError(
                f"{where} has {len(here)} lines {name} = number at its top level; it needs exactly one, for {value!r}"
            )
        number, old = here[0]
        line = lines[number][old.lineno - 1]
        lines[number][old.lineno - 1] = line[: old.col_offset] + repr(value).encode() + line[old.end_col_offset :]
    return [b"\n".join(several).decode() for several in lines]
