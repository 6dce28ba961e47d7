#!/usr/bin/env python3
"""Compiles all maps of WAD files with `fase level`, zdbsp and glbsp, alternating; writes bench/results/level.csv.

Usage: measure_level.py [--program build/release/fase] [--rounds 5] [--repository .] [WAD …]. Without a WAD, uses those of
Debian's package freedoom. Compares with the compilers found on PATH (tools/install_peers installs zdbsp, glbsp and freedoom). For each compiler,
`fase level --lumps nodes --check` reads the figures from the lumps that it wrote. The time of a single map excludes starting the program.
Run tools/make_tables.py afterwards.
"""
import argparse
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from figures import origin_of, write_table

FREEDOOM = [Path("/usr/share/games/doom") / name for name in ("freedoom1.wad", "freedoom2.wad")]
FIELDS = ["machine", "date", "commit", "compiler", "settings", "wad", "map", "lines", "sides", "segs", "splits", "nodes",
          "subsectors", "mean_depth", "worst_depth", "cpu_seconds", "wall_seconds", "bulge", "area_error"]
MAP_LUMPS = {"THINGS", "LINEDEFS", "SIDEDEFS", "VERTEXES", "SEGS", "SSECTORS", "NODES", "SECTORS", "REJECT", "BLOCKMAP"}


def contenders(program):
    """Returns (compiler, settings, function from input and output to command line) for each compiler that is installed."""
    def fase(*options):
        return lambda wad, out: [program, "level", wad, "--all", "-o", out, "--threads", "1", *options]

    found = [("fase", "default", fase()),
             ("fase", "--effort quick", fase("--effort", "quick")),
             ("fase", "--weight 0 --effort thorough", fase("--weight", "0", "--effort", "thorough"))]
    if zdbsp := shutil.which("zdbsp"):
        found += [("zdbsp", "default", lambda wad, out: [zdbsp, "-t", "-o", out, wad]),
                  ("zdbsp", "-g", lambda wad, out: [zdbsp, "-t", "-g", "-o", out, wad])]
    if glbsp := shutil.which("glbsp"):
        found += [("glbsp", "-n", lambda wad, out: [glbsp, "-q", "-xp", "-n", wad, "-o", out])]
    return found


def run(command):
    """Returns processor and elapsed seconds of a program. Exits when it fails."""
    begin = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"measure_level.py: error: {command[0]} ended with {process.returncode}")
    return usage.ru_utime + usage.ru_stime, time.monotonic() - begin


def startup_seconds(command, times=9):
    """Returns the processor seconds of starting a program (its --version)."""
    program = command(Path("/dev/null"), Path("/dev/null"))[0]
    taken = []
    for _ in range(times):
        with subprocess.Popen([program, "--version"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        taken.append(usage.ru_utime + usage.ru_stime)
    return median(taken)


def figures_of(program, wad):
    """Returns the figures of a compiled WAD by map, read from its lumps."""
    report = subprocess.run([program, "level", wad, "--all", "--lumps", "nodes", "--check", "--json"], check=False,
                          stdout=subprocess.PIPE, text=True).stdout
    return {row["map"]: row for row in json.loads(report)}


def single_maps(wad, folder):
    """Writes each map to its own WAD; yields (map, file)."""
    data = wad.read_bytes()
    count, directory = struct.unpack_from("<ii", data, 4)
    lumps = []
    for i in range(count):
        at, size = struct.unpack_from("<ii", data, directory + 16 * i)
        lumps.append((data[directory + 16 * i + 8:directory + 16 * i + 16], data[at:at + size]))
    names = [name.split(b"\0")[0].decode("latin-1") for name, _ in lumps]
    for i, name in enumerate(names):
        if names[i + 1:i + 3] != ["THINGS", "LINEDEFS"]:
            continue
        end = i + 1
        while end < count and names[end] in MAP_LUMPS:
            end += 1
        body, entries = b"", b""
        for raw, content in lumps[i:end]:
            entries += struct.pack("<ii", 12 + len(body), len(content)) + raw
            body += content
        file = Path(folder) / f"{wad.stem}-{name}.wad"
        file.write_bytes(b"PWAD" + struct.pack("<ii", end - i, 12 + len(body)) + body + entries)
        yield name, file


def median(values):
    return sorted(values)[len(values) // 2]


def measure(program, wad, rounds, folder):
    """Yields one dictionary per contender and map, and one per contender for the full file."""
    found = contenders(program)
    starts = [startup_seconds(command) for _, _, command in found]
    out = Path(folder) / "out.wad"
    jobs = [("all", wad), *single_maps(wad, folder)]
    for name, file in jobs:
        seconds = [[] for _ in found]
        figures = []
        for turn in range(rounds if name == "all" else max(1, rounds // 2)):
            for k, (_, _, command) in enumerate(found):
                seconds[k].append(run(command(file, out)))
                if turn == 0:
                    figures.append(figures_of(program, out))
        for k, (compiler, settings, _) in enumerate(found):
            maps = figures[k].values()
            row = {key: sum(one[key] for one in maps) for key in ("lines", "sides", "segs", "splits", "nodes", "subsectors")}
            cpu = median([one[0] for one in seconds[k]])
            leaves = sum(one["mean_depth"] * one["subsectors"] for one in maps)
            yield row | {"compiler": compiler, "settings": settings, "wad": wad.name, "map": name,
                         "mean_depth": round(leaves / row["subsectors"], 4),
                         "worst_depth": max(one["worst_depth"] for one in maps),
                         "cpu_seconds": round(cpu if name == "all" else max(cpu - starts[k], 0.0001), 4),
                         "wall_seconds": round(median([one[1] for one in seconds[k]]), 4),
                         "bulge": max(one["bulge"] for one in maps), "area_error": max(one["area_error"] for one in maps)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="build/release/fase")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--repository", default=Path(__file__).parent.parent, type=Path)
    parser.add_argument("wads", nargs="*", type=Path)
    options = parser.parse_args()
    wads = options.wads or [wad for wad in FREEDOOM if wad.is_file()]
    if not wads:
        raise SystemExit("measure_level.py: error: found no WAD; expected a path, or Debian's package freedoom")
    about = origin_of(options.repository)
    with tempfile.TemporaryDirectory() as folder:
        rows = [about | row for wad in wads for row in measure(str(options.program), wad, options.rounds, folder)]
    write_table(options.repository / "bench/results/level.csv", FIELDS, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
