"""Drawings of masks.md about groups of receivers: horizons, tests, sharing, its change."""
import math

import mask_constants
from raster import exact_share
from svg import BLUE, FAINT, GREEN, INK, ORANGE, RED, Drawing, Panel

FAMILY = [row[1:] for row in mask_constants.family()]  # s, r, u, g at qualities from -1 on
LARGEST_MOVE = mask_constants.value_of("kMaskLargestMove")
GROUP = 16  # kGroupSize of tree/receiver_groups.h


def ground(x):
    return 0.10 * math.sin(2.3 * x) - 0.06 * x * x


def ground_normal(x):
    slope = 0.23 * math.cos(2.3 * x) - 0.12 * x
    length = math.hypot(1.0, slope)
    return (-slope / length, 1.0 / length)


def group_of(points, normals):
    """Centre, radius, axis, half-angle of the cone, rise: tree/masks/groups.cpp in the plane."""
    c = tuple(sum(p[k] for p in points) / len(points) for k in range(2))
    total = tuple(sum(n[k] for n in normals) for k in range(2))
    length = math.hypot(*total)
    axis = tuple(t / length for t in total)
    radius = max(math.dist(p, c) for p in points)
    cone = max(math.acos(min(1.0, n[0] * axis[0] + n[1] * axis[1])) for n in normals)
    rise = max(-(n[0] * (p[0] - c[0]) + n[1] * (p[1] - c[1])) for p, n in zip(points, normals))
    return c, radius, axis, cone, rise


def group_horizon(numbers):
    d = Drawing(860, 390)
    p = Panel(d, 30, 50, 800, 300, (-1.6, 4.8), (-0.9, 1.5))
    places = [-0.8 + 1.6 * i / 7 for i in range(8)]
    points = [(x, ground(x)) for x in places]
    normals = [ground_normal(x) for x in places]
    c, radius, axis, cone, rise = group_of(points, normals)
    p.title("How high can a node stand over any horizon of the group?")
    p.path([(x / 50, ground(x / 50)) for x in range(-70, 71)], width=2)
    for q, n in zip(points, normals):
        p.dot(q, 3)
        p.arrow(q, (q[0] + 0.3 * n[0], q[1] + 0.3 * n[1]), width=1, head=5)
    p.ring(c, radius, stroke=FAINT, dash="4 3")
    p.arrow(c, (c[0] + 0.8 * axis[0], c[1] + 0.8 * axis[1]), color=BLUE, width=2.5)
    for side in (-1, 1):
        a = math.atan2(axis[1], axis[0]) + side * cone
        p.path([c, (c[0] + 0.95 * math.cos(a), c[1] + 0.95 * math.sin(a))], stroke=BLUE, dash="4 3")
    node, node_radius, thickness, node_axis = (3.4, 0.42), 0.62, 0.09, unit2((-0.15, 1.0))
    p.ring(node, node_radius, stroke=FAINT, dash="4 3")
    along = (node_axis[1], -node_axis[0])
    half = 0.58
    p.path([(node[0] + s * half * along[0] + t * thickness * node_axis[0],
             node[1] + s * half * along[1] + t * thickness * node_axis[1])
            for s, t in ((1, 1), (-1, 1), (-1, -1), (1, -1))],
           stroke=ORANGE, fill="#fbd38d", close=True)
    p.arrow(node, (node[0] + 0.45 * node_axis[0], node[1] + 0.45 * node_axis[1]), color=ORANGE)
    to = (node[0] - c[0], node[1] - c[1])
    distance = math.hypot(*to)
    height = to[0] * axis[0] + to[1] * axis[1]
    aside = math.sqrt(distance * distance - height * height)
    base = distance if height >= math.cos(cone) * distance else (height * math.cos(cone)
                                                                 + aside * math.sin(cone))
    facing = node_axis[0] * axis[0] + node_axis[1] * axis[1]
    tilt = math.sqrt(1 - facing * facing) + math.sin(cone)
    slab = min(node_radius, node_radius * tilt + thickness)
    top = base + slab + rise
    corners = [(node[0] + s * half * along[0] + t * thickness * node_axis[0],
                node[1] + s * half * along[1] + t * thickness * node_axis[1])
               for s in (1, -1) for t in (1, -1)]
    true = max(n[0] * (q[0] - r[0]) + n[1] * (q[1] - r[1])
               for r, n in zip(points, normals) for q in corners)
    p.path([c, node], stroke=INK, dash="2 3", width=1)
    p.dot(c, 4, fill=BLUE)
    p.text(c, "c", color=BLUE, dx=-14, dy=14, bold=True)
    p.text((1.7, 0.22), "d", dy=-6)
    p.text((c[0] + axis[0] * 0.8, c[1] + axis[1] * 0.8), "axis, cone", color=BLUE, dx=8, dy=-10)
    p.text(node, "q", color=ORANGE, dy=20, bold=True)
    p.text((node[0] + 0.5, node[1] - 0.65), "radius R, thickness t", color=ORANGE, size=12)
    low = min(zip(points, normals), key=lambda z: z[1][0] * (z[0][0] - c[0]) + z[1][1] * (z[0][1] - c[1]))
    q, n = low
    along_plane = (n[1], -n[0])
    p.path([(q[0] + t * along_plane[0], q[1] + t * along_plane[1]) for t in (-0.5, 1.3)],
           stroke=RED, width=1.5)
    p.text((0.55, -0.13), "lowest tangent plane; below c by: rise", color=RED, size=12, dy=12)
    d.text(30, 372, f"base {base:.2f} + slab {slab:.2f} + rise {rise:.2f} = {top:.2f} at most; "
           f"the highest corner of all is {true:.2f} up; the ball alone would say "
           f"{base + node_radius + radius:.2f}", size=12)
    numbers.update({"horizon base": base, "horizon slab": slab, "horizon rise": rise,
                    "horizon top": top, "horizon true": true,
                    "horizon ball": base + node_radius + radius})
    return d


def unit2(v):
    length = math.hypot(*v)
    return (v[0] / length, v[1] / length)


def decision(distance, radius, leaf, setting):
    """What happens to a flat node straight above the group (weight 1), lengths in group radii."""
    s, r, u, _ = setting
    nearest = distance - radius
    small = radius < s * distance
    far = 1.0 < (r if leaf else u) * nearest
    if small and far:
        return "shared"
    if leaf:
        return "listed" if radius < s * (distance - 1.0) else "opened"
    return "opened" if not small and radius > 1.0 else "handed"


COLORS = {"shared": "#bee3f8", "listed": "#fbd38d", "handed": "#c6f6d5", "opened": "#fed7d7"}


def walk_map(numbers):
    d = Drawing(860, 400)
    for i, (title, leaf) in enumerate((("Inner group", False), ("Leaf group", True))):
        p = Panel(d, 60 + 420 * i, 50, 350, 280, (0.0, 2.0), (-1.0, 1.5))
        across, up = 100, 100
        for row in range(up):
            y = -1.0 + 2.5 * (row + 0.5) / up
            runs = []
            for column in range(across):
                what = decision(10 ** (2.0 * (column + 0.5) / across), 10 ** y, leaf, FAMILY[2])
                if runs and runs[-1][0] == what:
                    runs[-1][2] = column + 1
                else:
                    runs.append([what, column, column + 1])
            for what, first, last in runs:
                x0, y0 = p.at((2.0 * first / across, y + 1.25 / up))
                x1, y1 = p.at((2.0 * last / across, y - 1.25 / up))
                d.rect(x0, y0, x1 - x0, y1 - y0 + 0.6, stroke=None, fill=COLORS[what])
        p.axes([(0, "1"), (1, "10"), (2, "100")], [(-1, "0.1"), (0, "1"), (1, "10")],
               "distance of the node's centre / group radius")
        p.title(title + ", good")
        labels = {"shared": (1.55, 0.25), "opened": (0.35, 1.1),
                  ("listed" if leaf else "handed"): (0.22, -0.85)}
        words = {"shared": "drawn once", "opened": "opened", "listed": "listed: drawn for each",
                 "handed": "handed down"}
        for what, at in labels.items():
            p.text(at, words[what], anchor="middle" if what == "shared" else "start", size=12)
    d.text(60, 388, "upwards: radius of the node (as the opening test sees it) / group radius; "
           "a flat node straight overhead", size=12)
    return d


def curve(t):
    return (4 * t - 2, 0.3 * math.sin(6 * t) + 0.1 * math.sin(17 * t))


def sharing_tree(numbers):
    d = Drawing(860, 420)
    points = [curve((i + 0.37) / 128) for i in range(128)]

    def build(group):
        if len(group) <= GROUP:
            return [(group, [])]
        axis = 0 if (max(p[0] for p in group) - min(p[0] for p in group)
                     >= max(p[1] for p in group) - min(p[1] for p in group)) else 1
        order = sorted(group, key=lambda p: (p[axis], p[1 - axis]))
        half = len(order) // 2
        return [(group, build(order[:half]) + build(order[half:]))]

    chain, level = [], build(points)
    while level:
        # the part that is farthest right and up
        group, children = max(level, key=lambda g: sum(p[0] + 0.3 * p[1] for p in g[0]) / len(g[0]))
        chain.append(group)
        level = children
    colors = [FAINT, GREEN, BLUE, ORANGE]
    p = Panel(d, 30, 50, 420, 340, (-2.7, 2.7), (-2.19, 2.19))
    p.title("128 receivers, groups of 128, 64, 32 and 16")
    q = Panel(d, 480, 50, 350, 340, (-11.5, 11.5), (-11.17, 11.17))
    q.title("Beyond its circle: drawn once for a group")
    _, r, u, _ = FAMILY[1]
    q.path([curve(t / 200) for t in range(201)], stroke=INK, width=1)
    for group, color in zip(chain, colors):
        c = tuple(sum(x[k] for x in group) / len(group) for k in range(2))
        radius = max(math.dist(x, c) for x in group)
        share = r if len(group) <= GROUP else u
        p.ring(c, radius, stroke=color, width=1.5)
        p.dots(group, 3 if color != FAINT else 2, color)
        p.dot(c, 4, fill=color)
        q.ring(c, radius / share, stroke=color, width=2)
        q.dot(c, 3, fill=color)
        numbers[f"group {len(group)} radius"] = radius
        numbers[f"group {len(group)} shares beyond"] = radius / share
        q.text((c[0], c[1] + radius / share), f"{len(group)}", color=color, anchor="middle", dy=-4,
               size=12)
    q.text((-11.5, -11.17), f"draft: u = {u} inner groups, r = {r} leaf groups", dy=18, size=12)
    return d


def gradient(numbers):
    d = Drawing(860, 340)
    up = (0.0, 0.0, 1.0)
    count = 8
    cells = [[(6.0, -2 + 4 * (i + a) / count, 4 * (j + b) / count)
              for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
             for i in range(count) for j in range(count)]

    def exact(x):
        wall = [(6.0 - x, -2.0, 0.0), (6.0 - x, 2.0, 0.0), (6.0 - x, 2.0, 4.0), (6.0 - x, -2.0, 4.0)]
        return exact_share(wall, up)

    # f and n.J of all cells, as seen from the group's centre
    center = 0.6
    irradiance, slope = 0.0, 0.0
    for cell in cells:
        r = tuple(sum(p[k] for p in cell) / 4 for k in range(3))
        r = (r[0] - center, r[1], r[2])
        area = (4.0 / count) ** 2
        r2 = sum(v * v for v in r)
        along = area * r[0]  # A.r, A = area (1, 0, 0)
        irradiance += r[2] * along / (math.pi * r2 * r2)
        # row z, column x of (4 r r^T (A.r) / r^2 - (A.r) I - r A^T) / (pi r^4)
        slope += (4 * r[2] * r[0] * along / r2 - r[2] * area) / (math.pi * r2 * r2)
    xs = [center + 0.04 * i for i in range(-30, 31)]
    base = exact(center)
    share = min(1.0, base / irradiance)
    corrected = []
    for x in xs:
        change = share * slope * (x - center)
        corrected.append(base + change / (1 + abs(change) / LARGEST_MOVE))
    p = Panel(d, 70, 50, 420, 220, (xs[0], xs[-1]), (0.02, 0.08))
    p.axes([(-0.6, "-.6"), (0, "0"), (0.6, ".6"), (1.2, "1.2"), (1.8, "1.8")],
           [(0.02, ".02"), (0.04, ".04"), (0.06, ".06"), (0.08, ".08")], "place x of a receiver")
    p.title("Occlusion by a wall of 4 x 4 at x = 6")
    p.path([(x, exact(x)) for x in xs], width=2.5)
    p.path([(x, base) for x in xs], stroke=FAINT, width=2)
    p.path(list(zip(xs, corrected)), stroke=ORANGE, width=2)
    p.dot((center, base), 4, fill=ORANGE)
    p.text((1.42, 0.06), "exact", anchor="end")
    p.text((-0.55, 0.041), "as seen from the centre", color="#718096")
    p.text((1.05, 0.0335), "with the change", color=ORANGE)
    edge = 0.6
    numbers.update({"wall at centre": base, "wall at edge": exact(center + edge),
                    "wall slope": slope, "wall share": share,
                    "wall error kept": exact(center + edge) - base,
                    "wall error changed": exact(center + edge) - corrected[xs.index(
                        min(xs, key=lambda x: abs(x - center - edge)))]})
    q = Panel(d, 570, 50, 250, 220, (-0.1, 0.1), (-0.06, 0.06))
    q.axes([(-0.1, "-.1"), (0, "0"), (0.1, ".1")], [(-0.03, "-.03"), (0, "0"), (0.03, ".03")],
           "change x by the first order")
    q.title("What of it is used: x / (1 + |x| / .03)")
    places = [-0.1 + 0.002 * i for i in range(101)]
    q.path([(-0.06, -0.06), (0.06, 0.06)], stroke=FAINT, dash="4 3")
    q.path([(x, x / (1 + abs(x) / LARGEST_MOVE)) for x in places], stroke=ORANGE, width=2)
    return d


def family(numbers):
    d = Drawing(560, 350)
    p = Panel(d, 60, 40, 460, 250, (-1, 4), (math.log10(0.005), 0.1))
    p.axes([(q, str(q)) for q in range(-1, 5)],
           [(math.log10(v), str(v)) for v in (0.01, 0.03, 0.1, 0.3, 1.0)], "quality")
    for k, (name, color, at) in enumerate((("s cluster", INK, (1.9, 0.34)), ("r leaf groups", BLUE, (-0.4, 0.5)),
                                           ("u inner groups", GREEN, (2.3, 0.008)), ("g grazing", ORANGE, (2.35, 0.085)))):
        p.path([(q - 1, math.log10(FAMILY[q][k])) for q in range(6)], stroke=color, width=2)
        for q in range(6):
            p.dot((q - 1, math.log10(FAMILY[q][k])), 3, fill=color)
        p.text((at[0], math.log10(at[1])), name, color=color)
    numbers["graze share good"] = FAMILY[2][3] ** 2
    for q, name in ((0, "draft"), (1, "good"), (2, "best")):
        p.text((q, 0.1), name, size=12, anchor="middle", dy=-6)
    return d


DRAWINGS = {"group_horizon": group_horizon, "walk_map": walk_map, "sharing_tree": sharing_tree,
            "gradient": gradient, "family": family}
