"""exact_views.py: views of docs/figures/pixels.json: the exact pass at pixels (docs/pixels.md)."""

from figure_views import fixed, short, table, thousands, view

LIMITS = {0: "none", 0.1: "a tenth"}


def chosen(figures, setting):
    return [row for row in figures["pixels"]["rows"] if row["setting"] == setting]


@view
def pixel_errors(figures, setting):
    """Errors at pixels: each view, and all together"""
    rows = []
    for row in chosen(figures, setting):
        where = f"{row['model']}, {'all' if row['view'] == 1 else 'near'}" if "view" in row \
            else "**all views**"
        rows.append([where, LIMITS[row["limit"]], thousands(row["points"]), row["ill_defined"],
                     short(row["rmse"], 4), short(row["bias"], 4, "+"), short(row["p95"], 3),
                     short(row["max"], 3), short(row["between"], 4)])
    return table(["view", "limit", "points", "left out", "RMSE", "bias", "p95", "max",
                  "two cameras"], rows)


@view
def pixel_times(figures):
    """Seconds of a picture, without and with what its edges cost"""
    rows = []
    for draft, good in zip(chosen(figures, "draft"), chosen(figures, "good")):
        if "view" not in good or good["limit"] != 0:
            continue
        rows.append([f"{good['model']}, {'all' if good['view'] == 1 else 'near'}",
                     thousands(good["pixels"]),
                     fixed(good["tree_s"] + good["outlines_s"], 2),
                     fixed(draft["see_s"] + draft["solve_s"], 2),
                     fixed(good["see_s"] + good["solve_s"], 2), thousands(good["extras"]),
                     fixed(good["edges_s"], 2)])
    return table(["view", "pixels that see something", "tree and outlines, s", "draft, s", "good, s",
                  "further receivers", "edges, s"], rows)


@view
def pixel_worst(figures, setting, key):
    """The largest RMSE, p95 or difference between two cameras of any view"""
    return short(max(row[key] for row in chosen(figures, setting) if "view" in row),
                 3 if key == "p95" else 4)


@view
def pixel_all(figures, setting, limit, key):
    """A figure of all views together"""
    for row in chosen(figures, setting):
        if "view" not in row and LIMITS[row["limit"]].split()[-1] == limit:
            return short(row[key], 3 if key == "p95" else 4)
    raise KeyError(limit)
