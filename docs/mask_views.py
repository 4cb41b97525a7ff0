"""mask_views.py: views of masks.md: the mask engine's constants and the worked numbers of its
drawings. A part of figure_views.py."""

import json

import mask_constants
from figure_views import fixed, table, view


def short_number(text):
    """0.9 for 0.90, 5 for 5.0."""
    return text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text


def cell(text):
    return text.replace("|", "\\|")


@view
def mask(figures, name):
    """mask NAME: the value of the constant kMaskNAME"""
    for row in mask_constants.rows():
        if row["name"] == "kMask" + name:
            return short_number(row["value"])
    raise KeyError(name)


@view
def mask_family(figures):
    """The mask engine's parameters at whole qualities"""
    names = {0: "draft", 1: "good", 2: "best"}
    return table(["quality", "s (cluster)", "r (share, leaf groups)", "u (share, inner groups)",
                  "g (grazing)"],
                 [[f"{row[0]:g} {names.get(row[0], '')}".strip(), *(f"{value:g}" for value in row[1:])]
                  for row in mask_constants.family()])


@view
def mask_falloff(figures):
    """The limits that stand for the smooth falloff, and what hits within them count"""
    return table(["distance over D", "weight"],
                 [[f"{value:g}" for value in row] for row in mask_constants.falloff()])


@view
def mask_constants_table(figures):
    """Every constant of the mask engine: value, unit, neutral value, reason, effect"""
    text = ""
    for title, rows in mask_constants.read():
        shown = [[f"`{row['name']}`", short_number(row["value"]), cell(row["unit"]),
                  cell(row["neutral"]), cell(row["reason"]), cell(row["effect"])]
                 for row in rows if row["kind"] == "CONSTANT"]
        if shown:
            text += f"**{title}**\n\n" + table(
                ["name", "value", "unit", "neutral", "reason", "effect"], shown) + "\n"
    return text


def drawn_number(figures, key):
    path = figures.folder.parent / "drawings/numbers.json"
    return json.loads(path.read_text())[key.replace("_", " ")]


@view
def drawn(figures, key, digits="3"):
    """drawn KEY [DIGITS]: a worked number of the drawings ("_" for spaces)"""
    return fixed(drawn_number(figures, key), int(digits))


@view
def drawn_percent(figures, key, digits="1"):
    """drawn_percent KEY [DIGITS]: the same, a share in percent"""
    return fixed(100 * drawn_number(figures, key), int(digits))


def instructions(row):
    """Vector instructions of sixteen lanes per receiver, by the costs that masks.md derives."""
    polygons = row["drawn"] + row["shared"]
    return (row["visits"] * 180 / 16 + row["listed"] * 40 / 16 + polygons * 350 / 16
            + polygons * row["faces"] * (6 * 4 + 3)
            + 150 * (2 + row["filled"] + row["closed"]) + 100)


@view
def mask_counts(figures):
    """Nodes, polygons and faces per receiver, scene by scene, and instructions per time"""
    rows = []
    for row in figures["mask_counts"]["rows"]:
        scene = next((s for s in figures["frontier"]["scenes"] if s["name"] == row["scene"]), None)
        timed = [r for r in scene["rows"] if r["engine"] == "masks" and r["setting"] == row["setting"]
                 and "us_per_receiver" in r] if scene else []
        rows.append([f"{row['scene']}, {row['setting']}", fixed(row["visits"], 0),
                     fixed(row["listed"], 0), fixed(row["drawn"], 0), fixed(row["shared"], 1),
                     fixed(row["faces"], 2), fixed(row["filled"], 2), fixed(row["closed"], 2),
                     f"{instructions(row):,.0f}",
                     fixed(instructions(row) / timed[0]["us_per_receiver"], 0) if timed else ""])
    return table(["", "V", "P", "Q", "S", "F", "filled", "closed", "instructions",
                  "over measured us, two threads"], rows)


@view
def mask_count(figures, scene, setting, key, digits="0"):
    """mask_count SCENE SETTING KEY|instructions [DIGITS]: one of them"""
    for row in figures["mask_counts"]["rows"]:
        if (row["scene"], row["setting"]) == (scene, setting):
            return f"{instructions(row) if key == 'instructions' else row[key]:,.{int(digits)}f}"
    raise KeyError(f"{scene} {setting}")
