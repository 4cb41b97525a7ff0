"""family_views.py: views of docs/figures/family.json: solve errors of masks over the family of generated
scenes and over models, without a distance limit and within some (docs/measurements.md)."""

from figure_views import fixed, quantile, short, table, view

QUALITIES = ("draft", "good", "best", "4")
HALVES = (("choosing", "choosing"), ("judging", "judging"), ("model", "models"))
BIASED = 0.003   # in occlusion
SAME = 1e-4      # in occlusion: errors that differ by less are one


def rows_of(figures, limit, half):
    return [row for row in figures["family"]["limits"][limit] if half in ("family", row["half"])
            and (half != "family" or row["half"] != "model")]


def figure_of(rows, quality, name):
    return [row["qualities"][QUALITIES.index(quality)][name] for row in rows]


def grows(row):
    """Whether a better quality is worse."""
    errors = [cell["rmse"] for cell in row["qualities"]]
    return any(later > earlier + SAME for earlier, later in zip(errors, errors[1:]))


@view
def family_halves(figures):
    """family_halves: RMSE and bias over either half and the models, by quality"""
    rows = []
    for half, name in HALVES:
        some = rows_of(figures, "none", half)
        for quality in QUALITIES:
            errors, biases = (figure_of(some, quality, what) for what in ("rmse", "bias"))
            rows.append([name, len(some), quality, short(quantile(errors, 0.5), 4),
                         short(quantile(errors, 0.95), 4), short(max(errors), 4),
                         short(min(biases), 4, "+"), short(max(biases), 4, "+"),
                         sum(abs(bias) > BIASED for bias in biases)])
    return table(["scenes", "number", "quality", "RMSE, median", "RMSE, 95 %", "RMSE, largest",
                  "least bias", "largest bias", "beyond .003"], rows)


@view
def family_kinds(figures):
    """family_kinds: median RMSE and mean bias of each kind, of both halves"""
    some = rows_of(figures, "none", "family")
    rows = []
    for kind in dict.fromkeys(row["kind"] for row in some):
        row = [kind.replace("_", " ")]
        for half in ("choosing", "judging"):
            scenes = [scene for scene in rows_of(figures, "none", half) if scene["kind"] == kind]
            for quality in QUALITIES[:3]:
                biases = figure_of(scenes, quality, "bias")
                row.append(f"{short(quantile(figure_of(scenes, quality, 'rmse'), 0.5), 4)}, "
                           f"{short(sum(biases) / len(biases), 4, '+')}")
        rows.append(row)
    return table(["kind", *[f"{quality}, {half}" for half in ("chosen on", "judged on")
                            for quality in QUALITIES[:3]]], rows)


@view
def family_models(figures):
    """family_models: the models one by one"""
    return table(["model", *QUALITIES],
                 [[row["kind"], *[f"{short(cell['rmse'], 4)}, {short(cell['bias'], 4, '+')}"
                                  for cell in row["qualities"]]]
                  for row in rows_of(figures, "none", "model")])


@view
def family_limits(figures):
    """family_limits: at good within distance limits, over the judging half and the models"""
    rows = []
    for limit in figures["family"]["limits"]:
        for half, name in HALVES[1:]:
            some = rows_of(figures, limit, half)
            errors, biases = (figure_of(some, "good", what) for what in ("rmse", "bias"))
            rows.append([limit, name, short(quantile(errors, 0.5), 4), short(quantile(errors, 0.95), 4),
                         short(sum(biases) / len(biases), 4, "+"), short(min(biases), 4, "+"),
                         short(max(biases), 4, "+")])
    return table(["limit", "scenes", "RMSE, median", "RMSE, 95 %", "mean bias", "least", "largest"],
                 rows)


@view
def family_growing(figures):
    """family_growing: of all scenes, those in which a better quality is worse by more than .0001"""
    some = rows_of(figures, "none", "family") + rows_of(figures, "none", "model")
    return f"{sum(map(grows, some))} of {len(some)}"
