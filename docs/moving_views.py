"""moving_views.py: views of docs/figures/moving.json: frames of scenes that move (docs/motion.md)."""

from figure_views import fixed, short, table, thousands, view

QUALITIES = ("draft", "good")
RAYS = ("rays_4", "rays_8", "rays_16", "rays_32", "rays_64")


def moving_scene(figures, name):
    part = figures["moving"]
    return part["robot"] if name == "robot" else \
        next(scene for scene in part["scenes"] if scene["name"] == name)


@view
def moving_rays(figures):
    """What errors are taken against"""
    part = figures["moving"]
    return f"{thousands(part['rays'])} rays at a thousand of them"


@view
def moving_frames(figures):
    """A body that crosses a scene: stages of a frame, rebuilt each frame beside it, receivers answered"""
    rows = []
    for scene in figures["moving"]["scenes"]:
        for quality in QUALITIES:
            row, rebuilt = scene[quality], scene[f"{quality}_rebuilt"]
            rows.append([scene["name"], thousands(scene["vertices"]), quality,
                         fixed(row["place_ms"], 1), fixed(row["tree_ms"], 1), fixed(row["solve_ms"], 1),
                         fixed(row["frame_ms"], 1), fixed(rebuilt["frame_ms"], 1),
                         fixed(100 * row["solved"] / scene["vertices"], 0)])
    return table(["scene + spot", "vertices", "masks", "place, ms", "tree, ms", "solve, ms", "frame, ms",
                  "rebuilt, ms", "answered, %"], rows)


@view
def moving_flicker(figures):
    """The same: error, what static vertices change beside the truth, untouched ones with other bytes"""
    rows = []
    for scene in figures["moving"]["scenes"]:
        for quality in QUALITIES:
            row, rebuilt = scene[quality], scene[f"{quality}_rebuilt"]
            rows.append([scene["name"], quality, short(row["rmse_static"], 4),
                         short(rebuilt["rmse_static"], 4), short(row["rmse"], 4), short(rebuilt["rmse"], 4),
                         f"{short(row['spurious'], 5)}, {short(row['largest'], 3)}",
                         f"{short(rebuilt['spurious'], 5)}, {short(rebuilt['largest'], 3)}",
                         thousands(row["untouched"]), thousands(row["untouched_changed"]),
                         thousands(rebuilt["untouched_changed"])])
    return table(["scene + spot", "masks", "RMSE, scene alone", "rebuilt", "with spot", "rebuilt",
                  "spurious change: RMS, largest", "rebuilt", "untouched, all frames",
                  "of them with other bytes", "rebuilt"], rows)


@view
def moving_robot(figures):
    """The robot: masks beside rays, raw and smoothed: frames a second, error, spurious change"""
    robot = figures["moving"]["robot"]
    names = [("draft", "masks, draft"), ("good", "masks, good"), ("draft_rebuilt", "masks, draft, rebuilt")]
    for rays in RAYS:
        count = rays.split("_")[1]
        names += [(rays, f"{count} rays"), (f"smooth_{count}", f"{count} rays, smoothed")]
    rows = [[label, fixed(robot[name]["frame_ms"], 1), fixed(1000 / robot[name]["frame_ms"], 1),
             short(robot[name]["rmse"], 4), short(robot[name]["spurious"], 4), short(robot[name]["largest"], 3)]
            for name, label in names]
    return table(["robot", "frame, ms", "frames/s", "RMSE", "spurious change of static vertices, RMS", "largest"],
                 rows)


@view
def moving_disks(figures):
    """Disks in three passes: with what is remembered, and built and corrected anew in each frame"""
    rows = []
    for scene in figures["moving"]["scenes"]:
        row, rebuilt = scene["disks"], scene["disks_rebuilt"]
        rows.append([scene["name"], fixed(row["frame_ms"], 1), fixed(1000 / row["frame_ms"], 1),
                     fixed(rebuilt["frame_ms"], 1), fixed(1000 / rebuilt["frame_ms"], 1),
                     short(row["rmse"], 4), short(rebuilt["rmse"], 4), short(row["spurious"], 5),
                     short(rebuilt["spurious"], 5)])
    return table(["scene + spot", "frame, ms", "solves/s", "anew, ms", "anew, solves/s", "RMSE", "anew",
                  "spurious change, RMS", "anew"], rows)


@view
def moving_memory(figures):
    """What many frames add to the memory that a scene takes"""
    memory = figures["moving"]["memory"]
    return table(["engine", f"MiB after {thousands(memory['frames'])} frames", f"more than after {memory['from']}"],
                 [[name, fixed(memory[name]["mib"], 0), fixed(memory[name]["grown_mib"], 2)]
                  for name in ("masks", "disks", "rays")])


@view
def moving_gpu(figures, key, digits="1"):
    """moving_gpu first|later|first_fps|later_fps|vertices [DIGITS]: disks in software OpenGL, ms or solves/s"""
    row = figures["moving"]["gpu"]
    if key == "vertices":
        return thousands(row[key])
    name = key.split("_")[0] + "_ms"
    return fixed(1000 / row[name] if key.endswith("fps") else row[name], int(digits))


@view
def moving_value(figures, scene, row, key, digits="1"):
    """moving_value SCENE ROW KEY [DIGITS]: one figure; ROW - for the scene's own, KEY fps for frames a second"""
    found = moving_scene(figures, scene)
    if row != "-":
        found = found[row]
    value = 1000 / found["frame_ms"] if key == "fps" else found[key]
    if isinstance(value, int):
        return thousands(value)
    return short(value, int(digits)) if abs(value) < 1 else fixed(value, int(digits))
