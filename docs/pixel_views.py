"""pixel_views.py: views of docs/figures/origin.json: screen-space methods and ours at the pixels of five
views, beside what the comparison from which the project comes has published (docs/pixel_comparison.md)."""

from figure_views import fixed, joined, table, thousands, view

METHODS = {"ssao-disc": "SSAO disc", "ssao-sphere": "SSAO sphere", "vo": "VO", "hbao": "HBAO"}
ALL_METHODS = {**METHODS, "gtao": "GTAO", "bitmask": "bit mask"}
SAMPLES = (24, 16, 8)

# Vocilka. Vergleich von Screen-Space-Ambient-Occlusion-Verfahren. Bachelor thesis, University of Applied
# Sciences Munich, 2013: RMSE in per cent at 24, 16 and 8 samples. What its text as it is at hand has lost is
# None; which group is which scene is told by the order of its pages.
PUBLISHED = {
    "dragon": {"ssao-disc": (4.8, 4.9, 5.6), "ssao-sphere": (4.8, 6.4, 23.7),
               "vo": (2.3, 2.4, 2.5), "hbao": (2.4, 2.5, 2.8)},
    "Sponza 1": {"ssao-disc": (7.7, 7.9, 8.7), "ssao-sphere": (7.8, 10.4, 31),
                 "vo": (5.5, 5.6, 5.7), "hbao": (4.9, 5.1, 5.7)},
    "Sponza 2": {"ssao-disc": (7.2, 7.2, 7.7), "ssao-sphere": (6.9, 13, 26.8),
                 "vo": (5.1, 5.3, 5.2), "hbao": (4.8, 5.1, 5.4)},
    "Sponza 3": {"ssao-disc": (9.2, 9.3, 9.8), "ssao-sphere": (10.3, 13.3, 27),
                 "vo": None, "hbao": None},
}


def views_of(figures):
    return [camera["view"] for camera in figures["origin"]["cameras"] if camera["kind"] == "far"]


def taps_of(setting):
    """Samples of a pass: "24 samples", "6 x 4, bias 30"."""
    words = setting.split(",")[0].split()
    return int(words[0]) * int(words[2]) if "x" in words else int(words[0])


def rows_of(figures, kind, engine, samples=None):
    """{view: row}; of an engine of the scene `samples` is its setting."""
    return {row["view"]: row for row in figures["origin"]["rows"]
            if row["kind"] == kind and row["engine"] == engine
            and (samples is None or row["setting"] == samples or
                 (isinstance(samples, int) and engine not in ("masks", "rays")
                  and taps_of(row["setting"]) == samples))}


def mean_of(rows, key):
    return sum(row[key] for row in rows.values()) / len(rows)


def mean(figures, kind, engine, samples, key="rmse"):
    return mean_of(rows_of(figures, kind, engine, samples), key)


def percents(values):
    return ["lost" if value is None else fixed(value, 1) for value in values]


@view
def origin_published(figures):
    """What the origin has published: RMSE in per cent by scene, method and samples"""
    rows = [[scene, METHODS[method], *percents(numbers or (None,) * 3)]
            for scene, methods in PUBLISHED.items() for method, numbers in methods.items()]
    return table(["view", "method", "24", "16", "8 samples"], rows)


@view
def origin_again(figures, key="rmse_whole"):
    """origin_again rmse_whole|rmse: its methods and others, near, in our views, RMSE in per cent"""
    rows = []
    for shown in views_of(figures):
        for method, name in ALL_METHODS.items():
            rows.append([shown, name,
                         *[fixed(rows_of(figures, "near", method, samples)[shown][key], 1)
                           for samples in SAMPLES]])
        for setting in ("good", "draft"):
            rows.append([shown, f"masks, {setting}",
                         fixed(rows_of(figures, "near", "masks", setting)[shown][key], 2), "", ""])
    return table(["view", "method", "24", "16", "8 samples"], rows)


@view
def origin_means(figures):
    """Means over the views, near: surface and whole RMSE, bias by samples, ms"""
    rows = []
    for method, name in ALL_METHODS.items():
        found = {samples: rows_of(figures, "near", method, samples) for samples in SAMPLES}
        rows.append([name, *[fixed(mean_of(found[samples], "rmse"), 1) for samples in SAMPLES],
                     *[f"{mean_of(found[samples], 'bias'):+.1f}" for samples in SAMPLES],
                     *[fixed(mean_of(found[samples], "ms"), 0) for samples in SAMPLES]])
    for setting in ("good", "draft"):
        found = rows_of(figures, "near", "masks", setting)
        rows.append([f"masks, {setting}", fixed(mean_of(found, "rmse"), 2), "", "",
                     f"{mean_of(found, 'bias'):+.2f}", "", "", fixed(mean_of(found, "ms"), 0), "", ""])
    return table(["means, %", "24", "16", "8 samples", "bias: 24", "16", "8", "ms: 24", "16", "8"], rows)


LADDER = (("masks", "good", "masks, good", "far"), ("masks", "draft", "masks, draft", "far"),
          ("rays", "64 rays", "rays, 64", "far"),
          ("gtao", 24, "GTAO, 24", "far"), ("gtao", 8, "GTAO, 8", "far"),
          ("bitmask", 24, "bit mask, 24", "far"), ("bitmask", 8, "bit mask, 8", "far"),
          ("hbao", 24, "HBAO, 24", "far"), ("hbao", 24, "HBAO, 24, as there", "far_there"),
          ("vo", 24, "VO, 24", "far"), ("vo", 24, "VO, 24, as there", "far_there"),
          ("ssao-sphere", 24, "SSAO sphere, 24", "far"),
          ("ssao-sphere", 24, "SSAO sphere, 24, as there", "far_there"),
          ("ssao-disc", 24, "SSAO disc, 24", "far"),
          ("ssao-disc", 24, "SSAO disc, 24, as there", "far_there"))


@view
def origin_all(figures):
    """Everyone: RMSE on surface pixels of each view, mean, whole picture, bias, p95, ms; per cent"""
    shown = views_of(figures)
    rows = []
    for engine, setting, name, kind in LADDER:
        found = rows_of(figures, kind, engine, setting)
        rows.append([name, *[fixed(found[look]["rmse"], 1) for look in shown],
                     fixed(mean_of(found, "rmse"), 1), fixed(mean_of(found, "rmse_whole"), 1),
                     f"{mean_of(found, 'bias'):+.1f}", fixed(mean_of(found, "p95"), 1),
                     fixed(mean_of(found, "ms"), 0)])
    return table(["", *shown, "mean", "whole picture", "bias", "p95", "ms"], rows)


@view
def origin_limits(figures, kind="far"):
    """origin_limits near|far: the methods with a thousand samples: RMSE in per cent on surface pixels"""
    shown = views_of(figures)
    rows = []
    for engine, name in (*ALL_METHODS.items(), ("masks", "masks, good")):
        found = rows_of(figures, f"{kind}_limit", engine)
        few = rows_of(figures, kind, engine, "good" if engine == "masks" else 24)
        rows.append([name, *[fixed(found[look]["rmse"], 1) for look in shown],
                     fixed(mean_of(found, "rmse"), 1), fixed(mean_of(few, "rmse"), 1)])
    return table(["", *shown, "mean", "with 24 samples"], rows)


@view
def origin_setup(figures):
    """What each view is: camera, share of the picture that is surface; mean occlusion and noise near and far"""
    rows = []
    near = {camera["view"]: camera for camera in figures["origin"]["cameras"] if camera["kind"] == "near"}
    for far in figures["origin"]["cameras"]:
        if far["kind"] != "far":
            continue
        one = near[far["view"]]
        rows.append([far["view"], f"`{far['from']}`", fixed(100 * far["share"], 0),
                     *[value for camera in (one, far)
                       for value in (camera["radius"].replace("%", " %"),
                                     fixed(100 * camera["mean_occlusion"], 0), fixed(camera["noise"], 2))]])
    return table(["view", "camera", "surface, %", "near: radius", "mean occlusion, %", "noise of the rays, %",
                  "far: radius", "mean occlusion, %", "noise, %"], rows)


@view
def origin_picture(figures, kind="far"):
    """origin_picture [KIND]: the size of the pictures"""
    row = next(row for row in figures["origin"]["rows"] if row["kind"] == kind)
    return f"{thousands(row['width'])} x {thousands(row['height'])}"


@view
def origin_device(figures):
    """Who drew, and what told the times"""
    part = figures["origin"]
    device = part["device"] + (" (software)" if part["software"] else "")
    clocks = sorted(set(part["clocks"].values()))
    return f"{device}; clocks: {joined(clocks)}"


@view
def origin_value(figures, kind, engine, setting, key="rmse", digits="1"):
    """origin_value KIND ENGINE SETTING [KEY [DIGITS]]: a mean over the views, in per cent or ms"""
    wanted = int(setting) if setting.isdigit() else setting
    return fixed(mean(figures, kind, engine, wanted, key), int(digits))


@view
def origin_better(figures, better, worse, samples, kind="near"):
    """origin_better BETTER WORSE SAMPLES [KIND]: "4 of 5" views in which one errs less than the other"""
    few, many = (rows_of(figures, kind, name, int(samples)) for name in (better, worse))
    won = sum(few[look]["rmse"] < many[look]["rmse"] for look in few)
    return f"{won} of {len(few)}"


@view
def origin_grows(figures, engine, kind="near"):
    """origin_grows ENGINE [KIND]: what 8 samples add to the error of 24, means, in per cent of it"""
    return fixed(100 * (mean(figures, kind, engine, 8) / mean(figures, kind, engine, 24) - 1), 0)


@view
def origin_times(figures, engine, setting, over="masks", good="good"):
    """origin_times ENGINE SETTING: its mean RMSE over that of masks at good"""
    wanted = int(setting) if setting.isdigit() else setting
    return fixed(mean(figures, "far", engine, wanted) / mean(figures, "far", over, good), 0)
