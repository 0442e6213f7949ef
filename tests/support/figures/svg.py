"""Diagrams as SVG: boxes, arrows and words at places given in pixels. The same calls give the same bytes."""

from html import escape

INK, FAINT, PAPER = "#22303c", "#5b6670", "#ffffff"
FILLS = {"blue": "#e1edf7", "green": "#ddf0e6", "amber": "#fbedd0", "red": "#f8dedb", "grey": "#eef1f3", "white": PAPER}
STROKES = {"blue": "#3b74a8", "green": "#2f8460", "amber": "#a9761c", "red": "#b0453b", "grey": "#7d8790", "white": "#7d8790"}
LINE = 17  # pixels from one line of text to the next


class Box:
    def __init__(self, x, y, width, height):
        self.x, self.y, self.width, self.height = x, y, width, height
        self.right, self.bottom = x + width, y + height
        self.middle_x, self.middle_y = x + width / 2, y + height / 2

    def left_at(self, part=0.5):
        return self.x, self.y + part * self.height

    def right_at(self, part=0.5):
        return self.right, self.y + part * self.height

    def top_at(self, part=0.5):
        return self.x + part * self.width, self.y

    def bottom_at(self, part=0.5):
        return self.x + part * self.width, self.bottom


def number(value):
    return f"{value:.1f}".removesuffix(".0")


class Drawing:
    def __init__(self, width, height, title):
        self.width, self.height, self.title, self.parts = width, height, title, []

    def add(self, part):
        self.parts.append(part)

    def text(self, x, y, words, size=13, anchor="middle", bold=False, colour=INK, code=False):
        """`y`: the base line of the first line."""
        style = (' font-weight="bold"' if bold else "") + (' font-family="monospace"' if code else "")
        for i, line in enumerate(words.split("\n")):
            self.add(f'<text x="{number(x)}" y="{number(y + i * LINE)}" font-size="{size}" text-anchor="{anchor}" fill="{colour}"{style}>'
                     f"{escape(line)}</text>")

    def box(self, x, y, width, height, words="", fill="blue", size=13, dash=False, radius=6):
        """Where there is more than one line the first is bold, the others are smaller."""
        self.add(f'<rect x="{number(x)}" y="{number(y)}" width="{number(width)}" height="{number(height)}" rx="{radius}" fill="{FILLS[fill]}" '
                 f'stroke="{STROKES[fill]}" stroke-width="1.3"{self.dashed(dash)}/>')
        lines = words.split("\n") if words else []
        first = y + height / 2 - (len(lines) - 1) * LINE / 2 + size * 0.34
        for i, line in enumerate(lines):
            self.text(x + width / 2, first + i * LINE, line, size if i == 0 else size - 1.5, bold=i == 0 and len(lines) > 1)
        return Box(x, y, width, height)

    @staticmethod
    def dashed(dash):
        return ' stroke-dasharray="5 4"' if dash else ""

    def path(self, points, colour=INK, width=1.5, dash=False, arrow=False, both=False, fill="none"):
        marks = (' marker-end="url(#arrow)"' if arrow or both else "") + (' marker-start="url(#arrow)"' if both else "")
        text = " ".join(f"{number(x)},{number(y)}" for x, y in points)
        self.add(f'<polyline points="{text}" fill="{fill}" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"{self.dashed(dash)}{marks}/>')

    def arrow(self, *points, label="", at=None, size=12, anchor="middle", dash=False, both=False, colour=INK):
        """`at`: where the label stands (its first base line); by default above the middle of the first and last point."""
        self.path(points, dash=dash, arrow=True, both=both, colour=colour)
        if label:
            x, y = at or ((points[0][0] + points[-1][0]) / 2, (points[0][1] + points[-1][1]) / 2 - 6)
            self.text(x, y, label, size, anchor, colour=FAINT)

    def circle(self, x, y, radius, fill=INK, stroke="none", dash=False):
        self.add(f'<circle cx="{number(x)}" cy="{number(y)}" r="{number(radius)}" fill="{fill}" stroke="{stroke}"{self.dashed(dash)}/>')

    def bytes(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" height="{self.height}" '
                f'font-family="DejaVu Sans, Verdana, sans-serif" role="img">\n<title>{escape(self.title)}</title>\n'
                '<defs><marker id="arrow" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" markerHeight="7" orient="auto-start-reverse">'
                f'<path d="M0,1 L10,5 L0,9 z" fill="{INK}"/></marker></defs>\n<rect width="100%" height="100%" fill="{PAPER}"/>\n')
        return (head + "\n".join(self.parts) + "\n</svg>\n").encode()


class Plot:
    """Axes with ticks in a part of a drawing; `x` and `y`: (smallest, largest) value."""

    def __init__(self, drawing, x, y, left, top, width, height, x_label, y_label, x_ticks, y_ticks):
        self.drawing, self.x, self.y = drawing, x, y
        self.left, self.top, self.width, self.height = left, top, width, height
        drawing.path([(left, top), (left, top + height), (left + width, top + height)], FAINT)
        for value in x_ticks:
            px, py = self.at(value, y[0])
            drawing.path([(px, py), (px, py + 4)], FAINT)
            drawing.text(px, py + 18, f"{value:g}", 11, colour=FAINT)
        for value in y_ticks:
            px, py = self.at(x[0], value)
            drawing.path([(px - 4, py), (px, py)], FAINT)
            drawing.text(px - 8, py + 4, f"{value:g}", 11, "end", colour=FAINT)
        drawing.text(left + width / 2, top + height + 35, x_label, 12, colour=FAINT)
        drawing.text(left, top - 10, y_label, 12, "start", colour=FAINT)

    def at(self, x, y):
        return (self.left + (x - self.x[0]) / (self.x[1] - self.x[0]) * self.width,
                self.top + (self.y[1] - y) / (self.y[1] - self.y[0]) * self.height)

    def line(self, points, colour, width=2, dash=False):
        self.drawing.path([self.at(x, y) for x, y in points], colour, width, dash)
