"""Rows of a graph as plain JSON: those that are needed, inputs first, each with the numbers of what it needs."""

import math

import numpy as np


def graph_data(graph, inputs, roots):
    """Return what some rows need as data, and the number that each row has there.

    Parameters
    ----------
    graph : Graph
    inputs : dict of str to float
        What each input is where it is not given.
    roots : iterable of int
        Rows that are wanted.

    Returns
    -------
    dict
        ``inputs``, pairs of a name and a number, and ``nodes``, numbered on from them: a number that is known;
        ["numbers", [...]]; ["linspace", first, last, count]; ["join", *single numbers]; ["slice", rows one after the
        other, first, step, count] or ["take", rows, places]; ["reduce" or "accumulate", function, how many numbers each,
        row]; or [function, *rows]. What is no number is "NaN", "Infinity" or "-Infinity".
    dict of int to int
    """
    needed, waiting = set(), list(roots)
    while waiting:
        number = waiting.pop()
        if number not in needed:
            needed.add(number)
            waiting += _needs(graph.rows[number])
    order = sorted(needed, key=lambda number: (graph.rows[number][0] != "input", number))
    places = {number: place for place, number in enumerate(order)}
    names = [graph.rows[number][1] for number in order if graph.rows[number][0] == "input"]
    nodes = [_step(graph, number, places) for number in order[len(names) :]]
    return {"inputs": [[name, _plain(inputs[name])] for name in names], "nodes": nodes}, places


def _needs(row):
    kind, *rest = row
    if kind in ("input", "constant"):
        return []
    if kind == "gather":
        return [number for number, _ in rest]
    return rest[2:] if kind in ("reduce", "accumulate") else rest


def _step(graph, number, places):
    kind, *rest = graph.rows[number]
    if kind == "constant":
        return _known(graph.constant(number))
    if kind == "gather":
        return _gathered(rest, graph.sizes, places)
    if kind in ("reduce", "accumulate"):
        return [kind, *rest[:2], places[rest[2]]]
    return [kind, *(places[one] for one in rest)]


def _known(values):
    if len(values) == 1:
        return _plain(values[0])
    even = np.linspace(values[0], values[-1], len(values))
    if len(values) > 3 and np.max(np.abs(values - even)) <= 1e-15 * np.max(np.abs(values)):
        return ["linspace", _plain(values[0]), _plain(values[-1]), len(values)]
    return ["numbers", [_plain(value) for value in values]]


def _plain(value):
    if not math.isfinite(value):
        return {math.inf: "Infinity", -math.inf: "-Infinity"}.get(value, "NaN")
    return int(value) if value == int(value) and abs(value) < 1e15 else float(value)


def _gathered(picks, sizes, places):
    if all(sizes[number] == 1 for number, _ in picks):
        return ["join", *(places[number] for number, _ in picks)]
    starts, end = {}, 0
    for number, _ in picks:
        if number not in starts:
            starts[number], end = end, end + sizes[number]
    sources, index = [places[number] for number in starts], [starts[number] + at for number, at in picks]
    step = index[1] - index[0] if len(index) > 1 else 1
    if index == [index[0] + k * step for k in range(len(index))]:
        return ["slice", sources, index[0], step, len(index)]
    return ["take", sources, index]
