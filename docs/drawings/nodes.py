"""Drawings of masks.md about the tree: rectangles from moments, depth, rims, pairs, splits."""
import math

import mask_constants
from svg import BLUE, FAINT, GREEN, GRID, INK, ORANGE, RED, Drawing, Panel

DILATION, CUT_REACH, SPREAD_MARGIN = (mask_constants.value_of("kMask" + name)
                                      for name in ("Dilation", "CutReach", "SpreadMargin"))


class Patch:
    """Sums over flat polygons of the plane, given as lists of corners, and their rectangle."""

    def __init__(self, polygons):
        self.area = 0.0
        first = [0.0, 0.0]
        second = [0.0, 0.0, 0.0]  # xx xy yy about the origin
        for polygon in polygons:
            for b, c in zip(polygon[1:], polygon[2:]):
                a = polygon[0]
                area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
                g = ((a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3)
                self.area += area
                for i, (k, m) in enumerate(((0, 0), (0, 1), (1, 1))):
                    corners = sum(p[k] * p[m] for p in (a, b, c))
                    second[i] += area / 12 * (corners + 9 * g[k] * g[m])
                first[0] += area * g[0]
                first[1] += area * g[1]
        self.center = (first[0] / self.area, first[1] / self.area)
        x, y = self.center
        xx, xy, yy = (second[0] / self.area - x * x, second[1] / self.area - x * y,
                      second[2] / self.area - y * y)
        mean, half = 0.5 * (xx + yy), 0.5 * (xx - yy)
        deviation = math.hypot(half, xy)
        self.wide, self.narrow = mean + deviation, mean - deviation
        angle = 0.5 * math.atan2(xy, half)
        self.axis = (math.cos(angle), math.sin(angle))
        self.radius = max(math.dist(self.center, p) for polygon in polygons for p in polygon)
        self.spread_area = 12 * math.sqrt(self.wide * self.narrow)
        self.cover = self.area / self.spread_area
        quarter = 0.25 * min(self.area, SPREAD_MARGIN * self.spread_area)
        u = min(math.sqrt(quarter * math.sqrt(self.wide / self.narrow)), self.radius)
        v = quarter / u
        shrink = min(1.0, self.radius / math.hypot(u, v))
        self.half = (u * shrink, v * shrink)

    def axes(self):
        (x, y), (u, v) = self.axis, self.half
        return (x * u, y * u), (-y * v, x * v)


def rectangle(center, along, across):
    return [(center[0] + s * along[0] + t * across[0], center[1] + s * along[1] + t * across[1])
            for s, t in ((1, 1), (-1, 1), (-1, -1), (1, -1))]


def moments_rectangle(numbers):
    d = Drawing(860, 330)
    blob = [(-1.5, -0.5), (-0.6, -0.9), (0.7, -0.5), (1.5, 0.3), (1.1, 0.9), (0.0, 0.75),
            (-1.1, 0.3)]
    spikes = [[(-1.5, -0.9), (1.5, -0.7), (1.45, -0.4), (-1.5, -0.55)],
              [(-1.4, -0.55), (-0.9, -0.5), (-0.9, 0.9), (-1.35, 0.85)],
              [(0.9, -0.45), (1.3, -0.4), (1.3, 0.8), (1.0, 0.85)]]
    for i, (title, polygons) in enumerate((("A sheet", [blob]), ("A patch with gaps", spikes))):
        p = Panel(d, 30 + 420 * i, 50, 380, 220, (-1.9, 1.9), (-1.1, 1.1))
        p.title(title)
        patch = Patch(polygons)
        for polygon in polygons:
            for b, c in zip(polygon[1:], polygon[2:]):
                p.area([polygon[0], b, c], BLUE, width=1)
        x, y = patch.axis
        su, sv = math.sqrt(3 * patch.wide), math.sqrt(3 * patch.narrow)
        p.path(rectangle(patch.center, (x * su, y * su), (-y * sv, x * sv)), stroke=INK,
               dash="3 3", width=1, close=True)
        p.path(rectangle(patch.center, *patch.axes()), stroke=ORANGE, width=2.5, close=True)
        p.dot(patch.center, 4, fill=ORANGE)
        for axis, length in ((patch.axis, math.sqrt(patch.wide)),
                             ((-y, x), math.sqrt(patch.narrow))):
            p.arrow(patch.center, (patch.center[0] + axis[0] * length,
                                   patch.center[1] + axis[1] * length), color=ORANGE)
        d.text(30 + 420 * i, 292, f"area {patch.area:.2f}, of the moments {patch.spread_area:.2f}: "
               f"cover {patch.cover:.2f}", size=12)
        name = "sheet" if i == 0 else "gaps"
        numbers.update({f"{name} area": patch.area, f"{name} spread area": patch.spread_area,
                        f"{name} cover": patch.cover, f"{name} wide": patch.wide,
                        f"{name} narrow": patch.narrow, f"{name} half sides": list(patch.half)})
    d.text(30, 314, "orange: the node's rectangle; dashed: half sides sqrt(3 lambda); arrows: "
           "sqrt(lambda) along the axes", size=12)
    triangle = Patch([[(0, 0), (1, 0), (0.3, 0.8)]])
    disk = Patch([[(math.cos(2 * math.pi * i / 720), math.sin(2 * math.pi * i / 720))
                   for i in range(720)]])
    numbers.update({"triangle cover": triangle.cover, "disk cover": disk.cover})
    return d


def open_radius(numbers):
    d = Drawing(560, 320)
    flat_penalty, flat_slope, penalty = (mask_constants.value_of("kMask" + name) for name in (
        "FlatPenalty", "FlatSlope", "FlatnessPenalty"))
    p = Panel(d, 60, 40, 460, 220, (-6, 0), (0.8, 6.2))
    p.axes([(e, f"1e{e}" if e else "1") for e in range(-6, 1)],
           [(k, str(k)) for k in (1, 2, 3, 4, 5, 6)], "1 - flatness")
    p.title("Open radius of a node without gaps, in spreads")
    places = [10 ** (-6 + 6 * i / 240) for i in range(241)]
    p.path([(math.log10(b), (1 + penalty * b) * (1 + flat_penalty * max(0.0, 1 - flat_slope * b)))
            for b in places], stroke=BLUE, width=2.5)
    p.text((-5.9, 2.3), "flat: parts are exact and cheap")
    p.text((-4.0, 1.45), "bends a little: one rectangle", color=BLUE)
    p.text((-1.1, 4.9), "bends: opened early", anchor="end")
    return d


def bulge_depth(numbers):
    d = Drawing(860, 420)
    n = 6
    f = math.pi / n
    at_centroid = 1 - math.sin(f) / f
    exact = 2 - math.cos(f) - f / math.sin(f)

    def perimeter(depth):
        return n * (2 * math.sin(f) + 2 * abs((1 - depth) * math.sin(f) - math.sin(f) * math.cos(f)))

    numbers.update({"arc half-angle": f, "arc centroid depth": at_centroid,
                    "arc exact depth": exact, "arc third": f * f / 3,
                    "arc mean width at centroid": perimeter(at_centroid) / math.pi,
                    "arc mean width deeper": perimeter(exact) / math.pi,
                    "arc mean bulge": 1 - (math.sin(f) / f) ** 2})
    for name, share in (("half bulge", 0.5), ("engine", mask_constants.value_of("kMaskBulgeDepth"))):
        depth = at_centroid + share * numbers["arc mean bulge"]
        numbers[f"arc {name} depth"] = depth
        numbers[f"arc {name} mean width"] = perimeter(depth) / math.pi
    for i, (title, depth) in enumerate((("Plates through the centroids", at_centroid),
                                        ("Plates deeper", exact))):
        p = Panel(d, 30 + 280 * i, 60, 260, 260, (-1.2, 1.2), (-1.2, 1.2))
        p.title(title)
        ring = [(math.cos(math.pi * k / 90), math.sin(math.pi * k / 90)) for k in range(180)]
        p.area(ring, BLUE, width=1)
        hull = []
        for k in range(n):
            t = 2 * f * k + math.pi / 2
            c, s = math.cos(t), math.sin(t)
            ends = [(c * (1 - depth) - side * s * math.sin(f), s * (1 - depth) + side * c * math.sin(f))
                    for side in (-1, 1)]
            hull += ends
            p.path(ends, stroke=ORANGE, width=4)
            p.path([(0.96 * math.cos(t + f), 0.96 * math.sin(t + f)),
                    (1.04 * math.cos(t + f), 1.04 * math.sin(t + f))], stroke=BLUE)
        p.path(hull, stroke=INK, dash="3 3", width=1, close=True)
        d.text(30 + 280 * i, 350, f"depth {depth:.4f}", size=12)
        d.text(30 + 280 * i, 370, f"outline {perimeter(depth):.3f}, mean width "
               f"{perimeter(depth) / math.pi:.3f}", size=12)
    d.text(30, 400, "the disk's own: outline 6.283, mean width 2", BLUE, 12)
    q = Panel(d, 640, 60, 190, 260, (0, 0.8), (0, 0.22))
    q.axes([(0, "0"), (0.4, ".4"), (0.8, ".8")], [(0, "0"), (0.1, ".1"), (0.2, ".2")],
           "half-angle f of an arc", "depth below the circle")
    angles = [0.01 + 0.79 * i / 60 for i in range(61)]
    q.path([(a, 2 - math.cos(a) - a / math.sin(a)) for a in angles], stroke=ORANGE, width=2.5)
    q.path([(a, a * a / 3) for a in angles], stroke=INK, dash="4 3")
    q.path([(a, 1 - math.sin(a) / a) for a in angles], stroke=BLUE, width=2.5)
    q.text((0.37, 0.155), "exact", color=ORANGE, size=12)
    q.text((0.62, 0.105), "f^2/3", size=12)
    q.text((0.46, 0.018), "centroid", color=BLUE, size=12)
    return d


def sheet_tiles():
    """An elliptic sheet of quadrilaterals: square rings become circles."""
    def point(i, j):
        x, y = i / 8 - 1, j / 8 - 1
        ring, length = max(abs(x), abs(y)), math.hypot(x, y)
        scale = ring / length if length else 0.0
        return (1.5 * x * scale, y * scale)
    return [[point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]
            for i in range(16) for j in range(16)]


def mean_of(tile):
    return (sum(p[0] for p in tile) / len(tile), sum(p[1] for p in tile) / len(tile))


def split_nodes(tiles, levels, low=(-math.inf, -math.inf), high=(math.inf, math.inf)):
    """Nodes of a flat sheet with the cuts about them: the middle of the longer extent."""
    if levels == 0 or len(tiles) < 2:
        return [(tiles, low, high)]
    keys = [mean_of(t) for t in tiles]
    lows, highs = ([pick(k[i] for k in keys) for i in range(2)] for pick in (min, max))
    axis = 0 if highs[0] - lows[0] >= highs[1] - lows[1] else 1
    at = 0.5 * (lows[axis] + highs[axis])
    left_high, right_low = list(high), list(low)
    left_high[axis] = right_low[axis] = at
    return (split_nodes([t for t, k in zip(tiles, keys) if k[axis] < at], levels - 1, low, left_high)
            + split_nodes([t for t, k in zip(tiles, keys) if k[axis] >= at], levels - 1, right_low,
                          high))


def grow_to_cuts(axis, shorter, center, low, high):
    """tree/masks/patch.cpp: half axis and move of the middle."""
    ahead = behind = False
    for k in range(2):
        reach = CUT_REACH * abs(axis[k])
        below, above = center[k] - low[k], high[k] - center[k]
        if axis[k] <= 0:
            below, above = above, below
        ahead |= above < reach
        behind |= below < reach
    rim = DILATION * math.hypot(*shorter) / math.hypot(*axis)
    forward, backward = (0.5 * rim * side for side in (ahead, behind))
    grown = 1 + forward + backward
    return (axis[0] * grown, axis[1] * grown), (axis[0] * (forward - backward),
                                                axis[1] * (forward - backward))


def inside(p, corners):
    signs = [(b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
             for a, b in zip(corners, corners[1:] + corners[:1])]
    return all(s >= 0 for s in signs) or all(s <= 0 for s in signs)


def rims(numbers):
    d = Drawing(860, 360)
    nodes = split_nodes(sheet_tiles(), 3)
    outline = [(1.5 * math.cos(math.pi * k / 60), math.sin(math.pi * k / 60)) for k in range(120)]
    probes = [(-1.7 + 3.4 * (i + 0.5) / 119, -1.2 + 2.4 * (j + 0.5) / 84)
              for i in range(119) for j in range(84)]
    on_sheet = [(x / 1.5) ** 2 + y * y < 1 for x, y in probes]
    for i, title in enumerate(("Rectangles of eight nodes", "Larger by 12 % of their width at cuts")):
        p = Panel(d, 30 + 420 * i, 50, 380, 268, (-1.7, 1.7), (-1.2, 1.2))
        p.title(title)
        p.area(outline, BLUE, width=1)
        shown, forms = [], []
        for tiles, low, high in nodes:
            patch = Patch(tiles)
            center, (along, across) = patch.center, patch.axes()
            if i == 1:
                grown, move_a = grow_to_cuts(along, across, center, low, high)
                across, move_b = grow_to_cuts(across, across, center, low, high)
                along = grown
                center = (center[0] + move_a[0] + move_b[0], center[1] + move_a[1] + move_b[1])
            shown.append(rectangle(center, along, across))
            forms.append([*center, along[0] + across[0], along[1] + across[1],
                          across[0] - along[0], across[1] - along[1]])
        for corners in shown:
            p.path(corners, stroke=ORANGE, fill="#fbd38d", width=1.5, opacity=0.75, close=True)
        cuts = {(axis, value) for _, low, high in nodes for axis in range(2)
                for value in (low[axis], high[axis]) if abs(value) < 9}
        for axis, value in sorted(cuts):
            ends = [(value, -1.1), (value, 1.1)] if axis == 0 else [(-1.6, value), (1.6, value)]
            p.path(ends, stroke=INK, dash="2 4", width=1)
        covered = [any(inside(q, corners) for corners in shown) for q in probes]
        missed = sum(a and not b for a, b in zip(on_sheet, covered)) / sum(on_sheet)
        beyond = sum(b and not a for a, b in zip(on_sheet, covered)) / sum(on_sheet)
        d.text(30 + 420 * i, 340, f"{100 * missed:.1f} % of the sheet is missed, "
               f"{100 * beyond:.1f} % is drawn beyond it", size=12)
        numbers[f"rims {i} missed"], numbers[f"rims {i} beyond"] = missed, beyond
    numbers["rims nodes"] = forms  # with rims; mask_derivation_test.cpp compares the engine's
    return d


def flat_pair(numbers):
    d = Drawing(860, 290)
    pair = [(-1.6, -0.55), (0.7, -0.9), (1.6, 0.45), (0.5, 0.95)]
    p = Panel(d, 30, 50, 340, 210, (-1.9, 1.9), (-1.17, 1.17))
    p.title("One leaf: the quadrilateral itself")
    p.area(pair[:3], BLUE)
    p.area([pair[2], pair[3], pair[0]], GREEN)
    p.path([pair[1], pair[3]], stroke=INK, dash="3 3", width=1)
    even = tuple(0.5 * (pair[0][k] + pair[2][k]) for k in range(2))
    odd = tuple(0.5 * (pair[1][k] + pair[3][k]) for k in range(2))
    center = tuple(0.5 * (even[k] + odd[k]) for k in range(2))
    p.arrow(even, pair[0], color=ORANGE, width=2)
    p.arrow(odd, pair[1], color=RED, width=2)
    p.arrow(center, even, color=INK, width=2)
    p.dot(center, 3)
    for name, at, dx, dy in (("a", 0, -16, 4), ("b", 1, 6, 12), ("c", 2, 8, 0), ("d", 3, -6, -8)):
        p.text(pair[at], name, dx=dx, dy=dy, bold=True)
    x = 400
    d.text(x, 70, "center + skew + axis_a = a", ORANGE)
    d.text(x, 92, "center - skew + axis_b = b", RED)
    d.text(x, 114, "center + skew - axis_a = c")
    d.text(x, 136, "center - skew - axis_b = d")
    d.text(x, 168, "skew: half of what parts the", size=12)
    d.text(x, 184, "middles of the diagonals (black)", size=12)
    d.text(x, 208, "0 for a rectangle and", size=12)
    d.text(x, 224, "for a parallelogram", size=12)
    for i, (title, quad) in enumerate((
            ("hollow: stays two", [(-0.1, 0.05), (-0.9, -0.7), (1.2, 0.0), (-0.8, 0.7)]),
            ("bent: stays two", None))):
        q = Panel(d, 650, 60 + 115 * i, 180, 85, (-1.4, 1.4), (-0.8, 0.8))
        d.text(650, 50 + 115 * i, title, size=12, bold=True)
        if quad:
            q.area([quad[0], quad[1], quad[2]], BLUE)
            q.area([quad[2], quad[3], quad[0]], GREEN)
        else:
            q.path([(-1.1, -0.35), (0, 0.15)], stroke=BLUE, width=5)
            q.path([(0, 0.15), (1.1, -0.05)], stroke=GREEN, width=5)
            q.path([(-1.1, 0.15), (1.1, 0.15)], stroke=FAINT, dash="3 3")
            q.path([(-1.1, -0.35), (-1.1, 0.15)], stroke=INK, width=1)
            q.text((-0.7, 0.35), "> 1e-3 of the diagonal", size=11)
    return d


def corner_nodes(cells, by_normal):
    """Cells of two walls: (middle, normal, length). Down to four cells, in the plane."""
    if len(cells) <= 4:
        return [cells]
    extents = [max(c[0][k] for c in cells) - min(c[0][k] for c in cells) for k in range(2)]
    turned = max(c[1][0] for c in cells) - min(c[1][0] for c in cells)
    if by_normal and turned > 0.5:
        parts = [[c for c in cells if (c[1][0] < 0.5) == side] for side in (True, False)]
    else:
        axis = 0 if extents[0] >= extents[1] else 1
        at = 0.5 * (max(c[0][axis] for c in cells) + min(c[0][axis] for c in cells))
        parts = [[c for c in cells if (c[0][axis] < at) == side] for side in (True, False)]
    return [node for part in parts for node in corner_nodes(part, by_normal)]


def splits(numbers):
    d = Drawing(860, 330)
    count = 6
    cells = ([((i + 0.5) / count, 0.0) for i in range(count)],
             [(0.0, (i + 0.5) / count) for i in range(count)])
    cells = ([(c, (0.0, 1.0), 1 / count) for c in cells[0]]
             + [(c, (1.0, 0.0), 1 / count) for c in cells[1]])
    for i, (title, by_normal) in enumerate((("Split by place alone", False),
                                            ("Walls that meet are parted first", True))):
        p = Panel(d, 60 + 430 * i, 50, 240, 240, (-0.1, 1.1), (-0.1, 1.1))
        p.title(title)
        p.path([(1.05, 0), (0, 0), (0, 1.05)], stroke=FAINT, width=6)
        for node in corner_nodes(cells, by_normal):
            length = sum(c[2] for c in node)
            center = tuple(sum(c[0][k] * c[2] for c in node) / length for k in range(2))
            area = tuple(sum(c[1][k] * c[2] for c in node) for k in range(2))
            half = (-0.5 * area[1], 0.5 * area[0])
            mixed = len({c[1] for c in node}) > 1
            p.path([(center[0] - half[0], center[1] - half[1]),
                    (center[0] + half[0], center[1] + half[1])],
                   stroke=RED if mixed else ORANGE, width=3)
            for end in (-1, 1):
                p.dot((center[0] + end * half[0], center[1] + end * half[1]), 2.5,
                      fill=RED if mixed else ORANGE)
    d.text(310, 100, "one node of both", RED, 12)
    d.text(310, 116, "walls lies across", RED, 12)
    d.text(310, 132, "the edge and leaves", RED, 12)
    d.text(310, 148, "a gap on each side", RED, 12)
    d.text(740, 100, "each wall's", ORANGE, 12)
    d.text(740, 116, "own nodes", ORANGE, 12)
    d.text(740, 132, "meet in the edge", ORANGE, 12)
    return d


def solid(numbers):
    d = Drawing(560, 290)
    p = Panel(d, 20, 40, 520, 220, (-2.2, 3.0), (-0.3, 1.9))
    p.title("A small closed body: what faces away is enough")
    body = [(0.2, 0.5), (1.3, 0.3), (1.9, 0.9), (1.4, 1.6), (0.4, 1.5), (-0.1, 1.0)]
    eye = (-1.5, 0.0)
    p.path([(-2.1, 0), (2.9, 0)], width=2)
    p.path(body, stroke=None, fill=GRID, close=True)
    for a, b in zip(body, body[1:] + body[:1]):
        normal = (b[1] - a[1], a[0] - b[0])
        away = normal[0] * (a[0] - eye[0]) + normal[1] * (a[1] - eye[1]) > 0
        p.path([a, b], stroke=BLUE if away else FAINT, width=4 if away else 2)
    p.arrow(eye, (2.7, 1.7))
    p.dot(eye, 4)
    p.text((-1.5, 0), "receiver", dx=-20, dy=20, size=12)
    p.text((1.75, 0.55), "faces away: drawn", color=BLUE, size=12, dx=10)
    p.text((-0.2, 1.35), "faces the receiver: left out", color="#718096", size=12, anchor="end")
    p.text((2.3, 1.72), "a ray that enters leaves", size=12, anchor="end")
    return d


DRAWINGS = {"moments_rectangle": moments_rectangle, "open_radius": open_radius, "bulge_depth": bulge_depth, "rims": rims,
            "flat_pair": flat_pair, "splits": splits, "solid": solid}
