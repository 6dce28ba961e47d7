#!/usr/bin/env python3
"""Steps worlds with every broad-phase structure and with the automatic choice, and checks that all end with the same hash.

A broad phase may pass all its own tests and still change a world: a pair that is reported one step late, a different
order. Takes some minutes, so it is not part of the tests, which step smaller worlds.

    tools/check_worlds.py [--fase build/release/fase] [--steps 600] [--threads 1]
"""
import argparse
import json
import re
import subprocess
import sys

# Kind, bodies (0: default), seed. Small enough that each structure steps a world in a few seconds.
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
        groups = "; ".join(f"{value}: {', '.join(names)}" for value, names in hashes.items())
        print(f"{kind:14} {options.steps} steps  " + (f"{next(iter(hashes))} from all {len(structures)}" if len(hashes) == 1 else "DIFFER: " + groups),
              flush=True)
        wrong += len(hashes) != 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
