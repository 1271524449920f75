"""Sweeps on threads, on processes, on maps of others and on a cluster: the same bits, whoever is killed."""

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import tracemalloc
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.analysis.sweeps import sweep as module
from hapticlab.analysis.sweeps import sweep_chunks
from hapticlab.analysis.sweeps import workers as workers_module
from hapticlab.analysis.sweeps.sweep_chunks import measured
from hapticlab.analysis.sweeps.workers import number_of, safe_path, spread

pytestmark = pytest.mark.interpreter

HELD = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=5e4, hand=hl.Hand(m=0.1, b=2.0, k=200.0, push=1.0))
AXES = {"k": np.geomspace(50, 3000, 90), "delay": np.array([0.0, 4e-4, 1e-3]), "T": np.array([1e-3, 7e-4])}


def swept(**changes):
    given = {"duration": 0.3, "progress": False, "x_o": 0.0, **AXES, **changes}
    return hl.sweep(hl.wall(), given.pop("paddle", HELD), **given).values


@pytest.fixture(scope="module")
def alone():
    return swept()


@pytest.mark.parametrize("most", [1, 7, 64, 1000])
@pytest.mark.parametrize("workers", [1, 2, 5])
@pytest.mark.always("5-64")
def test_bits_do_not_depend_on_workers_and_chunks(most, workers, alone, monkeypatch):
    monkeypatch.setattr(sweep_chunks, "MOST", most)
    monkeypatch.setattr(sweep_chunks, "FEWEST", 1)
    np.testing.assert_array_equal(swept(workers=workers), alone)


def test_an_intent_that_has_changed_is_sampled_again():
    class Moving:
        amplitude = 1e-3

        def __call__(self, times):
            return self.amplitude * np.sin(30 * times)

    intent = Moving()
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(k=50, b=1, intent=intent))
    soft = swept(paddle=paddle, metric="peak_force", delay=0, T=1e-3)
    intent.amplitude *= 2
    wide = swept(paddle=paddle, metric="peak_force", delay=0, T=1e-3)
    assert (wide > 1.5 * soft).all()


def test_any_map_will_do(alone):
    def backwards(function, pieces):
        return [function(pickle.loads(pickle.dumps(piece))) for piece in reversed(pieces)]

    np.testing.assert_array_equal(swept(workers=backwards), alone)
    np.testing.assert_array_equal(swept(workers=map), alone)
    with ThreadPoolExecutor(2) as pool:
        np.testing.assert_array_equal(swept(workers=pool.map), alone)


def test_a_map_that_loses_results_is_found_out():
    with pytest.raises(
        hl.errors.AnalysisError, match=r"workers returned 450 of 540 points; needs a map that returns every result once"
    ):
        swept(workers=lambda function, pieces: map(function, pieces[1:]))


def first_again(function, pieces):
    return [function(pieces[0])] * len(pieces)


def shortened(function, pieces):
    """As many points as there are, if they are only counted: a result without its last one, and that of another chunk."""
    for piece in pieces:
        group, first, values, missed = function(piece)
        yield group, first, values[:-1], missed
        yield group, first, values[:1], missed


def one_more(function, pieces):
    return [*map(function, pieces), function(pieces[0])]


def of_another(function, pieces):
    return [(group, first + 1, *rest) for group, first, *rest in map(function, pieces)]


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (first_again, "a chunk twice, or one that they were not given"),
        (one_more, "a chunk twice, or one that they were not given"),
        (of_another, "a chunk twice, or one that they were not given"),
        (shortened, r"an array of shape \(\d+,\) for a chunk of \d+ points"),
        (lambda function, pieces: None, "None; needs a map that returns all results"),
        (lambda function, pieces: [None for _ in pieces], "None; needs a map that returns the results of the function"),
        (lambda function, pieces: [ValueError("no " * 90)], r"ValueError\('no.* \.\.\.; needs"),
        (lambda function, pieces: [(0, 0, "none", 0)], r"\(0, 0, 'none', 0\); needs"),
        (lambda function, pieces: [([], 0, 1.0, 0)], r"\(\[\], 0, 1.0, 0\); needs"),
    ],
)
def test_only_what_was_measured_is_taken(wrong, words, tmp_path, monkeypatch):
    """And only that is kept in the file."""
    few = {"k": AXES["k"][:40], "T": 1e-3, "duration": 0.05, "metric": "peak_force"}
    alone = swept(**few)
    monkeypatch.setattr(sweep_chunks, "MOST", 20)
    monkeypatch.setattr(sweep_chunks, "FEWEST", 20)
    with pytest.raises(hl.errors.AnalysisError, match=f"workers returned {words}"):
        swept(workers=wrong, resume=tmp_path / "a", **few)
    np.testing.assert_array_equal(swept(resume=tmp_path / "a", **few), alone)


def test_a_map_gets_the_chunks_in_lists_that_grow(monkeypatch):
    """Before a list is asked for, all results of the one before are out."""
    monkeypatch.setattr(workers_module, "LARGEST_BATCH", 40)
    taken, sizes = [], []

    def pieces():
        for number in range(200):
            taken.append(number)
            yield number

    def mapped(function, batch):
        sizes.append(len(batch))
        return map(function, batch)

    for number, result in enumerate(spread(abs, pieces(), mapped)):
        assert result == number and len(taken) == sum(sizes)
    assert sizes == [16, 32, 40, 40, 40, 32]


def test_a_map_of_promises_is_refused():
    with (
        ThreadPoolExecutor(1) as pool,
        pytest.raises(hl.errors.AnalysisError, match=r"not futures\. .*client\.get_executor\(\)\.map"),
    ):
        swept(workers=lambda function, pieces: [pool.submit(function, piece) for piece in pieces])


def test_what_workers_may_be():
    assert (number_of(3), number_of(np.int64(2)), number_of(-1)) == (3, 2, os.cpu_count())
    for wrong in (0, -2, 2.0, "two", None, True):
        with pytest.raises(
            hl.errors.AnalysisError, match="needs a whole number >= 1, -1 for every processor, or a function like map"
        ):
            number_of(wrong)
    with ThreadPoolExecutor(1) as pool, pytest.raises(hl.errors.AnalysisError, match=r"give its map: workers=pool\.map"):
        number_of(pool)


def test_an_interrupt_ends_the_threads_and_keeps_what_they_had(tmp_path, alone, monkeypatch):
    """A real signal, in the main thread where it waits for the others; list.append is one step for all threads."""
    pytest.importorskip("llvmlite")  # the interpreter has processes
    monkeypatch.setattr(sweep_chunks, "MOST", 20)
    monkeypatch.setattr(sweep_chunks, "FEWEST", 20)
    threads, begun, finished = {*threading.enumerate()}, [], []

    def counted(chunk):
        begun.append(chunk)
        return measured(chunk)

    def interrupted(futures, *given):
        found = wait(futures, *given)
        finished.extend(found.done)
        if len(finished) >= 8:
            signal.raise_signal(signal.SIGINT)
        return found

    monkeypatch.setattr(module, "measured", counted)
    monkeypatch.setattr(workers_module, "wait", interrupted)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it
    try:
        with pytest.raises(KeyboardInterrupt) as stop:
            swept(workers=2, resume=tmp_path / "a")
    finally:
        signal.signal(signal.SIGINT, before)
    assert threads >= {*threading.enumerate()}
    assert len(begun) <= len(finished) + 4  # those under way, of 27 and more
    assert "points are in" in stop.value.__notes__[0] and int(stop.value.__notes__[0].split()[0]) >= 20
    monkeypatch.undo()
    np.testing.assert_array_equal(swept(workers=2, resume=tmp_path / "a"), alone)


def test_an_error_in_a_chunk_comes_out(monkeypatch):
    for threads in (True, False):
        with pytest.raises(TypeError, match="unsupported operand"):
            list(spread(sum, [[1, 2], ["a"], [3]], 2, threads=threads))


@pytest.mark.wide
def test_processes_measure_the_same(alone):
    """Of the interpreter, which holds Python's lock; the other engine's bits."""
    given = {"T": 1e-3, "k": AXES["k"][::9], "duration": 0.05}
    np.testing.assert_array_equal(swept(engine="interpreter", workers=2, **given), swept(**given))
    moving = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(k=50, intent=lambda t: 0 * t))
    with pytest.raises(hl.errors.AnalysisError, match="cannot be sent to worker processes: .*lambda.*def in a module"):
        swept(engine="interpreter", workers=2, paddle=moving, **given)


def test_a_killed_process_is_replaced():
    numbers = range(300_000)
    results = spread(sum, [numbers] * 60, 2, threads=False)
    assert next(results) == 299_999 * 150_000
    for child in multiprocessing.active_children():
        child.kill()
        break
    assert list(results) == [299_999 * 150_000] * 59


@pytest.mark.wide
def test_processes_that_die_again_and_again_are_given_up():
    with pytest.raises(
        hl.errors.AnalysisError, match=r"ended 3 times in a row before they finished any point\. .*if __name__ == '__main__':"
    ):
        list(spread(os._exit, [3, 3, 3], 2, threads=False))


def test_a_pool_that_breaks_says_so(tmp_path):
    def breaks(function, pieces):
        yield function(pieces[0])
        raise BrokenProcessPool("a process was terminated abruptly")

    with pytest.raises(hl.errors.AnalysisError, match="worker of the pool given as workers was killed.*resume=") as stop:
        swept(workers=breaks, resume=tmp_path / "a")
    assert "points are in" in stop.value.__notes__[0]


@pytest.mark.slow
def test_a_million_points(tmp_path):
    """Interrupted and resumed, in memory for the result and a few chunks; any point as when it runs alone."""
    k, b = np.geomspace(50, 3000, 1000), np.linspace(0.05, 1.0, 1000)
    given = {"metric": "energy", "duration": 0.1, "T": 1e-3, "delay": 4e-4, "workers": 2}

    def interrupted(function, pieces):
        yield from map(function, pieces[:20])
        raise KeyboardInterrupt

    tracemalloc.start()
    with pytest.raises(KeyboardInterrupt):
        swept(k=k, b=b, resume=tmp_path / "a", **{**given, "workers": interrupted})
    whole = swept(k=k, b=b, resume=tmp_path / "a", **given)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 60e6  # the result takes 8, what the file had 8
    assert (tmp_path / "a").stat().st_size < 8e6 + 20_000
    for i, j in np.random.default_rng(2).integers(0, 1000, (20, 2)):
        assert swept(k=k[i], b=b[j], **given) == whole[i, j]


@pytest.mark.slow
def test_a_pool_of_processes():
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
        np.testing.assert_array_equal(swept(workers=pool.map), swept())
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        np.testing.assert_array_equal(swept(workers=pool.imap_unordered), swept())


def test_workers_import_nothing_from_the_working_folder(tmp_path):
    """A folder of data may hold a random.py or a pickle.py; neither new processes nor copies of this one take them."""
    script, folder = tmp_path / "script.py", tmp_path / "data"
    folder.mkdir()
    for name in ("random", "pickle", "socket"):
        (folder / f"{name}.py").write_text("raise SystemExit('imported from the working folder')")
    script.write_text(
        "import operator\nfrom hapticlab.analysis.sweeps.forked_workers import shared_out\n"
        "from hapticlab.analysis.sweeps.workers import spread\n"
        "if __name__ == '__main__':\n"
        "    print(sorted(spread(abs, [-1, -2], 2, threads=False)))\n"
        "    with shared_out(10, 2) as share:\n        print(list(share(operator.add, [1, 2])))\n"
    )
    path = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, env=path, cwd=folder)
    assert done.stdout.splitlines() == ["[1, 2]", "[11, 12]"], done.stderr


@pytest.mark.slow
def test_a_script_without_a_guard_is_told(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import hapticlab as hl\npaddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)\n"
        "hl.sweep(hl.wall(), paddle, engine='interpreter', workers=2, duration=0.05, k=[float(a) for a in range(200)])\n"
    )
    path = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, env=path)
    assert done.returncode == 1
    assert done.stderr.rstrip().splitlines()[-1].startswith("hapticlab.errors.AnalysisError: the worker processes ended 3")


@pytest.mark.slow  # starting a cluster takes seconds; processes of our own are killed above
def test_a_cluster_survives_a_killed_worker(monkeypatch):
    """A scheduler, a nanny and two worker processes of Dask; the nanny starts the killed one again."""
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(sweep_chunks, "MOST", 20)
    monkeypatch.setattr(sweep_chunks, "FEWEST", 20)
    made = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "memory_limit": 0, "silence_logs": 50}
    given = {"T": 1e-3, "duration": 20.0}
    with distributed.LocalCluster(**made) as cluster, distributed.Client(cluster) as client:
        before = client.run(os.getpid)

        def killing(function, pieces):
            results = client.get_executor().map(function, pieces)
            yield next(results)
            os.kill(next(iter(before.values())), signal.SIGTERM if os.name == "nt" else signal.SIGKILL)
            yield from results

        np.testing.assert_array_equal(swept(workers=killing, **given), swept(**given))
        assert client.run(os.getpid) != before


@pytest.mark.parametrize("before", [{}, {"PYTHONSAFEPATH": "0"}])
def test_only_processes_that_start_meanwhile_are_kept_from_the_working_folder(monkeypatch, before):
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
    for name, value in before.items():
        monkeypatch.setenv(name, value)
    with safe_path():
        assert os.environ["PYTHONSAFEPATH"] == "1"
    assert os.environ.get("PYTHONSAFEPATH") == before.get("PYTHONSAFEPATH")
