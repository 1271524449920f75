"""What a front end is told once of a live view, before its first frame."""

from dataclasses import asdict

from .frame import columns
from .signals import open_traces
from .sources import help_words, overview_words
from .traces import rows_apart


def description(stage):
    """Return facts of a Stage: a dict of what JSON can carry.

    ``title``; ``kind``, "simulated" or "board"; ``parameters``, a list of the fields of a Span and ``value``;
    ``traces``, a list of {name, label, unit_shown, scale, open}, where shown = scale * value in SI, of the column of
    that name, and ``open`` where its trace is there from the beginning; ``touches``, whether there is something to be
    in contact with; ``loop``, whether F over x may be shown; ``x_range``, how far a hand goes, and ``box``, [left,
    right, bottom, top], of the picture [m]; ``along``, the direction in which the handle moves there; ``let_go``,
    whether a drag that is released lets go; ``overview`` and ``help``, words on what is seen and on what moves it;
    ``speed`` and ``slow``, scene time over the clock's, now and in slow motion; ``T`` and ``apart``, between two samples
    and between two rows of a frame [s]; ``columns``.
    """
    picture, source, values = stage.picture, stage.source, stage.values
    return {
        "title": source.program.name,
        "kind": source.kind,
        "parameters": [{**asdict(span), "value": values[span.name]} for span in stage.spans],
        "traces": open_traces(stage.signals),
        "touches": stage.touches,
        "loop": not stage.hidden & {"x", "F"},
        "x_range": list(picture.reach),
        "box": list(picture.box),
        "along": list(picture.along),
        "let_go": stage.let_go,
        "overview": overview_words(source, stage.scene, picture.along),
        "help": help_words(source),
        "speed": stage.motion.speed,
        "slow": stage.slow_speed,
        "T": source.period,
        "apart": rows_apart(source.period),
        "columns": columns(stage.motion.watched),
    }
