"""cloud_views.py: views of docs/figures/clouds.json and clouds_pcv.json: clouds of points against the
surfaces that they were sampled from, and CloudCompare's PCV beside them (docs/clouds.md)."""

from figure_views import fixed, short, table, thousands, view


def errors(row):
    return [short(row["rmse"], 4), short(row["bias"], 4, "+"), short(row["p95"], 3), short(row["max"], 2)]


@view
def cloud_rows(figures):
    """Each scan as points: errors against the mesh, and normals that look inward"""
    return table(["model", "points", "cloud", "RMSE", "bias", "p95", "max", "turned inward"],
                 [[row["model"], thousands(row["points"]), row["condition"], *errors(row),
                   fixed(100 * row["turned"], 3) + " %"] for row in figures["clouds"]["rows"]])


@view
def cloud_thin(figures):
    """Thin layers and interiors as points"""
    return table(["points", "cloud", "RMSE", "bias", "p95", "max", "turned inward"],
                 [[thousands(row["points"]), row["condition"], *errors(row),
                   fixed(100 * row["turned"], 1) + " %"] for row in figures["clouds"]["thin"]])


@view
def cloud_family(figures):
    """Generated scenes as points: geometric means of RMSE over either half"""
    halves = figures["clouds"]["family"]
    return table(["cloud", "scenes", "half on which constants were chosen", "the other half"],
                 [[row["condition"], int(row["scenes"]), short(row["rmse"], 4), short(other["rmse"], 4)]
                  for row, other in zip(halves["choosing"], halves["judging"])])


@view
def cloud_large(figures):
    """A large cloud from file to file: seconds of each stage, and memory"""
    stages = ("read", "points", "tree", "solve", "check", "write", "total")
    return table(["points", "normals", *stages, "MiB"],
                 [[thousands(row["points"]), "of the file" if row["normals"] else "fitted",
                   *[fixed(row[stage], 2) for stage in stages], fixed(row["mib"], 0)]
                  for row in figures["clouds"]["large"]])


@view
def cloud_pcv(figures):
    """Our error and time, and PCV's at several sizes of its pictures"""
    rows = []
    for row in figures["clouds_pcv"]["rows"]:
        kind = ("clean" if row["noise"] == 0 else "noisy") + (", normals" if row["normals"] else "")
        rows.append([kind, "surfelao bake", short(row["ours"], 3), "", fixed(row["ours_s"], 2)])
        rows += [[kind, f"PCV, {pcv['pixels']} pixels", short(pcv["cosine"], 3), short(pcv["own"], 3),
                  fixed(pcv["s"], 2)] for pcv in row["pcv"]]
    return table(["cloud of 50,000", "by", "error in cosine occlusion", "in PCV's own measure",
                  "seconds"], rows)

