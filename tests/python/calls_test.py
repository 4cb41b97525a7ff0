"""Threads, signals and listeners."""
import signal
import subprocess
import sys
import threading
import time

import numpy
import pytest
import surfelao
from conftest import box, waves


def test_several_threads_solve_with_one_mesh():
    vertices, faces = waves(60)
    prepared = surfelao.prepare(vertices, faces)
    expected, _ = prepared.solve()
    results = [None] * 4

    def solve(i):
        results[i] = prepared.solve()[0]

    threads = [threading.Thread(target=solve, args=[i]) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(numpy.array_equal(result, expected) for result in results)


def test_threads_do_not_change_bytes():
    vertices, faces = waves(40)
    one = surfelao.bake(vertices, faces, threads=1)
    assert one.report["settings"]["threads"] == 1
    assert numpy.array_equal(one.occlusion, surfelao.bake(vertices, faces).occlusion)


def test_the_lock_is_released_while_the_engine_works():
    vertices, faces = waves(100)
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    surfelao.bake(vertices, faces, engine="rays", rays=64, check=0)
    after = counted[0]
    stop.set()
    thread.join()
    assert after > before


def test_progress_is_told_in_the_calling_thread():
    told = []
    vertices, faces = waves(100)
    surfelao.bake(vertices, faces, engine="rays", rays=128, check=0,
                  progress=lambda stage, done: told.append((stage, done, threading.get_ident())))
    assert told and {ident for _, _, ident in told} == {threading.get_ident()}
    shares = [done for stage, done, _ in told if stage == "solve"]
    assert shares and shares == sorted(shares) and 0 <= shares[0] and shares[-1] <= 1


def test_progress_stops_the_call():
    vertices, faces = waves(150)
    with pytest.raises(surfelao.Cancelled):
        surfelao.bake(vertices, faces, engine="rays", rays=2**14, progress=lambda *_: False)
    with pytest.raises(ZeroDivisionError):
        surfelao.bake(vertices, faces, engine="rays", rays=2**14, progress=lambda *_: 1 / 0)
    with pytest.raises(TypeError, match="progress must be None or callable"):
        surfelao.bake(vertices, faces, progress=1)


# what stops must take minutes otherwise: no machine is too fast or too slow for the test
LONG = """
import sys, threading, time
import numpy, surfelao
sys.path.insert(0, {folder!r})
from conftest import waves
vertices, faces = waves(300)
def work():
    surfelao.bake(vertices, faces, engine="rays", rays=2**17, check=0)
{rest}
"""

INTERRUPTED = """
print("ready", flush=True)
try:
    work()
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
    occlusion = surfelao.bake([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).occlusion
    print("alive", occlusion.shape, flush=True)
"""

DAEMON = """
threading.Thread(target=work, daemon=True).start()
time.sleep(0.3)
print("leaving", flush=True)
"""


def long_script(rest):
    folder = __file__.rpartition("/")[0]
    return [sys.executable, "-c", LONG.format(folder=folder, rest=rest)]


def test_ctrl_c_raises_keyboard_interrupt_and_leaves_all_well():
    with subprocess.Popen(long_script(INTERRUPTED), stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=60)
    assert output.splitlines()[0].startswith("interrupted")
    assert output.splitlines()[1] == "alive (3,)"
    assert process.returncode == 0


def test_an_unhandled_ctrl_c_ends_the_script():
    script = long_script("print('ready', flush=True)\nwork()")
    with subprocess.Popen(script, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=60)
    assert error.rstrip().endswith("KeyboardInterrupt")
    assert process.returncode == -signal.SIGINT


def test_the_interpreter_ends_while_a_thread_is_at_work():
    process = subprocess.run(long_script(DAEMON), capture_output=True, text=True, timeout=60)
    assert process.stdout == "leaving\n" and process.returncode == 0
