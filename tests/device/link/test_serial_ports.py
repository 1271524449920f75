"""Ports that fail as ports do: a pseudo-terminal, a lock, a missing permission and a closed socket are real here.

Windows and macOS are not: what their drivers say is a table of pyserial's messages, from its bug reports.
"""

import multiprocessing
import os
import pickle
import re
import socket
from pathlib import Path

import pytest
import serial
from serial.tools.list_ports_common import ListPortInfo

from hapticlab.device.link import port_faults
from hapticlab.device.link.port_faults import explain, permission_cure, rules_file
from hapticlab.device.link.serial_ports import KNOWN, Port, available_ports, open_port, port_watched, read_available
from hapticlab.device.link.udev_rules import rules
from hapticlab.errors import PortError

NOBODY = 65534


@pytest.fixture
def line():
    """A pseudo-terminal: our end's number, and the name of the other, which is the port."""
    if not hasattr(os, "openpty"):
        pytest.skip("this system has no pseudo-terminals")
    ours, theirs = os.openpty()
    open_numbers = {ours, theirs}
    yield ours, os.ttyname(theirs), open_numbers
    for number in open_numbers:
        os.close(number)


def refused(url, **settings):
    with pytest.raises(PortError) as caught:
        open_port(url, **settings).close()
    return caught.value.cause, str(caught.value)


def received(port, count):
    """Read so many bytes, which may come in pieces."""
    port.timeout, came = 5, b""
    while len(came) < count and (piece := read_available(port)):
        came += piece
    return came


def test_bytes_pass_both_ways(line):
    ours, name, _ = line
    with open_port(name, timeout=0) as port:
        assert read_available(port) == b""
        os.write(ours, bytes(range(256)))
        assert received(port, 256) == bytes(range(256))
        port.write(b"\x00\r\n\x11\x13\xff")
        assert os.read(ours, 99) == b"\x00\r\n\x11\x13\xff"
        assert (port.baudrate, port.exclusive) == (500000, True)


def test_the_first_byte_wakes_the_reader():
    """One byte is asked for where none waits, and no more than wait: a reader never sits out its timeout over data."""

    class Recorder:
        is_open, in_waiting, asked = True, 0, ()

        def read(self, size):
            self.asked += (size,)
            return b"x" * size

    port = Recorder()
    read_available(port)
    port.in_waiting = 37
    assert read_available(port) == b"x" * 37
    assert port.asked == (1, 37)


def test_a_socket_is_a_port():
    with socket.create_server(("127.0.0.1", 0)) as server:
        with open_port(f"socket://127.0.0.1:{server.getsockname()[1]}", timeout=5) as port:
            peer, _ = server.accept()
            with peer:
                peer.sendall(b"hello")
                assert received(port, 5) == b"hello"
        address = f"socket://127.0.0.1:{server.getsockname()[1]}"
    cause, words = refused(address)
    assert cause == "refused" and address in words and "check the address" in words


def test_missing_port_lists_those_there_are(monkeypatch):
    monkeypatch.setattr("serial.tools.list_ports.comports", lambda: [usb("/dev/ttyACM7", 0x2341, 0x0043)])
    cause, words = refused("/dev/ttyNONE")
    assert cause == "missing" and "there are: /dev/ttyACM7 (Arduino Uno R3)" in words
    monkeypatch.setattr("serial.tools.list_ports.comports", list)
    assert "there is none. Plug in the board" in refused("/dev/ttyNONE")[1]


@pytest.mark.parametrize("path", ["/dev/null", __file__, str(Path(__file__).parent)])
def test_what_is_no_port(path):
    cause, words = refused(path)
    assert cause == "missing" and "not a serial port" in words and path in words


@pytest.mark.parametrize("url", ["socket://127.0.0.1:{}", "SOCKET://127.0.0.1:{}"])
def test_while_grading_only_simulated_paddles_open(monkeypatch, url):
    with socket.create_server(("127.0.0.1", 0)) as listening:
        url = url.format(listening.getsockname()[1])
        open_port(url).close()
        monkeypatch.setenv("HAPTICLAB_PORTS", "sim")
        cause, text = refused(url)
        assert cause == "refused"
        assert url in text
        assert "HAPTICLAB_PORTS=sim" in text
        opened = open_port("sim://hapkit")
        opened.close()


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("smi://hapkit", "the scheme 'smi' is not known.*sim://hapkit"),
        ("socket://localhost", "not the address of a port.*socket://host:port"),
        ("socket://localhost:99999", "not the address of a port.*socket://host:port"),
        ("socket://localhost:abc", "not the address of a port.*socket://host:port"),
    ],
)
def test_a_bad_address(url, words):
    cause, said = refused(url)
    assert cause == "url" and re.search(words, said) and said.startswith(url)


def test_a_rate_the_port_cannot(line):
    cause, words = refused(line[1], baudrate=-1)
    assert cause == "settings" and "-1 baud" in words


def elsewhere(work, *arguments, user=None):
    """Do work in another process, as another user if asked, and return what it returns."""

    def child(sender):
        if user is not None and os.getuid() == 0:
            os.setgroups([])
            os.setgid(user)
            os.setuid(user)
        sender.send(work(*arguments))

    available_ports()  # imports pyserial while its files may be read
    receiver, sender = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.get_context("fork").Process(target=child, args=(sender,))
    process.start()
    sender.close()
    try:
        return receiver.recv()
    finally:
        process.join()


def test_a_port_open_elsewhere_names_who_has_it(line):
    name = line[1]
    with open_port(name):
        cause, words = elsewhere(refused, name)
        assert cause == "busy" and f"(process {os.getpid()})" in words and "ModemManager" in words
        cause, words = refused(name)
        assert cause == "busy" and "in use by this very program" in words
    open_port(name).close()  # free again


def test_a_port_another_program_has_for_itself(line):
    """TIOCEXCL, as many terminal programs set it: the kernel refuses every other user but root."""
    import fcntl
    import termios

    _, name, numbers = line
    fcntl.ioctl(max(numbers), termios.TIOCEXCL)
    os.chmod(name, 0o666)
    assert elsewhere(refused, name, user=NOBODY)[0] == "busy"


def test_a_port_without_permission(line, monkeypatch):
    rules = rules_file()
    monkeypatch.setattr(port_faults, "rules_file", lambda: rules)  # the checkout may be closed to that user too
    os.chmod(line[1], 0)
    cause, words = elsewhere(refused, line[1], user=NOBODY)
    assert cause == "permission"
    assert f"sudo cp {rules} /etc/udev/rules.d/" in words and re.search("usermod -aG (dialout|uucp) ", words)


def test_the_device_leaves(line):
    _, name, numbers = line
    port = open_port(name)
    while numbers:
        os.close(numbers.pop())
    for use in (read_available, lambda p: watched_write(p, b"x")):
        with pytest.raises(PortError, match=f"{name}: the device disconnected.*plug it in again") as caught:
            use(port)
        assert caught.value.cause == "left"
    port.close()
    with pytest.raises(PortError, match="is closed; connect again"):
        read_available(port)


def watched_write(port, data):
    with port_watched(port):
        port.write(data)


def test_a_device_that_takes_nothing(line):
    with open_port(line[1]) as port:
        port.write_timeout = 0.01
        with pytest.raises(PortError, match="the device accepted no data for 0.01 s; plug it in again") as caught:
            watched_write(port, bytes(1 << 20))
        assert caught.value.cause == "silent"
        port.reset_output_buffer()


def test_a_mistake_of_ours_is_no_fault_of_the_port(line):
    with open_port(line[1]) as port, pytest.raises(TypeError), port_watched(port):
        port.write(object())


OPEN, SET = "could not open port 'COM3': ", "Cannot configure port, something went wrong. Original message: "


@pytest.mark.parametrize(
    ("text", "cause", "words"),
    [
        (OPEN + "FileNotFoundError(2, 'The system cannot find the file specified.', None, 2)", "missing", "no such port"),
        (OPEN + "FileNotFoundError(2, 'Das System kann die Datei nicht finden.', None, 2)", "missing", "no such port"),
        (OPEN + "PermissionError(13, 'Access is denied.', None, 5)", "busy", "another program"),
        (OPEN + "PermissionError(13, 'Zugriff verweigert', None, 5)", "busy", "Arduino IDE"),
        (OPEN + "OSError(22, 'The semaphore timeout period has expired.', None, 121)", "missing", "plug it in again"),
        (SET + "PermissionError(13, 'A device is not functioning.', None, 31)", "missing", "plug it in again"),
        (SET + "OSError(22, 'The parameter is incorrect.', None, 87)", "failed", "plug in the board again"),
    ],
)
def test_what_windows_says(text, cause, words):
    said, why = explain("COM3", 500000, serial.SerialException(text), [])
    assert why == cause and words in said and said.startswith("COM3")


@pytest.mark.parametrize(
    ("number", "text", "cause"), [(16, "Resource busy", "busy"), (13, "Permission denied", "permission"), (6, "x", "missing")]
)
def test_what_macos_says(number, text, cause):
    problem = serial.SerialException(number, f"could not open port /dev/cu.usbmodem1: [Errno {number}] {text}")
    assert explain("/dev/cu.usbmodem1", 500000, problem, [])[1] == cause


def test_windows_says_that_the_device_left():
    class Gone:
        port, is_open, read = "COM3", True, None

        @property
        def in_waiting(self):
            raise serial.SerialException("ClearCommError failed (PermissionError(13, 'Access is denied.', None, 5))")

    with pytest.raises(PortError, match=r"COM3: the device disconnected during use \(ClearCommError failed"):
        read_available(Gone())


def test_cures_elsewhere(monkeypatch):
    monkeypatch.setattr("sys.platform", "darwin")
    assert "usermod" not in permission_cure() and "driver" in permission_cure()


def usb(device, vid, pid, description="n/a"):
    info = ListPortInfo(device)
    info.vid, info.pid, info.serial_number, info.description = vid, pid, "55739", description
    return info


def test_ports_are_listed_by_what_they_are(monkeypatch):
    there = [usb("COM10", 0x1A86, 0x7523), usb("COM9", 0x2341, 0x0043, "Arduino Uno"), usb("COM1", 0x04D8, 0x000A, "CNC")]
    monkeypatch.setattr("serial.tools.list_ports.comports", lambda: there)
    first, second, third = available_ports()
    assert (first.device, first.known, first.vid, str(first)) == ("COM1", None, 0x04D8, "COM1 (CNC)")
    assert second == Port("COM9", "Arduino Uno", 0x2341, 0x0043, "55739", "Arduino Uno R3")
    assert third.device == "COM10" and third.known.startswith("CH340") and third.description == ""
    assert hash(second) and pickle.loads(pickle.dumps(second)) == second


def test_the_udev_rules_are_for_the_same_boards():
    text = rules_file().read_text()
    assert text == rules(), "run python -m hapticlab.device.link.udev_rules"
    pairs = re.findall(r'idVendor}=="(\w+)", ATTRS{idProduct}=="(\w+)", ENV{ID_HAPTICLAB}="1"', text)
    assert {(int(vendor, 16), int(product, 16)) for vendor, product in pairs} == set(KNOWN)
    assert 'TAG+="uaccess"' in text and 'ENV{ID_MM_DEVICE_IGNORE}="1"' in text
    assert int(rules_file().name[:2]) < 73  # systemd's 73-seat-late.rules gives access to what is tagged before it


def test_a_port_error_keeps_its_cause_when_it_travels():
    error = pickle.loads(pickle.dumps(PortError("COM3 is taken", "busy")))
    assert (str(error), error.cause) == ("COM3 is taken", "busy")


@pytest.mark.parametrize("url", ["", 5, b"COM3", None])
def test_what_is_no_address(url):
    with pytest.raises(PortError, match="is not a port; needs its name or address as text:"):
        open_port(url)
