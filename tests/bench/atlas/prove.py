#!/usr/bin/env python3
"""prove.py: charts of ours beside those of xatlas, on the same surfaces, judged alike.

    prove.py BUILD OUT      writes OUT/atlas.json: per mesh and maker charts, seam length over the
                            root of the area, area stretch (mean and largest), use of the page,
                            seconds; pages of 1024 texels a side, a padding of 4

Exit 1 where ours breaks a promise: seams at most 1.2 times as long as those of xatlas on spot, boat,
stanford_bunny and room, use at least .64 on all that both make. A few minutes, nearly all of them
xatlas (as WebAssembly, one thread), which gets meshes of at most 101,000 triangles. Not part of the
tests: needs nodejs, npm and the network for it; exit 77 where they are absent.
"""

import json
import pathlib
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import measure  # noqa: E402

SIZE = 1024
LARGEST_FOR_XATLAS = 101_000  # triangles; beyond it takes many minutes
HELD = ("spot", "boat", "stanford_bunny", "room")
MOST_SEAMS, LEAST_USE = 1.2, 0.64


def meshes():
    names = ("cornell_box.obj", "gazebo.obj", "spot.obj", "wingnut.obj", "boat.obj", "mountain.obj",
             "stanford_bunny.obj", "skull.obj", "stanford_dragon_res2.ply")
    found = [measure.ROOT / "data/room.obj", measure.ROOT / "data/bracket.obj"]
    found += [measure.SHARED / name for name in names]
    found.append(measure.ROOT / "data/models/engine.glb")
    return [path for path in found if path.exists()]


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    build, out = (pathlib.Path(argument).resolve() for argument in arguments)
    if not shutil.which("npm") or not shutil.which("node"):
        print("needs nodejs and npm", file=sys.stderr)
        return 77
    modules = out / "modules"
    modules.mkdir(parents=True, exist_ok=True)
    subprocess.run(["npm", "install", "--silent", "--prefix", modules, "watlas"], check=True)
    rows = json.loads(measure.run(build / "bin/atlas_tables", SIZE, out / "arrays", *meshes()))
    names = [row["name"] for row in rows]
    judged = json.loads(measure.run("node", HERE / "charts.mjs", modules, out / "arrays", SIZE,
                                    LARGEST_FOR_XATLAS, *names))
    code = 0
    for row in rows:
        ours = {key: row.pop(key) for key in ("charts", "use", "seconds")}
        row["ours"] = {**ours, **judged[row["name"]]["ours"]}
        row["xatlas"] = judged[row["name"]].get("xatlas")
        if not row["xatlas"]:
            continue
        if row["name"] in HELD and row["ours"]["seam"] > MOST_SEAMS * row["xatlas"]["seam"]:
            print(f"{row['name']}: seams are too long", file=sys.stderr)
            code = 1
        if row["ours"]["use"] < LEAST_USE:
            print(f"{row['name']}: too little of the page is used", file=sys.stderr)
            code = 1
    (out / "atlas.json").write_text(json.dumps({"size": SIZE, "rows": rows}))
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
