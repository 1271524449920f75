"""Write firmware/udev: the rules by which Linux lets a user open the boards, from the boards' records.

Run ``python -m hapticlab.device.link.udev_rules`` after changing the records; a test proves the committed file fresh.
"""

from ...compiler.boards.board_records import BOARDS
from .port_faults import rules_file

HEAD = """\
# Lets the user at the screen open the boards of a paddle, and keeps ModemManager from talking to them.
# Install: sudo cp 60-hapticlab.rules /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger
# Written by hapticlab/device/link/udev_rules.py: change hapticlab/compiler/boards/board_records.py, not this file.
ACTION=="remove", GOTO="hapticlab_end"
SUBSYSTEM!="usb|tty", GOTO="hapticlab_end"
"""
TAIL = """\
# the USB device and its port: ModemManager looks at both
ENV{ID_HAPTICLAB}=="1", ENV{ID_MM_DEVICE_IGNORE}="1"
SUBSYSTEM=="tty", ENV{ID_HAPTICLAB}=="1", MODE="0660", TAG+="uaccess"

LABEL="hapticlab_end"
"""


def rules():
    """Return the text of the rules: all USB devices by which a board is known."""
    return "\n".join([HEAD, "".join(_rule(usb) for board in BOARDS.values() for usb in board.usb), TAIL])


def _rule(usb):
    numbers = f'ATTRS{{idVendor}}=="{usb.vendor:04x}", ATTRS{{idProduct}}=="{usb.product:04x}"'
    return f'# {usb.words}\n{numbers}, ENV{{ID_HAPTICLAB}}="1"\n'


if __name__ == "__main__":
    rules_file().write_text(rules())
