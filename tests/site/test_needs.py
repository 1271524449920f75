"""Which packages come from Pyodide, and which from here."""

from importlib.metadata import distribution

import pytest

from hapticlab.errors import CourseError
from hapticlab.site.needs import NOT_THERE, OF_PYODIDE, ROOTS, needed, normal, requirements


def test_requirements_are_those_of_a_browser(install):
    lines = [
        "walls (>1)", 'llvmlite ; sys_platform == "linux"', "Coils; python_version >= '3.12'", 'old; python_version < "3.12"',
        'more ; extra == "all"', 'web; sys_platform == "emscripten"',
    ]  # fmt: skip
    install("springs", {"springs/__init__.py": ""}, "".join(f"Requires-Dist: {line}\n" for line in lines))
    assert requirements("springs") == ["walls", "Coils", "web"]


def test_what_pyodide_has_is_not_looked_into(install):
    install("hapticlab", {"hapticlab.py": ""}, "Requires-Dist: Two_Masses\nRequires-Dist: numpy\n")
    install("two-masses", {"two_masses.py": ""}, "Requires-Dist: beams\n")
    install("beams", {"beams.py": ""})
    theirs, ours = needed({normal(name) for name in ROOTS if name != "hapticlab"} | {"numpy"})
    assert theirs == sorted({*ROOTS, "numpy"} - {"hapticlab"}) and ours == ["beams", "hapticlab", "two-masses"]
    assert needed({normal(name) for name in ROOTS if name != "hapticlab"} | {"numpy", "beams"})[1] == ["hapticlab", "two-masses"]


def test_a_package_that_is_not_installed_is_named_with_the_cure(install):
    install("hapticlab", {"hapticlab.py": ""}, "Requires-Dist: nobody-has-this\n")
    with pytest.raises(CourseError, match=r'nobody-has-this is not installed.*pip install "hapticlab\[site\]"'):
        needed()


def test_every_package_of_here_is_in_python_alone():
    for name in needed()[1]:
        files = {str(path) for path in distribution(name).files if ".." not in path.parts}
        code = {path for path in files if path.endswith((".so", ".pyd")) and "__mypyc" not in path}
        assert {path.partition(".")[0] + ".py" for path in code} <= files, name
    assert not NOT_THERE & set(needed()[1])


@pytest.mark.wide
def test_the_packages_said_to_be_pyodides_are_in_its_lock_file():
    import json

    from pyodide_archive import LOCK, archive

    locked = json.loads((archive() / LOCK).read_text("utf-8"))["packages"]
    assert OF_PYODIDE <= {normal(name) for name in locked}
