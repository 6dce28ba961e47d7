#!/usr/bin/env python3
"""Writes docs/benchmarks.md from the figures in bench/results (step, structures, sizes, pairs and queries).

Usage: make_tables.py [--check] [REPOSITORY]. With --check nothing is written: exit code 1 when the page is not what the
figures give. Of several rows for one machine, scene, engine and number of threads the last one in the file counts.
"""
import csv
import sys
from pathlib import Path

import size_chart

FIGURES = "bench/results/step.csv"
QUERY_FIGURES = "bench/results/queries.csv"
PAGE = "docs/benchmarks.md"

HEAD = """# Benchmarks

Made by `tools/make_tables.py` from `{figures}`; change neither by hand. To add rows and renew the page:

```sh
build/release/fase bench step --csv {figures} && tools/make_tables.py
```

Whole steps of 1/60 s, nothing asleep, the same bodies in each engine. Engines take turns of ten steps in one run, so that a
noisy machine is noisy for all. *Median*, *mean* and *worst* step are medians over the rounds; *least* is the mean over
the steps of each step's quickest round, which other programs on the machine disturb least. *Times* is an engine's median
over that of Fase with as many threads (in brackets: the same of *least*). An engine whose pile is lower at the end than the
others' did not hold it up: *top* and *mean height* are of the bodies' centres, *drift* is their mean way from the
start. Hashes of Fase are equal for equal commits, whatever the threads and the machine.
"""

PAIR_FIGURES = "bench/results/pairs.csv"

PAIR_HEAD = """
# All pairs of many boxes

From `{figures}`; rows are added with `build/release/fase bench pairs TRACES --csv {figures}`.

A frame is taking its boxes and finding all pairs that overlap, with one thread; times are those that the processor worked
for it. Two static boxes are no pair. Engines take turns
of six frames in one run. The pairs of each were the same as those of Fase, and those of the first frame the same as a plain
sweep's; what finds others has no row. *Times* is the median over that of Fase's `{ours}`. *From, to*: one frame in ten was
quicker, one in ten slower. *Worst* is the worst frame over the mean. An engine with fewer frames was too slow for all.
"""

PAIR_OURS = "row_grid"

PAIR_COLUMNS = ["trace", "boxes", "engine", "median ms", "from", "to", "worst / mean", "times", "frames", "pairs",
                "build ms", "commit", "date"]

COLUMNS = [
    "scene", "engine", "threads", "bodies", "median ms", "mean ms", "worst ms", "least ms", "times", "contacts", "top m",
    "mean height m", "drift m", "hash", "commit", "date",
]


def read_rows(path):
    """The rows that count, in the order of their first appearance."""
    last = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            last[row["machine"], row["scene"], row["engine"], int(row["threads"]), row["bodies"], row["steps"]] = row
    return list(last.values())


def times_of(row, rows):
    """How many times as long as Fase's the engine's step took; "" where Fase has no row to compare with."""
    if row["engine"] == "fase":
        return ""
    same = ("machine", "scene", "threads", "bodies", "steps", "date")
    for other in rows:
        if other["engine"] == "fase" and all(other[key] == row[key] for key in same):
            median = float(row["median_ms"]) / float(other["median_ms"])
            least = float(row["min_ms"]) / float(other["min_ms"])
            return f"{median:.2f} ({least:.2f})"
    return ""


def cells_of(row, rows):
    """The row's cells, as COLUMNS names them."""
    short = {"median_ms": 2, "mean_ms": 2, "worst_ms": 2, "min_ms": 2, "top_height": 3, "mean_height": 3, "drift": 3}
    number = {key: f"{float(row[key]):.{digits}f}" for key, digits in short.items()}
    return [
        row["scene"], row["engine"], row["threads"], row["bodies"], number["median_ms"], number["mean_ms"],
        number["worst_ms"], number["min_ms"], times_of(row, rows), row["contacts"], number["top_height"],
        number["mean_height"], number["drift"], row["hash"], row["commit"], row["date"],
    ]


def line_of(cells):
    return "| " + " | ".join(cells) + " |"


def page_of(rows):
    """The whole page as text."""
    parts = [HEAD.format(figures=FIGURES)]
    for machine in dict.fromkeys(row["machine"] for row in rows):
        mine = [row for row in rows if row["machine"] == machine]
        settings = dict.fromkeys(f"{row['engine']}: {row['settings']}" for row in mine)
        lines = [f"## {machine}", "", "; ".join(settings) + ".", "", line_of(COLUMNS), line_of(["---"] * len(COLUMNS))]
        lines += [line_of(cells_of(row, mine)) for row in mine]
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


QUERY_HEAD = """
# Queries

Made from `{figures}`. To add rows and renew the page:

```sh
build/release/fase bench queries --mesh building.obj --csv {figures} && tools/make_tables.py
```

Thousands of questions a second of processor time, one thread, medians over the rounds; in brackets the slowest and the quickest round. *Rays*: the
nearest thing; *boxes*: all that overlap a box; *frusta*: all that a camera may see, copied out. All take turns in
one run. `static`: boxes that stand; `pile`: boxes that all move in each of 60 frames, following them counts; `level`: the
triangles of a mesh, their boxes for boxes and frusta. Before anything is timed, every answer is held against those of
`wide_bvh`, and a part of those against brute force; *differ* counts answers that were not equal (distances along a ray within a
ten-thousandth for those that round in their own way). What is slow is asked less.
"""
QUERY_COLUMNS = ["contender", "rays", "boxes", "frusta", "differ", "build ms", "bytes a thing", "commit", "date"]


def thousands(row):
    """A rate with three digits that count, and those of the slowest and quickest round."""
    def short(value):
        value = float(value) / 1000
        digits = 0 if value >= 100 else 1 if value >= 10 else 2 if value >= 1 else 3
        return f"{value:.{digits}f}"

    return f"{short(row['per_second'])} ({short(row['low'])}–{short(row['high'])})"


def read_query_rows(path):
    """The rows that count, in the order of their first appearance."""
    last = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            last[row["machine"], row["scene"], row["things"], row["contender"], row["kind"]] = row
    return list(last.values())


def query_page_of(rows):
    """The section on queries as text: a table a scene, a line a contender."""
    parts = [QUERY_HEAD.format(figures=QUERY_FIGURES)]
    scenes = dict.fromkeys((row["machine"], row["scene"], row["things"]) for row in rows)
    for machine, scene, things in scenes:
        mine = [row for row in rows if (row["machine"], row["scene"], row["things"]) == (machine, scene, things)]
        lines = [f"## {scene}, {things} things, {machine}", "", line_of(QUERY_COLUMNS), line_of(["---"] * len(QUERY_COLUMNS))]
        for contender in dict.fromkeys(row["contender"] for row in mine):
            kinds = {row["kind"]: row for row in mine if row["contender"] == contender}
            any_row = next(iter(kinds.values()))
            rates = [thousands(kinds[kind]) if kind in kinds else "" for kind in ("rays", "boxes", "frusta")]
            differ = sum(int(row["differ"]) for row in kinds.values())
            memory = f"{int(any_row['bytes']) / int(things):.0f}" if any_row["bytes"] else ""
            lines.append(line_of([contender, *rates, str(differ), f"{float(any_row['build_ms']):.1f}", memory,
                                  any_row["commit"], any_row["date"]]))
        settings = dict.fromkeys(f"{row['contender']}: {row['settings']}" for row in mine if row["settings"] != "as it comes")
        if settings:
            lines += ["", "; ".join(settings) + "."]
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def pair_cells_of(row, rows):
    """The row's cells, as PAIR_COLUMNS names them."""
    times = ""
    for other in rows:
        if other["engine"] == PAIR_OURS != row["engine"] and other["trace"] == row["trace"]:
            times = f"{float(row['median_ms']) / float(other['median_ms']):.1f}"
    worst = float(row["worst_ms"]) / float(row["mean_ms"])
    return [
        row["trace"], row["boxes"], row["engine"], f"{float(row['median_ms']):.3f}", f"{float(row['low_ms']):.3f}",
        f"{float(row['high_ms']):.3f}", f"{worst:.2f}", times, row["frames"], row["pairs"],
        f"{float(row['build_ms']):.1f}", row["commit"], row["date"],
    ]


def pair_page_of(path):
    """The part of the page on pairs as text; of several rows for one machine, trace and engine the last one counts."""
    last = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            last[row["machine"], row["trace"], row["engine"]] = row
    parts = [PAIR_HEAD.format(figures=PAIR_FIGURES, ours=PAIR_OURS)]
    for machine in dict.fromkeys(row["machine"] for row in last.values()):
        mine = [row for row in last.values() if row["machine"] == machine]
        peers = [f"{row['engine']}: {row['settings']}" for row in mine if not row["settings"].startswith("Fase")]
        lines = [f"## Pairs: {machine}", ""]
        if peers:
            lines += ["; ".join(dict.fromkeys(peers)) + ".", ""]
        lines += [line_of(PAIR_COLUMNS), line_of(["---"] * len(PAIR_COLUMNS))]
        lines += [line_of(pair_cells_of(row, mine)) for row in mine]
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


STRUCTURE_FIGURES = "bench/results/structures.csv"
STRUCTURE_HEAD = """
# Structures side by side

Made from `{figures}`. To renew it: `tools/measure_structures.py && tools/make_tables.py`.

Traces of `fase generate`, played by `fase pairs`; one thread. A frame's time is that of taking its boxes and finding all its pairs, which
were those of the judge in every frame. In a cell: median ms (worst), bytes a box, depth, boxes in a leaf. `auto` chooses for itself; the
last line is its median over that of the quickest other one. Of three runs in turns the quickest counts.
"""


def structure_page_of(path):
    """A table a machine: a line a structure, a column a trace."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    parts = [STRUCTURE_HEAD.format(figures=STRUCTURE_FIGURES)]
    for machine, count in dict.fromkeys((row["machine"], row["boxes"]) for row in rows):
        mine = [row for row in rows if (row["machine"], row["boxes"]) == (machine, count)]
        traces = list(dict.fromkeys(row["trace"] for row in mine))
        digits = 2 if int(count) >= 10000 else 4
        cells = {(row["structure"], row["trace"]): f"{float(row['median_ms']):.{digits}f} ({float(row['worst_ms']):.{digits - 1}f}), "
                 f"{row['bytes_a_box']}, {row['depth']}, {float(row['boxes_a_leaf']):.1f}" for row in mine}
        lines = [f"## {count} boxes, {machine}, {mine[0]['commit']}, {mine[0]['date']}", "",
                 line_of(["structure", *traces]), line_of(["---"] * (len(traces) + 1))]
        for structure in dict.fromkeys(row["structure"] for row in mine):
            lines.append(line_of([structure, *(cells.get((structure, trace), "") for trace in traces)]))
        lines.append(line_of(["auto / best", *(ratio_of_auto([row for row in mine if row["trace"] == trace]) for trace in traces)]))
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def ratio_of_auto(rows):
    """What the automatic choice takes, to what the quickest structure does; "" where it was not measured."""
    auto = [float(row["median_ms"]) for row in rows if row["structure"] == "auto"]
    others = [float(row["median_ms"]) for row in rows if row["structure"] != "auto"]
    return f"{auto[0] / min(others):.2f}" if auto and others else ""


SUDDEN_FIGURES = "bench/results/sudden.csv"
SUDDEN_HEAD = """
# Much at once

From `{figures}`; rows are added with `build/release/fase bench sudden --csv {figures}`.

Boxes stand or sleep, 2,000 move about among them. A frame is taking the boxes and finding all pairs, one thread, times that the
processor worked. *nothing*: no event, to compare with; *wall*: one box in a hundred vanishes in one frame; *comes*: one more in each
frame; *rain*: 1,000 come and 1,000 go in each frame; *wake*: all wake in one frame and move from then on; *rouse*: 500 wake in each frame.
Pairs of the event's frame and of the last one were those of a plain sweep.
"""
SUDDEN_COLUMNS = ["event", "structure", "median ms", "mean ms", "worst ms", "worst / mean", "build ms", "pairs", "commit", "date"]


def sudden_page_of(path):
    """A table a machine and number of boxes; of several rows for the same the last one counts."""
    last = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            last[row["machine"], row["boxes"], row["event"], row["structure"]] = row
    parts = [SUDDEN_HEAD.format(figures=SUDDEN_FIGURES)]
    for machine, boxes in dict.fromkeys((row["machine"], row["boxes"]) for row in last.values()):
        lines = [f"## {boxes} boxes, {machine}", "", line_of(SUDDEN_COLUMNS), line_of(["---"] * len(SUDDEN_COLUMNS))]
        for row in last.values():
            if (row["machine"], row["boxes"]) == (machine, boxes):
                number = [f"{float(row[key]):.3f}" for key in ("median_ms", "mean_ms", "worst_ms")]
                lines.append(line_of([row["event"], row["structure"], *number, f"{float(row['worst_ms']) / float(row['mean_ms']):.2f}",
                                      f"{float(row['build_ms']):.1f}", row["pairs"], row["commit"], row["date"]]))
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


LEVEL_FIGURES = "bench/results/level.csv"
LEVEL_HEAD = """
# Levels

Made from `{figures}`. To renew it: `tools/measure_level.py && tools/make_tables.py`.

All maps of a WAD, read, compiled and written, one thread; compilers take turns in one run, *seconds* are those that the
processor worked (median of the rounds), *wall* those that went by. All figures are read from the lumps that each compiler
wrote, by the same reader. *Segs* in classic lumps; *%*: more than the sides of lines that there were; *depth*: nodes above a
sub-sector. Settings: {settings}.
"""
LEVEL_COLUMNS = ["compiler", "maps", "segs", "%", "nodes", "mean depth", "worst", "seconds", "wall"]


def level_page_of(path):
    """The sum over all WADs, a line a compiler; then a line a map, compilers side by side."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    kinds = list(dict.fromkeys((row["compiler"], row["settings"]) for row in rows))
    parts = [LEVEL_HEAD.format(figures=LEVEL_FIGURES, settings="; ".join(f"`{c}` {s}" for c, s in kinds))]
    total = lambda some, key: sum(float(row[key]) for row in some)  # noqa: E731
    for machine in dict.fromkeys(row["machine"] for row in rows):
        mine = [row for row in rows if row["machine"] == machine]
        wads = ", ".join(dict.fromkeys(row["wad"] for row in mine))
        lines = [f"## {wads}, {machine}, {mine[0]['commit']}, {mine[0]['date']}", "", line_of(LEVEL_COLUMNS),
                 line_of(["---"] * len(LEVEL_COLUMNS))]
        for kind in kinds:
            of_kind = [row for row in mine if (row["compiler"], row["settings"]) == kind]
            whole = [row for row in of_kind if row["map"] == "all"]
            maps = [row for row in of_kind if row["map"] != "all"]
            leaves = sum(float(row["mean_depth"]) * float(row["subsectors"]) for row in whole)
            lines.append(line_of([
                " ".join(kind) if kind[1] != "as it comes" else kind[0], str(len(maps)), f"{total(whole, 'segs'):.0f}",
                f"{100 * total(whole, 'splits') / total(whole, 'sides'):.2f}", f"{total(whole, 'nodes'):.0f}",
                f"{leaves / total(whole, 'subsectors'):.3f}", str(max(int(row["worst_depth"]) for row in whole)),
                f"{total(whole, 'cpu_seconds'):.2f}", f"{total(whole, 'wall_seconds'):.2f}"]))
        shown = [kind for kind in kinds if kind[1] in ("as it comes", "-n")]
        names = [compiler for compiler, _ in shown]
        lines += ["", "Map by map: segs (% more than sides), nodes, mean and worst depth, milliseconds of the processor for a WAD "
                  "of that map alone, less those of starting the program.", "", line_of(["map", "lines", "sides", *names]),
                  line_of(["---"] * (3 + len(names)))]
        by_map = {}
        for row in mine:
            if row["map"] != "all":
                by_map.setdefault((row["wad"], row["map"]), {})[row["compiler"], row["settings"]] = row
        for (_, name), some in by_map.items():
            first = next(iter(some.values()))
            cells = [f"{row['segs']} ({100 * float(row['splits']) / float(row['sides']):.1f}), {row['nodes']}, "
                     f"{float(row['mean_depth']):.2f}, {row['worst_depth']}, {1000 * float(row['cpu_seconds']):.1f}"
                     for row in (some[kind] for kind in shown)]
            lines.append(line_of([name, first["lines"], first["sides"], *cells]))
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def main(arguments):
    check = "--check" in arguments
    folders = [argument for argument in arguments if argument != "--check"]
    root = Path(folders[0] if folders else Path(__file__).parent.parent)
    figures, page = root / FIGURES, root / PAGE
    text = page_of(read_rows(figures))
    if (root / STRUCTURE_FIGURES).is_file():
        text += structure_page_of(root / STRUCTURE_FIGURES)
    pages = {}
    if (root / size_chart.FIGURES).is_file():
        text += size_chart.section_of(root / size_chart.FIGURES)
        pages[root / size_chart.PICTURE] = size_chart.picture_of(root / size_chart.FIGURES)
    if (root / PAIR_FIGURES).is_file():
        text += pair_page_of(root / PAIR_FIGURES)
    if (root / LEVEL_FIGURES).is_file():
        text += level_page_of(root / LEVEL_FIGURES)
    if (root / SUDDEN_FIGURES).is_file():
        text += sudden_page_of(root / SUDDEN_FIGURES)
    if (root / QUERY_FIGURES).is_file():
        text += query_page_of(read_query_rows(root / QUERY_FIGURES))
    pages[page] = text
    if not check:
        for path, content in pages.items():
            path.write_text(content, encoding="utf-8")
        return 0
    stale = [path for path, content in pages.items() if not path.is_file() or path.read_text(encoding="utf-8") != content]
    for path in stale:
        print(f"{path.relative_to(root)}: found other figures than in bench/results, need what tools/make_tables.py writes")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
