"""Asking a session: a request, a deadline, a watch over its processes, and a reply that nobody believes."""

import json
import os
import secrets
import select
import socket
from dataclasses import asdict

from . import watch
from .inside.protocol import MOST_NUMBERS

#: what one look at a session's processes is apart from the next [s]
PERIOD = 0.05
#: how much wall clock a step has, in what it may be charged
MOST_WALL = 10
#: of a reply, beside its values
FRAME = 1 << 16
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


class Session:
    """A student's session, asked by :meth:`ask`; a context manager, which kills all its processes when it is left.

    Attributes
    ----------
    charged : float
        What all it was asked was charged [s].
    """

    def __init__(self, starter, limits):
        self.starter, self.limits, self.number, self.open = starter, limits, "", True
        self.charged = 0.0
        self.folder = starter._scratch()
        self.channel, theirs = socket.socketpair()
        self.channel.setblocking(False)
        self.status, status = os.pipe()
        scratch = self.folder.__enter__()
        starter.order("session", theirs.fileno(), status, scratch=scratch, limits=asdict(limits))
        theirs.close()
        os.close(status)

    def ask(self, request, seconds):
        """Return the reply to a request.

        Parameters
        ----------
        request : dict
        seconds : float
            What it may be charged, see :class:`hapticlab.grading.watch.Meter`; ten times that of wall clock [s].

        Raises
        ------
        SessionEnded
        """
        if not self.open:
            raise SessionEnded("exit")
        # no reply can be written before its request, as nobody guesses its number
        self.number = secrets.token_hex(8)
        meter = watch.Meter(self.starter.process.pid)
        try:
            return self._reply(json.dumps({**request, "number": self.number}).encode() + b"\n", meter, seconds)
        except SessionEnded:
            self.charged += meter.charged()
            self.close()
            raise
        finally:
            if self.open:
                self.charged += meter.charged() if meter.wall > PERIOD else meter.wall

    def _reply(self, line, meter, seconds):
        """Send a line and wait for the reply, watching meanwhile; the end of the socket is no news, as anybody may hold it."""
        left, held, taken, look = memoryview(line), b"", 0, PERIOD
        poller = select.poll()
        poller.register(self.status, select.POLLIN)
        poller.register(self.channel, select.POLLIN | select.POLLOUT)
        while True:
            events = dict(poller.poll(max(0, 1e3 * (look - meter.wall))))
            about = events.get(self.channel.fileno(), 0)
            if about & select.POLLIN and (block := self.received()):
                taken += len(block)
                if taken > self.limits.answer + FRAME:
                    raise SessionEnded("flood")
                *lines, held = (held + block).split(b"\n")
                for reply in (parsed(line, self.number) for line in lines):
                    if reply is not None:
                        return reply
            elif about & select.POLLOUT and not about & select.POLLIN:
                left = left[self.sent(left) :]
                if not left:
                    poller.modify(self.channel, select.POLLIN)
            elif about:
                poller.unregister(self.channel)
            elif self.status in events:
                code = os.read(self.status, 1)
                raise SessionEnded(f"signal {code[0]}" if code and code[0] else "exit")
            if meter.wall >= look:
                self.check()
                if meter.wall > MOST_WALL * seconds or meter.charged() > seconds:
                    raise SessionEnded("time")
                look = meter.wall + PERIOD

    def received(self):
        """Return what has come; nothing at the end of the socket."""
        try:
            return self.channel.recv(1 << 20)
        except OSError:
            return b""

    def sent(self, line):
        """Return how much could be sent; where the other end is gone, the keeper will say how it ended."""
        try:
            return self.channel.send(line)
        except BlockingIOError:
            return 0
        except OSError:
            return len(line)

    def check(self):
        """Raise where the session has too many processes, or too much memory."""
        found = watch.descendants(self.starter.process.pid)
        if len(found) > self.limits.processes + 2:
            raise SessionEnded("processes")
        if watch.memory(found, self.starter.held) > self.limits.memory:
            raise SessionEnded("memory")
        if self.starter.level != "namespaces" and watch.size(self.folder.name) > self.limits.scratch:
            raise SessionEnded("flood")

    def close(self):
        """Kill all processes of the session and delete what it wrote."""
        if self.open:
            self.open = False
            self.starter.end()
            self.channel.close()
            os.close(self.status)
            self.folder.__exit__(None, None, None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
