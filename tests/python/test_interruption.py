"""Progress, signals, threads: who may stop a run, and who runs beside it."""

import multiprocessing
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import hsdm
from conftest import scan_of_torus


@pytest.fixture(scope="module")
def large():
    return scan_of_torus(400000)


def test_progress_tells_phases_and_a_share_that_grows(large):
    calls = []
    hsdm.reconstruct(*large, depth=7, progress=lambda phase, done: calls.append((phase, done)))
    phases, shares = zip(*calls)
    assert all(isinstance(phase, str) and phase for phase in phases)
    assert all(0 <= share <= 1 for share in shares)
    assert list(shares) == sorted(shares) and shares[-1] > 0.5
    assert len(set(phases)) > 3


def test_progress_does_not_change_the_mesh(torus):
    seen = hsdm.reconstruct(*torus, depth=5, progress=lambda *_: True)
    assert seen.digest() == hsdm.reconstruct(*torus, depth=5).digest()


@pytest.mark.parametrize("answer", [False, 0, np.False_])
def test_false_cancels(torus, answer):
    calls = []
    with pytest.raises(hsdm.Cancelled):
        hsdm.reconstruct(*torus, depth=5, progress=lambda *call: calls.append(call) or answer)
    assert len(calls) == 1


def test_what_progress_raises_goes_through(torus):
    class Own(Exception):
        pass

    def progress(phase, done):
        raise Own(phase)

    with pytest.raises(Own) as caught:
        hsdm.reconstruct(*torus, depth=5, progress=progress)
    assert caught.traceback[-1].name == "progress"
    with pytest.raises(TypeError):
        hsdm.reconstruct(*torus, depth=5, progress=lambda: True)
    with pytest.raises(ValueError, match="ambiguous"):
        hsdm.reconstruct(*torus, depth=5, progress=lambda *_: np.zeros(2))


def test_a_cancelled_run_leaves_the_next_one_as_it_was(torus):
    with pytest.raises(hsdm.Cancelled):
        hsdm.reconstruct(*torus, depth=5, progress=lambda _, done: done < 0.5)
    assert hsdm.reconstruct(*torus, depth=5).topology()["closed"]


def test_progress_must_not_reconstruct(torus):
    with pytest.raises(RuntimeError, match="progress called back into hsdm"):
        hsdm.reconstruct(*torus, depth=5, progress=lambda *_: hsdm.reconstruct(*torus, depth=3))


class Stopped(Exception):
    pass


def test_a_signal_handlers_exception_ends_the_run_within_a_second(large):
    def stop(signum, frame):
        raise Stopped(time.monotonic())

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(Stopped) as caught:
            hsdm.reconstruct(*large, depth=10)
        assert time.monotonic() - caught.value.args[0] < 1
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


CTRL_C = """
import sys, time
import numpy as np
import hsdm
points = np.random.default_rng(1).normal(size=(400000, 3))
points /= np.linalg.norm(points, axis=1)[:, None]
print("ready", flush=True)
try:
    hsdm.reconstruct(points, points, depth=10)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def test_ctrl_c_raises_keyboard_interrupt_within_a_second():
    with subprocess.Popen([sys.executable, "-c", CTRL_C], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        assert process.stdout.readline() == "interrupted\n"
        assert time.monotonic() - begun < 1
        assert process.wait(10) == 0


def test_other_threads_run_meanwhile(large):
    ticks = []
    done = threading.Event()

    def tick():
        while not done.wait(0.005):
            ticks.append(time.monotonic())

    ticker = threading.Thread(target=tick)
    ticker.start()
    begun = time.monotonic()
    hsdm.reconstruct(*large, depth=7)
    ended = time.monotonic()
    done.set()
    ticker.join()
    # With the lock held there would be none.
    assert sum(begun < t < ended for t in ticks) > 5


def test_several_threads_reconstruct_at_a_time_and_get_the_same_bits(torus):
    digests, calls = [], []

    def work():
        mesh = hsdm.reconstruct(*torus, depth=5, progress=lambda *call: calls.append(call))
        digests.append(mesh.digest())

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert digests == [hsdm.reconstruct(*torus, depth=5).digest()] * 4
    assert calls


def test_progress_of_another_thread_cancels_its_own_run_alone(torus):
    failures = []

    def work():
        try:
            hsdm.reconstruct(*torus, depth=5, progress=lambda *_: False)
        except hsdm.Cancelled as error:
            failures.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    mesh = hsdm.reconstruct(*torus, depth=5)
    thread.join()
    assert len(failures) == 1 and mesh.topology()["closed"]


def digest_of(seed):
    return hsdm.reconstruct(*scan_of_torus(5000, seed), depth=4).digest()


def test_meshes_come_from_processes_that_are_spawned():
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert pool.map(digest_of, [1, 2]) == [digest_of(1), digest_of(2)]
