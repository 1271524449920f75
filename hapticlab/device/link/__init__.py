"""The wire between computer and board: messages, frames, checksums, serial ports.

In: a message. Out: its bytes on the wire, and the answer or a fault that says what to do.
Read ``messages`` (the tables), ``wire`` (COBS and CRC), ``exchange`` (one question, one answer), ``serial_ports`` and
``port_faults``; ``message_headers`` writes the firmware's copy of the tables, ``udev_rules`` what Linux is told of the boards.
"""
