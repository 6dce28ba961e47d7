"""The sections of docs/benchmarks_tables.md: one function per CSV file in bench/results, which returns Markdown text."""
import csv

from make_charts import INDEX_QUESTIONS, index_rows, last_rows, size_rows


def line_of(cells):
    return "| " + " | ".join(cells) + " |"


def head_of(columns):
    """The two lines that open a table."""
    return [line_of(columns), line_of(["---"] * len(columns))]


STEP_FIGURES = "bench/results/step.csv"
STEP_HEAD = """
## Steps

From `{figures}`. Add rows with `build/release/fase bench step --csv {figures}`.

Each row is a scene stepped by one engine: steps of 1/60 s, no sleep, the same bodies in each engine. The engines alternate
every ten steps in one run, so that noise affects all of them.

- *Median*, *mean* and *worst*: medians over the rounds. *Min*: for each step the fastest round, then the mean over the steps;
  other programs on the machine disturb it least.
- *Ratio*: the median divided by that of Fase with the same number of threads; in brackets the ratio of *min*.
- *Top* and *mean height* of the bodies' centres show whether the pile still stands at the end; *drift* is their mean
  distance from the start.
- *Hash*: equal for equal commits of Fase, for any number of threads and any machine.
"""
STEP_COLUMNS = ["scene", "engine", "threads", "bodies", "median ms", "mean ms", "worst ms", "min ms", "ratio", "contacts", "top m",
                "mean height m", "drift m", "hash", "commit", "date"]


def step_rows(path):
    """The last row for each machine, scene, engine, number of threads, bodies and steps."""
    return last_rows(path, "machine", "scene", "engine", "threads", "bodies", "steps")


def ratio_of(row, rows):
    """The engine's time divided by Fase's, median and min; "" where Fase has no row to compare with."""
    if row["engine"] == "fase":
        return ""
    same = ("machine", "scene", "threads", "bodies", "steps", "date")
    for other in rows:
        if other["engine"] == "fase" and all(other[key] == row[key] for key in same):
            median = float(row["median_ms"]) / float(other["median_ms"])
            least = float(row["min_ms"]) / float(other["min_ms"])
            return f"{median:.2f} ({least:.2f})"
    return ""


def step_cells(row, rows):
    """The row's cells in the order of STEP_COLUMNS."""
    digits = {"median_ms": 2, "mean_ms": 2, "worst_ms": 2, "min_ms": 2, "top_height": 3, "mean_height": 3, "drift": 3}
    number = {key: f"{float(row[key]):.{count}f}" for key, count in digits.items()}
    return [
        row["scene"], row["engine"], row["threads"], row["bodies"], number["median_ms"], number["mean_ms"],
        number["worst_ms"], number["min_ms"], ratio_of(row, rows), row["contacts"], number["top_height"],
        number["mean_height"], number["drift"], row["hash"], row["commit"], row["date"],
    ]


def step_section(path):
    rows = step_rows(path)
    parts = [STEP_HEAD.format(figures=STEP_FIGURES)]
    for machine in dict.fromkeys(row["machine"] for row in rows):
        mine = [row for row in rows if row["machine"] == machine]
        settings = dict.fromkeys(f"{row['engine']}: {row['settings']}" for row in mine)
        lines = [f"### Steps, {machine}", "", "; ".join(settings) + ".", "", *head_of(STEP_COLUMNS)]
        lines += [line_of(step_cells(row, mine)) for row in mine]
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


STRUCTURE_FIGURES = "bench/results/structures.csv"
STRUCTURE_HEAD = """
## Structures side by side

From `{figures}`. Measure again with `tools/measure_structures.py`.

Traces from `fase generate`, played by `fase pairs` with one thread. A frame updates the boxes and finds all pairs; the pairs of
every frame were equal to those of the reference. Each cell holds: median ms (worst ms), bytes per box, depth, boxes per leaf. `auto` is
the automatic choice; the last line is its median divided by that of the fastest structure. Each figure is the fastest of several
alternating runs.
"""


def structure_section(path):
    """A table for each machine and number of boxes: one line per structure, one column per trace."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    parts = [STRUCTURE_HEAD.format(figures=STRUCTURE_FIGURES)]
    for machine, count in dict.fromkeys((row["machine"], row["boxes"]) for row in rows):
        mine = [row for row in rows if (row["machine"], row["boxes"]) == (machine, count)]
        traces = list(dict.fromkeys(row["trace"] for row in mine))
        digits = 2 if int(count) >= 10000 else 4
        cells = {(row["structure"], row["trace"]): f"{float(row['median_ms']):.{digits}f} ({float(row['worst_ms']):.{digits - 1}f}), "
                 f"{row['bytes_a_box']}, {row['depth']}, {float(row['boxes_a_leaf']):.1f}" for row in mine}
        lines = [f"### {int(count):,} boxes, {machine}, {mine[0]['commit']}, {mine[0]['date']}", "", *head_of(["structure", *traces])]
        for structure in dict.fromkeys(row["structure"] for row in mine):
            lines.append(line_of([structure, *(cells.get((structure, trace), "") for trace in traces)]))
        lines.append(line_of(["auto / best", *(ratio_of_auto([row for row in mine if row["trace"] == trace]) for trace in traces)]))
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def ratio_of_auto(rows):
    """The median of the automatic choice divided by that of the fastest structure; "" where it was not measured."""
    auto = [float(row["median_ms"]) for row in rows if row["structure"] == "auto"]
    others = [float(row["median_ms"]) for row in rows if row["structure"] != "auto"]
    return f"{auto[0] / min(others):.2f}" if auto and others else ""


SIZE_FIGURES = "bench/results/sizes.csv"
SIZE_HEAD = """
## Cost per box

From `{figures}`. Measure again with `tools/measure_sizes.py`.

Trace `{trace}` from `fase generate`: all boxes move in each frame, about two pairs per box. Nanoseconds per box and frame, medians. A constant
line means that the cost grows linearly with the number of boxes. *changes*: reports begun, staying and ended pairs instead of all pairs.

{machine}, {commit}, {date}.

"""


def size_section(path):
    """A table with one line per series and one column per number of boxes."""
    rows = size_rows(path)
    sizes = sorted({int(row["boxes"]) for row in rows})
    cells = {(row["series"], int(row["boxes"])): f"{row['ns']:.1f}" for row in rows}
    lines = head_of(["boxes", *(f"{size:,}" for size in sizes)])
    for name in dict.fromkeys(row["series"] for row in rows):
        lines.append(line_of([name, *(cells.get((name, size), "") for size in sizes)]))
    first = {key: rows[0][key] for key in ("trace", "machine", "commit", "date")}
    return SIZE_HEAD.format(figures=SIZE_FIGURES, **first) + "\n".join(lines) + "\n"


PAIR_FIGURES = "bench/results/pairs.csv"
PAIR_OURS = "row_grid"
PAIR_HEAD = """
## All pairs of a frame

From `{figures}`. Add rows with `build/release/fase bench pairs TRACES --csv {figures}`.

A frame updates the boxes and finds all overlapping pairs, with one thread; times are processor time. Pairs of two static boxes are
not reported. The engines alternate every six frames in one run. Each engine found the same pairs as Fase in every frame; in the first frame
Fase is checked against a plain sweep. An engine that found other pairs has no row.

- *Ratio*: the median divided by that of Fase's `{ours}`. *P10* and *p90*: one frame in ten was faster, one in ten slower.
- *Worst / mean*: the worst frame divided by the mean.
- An engine with fewer frames reached the time limit.
"""
PAIR_COLUMNS = ["trace", "boxes", "engine", "median ms", "p10", "p90", "worst / mean", "ratio", "frames", "pairs", "build ms", "commit",
                "date"]


def pair_cells(row, rows):
    """The row's cells in the order of PAIR_COLUMNS."""
    ratio = ""
    for other in rows:
        if other["engine"] == PAIR_OURS != row["engine"] and other["trace"] == row["trace"]:
            ratio = f"{float(row['median_ms']) / float(other['median_ms']):.1f}"
    worst = float(row["worst_ms"]) / float(row["mean_ms"])
    return [
        row["trace"], row["boxes"], row["engine"], f"{float(row['median_ms']):.3f}", f"{float(row['low_ms']):.3f}",
        f"{float(row['high_ms']):.3f}", f"{worst:.2f}", ratio, row["frames"], row["pairs"],
        f"{float(row['build_ms']):.1f}", row["commit"], row["date"],
    ]


def pair_section(path):
    rows = last_rows(path, "machine", "trace", "engine")
    parts = [PAIR_HEAD.format(figures=PAIR_FIGURES, ours=PAIR_OURS)]
    for machine in dict.fromkeys(row["machine"] for row in rows):
        mine = [row for row in rows if row["machine"] == machine]
        peers = [f"{row['engine']}: {row['settings']}" for row in mine if not row["settings"].startswith("Fase")]
        lines = [f"### Pairs, {machine}", ""]
        if peers:
            lines += ["; ".join(dict.fromkeys(peers)) + ".", ""]
        lines += head_of(PAIR_COLUMNS)
        lines += [line_of(pair_cells(row, mine)) for row in mine]
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


SUDDEN_FIGURES = "bench/results/sudden.csv"
SUDDEN_HEAD = """
## Sudden changes

From `{figures}`. Add rows with `build/release/fase bench sudden --csv {figures}`.

Most boxes are static or asleep; 2,000 move among them. A frame updates the boxes and finds all pairs, with one thread; times are processor
time. The pairs of the event's frame and of the last frame were equal to those of a plain sweep.

| event | what happens |
| --- | --- |
| nothing | no event, for comparison |
| wall | one box in a hundred disappears in one frame |
| comes | one box is added in each frame |
| rain | 1,000 boxes are added and 1,000 removed in each frame |
| wake | all boxes wake in one frame and move from then on |
| rouse | 500 boxes wake in each frame |
"""
SUDDEN_COLUMNS = ["event", "structure", "median ms", "mean ms", "worst ms", "worst / mean", "build ms", "pairs", "commit", "date"]


def sudden_section(path):
    """A table for each machine and number of boxes."""
    rows = last_rows(path, "machine", "boxes", "event", "structure")
    parts = [SUDDEN_HEAD.format(figures=SUDDEN_FIGURES)]
    for machine, boxes in dict.fromkeys((row["machine"], row["boxes"]) for row in rows):
        lines = [f"### Sudden changes, {int(boxes):,} boxes, {machine}", "", *head_of(SUDDEN_COLUMNS)]
        for row in rows:
            if (row["machine"], row["boxes"]) == (machine, boxes):
                number = [f"{float(row[key]):.3f}" for key in ("median_ms", "mean_ms", "worst_ms")]
                lines.append(line_of([row["event"], row["structure"], *number, f"{float(row['worst_ms']) / float(row['mean_ms']):.2f}",
                                      f"{float(row['build_ms']):.1f}", row["pairs"], row["commit"], row["date"]]))
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


QUERY_FIGURES = "bench/results/queries.csv"
QUERY_HEAD = """
## Queries

From `{figures}`. Add rows with `build/release/fase bench queries --mesh building.obj --csv {figures}`.

Thousands of queries per second of processor time, one thread, median of the rounds; in brackets the slowest and the fastest round.
*Rays*: the nearest hit. *Boxes*: all boxes that overlap a box. *Frusta*: all boxes that a camera may see, copied out. All contenders
alternate in one run; slow ones answer fewer queries.

- Scenes: `static`: boxes that do not move. `pile`: all boxes move in each of 60 frames, and the time includes the update. `level`: the
  triangles of a mesh; box and frustum queries use the triangles' boxes.
- Before timing, every answer is compared with that of `wide_bvh`, and some of those with brute force. *Differ* counts answers that were not
  equal. Contenders with their own rounding may differ by a ten-thousandth of the distance along a ray.
"""
QUERY_COLUMNS = ["contender", "rays", "boxes", "frusta", "differ", "build ms", "bytes per item", "commit", "date"]


def query_rows(path):
    """The last row for each machine, scene, number of items, contender and kind of query."""
    return last_rows(path, "machine", "scene", "things", "contender", "kind")


def thousands(row):
    """The rate with three significant digits, and in brackets the slowest and fastest round."""
    def short(value):
        value = float(value) / 1000
        digits = 0 if value >= 100 else 1 if value >= 10 else 2 if value >= 1 else 3
        return f"{value:.{digits}f}"

    return f"{short(row['per_second'])} ({short(row['low'])}–{short(row['high'])})"


def query_section(path):
    """A table for each scene, with one line per contender."""
    rows = query_rows(path)
    parts = [QUERY_HEAD.format(figures=QUERY_FIGURES)]
    scenes = dict.fromkeys((row["machine"], row["scene"], row["things"]) for row in rows)
    for machine, scene, items in scenes:
        mine = [row for row in rows if (row["machine"], row["scene"], row["things"]) == (machine, scene, items)]
        lines = [f"### {scene}, {int(items):,} items, {machine}", "", *head_of(QUERY_COLUMNS)]
        for contender in dict.fromkeys(row["contender"] for row in mine):
            kinds = {row["kind"]: row for row in mine if row["contender"] == contender}
            any_row = next(iter(kinds.values()))
            rates = [thousands(kinds[kind]) if kind in kinds else "" for kind in ("rays", "boxes", "frusta")]
            differ = sum(int(row["differ"]) for row in kinds.values())
            memory = f"{int(any_row['bytes']) / int(items):.0f}" if any_row["bytes"] else ""
            lines.append(line_of([contender, *rates, str(differ), f"{float(any_row['build_ms']):.1f}", memory,
                                  any_row["commit"], any_row["date"]]))
        settings = dict.fromkeys(f"{row['contender']}: {row['settings']}" for row in mine if row["settings"] != "default")
        if settings:
            lines += ["", "; ".join(settings) + "."]
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


INDEX_FIGURES = "bench/results/index.csv"
INDEX_HEAD = """
## An index

From `{figures}`. Add rows with `build/release/fase bench index --csv {figures}`.

Units of 1 × 2 × 1 m stand on a square with 31 m² for each. In each round all of them move by up to 0.2 m in both directions; then come the
questions. Milliseconds, median of the rounds, in brackets the worst round; one thread, processor time. All contenders alternate in one run. In
each round all answers are compared, in the first one with brute force. *–*: the contender has no such question.
"""


def index_table(path):
    """One line for each question, one column for each contender."""
    rows = index_rows(path)
    contenders = list(dict.fromkeys(row["contender"] for row in rows))
    cells = {(row["question"], row["contender"]): row for row in rows}

    def short(row):
        digits = 2 if float(row["worst_ms"]) < 10 else 1 if float(row["worst_ms"]) < 100 else 0
        return f"{float(row['median_ms']):.{digits}f} ({float(row['worst_ms']):.{digits}f})"

    lines = head_of(["milliseconds", *(f"`{name}`" for name in contenders)])
    for question, meaning, _ in INDEX_QUESTIONS:
        if any((question, name) in cells for name in contenders):
            lines.append(line_of([meaning, *(short(cells[question, name]) if (question, name) in cells else "–" for name in contenders)]))
    return "\n".join(lines) + "\n"


def index_section(path):
    rows = index_rows(path)
    settings = dict.fromkeys(f"`{row['contender']}`: {row['settings']}" for row in rows)
    first = rows[0]
    title = f"### {int(first['units']):,} units, {first['machine']}, {first['commit']}, {first['date']}"
    return INDEX_HEAD.format(figures=INDEX_FIGURES) + f"\n{title}\n\n{index_table(path)}\n" + "; ".join(settings) + ".\n"


LEVEL_FIGURES = "bench/results/level.csv"
LEVEL_HEAD = """
## Levels

From `{figures}`. Measure again with `tools/measure_level.py`.

All maps of a WAD are read, compiled and written, with one thread; the compilers alternate in one run. *CPU s*: processor seconds, median of
the rounds; *wall s*: elapsed seconds. One reader takes all figures from the lumps that each compiler wrote. *Segs* are
counted in classic lumps; *split %*: how many more segs than sides; *depth*: nodes above a sub-sector. Settings: {settings}.
"""
LEVEL_COLUMNS = ["compiler", "maps", "segs", "split %", "nodes", "mean depth", "worst depth", "CPU s", "wall s"]


def level_total(rows, key):
    return sum(float(row[key]) for row in rows)


def level_kinds(rows):
    """The compilers with their settings, in the order of the file."""
    return list(dict.fromkeys((row["compiler"], row["settings"]) for row in rows))


def level_section(path):
    """The sum over all WADs, one line per compiler; then one line per map, the compilers side by side."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    kinds = level_kinds(rows)
    parts = [LEVEL_HEAD.format(figures=LEVEL_FIGURES, settings="; ".join(f"`{c}` {s}" for c, s in kinds))]
    for machine in dict.fromkeys(row["machine"] for row in rows):
        mine = [row for row in rows if row["machine"] == machine]
        wads = ", ".join(dict.fromkeys(row["wad"] for row in mine))
        lines = [f"### {wads}, {machine}, {mine[0]['commit']}, {mine[0]['date']}", "", *head_of(LEVEL_COLUMNS)]
        lines += [line_of(level_cells([row for row in mine if (row["compiler"], row["settings"]) == kind], kind)) for kind in kinds]
        parts.append("\n".join(lines + level_maps(mine, kinds)) + "\n")
    return "\n".join(parts)


def level_cells(rows, kind):
    """The cells of one compiler in the order of LEVEL_COLUMNS."""
    total = [row for row in rows if row["map"] == "all"]
    depths = sum(float(row["mean_depth"]) * float(row["subsectors"]) for row in total)
    return [
        " ".join(kind) if kind[1] != "default" else kind[0], str(len(rows) - len(total)), f"{level_total(total, 'segs'):.0f}",
        f"{100 * level_total(total, 'splits') / level_total(total, 'sides'):.2f}", f"{level_total(total, 'nodes'):.0f}",
        f"{depths / level_total(total, 'subsectors'):.3f}", str(max(int(row["worst_depth"]) for row in total)),
        f"{level_total(total, 'cpu_seconds'):.2f}", f"{level_total(total, 'wall_seconds'):.2f}"]


def level_maps(rows, kinds):
    """The lines of the table by map."""
    shown = [kind for kind in kinds if kind[1] in ("default", "-n")]
    lines = ["", "By map: segs (split %), nodes, mean and worst depth, processor milliseconds for a WAD of "
             "that map alone, without the time to start the program.", "",
             *head_of(["map", "lines", "sides", *(compiler for compiler, _ in shown)])]
    by_map = {}
    for row in rows:
        if row["map"] != "all":
            by_map.setdefault((row["wad"], row["map"]), {})[row["compiler"], row["settings"]] = row
    for (_, name), some in by_map.items():
        first = next(iter(some.values()))
        cells = [f"{row['segs']} ({100 * float(row['splits']) / float(row['sides']):.1f}), {row['nodes']}, "
                 f"{float(row['mean_depth']):.2f}, {row['worst_depth']}, {1000 * float(row['cpu_seconds']):.1f}"
                 for row in (some[kind] for kind in shown)]
        lines.append(line_of([name, first["lines"], first["sides"], *cells]))
    return lines


# The CSV file and the function of each section, in the order of the page.
SECTIONS = [(PAIR_FIGURES, pair_section), (SIZE_FIGURES, size_section), (QUERY_FIGURES, query_section), (STEP_FIGURES, step_section),
            (SUDDEN_FIGURES, sudden_section), (INDEX_FIGURES, index_section), (STRUCTURE_FIGURES, structure_section), (LEVEL_FIGURES, level_section)]
