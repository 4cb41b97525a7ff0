#!/usr/bin/env python3
"""prove.py: our maps and Blender's, of the same coordinates and normals, judged by the same rays.

    prove.py BUILD OUT [--keep] [--size N] NAME=MESH...

Each mesh is written as an OBJ with our corner normals and with charts of our own, NAME@file with the
file's own coordinates. From it `surfelao bake` (masks, good) and Blender's Cycles (64 samples a
texel, two threads, blender_bake.py) make a map of N x N floats (1024), and map_tables says how far
what each displays is off at 20,000 points of the surface. Both bakes run one after the other, so that
their ratio of times means something on a quiet machine; ours is raster, structures, solving and
filling, Blender's the bake call. --keep takes what is in OUT from before, without times.

At last ours alone at 4096 x 4096: time and memory. Writes OUT/maps.json. Twenty minutes on two cores,
nearly all of it Blender's. Needs blender (apt-get install blender); exit 77 without it.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SAMPLES, THREADS, LARGE = 64, 2, 4096
STAGES = ("raster", "surfels", "tree", "solve", "fill")
LARGE_ONES = 1  # models of which the large map is made, those with the most triangles


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def bake_ours(build, mesh, out, size):
    """The report of the bake, and the seconds of what Blender's bake call does too."""
    report = json.loads(run(build / "bin/surfelao", "bake", mesh, "-o", out, "--size", size,
                            "--threads", THREADS, "--check", 0, "--json", "-"))
    return report, sum(report["seconds"][stage] for stage in STAGES)


def bake_blender(mesh, out, size):
    text = run("blender", "-b", "--factory-startup", "--python-exit-code", 1, "--python",
               HERE / "blender_bake.py", "--", mesh, out, size, SAMPLES, THREADS)
    return json.loads(re.search(r"^BAKED (.*)$", text, re.M).group(1))


def compared(build, out, name, path, size, keep):
    """One row: what both display, and their times."""
    mesh, ours, theirs = (out / f"{name.replace('/', '_')}{end}"
                          for end in (".obj", ".ours.exr", ".blender.exr"))
    own = name.endswith("@file")
    if not (keep and mesh.exists()):
        run(build / "bin/map_tables", "write", path, mesh, *([] if own else [size]))
    report, seconds = bake_ours(build, mesh, ours, size)
    row = {"name": name.removesuffix("@file"), "uvs": "file" if own else "new",
           "triangles": report["triangles"], "covered": report["texels"]["covered"] / size**2}
    if not (keep and theirs.exists()):
        blender = bake_blender(mesh, theirs, size)
        row["times_ratio"] = blender["seconds"] / seconds
        row["turned_deg"] = blender["turned_deg"]
    judged = json.loads(run(build / "bin/map_tables", "judge", mesh, ours, theirs))
    row.update({key: judged[key] for key in ("points", "ill_defined", "hidden")})
    row["ours"], row["blender"] = judged["maps"]
    return row


def large_map(build, out, name):
    report, seconds = bake_ours(build, out / f"{name.replace('/', '_')}.obj", out / "large.exr", LARGE)
    (out / "large.exr").unlink()
    return {"name": name, "size": LARGE, "covered": report["texels"]["covered"] / LARGE**2,
            "seconds": seconds, "mib": report["peak_rss_bytes"] / 2**20}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("meshes", nargs="+", metavar="NAME=MESH")
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--size", type=int, default=1024)
    options = parser.parse_args()
    if not shutil.which("blender"):
        print("prove.py: no blender", file=sys.stderr)
        return 77
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for name, path in (word.split("=", 1) for word in options.meshes):
        rows.append(compared(options.build, options.out, name, path, options.size, options.keep))
        print(f"  {name}: ours {rows[-1]['ours']['rmse']:.4f}, "
              f"Blender's {rows[-1]['blender']['rmse']:.4f}", file=sys.stderr, flush=True)
    by_triangles = sorted((row for row in rows if row["uvs"] == "new"), key=lambda row: -row["triangles"])
    shown = {"size": options.size, "samples": SAMPLES, "rows": rows,
             "large": [large_map(options.build, options.out, row["name"])
                       for row in by_triangles[:LARGE_ONES]]}
    (options.out / "maps.json").write_text(json.dumps(shown, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
