"""Draws charts as SVG text: one style for all charts of docs/benchmarks.md. The same input gives the same text."""
import math

WIDTH = 800  # pixels; no text is smaller than 12 pixels at this width
SIZE = 12
INK, GREY, GRID = "#1f2328", "#59636e", "#dde1e6"
# Okabe and Ito's colours, which colour-blind readers can tell apart. Fase takes the first ones, peers the others.
BLUE, SKY, NAVY, VERMILION, ORANGE, GREEN, PURPLE, SLATE = (
    "#0072b2", "#56b4e9", "#003f63", "#d55e00", "#e69f00", "#009e73", "#cc79a7", "#8a939c")


def escaped(text):
    return str(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def text_width(text, size=SIZE):
    """An upper estimate in pixels, for layout only."""
    return 0.6 * size * len(str(text))


def number(value):
    """About three significant digits, thousands separated: 0.28, 5.19, 63.0, 1,084."""
    return f"{value:,.{0 if value >= 99.95 else 1 if value >= 9.995 else 2}f}"


def magnitude(value):
    """A number with a suffix for large ones: 840, 24.3 k, 2.12 M."""
    for limit, suffix in ((1e6, " M"), (1e3, " k")):
        if value >= limit * 0.9995:
            return number(value / limit) + suffix
    return number(value)


def tick(value):
    """A label on an axis: 0.1, 1, 10,000."""
    return f"{value:,g}" if value < 1e6 else f"{value:,.0f}"


def tick_magnitude(value):
    """A label on an axis of large numbers: 100, 10 k, 1 M."""
    for limit, suffix in ((1e6, " M"), (1e3, " k")):
        if value >= limit:
            return f"{value / limit:g}{suffix}"
    return f"{value:g}"


class LogScale:
    """Maps values from `low` to `high` to pixels; grid lines stand at powers of ten."""

    def __init__(self, low, high, start, end):
        self.low, self.high, self.start, self.end = math.log10(low), math.log10(high), start, end

    def at(self, value):
        return self.start + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self):
        return [10.0**k for k in range(math.ceil(self.low - 1e-9), math.floor(self.high + 1e-9) + 1)]


class LinearScale:
    """Maps values from 0 to `high` to pixels; grid lines stand at multiples of `step`."""

    def __init__(self, high, step, start, end):
        self.high, self.step, self.start, self.end = high, step, start, end

    def at(self, value):
        return self.start + value / self.high * (self.end - self.start)

    def ticks(self):
        return [self.step * k for k in range(int(self.high / self.step + 1e-9) + 1)]


class Canvas:
    """A white sheet with a title and a line of conditions below it; shapes are added in drawing order."""

    def __init__(self, height, title, conditions):
        self.height, self.title, self.parts = height, title, []
        self.text(16, 26, title, size=16, weight="bold")
        self.text(16, 46, conditions, colour=GREY)

    def text(self, x, y, text, anchor="start", colour=INK, size=SIZE, weight=None, turned=False, halo=False):
        turn = f' transform="rotate(-90 {x:.1f} {y:.1f})"' if turned else ""
        bold = f' font-weight="{weight}"' if weight else ""
        side = f' text-anchor="{anchor}"' if anchor != "start" else ""
        large = f' font-size="{size}"' if size != SIZE else ""
        white = ' stroke="#ffffff" stroke-width="3" paint-order="stroke"' if halo else ""  # grid lines stop at the text
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}"{side}{large}{bold}{white}{turn}>{escaped(text)}</text>')

    def line(self, x1, y1, x2, y2, colour=GRID, width=1):
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" stroke-width="{width}"/>')

    def bar(self, x, y, width, height, colour):
        self.parts.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{max(width, 1):.1f}" height="{height:.1f}" fill="{colour}"/>')

    def dot(self, x, y, colour, radius=3):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{colour}"/>')

    def curve(self, points, colour, dashed=False):
        dashes = ' stroke-dasharray="6 4"' if dashed else ""
        text = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{text}" fill="none" stroke="{colour}" stroke-width="2"{dashes}/>')

    def legend(self, entries, y=68, x=16):
        """One row of (name, colour), from left to right."""
        for name, colour in entries:
            self.bar(x, y - 9, 12, 10, colour)
            self.text(x + 17, y, name)
            x += 17 + text_width(name) + 12

    def vertical_grid(self, scale, top, bottom, label):
        """Grid lines at the ticks of a horizontal scale, with a label under each."""
        for value in scale.ticks():
            self.line(scale.at(value), top, scale.at(value), bottom)
            self.text(scale.at(value), bottom + 16, label(value), anchor="middle", colour=GREY)

    def horizontal_grid(self, scale, left, right, label):
        """Grid lines at the ticks of a vertical scale, with a label left of each."""
        for value in scale.ticks():
            self.line(left, scale.at(value), right, scale.at(value))
            self.text(left - 8, scale.at(value) + 4, label(value), anchor="end", colour=GREY)

    def finish(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{self.height}" viewBox="0 0 {WIDTH} {self.height}" '
                f'role="img" font-family="Helvetica, Arial, sans-serif" font-size="{SIZE}">')
        sheet = f'<rect width="{WIDTH}" height="{self.height}" fill="#ffffff"/>'
        return "\n".join([head, f"<title>{escaped(self.title)}</title>", sheet, *self.parts, "</svg>"]) + "\n"


def spread(positions, gap):
    """Moves sorted positions down until neighbours are at least `gap` apart."""
    out = []
    for position in positions:
        out.append(max(position, out[-1] + gap) if out else position)
    return out
