"""viewer_views.py: views of docs/figures/viewers.json, what programs show of a result (docs/results.md)."""

from figure_views import fixed, joined, short, table, view


def after(figures, part, program, **keys):
    """The one row of a part whose program starts so."""
    rows = [row for row in figures["viewers"][part] if row["program"].startswith(program)
            and all(row[key] == value for key, value in keys.items())]
    if len(rows) != 1:
        raise KeyError(f"{part} {program} {keys}")
    return rows[0]


@view
def viewers_formats(figures):
    """Mean visibility that a result holds and that three.js and Blender show, before and after"""
    rows = []
    for model in ("bunny", "corner"):
        for form in ("glb", "gltf", "ply", "obj"):
            cells = [after(figures, "formats", program, model=model, when=when, format=form)
                     for program in ("three.js", "Blender") for when in ("before", "after")]
            rows.append([model, f".{form}", short(cells[0]["truth"], 3),
                         *(short(cell["screen"], 3) for cell in cells)])
    return table(["mesh", "file", "it holds", "three.js before", "now", "Blender before", "now"], rows)


@view
def viewers_worst(figures, when="after", key="difference"):
    """viewers_worst before|after difference|rms: the largest of the table above"""
    return fixed(max(abs(row[key]) for row in figures["viewers"]["formats"] if row["when"] == when), 4)


@view
def viewers_maps(figures):
    """Mean visibility that three.js and Blender show of maps over new texture coordinates"""
    rows = []
    for model in ("bunny", "corner"):
        for form in ("glb", "gltf"):
            cells = [after(figures, "maps", program, model=model, format=form)
                     for program in ("three.js", "Blender")]
            rows.append([model, f".{form}", short(cells[0]["truth"], 3),
                         *(short(cell["screen"], 3) for cell in cells)])
    return table(["mesh", "file", "a bake of vertices holds", "three.js, ambient light alone",
                  "Blender, the image at the socket Occlusion"], rows)


@view
def viewers_before(figures):
    """The commit of `before`"""
    return figures["viewers"]["before"]


@view
def viewers_programs(figures):
    """Which programs were asked"""
    parts = ("formats", "others")
    return joined(dict.fromkeys(row["program"] for part in parts for row in figures["viewers"][part]))


@view
def viewers_textured(figures):
    """The textured corner: what changed, what remains of its light under ambient light"""
    words = {"unlit": "unlit", "direct": "direct light alone", "ambient": "ambient light alone",
             "texture": "Solid, Color: Texture", "occlusion": "the image at the socket Occlusion",
             "imported": "ambient light, as imported", "uv2": "the same, Ambient Occlusion > On UV2",
             "lit": "its own light"}
    return table(["program", "how it is shown", "mean change of a colour", "shown visibility",
                  "it holds", "RMS"],
                 [[row["program"], words[row["show"]],
                   fixed(row["changed"], 4) if "changed" in row else "",
                   *(fixed(row[key], 3) if key in row else "" for key in ("screen", "truth", "rms"))]
                  for row in figures["viewers"]["textured"]])


@view
def viewers_other(figures, program, show, key="screen"):
    """viewers_other PROGRAM SHOW [KEY]: of the scan's .glb in Godot and model-viewer"""
    return fixed(after(figures, "others", program, show=show)[key], 3)


@view
def viewers_attributes(figures, program, form):
    """viewers_attributes PROGRAM FORMAT: what the mesh has there by name"""
    names = after(figures, "bent", program, format=form)["attributes"]
    return ", ".join(f"`{name}`" for name in names if not name.startswith("."))
