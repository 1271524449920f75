"""What the link takes of a board's time while a program runs: interrupts in the step, work between the steps.

A byte of the link interrupts a step wherever it comes, so a step is as long as all that can come in one period. The line
limits that, 50 bytes a millisecond each way, and so does what there is to say: one request is under way at a time, since the
computer waits for the answer.
"""

from dataclasses import dataclass

#: 500000 baud
BYTES_PER_SECOND = 50_000
#: samples that wait on the board, where they would be lost the next time; HL_RING - 1
WAITING_SAMPLES = 3
#: requests a second, SET and the heartbeat together, that leave all samples their time
REQUESTS_PER_SECOND = 100
#: ticks after which the motor's heat is followed between steps, firmware/core/motor.c
HEAT_TICKS = 16
#: largest frames [bytes]: what SET has beside 5 for each value, STATUS, ACK; and the board's buffer of bytes to send
SET_OVERHEAD, STATUS_BYTES, ACK_BYTES, SEND_BUFFER = 11, 6, 12, 128
#: values in one SET
MOST_SET = 8


@dataclass(frozen=True)
class Traffic:
    """What is said while a program runs, and the cycles that it takes.

    Attributes
    ----------
    sample, every : int
        Bytes of a sample's frame, ticks from one to the next.
    parameters : int
        Values in the largest SET.
    sent_byte, received_byte : int
        Cycles of an interrupt.
    frame : float
        Cycles between steps to send a sample.
    answer : float
        Cycles between steps to answer a request, at most.
    heat : float
        Cycles between steps to follow the motor's heat, at most, once in :data:`HEAT_TICKS` ticks.
    """

    sample: int = 0
    every: int = 1
    parameters: int = 0
    sent_byte: int = 0
    received_byte: int = 0
    frame: float = 0
    answer: float = 0
    heat: float = 0

    @classmethod
    def of(cls, table, *, channels, parameters, every):
        """Return that of a board's table in costs.json."""
        sample = table["sample_bytes"] + 4 * channels
        several = min(parameters, MOST_SET)
        answers = table["answers"]
        answer = max(answers["STATUS"][0], answers["SET"][0] + answers["SET"][1] * several)
        frame = table["frame"][0] + table["frame"][1] * sample
        return cls(sample, every, several, table["sent_byte"], table["received_byte"], frame, answer, table.get("heat", 0))

    @property
    def set_bytes(self):
        """Of the largest SET; 0 where there is nothing to set."""
        return SET_OVERHEAD + 5 * self.parameters if self.parameters else 0

    @property
    def telemetry(self):
        """Cycles to send one sample: between steps, and its interrupts wherever they fall."""
        return self.frame + self.sent_byte * self.sample

    @property
    def request(self):
        """Cycles to take in a request and to answer it."""
        return self.answer + self.received_byte * max(self.set_bytes, STATUS_BYTES) + self.sent_byte * ACK_BYTES

    def interrupts(self, T, first=0, late=0):
        """Return the most cycles that the link takes of a step in one period T [s]: in the ``first`` tick that, but no sample.

        A SET comes whole where the period is long enough, and a heartbeat with it an answer later. Or a request holds the
        step off by ``late`` while it is obeyed: its answer is still to be sent, and until then the computer asks nothing.
        What is sent is in the buffer when the step begins: nothing is added in a step.
        """
        line = T * BYTES_PER_SECOND
        received = min(line, max(self.set_bytes, STATUS_BYTES))
        if self.set_bytes:
            received += min(max(line - self.set_bytes - ACK_BYTES, 0), STATUS_BYTES)
        sent = self.sent_byte * min(line, SEND_BUFFER)
        return max(self.received_byte * received, late) + max(sent, first + self.sent_byte * min(line, ACK_BYTES))

    def usual_interrupts(self, T, late):
        """Return the cycles where one request comes in a period, or holds the step off by ``late``, while a sample is sent."""
        line = T * BYTES_PER_SECOND
        received = self.received_byte * min(line, max(self.set_bytes, STATUS_BYTES))
        return max(received, late) + self.sent_byte * min(line, self.sample)

    def leaves_room(self, free, T):
        """Whether no sample is lost where a tick leaves so many cycles: on average, and while a request is answered."""
        average = self.telemetry + self.every * (T * REQUESTS_PER_SECOND * self.request + self.heat / HEAT_TICKS)
        while_answered = WAITING_SAMPLES * (self.every * free - self.sent_byte * self.sample)
        return self.every * free >= average and while_answered >= self.request + self.frame + self.heat
