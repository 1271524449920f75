"""A Raspberry Pi Pico in rp2040js, cycle by cycle in virtual time: :class:`emulator.Uno` for another board.

The chip runs in a process of node, ``pico/emulator.mjs``; what it models, and what not, is said in the files beside it.
"""

import json
import shutil
import subprocess
import weakref
from pathlib import Path

import numpy as np

from hapticlab.device.setup.drive.uf2_blocks import parse_uf2

CYCLES_PER_SECOND = 125_000_000
POWER, RUN_PIN = "power", "run"
HERE = Path(__file__).resolve().parent / "pico"
FLASH_AT, RAM_AT = 0x1000_0000, 0x2000_0000
FIRST_ADC_PIN = 26


def missing():
    """Why there can be no emulated Pico here, or None."""
    if not shutil.which("node"):
        return "the emulated Pico needs node 18 or newer"
    if not (HERE / "node_modules" / "rp2040js" / "package.json").is_file():
        return f"the emulated Pico needs rp2040js: npm ci --prefix {HERE.relative_to(HERE.parents[2]).as_posix()}"
    return None


def _end(node):
    node.stdin.close()
    node.wait()
    node.stdout.close()


class Pico:
    """One board. Time stands still but for :meth:`run`.

    Parameters
    ----------
    image : path
        The .uf2 file.
    flash : bytes, optional
        All of the flash as another board left it, in place of an image.

    Attributes
    ----------
    cycle : int
        Cycles of 8 ns since it was made.
    duty : float
        Duty of the motor from its pins, -256 to 256.
    halted : str or None
        Why the processor stands.
    configured : bool
        Whether the host has found a serial port on its USB.
    unsent : int
        Packets that wait for the board to take them.
    """

    hz = CYCLES_PER_SECOND
    #: bytes never wait in a receiver that could run over: a full board refuses the packet
    overruns = 0

    def __init__(self, image=None, *, flash=None):
        self._node = subprocess.Popen(
            ["node", "--stack-size=4000", HERE / "emulator.mjs"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        self._ended = weakref.finalize(self, _end, self._node)
        self.cycle, self.duty, self.halted, self.configured, self.unsent = 0, 0.0, None, False, 0
        self._set, self._received = [], bytearray()
        blocks = [(0, flash)] if flash else parse_uf2(Path(image).read_bytes(), str(image))
        self._ask("load", flash=[(at % FLASH_AT, bytes(data).hex()) for at, data in blocks])
        self.reset(POWER)

    def close(self):
        """End its process."""
        self._ended()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _ask(self, do, **given):
        request = {"do": do, **given}
        if self._set:
            request["set"], self._set = self._set, []
        self._node.stdin.write(json.dumps(request).encode() + b"\n")
        self._node.stdin.flush()
        answer = json.loads(self._node.stdout.readline() or '{"error": "node ended"}')
        if "error" in answer:
            raise RuntimeError(answer["error"])
        self.cycle, self.duty, self.halted = answer["cycle"], 256 * answer["duty"], answer["halted"]
        self.configured, self.unsent = answer["configured"], answer["unsent"]
        self._received += bytes.fromhex(answer["in"])
        return answer

    def wire(self, drive, motor_pins, chip_select=None):
        """Connect a driver's inputs, and the angle sensor's select line, to these GPs."""
        self._set.append(("wire", drive, list(motor_pins), chip_select))
        self._ask("run", to=self.cycle)

    def reset(self, cause=RUN_PIN):
        """Reset; RAM stays as it is, but for power."""
        self._ask("reset", cause=cause)

    def run(self, seconds):
        """Run this much longer."""
        self.run_to(self.cycle + round(seconds * CYCLES_PER_SECOND))

    def run_to(self, cycle):
        """Run to a cycle: the first instruction that ends there or behind it."""
        self._ask("run", to=cycle)

    @property
    def now(self):
        """Virtual time [s]."""
        return self.cycle / CYCLES_PER_SECOND

    def adc(self, counts, channel=0):
        """Put GP26 + channel at so many counts of 4096."""
        self._set.append(("adc", channel, int(counts)))

    def fly(self, counts, seconds, after=0.0, channel=0):
        """Let an input of the ADC fly to so many counts in some time, and begin after some time."""
        begin = self.cycle + round(after * CYCLES_PER_SECOND)
        self._set.append(("fly", channel, int(counts), begin, begin + round(seconds * CYCLES_PER_SECOND)))

    def pin(self, pin, level):
        """Drive a GP."""
        self._set.append(("pin", pin, int(level)))

    def angle(self, reading, fault=None):
        """Turn the AS5048A; ``fault`` is "parity", "error", "wire" or "low"."""
        self._set += [("angle", int(reading)), ("fault", fault)]

    def open_port(self, baudrate=500_000):
        """Open the port, as a terminal does: rate, DTR and RTS."""
        self._set.append(("lines", True, baudrate))

    def close_port(self):
        """Take DTR away."""
        self._set.append(("lines", False, 500_000))

    def attach(self, on):
        """Plug the cable in, or pull it out; the board keeps its supply."""
        self._set.append(("attach", on))

    def setup(self, request):
        """Send the eight bytes of a control request, and zeros where it announces data of the host."""
        self._set.append(("setup", list(request)))

    def listen(self, on):
        """Let the computer ask for what the board sends, or be busy with something else."""
        self._set.append(("listen", on))

    def cut_power(self, operation, part):
        """Take the supply away in an operation of the flash, 0 is the next one, after a part of its time."""
        self._set.append(("cut", operation, part))

    def write(self, data):
        """Queue bytes for it, in packets of up to 64 from each call."""
        self._set.append(("out", bytes(data).hex()))

    @property
    def waiting(self):
        """Bytes it has sent that nobody has read."""
        return len(self._received)

    def read(self, size=65536):
        """Bytes it has sent."""
        data = bytes(self._received[:size])
        del self._received[:size]
        return data

    def duties(self):
        """Every change of the duty, the latest 16384: cycles and duties."""
        found = self._ask("duties")
        return np.array(found["cycles"], dtype=np.int64), 256 * np.array(found["duties"])

    def levels(self, *pins):
        """Part of the time in which each GP is high; None where the board does not drive it."""
        return self._ask("levels", pins=list(pins))["levels"]

    def peek(self, address, count):
        """Bytes of RAM, or of flash counted from 0."""
        return bytes.fromhex(self._ask("peek", at=address, count=count)["bytes"])

    def poke(self, address, data):
        """Write into RAM."""
        self._ask("poke", at=address, bytes=bytes(data).hex())

    def store_word(self, address, value):
        """Write a word anywhere, as the processor would."""
        self._ask("word", at=address, value=value)

    def find(self, data):
        """Address of the first place in RAM with these bytes."""
        at = self._ask("find", bytes=bytes(data).hex())["at"]
        assert at >= 0, f"{data!r} is nowhere in RAM"
        return RAM_AT + at

    def watch(self, address):
        """Count cycles from one visit of the code at an address to the next, for :meth:`costs`."""
        self._ask("watch", at=address & ~1)

    def costs(self):
        """Cycles of every step since it was last asked, and of the rest of the main loop between visits of :meth:`watch`."""
        found = self._ask("costs")
        return np.array(found["steps"]), np.array(found["between"])

    @property
    def facts(self):
        """What the host saw of its USB, and what was noted of flash and registers."""
        return self._ask("facts")
