#!/usr/bin/env python3
"""whole_job.py: what a bake from file to file takes: its stages, processor time, memory.

    whole_job.py BUILD FILE|TRIANGLES...     prints JSON, a row for each
    whole_job.py --make TRIANGLES FILE       the rough one alone

A number of triangles stands for two bumpy tori of about so many, two a vertex, written as binary PLY: one
smooth at the scale of its triangles, as scans are, and one rough there: of 10^7 triangles each
bump is four wide, with slopes of up to 70 degrees, and fewer triangles are noise.
Bakes at good without the check, into a file of the same format. Python 3, standard library only.
"""

import array
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile


def make_torus(triangles, path, rough):
    rows = max(3, round(math.sqrt(triangles / 2 / 1.25)))
    columns = max(3, round(triangles / 2 / rows))
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {rows * columns}\n"
                   "property float x\nproperty float y\nproperty float z\n"
                   f"element face {2 * rows * columns}\nproperty list uchar int vertex_indices\n"
                   "end_header\n".encode())
        for row in range(rows):
            v = 2 * math.pi * row / rows
            places = array.array("f")
            for column in range(columns):
                u = 2 * math.pi * column / columns
                r = .35 + .03 * math.sin(23 * u) * math.cos(17 * v) + .01 * math.sin(91 * u + 3 * v)
                if rough:
                    r += .002 * math.sin(611 * u) * math.sin(517 * v)
                ring = 1 + r * math.cos(v)
                places.extend((ring * math.cos(u), ring * math.sin(u), r * math.sin(v)))
            places.tofile(file)
        pack = struct.Struct("<BiiiBiii").pack
        for row in range(rows):
            low, high = row * columns, (row + 1) % rows * columns
            file.write(b"".join(
                pack(3, low + c, low + (c + 1) % columns, high + (c + 1) % columns,
                     3, low + c, high + (c + 1) % columns, high + c) for c in range(columns)))


def bake(program, path, name, folder):
    report = folder / "report.json"
    process = subprocess.Popen([program, "bake", path, "-o", folder / f"baked{path.suffix}",
                                "--check", "0", "--json", report],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise RuntimeError(f"{name} was not baked")
    told = json.loads(report.read_text())
    seconds = told["seconds"]
    return {"name": name, "bytes": path.stat().st_size, "triangles": told["triangles"],
            **{stage: seconds[stage] for stage in ("read", "tree", "solve", "fit", "write", "total")},
            "user": usage.ru_utime, "system": usage.ru_stime,
            "bytes/triangle": told["peak_rss_bytes"] / told["triangles"]}


def measure(build, meshes):
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program = pathlib.Path(build) / "bin/surfelao"
        for mesh in meshes:
            if not mesh.isdigit():
                rows.append(bake(program, pathlib.Path(mesh), pathlib.Path(mesh).stem, folder))
                continue
            for rough in (False, True):
                make_torus(int(mesh), folder / "torus.ply", rough)
                label = f"{'rough' if rough else 'smooth'} torus, {int(mesh):,} triangles"
                rows.append(bake(program, folder / "torus.ply", label, folder))
    return rows


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    if sys.argv[1] == "--make":
        make_torus(int(sys.argv[2]), sys.argv[3], True)
    else:
        print(json.dumps(measure(sys.argv[1], sys.argv[2:]), indent=1))
