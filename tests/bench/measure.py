#!/usr/bin/env python3
"""measure.py: what README.md and docs/ tell in figures, measured anew into docs/figures/*.json.

    measure.py BUILD [PART...]      parts: frontier frontier_avx2 scaling stability gpu drawing
                                    readers foreign stated family demo viewers atlas maps
                                    map_frontier clouds clouds_pcv subdivide pixels origin cubes
                                    screen moving grids gridpictures whole_job;
                                    default: all, about an hour on two quiet cores

Every part is one file that says what command made it, of which version and commit, on what
processor and how many threads; never a host name or a path. A part whose models are absent keeps
its file and says so. The pages are filled from the files by docs/fill_figures.py.

Models: data/*, the Debian packages' (data/fetch.sh), and the folder SURFELAO_MODELS, by default
../shared/models beside the project (docs/measurements.md names them). Variables for a short trial:
SURFELAO_TRIAL=1 takes the smallest scenes and settings, and writes to out/trial/ instead.
Python 3, standard library only.
"""

import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import pixel_origin  # noqa: E402
import whole_job  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TRIAL = bool(os.environ.get("SURFELAO_TRIAL"))
FIGURES = ROOT / ("out/trial" if TRIAL else "docs/figures")
SHARED = pathlib.Path(os.environ.get("SURFELAO_MODELS") or ROOT / "../shared/models")

SHARED_MODELS = (  # from small to large
    "cornell_box.obj", "gazebo.obj", "spot.obj", "wingnut.obj", "pine/scene.gltf", "retroufo.gltf",
    "boat.obj", "mountain.obj", "stanford_bunny.obj", "skull.obj", "FlightHelmet/FlightHelmet.gltf",
    "pandora.obj", "stanford_dragon_res2.ply")
PACKAGE_MODELS = ("bunny.obj", "engine.glb")
DATA_MODELS = ("blob.off", "blocks.ply", "bracket.obj", "leaves.glb", "room.obj", "shells.stl")

LARGEST_ON_GPU = 30_000  # vertices: software OpenGL takes minutes for a model beyond
SAMPLE = 300 if TRIAL else 20_000  # points of the surface
ROUNDS = 3


class Absent(Exception):
    """What a part needs is not on this machine."""


# ---- models


def models():
    """[(path, name, group)], packaged, shared, committed ones."""
    if TRIAL:
        return [(ROOT / "data/bracket.obj", "data/bracket.obj", "data")]
    found = [(ROOT / "data/models" / file, file.split(".")[0], "package") for file in PACKAGE_MODELS]
    for file in SHARED_MODELS:
        name = pathlib.Path(file).stem if not file.endswith("/scene.gltf") else file.split("/")[0]
        found.append((SHARED / file, name, "shared"))
    found += [(ROOT / "data" / file, f"data/{file}", "data") for file in DATA_MODELS]
    absent = [name for path, name, _ in found if not path.exists()]
    if absent:
        raise Absent(f"no {', '.join(absent)} (SURFELAO_MODELS, data/fetch.sh)")
    return found


# ---- running and writing


def run(*command, shown=None):
    """Standard output; what the command says on standard error goes to the terminal."""
    command = [str(word) for word in command]
    print("  " + (shown or " ".join(command)).replace(f"{ROOT}/", ""), file=sys.stderr, flush=True)
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True, cwd=ROOT).stdout


def processor():
    """The model's name and the widest vectors, as far as the system tells."""
    try:
        text = pathlib.Path("/proc/cpuinfo").read_text()
    except OSError:
        return "unknown"
    name = re.search(r"^model name\s*:\s*(.*)$", text, re.M)
    name = re.sub(r"\((R|TM)\)| Processor| CPU|@.*", "", name.group(1) if name else "unknown").strip()
    vectors = "AVX-512" if " avx512bw" in text else "AVX2" if " avx2" in text else "SSE"
    return f"{name}, {vectors}"


def provenance(build, command, **others):
    git = ["git", "-C", str(ROOT)]
    commit = subprocess.run([*git, "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    changes = subprocess.run([*git, "status", "--porcelain", "--", ":!docs", ":!*.md"],
                             capture_output=True, text=True)
    return {"command": command,
            "commit": (commit.stdout.strip() or "no commit") + ("+" if changes.stdout else ""),
            "version": subprocess.run([build / "bin/surfelao", "--version"], capture_output=True,
                                      text=True, check=True).stdout.split()[1],
            "processor": processor(), "threads": len(os.sched_getaffinity(0)), **others}


def rounded(value):
    """Five digits: a text shows four at most, and a file that is read by people stays short."""
    if isinstance(value, float):
        return float(f"{value:.5g}")
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    return [rounded(item) for item in value] if isinstance(value, list) else value


def holds_objects(value):
    if isinstance(value, dict):
        return True
    return isinstance(value, list) and any(map(holds_objects, value))


def dump(value, indent=0):
    """JSON with a line for each object without objects in it: one row of a table is one line."""
    items = list(value.values() if isinstance(value, dict) else value) \
        if isinstance(value, (dict, list)) else []
    text = isinstance(value, list) and len(items) > 3 and all(isinstance(x, str) for x in items)
    if not items or not (indent == 0 or text or any(map(holds_objects, items))):
        return json.dumps(value, ensure_ascii=False)
    space = " " * (indent + 1)
    if isinstance(value, dict):
        parts = [f"{json.dumps(key)}: {dump(item, indent + 1)}" for key, item in value.items()]
    else:
        parts = [dump(item, indent + 1) for item in items]
    left, right = "{}" if isinstance(value, dict) else "[]"
    return left + "\n" + ",\n".join(space + part for part in parts) + "\n" + " " * indent + right


def write(path, figures):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(dump(rounded(figures)) + "\n")


def number(cell):
    """A cell of a table: a number where it is one, None where it is empty or a dash."""
    cell = cell.strip()
    if cell in ("", "-"):
        return None
    try:
        return int(cell) if re.fullmatch(r"\d+", cell) else float(cell)
    except ValueError:
        return cell


def tables_of(text):
    """Every Markdown table of a text: [[{column: value}]]."""
    tables, head = [], None
    for line in text.splitlines():
        if not line.startswith("|"):
            head = None
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if head is None:
            head = cells
            tables.append([])
        elif not set(line) <= set("|- "):
            tables[-1].append({name: number(cell) for name, cell in zip(head, cells)})
    return tables


# ---- parts: each returns what its file holds


def compare(build, path, *options):
    """The JSON of `surfelao compare`, and its command without the path."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "compare.json"
        words = [str(word) for word in options]
        shown = f"surfelao compare MODEL {' '.join(words)}"
        run(build / "bin/surfelao", "compare", path, *words, "-o", folder, "--json", file, shown=shown)
        return json.loads(file.read_text()), shown


def flat(row):
    """A row without what a page never shows; row["seen"]["rmse"] is flat["seen_rmse"]."""
    result = {}
    for key, value in row.items():
        if key in ("seen", "solve"):
            result.update({f"{key}_{name}": error for name, error in value.items()})
        elif key not in ("settings", "worst", "rounds"):
            result[key] = value
    return result


def condensed(scene, name, group):
    """A scene of the frontier without what a page never shows."""
    rows = [flat(row) for row in scene["rows"]]
    build_s = {row["engine"]: row["build_s"] for row in rows if row["setting"] in ("good", "64 rays")}
    return {"name": name, "group": group, "vertices": scene["vertices"],
            "triangles": scene["triangles"], "receivers": scene["receivers"],
            "reference": scene["reference"], "floor": scene["floor"],
            "build_over_embree": build_s["masks"] / build_s["rays"] if build_s.get("rays") else None,
            "ratios": scene["ratios"], "rows": rows}


def frontier(build, *options):
    """Scene by scene: all engines of one take turns in one process."""
    scenes = []
    for path, name, group in models():
        start = time.monotonic()
        result, command = compare(build, path, "--frontier", *options, "--sample", SAMPLE,
                                  "--rounds", ROUNDS)
        scenes.append(condensed(result["scenes"][0], name, group))
        print(f"    {name}: {time.monotonic() - start:.0f} s", file=sys.stderr, flush=True)
    return {**provenance(build, command), "scenes": scenes}


def part_frontier(build):
    return frontier(build, "--engines", "masks,disks")


def part_frontier_avx2(build):
    return {**frontier(build, "--engines", "masks", "--avx2"),
            "processor": processor().replace("AVX-512", "AVX2")}


def part_scaling(build):
    sizes = ["10000", "30000"] if TRIAL else ["10000", "100000", "1000000"]
    result = provenance(build, f"scaling masks|disks {' '.join(sizes)}", threads=1)
    for engine in ("masks", "disks"):
        text = run(build / "bin/scaling", engine, *sizes)
        result[engine] = {"exponent": float(re.search(r"vertices\^([\d.]+)", text).group(1)),
                          "rows": tables_of(text)[0]}
    return result


def part_whole_job(build):
    sizes = ["20000"] if TRIAL else ["200000", "1000000", "10000000"]
    files = [] if TRIAL else [SHARED / "stanford_dragon_res2.ply", SHARED / "skull.obj"]
    if absent := [file.stem for file in files if not file.exists()]:
        raise Absent(f"no {', '.join(absent)} (SURFELAO_MODELS)")
    return {**provenance(build, f"whole_job.py {' '.join([*(file.stem for file in files), *sizes])}"),
            "rows": whole_job.measure(build, [*map(str, files), *sizes])}


def part_stability(build):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "stability.json"
        words = ["--quick", "sheets", "creases"] if TRIAL else []
        run(build / "bin/stability", *words, "--json", file, shown=" ".join(["stability", *words]))
        return {**provenance(build, "stability"), **json.loads(file.read_text())}


def part_gpu(build):
    chosen = [(path, name) for path, name, _ in models()]
    limits = ["--largest", 11_000, "--largest-masks", 1] if TRIAL else \
        ["--largest", 400_000, "--largest-masks", 11_000]
    text = run(build / "bin/gpu_tables", "--backend", "egl", *limits)
    device = re.search(r"^GPU: (.*?)(?:, | \().*$", text, re.M).group(1)
    grids, bodies = tables_of(text)
    rows = []
    for path, name in chosen:
        info = json.loads(run(build / "bin/surfelao", "info", path, "--json", "-"))
        if info["vertices"] > LARGEST_ON_GPU:
            continue
        scene, command = compare(build, path, "--engines", "masks", "--devices", "cpu,gpu",
                                 "--qualities", "good", "--rounds", "1", "--sample", SAMPLE)
        row = {"scene": name, "vertices": scene["vertices"]}
        for line in scene["rows"]:
            if line["engine"] == "masks":
                row[line["settings"]["device"]] = {key: line[key]["rmse"] for key in ("seen", "solve")}
        text = run(build / "bin/gpu_tables", "--backend", "egl", "--largest-masks", LARGEST_ON_GPU, path)
        for line in tables_of(text)[0]:
            row[line["engine"]] = {key: line[key] for key in
                                   ("speed GPU / CPU", "RMS difference", "largest")}
        rows.append(row)
    return {**provenance(build, f"gpu_tables; {command}"), "device": device,
            "grids": grids, "bodies": bodies, "models": rows}


def part_drawing(build):
    text = run(build / "bin/drawing_tables", "egl")
    return {**provenance(build, "drawing_tables"),
            "device": re.search(r"^Device: (.*?)(?:, | \().*$", text, re.M).group(1),
            "rows": tables_of(text)[0]}


def part_readers(build):
    if not pathlib.Path("/usr/share/assimp/models/glTF2").exists():
        raise Absent("no package assimp-testmodels")
    baked, refused = tables_of(run(ROOT / "tests/odd_files.sh", build / "bin/surfelao"))
    return {**provenance(build, "tests/odd_files.sh"), "baked": baked, "refused": refused}


def part_foreign(build):
    if not pathlib.Path("/usr/share/assimp/models/FBX").exists():
        raise Absent("no package assimp-testmodels")
    return {**provenance(build, "tests/bench/foreign_formats.py"),
            **json.loads(run(ROOT / "tests/bench/foreign_formats.py", build))}


def check_share(build, path):
    """Time of a bake with its statement over that of the rest of it, the median of several."""
    shares = []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(2 if TRIAL else 9):
            text = run(build / "bin/surfelao", "bake", path, "-o", pathlib.Path(folder) / "baked.ply",
                       "--json", "-")
            seconds = json.loads(text)["seconds"]
            shares.append(seconds["check"] / (seconds["total"] - seconds["check"]))
    return statistics.median(shares)


def part_stated(build):
    words = ["0", "61"] if TRIAL else []
    rows = json.loads(run(build / "bin/stated_tables", *words))
    costs = [{"name": name, "triangles": json.loads(run(build / "bin/surfelao", "info", path, "--json",
                                                        "-"))["triangles"],
              "share": check_share(build, path)} for path, name, _ in models()]
    return {**provenance(build, "stated_tables"), "bakes": rows, "costs": costs}


FAMILY_LIMITS = {"none": [], "3 %": ["--limit", 3], "10 %": ["--limit", 10], "30 %": ["--limit", 30],
                 "10 %, smooth": ["--limit", 10, "--smooth"]}


def part_family(build):
    """Solve errors of masks over the family of generated scenes, and over the models."""
    scenes = ["0", "61"] if TRIAL else ["0", "1"]
    files = [f"{name}={path}" for path, name, _ in models()]
    return {**provenance(build, "family_tables"),
            "limits": {limit: json.loads(run(build / "bin/family_tables", *words, *scenes, *files,
                                             shown=f"family_tables, limit {limit}"))
                       for limit, words in FAMILY_LIMITS.items()}}


def part_demo(build):
    if not (ROOT / "data/models/bunny.obj").exists():
        raise Absent("no data/models/bunny.obj (data/fetch.sh)")
    text = run(ROOT / "data/demo.sh", build / "bin/surfelao", ROOT / "data/models", ROOT / "out/demo")
    return {**provenance(build, "run demo"), "lines": text.replace(f"{ROOT}/", "").splitlines()}


def part_viewers(build):
    """What was shown before (another version of the program: prove.py --before) stays as it is."""
    out = ROOT / "out/viewers"
    try:
        run(ROOT / "tests/bench/viewers/prove.py", build / "bin/surfelao", out)
    except subprocess.CalledProcessError as fault:
        if fault.returncode == 77:
            raise Absent("no Blender, chromium or Godot") from fault
        raise
    shown = json.loads((out / "viewers.json").read_text())
    old = json.loads((ROOT / "docs/figures/viewers.json").read_text())
    shown["formats"] += [row for row in old["formats"] if row["when"] == "before"]
    return {**provenance(build, "tests/bench/viewers/prove.py"), "before": old["before"], **shown}


SUBDIVIDED = ("cornell_box", "gazebo", "boat", "data/room.obj", "data/blob.off")


def part_subdivide(build):
    """Coarse meshes as they are and by --subdivide, and what a second run over the result adds."""
    rows = []
    for path, name, _ in models():
        if not TRIAL and name not in SUBDIVIDED:
            continue
        with tempfile.TemporaryDirectory() as folder:
            bakes, source = [], path
            for turn in range(2):
                result = pathlib.Path(folder) / f"{turn}{pathlib.Path(path).suffix}"
                text = run(build / "bin/surfelao", "bake", source, "-o", result, "--subdivide",
                           "--check", "0", "--json", "-")
                bakes.append(json.loads(text))
                source = result
        row = {"name": name, "seconds": bakes[0]["seconds"]["subdivide"],
               "again": bakes[1]["vertices"] / bakes[0]["vertices"] - 1}
        for key, options in (("plain", []), ("cut", ["--subdivide"])):
            told, command = compare(build, path, "--engines", "masks", "--qualities", "good,best",
                                    "--rounds", "1", "--sample", SAMPLE, *options)
            row[key] = {"vertices": told["vertices"], "floor": told["floor"]["rmse"],
                        "good": told["rows"][0]["seen"]["rmse"], "best": told["rows"][1]["seen"]["rmse"]}
        rows.append(row)
    return {**provenance(build, command), "rows": rows}


def part_atlas(build):
    out = ROOT / "out/atlas"
    try:
        run(ROOT / "tests/bench/atlas/prove.py", build, out)
    except subprocess.CalledProcessError as fault:
        if fault.returncode == 77:
            raise Absent("no npm") from fault
        raise
    return {**provenance(build, "tests/bench/atlas/prove.py"),
            **json.loads((out / "atlas.json").read_text())}


MAP_SIZE = 128 if TRIAL else 1024
FRONTIER_SIZE = 128 if TRIAL else 512  # Embree answers at each texel with up to a thousand rays
NO_MAPS = ("pine", "pandora")  # leaves that are no sheets; a level that is closed but for its sky


def map_models():
    return [(path, name, group) for path, name, group in models()
            if name not in NO_MAPS and (group != "data" or TRIAL or name == "data/room.obj")]


def part_maps(build):
    """Errors of an earlier run stay true with SURFELAO_KEEP=1, which takes no times."""
    out = ROOT / "out/maps"
    words = [f"{name}={path}" for path, name, _ in map_models()]
    words += [f"{name}@file={path}" for path, name, _ in map_models() if name == "spot"]
    keep = ["--keep"] if os.environ.get("SURFELAO_KEEP") else []
    try:
        run(ROOT / "tests/bench/maps/prove.py", build, out, "--size", MAP_SIZE, *keep, *words,
            shown="tests/bench/maps/prove.py")
    except subprocess.CalledProcessError as fault:
        if fault.returncode == 77:
            raise Absent("no Blender") from fault
        raise
    return {**provenance(build, "tests/bench/maps/prove.py"),
            **json.loads((out / "maps.json").read_text())}


def part_map_frontier(build):
    """The same maps by all qualities and by Embree."""
    scenes = []
    for path, name, group in map_models():
        result, command = compare(build, path, "--frontier", "--at", "texels", "--size", FRONTIER_SIZE,
                                  "--uv", "new", "--engines", "masks", "--sample", SAMPLE,
                                  "--rounds", ROUNDS)
        scenes.append(condensed(result["scenes"][0], name, group))
    return {**provenance(build, command), "scenes": scenes}


CLOUD_MODELS = ("bunny", "stanford_bunny", "spot", "skull", "stanford_dragon_res2", "data/blob.off")
THIN_MODEL = "FlightHelmet"
LARGE_CLOUD = 20_000 if TRIAL else 1_000_000


def part_clouds(build):
    """Clouds sampled from closed scans, from thin layers, and of generated scenes; a large one."""
    tables = build / "bin/cloud_tables"
    paths = {name: path for path, name, _ in models()}
    names = list(paths) if TRIAL else CLOUD_MODELS
    count = 2_000 if TRIAL else 50_000
    rows = json.loads(run(tables, "rows", count, *[paths[name] for name in names]))
    for row, name in zip(rows, [name for name in names for _ in range(len(rows) // len(names))]):
        row["model"] = name
    thin = [] if TRIAL else [row for points in (100_000, 400_000)
                             for row in json.loads(run(tables, "rows", points, paths[THIN_MODEL]))]
    family = {} if TRIAL else {half: json.loads(run(tables, "family", half))
                               for half in ("choosing", "judging")}
    large = []
    with tempfile.TemporaryDirectory() as folder:
        for normals in ("normals", "none"):
            cloud = pathlib.Path(folder) / "cloud.ply"
            run(tables, "sample", paths[names[0]], LARGE_CLOUD, 0, normals, cloud)
            reports = [json.loads(run(build / "bin/surfelao", "bake", cloud, "-o",
                                      pathlib.Path(folder) / "out.ply", "--json", "-"))
                       for _ in range(ROUNDS)]
            report = sorted(reports, key=lambda report: report["seconds"]["total"])[ROUNDS // 2]
            large.append({"count": LARGE_CLOUD, "normals": normals == "normals",
                          "mib": report["peak_rss_bytes"] / 2**20, **report["seconds"]})
    return {**provenance(build, "cloud_tables; surfelao bake"), "rows": rows, "thin": thin,
            "family": family, "large": large}


def part_clouds_pcv(build):
    """CloudCompare's PCV beside us."""
    paths = {name: path for path, name, _ in models()}
    mesh = paths[next(iter(paths)) if TRIAL else "bunny"]
    rows = []
    for noise, normals in ((0, "normals"), (0.3, "none")):
        try:
            rows.append(json.loads(run(ROOT / "tests/bench/clouds/pcv.py", build, mesh,
                                       2_000 if TRIAL else 50_000, noise, normals)))
        except subprocess.CalledProcessError as fault:
            if fault.returncode == 77:
                raise Absent("no CloudCompare, or no xvfb-run") from fault
            raise
    return {**provenance(build, "tests/bench/clouds/pcv.py"), "rows": rows}


def part_moving(build):
    """Frames of scenes that move; without the shared models generated ones stand in."""
    folder = pathlib.Path("/nowhere") if TRIAL else SHARED
    figures = json.loads(run(build / "bin/moving_tables", folder, shown="moving_tables MODELS"))
    if figures.pop("generated") and not TRIAL:
        raise Absent("no mountain.obj, FlightHelmet or spot.obj (SURFELAO_MODELS)")
    return {**provenance(build, "moving_tables"), **figures}


PIXEL_MODELS = ("bunny", "FlightHelmet", "stanford_dragon_res2", "pine", "data/room.obj")


def part_cubes(build):
    """Cube maps round a body and in a room, and the pixels themselves."""
    tables = build / "bin/cube_tables"
    body = ROOT / "data/blob.off" if TRIAL else SHARED / "stanford_bunny.obj"
    if not body.exists():
        raise Absent(f"no {body.name} (SURFELAO_MODELS)")
    counts = (300, 64) if TRIAL else ()
    scenes = [json.loads(run(tables, path, kind, *counts))
              for path, kind in ((body, "ring"), (ROOT / "data/room.obj", "inside"))]
    return {**provenance(build, "cube_tables"), "scenes": scenes}


def part_pixels(build):
    """The exact pass at the pixels of two views of each."""
    paths = {name: path for path, name, _ in models()}
    names = list(paths) if TRIAL else PIXEL_MODELS
    size = (64, 36) if TRIAL else (1280, 720)
    rows = json.loads(run(build / "bin/pixel_tables", "exact", 100 if TRIAL else 4000, *size,
                          *[paths[name] for name in names], shown="pixel_tables exact"))
    for row, name in zip(rows, [name for name in names for _ in range(8)]):
        row["model"] = name
    return {**provenance(build, "pixel_tables exact"), "width": size[0], "height": size[1],
            "rows": rows}


def part_origin(build):
    """Screen-space methods and ours at the pixels of five views."""
    needed = [SHARED / file for _, file, *_ in pixel_origin.VIEWS if not file.startswith("data/")]
    absent = [path.name for path in needed if not path.exists()]
    if absent and not TRIAL:
        raise Absent(f"no {', '.join(absent)} (SURFELAO_MODELS)")

    def told(path, *options):
        words = [str(word) for word in options]
        shown = f"surfelao compare MODEL {' '.join(words)}"
        return json.loads(run(build / "bin/surfelao", "compare", path, *words, "--json", "-",
                              shown=shown)), shown

    command, figures = pixel_origin.measure(told, ROOT, SHARED, TRIAL)
    return {**provenance(build, command), **figures}


def part_grids(build):
    """AO grids: errors of three objects, seconds against triangles, bytes."""
    models = [(name, SHARED / file) for name, file in
              (("bunny", "stanford_bunny.obj"), ("wingnut", "wingnut.obj"))]
    if TRIAL:
        models = [("bracket", ROOT / "data/bracket.obj")]
    absent = [path.name for _, path in models if not path.exists()]
    if absent:
        raise Absent(f"no {', '.join(absent)} (SURFELAO_MODELS)")
    program = build / "bin/grid_tables"
    errors = json.loads(run(program, "errors", *[f"{name}={path}" for name, path in models],
                            shown="grid_tables errors"))
    return {**provenance(build, "grid_tables errors; grid_tables growth"), **errors,
            **json.loads(run(program, "growth"))}


def part_screen(build):
    """The screen-space passes alone; egl: a GPU where there is one."""
    return {**provenance(build, "screen_tables egl"),
            **json.loads(run(build / "bin/screen_tables", "egl"))}


def part_gridpictures(build):
    """Pictures of objects with AO grids: cost of boxes and crowds, floors, pairs, the robot."""
    return {**provenance(build, "grid_pictures data/robot.glb"),
            **json.loads(run(build / "bin/grid_pictures", ROOT / "data/robot.glb"))}


PARTS = {"frontier": part_frontier, "frontier_avx2": part_frontier_avx2, "scaling": part_scaling,
         "stability": part_stability, "gpu": part_gpu, "drawing": part_drawing,
         "readers": part_readers, "foreign": part_foreign, "stated": part_stated,
         "family": part_family, "demo": part_demo,
         "viewers": part_viewers, "atlas": part_atlas, "maps": part_maps,
         "map_frontier": part_map_frontier, "clouds": part_clouds,
         "clouds_pcv": part_clouds_pcv,
         "pixels": part_pixels, "origin": part_origin, "cubes": part_cubes,
         "screen": part_screen, "moving": part_moving, "grids": part_grids,
         "gridpictures": part_gridpictures, "whole_job": part_whole_job,
         "subdivide": part_subdivide}


def main(arguments):
    if not arguments or any(part not in PARTS for part in arguments[1:]):
        print(__doc__, file=sys.stderr)
        return 2
    build = pathlib.Path(arguments[0]).resolve()
    code = 0
    for name in arguments[1:] or PARTS:
        start = time.monotonic()
        print(f"{name} ...", file=sys.stderr, flush=True)
        try:
            write(FIGURES / f"{name}.json", PARTS[name](build))
            print(f"{name}: {time.monotonic() - start:.0f} s", file=sys.stderr)
        except Absent as reason:
            print(f"{name}: keeps its old figures: {reason}", file=sys.stderr)
        except (subprocess.CalledProcessError, RuntimeError) as fault:
            print(f"{name}: keeps its old figures: {fault}", file=sys.stderr)
            code = 1
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
