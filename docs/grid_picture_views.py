"""grid_picture_views.py: views of docs/figures/gridpictures.json: pictures of objects with AO grids
(docs/ao_grid_pictures.md), and what the origin of the method has published."""

from figure_views import fixed, short, table, thousands, view

MERGES = {"product": "product", "union": "union"}


@view
def grid_boxes(figures):
    """Milliseconds of a box by picture, store, merge and the share of the picture that it covers"""
    return table(["picture", "store", "merge", "covered", "ms", "ms of the processor"],
                 [[f"{row['width']} x {row['height']}", row["store"], MERGES[row["merge"]],
                   fixed(100 * row["covered"], 0) + " %", fixed(row["ms"], 1),
                   fixed(row["cpu_ms"], 1)] for row in figures["gridpictures"]["boxes"]])


@view
def grid_crowds(figures):
    """Whole frames of objects on a floor"""
    return table(["objects", "triangles", "G-buffer, ms", "frame, ms", "frames a second",
                  "frame by union, ms"],
                 [[row["objects"], thousands(row["triangles"]), fixed(row["see_ms"], 1),
                   fixed(row["frame_ms"], 1), fixed(row["fps"], 1), fixed(row["union_ms"], 1)]
                  for row in figures["gridpictures"]["crowds"]])


@view
def grid_floors(figures):
    """The floor under an object, per place, against rays"""
    return table(["store", "border", "eps", "RMSE", "bias", "max"],
                 [[row["store"], row["border"], short(row["extent"], 2), short(row["rmse"], 4),
                   short(row["bias"], 4, "+"), short(row["max"], 3)]
                  for row in figures["gridpictures"]["floors"]])


@view
def grid_pairs(figures):
    """Two boxes over a floor, per place, against rays"""
    return table(["boxes", "merge", "RMSE", "bias", "max"],
                 [[row["boxes"], MERGES[row["merge"]], short(row["rmse"], 4),
                   short(row["bias"], 4, "+"), short(row["max"], 3)]
                  for row in figures["gridpictures"]["pairs"]])


@view
def grid_robot(figures):
    """The robot's walk: costs and errors of frames"""
    return table(["second", "G-buffer, ms", "passes, ms", "RMSE", "bias", "max"],
                 [[fixed(row["seconds"], 2), fixed(row["see_ms"], 1), fixed(row["pass_ms"], 1),
                   short(row["rmse"], 4), short(row["bias"], 4, "+"), short(row["max"], 3)]
                  for row in figures["gridpictures"]["robot"]["frames"]])


@view
def grid_robot_bake(figures):
    """Seconds of the grids of all parts of the robot"""
    return fixed(figures["gridpictures"]["robot"]["bake_s"], 1)
