"""The virtual machine of the Pico's image, its functions called one by one in rp2040js: as :class:`bare.Avr`."""

import numpy as np
from build_image import build_image
from pico_emulator import Pico
from pico_loop import image

#: RAM that the image leaves free: for a program's bytes and registers, and for what hl_verify finds
FREE, ARENA = 0x2002_0000, 16_000


class Rp2040:
    """A processor with the image in RAM, whose functions are called one by one; cycles are those of rp2040js."""

    word_bits = 8
    arena_bytes = ARENA

    def __init__(self):
        elf = image().with_suffix(".elf")
        self.address = build_image.elf_symbols(elf) | {"arena": FREE, "program": FREE + ARENA}
        self.chip = Pico(flash=b"\xff" * 4096)
        for _, data, at, _ in build_image.segments(elf):
            assert at < 0x2000_0000 or at + len(data) <= FREE
            if data and at >= 0x2000_0000:
                self.write(at, data)

    def place(self, name):
        return self.address[name]

    def write(self, address, data):
        self.chip.poke(address, data)

    def read(self, address, count):
        return self.chip.peek(address, count)

    def call(self, name, *arguments):
        """Call a function; return its result's low byte and its cycles."""
        found = self.chip._ask("call", pc=self.address[name], given=[int(a) for a in arguments])
        return found["result"] & 255, found["cycles"]

    def verify(self, place, size, registers, capacity):
        return self.call("hl_verify", place, self.place("arena"), size, registers, capacity)

    def rows(self, name, arguments, to, rows, source, count):
        """Call a function once a row of bytes written to ``to``; return bytes read from ``source``, and cycles."""
        rows = np.ascontiguousarray(rows, np.uint8)
        found = self.chip._ask(
            "rows", pc=self.address[name], given=[int(a) for a in arguments], to=to, size=rows.shape[1],
            times=len(rows), rows=rows.tobytes().hex(), source=source, count=count,
        )  # fmt: skip
        out = np.frombuffer(bytes.fromhex(found["out"]), np.uint8).reshape(len(rows), count)
        return out, np.array(found["cycles"], np.uint32)
