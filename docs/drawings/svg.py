"""A small SVG writer with one look for all drawings. Equal calls give equal bytes.

Numbers are rounded to hundredths of a pixel, so that the last digit of a sine decides nothing.
"""

INK = "#1a202c"
FAINT = "#a0aec0"
GRID = "#e2e8f0"
BLUE = "#2b6cb0"
ORANGE = "#c05621"
GREEN = "#2f855a"
RED = "#c53030"
TINTS = {BLUE: "#bee3f8", ORANGE: "#fbd38d", GREEN: "#c6f6d5", RED: "#fed7d7", INK: "#cbd5e0"}


def number(value):
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def escape(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


class Drawing:
    """Pixels, y downwards."""

    def __init__(self, width, height):
        self.size = (width, height)
        self.parts = []

    def add(self, text):
        self.parts.append(text)

    def style(self, stroke, fill, width, dash, opacity):
        out = f' fill="{fill or "none"}"'
        if stroke:
            out += f' stroke="{stroke}" stroke-width="{number(width)}"'
        if dash:
            out += f' stroke-dasharray="{dash}"'
        if opacity != 1:
            out += f' opacity="{number(opacity)}"'
        return out

    def path(self, points, stroke=INK, fill=None, width=1.5, dash=None, opacity=1, close=False):
        at = " L".join(f"{number(x)} {number(y)}" for x, y in points)
        self.add(f'<path d="M{at}{" Z" if close else ""}"'
                 f"{self.style(stroke, fill, width, dash, opacity)}/>")

    def rect(self, x, y, w, h, stroke=INK, fill=None, width=1, opacity=1):
        self.add(f'<rect x="{number(x)}" y="{number(y)}" width="{number(w)}" height="{number(h)}"'
                 f"{self.style(stroke, fill, width, None, opacity)}/>")

    def circle(self, x, y, r, stroke=None, fill=INK, width=1.5, dash=None, opacity=1):
        self.add(f'<circle cx="{number(x)}" cy="{number(y)}" r="{number(r)}"'
                 f"{self.style(stroke, fill, width, dash, opacity)}/>")

    def dots(self, points, r, fill):
        """Many equal dots as one path: short strokes with round ends."""
        at = "".join(f"M{number(x)} {number(y)}h.01" for x, y in points)
        self.add(f'<path d="{at}" stroke="{fill}" stroke-width="{number(2 * r)}"'
                 ' stroke-linecap="round"/>')

    def text(self, x, y, text, color=INK, size=13, anchor="start", bold=False):
        weight = ' font-weight="bold"' if bold else ""
        self.add(f'<text x="{number(x)}" y="{number(y)}" fill="{color}" font-size="{size}"'
                 f' text-anchor="{anchor}"{weight}>{escape(text)}</text>')

    def arrow(self, a, b, color=INK, width=1.5, head=7):
        dx, dy = b[0] - a[0], b[1] - a[1]
        length = max((dx * dx + dy * dy) ** 0.5, 1e-9)
        dx, dy = dx / length * head, dy / length * head
        foot = (b[0] - dx, b[1] - dy)
        self.path([a, foot], stroke=color, width=width)
        self.path([b, (foot[0] - 0.4 * dy, foot[1] + 0.4 * dx),
                   (foot[0] + 0.4 * dy, foot[1] - 0.4 * dx)],
                  stroke=None, fill=color, close=True)

    def svg(self):
        w, h = self.size
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{w}" height="{h}"'
                f' viewBox="0 0 {w} {h}" font-family="DejaVu Sans, Helvetica, Arial, sans-serif">')
        return "\n".join([head, f'<rect width="{w}" height="{h}" fill="#fcfcfa"/>', *self.parts,
                          "</svg>", ""])


class Panel:
    """A window of a drawing with its own coordinates, y upwards."""

    def __init__(self, drawing, x, y, w, h, x_range, y_range):
        self.d = drawing
        self.box = (x, y, w, h)
        self.x_range, self.y_range = x_range, y_range

    def at(self, p):
        x, y, w, h = self.box
        (x0, x1), (y0, y1) = self.x_range, self.y_range
        return (x + (p[0] - x0) / (x1 - x0) * w, y + h - (p[1] - y0) / (y1 - y0) * h)

    def scale(self):
        return self.box[2] / (self.x_range[1] - self.x_range[0])

    def path(self, points, **style):
        self.d.path([self.at(p) for p in points], **style)

    def area(self, points, color, **style):
        self.path(points, **{"stroke": color, "fill": TINTS[color], "close": True, **style})

    def dot(self, p, r=3, fill=INK, **style):
        self.d.circle(*self.at(p), r, fill=fill, **style)

    def dots(self, points, r, fill):
        if points:
            self.d.dots([self.at(p) for p in points], r, fill)

    def ring(self, p, radius, stroke=INK, **style):
        """Of a radius in the panel's own units."""
        self.d.circle(*self.at(p), radius * self.scale(), stroke=stroke,
                      **{"fill": None, **style})

    def arrow(self, a, b, **style):
        self.d.arrow(self.at(a), self.at(b), **style)

    def text(self, p, text, dx=0, dy=0, **style):
        x, y = self.at(p)
        self.d.text(x + dx, y + dy, text, **style)

    def title(self, text):
        self.d.text(self.box[0], self.box[1] - 10, text, bold=True)

    def frame(self):
        self.d.rect(*self.box, stroke=FAINT)

    def axes(self, x_ticks, y_ticks, x_label="", y_label=""):
        """Ticks: pairs of a value and its label. Draws the grid, so comes first."""
        x, y, w, h = self.box
        for value, label in x_ticks:
            px = self.at((value, self.y_range[0]))[0]
            self.d.path([(px, y), (px, y + h)], stroke=GRID, width=1)
            self.d.text(px, y + h + 16, label, size=11, anchor="middle")
        for value, label in y_ticks:
            py = self.at((self.x_range[0], value))[1]
            self.d.path([(x, py), (x + w, py)], stroke=GRID, width=1)
            self.d.text(x - 6, py + 4, label, size=11, anchor="end")
        self.frame()
        if x_label:
            self.d.text(x + w / 2, y + h + 34, x_label, size=12, anchor="middle")
        if y_label:
            self.d.text(x, y - 8, y_label, size=12)
