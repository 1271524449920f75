"""An upper bound of an AVR image's stack, from its disassembly: every function's own bytes, and the deepest chain of calls.

Sound where nothing recurs and nothing is called through a pointer; both are refused, except for jumps through a table
that stay in their function.
"""

import re
import subprocess

from build_image import tool

_HEAD = re.compile(r"^([0-9a-f]{8}) <(.+)>:$")
_LINE = re.compile(r"^ +([0-9a-f]+):\t[0-9a-f ]+\t(\w+)(?:\t([^;]*))?(?:; (.*))?$")
_TARGET = re.compile(r"0x([0-9a-f]+)")
_LEAVING = ("ret", "reti", "jmp", "rjmp", "ijmp")
_SAVES = re.compile(r"<__prologue_saves__(?:\+(0x[0-9a-f]+))?>")
RETURN = 2  # bytes of a return address
SAVED = 18  # registers that __prologue_saves__ pushes, by one instruction of 2 bytes each; Y is lowered by X then


class StackBound:
    """The functions of an .elf: own bytes on the stack, and whom they call."""

    def __init__(self, elf):
        text = subprocess.run([tool("avr-objdump"), "-d", elf], check=True, capture_output=True, text=True).stdout
        self._known, self.names, self.own, self._calls, self._framing, name = {}, {}, {}, {}, None, None
        self._loaded, last = {}, None
        for line in text.splitlines():
            if head := _HEAD.match(line):
                address = int(head[1], 16)
                if last not in _LEAVING and name:
                    self._calls[name].add((address, 0))  # goes on into the next
                name = head[2]
                self.names[address] = name
                self.own[name], self._calls[name] = 0, set()
            elif name and (part := _LINE.match(line)):
                last = part[2]
                self._read(name, part[2], (part[3] or "").replace(" ", "").strip(), part[4] or "")

    def _read(self, name, operation, operands, comment):
        if operation == "push":
            self.own[name] += 1
        elif operation == "in" and operands == "r29,0x3e":
            self._framing = name  # SP is in Y: lowered next, where there are locals on the stack
            return
        elif operation in ("sbiw", "subi") and operands.startswith("r28") and self._framing == name:
            self.own[name] += int(operands.split(",")[1], 0)
        elif operation == "rcall" and operands == ".+0":
            self.own[name] += RETURN  # room for two bytes
        elif operation == "ldi" and operands.startswith(("r26,", "r27,")):
            self._loaded[operands[:3]] = int(operands[4:], 0)
        elif jump := _SAVES.search(comment):
            self.own[name] += SAVED - int(jump[1] or "0", 0) // 2 + self._loaded["r26"] + 256 * self._loaded["r27"]
        elif operation == "icall":
            raise ValueError(f"{name} calls through a pointer")
        elif operation in ("call", "rcall", "jmp", "rjmp"):
            target = int(_TARGET.search(comment)[1], 16)
            self._calls[name].add((target, RETURN if "call" in operation else 0))
        self._framing = None

    def of(self, name, above=()):
        """Bytes that calling a function takes at most, with a chain of calls that does."""
        if name in self._known:
            return self._known[name]
        if name in above:
            raise ValueError(f"{name} calls itself through {above}")
        deepest, chain = 0, ()
        for target, extra in self._calls[name]:
            callee = self.names.get(target)
            if callee is None or callee == name:  # a jump within the function
                deepest = max(deepest, extra)
                continue
            depth, below = self.of(callee, (*above, name))
            if depth + extra > deepest:
                deepest, chain = depth + extra, below
        self._known[name] = self.own[name] + deepest, (name, *chain)
        return self._known[name]

    def image(self, tick="__vector_11", others=("__vector_1", "__vector_18", "__vector_19")):
        """Bytes of the main program, the tick that interrupts it, and one more interrupt in the tick, at their deepest.

        Interrupts other than the tick let nobody in, so there is one at most. The last byte of RAM is the first one used.
        """
        return sum(self.of(name)[0] + RETURN for name in ("main", tick, max(others, key=self.of)))
