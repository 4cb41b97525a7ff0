#!/usr/bin/env python3
"""pcv.py: our occlusion of a cloud and that of CloudCompare's PCV, beside the mesh it was taken from.

    pcv.py BUILD MESH POINTS NOISE normals|none

cloud_tables samples the mesh; `surfelao bake` and `CloudCompare -PCV` (256 rays, under a virtual
display) answer at the same points. PCV draws each point as one pixel: in large pictures it sees
through the cloud, in small ones points hide each other. So it runs at its default size and at three
smaller ones, of which the one counts that is best by its own measure: the share of all directions
of the whole sphere from which a point is seen, without a cosine. Its error is told against that
share, and, scaled to the hemisphere by 2, against the cosine-weighted openness; ours against the
latter. Times are those of whole processes, from file to file. Prints a JSON object. Needs
xvfb-run and CloudCompare (apt-get install cloudcompare xvfb); exit 77 without.
"""

import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

PIXELS = (1024, 512, 384, 256)  # the first is the default
RAYS = 256


def run(*command):
    start = time.monotonic()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout, time.monotonic() - start


def rmse(found, truth):
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(found, truth, strict=True)) / len(truth))


def main(build, mesh, points, noise, normals):
    if not shutil.which("CloudCompare") or not shutil.which("xvfb-run"):
        return 77
    build = pathlib.Path(build)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        cloud, answers = folder / "cloud.ply", folder / "ours.xyz"
        run(build / "bin/cloud_tables", "sample", mesh, points, noise, normals, cloud,
            folder / "truth.txt")
        truth = [[float(word) for word in line.split()]
                 for line in (folder / "truth.txt").read_text().splitlines()]
        cosine, sphere = [1 - row[0] for row in truth], [row[1] for row in truth]
        report, ours_s = run(build / "bin/surfelao", "bake", cloud, "-o", answers, "--check", 0,
                             "--json", "-")
        rows = [line.split() for line in answers.read_text().splitlines() if line[:1] != "#"]
        column = 6 if normals == "normals" else 3  # behind x y z and nx ny nz
        ours = [1 - float(row[column]) for row in rows]
        found = {"points": int(points), "noise": float(noise), "normals": normals == "normals",
                 "ours_s": ours_s, "solve_s": json.loads(report)["seconds"]["solve"],
                 "ours": rmse(ours, cosine), "pcv": []}
        for pixels in PIXELS:
            _, seconds = run("xvfb-run", "-a", "CloudCompare", "-SILENT", "-O", cloud,
                             "-NO_TIMESTAMP", "-C_EXPORT_FMT", "ASC", "-PREC", 9, "-PCV", "-N_RAYS",
                             RAYS, "-RESOLUTION", pixels)
            lines = (folder / "cloud_PCV.asc").read_text().splitlines()
            seen = [float(line.split()[-1]) for line in lines]
            found["pcv"].append({"pixels": pixels, "s": seconds, "own": rmse(seen, sphere),
                                 "cosine": rmse([min(1.0, 2 * share) for share in seen], cosine)})
    print(json.dumps(found))
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 6:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(main(*sys.argv[1:]))
