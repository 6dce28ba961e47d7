#!/usr/bin/env python3
"""Measures every structure on generated traces; writes bench/results/structures.csv.

Usage: measure_structures.py [--program build/release/fase] [--counts 100 1000 10000] [--frames 40] [REPOSITORY]. `fase generate`
makes each trace; its pairs are checked against the reference. Run tools/make_tables.py afterwards.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from figures import origin_of, write_table

KINDS = ["uniform", "clusters", "flat", "mixed", "static", "asleep", "coincident", "lattice", "explosion", "rain", "pile"]
FIELDS = ["machine", "date", "commit", "trace", "boxes", "frames", "structure", "build_ms", "mean_ms", "median_ms", "worst_ms",
          "bytes_a_box", "depth", "boxes_a_leaf", "pairs"]


def rows_of(program, kind, count, frames, rounds, folder):
    """Yields one dictionary per structure, measured on a new trace of that kind."""
    trace = Path(folder) / f"{kind}.aabt"
    subprocess.run([program, "generate", kind, "--count", str(count), "--frames", str(frames), "-o", trace], check=True,
                   stdout=subprocess.DEVNULL)
    best = {}
    for structure in ("auto", "all") * rounds:  # alternating; the fastest run counts
        out = subprocess.run([program, "pairs", trace, "--structure", structure, "--check", "--json"], check=True,
                             stdout=subprocess.PIPE, text=True).stdout
        for row in json.loads(out):
            known = best.setdefault(row["structure"], row)
            if row["skipped"] is None and row["ms"]["median"] < known["ms"]["median"]:
                best[row["structure"]] = row
    for row in best.values():
        if row["skipped"] is None:
            yield {"trace": kind, "boxes": count, "frames": row["frames"], "structure": row["structure"],
                   "build_ms": row["build_ms"], "mean_ms": row["ms"]["mean"], "median_ms": row["ms"]["median"],
                   "worst_ms": row["ms"]["worst"], "bytes_a_box": round(row["bytes"] / count), "depth": row["depth"],
                   "boxes_a_leaf": row["boxes_per_leaf"], "pairs": row["pairs_last"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="build/release/fase")
    parser.add_argument("--counts", type=int, nargs="+", default=[100, 1000, 10000])
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("repository", nargs="?", default=Path(__file__).parent.parent, type=Path)
    options = parser.parse_args()
    about = origin_of(options.repository)
    with tempfile.TemporaryDirectory() as folder:
        rows = [about | row for count in options.counts for kind in KINDS
                for row in rows_of(str(options.program), kind, count, options.frames * (3 if count < 10000 else 1),
                                   12 if count < 10000 else 3, folder)]
    write_table(options.repository / "bench/results/structures.csv", FIELDS, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
