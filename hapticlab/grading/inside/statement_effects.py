"""What a statement at the top level of a notebook reads, binds and may change, told from its code without running it."""

import ast
import copy
import dis
from dataclasses import dataclass, field

#: what else than by its name reaches a variable, as a name and as an attribute; a notebook that has one is run as a whole
OPAQUE_NAMES = frozenset(
    "exec eval compile globals locals vars setattr delattr breakpoint __import__ __builtins__ __main__ builtins importlib ctypes "
    "gc inspect mock runpy sys traceback tracemalloc faulthandler logging pdb bdb trace cProfile profile".split()
)
#: with those by which code sees what runs it, and could answer a part of the notebook otherwise than the whole
OPAQUE_ATTRIBUTES = frozenset(
    "modules settrace setprofile _getframe _current_frames __dict__ __globals__ __code__ __class__ __setattr__ __traceback__ "
    "__context__ tb_frame f_back f_code f_globals f_locals gi_frame cr_frame ag_frame".split()
)
#: state that belongs to no variable: name or attribute that uses it -> what stands for it. Settings are always needed
STATE = {
    **dict.fromkeys("random rng shuffle seed".split(), "<random>"),
    **dict.fromkeys(
        "open Path save savez savetxt load loadtxt genfromtxt fromfile tofile read_csv to_csv read_text write_text shutil "
        "read_bytes write_bytes tempfile pickle json csv".split(),
        "<files>",
    ),
    **dict.fromkeys("plt pyplot pylab gca gcf rcParams".split(), "<pyplot>"),
    **dict.fromkeys(
        "seterr seterrcall errstate warnings simplefilter filterwarnings sys os threading Thread multiprocessing "
        "subprocess atexit decimal locale setrecursionlimit set_event_loop chdir environ reload set_string_function".split(),
        "<settings>",
    ),
}
SHOWING = {"print", "display"}


@dataclass
class Reads:
    """What one statement does with names.

    Attributes
    ----------
    now, later : set of str
        Names of the notebook that it reads as it runs, and that its functions may read or bind when they are called.
    shown : set of str
        Names that it reads only to print or to check them.
    binds, rebinds : set of str
        Names that it may bind or delete, and those of them that it binds anew whenever it runs to its end.
    alters : set of str
        Names with an attribute or item that it sets.
    sets : set of str
        Names that its functions bind, by ``global``.
    imports : dict of str to str
        Name to what it is in its module, ``{"np": "numpy", "x": "hapticlab.x"}``.
    star : bool
        It imports names that are not written.
    harmless : bool
        It can neither fail nor read anything: a definition, a constant.
    """

    now: set = field(default_factory=set)
    later: set = field(default_factory=set)
    shown: set = field(default_factory=set)
    binds: set = field(default_factory=set)
    rebinds: set = field(default_factory=set)
    alters: set = field(default_factory=set)
    sets: set = field(default_factory=set)
    imports: dict = field(default_factory=dict)
    star: bool = False
    harmless: bool = False
    opaque: bool = False


def reads_of(node):
    """Names that a statement reads and binds.

    Parameters
    ----------
    node : ast.stmt

    Examples
    --------
    >>> found = reads_of(ast.parse("rows[0] = [k * row for row in given]").body[0])
    >>> sorted(found.now), sorted(found.binds), sorted(found.alters)
    (['given', 'k', 'rows'], [], ['rows'])
    >>> reads_of(ast.parse("def force(x, k=2):\\n    return k * x * np.pi").body[0]).later
    {'np'}
    """
    found = Reads(harmless=_is_harmless(node), rebinds=_rebound(node))
    _read_code(_compiled(node), found, later=False)
    parts = list(ast.walk(node))
    for part in parts:
        _read_part(part, found)
    found.opaque |= not OPAQUE_NAMES.isdisjoint(found.now | found.later)
    found.now |= {STATE[name] for name in found.now | found.later if name in STATE}
    found.now -= _given_by_loop(node)
    found.rebinds -= found.now
    found.alters &= found.now | found.later
    found.opaque |= not SHOWING.isdisjoint(found.binds) or "hl" in found.alters  # what shows, or checks, does something else
    if isinstance(node, ast.Expr) and _only_shows(node, parts):
        found.shown = set(found.now)
    elif any(map(_is_check, parts)):
        unchecked = Reads()
        _read_code(_compiled(_Unchecked().visit(copy.deepcopy(node))), unchecked, later=False)
        found.shown = found.now - unchecked.now
    return found


def _compiled(node):
    return compile(ast.Module([node], []), "", "exec", ast.PyCF_ALLOW_TOP_LEVEL_AWAIT, dont_inherit=True)


class _Unchecked(ast.NodeTransformer):
    """Leaves out what is given to hl.check, which judges nothing here."""

    def visit_Call(self, node):
        """Take the arguments of a check away."""
        self.generic_visit(node)
        if _is_check(node):
            node.args, node.keywords = [], []
        return node


def _is_check(node):
    name = node.func if isinstance(node, ast.Call) else None
    return isinstance(name, ast.Attribute) and name.attr == "check" and isinstance(name.value, ast.Name) and name.value.id == "hl"


def _read_code(code, found, later):
    """Read the names in code; those of a comprehension and of a class body are read at once."""
    reads = found.later if later else found.now
    for step in dis.get_instructions(code):
        kind, _, target = step.opname.partition("_")
        if kind == "LOAD" and target in ("NAME", "GLOBAL", "FROM_DICT_OR_GLOBALS"):
            reads.add(step.argval)
        elif kind in ("STORE", "DELETE") and (target == "GLOBAL" or (target == "NAME" and code.co_name == "<module>")):
            found.binds.add(step.argval)
            reads.update({step.argval} if kind == "DELETE" else ())  # it fails where there is none
            if later:
                found.later.add(step.argval)
                found.sets.add(step.argval)
    for inner in filter(lambda constant: hasattr(constant, "co_code"), code.co_consts):
        at_once = inner.co_name in ("<listcomp>", "<setcomp>", "<dictcomp>") or not inner.co_flags & 2  # CO_NEWLOCALS: no class
        _read_code(inner, found, later or not at_once)


def _read_part(part, found):
    """Read what the names in code do not tell."""
    if isinstance(part, ast.Attribute | ast.Subscript) and not isinstance(part.ctx, ast.Load):
        found.alters.add(_root(part))
    if isinstance(part, ast.Attribute):
        found.opaque |= part.attr in OPAQUE_ATTRIBUTES
        found.now.update({STATE[part.attr]} if part.attr in STATE else ())
    elif isinstance(part, ast.Import | ast.ImportFrom):
        base = f"{part.module or ''}." if isinstance(part, ast.ImportFrom) else ""
        found.star |= any(one.name == "*" for one in part.names) or base == "__future__."
        found.imports |= {one.asname or one.name.partition(".")[0]: base + one.name for one in part.names}
        found.opaque |= any(not OPAQUE_NAMES.isdisjoint((base + one.name).split(".")) for one in part.names)


def _root(node):
    """Return the name that attributes and items begin with."""
    while isinstance(node, ast.Attribute | ast.Subscript | ast.Starred):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def _rebound(node):
    """Return the names that a statement binds anew whenever it runs to its end."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return {node.name}
    if not isinstance(node, ast.Assign):
        return set()
    parts = [part for target in node.targets for part in (target.elts if isinstance(target, ast.Tuple | ast.List) else [target])]
    return {part.id for part in parts if isinstance(part, ast.Name)}


def _given_by_loop(node):
    """Return the names that a loop reads only after it has bound them."""
    if not isinstance(node, ast.For | ast.AsyncFor) or node.orelse:
        return set()
    targets = node.target.elts if isinstance(node.target, ast.Tuple) else [node.target]
    names = {one.id for one in targets if isinstance(one, ast.Name)}
    if len(names) < len(targets):
        return set()
    return names - {part.id for part in ast.walk(node.iter) if isinstance(part, ast.Name)}


def _is_harmless(node):
    if isinstance(node, ast.FunctionDef):
        defaults = [*node.args.defaults, *filter(None, node.args.kw_defaults)]
        arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs, node.args.vararg, node.args.kwarg]
        noted = [one for one in arguments if one is not None and one.annotation is not None]
        return not (node.decorator_list or noted or node.returns) and all(isinstance(one, ast.Constant) for one in defaults)
    return isinstance(node, ast.Assign | ast.Expr) and isinstance(node.value, ast.Constant) and not _stores_inside(node)


def _stores_inside(node):
    return any(not isinstance(target, ast.Name) for target in getattr(node, "targets", ()))


def _only_shows(node, parts):
    """Whether an expression only prints what is there, and does nothing else for it."""
    acts = [part for part in parts if isinstance(part, ast.Call | ast.Await | ast.NamedExpr | ast.Yield | ast.Subscript)]
    shows = isinstance(node.value, ast.Call) and isinstance(node.value.func, ast.Name) and node.value.func.id in SHOWING
    return not acts or (shows and acts == [node.value])
