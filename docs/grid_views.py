"""grid_views.py: views of docs/figures/grids.json: AO grids round objects (docs/ao_grids.md)."""

from figure_views import fixed, short, table, thousands, view

# Seconds of Malmer et al., table 1: triangles, occlusion queries, cones by the GPU, 256 rays a cell.
ORIGIN = ((391, 0.45, 2.75, 5.58), (4698, 8.33, 9, 7.46), (16271, 50, 50, 6.25),
          (378_000, 230, 230, 92), (1_100_000, None, None, 226))


def what(row):
    text = f"{row['store']}, eps {short(row['extent'], 2)}, {row['border']}"
    return text + (", uniform: the report's settings" if row["origin"] else "")


@view
def grid_errors(figures):
    """Each object: errors of cones and harmonics, and of the report's settings, at places about it"""
    rows = []
    for scene in figures["grids"]["objects"]:
        for row in scene["rows"]:
            error = row["error"]
            rows.append([scene["input"], row["setting"], what(row), row["inside"],
                         short(error["rmse"], 4), short(error["bias"], 4, "+"),
                         short(error["p95"], 3), short(error["max"], 3)])
    return table(["object", "masks", "cells hold", "moved out", "RMSE", "bias", "p95", "max"], rows)


def seconds(value):
    return "" if value is None else fixed(value, 2 if value < 10 else 0)


@view
def grid_growth(figures):
    """Seconds of a bake against triangles, beside the report's"""
    rows = []
    times = figures["grids"]["rows"]
    for masks in [row for row in times if row["engine"] == "masks"]:
        rays = next(row for row in times
                    if row["engine"] == "rays" and row["triangles"] == masks["triangles"])
        near = min(ORIGIN, key=lambda line: abs(line[0] - masks["triangles"]))
        known = near if 0.8 < near[0] / masks["triangles"] < 1.25 else (None, None, None, None)
        rows.append([thousands(masks["triangles"]), fixed(masks["build_s"], 3),
                     fixed(masks["solve_s"], 3), fixed(masks["repair_s"], 3),
                     fixed(masks["total_s"], 3), fixed(rays["total_s"], 3),
                     known[0] and thousands(known[0]), seconds(known[1]), seconds(known[2]),
                     seconds(known[3])])
    return table(["triangles", "build", "solve", "repair", "masks, all", "256 rays a cell, all",
                  "the report's triangles", "its queries", "its cones", "its rays"], rows)


@view
def grid_growth_factor(figures):
    """Seconds at the most triangles over those at 69,000"""
    masks = {row["triangles"]: row["total_s"] for row in figures["grids"]["rows"]
             if row["engine"] == "masks"}
    middle = min(masks, key=lambda triangles: abs(triangles - 69_000))
    return fixed(masks[max(masks)] / masks[middle], 1)


@view
def grid_memory(figures):
    """Bytes of a grid beside the report's"""
    report = {("cone", 8): "128 (8 bits, AO and direction)"}
    return table(["cells hold", "bits", "KiB", "the report's KB"],
                 [[row["store"], row["bits"], row["kib"], report.get((row["store"], row["bits"]), "")]
                  for row in figures["grids"]["memory"]])
