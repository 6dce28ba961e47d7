#!/usr/bin/env python3
"""Draws the charts of docs/benchmarks.md from the CSV files in bench/results, as SVG files in docs/pictures.

Usage: make_charts.py [--check] [REPOSITORY]. With --check nothing is written: exit code 1 when a chart differs from what the
figures give. A chart whose CSV file does not exist is left out. The last row in a file counts for its engine and scene.
"""
import csv
import math
import sys
from pathlib import Path

import svg

FOLDER = "docs/pictures"
BAR, GAP = 14, 14  # pixels: a bar with the line below it; between groups of bars


def last_rows(path, *keys):
    """The last row for each combination of the key columns, in the order of first appearance."""
    last = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            last[tuple(row[key] for key in keys)] = row
    return list(last.values())


def decades(values):
    """The powers of ten around the values."""
    return 10.0 ** math.floor(math.log10(min(values))), 10.0 ** math.ceil(math.log10(max(values)))


def around(values):
    """The numbers of the series 1, 2, 5, 10, … around the values."""
    low, high = min(values), max(values)
    steps = [digit * 10.0**power for power in range(-4, 10) for digit in (1, 2, 5)]
    return max(step for step in steps if step <= low), min(step for step in steps if step >= high)


def grouped_bars(canvas, groups, series, scale, top, mark=None):
    """Draws horizontal bars in groups. `groups`: (label, note, {series name: value}); `series`: {name: colour}.
    `mark`: {(label, series name): value} draws a second value as a white tick. Returns the bottom of the last bar."""
    y = top
    for label, note, values in groups:
        canvas.text(scale.start - 10, y + 11, label, anchor="end", weight="bold")
        canvas.text(scale.start - 10, y + 25, note, anchor="end", colour=svg.GREY)
        for name, colour in series.items():
            if name not in values:
                continue
            end = scale.at(values[name])
            canvas.bar(scale.start, y, end - scale.start, BAR - 1, colour)
            if mark and (label, name) in mark:
                x = scale.at(mark[label, name])
                canvas.line(x, y, x, y + BAR - 1, colour="#ffffff", width=2)
            canvas.text(end + 5, y + 11, svg.number(values[name]), halo=True)
            y += BAR
        y += GAP + max(0, 2 * BAR - BAR * sum(name in values for name in series))  # the label has two lines
    return y - GAP


# Traces of pairs.csv: name in the file, label, note.
PAIR_TRACES = [("gas100k", "100,000 in space", "all move"), ("flat100k", "100,000 on a plane", "all move"),
               ("cities100k", "100,000 in clusters", "all move"), ("mix50k", "50,000, mixed sizes", "all move"),
               ("static100k", "100,000", "most are static"), ("asleep100k", "100,000", "most are asleep"),
               ("pile10k", "10,000", "a forming pile")]
PAIR_ENGINES = {"row_grid": ("Fase row_grid", svg.BLUE), "fcl_dynamic_tree": ("FCL dynamic tree", svg.ORANGE),
                "embree_collide": ("Embree collide", svg.GREEN), "boost_rtree": ("Boost R-tree", svg.PURPLE),
                "bullet_dbvt_deferred": ("Bullet DBVT", svg.VERMILION)}


def log_bars(canvas, height, groups, series, limits, axis):
    """Completes a chart of grouped bars on a logarithmic axis. `series`: {name: (label, colour)}; `limits`: lowest and highest decade."""
    low, high = limits
    canvas.legend(series.values())
    scale = svg.LogScale(low, high * 1.6, 160, svg.WIDTH - 40)
    canvas.vertical_grid(scale, 82, height - 50, svg.tick)
    grouped_bars(canvas, groups, {name: colour for name, (_, colour) in series.items()}, scale, 90)
    canvas.text((160 + svg.WIDTH - 40) / 2, height - 14, axis, anchor="middle")
    return canvas.finish()


def pairs_chart(path):
    rows = last_rows(path, "machine", "trace", "engine")
    time = {(row["trace"], row["engine"]): float(row["median_ms"]) for row in rows}
    groups = [(label, note, {engine: time[trace, engine] for engine in PAIR_ENGINES if (trace, engine) in time})
              for trace, label, note in PAIR_TRACES]
    groups = [group for group in groups if group[2]]
    if not groups:
        return None
    low, high = decades([value for _, _, values in groups for value in values.values()])
    height = 90 + sum(BAR * len(values) + GAP for _, _, values in groups) + 45
    canvas = svg.Canvas(height, "Time to find all pairs in a frame", f"median, 1 thread, {rows[0]['machine']}; shorter is better")
    return log_bars(canvas, height, groups, PAIR_ENGINES, (low, high), "milliseconds per frame (logarithmic)")


SIZE_COLOURS = {"auto": svg.BLUE, "auto, 2 threads": svg.SKY, "auto, changes": svg.NAVY, "wide_bvh": svg.GREEN,
                "octree": svg.PURPLE, "dynamic_bvh": svg.ORANGE, "sweep_and_prune": svg.VERMILION, "brute_force": svg.SLATE}


def size_rows(path):
    """Rows of sizes.csv with two columns more: `series`, and `ns` per box and frame."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        threads = "" if row["threads"] == "1" else f", {row['threads']} threads"
        row["series"] = row["structure"] + threads + (", changes" if row["output"] == "changes" else "")
        row["ns"] = float(row["median_ms"]) * 1e6 / int(row["boxes"])
    return rows


def sizes_chart(path):
    rows = size_rows(path)
    left, right, top, bottom = 74, svg.WIDTH - 150, 64, 450
    height = 500
    x = svg.LogScale(min(int(row["boxes"]) for row in rows), max(int(row["boxes"]) for row in rows), left, right)
    low, high = around([row["ns"] for row in rows])
    y = svg.LogScale(low, high, bottom, top)
    canvas = svg.Canvas(height, "Cost per box against the number of boxes",
                        f"all boxes move, about two pairs per box; median, 1 thread unless stated, {rows[0]['machine']}; lower is better")
    canvas.vertical_grid(x, top, bottom, svg.tick)
    canvas.horizontal_grid(y, left, right, svg.tick)
    canvas.line(left, bottom, right, bottom)
    ends = []
    for name in dict.fromkeys(row["series"] for row in rows):
        points = sorted((int(row["boxes"]), row["ns"]) for row in rows if row["series"] == name)
        points = [(x.at(boxes), y.at(ns)) for boxes, ns in points]
        colour = SIZE_COLOURS.get(name, svg.SLATE)
        canvas.curve(points, colour, dashed="," in name)
        for px, py in points:
            canvas.dot(px, py, colour)
        ends.append((points[-1][1], points[-1][0], name, colour))
    ends.sort()
    for place, (_, px, name, colour) in zip(svg.spread([end[0] for end in ends], 15), ends):
        canvas.text(px + 9, place + 4, name, colour=colour, weight="bold")
    canvas.text((left + right) / 2, height - 12, "boxes (logarithmic)", anchor="middle")
    canvas.text(20, (top + bottom) / 2, "nanoseconds per box and frame (logarithmic)", anchor="middle", turned=True)
    return canvas.finish()


QUERY_SCENE = "static"
QUERY_KINDS = [("rays", "rays: nearest hit"), ("boxes", "boxes: all overlaps"), ("frusta", "frusta: all in view")]
QUERY_PEERS = {"embree": "Embree", "bullet_dbvt": "Bullet DBVT", "boost_rtree": "Boost R-tree"}


def queries_chart(path):
    rows = [row for row in last_rows(path, "machine", "scene", "things", "contender", "kind") if row["scene"] == QUERY_SCENE]
    rate = {(row["contender"], row["kind"]): float(row["per_second"]) for row in rows if row["contender"] != "copy"}
    if not rate:
        return None
    names = list(dict.fromkeys(contender for contender, _ in rate))
    names.sort(key=lambda name: (name in QUERY_PEERS, -rate.get((name, "rays"), 0)))
    row_height, top = 22, 112
    bottom = top + row_height * len(names)
    height = bottom + 58
    canvas = svg.Canvas(height, "Queries per second, by structure",
                        f"{int(rows[0]['things']):,} static boxes, 1 thread, {rows[0]['machine']}; longer is better")
    canvas.legend([("Fase", svg.BLUE), ("other libraries", svg.ORANGE)])
    for place, name in enumerate(names):
        y = top + row_height * place
        canvas.text(138, y + 15, QUERY_PEERS.get(name, name), anchor="end")
    panel = (svg.WIDTH - 150 - 10) / len(QUERY_KINDS)
    for place, (kind, title) in enumerate(QUERY_KINDS):
        values = {name: rate[name, kind] for name in names if (name, kind) in rate}
        if not values:
            continue
        low, high = decades(values.values())
        left = 150 + panel * place
        scale = svg.LogScale(low, high, left, left + panel - 62)
        canvas.text(left, top - 14, title, weight="bold")
        canvas.vertical_grid(scale, top - 4, bottom + 2, lambda _: "")
        for value in scale.ticks()[::2]:
            canvas.text(scale.at(value), bottom + 18, svg.tick_magnitude(value), anchor="middle", colour=svg.GREY)
        for row, name in enumerate(names):
            y = top + row_height * row
            if name not in values:
                canvas.text(left + 4, y + 15, "no such query", colour=svg.GREY, halo=True)
                continue
            end = scale.at(values[name])
            canvas.bar(left, y + 3, end - left, row_height - 6, svg.ORANGE if name in QUERY_PEERS else svg.BLUE)
            canvas.text(end + 4, y + 15, svg.magnitude(values[name]), halo=True)
    canvas.text((150 + svg.WIDTH) / 2, height - 12, "queries per second (logarithmic; k: thousand, M: million)", anchor="middle")
    return canvas.finish()


STEP_SCENES = {"large_pyramid": "large pyramid", "many_pyramids": "many pyramids", "hull_pile": "pile of hulls", "washer": "washer", "hills": "hills of triangles"}
STEP_ENGINES = {"fase": ("Fase", svg.BLUE), "bullet": ("Bullet", svg.VERMILION)}


def step_chart(path):
    rows = last_rows(path, "machine", "scene", "engine", "threads", "bodies", "steps")
    groups = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        some = {row["engine"]: row for row in reversed(rows) if row["scene"] == scene and row["threads"] == "1"}
        values = {engine: float(some[engine]["median_ms"]) for engine in STEP_ENGINES if engine in some}
        if len(values) == len(STEP_ENGINES):
            bodies = next(iter(some.values()))["bodies"]
            groups.append((STEP_SCENES.get(scene, scene), f"{int(bodies):,} bodies", values))
    if not groups:
        return None
    peak = max(value for _, _, values in groups for value in values.values())
    step = 10.0 ** math.floor(math.log10(peak)) / 4
    high = step * math.ceil(peak * 1.12 / step)
    height = 90 + len(groups) * (2 * BAR + GAP) + 45
    canvas = svg.Canvas(height, "Time of a step beside Bullet",
                        f"full steps of 1/60 s, nothing asleep; median, 1 thread, {rows[0]['machine']}; shorter is better")
    canvas.legend(STEP_ENGINES.values())
    scale = svg.LinearScale(high, step, 140, svg.WIDTH - 40)
    canvas.vertical_grid(scale, 82, height - 50, svg.tick)
    grouped_bars(canvas, groups, {engine: colour for engine, (_, colour) in STEP_ENGINES.items()}, scale, 90)
    canvas.text((140 + svg.WIDTH - 40) / 2, height - 14, "milliseconds per step", anchor="middle")
    return canvas.finish()


SUDDEN_EVENTS = [("nothing", "no event", "2,000 boxes move"), ("wall", "a wall vanishes", "1 % of boxes, once"),
                 ("comes", "boxes appear", "1 in each frame"), ("rain", "boxes come and go", "1,000 + 1,000 per frame"),
                 ("rouse", "boxes wake", "500 in each frame"), ("wake", "all boxes wake", "in one frame")]
SUDDEN_STRUCTURES = {"row_grid": ("row_grid", svg.BLUE), "wide_bvh": ("wide_bvh", svg.GREEN),
                     "dynamic_bvh": ("dynamic_bvh", svg.ORANGE)}


def sudden_chart(path):
    rows = last_rows(path, "machine", "boxes", "event", "structure")
    worst = {(row["event"], row["structure"]): row for row in rows}
    groups, median = [], {}
    for event, label, note in SUDDEN_EVENTS:
        values = {name: float(worst[event, name]["worst_ms"]) for name in SUDDEN_STRUCTURES if (event, name) in worst}
        if values:
            groups.append((label, note, values))
            median |= {(label, name): float(worst[event, name]["median_ms"]) for name in values}
    if not groups:
        return None
    low, high = decades([*median.values(), *(value for _, _, values in groups for value in values.values())])
    height = 90 + sum(BAR * len(values) + GAP for _, _, values in groups) + 45
    canvas = svg.Canvas(height, "Worst frame under sudden changes",
                        f"{int(rows[0]['boxes']):,} boxes, 1 thread, {rows[0]['machine']}; white mark: median frame; shorter is better")
    canvas.legend(SUDDEN_STRUCTURES.values())
    scale = svg.LogScale(low, high, 170, svg.WIDTH - 40)
    canvas.vertical_grid(scale, 82, height - 50, svg.tick)
    grouped_bars(canvas, groups, {name: colour for name, (_, colour) in SUDDEN_STRUCTURES.items()}, scale, 90, median)
    canvas.text((170 + svg.WIDTH - 40) / 2, height - 14, "milliseconds in the worst frame (logarithmic)", anchor="middle")
    return canvas.finish()


# Questions of index.csv: name in the file, what is asked. The third tells what the chart says of it; "" leaves it out.
INDEX_QUESTIONS = [("moves", "new places for all units, and `commit()`", "moves"),
                   ("neighbours_moved", "neighbours within 5 m, the first question after the moves", ""),
                   ("frame", "both: what a frame needs", "moves, neighbours"),
                   ("neighbours", "neighbours again", "neighbours"),
                   ("grown_pairs", "pairs of boxes that are larger by 2.5 m on each side", ""),
                   ("rectangles_moved", "units in 10 rectangles of 100 m, the first such question after the moves", "rectangles, first"),
                   ("rectangles", "units in 10 rectangles again", ""),
                   ("nearest_moved", "the nearest unit of 2,000 places, the first such question after the moves", "nearest, first"),
                   ("nearest", "the nearest unit of 2,000 places again", ""),
                   ("nearest_eight", "the nearest eight of 2,000 places", "nearest eight"),
                   ("rays", "1,000 rays of 100 m", "rays")]
INDEX_NOTES = {"moves": "all 200,000", "frame": "what a frame needs", "neighbours": "again", "rectangles_moved": "after the moves",
               "nearest_moved": "after the moves", "nearest_eight": "of 2,000 places", "rays": "1,000"}
INDEX_CONTENDERS = {"index": ("Index", svg.BLUE), "flat_grid": ("flat grid", svg.SLATE), "hash_grid": ("hash map grid", svg.VERMILION),
                    "boost_rtree": ("Boost R-tree", svg.PURPLE), "nanoflann": ("nanoflann", svg.GREEN)}


def index_rows(path):
    """The last row for each question and contender, with one thread, of the first machine and number of units."""
    rows = [row for row in last_rows(path, "machine", "units", "threads", "question", "contender") if row["threads"] == "1"]
    return [row for row in rows if (row["machine"], row["units"]) == (rows[0]["machine"], rows[0]["units"])]


def index_chart(path):
    rows = index_rows(path)
    if not rows:
        return None
    time = {(row["question"], row["contender"]): float(row["median_ms"]) for row in rows}
    groups = [(label, INDEX_NOTES[question], {name: time[question, name] for name in INDEX_CONTENDERS if (question, name) in time})
              for question, _, label in INDEX_QUESTIONS if label]
    groups = [group for group in groups if group[2]]
    low, high = decades([value for _, _, values in groups for value in values.values()])
    height = 90 + sum(BAR * max(len(values), 2) + GAP for _, _, values in groups) + 45
    canvas = svg.Canvas(height, "An index of many moving units",
                        f"{int(rows[0]['units']):,} units, median, 1 thread, {rows[0]['machine']}; shorter is better")
    return log_bars(canvas, height, groups, INDEX_CONTENDERS, (low, high), "milliseconds (logarithmic)")


# Name of the SVG file, the CSV file, and the function that draws it, in the order of the page.
CHARTS = [("pairs", "bench/results/pairs.csv", pairs_chart), ("sizes", "bench/results/sizes.csv", sizes_chart),
          ("queries", "bench/results/queries.csv", queries_chart), ("step", "bench/results/step.csv", step_chart),
          ("sudden", "bench/results/sudden.csv", sudden_chart), ("index", "bench/results/index.csv", index_chart)]


def charts_of(root):
    """The text of each chart by its path; charts without figures are left out."""
    found = {}
    for name, figures, draw in CHARTS:
        if (root / figures).is_file() and (text := draw(root / figures)) is not None:
            found[root / FOLDER / f"{name}.svg"] = text
    return found


def write_or_check(root, files, check, tool):
    """Writes each text to its path, or with `check` prints the paths whose content differs. Returns the exit code."""
    if not check:
        for path, text in files.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return 0
    stale = [path for path, text in files.items() if not path.is_file() or path.read_text(encoding="utf-8") != text]
    for path in stale:
        print(f"{path.relative_to(root)}: differs from the figures in bench/results; run {tool}")
    return 1 if stale else 0


def main(arguments):
    folders = [argument for argument in arguments if argument != "--check"]
    root = Path(folders[0] if folders else Path(__file__).parent.parent)
    return write_or_check(root, charts_of(root), "--check" in arguments, "tools/make_charts.py")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
