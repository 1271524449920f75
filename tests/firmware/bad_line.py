"""Lines that lose what is said: in virtual time around sim://, and a socket with a board at its other end."""

import select
import socket
import threading

from host_driver import settings

from hapticlab.device.board.host_board import HostBoard
from hapticlab.device.link.messages import MESSAGES
from hapticlab.device.link.serial_ports import open_port
from hapticlab.device.link.wire import Decoder


def said(piece):
    """Return the frame in one encoded piece, its end included, or None."""
    frames = Decoder().feed(piece)
    return frames[0] if frames else None


class Lossy:
    """A board whose words, and what is said to it, pass judges: ``heard(frame)`` and ``told(frame)`` keep it if true."""

    def __init__(self, board, heard=lambda frame: True, told=lambda frame: True):
        self._board, self._heard, self._told = board, heard, told

    def __getattr__(self, name):
        return getattr(self._board, name)

    def transmit(self):
        return self._kept(self._board.transmit(), self._heard)

    def receive(self, data):
        self._board.receive(self._kept(data, self._told))

    @staticmethod
    def _kept(data, judge):
        pieces = [piece + b"\0" for piece in data.split(b"\0")[:-1]]
        return b"".join(piece for piece in pieces if judge(said(piece)))


def lossy_port(**judges):
    """Return a port of sim://hapkit, in virtual time, over a line that loses."""
    port = open_port("sim://hapkit")
    port.board = Lossy(port.board, **judges)
    return port


def is_ack(frame, request):
    return frame is not None and frame.message == "ACK" and frame.payload[0] == MESSAGES[request].number


class Peer(threading.Thread):
    """A board behind a socket: it ticks once whenever nothing comes for half a millisecond, and answers at once."""

    def __init__(self, told=lambda frame: True):
        super().__init__(daemon=True)
        self.board = Lossy(HostBoard(settings().to_bytes()), told=told)
        self._server = socket.create_server(("127.0.0.1", 0))
        self.url = f"socket://127.0.0.1:{self._server.getsockname()[1]}"
        self.leave, self.ticks, self.ended = threading.Event(), 0, threading.Event()
        self.start()

    def run(self):
        connection, _ = self._server.accept()
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # as a serial line, it keeps nothing back
        buffered = b""
        with connection, self._server:
            while not self.leave.is_set():
                if select.select([connection], [], [], 0.0005)[0]:
                    try:
                        data = connection.recv(4096)
                    except ConnectionError:
                        break
                    if not data:
                        break
                    whole, zero, buffered = (buffered + data).rpartition(b"\0")
                    self.board.receive(whole + zero)
                else:
                    self.board.tick(0, self.ticks * self.board.period)
                    self.ticks += 1
                try:
                    connection.sendall(self.board.transmit())
                except ConnectionError:
                    break
        while self.board.tick(0, self.ticks * self.board.period):  # the host is gone: until the board has seen it
            self.ticks += 1
        self.ended.set()
