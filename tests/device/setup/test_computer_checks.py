"""What the doctor says of this computer: each system's own way of keeping a port closed."""

import os
import sys

import pytest

from hapticlab.device.link.port_faults import RULES
from hapticlab.device.setup import computer_checks
from hapticlab.device.setup.computer_checks import notebook, rights


def test_macos_is_told_which_of_the_two_names():
    found = rights("/dev/tty.usbmodem101", "darwin")
    assert (found.state, found.cure) == ("fault", "name /dev/cu.usbmodem101 instead")
    assert rights("/dev/cu.usbmodem101", "darwin").state == "ok"


def test_windows_lends_a_port_to_one_program():
    assert "one program at a time" in rights("COM3", "win32").found


@pytest.mark.skipif(sys.platform == "win32", reason="the groups of a POSIX system")
class TestLinux:
    @pytest.fixture
    def student(self, monkeypatch, tmp_path):
        monkeypatch.setattr(os, "geteuid", lambda: 1000)
        monkeypatch.setattr(computer_checks, "UDEV", (str(tmp_path),))
        return tmp_path

    def test_nothing_lets_in(self, student, monkeypatch):
        monkeypatch.setattr(computer_checks, "_groups", lambda: (None, None))
        found = rights(platform="linux")
        assert found.state == "attention" and "udevadm" in found.cure and "usermod" in found.cure

    def test_a_group_that_waits_for_a_login(self, student, monkeypatch):
        monkeypatch.setattr(computer_checks, "_groups", lambda: (None, "dialout"))
        assert "log out" in rights(platform="linux").cure

    def test_the_rules(self, student):
        (student / RULES).touch()
        assert rights(platform="linux").state == "ok"

    def test_the_groups_of_this_login(self, monkeypatch):
        import grp

        rows = [grp.struct_group(("dialout", "x", os.getegid(), [])), grp.struct_group(("uucp", "x", 4_000_000, []))]
        monkeypatch.setattr(grp, "getgrall", lambda: rows)
        assert computer_checks._groups() == ("dialout", None)


def test_what_is_missing_for_notebooks(monkeypatch):
    real = computer_checks.version

    def version(name):
        if name == "anywidget":
            raise computer_checks.PackageNotFoundError(name)
        return real("pytest")

    monkeypatch.setattr(computer_checks, "version", version)
    found = notebook()
    assert found.state == "attention" and found.cure.endswith("-m pip install anywidget")
