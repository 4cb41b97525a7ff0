#!/usr/bin/env python3
"""What the Python package costs beside the program, and how soon Ctrl-C ends its calls.

    PYTHONPATH=build/release/python python_limits.py build/release/bin/surfelao [SIDE]

A field of SIDE^2 vertices (default 1000). Peak memory of a bake by the program, which reads the mesh
from a PLY, and by the package, beyond the arrays that are there before. Then for each function
SIGINT at several moments: the time until KeyboardInterrupt arrives, of a process that has the machine.
"""
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time

import numpy
import surfelao

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from conftest import waves  # noqa: E402

MOMENTS = (0.1, 0.3, 1.0, 2.0, 4.0)


def write_ply(path, vertices, faces):
    rows = numpy.zeros(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, faces
    head = ("ply\nformat binary_little_endian 1.0\n"
            f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    path.write_bytes(head.encode() + vertices.tobytes() + rows.tobytes())


def megabytes_now():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() / 1e6


def memory(program, vertices, faces):
    with tempfile.TemporaryDirectory() as folder:
        mesh, out, report = [pathlib.Path(folder) / name for name in ("in.ply", "out.ply", "report.json")]
        write_ply(mesh, vertices, faces)
        subprocess.run([program, "bake", mesh, "-o", out, "--check", "0", "--json", report], check=True,
                       stdout=subprocess.DEVNULL)
        of_program = json.loads(report.read_text())["peak_rss_bytes"] / 1e6
    before = megabytes_now()
    baked = surfelao.bake(vertices, faces, check=0)
    of_package = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3 - before
    before = megabytes_now()
    views = [baked.occlusion, baked.bent_normals]
    print(f"{len(vertices)} vertices: the program's peak {of_program:.0f} MB; the package's "
          f"{of_package:.0f} MB beyond its arrays; {len(views)} views of the results "
          f"{megabytes_now() - before:.1f} MB")


def wait_for_interrupt(call, moment):
    """Seconds from the signal to KeyboardInterrupt; None where the call is done before."""
    sent = []

    def interrupt():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(moment, interrupt)
    try:
        timer.start()
        call()
        timer.cancel()
        timer.join()
        time.sleep(0.1)  # one that was on its way arrives here
        return None
    except KeyboardInterrupt:
        return time.monotonic() - sent[0] if sent else None
    finally:
        timer.join()


def interrupts(vertices, faces):
    prepared = surfelao.prepare(vertices, faces)
    calls = {
        "bake": lambda: surfelao.bake(vertices, faces, quality=4),
        "bake, rays": lambda: surfelao.bake(vertices, faces, engine="rays", rays=4096),
        "texture": lambda: surfelao.texture(vertices, faces, size=4096),
        "cloud": lambda: surfelao.cloud(vertices),
        "prepare": lambda: surfelao.prepare(vertices, faces),
        "solve": lambda: prepared.solve(quality=4),
        "compare": lambda: surfelao.compare(vertices, faces),
    }
    for name, call in calls.items():
        waits = []
        for moment in MOMENTS:
            wait = wait_for_interrupt(call, moment)
            waits.append("done" if wait is None else f"{wait:.3f}")
            time.sleep(4)  # what was stopped ends
        print(f"{name:12}", *waits)


def main():
    vertices, faces = waves(int(sys.argv[2]) if len(sys.argv) > 2 else 1000)
    memory(sys.argv[1], vertices, faces)
    print("seconds from Ctrl-C to KeyboardInterrupt, sent after", *MOMENTS)
    interrupts(vertices, faces)


if __name__ == "__main__":
    main()
