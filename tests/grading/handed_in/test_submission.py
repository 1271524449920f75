"""Submissions as classes hand them in, and as nobody should: real files, links, fifos and zip files."""

import hashlib
import io
import json
import os
import stat
import struct
import sys
import zipfile

import pytest
from submitted_files import ADA, BOB, LAB, fill, handed, notebook, whose, zipped

from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of
from hapticlab.course.notebook import read as read_notebook
from hapticlab.errors import CourseError
from hapticlab.grading.handed_in import folders
from hapticlab.grading.handed_in.naming import is_lab
from hapticlab.grading.handed_in.submission import find_submissions, lab_of, read
from hapticlab.grading.inside.cells import run_cell
from hapticlab.grading.inside.source_lines import statements


@pytest.mark.parametrize("packed", [False, True], ids=["folder", "zip"])
@pytest.mark.parametrize(
    ("files", "expected"),
    [
        ({"ada.ipynb": ADA, "bob.ipynb": BOB, "roster.csv": "x"}, {"ada": "ada", "bob": "bob"}),
        ({"ada.ipynb": ADA, "bob.py": "bob"}, {"ada": "ada", "bob": "bob"}),
        ({"ada/x.ipynb": ADA, "bob/y.ipynb": BOB, "bob/data.csv": "1"}, {"ada": "ada", "bob": "bob"}),
        ({"ada/x.ipynb": ADA, "bob.ipynb": BOB}, {"ada": "ada", "bob": "bob"}),
        ({f"{LAB}_ada.ipynb": ADA, f"bob-{LAB}.ipynb": BOB}, {"ada": "ada", "bob": "bob"}),
        ({f"ada/{LAB}/{LAB}.ipynb": ADA, f"bob/{LAB}/{LAB}.ipynb": BOB}, {"ada": "ada", "bob": "bob"}),
        ({f"submitted/ada/{LAB}/w.ipynb": ADA, f"submitted/bob/{LAB}/w.ipynb": BOB}, {"ada": "ada", "bob": "bob"}),
        (
            {f"submitted/ada/{LAB}/{LAB}.ipynb": ADA, f"source/{LAB}/{LAB}.ipynb": BOB, "gradebook.db": "x"},
            {"ada": "ada"},
        ),
        (
            {"Ada L_12_assignsubmission_file_/x.ipynb": ADA, "Bob_13_assignsubmission_file_/sub/y.ipynb": BOB,
             "Ada L_12_assignsubmission_onlinetext_/onlinetext.html": "<p>hello"},
            {"Ada L_12": "ada", "Bob_13": "bob"},
        ),
        ({"01_ada/x.ipynb": ADA, "02_bob/x.ipynb": BOB}, {"01_ada": "ada", "02_bob": "bob"}),
        ({"Ada L_12_assignsubmission_file_/x.ipynb": ADA}, {"Ada L_12": "ada"}),
        (
            {"lovelaceada_12_345_x-1.ipynb": ADA, "lovelaceada_12_346_data.csv": "", "bobb_LATE_9_8_y.py": "bob"},
            {"lovelaceada_12": "ada", "bobb_9": "bob"},
        ),
        ({"anon_x7Qa_345_x.ipynb": ADA, "anon_x7Qa_346_x.png": "", "LATE_anon_b2Cd_8_y.py": "bob"},
         {"anon_x7Qa": "ada", "anon_b2Cd": "bob"}),
        ({"Red team_17_assignsubmission_file/x.ipynb": ADA, "Default group_assignsubmission_file/y.ipynb": BOB},
         {"Red team_17": "ada", "Default group": "bob"}),
        ({"export/submission_77/x.ipynb": ADA, "export/submission_metadata.yml": "x"}, {"submission_77": "ada"}),
        ({"ada.zip": zipped({"x.ipynb": ADA}), "bob.zip": zipped({"deep/er/y.py": "bob"})}, {"ada": "ada", "bob": "bob"}),
        ({"ada/w.zip": zipped({f"{LAB}.ipynb": ADA, "x.png": "1"}), "bob/y.py": "bob"}, {"ada": "ada", "bob": "bob"}),
        ({"ada/x.ipynb": ADA, "ada/.ipynb_checkpoints/x-checkpoint.ipynb": BOB, "bob/b.py": "bob"}, {"ada": "ada", "bob": "bob"}),
        (
            {"ada/x.ipynb": ADA, "__MACOSX/ada/._x.ipynb": BOB, "bob/b.py": "bob", "bob/checks.py": "1"},
            {"ada": "ada", "bob": "bob"},
        ),
        ({"ada/x.ipynb.txt": ADA, "bob/y.IPYNB": BOB}, {"ada": "ada", "bob": "bob"}),
        ({"ada/01_motion_to_force.ipynb": BOB, f"ada/{LAB}.ipynb": ADA, "bob/b.py": "bob"}, {"ada": "ada", "bob": "bob"}),
        ({f"ada/{LAB}.ipynb": ADA, f"ada/old/{LAB}.ipynb": BOB, "bob/b.py": "bob"}, {"ada": "ada", "bob": "bob"}),
        (
            {"ada/a.ipynb": notebook("ada", "hl.check('02.k', k)"), "ada/b.ipynb": notebook("x", "hl.check('01.k', k)"),
             "bob.py": "bob"},
            {"ada": "ada", "bob": "bob"},
        ),
        ({"ada/a.ipynb": ADA, "ada/b.ipynb": ADA, "bob/b.py": "bob"}, {"ada": "ada", "bob": "bob"}),
    ],
)  # fmt: skip
def test_a_class_is_found(tmp_path, files, expected, packed):
    path = zipped(files, tmp_path / "class.zip") if packed else fill(tmp_path / "class", files)
    assert whose(path) == expected


@pytest.mark.parametrize(
    ("files", "named"),
    [
        ({f"{LAB}.ipynb": ADA, "figures/a.png": "b", "checks.py": "x"}, "ada"),
        ({f"{LAB} (1).ipynb": ADA, "01_motion_to_force.ipynb": BOB}, "ada"),
        ({f"{LAB}/{LAB}.ipynb": ADA, f"{LAB}/checks.py": "x"}, "ada"),
        ({"01_motion_to_force/01_motion_to_force.ipynb": BOB, f"{LAB}/{LAB}.ipynb": ADA}, "ada"),
    ],
)
def test_the_folder_of_one_student_is_named_after_it(tmp_path, files, named):
    assert whose(fill(tmp_path / "grace", files)) == {"grace": named}
    assert whose(zipped(files, tmp_path / "grace.zip")) == {"grace": named}


@pytest.mark.parametrize("name", ["x.ipynb", "x.py", f"x-{LAB}.ipynb"])
def test_a_file_alone_is_named_by_itself_in_a_folder_and_by_its_students_zip_or_folder(tmp_path, name):
    content = "ada" if name.endswith("py") else ADA
    assert whose(fill(tmp_path / "class", {name: content, "roster.csv": "x"})) == {"x": "ada"}
    assert whose(zipped({name: content}, tmp_path / "grace.zip")) == {"grace": "ada"}
    assert whose(fill(tmp_path / "school", {f"grace/{name}": content})) == {"grace": "ada"}
    fill(tmp_path / "two", {f"grace/{name}": content, "bob/y.ipynb": BOB})
    assert whose(*(tmp_path / "two").iterdir()) == {"grace": "ada", "bob": "bob"}


@pytest.mark.parametrize("packed", [False, True], ids=["folder", "zip"])
@pytest.mark.parametrize("name", [f"{LAB}.ipynb", f"{LAB} (1).ipynb", f"{LAB}/x.ipynb", f"{LAB}.zip"])
def test_work_under_the_labs_own_name_takes_no_marks_of_others(tmp_path, name, packed):
    eve = zipped({"x.ipynb": ADA}) if name.endswith("zip") else ADA
    files = {"ada.py": "ada", "bob/x.ipynb": BOB, "carl_1_2_x.py": "carl", name: eve}
    for others in (files, {key: content for key, content in files.items() if key[0] != "c"}):
        folder = tmp_path / f"class{len(others)}"
        found = handed(zipped(others, folder.with_suffix(".zip")) if packed else fill(folder, others))
        cells, problem = found.pop(name.partition("/")[0].partition(".")[0])
        assert cells == ()
        assert f"it has the name of the lab, next to other files in {folder.name}. Name it after its student" in problem
        assert list(found.values()) == [((student.partition("_")[0],), "") for student in found]
        assert len(found) == len(others) - 1


def test_what_moodle_makes_beside_the_files_is_no_other_submission(tmp_path):
    files = {"Cleo Ng_8_assignsubmission_onlinetext_/onlinetext.html": "x", "Cleo Ng_8_assignsubmission_file_/mine.ipynb": ADA,
             "Dan_9_assignsubmission_onlinetext_/onlinetext.html": "x"}  # fmt: skip
    expected = {"Cleo Ng_8": (("ada",), ""), "Dan_9": ((), "it contains no notebook; there is onlinetext.html")}
    assert handed(zipped(files, tmp_path / "class.zip")) == expected
    folder = fill(tmp_path / "class", files)
    assert handed(folder) == handed(*folder.iterdir()) == expected


def test_a_text_or_an_address_typed_into_canvas_is_a_student_without_a_notebook(tmp_path):
    files = {"ngcleo_LATE_8_text.html": "x", "dvdan_9_link.html": "x", "eve_10_11_x.ipynb": ADA}
    words = "it contains no notebook; there is {}"
    expected = {"ngcleo_8": ((), words.format("ngcleo_LATE_8_text.html")), "dvdan_9": ((), words.format("dvdan_9_link.html")),
                "eve_10": (("ada",), "")}  # fmt: skip
    assert handed(fill(tmp_path / "class", files)) == handed(zipped(files, tmp_path / "class.zip")) == expected


def test_a_notebook_of_another_lab_is_a_problem(tmp_path):
    def checked(lab, *names):
        return notebook(*(f"hl.check('{lab}.{name}', 1)" for name in names))

    fill(tmp_path, {
        "ada/01_motion_to_force.ipynb": checked("01", "k"), "bob/x.ipynb": checked("01", "k", "b", "m"),
        "cleo/01_motion_to_force.ipynb": checked("02", "k"), "dan/x.ipynb": checked("01", "k", "b"),
        "eve/x.ipynb": checked("01", "k", "b", "m"), "eve/y.ipynb": checked("02", "k"), "finn/01_x.ipynb": ADA,
        "gus/01_x.ipynb": checked("01", "k"), "gus/03_x.ipynb": checked("03", "k"),
    })  # fmt: skip
    found = handed(tmp_path)
    assert {student: problem for student, (_, problem) in found.items() if problem} == {
        "ada": "01_motion_to_force.ipynb is of lab 01, not of lab 02",
        "bob": "x.ipynb is of lab 01, not of lab 02",
        "gus": "01_x.ipynb is of lab 01, not of lab 02",
    }
    assert found["eve"][0] == ("hl.check('02.k', 1)",)


def test_a_copy_of_the_lab_as_it_came_is_set_aside(tmp_path):
    own, done = ["k = ...", "hl.check('02.k', k)"], notebook("k = 2")
    blank = notebook("k = ...\n", "", "hl.check('02.k', k)")
    fill(tmp_path, {
        f"ada/{LAB}.ipynb": done, f"ada/{LAB}-Copy1.ipynb": blank, f"bob/{LAB}.ipynb": blank, f"bob/done/{LAB}.ipynb": done,
        f"cleo/{LAB}.ipynb": blank, f"dan/{LAB}.ipynb": blank, f"dan/{LAB}-Copy1.ipynb": blank, f"eve/{LAB}.ipynb": blank,
        f"eve/{LAB}-Copy1.ipynb": b"cut off",
    })  # fmt: skip
    found = {source.student: read(source, own) for source in find_submissions([tmp_path], LAB)}
    assert [len(found[student].cells) for student in ("ada", "bob", "cleo", "dan")] == [1, 1, 3, 3]
    assert found["eve"].problem == f"{LAB}-Copy1.ipynb is not a notebook; it needs the JSON that Jupyter writes"


def test_a_notebook_that_a_dot_hides_is_named(tmp_path):
    files = {"ada/.x.ipynb": ADA, ".bob.ipynb": BOB, "cleo/.x.ipynb": BOB, "cleo/x.ipynb": ADA, "._dan.ipynb": "x",
             "cleo/.ipynb_checkpoints/.x.ipynb": BOB}  # fmt: skip
    words = "it contains no notebook; there is {}; a file is hidden by the dot before its name"
    expected = {"ada": ((), words.format(".x.ipynb")), "bob": ((), words.format(".bob.ipynb")), "cleo": (("ada",), "")}
    assert handed(fill(tmp_path / "class", files)) == handed(zipped(files, tmp_path / "class.zip")) == expected


def test_paths_in_nbgraders_tree_name_the_student(tmp_path):
    place = fill(tmp_path, {f"course/submitted/ada/{LAB}/x.ipynb": ADA}) / "course"
    for path in (place, place / "submitted", place / "submitted/ada", place / f"submitted/ada/{LAB}/x.ipynb"):
        assert whose(path) == {"ada": "ada"}


def test_a_file_is_named_by_itself_or_where_it_is_the_labs_by_its_folder(tmp_path):
    fill(tmp_path, {f"ada/{LAB}.ipynb": ADA, "all/bob.ipynb": BOB})
    assert whose(tmp_path / f"ada/{LAB}.ipynb", tmp_path / "all/bob.ipynb") == {"ada": "ada", "bob": "bob"}


def test_the_number_of_a_lab_does_as_well(tmp_path):
    fill(tmp_path, {f"ada/{LAB}.ipynb": ADA, "ada/01_motion_to_force.ipynb": BOB, "bob/b.py": "bob"})
    assert whose(tmp_path, lab="02") == {"ada": "ada", "bob": "bob"}


def test_a_student_who_is_there_twice_is_named_and_each_gets_a_problem(tmp_path):
    fill(tmp_path, {"a/bob.ipynb": BOB, "b/bob.ipynb": ADA, "b/ada.ipynb": ADA})
    found = handed(tmp_path / "a/bob.ipynb", tmp_path / "b/bob.ipynb", tmp_path / "b/ada.ipynb")
    assert set(found) == {"bob", "bob (2)", "ada"}
    assert (
        found["bob"][1]
        == found["bob (2)"][1]
        == ("2 submissions belong to bob: bob.ipynb and bob.ipynb; keep one, or give them different names")
    )
    assert found["ada"] == (("ada",), "")


def test_undecidable_notebooks_are_named(tmp_path):
    fill(tmp_path, {"ada/a.ipynb": ADA, "ada/b.ipynb": BOB, "bob/b.pdf": "x", "bob/c.txt": "x"})
    found = handed(tmp_path)
    assert found["ada"] == ((), "a.ipynb and b.ipynb are all possible; hand in only one")
    assert found["bob"] == ((), "it contains no notebook; there is b.pdf, c.txt")


def test_which_lab_the_names_agree_on(tmp_path):
    fill(tmp_path, {f"one/ada/{LAB}/x.ipynb": ADA, f"one/{LAB}_bob.ipynb": BOB, "two/ada/01_x.ipynb": ADA, "three/x.ipynb": ADA})
    assert lab_of(find_submissions([tmp_path / "one"])) == "02"
    with pytest.raises(CourseError, match=r"name labs 01, 02; give the lab to grade, such as --lab 02"):
        lab_of(find_submissions([tmp_path / "one", tmp_path / "two"]))
    with pytest.raises(CourseError, match="name no lab"):
        lab_of(find_submissions([tmp_path / "three"]))


def test_a_missing_path_is_an_error(tmp_path):
    with pytest.raises(CourseError, match="no such file"):
        find_submissions([tmp_path / "nobody.ipynb"])


@pytest.mark.parametrize("folder", find_labs(), ids=lambda folder: folder.name)
def test_the_cells_of_a_lab_are_those_that_it_has(folder):
    (source,) = find_submissions([folder.notebook], folder.name)
    found = read(source)
    assert (source.student, found.name) == (folder.name, folder.notebook.name)
    assert list(found.cells) == code_of(read_notebook(folder.notebook))
    assert found.sha256 == hashlib.sha256(folder.notebook.read_bytes()).hexdigest()


TEXT = "name = 'Zoë'"
NOTEBOOKS = {
    "utf-8 with a mark": b"\xef\xbb\xbf" + notebook(TEXT),
    "utf-8 as it is": json.dumps(json.loads(notebook(TEXT)), ensure_ascii=False).encode(),
    "latin-1": json.dumps(json.loads(notebook(TEXT)), ensure_ascii=False).encode("latin-1"),
    "utf-16": json.dumps(json.loads(notebook(TEXT)), ensure_ascii=False).encode("utf-16"),
    "utf-16 without a mark": json.dumps(json.loads(notebook(TEXT)), ensure_ascii=False).encode("utf-16-le"),
    "lines": notebook(["name = ", "'Zoë'"]),
    "version 3": json.dumps(
        {"worksheets": [{"cells": [{"cell_type": "code", "language": "python", "input": [TEXT], "prompt_number": 1}]}]}
    ).encode(),
    "cells that are none": json.dumps(
        {"cells": [3, None, {}, {"cell_type": "code", "source": TEXT}, {"cell_type": ["code"], "source": 3}]}
    ).encode(),
    "numbers of any size": notebook(TEXT)[:-1] + b', "a": ' + b"9" * 10000 + b', "b": NaN, "c": 1e999999, "d": -Infinity}',
    "names twice": b'{"cells": 3, ' + notebook(TEXT)[1:],
}


@pytest.mark.parametrize("kind", NOTEBOOKS)
def test_a_notebook_is_read_however_it_was_saved(tmp_path, kind):
    fill(tmp_path, {"ada.ipynb": NOTEBOOKS[kind]})
    assert [cell for cell in handed(tmp_path)["ada"][0] if cell] == [TEXT]


def test_cells_without_source_stay_in_their_places(tmp_path):
    raw = json.dumps({"cells": [{"cell_type": "code"}, {"cell_type": "code", "source": ["k", 3, "=2"]}]})
    assert handed(fill(tmp_path, {"ada.ipynb": raw}))["ada"][0] == ("", "k=2")


NO_NOTEBOOKS = {
    "nothing": b"",
    "no JSON": b"\x89PNG\r\n\x1a\n" + bytes(range(256)),
    "cut off": notebook("k = 2")[:-9],
    "another JSON": b"[1, 2]",
    "no cells": b'{"cells": null}',
    "a number": b"3",
    "deep": b"[" * 100_000,
    "deep and whole": b'{"cells": ' + b"[" * 100_000 + b"]" * 100_000 + b"}",
    "too many lists": b'{"cells": [' + b"[]," * 600_000 + b"1]}",
    "too many cells": notebook(*["k"] * 3000),
    "too much code": notebook("#" * 6_000_000),
    "nothing in its cells": notebook("", " \n"),
    "worksheets that are none": b'{"worksheets": [3]}',
}


@pytest.mark.parametrize("kind", NO_NOTEBOOKS)
def test_what_is_no_notebook_is_a_problem_in_words(tmp_path, kind):
    cells, problem = handed(fill(tmp_path, {"ada.ipynb": NO_NOTEBOOKS[kind]}))["ada"]
    assert cells == ()
    assert problem.startswith("ada.ipynb ")
    assert "\n" not in problem


def test_a_script_is_cells_that_keep_their_lines(tmp_path):
    script = "import math\r\n\r\n# %%\r\nk = (1 +\r\n  nothing)\r\nb = 3\r\ndef f(:\r\n    pass\r\ndef c():\r\n    return 4\r\n"
    cells, _ = handed(fill(tmp_path, {"ada.py": script}))["ada"]
    names = {"__name__": "__main__"}
    problems = [run_cell(cell, names, number) for number, cell in enumerate(cells, start=1)]
    assert [problem.split(":")[0] for problem in problems if problem] == ["NameError in line 5", "SyntaxError in line 7"]
    assert (names["b"], names["c"]()) == (3, 4)


def test_a_script_in_latin_1_and_one_with_more_statements_than_any(tmp_path):
    fill(tmp_path, {"ada.py": TEXT.encode("latin-1"), "bob.py": "k = 2\n" * 5000, "eve.py": "k = 2\n" * 100_000})
    found = handed(tmp_path)
    assert found["ada"][0] == (TEXT,)
    assert found["bob"] == (("k = 2\n" * 5000,), "")
    assert found["eve"] == ((), "eve.py has more code than any lab: at most 500000 characters")


SLOW = {
    "blanks": " " * 200_000,
    "blank lines": "\n" * 200_000,
    "names": "a" * 200_000,
    "an expression": "a, " * 66_000,
    "open brackets": "(" * 200_000,
    "lines in a bracket": "(" + "\n@a" * 66_000,
    "open texts": "'" * 200_000,
    "texts of many lines": '"""' * 66_333,
    "lines that go on": "if a:\n" + " a\n" * 66_000,
    "backslashes": "\\\n" * 66_000,
    "decorators": "@a\n" * 66_000,
    "questions": "a" * 160_000 + "?" * 36_000 + "!",
}


@pytest.mark.parametrize("kind", SLOW)
@pytest.mark.always(
    "blanks", "names", "an expression", "open *", "lines in a bracket", "texts of many lines", "backslashes", "questions"
)
def test_a_long_script_is_taken_apart(kind):
    """In seconds; where the time grows with the square of the length, it takes minutes to hours."""
    assert "".join(statements(SLOW[kind])) in (SLOW[kind], "")


def test_a_name_of_many_dashes_is_no_lab():
    assert not is_lab(LAB + "-" * 60_000 + "a.ipynb", LAB)


def test_links_and_what_is_no_file_are_never_read(tmp_path):
    if not hasattr(os, "mkfifo"):
        pytest.skip("this system has no fifos")
    fill(tmp_path, {"secret/solution.ipynb": notebook("secret"), "class/bob/b.py": "bob", "class/eve/.x": ""})
    (tmp_path / "class/ada").symlink_to(tmp_path / "secret")
    (tmp_path / "class/eve/x.ipynb").symlink_to(tmp_path / "secret/solution.ipynb")
    (tmp_path / "class/mallory").mkdir()
    os.mkfifo(tmp_path / "class/mallory/x.ipynb")
    found = handed(tmp_path / "class")
    assert found == {
        "ada": ((), "it contains no notebook; there is a link"),
        "bob": (("bob",), ""),
        "eve": ((), "x.ipynb: it is a link; hand in the file itself"),
        "mallory": ((), "x.ipynb: it is not a plain file"),
    }


def test_a_file_larger_than_any_notebook_is_not_read(tmp_path):
    fill(tmp_path, {"bob.ipynb": BOB, "ada.ipynb": b""})
    with (tmp_path / "ada.ipynb").open("wb") as file:
        file.truncate(1 << 30)  # takes no room on the disk
    found = handed(tmp_path)
    assert found["ada"][1].startswith("ada.ipynb: it is larger than 32 MiB")
    assert found["bob"][0] == ("bob",)


def hostile_link():
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w") as archive:
        info = zipfile.ZipInfo("x.ipynb")
        info.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(info, "/etc/passwd")
    return held.getvalue()


def with_size(content):
    """A zip file whose table of contents says it has 1 GiB."""
    end = content.rfind(b"PK\5\6")
    return content[: end + 12] + struct.pack("<L", 1 << 30) + content[end + 16 :]


def encrypted(content):
    central = content.rfind(b"PK\1\2")
    changed = bytearray(content)
    changed[6] |= 1
    changed[central + 8] |= 1
    return bytes(changed)


HOSTILE = {
    "no zip": (b"PK\3\4 and nothing more", "is not a zip file, or it is incomplete"),
    "cut off": (zipped({"x.ipynb": ADA})[:-30], "is not a zip file, or it is incomplete"),
    "a bomb": (zipped({"x.ipynb": b"0" * (40 << 20)}), "larger than 32 MiB"),
    "a bomb in a zip": (zipped({"x.zip": zipped({"x.ipynb": b"0" * (40 << 20)})}),
                        "x.zip is a zip file inside a zip file; hand in the notebook itself"),
    "a link": (hostile_link(), "it contains no notebook; there is a link"),
    "a large table": (with_size(zipped({"x.ipynb": ADA})), "its table of contents has 1073741824 bytes"),
    "a password": (encrypted(zipped({"x.ipynb": ADA})), "x.ipynb: it is locked by a password; hand it in without one"),
    "turned bytes": (zipped({"x.ipynb": ADA}).replace(b"PK\3\4", b"PK\3\5"), "cannot be read: BadZipFile"),
    "empty": (zipped({}), "it contains no notebook; there is nothing"),
}  # fmt: skip


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_zip_file_is_a_problem_of_its_student_alone(tmp_path, kind):
    content, words = HOSTILE[kind]
    found = handed(fill(tmp_path, {"class/ada.zip": content, "class/bob.ipynb": BOB}) / "class")
    assert found["bob"] == (("bob",), "")
    assert words in found["ada"][1]
    alone = handed(tmp_path / "class/ada.zip")
    assert words in alone["ada"][1] or kind == "a bomb in a zip"
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["ada.zip", "bob.ipynb", "class"]


def test_a_zip_file_that_names_places_elsewhere_writes_nothing_and_is_read(tmp_path):
    fill(tmp_path, {"in/bob.ipynb": BOB})
    zipped({"../../ada/x.ipynb": ADA, "/etc/eve/x.ipynb": BOB, "C:\\windows\\x.py": "w"}, tmp_path / "in/class.zip")
    assert whose(tmp_path / "in/class.zip") == {"ada": "ada", "etc": "bob", "C:": "w"}
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["bob.ipynb", "class.zip", "in"]


def test_names_hold_nothing_that_turns_or_controls(tmp_path):
    names = ["<script>alert(1)<", "=cmd|' !A0", "a\u202etxt.b", "b\x1b[31mred", "n\nl", "x" * 300, " "]
    zipped({f"{name}/x.ipynb": ADA for name in names}, tmp_path / "class.zip")
    students = list(handed(tmp_path / "class.zip"))
    assert len(students) == 7
    assert {"<script>alert(1)<", "=cmd|' !A0", "atxt.b", "b[31mred", "n l", "unnamed"} <= {*students}
    assert max(map(len, students)) <= 84


def test_a_folder_of_more_files_than_any_class_has_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(folders, "MOST_FILES", 3)
    fill(tmp_path, {f"{name}.ipynb": ADA for name in "abcd"})
    with pytest.raises(CourseError, match="more than 3 files; give the folder of the submissions"):
        find_submissions([tmp_path])


@pytest.mark.parametrize("tree", ["", "submitted/"])
def test_too_many_files_of_one_student_are_a_problem_of_that_one_alone(tmp_path, monkeypatch, tree):
    monkeypatch.setattr(folders, "MOST_OF_ONE", 3)
    many = {f"{tree}eve/{number}/{number}.ipynb": ADA for number in range(4)}
    fill(tmp_path / "class", {f"{tree}ada/x.ipynb": ADA, f"{tree}bob/x.ipynb": BOB, **many})
    assert handed(tmp_path / "class") == {
        "ada": (("ada",), ""),
        "bob": (("bob",), ""),
        "eve": ((), "eve contains more than 3 files; hand in the notebook only"),
    }


@pytest.mark.skipif(sys.platform != "linux", reason="names elsewhere cannot be other than Unicode")
def test_a_name_in_another_encoding(tmp_path):
    raw = os.fsencode(tmp_path) + b"/Zo\xeb.ipynb"
    with open(raw, "wb") as file:
        file.write(ADA)
    fill(tmp_path, {"bob.ipynb": BOB})
    found = whose(tmp_path)
    assert sorted(found.values()) == ["ada", "bob"]
    assert all(student.encode() for student in found)
