"""What attacks hold while they run, seen by who does not grade: the memory of a group that the whole grader is put into."""

import os
import sys

import pytest

if sys.platform != "linux":
    pytest.skip("memory groups are Linux'", allow_module_level=True)

from attacks import holding
from attacks.arena import LIMITS
from attacks.table import Group, measured

LEVELS = ("namespaces", "user")
MEMORY = [one.name for one in holding.MEMORY if not one.patience]
FILES = [one.name for one in holding.FILES if not one.patience]
#: what a session that keeps to its bound may hold beside it: its own Python, and the grader's while it looks [MiB]
BESIDE = 80
pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(1800),  # the first test of a level waits for all attacks
    pytest.mark.skipif(os.geteuid() != 0, reason="only root may make a memory group"),
]


@pytest.fixture(scope="module", params=LEVELS)
def seen(request):
    group = Group()
    if not group.place:
        pytest.skip("no memory group of version 1 can be made here")
    group.place.rmdir()
    return {row["end"]: row for row in measured(request.param, MEMORY + FILES, False) if "end" in row}


@pytest.mark.parametrize("name", MEMORY)
def test_memory_keeps_to_its_bound(seen, name):
    assert seen[name]["memory"] <= LIMITS.memory / 2**20 + BESIDE


@pytest.mark.parametrize("name", MEMORY + FILES)
def test_nothing_is_left_and_the_next_is_graded(seen, name):
    row = seen[name]
    assert not row["processes"] and not row["files"] and not row.get("grader")
    assert row["honest"] and not row["gained"] and not row["missing"]
