"""The latest value wins: what is asked for while work is under way is worked on once, with its last value."""

import threading

from hapticlab.widgets.latest_value import Latest


def test_values_in_between_are_dropped():
    begun, go, done = threading.Event(), threading.Event(), []

    def work(value):
        begun.set()
        assert go.wait(10)
        done.append(value)

    latest = Latest(work, done.append)
    latest.ask(0)
    assert begun.wait(10)
    for value in range(1, 500):
        latest.ask(value)
    assert not latest.wait(0)  # the first is still under way
    go.set()
    assert latest.wait(10)
    assert done == [0, 499]


def test_without_threads_the_last_value_alone_is_worked_on(one_thread):
    done = []
    latest = Latest(done.append, done.append)
    for value in range(500):
        latest.ask(value)
    assert latest.wait(10) and done == [499]


def test_a_value_that_comes_while_one_is_worked_on_is_next(both):
    done, enough = [], both.event()

    def work(value):
        done.append(value)
        if value < 3:
            latest.ask(value + 1)
        else:
            enough.set()

    latest = Latest(work, done.append)
    latest.ask(0)
    assert enough.wait(20) and done == [0, 1, 2, 3]


def test_it_begins_again_and_survives_an_error(both):
    done, failures = [], []

    def work(value):
        done.append(1 / value)

    latest = Latest(work, failures.append)
    for value in (0, 4):
        latest.ask(value)
        assert latest.wait(10)
    assert done == [0.25] and isinstance(failures[0], ZeroDivisionError)


def test_asking_from_many_threads_leaves_nothing_undone():
    done = []
    latest = Latest(done.append, done.append)
    threads = [threading.Thread(target=latest.ask, args=[value]) for value in range(50)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    latest.ask("last")
    assert latest.wait(10) and done[-1] == "last" and len(done) <= 51
