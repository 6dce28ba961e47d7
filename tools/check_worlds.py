#!/usr/bin/env python3
"""Steps whole worlds with every structure of the broad phase, and with the automatic choice: all must end in the same bits.

A broad phase may be right in every test of its own and still hang a world: a pair that comes a step late, an order that
changes. Takes some minutes; not part of the tests, which step smaller worlds.

    tools/check_worlds.py [--fase build/release/fase] [--steps 600] [--threads 1]
"""
import argparse
import json
import re
import subprocess
import sys

# Kind, bodies, seed: ten worlds, small enough to be stepped with each structure in some seconds.
WORLDS = [("castle", 0, 1), ("large_pyramid", 1275, 1), ("many_pyramids", 2200, 1), ("hull_pile", 500, 1), ("washer", 1500, 1),
          ("stack", 20, 1), ("pile", 1000, 1), ("pile", 300, 2), ("sleepers", 5000, 1), ("domino", 600, 1)]


def run(arguments):
    return subprocess.run(arguments, capture_output=True, text=True, check=True).stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--fase", default="build/release/fase")
    parser.add_argument("--steps", default="600")
    parser.add_argument("--threads", default="1")
    options = parser.parse_args()
    listed = re.search(r"--structure TEXT\s+Broad phase: (.*)", run([options.fase, "run", "--help"])).group(1)
    structures = [name.split()[0] for name in listed.split(",")]
    wrong = 0
    for kind, count, seed in WORLDS:
        hashes = {}
        for structure in structures:
            arguments = [options.fase, "run", kind, "--steps", options.steps, "--threads", options.threads, "--seed", str(seed),
                         "--structure", structure, "--json"]
            if count:
                arguments += ["--count", str(count)]
            hashes.setdefault(json.loads(run(arguments))["hash"], []).append(structure)
        told = "; ".join(f"{value}: {', '.join(names)}" for value, names in hashes.items())
        print(f"{kind:14} {options.steps} steps  " + (f"{next(iter(hashes))} from all {len(structures)}" if len(hashes) == 1 else "DIFFER: " + told),
              flush=True)
        wrong += len(hashes) != 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
