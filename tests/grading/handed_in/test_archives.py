"""Zip files as nobody should hand them in: nothing is unpacked, the others are graded, and their student is told why not."""

import io
import stat
import struct
import warnings
import zipfile

import pytest
from submitted_files import ADA, BOB, fill, handed, notebook, zipped

from hapticlab.grading.handed_in import archives, file_choice


def member(name, content=ADA, **given):
    info = zipfile.ZipInfo(name)
    for attribute, value in given.items():
        setattr(info, attribute, value)
    return info, content


def archive(*members, prefix=b"", comment=b""):
    held = io.BytesIO(prefix)
    held.seek(len(prefix))
    with zipfile.ZipFile(held, "a" if prefix else "w") as made:
        made.comment = comment
        for info, content in members:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of a name that is there twice
                made.writestr(info, content)
    return held.getvalue()


def with_flags(content, flags):
    """A zip file of one member, of which the flags are other ones."""
    changed = bytearray(content)
    for mark, place in ((b"PK\3\4", 6), (b"PK\1\2", 8)):
        struct.pack_into("<H", changed, content.find(mark) + place, flags)
    return bytes(changed)


NOTHING, LINK = "it contains no notebook; there is nothing", "it contains no notebook; there is a link"
HIDDEN = "it contains no notebook; there is {}; a file is hidden by the dot before its name"
INNER = "y.zip is a zip file inside a zip file; hand in the notebook itself"
LINKED = stat.S_IFLNK | 0o777
#: what ada's zip file holds, and the cells or the words that come of it
ZIPS = {
    "a path of 30 000 folders": (archive(member("a/" * 30_000 + "x.ipynb")), "a contains folders nested more than 40 deep"),
    "such a path beside work": (archive(member("x.ipynb"), member("b/" * 30_000 + "y")), "b contains folders nested more "
                                                                                         "than 40"),
    "names that lead elsewhere": (archive(member("../../../etc/x.ipynb")), ("ada",)),
    "an absolute name": (archive(member("/etc/passwd.ipynb")), ("ada",)),
    "a name of dots": (archive(member("../..")), NOTHING),
    "the same name twice": (
        archive(member("x.ipynb"), member("x.ipynb", BOB)), "x.ipynb and x.ipynb are all possible; hand in only one"),
    "the same file twice": (archive(member("x.ipynb"), member("x.ipynb")), ("ada",)),
    "a prefix": (archive(member("x.ipynb"), prefix=b"MZ" + b"\0" * 5000), ("ada",)),
    "a comment with an end": (archive(member("x.ipynb"), comment=b"PK\5\6 and so on"), "it is not a zip file, or it is "
                                                                                       "incomplete"),
    "a locked member": (with_flags(archive(member("x.ipynb")), 1), "x.ipynb: it is locked by a password; hand it in without one"),
    "zip in zip": (zipped({"y.zip": zipped({"x.ipynb": ADA})}), INNER),
    "zip in zip in zip": (zipped({"y.zip": zipped({"z.zip": zipped({"x.ipynb": ADA})})}), INNER),
    "a zip beside the work": (zipped({"y.zip": zipped({"x.ipynb": BOB}), "x.ipynb": ADA}), ("ada",)),
    "folders alone": (archive(member("ada/", b""), member("ada/b/", b"")), NOTHING),
    "a link": (archive(member("x.ipynb", b"/etc/passwd", external_attr=LINKED << 16)), LINK),
    "a link beside the work": (archive(member("x.ipynb"), member("data", b"/etc", external_attr=LINKED << 16)), ("ada",)),
    "what macOS leaves": (zipped({"__MACOSX/ada/._x.ipynb": b"\0", "__MACOSX/x.ipynb": BOB, "ada/x.ipynb": ADA}), ("ada",)),
    "what Windows leaves": (zipped({"desktop.ini": "", "ada/x.ipynb": ADA, "ada/Thumbs.db": ""}), ("ada",)),
    "what Jupyter keeps": (zipped({"x.ipynb": ADA, ".ipynb_checkpoints/x-checkpoint.ipynb": BOB}), ("ada",)),
    "a tar file": (zipped({"x.tgz": b"\x1f\x8b"}), "x.tgz cannot be unpacked here; hand in the notebook itself, or a zip file"),
    "an unusual method": (archive(member("x.ipynb", compress_type=zipfile.ZIP_LZMA)), "compressed in an unusual way"),
    "a name with a NUL": (archive(member("x.ipynb")).replace(b"x.ipynb", b"x\0ipynb"), "it contains no notebook; there is x"),
    "sizes that lie": (
        zipped({"x.ipynb": ADA}).replace(len(ADA).to_bytes(4, "little"), b"\1\0\0\0"), "cannot be read: BadZipFile"),
}  # fmt: skip


@pytest.mark.parametrize("kind", ZIPS)
def test_what_is_wrong_in_a_zip_file_is_told_and_stops_nobody_else(tmp_path, kind):
    content, expected = ZIPS[kind]
    fill(tmp_path / "class", {"ada.zip": content, "bob/y.ipynb": BOB})
    for path in (tmp_path / "class", zipped({"ada.zip": content, "bob/y.ipynb": BOB}, tmp_path / "class.zip")):
        found = handed(path)
        assert found["bob"] == (("bob",), "")
        assert found["ada"] == (expected, "") if isinstance(expected, tuple) else expected in found["ada"][1], found["ada"]


def test_a_zip_file_of_a_class_loses_nobody(tmp_path):
    deep, empty = member("deep/" + "a/" * 1500 + "x.ipynb"), member("empty/", b"")
    away = member("away", b"../secret", external_attr=LINKED << 16)
    others = [member(name) for name in ("..dots.ipynb", "ada/x.ipynb", "t.rar")]
    (tmp_path / "class.zip").write_bytes(archive(deep, empty, away, *others))
    assert handed(tmp_path / "class.zip") == {
        "ada": (("ada",), ""),
        "away": ((), LINK),
        "deep": ((), "deep contains folders nested more than 40 deep; hand in the notebook only"),
        "dots": ((), HIDDEN.format("..dots.ipynb")),
        "empty": ((), NOTHING),
        "t": ((), "t.rar cannot be unpacked here; hand in the notebook itself, or a zip file"),
    }


def test_names_in_zip_files_are_read_as_their_systems_wrote_them(tmp_path):
    by_python = archive(member("Müller/x.ipynb"))
    by_system = {"linux": by_python, "macos": with_flags(by_python, 0),
                 "windows": archive(member("M_ller/x.ipynb")).replace(b"M_ller", b"M\x81ller")}  # fmt: skip
    for name, content in by_system.items():
        (tmp_path / name).write_bytes(content)
        (entry,) = archives.zip_entries(archives.Entry(tmp_path / name, (name,)))
        assert entry.parts == ("Müller", "x.ipynb")
        assert archives.read_entry(entry, 1 << 20) == ADA


@pytest.mark.wide
def test_a_zip_file_of_many_members_is_read(tmp_path):
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as made:  # as zip64, of more members than 16 bits count
        for number in range(66_000):
            made.writestr(zipfile.ZipInfo(f"e/{number}.png"), b"")
        made.writestr("ada/x.ipynb", ADA)
    assert handed(tmp_path / "class.zip")["ada"] == (("ada",), "")


def test_notebooks_that_are_large_together_are_not_all_read(tmp_path, monkeypatch):
    monkeypatch.setattr(file_choice, "MOST_TOGETHER", 1 << 20)
    large = notebook("k = 2", "#" * 400_000)
    fill(tmp_path, {**{f"ada/{number}.ipynb": large for number in range(4)}, "bob/y.ipynb": BOB})
    assert handed(tmp_path)["ada"] == ((), "its notebooks have more than 1 MiB together; hand in only one")
