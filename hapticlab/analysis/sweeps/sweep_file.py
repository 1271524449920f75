"""The file that a sweep fills while it runs, and goes on from: a line that says what it is of, then one record a chunk.

A record is written at once, at the end, and carries its own checksum: whatever a kill, a full disk or a pulled plug leaves
behind, what was finished before is read back, and the rest is measured again.
"""

import contextlib
import json
import os
import struct
import zlib
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...errors import AnalysisError

MAGIC = b"hapticlab sweep, format 1: "
#: mark, group, first point, number of points, digest of the group's program; then the values and a CRC-32 of it all
HEAD = struct.Struct("<4sIQQ16s")
MARK, CRC = b"part", struct.Struct("<I")


class Record(NamedTuple):
    """The metric at ``values.size`` points of a group from ``first`` on, by the program of that digest."""

    group: int
    first: int
    digest: bytes
    values: np.ndarray


class Partial:
    """A file open for appending; ``records`` are those it had. Without a path nothing is kept.

    Parameters
    ----------
    path : path or None
    identity : dict of str to str
        What the sweep is, part by part; a file of another is refused.

    Raises
    ------
    AnalysisError
        If the file is something else, of another sweep, or cannot be written.
    """

    def __init__(self, path, identity):
        self.records, self._file, self._written = [], None, False
        if path is None:
            return
        try:
            self.path = Path(path)
        except TypeError:
            raise AnalysisError(f"resume = {path!r}; needs the path of a file, which is made if it does not exist") from None
        line = MAGIC + json.dumps(identity).encode() + b"\n"
        with self._named("open"):
            self._file = open(self.path, "a+b", buffering=0)  # noqa: SIM115 (closed where the block ends)
        try:
            self._begin(line, identity)
        except BaseException:
            self._file.close()
            raise

    def _begin(self, line, identity):
        with self._named("read"):
            self._file.seek(0)
            content = self._file.read()
        kept = self._read(content, line, identity)
        with self._named("write"):
            if kept < len(content):
                self._file.truncate(kept)  # what a record that was cut off has left
            if kept == 0:
                self._write(line)

    def _read(self, content, line, identity):
        """Read the records that are whole; return where they end, 0 for a file that has yet to begin."""
        if line.startswith(content) and content != line:
            return 0
        head, _, _ = content.partition(b"\n")
        if not head.startswith(MAGIC):
            raise AnalysisError(f"resume = {str(self.path)!r} is not the file of a sweep; give the path of a new file")
        self._compare(head, identity)
        at = len(head) + 1
        while (record := _record(content, at)) is not None:
            self.records.append(record)
            at += HEAD.size + 8 * len(record.values) + CRC.size
        return at

    def _compare(self, head, identity):
        try:
            there = json.loads(head[len(MAGIC) :])
        except ValueError:
            there = {"first line": "damaged"}
        names = [name for name in {**identity, **there} if identity.get(name) != there.get(name)]
        if names:
            differ = "; ".join(f"{name}: {there.get(name, 'none')} there, {identity.get(name, 'none')} here" for name in names)
            raise AnalysisError(
                f"resume = {str(self.path)!r} contains a different sweep ({differ}). Give a different file, or delete this one"
            )

    def add(self, record):
        """Append a record, in one piece."""
        if self._file is None:
            return
        values = np.ascontiguousarray(record.values, "<f8")
        body = HEAD.pack(MARK, record.group, record.first, values.size, record.digest) + values.tobytes()
        with self._named("write"):
            self._write(body + CRC.pack(zlib.crc32(body)))

    def _write(self, content):
        self._written = True
        if self._file.write(content) != len(content):
            raise OSError("the disk is full")

    @contextlib.contextmanager
    def _named(self, what):
        try:
            yield
        except OSError as error:
            raise AnalysisError(f"resume = {str(self.path)!r}: cannot {what} it ({error.strerror or error})") from error

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._file is not None:
            if self._written:
                with contextlib.suppress(OSError):  # a network drive may know no way to make sure
                    os.fsync(self._file.fileno())
            self._file.close()


def _record(content, at):
    """Return the record that begins there, or None if none does, or it is cut off or damaged."""
    if len(content) < at + HEAD.size:
        return None
    mark, group, first, count, digest = HEAD.unpack_from(content, at)
    end = at + HEAD.size + 8 * count
    if mark != MARK or len(content) < end + CRC.size or CRC.unpack_from(content, end)[0] != zlib.crc32(content[at:end]):
        return None
    return Record(group, first, digest, np.frombuffer(content, "<f8", count, at + HEAD.size))


def remaining(records, points):
    """Return the ranges of a number of points that no record covers, as (start, stop).

    Examples
    --------
    >>> import numpy as np
    >>> remaining([Record(0, 4, b"", np.zeros(2)), Record(0, 0, b"", np.zeros(1))], 10)
    [(1, 4), (6, 10)]
    """
    found, at = [], 0
    for first, stop in sorted((r.first, r.first + len(r.values)) for r in records):
        if first > at:
            found.append((at, first))
        at = max(at, stop)
    return [*found, (at, points)] if at < points else found
