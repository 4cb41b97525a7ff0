"""Drawings of masks.md about cracks between clusters."""
from mask_constants import value_of
from raster import COLUMNS, ROW_SHIFT, ROWS, bits_of, polygon_rows, set_of_bits
from svg import BLUE, GREEN, ORANGE, RED, Drawing, Panel

ALL = 0xFFFFFFFF


def left(row):
    return row << 1 & ALL


def right(row):
    return row >> 1


def beside(rows, neighbour, y):
    """The bits of a neighbouring row that stand next to, not right beside, those of row y."""
    if not 0 <= neighbour < ROWS:
        return 0
    row = rows[neighbour]
    return left(row) if ROW_SHIFT[neighbour] > ROW_SHIFT[y] else right(row)


def row_at(rows, y):
    return rows[y] if 0 <= y < ROWS else 0


def fill(mask, loose):
    out = []
    for y in range(ROWS):
        sides = left(mask[y]) & right(mask[y]) & (left(loose[y]) | right(loose[y]))
        stacked = (row_at(mask, y - 1) & beside(mask, y - 1, y) & row_at(mask, y + 1)
                   & beside(mask, y + 1, y))
        near = (row_at(loose, y - 1) | beside(loose, y - 1, y) | row_at(loose, y + 1)
                | beside(loose, y + 1, y))
        out.append(mask[y] | sides | (stacked & near))
    return out


def openings(mask, filled):
    gone = [~row & ALL for row in filled]
    return [~mask[y] & ALL & (gone[y] | left(gone[y]) | right(gone[y]) | row_at(gone, y - 1)
                              | row_at(gone, y + 1)) for y in range(ROWS)]


def close(mask, loose):
    def grown(rows, y):
        return (row_at(rows, y) | row_at(rows, y - 1) | beside(rows, y - 1, y) | row_at(rows, y + 1)
                | beside(rows, y + 1, y))
    wide = [m | left(m) | right(m) for m in mask]
    up = [grown(mask, y) for y in range(ROWS)]
    wide_loose = [m | left(m) | right(m) for m in loose]
    out = []
    for y in range(ROWS):
        rows = wide[y] & left(wide[y]) & right(wide[y])
        columns = (up[y] & row_at(up, y - 1) & beside(up, y - 1, y) & row_at(up, y + 1)
                   & beside(up, y + 1, y))
        out.append(mask[y] | ((rows | columns) & grown(wide_loose, y)))
    return out


def on_face(points):
    return [(1.0, u, v) for u, v in points]


def cracks(numbers):
    d = Drawing(860, 400)
    # two clusters whose rims do not meet, a third above them, and an opening at the right
    clusters = [[(-1.2, -1.2), (-0.12, -1.2), (0.02, 0.32), (-1.2, 0.32)],
                [(-0.03, -1.2), (0.55, -1.2), (0.55, 0.32), (0.10, 0.32)],
                [(-1.2, 0.40), (0.80, 0.42), (0.80, 1.2), (-1.2, 1.2)]]
    mask = [0] * ROWS
    for quad in clusters:
        mask = [a | b for a, b in zip(mask, polygon_rows(on_face(quad)))]
    filled = fill(mask, mask)
    closed = close(filled, mask)
    rest = openings(mask, filled)
    crack = [~mask[y] & ALL & ~rest[y] for y in range(ROWS)]
    notch = [filled[y] & ~mask[y] & rest[y] for y in range(ROWS)]
    more = [closed[y] & ~filled[y] for y in range(ROWS)]
    panels = (("Drawn", [(mask, BLUE)]),
              ("Filled: clear bits between set ones", [(mask, "#bee3f8"), (crack, ORANGE),
                                                        (notch, RED)]),
              ("Closed: cracks of two bits too", [(mask, "#bee3f8"), (filled_only(filled, mask), "#fbd38d"),
                                                   (more, GREEN)]))
    for i, (title, layers) in enumerate(panels):
        p = Panel(d, 20 + 282 * i, 50, 256, 256, (-1.02, 1.02), (-1.02, 1.02))
        p.title(title)
        every = [(x, y) for y in range(ROWS) for x in range(COLUMNS)]
        set_of_bits(p, every, "#d5dce6", r=1.4)
        if i == 0:
            for quad in clusters:
                p.path([(max(-1, min(1, u)), max(-1, min(1, v))) for u, v in quad], stroke=ORANGE,
                       width=1, close=True)
        for rows, color in layers:
            set_of_bits(p, bits_of(rows), color, r=3)
        p.frame()
    count = {name: len(bits_of(rows)) for name, rows in (("crack", crack), ("notch", notch),
                                                          ("more", more))}
    numbers.update({f"{name} bits": value for name, value in count.items()})
    d.text(302, 330, f"orange: cracks, {count['crack']} bits", ORANGE, 12)
    d.text(302, 347, f"red: {count['notch']} bits that touch what stays open", RED, 12)
    d.text(584, 330, f"green: {count['more']} bits more, where the", GREEN, 12)
    d.text(584, 347, "crack is wider than one", GREEN, 12)
    d.text(20, 330, "blue: set by clusters whose", BLUE, 12)
    d.text(20, 347, "rims (orange) do not meet", BLUE, 12)
    d.text(20, 380, "Above and below count only where both of the two bits nearest in direction are set:"
           " rows are shifted.", size=12)
    return d


def filled_only(filled, mask):
    return [a & ~b for a, b in zip(filled, mask)]


def crack_weights(numbers):
    d = Drawing(560, 330)
    p = Panel(d, 60, 40, 460, 220, (0, 1), (0, 1.4))
    p.axes([(i / 5, f"{i / 5:.1f}") for i in range(6)],
           [(0, "0"), (0.65, ".65"), (1, "1"), (1.3, "1.3")], "occlusion of the mask")
    places = [i / 200 for i in range(201)]

    def weight(occlusion, rule):
        start, reach = value_of(f"kMask{rule}From"), value_of(f"kMask{rule}Range")
        return max(0.0, min(1.0, (occlusion - start) / reach))
    share = value_of("kMaskFillShare")
    p.path([(a, share * weight(a, "Fill")) for a in places], stroke=ORANGE, width=2.5)
    for s, dash in ((0.7, None), (0.5, "6 3"), (0.4, "2 3")):
        c = max(0.0, min(1.0, s / value_of("kMaskNarrowCracks") - 1))
        p.path([(a, c * weight(a, "Close")) for a in places], stroke=GREEN, width=2, dash=dash)
    p.text((0.30, 0.72), "cracks of one bit", color=ORANGE)
    p.text((0.50, 0.14), "of two bits: s = .7, .5, .4", color=GREEN)
    p.title("How much a crack counts as closed")
    numbers["fill weight at half"] = share * weight(0.5, "Fill")
    return d


DRAWINGS = {"cracks": cracks, "crack_weights": crack_weights}
