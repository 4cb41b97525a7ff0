"""cube_views.py: views of docs/figures/cubes.json: what pixels read from cube maps (docs/cube_maps.md)."""

from figure_views import fixed, short, table, thousands, view


def cube_scene(figures, name):
    return next(scene for scene in figures["cubes"]["scenes"] if scene["inside"] == (name == "room"))


def cube_row(figures, name, placement, engine):
    return next(row for row in cube_scene(figures, name)["rows"]
                if row["placement"] == placement and row["engine"] == engine)


@view
def cube_errors(figures):
    """Errors at covered pixels: placements and engines, and masks at the pixels themselves"""
    rows = []
    for scene in figures["cubes"]["scenes"]:
        name = "room" if scene["inside"] else "bunny"
        for row in scene["rows"]:
            rows.append([name, row["placement"], row["maps"], row["engine"],
                         fixed(100 * row["coverage"], 2) + " %", short(row["rmse"], 4),
                         short(row["bias"], 4, "+"), short(row["p95"], 3), short(row["max"], 3),
                         short(row["rmse_white"], 4), short(row["rmse_solved"], 4)])
        direct = scene["direct"]
        rows.append([name, "none: the pixels themselves", 0, "masks", "", short(direct["rmse"], 4),
                     short(direct["bias"], 4, "+"), short(direct["p95"], 3),
                     short(direct["max"], 3), "", ""])
    return table(["view", "maps are put", "maps", "texels by", "covered", "RMSE covered", "bias",
                  "p95", "max", "whole, holes white", "whole, holes solved"], rows)


@view
def cube_seconds(figures):
    """Seconds of placement, of all maps, and of the pixels themselves"""
    rows = []
    for scene in figures["cubes"]["scenes"]:
        name = "room" if scene["inside"] else "bunny"
        for row in scene["rows"]:
            rows.append([name, row["placement"], row["engine"], row["maps"],
                         thousands(row["texels"]), fixed(row["mb"], 1), fixed(row["placement_s"], 2),
                         fixed(row["draw_s"], 2), fixed(row["solve_s"], 2)])
        direct = scene["direct"]
        rows.append([name, "the pixels themselves", "masks", 0, thousands(direct["pixels"]), "", "",
                     "", fixed(direct["solve_s"], 2)])
    return table(["view", "maps are put", "by", "maps", "receivers", "MB", "placement, s",
                  "G-buffers, s", "solve, s"], rows)


@view
def cube_frames(figures):
    """A frame of 1280 x 720 with ten maps on software OpenGL, and what a moving camera changes"""
    return table(["view", "G-buffer, ms", "ten maps, ms", "places x frames", "jumps", "largest",
                  "jumps without fading", "largest without fading"],
                 [["room" if scene["inside"] else "bunny", fixed(scene["projection"]["draw_ms"], 0),
                   fixed(scene["projection"]["project_ms"], 0),
                   thousands(scene["path"]["places"] * scene["path"]["frames"]),
                   scene["path"]["jumps"], short(scene["path"]["largest"], 3),
                   scene["path"]["jumps_without_fading"],
                   short(scene["path"]["largest_without_fading"], 3)]
                  for scene in figures["cubes"]["scenes"]])


@view
def cube_figure(figures, name, placement, engine, key):
    """cube_figure bunny|room PLACEMENT masks|horizon KEY: one figure; spaces in names as _"""
    value = cube_row(figures, name, placement.replace("_", " "), engine)[key]
    return fixed(100 * value, 2) if key == "coverage" else short(value, 4)


@view
def cube_direct(figures, name):
    """cube_direct bunny|room: RMSE of masks at the pixels themselves"""
    return short(cube_scene(figures, name)["direct"]["rmse"], 4)
