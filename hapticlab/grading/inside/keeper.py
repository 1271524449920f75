"""The keeper: waits for a student's session, takes in its orphans, and tells the grader how the session ended.

In a pid namespace it is process 1: when it ends, the system ends everything in there.
"""

import os
import signal

from . import linux


def keep(session, status):
    """Wait until the session ends, write its signal as one byte (0 for an exit), and end.

    Parameters
    ----------
    session : int
        Process id.
    status : int
        File descriptor that nobody else in the session holds.
    """
    linux.close_all_but(status)
    while True:
        ended, how = os.waitpid(-1, 0)
        if ended == session:
            code = os.waitstatus_to_exitcode(how)
            os.write(status, bytes([max(0, -code)]))
            os._exit(0)


def prepare():
    """Make this process one whose orphans come back to it, and whose memory nobody of its user reads."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    linux.become_subreaper()
    linux.forbid_dumps()
