"""Ctrl-C: a signal at any time ends the call with KeyboardInterrupt, and no signal is lost."""
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest

import ptriangle

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGALRM"), reason="signals of POSIX")

N = int(os.environ.get("PTRIANGLE_SIGNALS", "20"))
SQUARE = [[0, 0], [4, 0], [4, 3], [0, 3]], [[0, 1], [1, 2], [2, 3], [3, 0]]

LONG = """
    import os, signal, sys, threading, time
    import ptriangle
    import ptriangle.compat
    points, segments = [[0, 0], [4, 0], [4, 3], [0, 3]], [[0, 1], [1, 2], [2, 3], [3, 0]]
    delay, number = float(sys.argv[1]), int(sys.argv[2])
    class Alarm(BaseException): pass
    def ring(*_): raise Alarm
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGALRM, ring)
    try:
        threading.Timer(delay, os.kill, (os.getpid(), number)).start()
        %s
        print("lost")
    except BaseException as fault:
        print(type(fault).__name__)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler, "the handler was not put back"
    assert signal.getsignal(signal.SIGALRM) is ring
"""
WAYS = {
    "one thread": "ptriangle.mesh(points, segments, min_angle=30, max_area=1e-7, threads=1)",
    "two threads": "ptriangle.mesh(points, segments, min_angle=30, max_area=1e-7, threads=2)",
    "size": "ptriangle.mesh(points, segments, min_angle=30, size=lambda x, y: 1e-3)",
    "progress": "ptriangle.mesh(points, segments, max_area=1e-7, progress=lambda done, n: None)",
    "endless callback": "ptriangle.mesh(points, segments, size=lambda x, y: time.sleep(100))",
    "in a callback": "ptriangle.mesh(points, segments, max_area=0.1,"
                     " size=lambda x, y: ptriangle.mesh(points, segments, max_area=1e-7))",
    "refine": "ptriangle.mesh(points, segments).refine(max_area=1e-7)",
    "compat": "ptriangle.compat.triangulate({'vertices': points, 'segments': segments}, 'pq30a0.0000001')",
}


@pytest.fixture(autouse=True)
def heard():
    """A background job of a shell starts with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def ended_by(way, delay, number):
    script = textwrap.dedent(LONG % WAYS[way])
    run = subprocess.run([sys.executable, "-c", script, str(delay), str(int(number))], capture_output=True, text=True,
                         timeout=60)
    assert run.stderr == "" and run.returncode == 0, run.stderr
    return run.stdout.strip()


@pytest.mark.parametrize("way", WAYS)
def test_interrupts(way):
    assert [ended_by(way, 0.1 + 0.013 * k, signal.SIGINT) for k in range(max(1, N // 10))] == (
        ["KeyboardInterrupt"] * max(1, N // 10))


@pytest.mark.parametrize("way", WAYS)
def test_handlers_of_other_signals_may_raise(way):
    assert ended_by(way, 0.15, signal.SIGALRM) == "Alarm"


@pytest.mark.parametrize("threads", [1, 2])
def test_many_interrupts_in_one_process(threads):
    """No signal is lost, and each raises KeyboardInterrupt. The next one is sent as soon as possible."""
    found = []
    for k in range(N):
        timer = threading.Timer(0.02 + 0.0017 * (k % 30), os.kill, (os.getpid(), signal.SIGINT))
        try:
            timer.start()  # which may take as long, on a busy machine
            ptriangle.mesh(*SQUARE, min_angle=30, max_area=1e-7, threads=threads)
            found.append("lost")
        except BaseException as fault:
            found.append(type(fault).__name__)
        timer.join()
    assert found == ["KeyboardInterrupt"] * N


def test_a_handler_that_returns_does_not_end_the_work():
    rung = []
    before = signal.signal(signal.SIGALRM, lambda *_: rung.append(time.monotonic()))
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.05, 0.05)
        m = ptriangle.mesh(*SQUARE, min_angle=30, max_area=1e-5)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert m.check(min_angle=30, max_area=1e-5) and rung


def test_work_in_another_thread_leaves_signals_alone():
    before = signal.getsignal(signal.SIGINT)
    found = []
    worker = threading.Thread(target=lambda: found.append(ptriangle.mesh(*SQUARE, max_area=1e-4)))
    worker.start()
    worker.join()
    assert len(found[0].triangles) > 1000 and signal.getsignal(signal.SIGINT) is before
