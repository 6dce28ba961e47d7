#!/usr/bin/env python3
"""Checks the pairs of every frame of a trace against a plain sweep, for each SIMD width and several numbers of threads.

    tools/check_pairs.py [--fase build/release/fase] [--structure row_grid] [--frames 20] [--count 10000] [TRACE ...]

Without a TRACE, generates one of each kind of `fase generate` with --count boxes. From 32,768 boxes, several threads sort them by another
algorithm than one thread does.
"""
import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

THREADS = [1, 2, 4, 8]


def run(arguments):
    return subprocess.run(arguments, capture_output=True, text=True, check=False)


def generate_traces(fase, folder, count):
    """Yields one trace of each kind that the command can generate."""
    help_text = run([fase, "generate", "--help"]).stdout
    kinds = re.findall(r"^  (\w+) ", help_text[help_text.index("Traces:"):help_text.index("Examples:")], re.MULTILINE)
    for kind in kinds:
        path = Path(folder) / f"{kind}.aabt"
        run([fase, "generate", kind, "--count", count, "--frames", "40", "-o", path]).check_returncode()
        yield path


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--fase", default="build/release/fase")
    parser.add_argument("--structure", default="row_grid")
    parser.add_argument("--frames", default="20")
    parser.add_argument("--count", default="10000")
    parser.add_argument("traces", nargs="*", type=Path)
    options = parser.parse_args()
    levels = [level for level in ("avx512", "avx2", "sse4")
              if "lacks" not in run([options.fase, "pairs", "none", "--simd", level]).stderr]
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for trace in options.traces or generate_traces(options.fase, folder, options.count):
            hashes = set()
            for level in levels:
                for threads in THREADS:
                    for output in ([], ["--changes"]):
                        out = run([options.fase, "pairs", trace, "--structure", options.structure, "--frames", options.frames, "--check",
                                   "--json", "--simd", level, "--threads", str(threads), *output])
                        row = json.loads(out.stdout)[0]
                        hashes.add(row["hash"])
                        if out.returncode != 0:
                            wrong += 1
                            print(f"{trace.stem}: WRONG with {level}, {threads} threads {' '.join(output)}", flush=True)
            wrong += len(hashes) != 1
            print(f"{trace.stem:14} {', '.join(levels)} x {THREADS} threads: {' '.join(sorted(hashes))}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
