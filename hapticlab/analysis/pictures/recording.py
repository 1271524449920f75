"""A function of numbers, or a moving picture, as plain JSON: ``widgets/browser/page/drawing.js`` does it without Python.

The function is called with nodes (``graph``) in place of numbers: once, or once for each way that it goes where it asks whether
one of them is true.
"""

import json

import numpy as np

from ...errors import AnalysisError
from ...library.display_list import DisplayList
from .graph import Graph, Node, NotRecorded, Undecided
from .graph_data import graph_data

#: ways that a function may go
WAYS = 64


def recorded(function, inputs, name="the function"):
    """Return a function as data.

    Parameters
    ----------
    function : callable of a dict of nodes -> node, number or array
        Written with operators and functions of NumPy.
    inputs : dict of str to float
        What it may be given, and what each is where it is not.
    name : str
        Names the function in errors.

    Returns
    -------
    dict
        ``inputs`` and ``nodes`` as :func:`~hapticlab.analysis.pictures.graph_data.graph_data` has them; ``gives``, the number of
        a node, or {"if", "then", "else"}: the number of a node, and what is given where that is true and where it is not.

    Raises
    ------
    AnalysisError
        For a function that needs a number where there is none yet, and one that goes more than 64 ways.

    Examples
    --------
    >>> recorded(lambda known: np.maximum(2 * known["x"], 0.0), {"x": 0.0, "k": 300.0})
    {'inputs': [['x', 0]], 'nodes': [2, ['multiply', 1, 0], 0, ['maximum', 2, 3]], 'gives': 4}
    """
    graph, tree = _explored(lambda graph, given: graph.node(function(given)).number, inputs, name)
    told, places = graph_data(graph, inputs, [*_leaves(tree), *_asked(tree)])
    return {**told, "gives": _renumbered(tree, places, places.get)}


def recorded_picture(draw, inputs, name):
    """Return a moving picture as data.

    Parameters
    ----------
    draw : callable of (DisplayList, dict of nodes) -> items
    inputs, name
        As for :func:`recorded`.

    Returns
    -------
    dict
        As of :func:`recorded`, but what it gives is a list of places in ``items``. An item is [kind, node of its points,
        style that stays, style that moves]; of the latter each is the number of a node, in a list where it is an array.
    """
    texts = {}

    def listed(graph, given):
        drawn = draw(_RecordedList(graph), given)
        return [texts.setdefault(json.dumps(_item(graph, *item), default=lambda one: one.item()), len(texts)) for item in drawn]

    graph, tree = _explored(listed, inputs, name)
    items = [json.loads(text) for text in texts]
    moving = [one for *_, style in items for one in style.values()]
    roots = [points for _, points, *_ in items] + [one[0] if isinstance(one, list) else one for one in moving]
    told, places = graph_data(graph, inputs, [*roots, *_asked(tree)])
    for item in items:
        item[1] = places[item[1]]
        item[3] = {key: [places[one[0]]] if isinstance(one, list) else places[one] for key, one in item[3].items()}
    return {**told, "items": items, "gives": _renumbered(tree, places, list)}


class _RecordedList(DisplayList):
    """A display list whose points are nodes."""

    def __init__(self, graph):
        super().__init__()
        self._graph = graph

    def add(self, kind, points, zorder=3.0, shown=True, **style):
        """Keep an item; one that is not shown lies nowhere."""
        places = self._graph.node(list(points))
        if isinstance(shown, Node):
            places, shown = np.where(shown, places, np.nan), True
        known = self._graph.constant(places.number)
        if shown and (known is None or np.isfinite(known).all()):
            self._kept.append((zorder, (kind, places, style)))


def _item(graph, kind, points, style):
    stays, moves = {}, {}
    for key, value in style.items():
        is_list = isinstance(value, (list, tuple)) and any(isinstance(one, Node) for one in value)
        node = graph.node(value) if is_list or isinstance(value, Node) else None
        known = node is not None and graph.constant(node.number)
        if node is None:
            stays[key] = value
        elif known is not None:
            stays[key] = known.reshape(node.shape).tolist()
        else:
            moves[key] = [node.number] if node.shape else node.number
    return kind, points.number, stays, moves


def _explored(function, inputs, name):
    """Return the graph of a function, and what it gives, of each way that it goes, in a tree of what it asks."""
    graph, ways = Graph(), []
    given = {one: graph.input(one) for one in inputs}

    def tree(outcomes):
        graph.outcomes = outcomes
        try:
            found = function(graph, given)
        except Undecided as asked:
            (number,) = asked.args
        else:
            ways.append(outcomes)
            return found
        if len(ways) >= WAYS or len(outcomes) >= WAYS:
            raise AnalysisError(
                f"{name} goes more than {WAYS} ways through its if, max and min. A page without Python takes up to {WAYS}. Use "
                "np.where, np.maximum and np.minimum instead."
            )
        return {"if": number, "then": tree({**outcomes, number: True}), "else": tree({**outcomes, number: False})}

    try:
        return graph, tree({})
    except NotRecorded as needed:
        raise AnalysisError(
            f"{name} uses {needed} with a value that changes. A page without Python draws with functions of NumPy alone. Use "
            "np.cos, np.maximum, np.where and others like them, and labels whose text stays."
        ) from None
    except AnalysisError:
        raise
    except Exception as error:
        raise AnalysisError(
            f"{name} stops with {type(error).__name__}: {error}. For a page without Python it is called with values that are not "
            "known yet. Use functions of NumPy, and np.stack([x, y]) instead of np.array([x, y])."
        ) from error


def _leaves(tree):
    return [*_leaves(tree["then"]), *_leaves(tree["else"])] if isinstance(tree, dict) else [tree]


def _asked(tree):
    return [tree["if"], *_asked(tree["then"]), *_asked(tree["else"])] if isinstance(tree, dict) else []


def _renumbered(tree, places, leaf):
    if not isinstance(tree, dict):
        return leaf(tree)
    return {"if": places[tree["if"]], **{way: _renumbered(tree[way], places, leaf) for way in ("then", "else")}}
