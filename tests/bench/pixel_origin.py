"""pixel_origin.py: the comparison of screen-space methods from which the project comes, again, for
measure.py: five views, 256 rays a pixel, with its settings and with ours; beside it what it has not:
engines of the scene at the same pixels, and the methods' limits.

The origin's scenes that are not at hand (Sponza, a restaurant) are replaced by the room of data/ and
FlightHelmet; its dragon is the coarser one of the same scan.
"""

# name, file in data/ or among the shared models, radius, options, cameras
VIEWS = (
    ("dragon", "stanford_dragon_res2.ply", "10%", (), ("azimuth=30,elevation=18",)),
    ("room", "data/room.obj", "15%", ("--up", "z"),
     ("eye=0.8:0.7:1.6,target=6:4.4:1.0,fov=65", "eye=7.4:5.4:2.2,target=2.5:2:0.4,fov=65")),
    ("FlightHelmet", "FlightHelmet/FlightHelmet.gltf", "10%", (),
     ("azimuth=30,elevation=10", "azimuth=-35,elevation=25,distance=0.45")),
)
# the origin tells its radii in units of its scenes; with this share of the diagonal its errors of the
# dragon come out
NEAR = "1%"
ORIGIN = ("ssao-disc", "ssao-sphere", "vo", "hbao")

AS_THERE = [f"{name}.{setting}" for name in ("ssao-disc", "ssao-sphere")
            for setting in ("pairs=off", "ratio-test=on")] + ["hbao.bias=30", "hbao.normals=off",
                                                             "noise=origin"]


def sets(settings):
    return [word for setting in settings for word in ("--set", setting)]


def runs(trial, radius):
    """(kind, radius, options) of each comparison of a model: near and far are radii of the origin's kind
    and of ours."""
    full = ("--width", 64, "--height", 36) if trial else ("--width", 960, "--height", 540)
    # a thousand reads a pixel take seconds on software: smaller pictures, once
    small = full if trial else ("--width", 640, "--height", 360)
    most = 64 if trial else 1024
    methods = ",".join(ORIGIN) + ",gtao,bitmask"
    limit = [*small, "--engines", "masks," + methods, "--qualities", "good", "--taps", most,
             "--rounds", 1]
    return (("near", NEAR, [*full, "--engines", "masks," + methods, "--qualities", "draft,good",
                            "--taps", "8,16,24", *sets(AS_THERE)]),
            ("near_limit", NEAR, limit),
            ("far_there", radius, [*full, "--engines", ",".join(ORIGIN), "--taps", "8,24",
                                   "--rounds", 1, *sets(AS_THERE)]),
            ("far", radius, [*full, "--engines", "masks,rays," + methods, "--qualities", "draft,good",
                             "--rays", "64", "--taps", "8,24"]),
            ("far_limit", radius, limit))


def rows_of(told, views, kind):
    """Flat rows: kind, view, engine, setting, samples, errors in per cent, ms."""
    numbers = {"kind": kind, "width": told["width"], "height": told["height"]}
    return [{**numbers, "view": views[row["camera"] - 1],
             **{key: value for key, value in row.items() if key not in ("camera", "clock")}}
            for row in told["rows"]]


def measure(compare, folder, shared, trial):
    """compare(path, *options): the JSON of `surfelao compare --at pixels` and its command."""
    rows, cameras, clocks = [], [], {}
    for name, file, radius, options, looks in VIEWS[1:2] if trial else VIEWS:
        path = folder / file if file.startswith("data/") else shared / file
        views = [f"{name} {number}" if len(looks) > 1 else name for number in range(1, len(looks) + 1)]
        looking = [*options, *[word for look in looks for word in ("--camera", look)]]
        for kind, limit, chosen in runs(trial, radius):
            told, command = compare(path, "--at", "pixels", "--max-distance", limit, *looking, *chosen)
            rows += rows_of(told, views, kind)
            clocks.update({row["engine"]: row["clock"] for row in told["rows"]})
            if kind in ("near", "far"):
                cameras += [{"kind": kind, "view": view, "model": name, "radius": limit,
                             "from": camera["text"], "share": camera["share"],
                             "noise": camera["noise"], "mean_occlusion": camera["mean_occlusion"]}
                            for view, camera in zip(views, told["cameras"])]
    return command, {"device": told["renderer"], "software": told["software"], "clocks": clocks,
                     "cameras": cameras, "rows": rows}
