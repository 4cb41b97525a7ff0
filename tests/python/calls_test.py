"""Threads, signals and listeners."""
import os
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


def test_ctrl_c_ends_a_call_and_leaves_all_well():
    vertices, faces = waves(300)
    # hours of work; were the interpreter's lock held meanwhile, the timer could not go off
    timer = threading.Timer(0.2, os.kill, [os.getpid(), signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        surfelao.bake(vertices, faces, engine="rays", rays=2**17, check=0)
    timer.join()
    assert surfelao.bake(*box()).occlusion.shape == (8,)


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


# hours of work, unless it is stopped
LONG = """
import sys, threading, time
import surfelao
sys.path.insert(0, {folder!r})
from conftest import waves
vertices, faces = waves(300)
def work():
    surfelao.bake(vertices, faces, engine="rays", rays=2**17, check=0)
{rest}
"""

DAEMON = """
threading.Thread(target=work, daemon=True).start()
time.sleep(0.3)
print("leaving", flush=True)
"""


def long_script(rest):
    folder = __file__.rpartition("/")[0]
    return [sys.executable, "-c", LONG.format(folder=folder, rest=rest)]


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
