"""Asking a session: a request, a deadline, a watch over its processes, and a reply that nobody believes."""

import json
import math
import secrets
import select
import socket
from dataclasses import asdict

from ..inside import watch
from ..inside.protocol import MOST_NUMBERS

#: what one look at a session's processes is apart from the next [s]
PERIOD = 0.05
#: how much wall clock a step has, in what it may be charged
MOST_WALL = 10
#: of a reply, beside its values
FRAME = 1 << 16
#: how long a process may take to end whose socket is closed already [s]
GRACE = 2.0
#: lists, dicts and quotes of a reply: what each costs to read is far more than its bytes
MOST_PARTS = 2_000_000


class SessionEnded(Exception):
    """A session is over before it replied.

    ``reason`` is "time", "memory", "processes", "exit", "signal N", "flood" or "garbage".
    """

    def __init__(self, reason):
        super().__init__(f"the session ended: {reason}")
        self.reason = reason


def parsed(line, number):
    """Return the reply to the request of that number, or None for another line.

    Examples
    --------
    >>> parsed(b'{"number": "a7", "cells": 3}', "a7"), parsed(b'{"number": "a6"}', "a7")
    ({'cells': 3}, None)
    """
    try:
        if sum(map(line.count, (b"[", b"{", b'"'))) > MOST_PARTS or line.count(b",") > MOST_NUMBERS + FRAME:
            raise SessionEnded("garbage")
        reply = json.loads(line)
        found = reply.pop("number")
    except (ValueError, RecursionError, KeyError, AttributeError, TypeError):
        raise SessionEnded("garbage") from None
    return reply if found == number else None


class Replies:
    """Reads the reply to one request out of what comes.

    Parameters
    ----------
    number : str
        Of the request.
    most : int
        Bytes that may come before there is a reply.
    """

    def __init__(self, number, most):
        self.number, self.left, self.held = number, most, b""

    def found(self, block):
        """Return the reply, once the block ends its line; None before."""
        self.left -= len(block)
        if self.left < 0:
            raise SessionEnded("flood")
        *lines, self.held = (self.held + block).split(b"\n")
        return next((reply for line in lines if (reply := parsed(line, self.number)) is not None), None)


class Session:
    """A student's session, asked by :meth:`ask`; a context manager, which kills it when it is left.

    Attributes
    ----------
    charged : float
        What all it was asked was charged [s].
    """

    def __init__(self, starter, limits):
        self.starter, self.limits, self.open, self.charged = starter, limits, True, 0.0
        self.killed = starter.group.ended() if starter.group else 0
        self.folder = starter._scratch()
        self.channel, theirs = socket.socketpair()
        self.channel.setblocking(False)
        settings = {**starter.settings, "scratch": self.folder.__enter__(), "limits": asdict(limits)}
        try:
            with theirs:
                self.process = starter.order("session", theirs.fileno(), **settings)["process"]
        except ConnectionError:
            self._put_away()
            raise

    def ask(self, request, seconds):
        """Return the reply to a request.

        Parameters
        ----------
        request : dict
        seconds : float
            What it may be charged, see :class:`hapticlab.grading.inside.watch.Meter`; ten times that of wall clock [s].

        Raises
        ------
        SessionEnded
        """
        if not self.open:
            raise SessionEnded("exit")
        # no reply can be written before its request, as nobody guesses its number
        number = secrets.token_hex(8)
        meter = watch.Meter(self.process)
        try:
            return self._reply(json.dumps({**request, "number": number}).encode() + b"\n", number, meter, seconds)
        except SessionEnded:
            self.charged += meter.charged()
            self.close()
            raise
        finally:
            if self.open:
                self.charged += meter.charged() if meter.wall > PERIOD else meter.wall

    def _reply(self, line, number, meter, seconds):
        """Send a line and wait for the reply, watching meanwhile."""
        left, replies, look = memoryview(line), Replies(number, self.limits.answer + FRAME), PERIOD
        poller = select.poll()
        poller.register(self.channel, select.POLLIN | select.POLLOUT)
        while True:
            events = dict(poller.poll(max(0, 1e3 * (look - meter.wall))))
            about = events.get(self.channel.fileno(), 0)
            if about & select.POLLIN and (block := self.received()):
                if (reply := replies.found(block)) is not None:
                    return reply
            elif about & (select.POLLIN | select.POLLHUP | select.POLLERR):
                raise SessionEnded(self._how_it_ended())
            elif about & select.POLLOUT:
                left = left[self.sent(left) :]
                if not left:
                    poller.modify(self.channel, select.POLLIN)
            if meter.wall >= look:
                self.check()
                if meter.wall > MOST_WALL * seconds or meter.charged() > seconds:
                    raise SessionEnded("time")
                look = meter.wall + PERIOD

    def received(self):
        """Bytes that have come; none at the end of the socket."""
        try:
            return self.channel.recv(1 << 20)
        except OSError:
            return b""

    def sent(self, line):
        """Number of bytes that could be sent; where the other end is gone, that is seen next."""
        try:
            return self.channel.send(line)
        except BlockingIOError:
            return 0
        except OSError:
            return len(line)

    def _how_it_ended(self):
        """Return the reason, once the other end of the socket is closed; who closed it and goes on is ended."""
        code = self._end(GRACE)
        if self._without_memory():
            return "memory"
        return f"signal {-code}" if code is not None and code < 0 else "exit"

    def check(self):
        """Raise where the session has too many processes, or too much memory or files."""
        limits, level = self.limits, self.starter.level
        found = [self.process, *(watch.descendants(self.process) if limits.processes > 1 else ())]
        if len(found) > limits.processes:
            raise SessionEnded("processes")
        # of one process what it was forked with is known, of several what they share is told by smaps_rollup, which is slow
        held = watch.memory(found) if limits.processes > 1 else watch.anonymous(self.process)
        if held - self.starter.held > limits.memory or self._without_memory():
            raise SessionEnded("memory")
        if level != "namespaces" and self._files(found) > limits.scratch:
            raise SessionEnded("flood")

    def _without_memory(self):
        return bool(self.starter.group) and self.starter.group.ended() > self.killed

    def _files(self, processes):
        """Size of its files [bytes], infinite where there are too many."""
        places = [self.folder.name, *watch.left_by(self.starter.user, self.starter.writable)]
        total, count = map(sum, zip(*map(watch.size, places), strict=True))
        return total + sum(map(watch.unlinked, processes)) if count <= self.limits.files else math.inf

    def close(self):
        """Kill all processes of the session and delete what it wrote."""
        if self.open:
            self._end(0.0)

    def _end(self, grace):
        self.open = False
        code = self.starter.end(grace)
        self._put_away()
        return code

    def _put_away(self):
        self.channel.close()
        self.folder.__exit__(None, None, None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
