"""The page for instructors says where the chapter is taught, as the labs are now."""

from taught import PAGE, sections_of, used_names, written


def test_sections_and_names_are_found():
    assert sections_of("Eqs. (23.5), (23.9), Fig. 23.7 and Section 23.2.2.") == ["23.2.2", "23.4", "23.4.2", "23.5.1"]
    assert used_names("from hapticlab import n, x\nhl.laws.virtual_damper()(B=1)") == {"laws", "laws.virtual_damper", "n", "x"}


def test_page_has_the_table_of_now():
    page = PAGE.read_text("utf-8")
    assert page == written(page), "python tests/labs/taught.py --write"
