"""Draws the cost of a box against the number of boxes, from bench/results/sizes.csv: both axes by powers of ten."""
import csv
import math

FIGURES = "bench/results/sizes.csv"
PICTURE = "docs/pictures/sizes.svg"
HEAD = """
# Cost against number

Made from `{figures}`. To renew it: `tools/measure_sizes.py && tools/make_tables.py`.

Trace `{trace}` of `fase generate`: all boxes move in each frame, about two pairs a box. Nanoseconds a box and frame, medians; a level line
is a cost that grows with the number of boxes alone. *changes*: begun, staying and ended pairs are told instead of all.

![nanoseconds a box against the number of boxes](pictures/sizes.svg)

"""
COLOURS = ["#c0392b", "#e67e22", "#8e44ad", "#2471a3", "#1e8449", "#7f8c8d", "#b7950b", "#5d6d7e"]
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 860, 520, 70, 20, 190, 50


def read(path):
    """The rows, and the names of their series in the order of the file."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        threads = "" if row["threads"] == "1" else f", {row['threads']} threads"
        row["series"] = row["structure"] + threads + (", changes" if row["told"] == "changes" else "")
        row["ns"] = float(row["median_ms"]) * 1e6 / int(row["boxes"])
    return rows, list(dict.fromkeys(row["series"] for row in rows))


def section_of(path):
    """The section of the page: the picture, and a table with a line a series."""
    rows, series = read(path)
    sizes = sorted({int(row["boxes"]) for row in rows})
    cells = {(row["series"], int(row["boxes"])): f"{row['ns']:.1f}" for row in rows}
    first = rows[0]
    lines = [f"{first['machine']}, {first['commit']}, {first['date']}.", "",
             "| boxes | " + " | ".join(str(size) for size in sizes) + " |", "| --- |" + " --- |" * len(sizes)]
    for name in series:
        lines.append(f"| {name} | " + " | ".join(cells.get((name, size), "") for size in sizes) + " |")
    return HEAD.format(figures=FIGURES, trace=first["trace"]) + "\n".join(lines) + "\n"


def picture_of(path):
    """The chart as SVG text."""
    rows, series = read(path)
    low_x, high_x = (math.log10(f(int(row["boxes"]) for row in rows)) for f in (min, max))
    low_y, high_y = math.floor(math.log10(min(row["ns"] for row in rows))), math.ceil(math.log10(max(row["ns"] for row in rows)))

    def place(boxes, ns):
        x = LEFT + (math.log10(boxes) - low_x) / (high_x - low_x) * (WIDTH - LEFT - RIGHT)
        y = HEIGHT - BOTTOM - (math.log10(ns) - low_y) / (high_y - low_y) * (HEIGHT - TOP - BOTTOM)
        return x, y

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>']
    for k in range(math.ceil(low_x), math.floor(high_x) + 1):
        x, _ = place(10**k, 10**low_y)
        out.append(f'<line x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{HEIGHT - BOTTOM}" stroke="#e0e0e0"/>')
        out.append(f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 20}" text-anchor="middle">{10**k:,}</text>'.replace(",", " "))
    for k in range(low_y, high_y + 1):
        _, y = place(10**low_x, 10**k)
        out.append(f'<line x1="{LEFT}" y1="{y:.1f}" x2="{WIDTH - RIGHT}" y2="{y:.1f}" stroke="#e0e0e0"/>')
        out.append(f'<text x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">{10**k:g}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 8}" text-anchor="middle">boxes</text>')
    out.append(f'<text transform="translate(16 {HEIGHT / 2}) rotate(-90)" text-anchor="middle">nanoseconds a box and frame</text>')
    ends = []
    for number, name in enumerate(series):
        mine = sorted((row for row in rows if row["series"] == name), key=lambda row: int(row["boxes"]))
        points = [place(int(row["boxes"]), row["ns"]) for row in mine]
        colour = COLOURS[number % len(COLOURS)]
        dashes = ' stroke-dasharray="6 4"' if "," in name else ""
        out.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in points)}" fill="none" stroke="{colour}" stroke-width="2"{dashes}/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]
        ends.append([points[-1][1], points[-1][0], name, colour])
    ends.sort()  # names beside the ends of their lines, none over another
    for i in range(1, len(ends)):
        ends[i][0] = max(ends[i][0], ends[i - 1][0] + 15)
    for y, x, name, colour in ends:
        out.append(f'<text x="{x + 10:.1f}" y="{y + 4:.1f}" fill="{colour}">{name}</text>')
    return "\n".join(out) + "\n</svg>\n"
