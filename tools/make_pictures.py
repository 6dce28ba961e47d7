#!/usr/bin/env python3
"""Makes the pictures of docs/tour.md (sketches, and what the command `fase` draws) and of docs/structures.

Usage: make_pictures.py [--program build/release/fase] [--check] [REPOSITORY]. --check writes nothing: exit code 1 when a sketch
differs from its file, or when a picture that `fase` draws does not exist. The level of the tour is drawn by the command on its page.
"""
import argparse
import random
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

from tour_sketches import SKETCHES

FOLDER = "docs/pictures/tour"
PAGES = "docs/pictures/structures"  # a picture for each structure's page
STRUCTURES = ["quadtree", "kd_tree", "dynamic_bvh", "row_grid"]
DRAWN = ["cities.svg", "asleep.svg", "atlas.png", *(f"{name}.svg" for name in STRUCTURES)]
COLOURS = [(0x00, 0x72, 0xb2), (0xd5, 0x5e, 0x00), (0x00, 0x9e, 0x73), (0xcc, 0x79, 0xa7), (0xe6, 0x9f, 0x00), (0x56, 0xb4, 0xe9)]


def write_cities(path):
    """A trace of two crowds of 150 boxes each, which are 120 m apart."""
    dice = random.Random(1)
    boxes = []
    for centre in (-60, 60):
        for _ in range(150):
            x, z = dice.gauss(centre, 9), dice.gauss(0, 9)
            boxes.append((x, 0, z, x + 1, 1.8, z + 1))
    path.write_bytes(struct.pack("<4sIII", b"AABT", 1, len(boxes), 1) + bytes(len(boxes) + -len(boxes) % 4)
                     + b"".join(struct.pack("<6f", *box) for box in boxes))


def png(width, height, colour, inside):
    """A PNG file of one colour, transparent where inside(x, y) is false; x and y go from -1 to 1."""
    rows = b"".join(b"\0" + b"".join(bytes((*colour, 255)) if inside(2 * (x + 0.5) / width - 1, 2 * (y + 0.5) / height - 1) else bytes(4)
                                     for x in range(width)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_sprites(folder):
    """Eighty sprites: discs, diamonds, rings and bars of many sizes."""
    dice = random.Random(2)
    forms = [lambda x, y: x * x + y * y <= 1, lambda x, y: abs(x) + abs(y) <= 1, lambda x, y: 0.35 <= x * x + y * y <= 1, lambda x, y: True]
    folder.mkdir()
    for i in range(80):
        width, height = dice.randint(12, 80), dice.randint(12, 80)
        (folder / f"sprite{i:02}.png").write_bytes(png(width, height, COLOURS[i % len(COLOURS)], forms[i % len(forms)]))


def draw(program, pictures, pages):
    """Writes the pictures that the command draws: those of the tour, and those of the structures' pages."""
    def fase(*arguments):
        subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_cities(folder / "cities.aabt")
        fase("draw", folder / "cities.aabt", "--structure", "dynamic_bvh", "-o", pictures / "cities.svg")
        fase("run", "sleepers", "--count", 300, "--seconds", 4, "--trace", folder / "asleep.aabt")
        fase("draw", folder / "asleep.aabt", "--structure", "dynamic_bvh", "--frame", 200, "-o", pictures / "asleep.svg")
        fase("generate", "flat", "--count", 250, "--frames", 20, "-o", folder / "flat.aabt")
        for structure in STRUCTURES:
            fase("draw", folder / "flat.aabt", "--structure", structure, "--frame", 10, "-o", pictures / f"{structure}.svg")
        fase("run", "domino", "--count", 800, "--steps", 301, "--trace", folder / "domino.aabt")
        fase("draw", folder / "domino.aabt", "--structure", "all", "--frame", 300, "-o", f"{pages}/")
        write_sprites(folder / "sprites")
        fase("atlas", folder / "sprites", "-o", folder / "atlas", "--padding", 2, "--tries", 100)
        (pictures / "atlas.png").write_bytes((folder / "atlas.png").read_bytes())


def differences(pictures):
    """The names of sketches that differ from their files, and of drawn pictures that do not exist."""
    def is_current(name, sketch):
        path = pictures / f"{name}.svg"
        return path.exists() and path.read_text(encoding="utf-8") == sketch()

    return ([f"{name}.svg" for name, sketch in SKETCHES.items() if not is_current(name, sketch)]
            + [name for name in DRAWN if not (pictures / name).exists()])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="build/release/fase")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("repository", nargs="?", default=Path(__file__).parent.parent, type=Path)
    arguments = parser.parse_args()
    pictures = arguments.repository / FOLDER
    if arguments.check:
        wrong = differences(pictures)
        print("\n".join(f"{FOLDER}/{name}: differs; run tools/make_pictures.py" for name in wrong) or "the pictures of the tour are current")
        return 1 if wrong else 0
    pictures.mkdir(parents=True, exist_ok=True)
    for name, sketch in SKETCHES.items():
        (pictures / f"{name}.svg").write_text(sketch(), encoding="utf-8")
    draw(arguments.program, pictures, arguments.repository / PAGES)
    return 0


if __name__ == "__main__":
    sys.exit(main())
