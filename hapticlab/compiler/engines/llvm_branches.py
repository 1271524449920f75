"""Arms of selects as branches in LLVM's text: what no lane needs is not computed.

The selects stay. Where an arm is skipped its results are poison, which a select does not take from an arm that it does
not choose; so every bit is as it would be without branches.
"""


class Branches:
    """Writes the arranged positions of a block for a :class:`~hapticlab.compiler.engines.llvm_emit.Writer`.

    Parameters
    ----------
    writer : Writer
    block : Block
    demand : Demand
        Of the block.
    names : list of str
        Of the results, by position; an arm that has ended gives its results new ones.
    """

    def __init__(self, writer, block, demand, names):
        self.writer, self.block, self.demand, self.names = writer, block, demand, names
        self.users = [[] for _ in block.instructions]
        for k, needed in enumerate(demand.of):
            for a in demand.before(k) if needed is not None else ():
                self.users[a].append(k)
        self._count = 0

    def lines(self, positions, label):
        """Return the lines that compute these positions, in a basic block called ``label``."""
        return self._written(self.demand.arranged(positions), label, None)[0]

    def _written(self, items, label, mask):
        """Return the lines, and the name of the basic block they end in; ``mask``: the lanes that need them, None if all."""
        lines, together = [], []
        for item in (*items, None):
            if isinstance(item, int):
                together.append(item)
                continue
            lines += self.writer.lines(self.block, self.names, together)
            together = []
            if item:
                more, label = self._arm(item, label, mask)
                lines += more
        return lines, label

    def _arm(self, arm, label, mask):
        self._count += 1
        here = f"arm{self._count}"
        lines, needed, mask = self._needed(arm, f"%{here}", mask)
        lines += [f"br i1 {needed}, label %{here}, label %{here}.end", f"{here}:"]
        inside, last = self._written(arm.items, here, mask)
        lines += [*inside, f"br label %{here}.end", f"{here}.end:"]
        within = arm.positions()
        apart = set(within)
        for k in within:
            if not apart.issuperset(self.users[k]):
                name, after = self.names[k], f"%{here}.{k}"
                type = self.writer.types[self.block.instructions[k].type]
                lines.append(f"{after} = phi {type} [ {name}, %{last} ], [ poison, %{label} ]")
                self.names[k] = after
        return lines, f"{here}.end"

    def _needed(self, arm, name, mask):
        """Return the lines that find whether an arm is needed by any lane, the name of that, and the lanes."""
        writer, lanes = self.writer, self.writer.lanes
        condition, type, true = self.names[arm.condition], writer.types["bool"], writer.const(True, "bool")
        lines = []
        if not arm.chosen:
            lines.append(f"{name}.not = xor {type} {condition}, {true}")
            condition = f"{name}.not"
        if lanes == 1:
            return lines, condition, None
        if mask:
            false = writer.const(False, "bool")  # a lane that does not need the arm around may hold poison here
            lines.append(f"{name}.lanes = select {type} {mask}, {type} {condition}, {type} {false}")
            condition = f"{name}.lanes"
        lines += [
            f"{name}.bits = bitcast {type} {condition} to i{lanes}",
            f"{name}.any = icmp ne i{lanes} {name}.bits, 0",
        ]
        return lines, f"{name}.any", condition
