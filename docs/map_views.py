"""map_views.py: views of docs/figures/maps.json and map_frontier.json: maps against Blender's and
against Embree's (docs/maps.md)."""

from figure_views import cell, fixed, ratio_of, ratio_text, row_of, short, table, thousands, three_errors, view


def four(error):
    return (f"{short(error['rmse'], 4)}, {short(error['p95'], 3)}, {short(error['max'], 2)}, "
            f"{short(error['bias'], 4, '+')}")


@view
def maps_against_blender(figures):
    """Each model: what our map and Blender's display, and Blender's error and time over ours"""
    rows = []
    for row in figures["maps"]["rows"]:
        times = row.get("times_ratio")
        rows.append([row["name"] + (", its own" if row["uvs"] == "file" else ""),
                     thousands(row["triangles"]), fixed(100 * row["covered"], 0) + " %",
                     four(row["ours"]), four(row["blender"]),
                     fixed(row["blender"]["rmse"] / row["ours"]["rmse"], 1), times and fixed(times, 0)])
    return table(["model", "triangles", "map covered", "ours: RMSE, p95, max, bias",
                  "Blender's: the same", "its RMSE over ours", "its time over ours"], rows)


@view
def maps_size(figures):
    """Texels of a side of these maps"""
    return thousands(figures["maps"]["size"])


@view
def maps_below(figures, limit):
    """maps_below LIMIT: "9 of 13" maps of ours whose RMSE is at most that"""
    errors = [row["ours"]["rmse"] for row in figures["maps"]["rows"]]
    return f"{sum(error <= float(limit) for error in errors)} of {len(errors)}"


@view
def maps_least(figures, key="rmse"):
    """maps_least rmse|times: the least of Blender's error or time over ours, and whose"""
    rows = [(row["blender"]["rmse"] / row["ours"]["rmse"] if key == "rmse" else row["times_ratio"],
             row["name"]) for row in figures["maps"]["rows"] if key == "rmse" or "times_ratio" in row]
    least, name = min(rows, default=(None, None))
    return "not measured" if name is None else f"{fixed(least, 1 if key == 'rmse' else 0)} ({name})"


@view
def maps_left_out(figures):
    """The most points left out of a model, in %: "26 (retroufo)" """
    rows = figures["maps"]["rows"]
    worst = max(rows, key=lambda row: row["hidden"] / (row["points"] + row["hidden"]))
    return f"{fixed(100 * worst['hidden'] / (worst['points'] + worst['hidden']), 0)} ({worst['name']})"


@view
def maps_large(figures):
    """Large maps: time and memory"""
    return table(["model", "texels", "covered", "seconds", "MiB"],
                 [[row["name"], f"{row['size']} x {row['size']}", fixed(100 * row["covered"], 0) + " %",
                   cell(row, "seconds", 1), fixed(row["mib"], 0)] for row in figures["maps"]["large"]])


@view
def map_frontier_table(figures):
    """Each model: floor, errors of masks and rays, and Embree's time over ours"""
    rows = []
    for scene in figures["map_frontier"]["scenes"]:
        masks = [row_of(scene, "masks", setting) for setting in ("draft", "good", "best")]
        rows.append([scene["name"], thousands(scene["receivers"]), scene["reference"]["hidden"],
                     short(scene["floor"]["rmse"], 4), *map(three_errors, masks),
                     three_errors(row_of(scene, "rays", "64 rays")),
                     ratio_text((masks[1]["embree_ratio"], masks[1]["extrapolated"]))
                     if masks[1]["embree_ratio"] else "-",
                     *(ratio_text(ratio_of(scene, "masks", target)) for target in ("010", "005"))])
    return table(["model", "texels", "hidden points", "floor", "draft", "good", "best", "64 rays",
                  "Embree over ours, at good's error", "at .010", "at .005"], rows)


@view
def subdivided(figures):
    """Coarse meshes as they are and subdivided: vertices, floor and seen errors"""
    rows = [[row["name"], *(thousands(row[key]["vertices"]) for key in ("plain", "cut")),
             *(short(row[key]["floor"], 4) for key in ("plain", "cut")),
             short(row["plain"]["good"], 4), short(row["cut"]["good"], 4), short(row["cut"]["best"], 4),
             fixed(row["seconds"], 2), fixed(100 * row["again"], 1) + " %"]
            for row in figures["subdivide"]["rows"]]
    return table(["model", "vertices", "subdivided", "floor", "subdivided", "seen (good)", "subdivided",
                  "best", "seconds", "a second run adds"], rows)
