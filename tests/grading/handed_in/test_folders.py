"""Folders as nobody should hand them in: whatever is in one, the others are graded, and its student is told why not."""

import os
import socket
import stat
import sys
from pathlib import Path

import pytest
from submitted_files import ADA, BOB, LAB, fill, handed, whose, zipped

from hapticlab.errors import CourseError
from hapticlab.grading.handed_in import folders
from hapticlab.grading.handed_in.submission import find_submissions, left_aside, read

POSIX = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no fifos and names no file by bytes")


def nested(folder, names):
    """Make folders inside one another, however long their path gets."""
    folder.mkdir(parents=True)
    place = os.open(folder, os.O_RDONLY)
    for name in names:
        os.mkdir(name, dir_fd=place)
        inner = os.open(name, os.O_RDONLY, dir_fd=place)
        os.close(place)
        place = inner
    with os.fdopen(os.open("x.ipynb", os.O_WRONLY | os.O_CREAT, dir_fd=place), "wb") as file:
        file.write(ADA)
    os.close(place)


def removed(folder):
    """Remove folders inside one another; what pytest clears its own folders with calls itself for each, and would end."""
    place, names = os.open(folder, os.O_RDONLY), []
    while True:
        (inner,) = os.listdir(place)
        if not stat.S_ISDIR(os.lstat(inner, dir_fd=place).st_mode):
            os.unlink(inner, dir_fd=place)
            break
        names.append(inner)
        below = os.open(inner, os.O_RDONLY, dir_fd=place)
        os.close(place)
        place = below
    for name in reversed(names):
        above = os.open("..", os.O_RDONLY, dir_fd=place)
        os.rmdir(name, dir_fd=above)
        os.close(place)
        place = above
    os.close(place)


def link(name, target):
    return lambda folder: (folder / name).symlink_to(target)


def a_socket(folder):
    with socket.socket(socket.AF_UNIX) as one:
        here = Path.cwd()
        os.chdir(folder)  # an address has a hundred bytes at most
        try:
            one.bind("x.ipynb")
        finally:
            os.chdir(here)


NOTHING_THERE = "it contains no notebook; there is nothing"
LINK_THERE = "it contains no notebook; there is a link"
DEEP = "ada contains folders nested more than 40 deep; hand in the notebook only"
HIDDEN = "it contains no notebook; there is {}; a file is hidden by the dot before its name"
#: what is to be found in the folder of ada, and what she is told
FOLDERS = {
    "nothing": (lambda folder: None, NOTHING_THERE),
    "folders alone": (lambda folder: (folder / "a/b").mkdir(parents=True), NOTHING_THERE),
    "a folder called a notebook": (lambda folder: (folder / "x.ipynb").mkdir(), NOTHING_THERE),
    "a link to a folder": (link("work", ".."), LINK_THERE),
    "a link to nowhere": (link("work", "nowhere"), LINK_THERE),
    "links in a circle": (lambda folder: (link("a", "b")(folder), link("b", "a")(folder)), "there is a link, a link"),
    "a link called a notebook": (link("x.ipynb", "x.ipynb"), "there is a link"),
    "a link to another's work": (link("x.ipynb", "../bob/y.ipynb"), "x.ipynb: it is a link; hand in the file itself"),
    "a device": (link("x.ipynb", "/dev/zero"), "there is a link"),
    "a fifo": (lambda folder: os.mkfifo(folder / "x.ipynb"), "x.ipynb: it is not a plain file"),
    "a socket": (a_socket, "x.ipynb cannot be read: No such device or address; hand it in again"),
    "two dots": (lambda folder: fill(folder, {"..x.ipynb": ADA}), HIDDEN.format("..x.ipynb")),
    "a hidden folder": (lambda folder: fill(folder, {".work/x.ipynb": ADA, ".work/y.png": ""}), HIDDEN.format("x.ipynb")),
    "what Jupyter keeps": (lambda folder: fill(folder, {".ipynb_checkpoints/x-checkpoint.ipynb": ADA}), NOTHING_THERE),
    "what systems leave": (lambda folder: fill(folder, {"desktop.ini": "", "Thumbs.db": "", ".DS_Store": ""}), NOTHING_THERE),
    "a sparse notebook of 100 GB": (
        lambda folder: os.truncate(fill(folder, {"x.ipynb": b""}) / "x.ipynb", 100 << 30), "it is larger than 32 MiB"),
    "a tar file": (lambda folder: fill(folder, {"x.tar.gz": b"\x1f\x8b"}), "x.tar.gz cannot be unpacked here"),
    "a document": (lambda folder: fill(folder, {"x.pdf": b"%PDF"}), "it contains no notebook; there is x.pdf"),
}  # fmt: skip


@POSIX
@pytest.mark.parametrize("kind", FOLDERS)
@pytest.mark.parametrize("tree", ["", "submitted/"])
def test_what_is_wrong_in_a_folder_is_told_and_stops_nobody_else(tmp_path, kind, tree):
    make, words = FOLDERS[kind]
    fill(tmp_path / "class", {f"{tree}bob/y.ipynb": BOB, f"{tree}cy/{LAB}.ipynb": ADA})
    folder = tmp_path / "class" / tree / "ada"
    folder.mkdir()
    make(folder)
    found = handed(tmp_path / "class")
    cells, problem = found.pop("ada")
    assert cells == () and words in problem
    assert found == {"bob": (("bob",), ""), "cy": (("ada",), "")}
    assert not left_aside([tmp_path / "class"], LAB)


@POSIX
@pytest.mark.parametrize("tree", ["", "submitted/"])
@pytest.mark.parametrize("work", [{}, {"ada/x.ipynb": ADA}], ids=["alone", "beside work"])
@pytest.mark.parametrize(("names", "words"), [(["a"] * 1500, DEEP), (["b" * 250] * 20, "cannot be read: File name too long")])
@pytest.mark.always("*-alone-")
def test_folders_however_deep_stop_nobody_else(tmp_path, tree, work, names, words):
    fill(tmp_path / "class" / tree, {"bob/y.ipynb": BOB, **work})
    nested(tmp_path / "class" / tree / "ada" / "a", names)
    try:
        found = handed(tmp_path / "class")
    finally:
        removed(tmp_path / "class" / tree / "ada" / "a")
    assert found["bob"] == (("bob",), "")
    assert found["ada"][0] == () and words in found["ada"][1]


#: what lies in the class's own folder, beside bob's, whose it is and what is told
BESIDE = {
    "an empty folder": (lambda folder: (folder / "ada").mkdir(), "ada", NOTHING_THERE),
    "an empty folder called a notebook": (lambda folder: (folder / "ada.ipynb").mkdir(), "ada", NOTHING_THERE),
    "a folder called a notebook": (lambda folder: fill(folder, {"ada.ipynb/x.ipynb": ADA}), "ada", ""),
    "a link to a folder": (link("ada", "bob"), "ada", LINK_THERE),
    "a link to nowhere": (link("ada", "nowhere"), "ada", LINK_THERE),
    "a link to a file": (link("ada.ipynb", "bob/y.ipynb"), "ada", "ada.ipynb: it is a link"),
    "two dots": (lambda folder: fill(folder, {"..ada.ipynb": ADA}), "ada", HIDDEN.format("..ada.ipynb")),
    "a hidden folder": (lambda folder: fill(folder, {".ada/x.ipynb": ADA}), "ada", HIDDEN.format("x.ipynb")),
    "underscores": (lambda folder: fill(folder, {"__ada__/x.ipynb": ADA}), "ada", ""),
    "a 7z file": (lambda folder: fill(folder, {"ada.7z": b"7z"}), "ada", "ada.7z cannot be unpacked here"),
    "a rar file": (lambda folder: fill(folder, {"ada.RAR": b"Rar!"}), "ada", "ada.RAR cannot be unpacked here"),
    "a tar file": (lambda folder: fill(folder, {"ada.tar.gz": b""}), "ada", "ada.tar.gz cannot be unpacked here"),
    "a document": (lambda folder: fill(folder, {"ada.docx": b"PK"}), "ada", "there is ada.docx"),
    "what a browser added": (lambda folder: fill(folder, {"ada.ipynb.txt": ADA}), "ada", ""),
    "a document beside the work": (lambda folder: fill(folder, {"ada.pdf": b"%PDF", "ada.ipynb": ADA}), "ada", ""),
    "capitals beside small letters": (lambda folder: fill(folder, {"BOB/x.ipynb": ADA}), "BOB", ""),
}  # fmt: skip


@POSIX
@pytest.mark.parametrize("kind", BESIDE)
def test_what_lies_in_the_class_folder_is_somebodys(tmp_path, kind):
    make, whom, words = BESIDE[kind]
    make(fill(tmp_path / "class", {"bob/y.ipynb": BOB, "cy.py": "cy", "grades.csv": ""}) / "bob" / "..")
    found = handed(tmp_path / "class")
    cells, problem = found.pop(whom)
    assert (words in problem and cells == ()) if words else (cells, problem) == (("ada",), "")
    assert found == {"bob": (("bob",), ""), "cy": (("cy",), "")}
    assert left_aside([tmp_path / "class"], LAB) == ["ada.pdf"] * (kind == "a document beside the work") + ["grades.csv"]


def test_what_holds_no_work_takes_nothing_from_a_student_who_has_some(tmp_path):
    (tmp_path / "ada").mkdir()
    fill(tmp_path, {"ada.ipynb": ADA, ".bob/y.ipynb": ADA, "bob.py": "bob", "bob.pdf": "%PDF", "cy/a.txt": "", "notes.md": ""})
    found = handed(tmp_path)
    assert found == {"ada": (("ada",), ""), "bob": (("bob",), ""), "cy": ((), "it contains no notebook; there is a.txt")}
    assert left_aside([tmp_path], LAB) == ["bob.pdf", "notes.md", ".bob/y.ipynb", "ada/nothing"]


@POSIX
def test_names_that_are_no_text_are_students(tmp_path):
    if sys.platform == "darwin":
        pytest.skip("names there are Unicode")
    for name in (b"Zo\xeb", b"\xff\xfe", b"Zo\xeb\x00"[:3] + b"\xea"):
        os.makedirs(os.path.join(os.fsencode(tmp_path), b"class", name))
        with open(os.path.join(os.fsencode(tmp_path), b"class", name, b"\xe4.ipynb"), "wb") as file:
            file.write(ADA)
    fill(tmp_path / "class", {"bob.py": "bob"})
    found = handed(tmp_path / "class")
    assert len(found) == 4 and found["bob"] == (("bob",), "")
    assert all(student.encode() and (cells or problem) for student, (cells, problem) in found.items())


@pytest.mark.parametrize("whose_folder", ["ada", "submitted/ada"])
def test_a_folder_that_may_not_be_read_is_told(tmp_path, monkeypatch, whose_folder):
    fill(tmp_path, {f"{whose_folder}/x.ipynb": ADA, f"{whose_folder}/more/y.ipynb": ADA, f"{whose_folder}/../bob/y.ipynb": BOB})
    listed = os.scandir

    def scandir(place):
        if Path(place).name == "more":
            raise PermissionError(13, "Permission denied", str(place))
        return listed(place)

    monkeypatch.setattr(os, "scandir", scandir)
    found = handed(tmp_path)
    assert found["bob"] == (("bob",), "")
    words = "cannot be read: Permission denied; change its permissions, or ask for the notebook again"
    assert found["ada"][1] == f"{whose_folder}/more {words}"
    with pytest.raises(CourseError, match="cannot be read: Permission denied"):
        find_submissions([tmp_path / whose_folder / "more"], LAB)


def test_more_folders_than_any_student_has_are_told(tmp_path, monkeypatch):
    monkeypatch.setattr(folders, "MOST_OF_ONE", 30)
    for number in range(40):
        (tmp_path / f"eve/.{number}/.{number}").mkdir(parents=True)
    fill(tmp_path, {"bob/y.ipynb": BOB})
    assert handed(tmp_path) == {"bob": (("bob",), ""), "eve": ((), "eve contains more than 30 files; hand in the notebook only")}


def test_files_of_many_students_are_not_added_up(tmp_path, monkeypatch):
    monkeypatch.setattr(folders, "MOST_FILES", 10)
    fill(tmp_path, {f"s{number}/{name}": ADA for number in range(9) for name in ("x.ipynb", "y.png", "z.png")})
    assert len(whose(tmp_path)) == 9


def test_a_file_that_goes_or_changes_between_is_a_problem_or_read_as_it_is(tmp_path):
    fill(tmp_path, {"ada.ipynb": ADA, "bob.ipynb": BOB, "cy.zip": zipped({"x.ipynb": ADA}), "dan.ipynb": ADA})
    sources = {source.student: source for source in find_submissions([tmp_path], LAB)}
    (tmp_path / "ada.ipynb").unlink()
    (tmp_path / "bob.ipynb").write_bytes(ADA)
    (tmp_path / "cy.zip").write_bytes(zipped({}))
    (tmp_path / "dan.ipynb").unlink()
    (tmp_path / "dan.ipynb").mkdir()
    found = {student: read(source) for student, source in sources.items()}
    assert found["ada"].problem == "ada.ipynb cannot be read: No such file or directory; hand it in again"
    assert found["bob"].cells == ("ada",)
    assert found["cy"].problem == "it contains no notebook; there is nothing"
    assert found["dan"].problem.startswith("dan.ipynb")


@POSIX
def test_a_link_among_several_paths_is_a_students_and_alone_it_is_followed(tmp_path):
    fill(tmp_path, {"class/bob.ipynb": BOB, "answers/solved.ipynb": ADA})
    (tmp_path / "class/eve.ipynb").symlink_to(tmp_path / "answers/solved.ipynb")
    (tmp_path / "class/mal").symlink_to(tmp_path / "answers")
    (tmp_path / "class/zed").symlink_to(tmp_path / "nowhere")
    found = handed(*sorted((tmp_path / "class").iterdir()))
    assert found.pop("bob") == (("bob",), "")
    assert found == dict.fromkeys(("eve", "mal", "zed"), ((), LINK_THERE))
    (tmp_path / "link").symlink_to(tmp_path / "class")
    assert handed(tmp_path / "link")["bob"] == (("bob",), "")


@POSIX
def test_no_file_stays_open(tmp_path):
    if not Path("/proc/self/fd").is_dir():
        pytest.skip("this system does not list open files")
    fill(tmp_path, {"ada.ipynb": ADA, "bob/x.zip": zipped({"x.ipynb": BOB}), "cy.zip": b"PK\3\4", "dan.ipynb": b"{"})
    zipped({"a/x.zip": zipped({"x.ipynb": BOB}), "b.ipynb": b"["}, tmp_path / "class.zip")
    handed(tmp_path), handed(tmp_path / "class.zip")
    held = [os.readlink(one) for one in Path("/proc/self/fd").iterdir() if one.is_symlink()]
    assert not [path for path in held if path.startswith(str(tmp_path))]
