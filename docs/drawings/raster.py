"""Drawings of masks.md about the bits: directions, weights, polygons, limits."""
import math
import random

import mask_constants
from svg import BLUE, FAINT, GREEN, GRID, INK, ORANGE, RED, TINTS, Drawing, Panel

ROWS, COLUMNS = 16, 32
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0

# tree/masks/raster.cpp: rows at equal angles, each shifted by a multiple of the golden ratio
ROW_V = [math.tan(((y + 0.5) / ROWS - 0.5) * math.pi / 2.0) for y in range(ROWS)]
ROW_SHIFT = [y * GOLDEN - math.floor(y * GOLDEN) for y in range(ROWS)]


def column_u(x, y, shift=True):
    return (x + (ROW_SHIFT[y] if shift else 0.5)) / 16.0 - 1.0


def solid_angle(u, v):
    """Of one bit: du dv / L^3 with du = 1/16, dv = (1 + v^2) pi / 32."""
    length = math.sqrt(1.0 + u * u + v * v)
    return (1.0 + v * v) / length ** 3 / 16.0 * math.pi / 32.0


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def minus(a, b):
    return tuple(p - q for p, q in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return tuple(p / length for p in a)


def edge_planes(corners):
    """Normals of the planes through the origin and each edge, turned inward."""
    count = len(corners)
    normals = [cross(c, minus(corners[(i + 1) % count], c)) for i, c in enumerate(corners)]
    turn = 1.0 if dot(normals[0], minus(corners[2], corners[1])) > 0.0 else -1.0
    return [tuple(turn * p for p in n) for n in normals]


def half_plane(n):
    """The sixteen rows of the +a face: bits from ceil(slope v + start - shift) up, or those below.
    n: along a, u and v."""
    scale = -16.0 / max(abs(n[1]), 1e-30) * (1.0 if n[1] >= 0.0 else -1.0)
    slope, start = n[2] * scale, 16.0 + n[0] * scale
    rows = []
    for y in range(ROWS):
        first = math.ceil(max(slope * ROW_V[y] + start - ROW_SHIFT[y], 0.0))
        bits = (~0 << first) & 0xFFFFFFFF if first < 32 else 0
        rows.append(bits if n[1] >= 0.0 else bits ^ 0xFFFFFFFF)
    return rows


def polygon_rows(corners):
    rows = [0xFFFFFFFF] * ROWS
    for n in edge_planes(corners):
        rows = [a & b for a, b in zip(rows, half_plane(n))]
    return rows


def bits_of(rows):
    return [(x, y) for y in range(ROWS) for x in range(COLUMNS) if rows[y] >> x & 1]


def share_of(bits, normal):
    """Cosine-weighted share of the hemisphere around `normal` that bits of the +a face stand for."""
    total = 0.0
    for x, y in bits:
        u, v = column_u(x, y), ROW_V[y]
        total += solid_angle(u, v) * dot(normal, (1.0, u, v)) / math.sqrt(1.0 + u * u + v * v)
    return total / math.pi


def exact_share(corners, normal):
    """Lambert 1760: 1/(2 pi) times the sum over edges of the angle they subtend times n.Gamma."""
    total = 0.0
    for n, a, b in zip(edge_planes(corners), corners, corners[1:] + corners[:1]):
        angle = math.acos(max(-1.0, min(1.0, dot(unit(a), unit(b)))))
        total += angle * dot(normal, unit(n))
    return abs(total) / (2.0 * math.pi)


def set_of_bits(panel, bits, fill, r=2.6):
    panel.dots([(column_u(x, y), ROW_V[y]) for x, y in bits], r, fill)


def raster_face(numbers):
    d = Drawing(860, 470)
    p = Panel(d, 40, 50, 380, 380, (-1.02, 1.02), (-1.02, 1.02))
    p.title("One face: 16 rows of 32 bits")
    p.path([(-1, -1), (1, -1), (1, 1), (-1, 1)], stroke=FAINT, close=True, width=1)
    largest = solid_angle(0.0, 0.05)
    for y in range(ROWS):
        p.path([(-1, ROW_V[y]), (1, ROW_V[y])], stroke=GRID, width=1)
        for x in range(COLUMNS):
            u, v = column_u(x, y), ROW_V[y]
            p.dot((u, v), 4.6 * math.sqrt(solid_angle(u, v) / largest), fill=BLUE, opacity=0.75)
    p.text((1, -1), "u", dx=8, dy=4)
    p.text((-1, 1), "v", dx=-14, dy=4)
    p.text((-1, -1), "a dot's area: the solid angle of its bit", dy=24, size=12)

    # the same upright edge at every place of one column: how much of the face lies right of it
    def counted(u, shift):
        return sum(1 for y in range(ROWS) for x in range(COLUMNS)
                   if column_u(x, y, shift) >= u) / (ROWS * COLUMNS)

    q = Panel(d, 520, 60, 300, 160, (0.0, 0.1875), (0.4, 0.5))
    q.axes([(i / 16, f"{i}/16") for i in range(4)], [(0.4, ".40"), (0.45, ".45"), (0.5, ".50")])
    d.text(520, 36, "An upright edge at u: share of set bits", bold=True)
    steps = [0.1875 * (i + 0.5) / 600 for i in range(600)]
    q.path([(0, 0.5), (0.1875, 0.5 - 0.1875 / 2)], stroke=INK, width=1)
    q.path([(u, counted(u, False)) for u in steps], stroke=ORANGE)
    q.path([(u, counted(u, True)) for u in steps], stroke=BLUE)
    d.text(655, 78, "rows shifted: 512 places", BLUE, 11)
    d.text(655, 92, "columns in line: 32 places", ORANGE, 11)
    d.text(675, 106, "exact", INK, 11)
    numbers["edge error shifted"] = max(abs(counted(u, True) - (1 - u) / 2) for u in steps)
    numbers["edge error in line"] = max(abs(counted(u, False) - (1 - u) / 2) for u in steps)
    numbers["mean shift"] = sum(ROW_SHIFT) / ROWS

    r = Panel(d, 520, 300, 300, 120, (-0.6, 6.6), (-0.6, 15.6))
    d.text(520, 276, "Where the bits stand within their columns", bold=True)
    for x in range(7):
        r.path([(x, -0.5), (x, 15.5)], stroke=GRID, width=1)
    for y in range(ROWS):
        r.dots([(x + ROW_SHIFT[y], y) for x in range(6)], 2.2, BLUE)
    r.text((0, -0.6), "row y is moved by frac(0.618 y) columns", dy=18, size=12)
    total = sum(solid_angle(column_u(x, y), ROW_V[y]) for y in range(ROWS) for x in range(COLUMNS))
    numbers["sphere of solid angles"] = 6.0 * total / (4.0 * math.pi)
    angles = [solid_angle(column_u(x, y), ROW_V[y]) for y in range(ROWS) for x in range(COLUMNS)]
    numbers["largest over smallest bit"] = max(angles) / min(angles)
    numbers["largest bit of the hemisphere"] = max(angles) / math.pi
    return d


QUAD = [(1.0, -0.62, -0.30), (1.0, 0.40, -0.66), (0.8, 0.56, 0.34), (1.25, -0.30, 0.62)]


def polygon_rows_drawing(numbers):
    d = Drawing(860, 520)
    p = Panel(d, 40, 50, 400, 400, (-1.02, 1.02), (-1.02, 1.02))
    p.title("A quadrilateral on the +a face")
    outline = [(c[1] / c[0], c[2] / c[0]) for c in QUAD]
    rows = polygon_rows(QUAD)
    bits = bits_of(rows)
    p.path([(-1, -1), (1, -1), (1, 1), (-1, 1)], stroke=FAINT, close=True, width=1)
    every = [(x, y) for y in range(ROWS) for x in range(COLUMNS)]
    set_of_bits(p, every, "#d5dce6", r=1.8)
    p.area(outline, ORANGE, opacity=0.55)
    set_of_bits(p, bits, BLUE)
    normal = unit((1.0, 0.2, 0.4))
    counted, exact = share_of(bits, normal), exact_share(QUAD, normal)
    numbers.update({"quad bits": len(bits), "quad share": counted, "quad exact": exact,
                    "quad error": counted - exact})
    p.text((-1, -1), f"{len(bits)} bits, share {counted:.4f}; Lambert's formula {exact:.4f}", dy=28)
    anywhere = random.Random(1)
    triangles = [[(1.0, anywhere.uniform(-1, 1), anywhere.uniform(-1, 1)) for _ in range(3)]
                 for _ in range(400)]
    errors = [share_of(bits_of(polygon_rows(t)), normal) - exact_share(t, normal)
              for t in triangles]
    numbers["triangle rms error"] = math.sqrt(sum(e * e for e in errors) / len(errors))
    numbers["triangle mean share"] = (sum(exact_share(t, normal) for t in triangles)
                                      / len(triangles))

    d.text(500, 40, "Edges are half-planes, the polygon their AND", bold=True)
    planes = edge_planes(QUAD)
    # along a, u, v as they are: the face is +x, so (x, y, z) = (a, u, v)
    for i, n in enumerate(planes):
        q = Panel(d, 500 + (i % 2) * 170, 70 + (i // 2) * 165, 140, 140, (-1.05, 1.05),
                  (-1.05, 1.05))
        set_of_bits(q, every, "#d5dce6", r=0.9)
        set_of_bits(q, bits_of(half_plane(n)), TINTS[BLUE], r=2.0)
        set_of_bits(q, bits, BLUE, r=2.0)
        a, b = outline[i], outline[(i + 1) % 4]
        q.path([a, b], stroke=ORANGE, width=3)
        q.frame()
        side = "from x up" if n[1] >= 0 else "below x"
        q.text((-1.05, -1.05), f"edge {i}: bits {side}", dy=14, size=11)
    y = 9
    n = planes[3]
    scale = -16.0 / n[1]
    t = n[2] * scale * ROW_V[y] + 16.0 + n[0] * scale - ROW_SHIFT[y]
    numbers.update({"row slope": n[2] * scale, "row start": 16.0 + n[0] * scale,
                    "row v": ROW_V[y], "row shift": ROW_SHIFT[y], "row t": t})
    d.text(500, 435, f"row {y} of edge 3: slope {n[2] * scale:.2f}, start {16 + n[0] * scale:.2f}",
           size=12)
    d.text(500, 455, f"x >= {n[2] * scale:.2f} * {ROW_V[y]:.3f} + {16 + n[0] * scale:.2f}"
           f" - {ROW_SHIFT[y]:.3f} = {t:.2f}", size=12)
    d.text(500, 475, f"so the bits from {math.ceil(t)} up", size=12)
    return d


def visibility(numbers):
    d = Drawing(860, 330)
    walls = [((-0.9, 1.0), (0.15, 1.25), BLUE), ((-0.55, 1.75), (0.75, 1.7), ORANGE)]

    def covers(wall, angle):
        """Whether the ray at an angle from the normal meets the wall from a to b."""
        (ax, ay), (bx, by), _ = wall
        low, high = sorted((math.atan2(ax, ay), math.atan2(bx, by)))
        return low <= angle <= high

    count = 48
    middles = [math.pi * ((i + 0.5) / count - 0.5) for i in range(count)]
    weights = [math.cos(m) * math.pi / count / 2.0 for m in middles]
    alone = [sum(w for w, m in zip(weights, middles) if covers(wall, m)) for wall in walls]
    union = sum(w for w, m in zip(weights, middles) if any(covers(s, m) for s in walls))
    numbers.update({"layer 1": alone[0], "layer 2": alone[1], "layers summed": sum(alone),
                    "layers united": union})
    p = Panel(d, 30, 40, 440, 260, (-2.0, 2.0), (-0.3, 2.064))
    p.title("Two layers over one receiver")
    p.path([(-2, 0), (2, 0)], stroke=INK, width=2)
    for m in middles:
        hit = [s for s in walls if covers(s, m)]
        far = (2.0 * math.sin(m), 2.0 * math.cos(m))
        color = RED if len(hit) == 2 else hit[0][2] if hit else FAINT
        p.path([(0, 0), tuple(0.97 * q for q in far)], stroke=color, width=1,
               opacity=1 if hit else 0.6)
    for a, b, color in walls:
        p.path([a, b], stroke=color, width=5)
    p.arrow((0, 0), (0, 0.55), width=2)
    p.text((0.03, 0.42), "n", dx=6)
    p.dot((0, 0), 4)
    x = 510
    d.text(x, 40, "Sum: what each covers, added", bold=True)
    d.text(x, 62, f"{alone[0]:.3f} + {alone[1]:.3f} = {sum(alone):.3f}")
    d.text(x, 84, "the red directions count twice", RED, 12)
    d.text(x, 130, "Bits: each direction once", bold=True)
    for row, (label, test) in enumerate((
            ("near", lambda m: covers(walls[0], m)), ("far", lambda m: covers(walls[1], m)),
            ("OR", lambda m: covers(walls[0], m) or covers(walls[1], m)))):
        y = 150 + 34 * row
        for i, m in enumerate(middles):
            color = (BLUE, ORANGE, GREEN)[row]
            d.rect(x + 40 + 6 * i, y, 6, 20, stroke="#ffffff", width=0.5,
                   fill=color if test(m) else GRID)
        d.text(x, y + 15, label, size=12)
    d.text(x, 276, f"weight of the set bits: {union:.3f}", GREEN)
    return d


def limit_cone(numbers):
    d = Drawing(860, 330)
    p = Panel(d, 30, 50, 380, 240, (-1.9, 1.9), (-0.2, 2.2))
    height, limit = 0.8, 1.3
    half = math.sqrt(limit * limit - height * height)
    p.title("A polygon's plane at height h, a limit D")
    arc = [(limit * math.sin(a), limit * math.cos(a))
           for a in (math.pi * (i / 60.0 - 0.5) for i in range(61))]
    p.path([(-1.9, 0), (1.9, 0)], width=2)
    p.path(arc, stroke=FAINT, dash="5 4")
    p.path([(-1.8, height), (-half, height)], stroke=FAINT, width=4)
    p.path([(half, height), (1.8, height)], stroke=FAINT, width=4)
    p.path([(-half, height), (half, height)], stroke=BLUE, width=4)
    for x in (-half, half):
        p.path([(0, 0), (x * 1.7, height * 1.7)], stroke=ORANGE)
    p.dot((0, 0), 4)
    p.path([(0, 0), (0, height)], stroke=INK, dash="2 3", width=1)
    p.text((0, height / 2), "h", dx=6)
    p.text((half, height), "D", dx=-32, dy=26)
    p.text((0, 1.75), "kept: n.w > h / D", color=ORANGE, anchor="middle")
    q = Panel(d, 500, 50, 240, 240, (-1.02, 1.02), (-1.02, 1.02))
    q.title("The cone's bits on one face, n = (.8, .5, .33)")
    n = unit((0.8, 0.5, 0.33))
    k = 0.8
    every = [(x, y) for y in range(ROWS) for x in range(COLUMNS)]
    inside = [(x, y) for x, y in every
              if dot(n, unit((1.0, column_u(x, y), ROW_V[y]))) >= k]
    set_of_bits(q, every, "#d5dce6", r=1.6)
    set_of_bits(q, inside, BLUE, r=2.2)
    q.frame()
    q.text((-1.02, -1.02), f"h / D = {k}: {len(inside)} bits", dy=20, size=12)
    numbers["cone bits"] = len(inside)
    return d


def falloff(numbers):
    d = Drawing(560, 320)
    p = Panel(d, 60, 40, 460, 220, (0, 1), (0, 1.02))
    p.axes([(i / 5, f"{i / 5:.1f}") for i in range(6)], [(0, "0"), (0.5, ".5"), (1, "1")],
           "distance of the hit over the limit D", "weight of a hit")
    places = [i / 400 for i in range(401)]
    steps = mask_constants.falloff()

    def stepped(t):
        return sum(weight for limit, weight in steps if t < limit)
    p.path([(t, stepped(t)) for t in places], stroke=BLUE)
    p.path([(t, (1 - t * t) ** 2) for t in places], stroke=ORANGE, width=2)
    for limit, _ in steps:
        p.dot((limit, 0), 3.5, fill=BLUE)
    p.text((0.45, 0.88), "(1 - (t/D)^2)^2", color=ORANGE)
    p.text((0.45, 0.77), "sum over five limits (dots)", color=BLUE)
    numbers["falloff limits"] = [limit for limit, _ in steps]
    numbers["falloff error"] = max(abs(stepped(t) - (1 - t * t) ** 2) for t in places)
    return d


def steps(numbers):
    d = Drawing(860, 330)

    def box(x, y, title, words, color, w=150):
        d.rect(x, y, w, 62, stroke=color, fill="#ffffff", width=1.5)
        d.text(x + w / 2, y + 25, title, color, 13, "middle", True)
        d.text(x + w / 2, y + 46, words, INK, 11, "middle")

    box(20, 40, "triangles", "unit frame, welded", INK)
    box(210, 40, "tiles", "flat pairs (5)", BLUE)
    box(400, 40, "tree", "nodes as rectangles (4, 5)", BLUE, 190)
    box(20, 220, "receivers", "points with normals", INK)
    box(210, 220, "groups", "16 neighbours, cones (6)", ORANGE, 170)
    box(630, 40, "walk", "which nodes, for whom (6)", GREEN, 200)
    box(630, 130, "shared masks", "drawn once for a group (3, 7)", GREEN, 200)
    box(630, 220, "own masks", "lists, 16 receivers (3, 6)", GREEN, 200)
    box(410, 220, "answers", "sums (2), cracks (8)", RED, 180)
    for a, b in (((170, 71), (210, 71)), ((360, 71), (400, 71)), ((590, 71), (630, 71)),
                 ((170, 251), (210, 251)), ((730, 102), (730, 130)), ((730, 192), (730, 220))):
        d.arrow(a, b)
    d.path([(295, 220), (295, 161), (605, 161), (605, 85)])
    d.arrow((605, 85), (630, 85))
    d.arrow((630, 251), (590, 251))
    d.text(20, 130, "once per scene", BLUE, 12)
    d.text(20, 312, "once per set of receivers", ORANGE, 12)
    d.text(630, 312, "per solve; numbers: sections", GREEN, 12)
    return d


DRAWINGS = {"steps": steps, "visibility": visibility, "raster_face": raster_face,
            "polygon_rows": polygon_rows_drawing, "limit_cone": limit_cone, "falloff": falloff}
