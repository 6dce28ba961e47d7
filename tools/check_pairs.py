#!/usr/bin/env python3
"""Plays traces with every width of SIMD and several numbers of threads: each frame's pairs must be those of a plain sweep.

    tools/check_pairs.py [--fase build/release/fase] [--structure row_grid] [--frames 20] [--count 10000] [TRACE ...]

Without traces, those of every kind of `fase generate` are made, of --count boxes. From 32,768 boxes on several threads sort them in another
way than one does.
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


def made_traces(fase, folder, count):
    """One trace of each kind that the command knows."""
    told = run([fase, "generate", "--help"]).stdout
    kinds = re.findall(r"^  (\w+) ", told[told.index("Traces:"):told.index("Examples:")], re.MULTILINE)
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
        for trace in options.traces or made_traces(options.fase, folder, options.count):
            hashes = set()
            for level in levels:
                for threads in THREADS:
                    for told in ([], ["--changes"]):
                        out = run([options.fase, "pairs", trace, "--structure", options.structure, "--frames", options.frames, "--check",
                                   "--json", "--simd", level, "--threads", str(threads), *told])
                        row = json.loads(out.stdout)[0]
                        hashes.add(row["hash"])
                        if out.returncode != 0:
                            wrong += 1
                            print(f"{trace.stem}: WRONG with {level}, {threads} threads {' '.join(told)}", flush=True)
            wrong += len(hashes) != 1
            print(f"{trace.stem:14} {', '.join(levels)} x {THREADS} threads: {' '.join(sorted(hashes))}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
