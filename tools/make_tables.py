#!/usr/bin/env python3
"""Writes docs/benchmarks.md, docs/benchmarks_tables.md, the charts in docs/pictures and the table in docs/guides/index.md from the CSV
files in bench/results.

Usage: make_tables.py [--check] [REPOSITORY]. With --check nothing is written: exit code 1 when a page or chart differs from what
the figures give. Where rows repeat (same machine, scene, engine and threads), the last row in the file counts.
"""
import sys
from pathlib import Path

import benchmark_tables as tables
import make_charts
import svg
from make_charts import CHARTS, FOLDER, PAIR_ENGINES, QUERY_PEERS, STEP_ENGINES, STEP_SCENES, charts_of, last_rows, write_or_check

PAGE = "docs/benchmarks.md"
APPENDIX = "docs/benchmarks_tables.md"
GUIDE = "docs/guides/index.md"
GUIDE_TABLE = ("<!-- tools/make_tables.py writes this table -->\n", "<!-- end of the table -->\n")

PAGE_HEAD = """# Benchmarks

Six charts compare Fase with other libraries and its structures with each other; one table sums up. The figures behind them
are in [bench/results](../bench/results) (CSV) and in the [full tables](benchmarks_tables.md).
"""

CHART_TEXT = {
    "pairs": ("Pairs", "Each library updates the boxes of a frame and finds all overlapping pairs. All found the same pairs. The tables have "
              "more engines (ODE, CGAL, Bullet's other broad phases)."),
    "sizes": ("Cost per box", "A flat line means that the cost grows linearly with the number of boxes. `auto` is the automatic choice of the "
              "structure; *changes* reports begun, staying and ended pairs instead of all pairs."),
    "queries": ("Queries", "`row_grid` finds pairs fastest, `wide_bvh` answers queries fastest; a world uses each for its purpose "
                "([decision 9](decisions/0009-two-sets-of-trees.md))."),
    "step": ("Steps", "Full steps of the same scenes: broad phase, narrow phase and solver. The tables also show whether the piles still "
             "stand at the end."),
    "index": ("An index", "Many units that all move, and the questions of a frame. What each figure means: "
              "[which call for which question](guides/index.md#how-long-it-takes)."),
    "sudden": ("Sudden changes", "A game loses a frame when a single step takes too long, so the worst frame counts here, not the mean."),
}

SUMMARY_HEAD = """
## Summary

*Speed*: how many times as fast as the fastest other library; below 1 the other library is faster.

"""
SUMMARY_COLUMNS = ["question", "workload", "Fase", "fastest other library", "speed"]

RULES = """
## How it is measured

- One question per benchmark. In a run the contenders alternate, so that noise affects all of them. Figures of one run compare well;
  figures of different runs less so, since the machine (two cores) is shared.
- Before its time counts, a structure or peer must report the same pairs or answers as the others.
- One thread unless stated, medians. Pairs, queries and sudden changes are in processor time, the rest in elapsed time.
- Each row names machine, commit and date.

To measure on your machine and renew this page:

```sh
cmake --preset release -D FASE_BUILD_BENCH=ON -D FASE_BUILD_PEERS=ON && cmake --build build/release
build/release/fase bench step --csv bench/results/step.csv
tools/make_tables.py                                 # this page, its charts and the tables
```

The build includes each library that CMake finds (on Debian: `libbullet-dev`, `libembree-dev`, `libfcl-dev`, `libode-dev`,
`libcgal-dev`, `libboost-dev`); `tools/install_peers` installs nanoflann and the level compilers.

`fase bench pairs`, `queries`, `sudden` and `index` take `--csv`, too; `tools/measure_sizes.py`, `tools/measure_structures.py` and
`tools/measure_level.py` write their CSV file. `tools/make_tables.py --check`, which the tests run, fails when this page, a chart or a table
differs from the CSV files; do not edit them by hand.
"""

APPENDIX_HEAD = """# Benchmark tables

All figures behind the [charts](benchmarks.md). `tools/make_tables.py` writes this page from the CSV files in `bench/results`; do not edit it by hand.
"""


def pair_summary(path):
    """One line each for boxes that all move and for a pile: Fase's row_grid beside the fastest peer."""
    rows = last_rows(path, "machine", "trace", "engine")
    for trace, workload in (("gas100k", "100,000 moving boxes"), ("pile10k", "a forming pile of 10,000 boxes")):
        some = {row["engine"]: row for row in rows if row["trace"] == trace}
        peers = [row for row in some.values() if not row["settings"].startswith("Fase")]
        if tables.PAIR_OURS in some and peers:
            best = min(peers, key=lambda row: float(row["median_ms"]))
            ours, theirs = float(some[tables.PAIR_OURS]["median_ms"]), float(best["median_ms"])
            name = PAIR_ENGINES.get(best["engine"], (best["engine"],))[0]
            yield ["all pairs of a frame", workload, f"{svg.number(ours)} ms", f"{name}: {svg.number(theirs)} ms", theirs / ours]


def query_summary(path):
    """One line for each scene and kind of query that a peer answers, too: the fastest structure beside the fastest peer."""
    rows = tables.query_rows(path)
    for scene, kind, question in (("static", "rays", "nearest hit of a ray"), ("level", "rays", "nearest hit of a ray"),
                                  ("static", "boxes", "all overlaps of a box")):
        some = [row for row in rows if row["scene"].startswith(scene) and row["kind"] == kind and row["contender"] != "copy"]
        ours = [row for row in some if row["contender"] not in QUERY_PEERS]
        peers = [row for row in some if row["contender"] in QUERY_PEERS]
        if ours and peers:
            best, other = (max(part, key=lambda row: float(row["per_second"])) for part in (ours, peers))
            items = "triangles" if scene == "level" else "static boxes"
            rates = [float(row["per_second"]) for row in (best, other)]
            yield [question, f"{int(best['things']):,} {items}", f"{best['contender']}: {svg.magnitude(rates[0])}/s",
                   f"{QUERY_PEERS[other['contender']]}: {svg.magnitude(rates[1])}/s", rates[0] / rates[1]]


def step_summary(path):
    """One line for each scene that Bullet also steps."""
    rows = [row for row in tables.step_rows(path) if row["threads"] == "1"]
    for scene in dict.fromkeys(row["scene"] for row in rows):
        some = {row["engine"]: row for row in rows if row["scene"] == scene}
        if "fase" in some and "bullet" in some:
            ours, theirs = (float(some[engine]["median_ms"]) for engine in STEP_ENGINES)
            yield ["a step", f"{STEP_SCENES.get(scene, scene)}, {int(some['fase']['bodies']):,} bodies", f"{svg.number(ours)} ms",
                   f"Bullet: {svg.number(theirs)} ms", theirs / ours]


def index_summary(path):
    """What a frame needs, and the question that a k-d tree of points answers best, beside the fastest other contender."""
    rows = make_charts.index_rows(path)
    for asked, question in (("frame", "a frame of moves and neighbours"), ("nearest_eight", "the nearest eight of 2,000 places")):
        some = {row["contender"]: row for row in rows if row["question"] == asked}
        others = [row for name, row in some.items() if name in make_charts.INDEX_CONTENDERS and name != "index"]
        if "index" in some and others:
            best = min(others, key=lambda row: float(row["median_ms"]))
            ours, theirs = float(some["index"]["median_ms"]), float(best["median_ms"])
            name = make_charts.INDEX_CONTENDERS[best["contender"]][0]
            yield [question, f"{int(best['units']):,} units", f"{svg.number(ours)} ms", f"{name}: {svg.number(theirs)} ms", theirs / ours]


def level_summary(path):
    """One line: all maps compiled with default settings, beside zdbsp."""
    rows = [row for row in last_rows(path, "machine", "compiler", "settings", "wad", "map") if row["settings"] == "default"]
    seconds, maps = {}, {}
    for row in rows:
        if row["map"] == "all":
            seconds[row["compiler"]] = seconds.get(row["compiler"], 0) + float(row["cpu_seconds"])
        else:
            maps[row["compiler"]] = maps.get(row["compiler"], 0) + 1
    if "fase" in seconds and "zdbsp" in seconds:
        yield ["BSP of all maps", f"{maps.get('fase', 0)} maps of Freedoom", f"{svg.number(seconds['fase'])} s",
               f"zdbsp: {svg.number(seconds['zdbsp'])} s", seconds["zdbsp"] / seconds["fase"]]


# The CSV file and the function of each part of the summary, in the order of the table.
SUMMARIES = [(tables.PAIR_FIGURES, pair_summary), (tables.QUERY_FIGURES, query_summary), (tables.STEP_FIGURES, step_summary), (tables.INDEX_FIGURES, index_summary),
             (tables.LEVEL_FIGURES, level_summary)]


def summary_of(root):
    """The short table as Markdown; "" without any figures to compare."""
    lines = [line for figures, lines_of in SUMMARIES if (root / figures).is_file() for line in lines_of(root / figures)]
    if not lines:
        return ""
    body = [tables.line_of([*cells, f"{speed:.2f}×" if speed < 10 else f"{speed:.0f}×"]) for *cells, speed in lines]
    return SUMMARY_HEAD + "\n".join([*tables.head_of(SUMMARY_COLUMNS), *body]) + "\n"


def page_of(root, charts):
    """docs/benchmarks.md: the charts, the short table, how it is measured."""
    parts = [PAGE_HEAD]
    for name, figures, _ in CHARTS:
        if root / FOLDER / f"{name}.svg" in charts:
            title, text = CHART_TEXT[name]
            parts.append(f"\n## {title}\n\n{text}\n\n![{title}: chart from {figures}](pictures/{name}.svg)\n")
    return "".join(parts) + summary_of(root) + RULES


def appendix_of(root):
    """docs/benchmarks_tables.md: one section per CSV file that exists."""
    return APPENDIX_HEAD + "".join(section(root / figures) for figures, section in tables.SECTIONS if (root / figures).is_file())


def guide_of(root):
    """docs/guides/index.md with a new table; no file when there is no place for it, or no figures."""
    guide, figures = root / GUIDE, root / tables.INDEX_FIGURES
    text = guide.read_text(encoding="utf-8") if guide.is_file() and figures.is_file() else ""
    before, opening, rest = text.partition(GUIDE_TABLE[0])
    _, closing, after = rest.partition(GUIDE_TABLE[1])
    return {guide: before + opening + tables.index_table(figures) + closing + after} if opening and closing else {}


def main(arguments):
    folders = [argument for argument in arguments if argument != "--check"]
    root = Path(folders[0] if folders else Path(__file__).parent.parent)
    files = charts_of(root)
    files |= {root / PAGE: page_of(root, files), root / APPENDIX: appendix_of(root)}
    files |= guide_of(root)
    return write_or_check(root, files, "--check" in arguments, "tools/make_tables.py")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
