"""Work that takes turns: the same in a thread and, where there are none, on the event loop."""

import threading

from hapticlab.device import turns


def counting(done, enough=None, *, until=3, pause=0.0):
    for k in range(until):
        done.append(k)
        yield pause
    if enough is not None:
        enough.set()


def test_it_goes_on_until_it_ends(both):
    done, enough = [], both.event()
    work = turns.begin(counting(done, enough), "count")
    assert enough.wait(20) and done == [0, 1, 2]
    assert work.join(20) and not work.is_alive()


def test_a_wait_ends_when_it_is_woken(both):
    done, waits, enough = [], both.event(), both.event()

    def waiting():
        waits.set()
        yield 1e6
        enough.set()

    work = turns.begin(waiting(), "wait")
    assert waits.wait(20)
    work.wake()
    assert enough.wait(20) and done == []


def test_a_wait_that_was_cut_short_does_not_end_the_next_one(both):
    done, waits, over = [], both.event(), both.event()

    def waiting():
        waits.set()
        yield 0.02
        done.append("woken")
        yield 1e6
        done.append("by itself")
        over.set()

    work = turns.begin(waiting(), "wait twice")
    assert waits.wait(20)
    work.wake()
    assert not over.wait(0.05) and done == ["woken"]


def test_who_takes_a_turn_is_known(both):
    said, known, enough = [], threading.Event(), both.event()

    def asking():
        while not known.is_set():
            yield 1e-3
        said.append(work.is_current())
        enough.set()

    work = turns.begin(asking(), "ask")
    known.set()
    assert not work.is_current()
    assert enough.wait(20) and said == [True]


def test_two_take_turns(both):
    done, enough = [], both.event()
    first = turns.begin(counting(done, until=40), "first")
    second = turns.begin(counting(done, enough, until=40), "second")
    assert enough.wait(20) and first.join(20) and second.join(20)
    assert sorted(done) == sorted([*range(40)] * 2)


def test_without_threads_nothing_begins_before_the_loop_is_free_and_whoever_waits_does_it(one_thread):
    done, before = [], set(threading.enumerate())
    work = turns.begin(counting(done), "count")
    assert done == [] and work.is_alive() and set(threading.enumerate()) <= before
    assert not work.join(0) and work.join(20) and done == [0, 1, 2]


def test_without_threads_others_come_between_two_turns(one_thread):
    done, enough = [], one_thread.event()
    turns.begin(counting(done, until=3), "first")
    turns.begin(counting(done, enough, until=3), "second")
    assert enough.wait(20) and done == [0, 0, 1, 1, 2, 2]


def test_a_wait_that_is_not_over_when_time_is_up_is_said(both):
    work = turns.begin(counting([], pause=1e6), "wait")
    assert not work.join(0.01) and work.is_alive()


def test_a_loop_that_ends_first_ends_the_turns_too(one_thread):
    ended = []

    def waiting():
        try:
            yield 1e6
        finally:
            ended.append(True)

    work, soon = turns.begin(waiting(), "wait"), one_thread.event()
    turns.begin(counting([], soon), "count")
    assert soon.wait(20) and work.is_alive()
    work._task.cancel()
    assert work.join(0) or not one_thread.event().wait(0.0)
    assert ended == [True] and not work.is_alive()
