"""Cortex-M processors under unicorn: the bits of the machine, and cycles by a model, which nobody has measured.

Unicorn executes instructions and knows no cycles. The model adds, for every instruction executed, what the processor's
technical reference manual says (Cortex-M4: DDI 0439B, table 3-1 and 7-1), memory without wait states, and 3 for a pipeline
refill.
"""

import functools
import re
import shutil
import struct
from importlib.util import find_spec

import numpy as np
from bare import build, run, scratch, symbols

STOP, STACK = 0x0100_0000, 0x2002_0000
TEXT, DATA = 0x0800_0000, 0x2000_0000
CONDITIONAL = re.compile(r"(b(eq|ne|cs|cc|hs|lo|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)(\.[nw])?|cbn?z)$")
REGISTERS = re.compile(r"\{([^}]*)\}")


def _count(operands):
    """Return how many registers are between the braces."""
    count = 0
    for part in REGISTERS.search(operands)[1].split(","):
        ends = [int(n) for n in re.findall(r"[rs](\d+)", part)]
        count += ends[1] - ends[0] + 1 if len(ends) == 2 else 1
    return count


REFILL = 3  # cycles of the M4 after a taken branch, 1 to 3


def m4_cycles(name, operands):
    if name.startswith(("vdiv", "vsqrt")):
        return 14
    if name in ("push", "pop", "vpush", "vpop") or name.startswith(("ldm", "stm", "vldm", "vstm")):
        return 1 + _count(operands) + (REFILL if "pc" in operands else 0)
    if name.startswith(("ldr", "vldr")):
        wide = name.startswith(("ldrd", "vldr.64"))
        return 2 + wide + (REFILL if re.match(r"pc\b", operands) else 0)
    if name.startswith(("str", "vstr")):
        return 2 + name.startswith("strd")
    if name.startswith(("udiv", "sdiv")):
        return 12
    if name.startswith(("tbb", "tbh")):
        return 2 + REFILL
    if CONDITIONAL.match(name):
        return 1
    if re.match(r"(b|bl|bx|blx)(\.[nw])?$", name) or (name.startswith("mov") and operands.startswith("pc")):
        return 1 + REFILL
    return 1


#: name -> (compiler flags, unicorn's model, cycles of an instruction, more cycles of a conditional branch taken)
PROCESSORS = {
    "cortex-m4f": (
        ("-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"), "UC_CPU_ARM_CORTEX_M4", m4_cycles, REFILL,
    ),
}  # fmt: skip


def missing():
    """Why there can be no Cortex-M here, or None."""
    if not shutil.which("arm-none-eabi-gcc"):
        return "needs a cross compiler: apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi"
    return None if find_spec("unicorn") else "needs an emulator: pip install unicorn"


def tool(name):
    return shutil.which(f"arm-none-eabi-{name}") or f"arm-none-eabi-{name}"


@functools.cache
def image(name):
    """Build the bench for a processor; return its path."""
    flags = ("-mthumb", "-nostartfiles", "--specs=nosys.specs", "-Wl,--no-warn-rwx-segments", "-DBENCH_ARENA=16000")
    places = (f"-Wl,-Ttext={TEXT:#x}", f"-Wl,-Tdata={DATA:#x}", "-Wl,-e,main")
    return build(tool("gcc"), scratch() / f"{name}.elf", *PROCESSORS[name][0], *flags, *places)


def segments(path):
    """Yield (address, bytes) of what an ELF file loads."""
    data = path.read_bytes()
    at, size, count = struct.unpack_from("<I", data, 28)[0], *struct.unpack_from("<HH", data, 42)
    for k in range(count):
        kind, offset, address, _, length, _ = struct.unpack_from("<6I", data, at + k * size)
        if kind == 1 and length:
            yield address, data[offset : offset + length]


class Cortex:
    """A Cortex-M with an image whose functions are called one by one; the interface of :class:`bare.Avr`.

    Parameters
    ----------
    name : {"cortex-m4f"}
    counting : bool
        False: cycles are not counted, which is faster.
    """

    word_bits = 8
    arena_bytes = 16000

    def __init__(self, name, counting=True):
        import unicorn
        from unicorn import arm_const

        _, model, self.cycles_of, self.taken = PROCESSORS[name]
        self.arm, path = arm_const, image(name)
        self.address = symbols(tool("nm"), path)
        self.emulator = uc = unicorn.Uc(unicorn.UC_ARCH_ARM, unicorn.UC_MODE_THUMB | unicorn.UC_MODE_MCLASS)
        uc.ctl_set_cpu_model(getattr(arm_const, model))
        for place, size in ((TEXT, 0x10_0000), (DATA, 0x2_0000), (STOP, 0x1000)):
            uc.mem_map(place, size)
        for place, data in segments(path):
            uc.mem_write(place, data)
        if name == "cortex-m4f":
            uc.reg_write(arm_const.UC_ARM_REG_FPEXC, 0x4000_0000)
        self.listing = _listing(path)
        self.blocks, self.cycles = {}, 0
        self.after, self.may_fall = None, False
        if counting:
            uc.hook_add(unicorn.UC_HOOK_BLOCK, self._block)

    def _block(self, uc, address, size, _):
        if self.may_fall and address != self.after:
            self.cycles += self.taken
        key = (address, size)
        if key not in self.blocks:
            code = [self.listing[a] for a in range(address, address + size, 2) if a in self.listing]
            last = bool(code) and bool(CONDITIONAL.match(code[-1][0]))
            self.blocks[key] = sum(self.cycles_of(*c) for c in code), last
        cycles, self.may_fall = self.blocks[key]
        self.cycles += cycles
        self.after = address + size

    def place(self, name):
        return self.address[name]

    def write(self, address, data):
        self.emulator.mem_write(address, bytes(data))

    def read(self, address, count):
        return bytes(self.emulator.mem_read(address, count))

    def call(self, name, *arguments):
        """Call a function; return its result's low byte and its cycles by the model."""
        uc, arm = self.emulator, self.arm
        for k, value in enumerate(arguments[:4]):
            uc.reg_write(getattr(arm, f"UC_ARM_REG_R{k}"), value)
        stack = STACK - 64
        for k, value in enumerate(arguments[4:]):
            self.write(stack + 4 * k, struct.pack("<I", value))
        uc.reg_write(arm.UC_ARM_REG_SP, stack)
        uc.reg_write(arm.UC_ARM_REG_LR, STOP | 1)
        self.cycles = 0
        self.may_fall = False
        uc.emu_start(self.address[name] | 1, STOP)
        return uc.reg_read(arm.UC_ARM_REG_R0) & 255, self.cycles

    def verify(self, place, size, registers, capacity):
        return self.call("hl_verify", place, self.place("arena"), size, registers, capacity)

    def rows(self, name, arguments, to, rows, source, count):
        """Call a function once a row of bytes written to ``to``; return bytes read from ``source``, and cycles."""
        rows = np.ascontiguousarray(rows, np.uint8)
        out, cycles = np.empty((len(rows), count), np.uint8), np.empty(len(rows), np.uint32)
        for k, row in enumerate(rows):
            if len(row):
                self.write(to, row.tobytes())
            cycles[k] = self.call(name, *arguments)[1]
            out[k] = np.frombuffer(self.read(source, count), np.uint8)
        return out, cycles


def _listing(path):
    """Return {address: (mnemonic, operands)} of an image."""
    found = {}
    for line in run(tool("objdump"), "-d", path).splitlines():
        parts = line.split("\t")
        if len(parts) >= 3 and parts[0].strip().endswith(":"):
            operands = parts[3] if len(parts) > 3 else ""
            found[int(parts[0].strip()[:-1], 16)] = parts[2].strip(), operands
    return found
