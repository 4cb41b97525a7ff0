"""figure_views.py: from docs/figures/*.json to Markdown; each @view is a name for fill_figures.py.

A view takes the figures and the words behind its name in the marker, and returns text. A table's
column whose key no row has is left out, and keys that no view asks for do no harm: a new column of
the program needs one line here to be shown.
"""

import json
import math
import re

VIEWS = {}

TARGETS = {"010": "at_010", "005": "at_005"}  # errors beyond the floor at which the frontier compares
QUALITIES = ("quality -1", "draft", "quality 0.5", "good", "quality 1.5", "best", "quality 3")
ASKED = ("command", "commit", "version", "processor", "threads")


def view(function):
    VIEWS[function.__name__] = function
    return function


class Figures:
    """The parts of docs/figures, read when asked for: figures["gpu"] is gpu.json."""

    def __init__(self, folder):
        self.folder = folder
        self.parts = {}

    def __getitem__(self, name):
        if name not in self.parts:
            part = json.loads((self.folder / f"{name}.json").read_text())
            for key in ASKED:
                if key not in part:
                    raise ValueError(f"{name}.json does not say its {key}")
            self.parts[name] = part
        return self.parts[name]

    def __contains__(self, name):
        return (self.folder / f"{name}.json").exists()

    def unused(self):
        return sorted(path.name for path in self.folder.glob("*.json") if path.stem not in self.parts)


# ---- words and numbers


def fixed(value, digits):
    return f"{value:.{digits}f}"


def short(value, digits, sign=""):
    """.0031 and +.0004: without the zero in front."""
    text = f"{value:{sign}.{digits}f}"
    return text.replace("0.", ".", 1) if abs(value) < 1 else text


def thousands(number):
    return f"{number:,}"


def cell(row, key, digits):
    """A row's figure, or None where there is no such row or it lacks the figure."""
    return fixed(row[key], digits) if row and row.get(key) is not None else None


def joined(words):
    words = list(words)
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:]))) if words else "none"


def significant(value, digits=2):
    """2e-7, 0.0031, 54: as short as it can be said."""
    if value == 0:
        return "0"
    if abs(value) < 0.0005:
        mantissa, exponent = f"{value:.0e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:,.{decimals}f}"


def table(head, rows):
    """Markdown; a column that is None in every row is left out."""
    rows = [list(row) for row in rows]
    if not rows:
        raise ValueError("no rows")
    shown = [i for i in range(len(head)) if any(row[i] is not None for row in rows)]
    lines = [head, ["---"] * len(head), *rows]
    text = ""
    for number, line in enumerate(lines):
        cells = ["" if line[i] is None else str(line[i]) for i in shown]
        text += "|---" * len(shown) + "|\n" if number == 1 else "| " + " | ".join(cells) + " |\n"
    return text


def quantile(values, at):
    """Linear between the two nearest, as bake/statistics.h."""
    values = sorted(values)
    place = at * (len(values) - 1)
    low = math.floor(place)
    high = min(low + 1, len(values) - 1)
    return values[low] + (place - low) * (values[high] - values[low])


# ---- speed against error: frontier.json, and frontier_avx2.json by the AVX2 kernels


def scenes_of(figures, group="all", part="frontier"):
    """all; models: without the generated ones of data/; data."""
    scenes = figures[part]["scenes"]
    if group == "models":
        return [scene for scene in scenes if scene["group"] != "data"]
    return [scene for scene in scenes if group in ("all", scene["group"])]


def scene_of(figures, name, part="frontier"):
    for scene in figures[part]["scenes"]:
        if scene["name"] == name:
            return scene
    raise KeyError(name)


def row_of(scene, engine, setting):
    """None where the scene was not run so."""
    for row in scene["rows"]:
        if row["engine"] == engine and row["setting"] == setting:
            return row
    return None


def ratio_of(scene, engine, target, cost="solve"):
    """Embree's time over ours at an error beyond the floor of .010 or .005; (ratio, extrapolated)
    or None.
    cost: solve, builds (with_builds) or files (with_files)."""
    ratios = scene["ratios"].get(engine, {})
    if cost != "solve":
        ratios = ratios.get(f"with_{cost}", {})
    found = ratios.get(TARGETS[target])
    return (found["ratio"], found["extrapolated"]) if found else None


def ratio_text(found, bold_below_one=True):
    if not found:
        return None
    text = fixed(found[0], 1)
    if bold_below_one and float(text) < 1:
        text = f"**{text}**"
    return text + ("*" if found[1] else "")


def counted_ratios(figures, target, cost, group, part="frontier", engine="masks"):
    found = [ratio_of(scene, engine, target, cost) for scene in scenes_of(figures, group, part)]
    return [ratio for ratio, extrapolated in filter(None, found) if not extrapolated]


@view
def scenes(figures, group="all"):
    """scenes [GROUP]: how many scenes the frontier has. GROUP: all, models, data"""
    return str(len(scenes_of(figures, group)))


@view
def scene(figures, name, key):
    """scene NAME vertices|triangles: of a scene of the frontier"""
    return thousands(scene_of(figures, name)[key])


@view
def row(figures, scene, engine, setting, key, digits="4"):
    """row SCENE ENGINE SETTING KEY [DIGITS]: one figure of a scene at a setting ("_" for spaces)"""
    found = row_of(scene_of(figures, scene), engine, setting.replace("_", " "))
    if found is None:
        raise KeyError(f"{scene} {engine} {setting}")
    return fixed(found[key], int(digits))


@view
def ratio(figures, scene, target, cost="solve", part="frontier"):
    """ratio SCENE 010|005 [solve|builds|files] [PART]: Embree's time over that of masks"""
    return ratio_text(ratio_of(scene_of(figures, scene, part), "masks", target, cost), False)


@view
def ratio_scenes(figures, target, cost="solve", group="all", part="frontier"):
    """ratio_scenes 010|005 [COST] [GROUP] [PART]: "20 of 21" scenes where both sides reach the error"""
    counted = len(counted_ratios(figures, target, cost, group, part))
    return f"{counted} of {len(scenes_of(figures, group, part))}"


@view
def ratio_quantile(figures, at, target, cost="solve", group="all", part="frontier"):
    """ratio_quantile 0.5 010|005 [COST] [GROUP] [PART]: of Embree's time over that of masks. A median
    of few scenes stands for none (stands_for_all() of bake/frontier.h): it is refused."""
    counted = counted_ratios(figures, target, cost, group, part)
    if 3 * len(counted) < 2 * len(scenes_of(figures, group, part)):
        raise ValueError(f"the error is reached on {ratio_scenes(figures, target, cost, group, part)} only")
    return fixed(quantile(counted, float(at)), 1)


@view
def ratios_below_one(figures, target, cost="solve", group="all", part="frontier"):
    """ratios_below_one 010|005 [COST] [GROUP] [PART]: "pandora (0.9) and engine (0.9)", or none"""
    losers = []
    for scene in scenes_of(figures, group, part):
        found = ratio_of(scene, "masks", target, cost)
        if found and float(fixed(found[0], 1)) < 1:
            losers.append(f"{scene['name']} ({fixed(found[0], 1)})")
    return joined(losers)


@view
def embree_wins(figures, group="all", engine="masks"):
    """embree_wins [GROUP] [ENGINE]: where rays are faster at our error, setting by setting"""
    lists = []
    for setting in QUALITIES:
        losers = []
        for scene in scenes_of(figures, group):
            found = row_of(scene, engine, setting)
            if found and found.get("embree_ratio") and float(fixed(found["embree_ratio"], 1)) < 1:
                losers.append(f"{scene['name']} ({fixed(found['embree_ratio'], 1)})")
        if losers:
            lists.append(f"at {setting} on {joined(losers)}")
    return "; ".join(lists) if lists else "nowhere"


@view
def range_of(figures, engine, setting, key, digits="4", group="all"):
    """range_of ENGINE SETTING KEY [DIGITS] [GROUP]: "0.0015 to 0.0075", over the scenes"""
    values = [found[key] for found in (row_of(scene, engine, setting.replace("_", " "))
                                       for scene in scenes_of(figures, group)) if found]
    return f"{fixed(min(values), int(digits))} to {fixed(max(values), int(digits))}"


@view
def largest(figures, engine, setting, key, digits="4", group="all"):
    """largest ENGINE SETTING KEY [DIGITS] [GROUP]: the largest by size, and of which scene"""
    value, name = max((abs(found[key]), scene["name"]) for scene, found in (
        (scene, row_of(scene, engine, setting.replace("_", " ")))
        for scene in scenes_of(figures, group)) if found)
    return f"{fixed(value, int(digits))} ({name})"


@view
def floor(figures, scene, digits="4"):
    """floor SCENE [DIGITS]: the seen error of the best values of its vertices"""
    return fixed(scene_of(figures, scene)["floor"]["rmse"], int(digits))


@view
def points_left_out(figures, group="all"):
    """points_left_out [GROUP]: the largest share of ill-defined surface points, and of which scene"""
    def share(scene):
        points = scene["reference"]
        return 100 * points["ill_defined"] / max(1, points["points"] + points["ill_defined"])
    worst = max(scenes_of(figures, group), key=share)
    return f"{fixed(share(worst), 2)} % ({worst['name']})"


def three_errors(row):
    """Seen, solve and beyond."""
    return " / ".join(short(row[key], 4) for key in ("seen_rmse", "solve_rmse", "beyond"))


def row_cell(row):
    """Microseconds a receiver; three errors; of our engines, bias, 95th percentile and maximum of
    what is seen; ratio."""
    if row is None:
        return None
    text = f"{fixed(row['us_per_receiver'], 2)} us; {three_errors(row)}"
    if row["engine"] != "rays":
        text += (f"; {short(row['seen_bias'], 4, '+')}, {short(row['seen_p95'], 3)}, "
                 f"{short(row['seen_max'], 2)}")
    if row.get("embree_ratio") is not None:
        text += f"; x{fixed(row['embree_ratio'], 1)}" + ("*" if row["extrapolated"] else "")
    return text


@view
def every_model(figures):
    """Every scene, masks, disks and rays: points left out, floor; time, seen / solve / beyond, ..."""
    columns = (("masks", "draft"), ("masks", "good"), ("disks", "good"),
               ("rays", "64 rays"), ("rays", "256 rays"))
    return table(["scene", "left out", "floor",
                  *(" ".join((engine, setting.split()[0])) for engine, setting in columns)],
                 [[scene["name"], scene["reference"]["ill_defined"],
                   short(scene["floor"]["rmse"], 4),
                   *(row_cell(row_of(scene, *column)) for column in columns)]
                  for scene in scenes_of(figures, "models")])


@view
def how_fast(figures):
    """README: floor; seen, solve and beyond at good and Embree's time at that error over ours"""
    rows = []
    for scene in scenes_of(figures, "models"):
        masks, disks = row_of(scene, "masks", "good"), row_of(scene, "disks", "good")
        rows.append([
            scene["name"], thousands(scene["triangles"]), short(scene["floor"]["rmse"], 4),
            *(short(masks[key], 4) for key in ("seen_rmse", "solve_rmse", "beyond")),
            cell(masks, "embree_ratio", 1), disks and short(disks["seen_rmse"], 4),
            cell(disks, "embree_ratio", 1)])
    return table(["model", "triangles", "floor", "masks, good: seen", "solve", "beyond the floor",
                  "Embree's time over ours", "disks, good: seen", "Embree over ours"], rows)


@view
def bent_normals(figures):
    """Angle of displayed bent normals to the reference's, mean and 95th percentile, and the floor"""
    columns = (("masks", "draft"), ("masks", "good"), ("masks", "best"), ("rays", "4 rays"))

    def angles(found, kind=""):
        return found and (f"{fixed(found[kind + 'bent_mean_deg'], 2)}, "
                          f"{fixed(found[kind + 'bent_p95_deg'], 1)}")
    return table(["scene", "floor", "draft", "good", "solve at good", "best", "4 rays"],
                 [[scene["name"], angles(scene["floor"]),
                   *(angles(row_of(scene, *column), "seen_") for column in columns[:2]),
                   angles(row_of(scene, *columns[1]), "solve_"),
                   *(angles(row_of(scene, *column), "seen_") for column in columns[2:])]
                  for scene in scenes_of(figures, "models")])


@view
def build_times(figures):
    """Time of building the masks' tree over that of Embree's"""
    return table(["scene", "triangles", "our build over Embree's"],
                 [[scene["name"], thousands(scene["triangles"]), cell(scene, "build_over_embree", 2)]
                  for scene in scenes_of(figures, "models") if scene.get("build_over_embree")])


@view
def frontier_table(figures):
    """Every scene: ratio at .010 and .005 beyond the floor, with builds, by AVX2; errors"""
    avx2 = figures["frontier_avx2"] if "frontier_avx2" in figures else {"scenes": []}
    by_avx2 = {scene["name"]: scene for scene in avx2["scenes"]}

    def errors(row):
        return row and (f"{three_errors(row)}; {short(row['seen_bias'], 4, '+')} "
                        f"{short(row['seen_max'], 2)}")
    rows = []
    for scene in scenes_of(figures):
        other = by_avx2.get(scene["name"])
        rows.append([
            scene["name"],
            *(ratio_text(ratio_of(scene, "masks", target, cost))
              for cost in ("solve", "builds") for target in TARGETS),
            *(other and ratio_text(ratio_of(other, "masks", target)) for target in TARGETS),
            scene["reference"]["ill_defined"], short(scene["floor"]["rmse"], 4),
            errors(row_of(scene, "masks", "good")), errors(row_of(scene, "masks", "best"))])
    return table(["scene", "at .010", "at .005", ".010 with builds", ".005 with builds",
                  "AVX2, .010", "AVX2, .005", "left out", "floor",
                  "good: seen / solve / beyond; bias, max", "best: the same"], rows)


@view
def how_measured(figures, part):
    """how_measured PART: processor, threads, version and commit of a part, and its note"""
    found = figures[part]
    threads = f"{found['threads']} thread{'s' if found['threads'] != 1 else ''}"
    note = f"; {found['note']}" if "note" in found else ""
    return f"{found['processor']}, {threads}, version {found['version']} ({found['commit']}{note})"


@view
def command(figures, part):
    """command PART: the command that made it"""
    return f"`{figures[part]['command']}`"


# ---- other parts


@view
def demo(figures):
    """What ./run demo prints"""
    return "\n".join(["```text", *figures["demo"]["lines"], "```"])


@view
def scaling(figures, engine):
    """scaling masks|disks: costs on growing meshes"""
    rows = figures["scaling"][engine]["rows"]
    columns = (("vertices", "vertices", lambda v: thousands(v)),
               ("build us/vertex", "build, us a vertex", lambda v: fixed(v, 2)),
               ("solve us/vertex", "solve, us a vertex", lambda v: fixed(v, 2)),
               ("brute force us/vertex", "brute force, us a vertex", lambda v: thousands(round(v))),
               ("RMS to it", "RMS difference to it", lambda v: fixed(v, 4)),
               ("build peak bytes/triangle", "build, bytes a triangle", str),
               ("solve peak bytes/vertex", "solve, bytes a vertex", str),
               ("work", "work", str))
    return table([head for _, head, _ in columns],
                 [[None if row.get(key) is None else text(row[key]) for key, _, text in columns]
                  for row in rows])


@view
def whole_job(figures):
    """from file to file: stages, processor time, memory"""
    columns = [("name", "mesh", str), ("triangles", "triangles", thousands),
               ("bytes", "file, MB", lambda v: fixed(v / 1e6, 1))]
    columns += [(stage, f"{stage}, s", lambda v: fixed(v, 2))
                for stage in ("read", "tree", "solve", "fit", "write", "total", "user", "system")]
    columns.append(("bytes/triangle", "peak, bytes a triangle", lambda v: thousands(round(v))))
    return table([head for _, head, _ in columns],
                 [[text(row[key]) for key, _, text in columns]
                  for row in figures["whole_job"]["rows"]])


@view
def scaling_exponent(figures, engine):
    """scaling_exponent masks|disks: solving grows with vertices to the power of this"""
    return fixed(figures["scaling"][engine]["exponent"], 2)


@view
def charts(figures):
    """Charts beside those of xatlas: number, seams, stretch, use"""
    def cells(found):
        return ([found["charts"], fixed(found["seam"], 1),
                 f"{fixed(found['stretch'], 2)}, {fixed(found['largest'], 1)}",
                 fixed(found["use"], 2)] if found else ["", "", "", ""])
    rows = [[row["name"], thousands(row["triangles"]), *cells(row["ours"]), *cells(row["xatlas"])]
            for row in figures["atlas"]["rows"]]
    return table(["mesh", "triangles", "charts", "seams", "stretch: mean, largest", "use",
                  "xatlas: charts", "seams", "stretch", "use"], rows)


@view
def device(figures, part="gpu"):
    """device gpu|drawing: the GPU that made the part's figures"""
    return figures[part]["device"]


@view
def gpu_disks(figures):
    """Disks on the GPU against disks on the CPU: speed and difference"""
    rows = [(row["scene"], row["vertices"], row) for row in figures["gpu"]["bodies"]
            if row["engine"] == "disks"]
    rows += [(row["scene"], row["vertices"], row["disks"]) for row in figures["gpu"]["models"]
             if "disks" in row]
    return table(["scene", "vertices", "speed of GPU / CPU", "RMS difference", "largest"],
                 [[name, thousands(vertices), fixed(row["speed GPU / CPU"], 2),
                   significant(row["RMS difference"]), significant(row["largest"])]
                  for name, vertices, row in rows])


@view
def gpu_masks(figures):
    """Masks on the GPU against the CPU: difference, both seen and solve errors, speed"""
    def error(found):
        return found and f"{short(found['seen'], 4)} / {short(found['solve'], 4)}"
    return table(["scene", "vertices", "GPU - CPU, RMS", "largest", "seen / solve, CPU",
                  "seen / solve, GPU", "speed of GPU / CPU"],
                 [[row["scene"], thousands(row["vertices"]),
                   significant(row["masks"]["RMS difference"]), significant(row["masks"]["largest"]),
                   error(row.get("cpu")), error(row.get("gpu")),
                   fixed(row["masks"]["speed GPU / CPU"], 3)]
                  for row in figures["gpu"]["models"] if "masks" in row])


@view
def gpu_grids(figures):
    """The report's table 1: solves a second on grids, by brute force and by the tree"""
    return table(["vertices", "report, triangles", "brute force", "tree", "tree over brute force"],
                 [[thousands(row["vertices"]), row["report, frames/s"],
                   significant(row["GPU brute force"]), significant(row["GPU tree"]),
                   significant(row["GPU: tree / brute force"])] for row in figures["gpu"]["grids"]])


@view
def frame_rates(figures):
    """The report's table 2: frames a second of triangles and splats"""
    columns = ("triangles", "report", "splats", "report, covering", "affine", "points",
               "covering radius", "report, radius")
    return table(["vertices", *columns],
                 [[thousands(row["vertices"]), *(
                     "" if row[key] is None else row[key] if key.startswith("report")
                     else significant(row[key]) for key in columns)]
                  for row in figures["drawing"]["rows"]])


@view
def odd_files(figures):
    """docs/readers.md, as tests/odd_files.sh prints it"""
    baked, refused = figures["readers"]["baked"], figures["readers"]["refused"]
    return (f"Baked, {len(baked)} files, with vertices and triangles (polygons are cut into as many\n"
            "triangles as corners less two):\n\n"
            + table(["file", "vertices", "triangles", "what is odd"],
                    [[row["file"], row["vertices"], row["triangles"], row["what is odd"] or ""]
                     for row in baked])
            + f"\nRefused, {len(refused)} files, each with the whole sentence behind the file's name:"
              "\n\n"
            + table(["file", "sentence"], [[row["file"], row["sentence"]] for row in refused]))


@view
def odd_files_count(figures, kind="all"):
    """odd_files_count all|baked|refused: files of assimp-testmodels"""
    lists = ("baked", "refused") if kind == "all" else (kind,)
    return str(sum(len(figures["readers"][name]) for name in lists))


@view
def foreign_files(figures):
    """docs/readers.md: what is read through assimp"""
    files = figures["foreign"]["files"]
    read = [[row["file"], row["vertices"], row["triangles"], "; ".join(row["notes"])]
            for rows in files.values() for row in rows if "sentence" not in row]
    refused = [[row["file"], row["sentence"]]
               for rows in files.values() for row in rows if "sentence" in row]
    return (f"Read, {len(read)} files:\n\n"
            + table(["file", "vertices", "triangles", "notes"], read)
            + f"\nRefused, {len(refused)} files:\n\n" + table(["file", "sentence"], refused))


@view
def foreign_pairs(figures):
    """docs/readers.md: the same model in two formats"""
    return table(["model", "format", "places", "mean occlusion", "largest difference", "mean"],
                 [[row["model"], row["format"], row["places"], f"{row['occlusion']:.4f}",
                   f"{row['largest']:.5f}", f"{row['mean']:.6f}"] for row in figures["foreign"]["pairs"]])


@view
def foreign_mutants(figures):
    """docs/readers.md: broken files through assimp"""
    row = figures["foreign"]["mutants"]
    return table(["files", "read", "refused", "of these: assimp crashed", "took too long",
                  "asked for too much memory", "peak, MiB", "longest, s"],
                 [[row["count"], row["read"], row["refused"], row["crashed"], row["too_long"],
                   row["too_large"], f"{row['peak_mib']:.0f}", f"{row['longest_seconds']:.1f}"]])


@view
def foreign_mutant_count(figures):
    """how many broken files go through assimp"""
    return str(figures["foreign"]["mutants"]["count"])


@view
def stability_table(figures, device):
    """stability_table cpu|gpu: RMS and worst error of every hard case, as `stability` prints it"""
    part = figures["stability"]
    chosen = [i for i, engine in enumerate(part["engines"])
              if engine["name"].startswith("GPU") == (device == "gpu")]
    engines = [part["engines"][i] for i in chosen]
    lines = [f"{'case':52} {'truth':>5} {'points':>6} {'undef':>5}"
             + "".join(f"  {engine['name']:13}" for engine in engines),
             f"{'bound (rms worst)':52} {'':5} {'':6} {'':5}"
             + "".join(f"  {engine['bound_rms']:5.3f} {engine['bound_worst']:5.3f}  "
                       for engine in engines)]
    for case in part["cases"]:
        line = (f"{case['group'] + ': ' + case['name']:52} {case['truth']:>5} "
                f"{case['points']:6} {case['undefined']:5}")
        for i in chosen:
            error = case["errors"][i]
            line += f"  {error[0]:5.3f} {error[1]:5.3f} {error[2]:1}" if error else "      -     -  "
        lines.append(line)
    return "\n".join(["```text", *(line.rstrip() for line in lines), "```"])


@view
def stability_summary(figures):
    """Engine by engine: cases passed, excused, failed, and the worst error held to a bound"""
    return table(["engine", "pass", "excused", "undefined", "FAIL", "largest RMS", "worst receiver"],
                 [[engine["name"], engine["pass"], engine["excused"], engine["undefined"],
                   engine["fail"], fixed(engine["largest_rms"], 4),
                   f"{fixed(engine['largest_worst'], 4)} ({engine['worst_case']})"]
                  for engine in figures["stability"]["engines"]])


@view
def stability_count(figures, what):
    """stability_count cases|receivers|undefined|fail"""
    part = figures["stability"]
    counts = {"cases": len(part["cases"]),
              "receivers": sum(case["points"] for case in part["cases"]),
              "undefined": sum(case["undefined"] for case in part["cases"]),
              "fail": sum(engine["fail"] for engine in part["engines"])}
    return thousands(counts[what])


@view
def stability_failures(figures):
    """The cases that failed, or Nothing"""
    part = figures["stability"]
    failed = [f"{case['group']}: {case['name']} ({engine['name']})" for case in part["cases"]
              for engine, error in zip(part["engines"], case["errors"]) if error and error[2] == "!"]
    return "; ".join(failed) if failed else "Nothing"


@view
def stability_excused_range(figures, prefix="disks"):
    """stability_excused_range PREFIX: RMS of the cases that engines of this name are excused from"""
    part = figures["stability"]
    values = [error[0] for case in part["cases"] for engine, error in zip(part["engines"], case["errors"])
              if engine["name"].startswith(prefix) and error and error[2] == "~"]
    return f"{fixed(min(values), 2)} to {fixed(max(values), 2)}"


# ---- single figures


@view
def recorded(figures, name):
    """recorded NAME: a figure of recorded.json, measured once by hand, with how and when there"""
    text = figures["recorded"]["figures"][name]["text"]
    return text if isinstance(text, str) else "\n".join(text)


@view
def constant(figures, name):
    """constant kName: the value of a constexpr in the sources"""
    root = figures.folder.parent.parent
    for folder in ("surfels", "tree", "reference", "gpu", "engines", "bake"):
        for path in (path for kind in ("*.h", "*.cpp") for path in sorted((root / folder).rglob(kind))):
            found = re.search(rf"constexpr [\w:]+ {name} = ([-\d.e]+)f?;", path.read_text())
            if found:
                return found.group(1)
    raise KeyError(name)


# ---- what bakes state of themselves


def stated(figures, half, kind=None):
    return [bake for bake in figures["stated"]["bakes"]
            if half in ("all", bake["half"]) and kind in (None, bake["kind"])]


def holds(bake):
    return bake["low"] <= bake["truth"] <= bake["high"]


def kept(bakes, asked):
    """Of bakes that say to have met an error, those that have."""
    met = [bake[asked] for bake in bakes if bake[asked]["met"]]
    return met, [row for row in met if row["truth"] <= float(asked.split("_")[1])]


@view
def stated_kinds(figures):
    """stated_kinds: the table of the family, kind by kind"""
    kinds = list(dict.fromkeys(bake["kind"] for bake in figures["stated"]["bakes"]))
    rows = []
    for kind in kinds:
        bakes = stated(figures, "all", kind)
        row = [kind.replace("_", " "), short(quantile([bake["rmse"] for bake in bakes], 0.5), 4),
               fixed(quantile([bake["high"] / max(bake["low"], 1e-4) for bake in bakes], 0.5), 2)]
        for half in ("choosing", "judging"):
            some = stated(figures, half, kind)
            row.append(f"{sum(map(holds, some))} of {len(some)}")
        for asked in ("asked_0.01", "asked_0.005"):
            met, right = kept(bakes, asked)
            row.append(f"{len(right)} of {len(met)}")
        rows.append(row)
    return table(["kind", "error at good, median", "high / low, median", "holds, chosen on",
                  "holds, judged on", "--error .01 kept", "--error .005 kept"], rows)


@view
def stated_share(figures, half):
    """stated_share all|choosing|judging: of the statements, how many per cent hold"""
    bakes = stated(figures, half)
    return fixed(100.0 * sum(map(holds, bakes)) / len(bakes), 0)


@view
def stated_kept(figures, asked):
    """stated_kept 0.01|0.005: "98 of 100" bakes that say to have met an error have"""
    met, right = kept(stated(figures, "all"), f"asked_{asked}")
    return f"{len(right)} of {len(met)}"


@view
def stated_correction(figures):
    """stated_correction: what correcting by the stated bias would do to the error, median, per cent"""
    gains = [1.0 - bake["corrected"] / bake["truth"] for bake in stated(figures, "all")
             if bake["truth"] > 0]
    return fixed(100.0 * quantile(gains, 0.5), 1)


@view
def stated_cost(figures, least="0", most="1e9"):
    """stated_cost [LEAST MOST]: the statement's share of a bake, models by triangles, per cent"""
    shares = [cost["share"] for cost in figures["stated"]["costs"]
              if float(least) <= cost["triangles"] <= float(most)]
    low, high = (fixed(100.0 * share, 0) for share in (min(shares), max(shares)))
    return low if low == high else f"{low} to {high}"


import mask_views  # noqa: E402, F401 - more views, in files of their own
import cloud_views  # noqa: E402, F401
import cube_views  # noqa: E402, F401
import grid_picture_views  # noqa: E402, F401
import exact_views  # noqa: E402, F401
import family_views  # noqa: E402, F401
import grid_views  # noqa: E402, F401
import map_views  # noqa: E402, F401
import moving_views  # noqa: E402, F401
import screen_views  # noqa: E402, F401
import viewer_views  # noqa: E402, F401
import pixel_views  # noqa: E402, F401
