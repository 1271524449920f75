"""What a class costs one server: `python tests/benchmarks/many_views.py` (``--kernels 20``, ``--seconds 10``).

JupyterLab's server runs so many kernels, each with a live view on which a hand pushes a wall. The browsers are left out, for
they run on the students' computers: a client of a few lines stands for each, which opens the widget over the server's
websocket, says what view.js says, and throws the frames away. Printed are the memory and the processor time of kernels and
server.
"""

import argparse
import asyncio
import json
import math
import os
import struct
import sys
import tempfile
import time
import uuid
from pathlib import Path
from urllib.request import Request, urlopen

import psutil
from tornado.websocket import websocket_connect

sys.path.insert(0, str(Path(__file__).parents[1] / "browser"))
from lab import Lab

from hapticlab.widgets.browser_view import KINDS

VIEW = """
import os, hapticlab as hl
from IPython.display import display
paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
view = hl.live(paddle, {scene})
display(view)
"""
#: what the hands do: sixty moves a second to and fro over a wall at 10 mm, and words of life as view.js sends them
MOVES, HEARTBEAT, AMPLITUDE = 60, 0.4, 0.02


class Student:
    """One kernel, and what its browser says and hears."""

    def __init__(self, address, number):
        with urlopen(Request(f"{address}/api/kernels", data=b'{"name": "python3"}', method="POST")) as said:
            self.kernel = json.load(said)["id"]
        self.address, self.number, self.frames, self.view = address, float(number), 0, None

    async def open(self, scene):
        """Run the cells and wait for the widget's channel."""
        self.socket = await websocket_connect(f"ws{self.address[4:]}/api/kernels/{self.kernel}/channels")
        self._send("shell", "execute_request", {"code": VIEW.format(scene=scene), "silent": False, "stop_on_error": True})
        while self.view is None:
            message, _ = await self._next()
            if message["msg_type"] == "error":
                raise RuntimeError("\n".join(message["content"]["traceback"]))
            model = message["content"].get("data", {}).get("state", {}) if message["msg_type"] == "comm_open" else {}
            if "about" in model:
                self.view = message["content"]["comm_id"]

    async def push(self, seconds):
        """Drag the handle to and fro; count the frames that come."""
        self._say("ready", 1.0)
        hearing = asyncio.create_task(self._hear())
        begun, said = time.monotonic(), -1.0
        self._say("hold", 1.0)
        while (now := time.monotonic() - begun) < seconds:
            if now > said + HEARTBEAT:
                said = now
                self._say("alive", 1.0, time.time())
            self._say("intend", AMPLITUDE * math.sin(2 * math.pi * 0.6 * now))
            await asyncio.sleep(1 / MOVES)
        hearing.cancel()

    async def _hear(self):
        while True:
            message, buffers = await self._next()
            self.frames += message["msg_type"] == "comm_msg" and bool(buffers)

    async def _next(self):
        """Return the next message and its buffers; those with buffers come as binary: count, offsets, JSON, buffers."""
        said = await self.socket.read_message()
        if isinstance(said, str):
            return json.loads(said), []
        (count,) = struct.unpack(">I", said[:4])
        offsets = [*struct.unpack(f">{count}I", said[4 : 4 * (count + 1)]), len(said)]
        parts = [said[begin:end] for begin, end in zip(offsets, offsets[1:], strict=False)]
        return json.loads(parts[0]), parts[1:]

    def _say(self, kind, value=0.0, more=0.0):
        buffer = struct.pack("<4d", self.number, KINDS.index(kind), value, more)
        self._send("shell", "comm_msg", {"comm_id": self.view, "data": {"method": "custom", "content": {}}}, [buffer])

    def _send(self, channel, kind, content, buffers=()):
        header = {"msg_id": uuid.uuid4().hex, "msg_type": kind, "session": "class", "username": "", "version": "5.3", "date": ""}
        whole = {"header": header, "parent_header": {}, "metadata": {}, "content": content, "channel": channel}
        if not buffers:
            self.socket.write_message(json.dumps(whole))
            return
        parts = [json.dumps(whole).encode(), *buffers]
        offsets = [4 * (len(parts) + 1)]
        for part in parts[:-1]:
            offsets.append(offsets[-1] + len(part))
        self.socket.write_message(struct.pack(f">{len(parts) + 1}I", len(parts), *offsets) + b"".join(parts), binary=True)


async def lesson(lab, count, seconds, scene):
    """Return the students after the views ran so long, with the processor time of the kernels and of the server meanwhile [s]."""
    students = []
    for number in range(count):
        students.append(Student(lab.address, number))
        await students[-1].open(scene)
    server = psutil.Process(lab._server.pid)
    await asyncio.gather(*(student.push(2.0) for student in students))  # compiles, and settles
    kernels = [one for one in server.children(recursive=True) if "ipykernel" in " ".join(one.cmdline())]
    frames, before = sum(student.frames for student in students), (spent(kernels), spent([server]))
    begun = time.monotonic()
    await asyncio.gather(*(student.push(seconds) for student in students))
    took = time.monotonic() - begun
    memory = sorted(one.memory_full_info().uss / 2**20 for one in kernels)
    share, own = 100 * (spent(kernels) - before[0]) / took / count, server.memory_full_info().uss / 2**20
    rate = (sum(student.frames for student in students) - frames) / took / count
    print(f"{count} kernels, {scene}, {rate:.1f} frames/s a view")
    print(
        f"a kernel: {memory[len(memory) // 2]:.0f} MiB of its own (median; {sum(memory):.0f} MiB in all), {share:.1f} % of a core"
    )
    print(f"the server: {own:.0f} MiB, {100 * (spent([server]) - before[1]) / took:.0f} % of a core")


def spent(processes):
    """Return the processor time of processes so far [s]."""
    return sum(sum(one.cpu_times()[:2]) for one in processes)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kernels", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--scene", default="hl.wall()(k=300, x_o=0.01)")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, Lab(folder) as lab:
        asyncio.run(lesson(lab, given.kernels, given.seconds, given.scene))
        lab.end_kernels()
    load = ", ".join(f"{each:.1f}" for each in os.getloadavg()) if hasattr(os, "getloadavg") else "unknown"
    print(f"load of this computer at the end, of 1, 5 and 15 minutes: {load}; {os.cpu_count()} processors")


if __name__ == "__main__":
    main()
