"""The progress bar: nothing for two seconds, then a bar; on standard error, and gone afterwards."""

import pytest

from hapticlab.device.progress import progress_bar


@pytest.mark.parametrize(("waited", "shown"), [(1.9, False), (2.1, True)])
def test_the_bar_appears_after_two_seconds(capsys, waited, shown):
    with progress_bar(100, True) as bar:
        for clock in ("start_t", "last_print_t"):  # as if it had begun that long ago
            setattr(bar, clock, getattr(bar, clock) - waited)
        bar.update(40)
        seen = capsys.readouterr()
    assert ("40%" in seen.err) == shown
    assert seen.out == ""


def test_a_bar_that_is_not_wanted_never_appears(capsys):
    with progress_bar(100, False) as bar:
        bar.update(100)
    assert capsys.readouterr() == ("", "")
