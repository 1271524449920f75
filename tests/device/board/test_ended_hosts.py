"""A program that is killed or stopped while its motor pulls: it says nothing more, and the board stops by itself."""

import signal
import subprocess
import sys
import time

import pytest
from bad_line import Peer

from hapticlab.device.link.messages import FAULTS, HOST_SILENCE_MS

PROGRAM = """if True:
    import sys, hapticlab as hl
    f = hl.parameters("f", units="N")
    board = hl.connect(sys.argv[1])
    board.home(at=0.0)
    board.start(hl.Scene(force=f, name="pull")(f=0.4))
    print("pulls", flush=True)
    input()
"""


@pytest.mark.wide
@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="this system stops no process")
@pytest.mark.parametrize("how", ["SIGKILL", "SIGSTOP"])
def test_a_host_that_is_killed_or_stopped_is_a_silent_host(how):
    heard = []
    peer = Peer(told=lambda frame: heard.append(frame and frame.message) or True)
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", PROGRAM, peer.url], **pipes) as host:
        assert host.stdout.readline().strip() == b"pulls"
        try:
            _until(lambda: peer.board.duty != 0)
            host.send_signal(getattr(signal, how))
            _until(lambda: peer.board.duty == 0)
        finally:
            host.kill()
    assert "START" in heard and "STOP" not in heard
    assert peer.board.duty == 0


def _until(happens, seconds=20.0):
    end = time.monotonic() + seconds
    while not happens():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_the_words_of_silence_are_those_of_the_boards_limit():
    assert f"for {HOST_SILENCE_MS} ms" in FAULTS["HOST_SILENT"][1]
