#!/usr/bin/env python3
"""Makes the pictures of docs/tour.md (sketches, and what the command `fase` draws) and of docs/structures.

Usage: make_pictures.py [--program build/release/fase] [--check] [REPOSITORY]. --check writes nothing: exit code 1 when a sketch
differs from its file, or when a picture that `fase` draws does not exist. The level of the tour is drawn by the command on its page.
"""
import argparse
import random
import re
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
GROUND = bytes((0xe4, 0xe7, 0xeb, 0xff))  # of sprites: shows their rectangles on the page


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
    """A PNG file of one colour, light grey where inside(x, y) is false; x and y go from -1 to 1."""
    rows = b"".join(b"\0" + b"".join(bytes((*colour, 255)) if inside(2 * (x + 0.5) / width - 1, 2 * (y + 0.5) / height - 1) else GROUND
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


def add(path, shapes):
    """Adds shapes to the end of a drawing, whose content begins 64 pixels below its legend."""
    text = path.read_text(encoding="utf-8")
    group = f'<g transform="translate(0 64)" font-family="sans-serif" font-size="14" fill="#1f2328">{shapes}</g>'
    path.write_text(text.replace("</svg>", f"{group}\n</svg>"), encoding="utf-8")


def add_distance(path):
    """Adds the 120 m between the middles of the two crowds: the boxes fill the width of the page but for 20 pixels on each side."""
    lefts = [float(x) for x in re.findall(r'<rect x="([\d.]+)" y="[\d.]+" width="[\d.]+" height="[\d.]+"/>', path.read_text(encoding="utf-8"))]
    middles = [sum(crowd) / len(crowd) for crowd in ([x for x in lefts if x < 450], [x for x in lefts if x > 450])]
    line = "M{0:.0f} 131v12m0-6H{1:.0f}m0-6v12".format(*middles)
    add(path, f'<path d="{line}" fill="none" stroke="#1f2328" stroke-width="1.5"/><text x="450" y="129" text-anchor="middle">120 m</text>')


def add_enlarged_cell(path):
    """Adds a cell of the loose octree at depth 3, away from the border, and the limit of its boxes, which is half a side farther out."""
    layer = re.search(r'id="depth3" d="([^"]+)"', path.read_text(encoding="utf-8"))[1]
    cells = [tuple(map(float, cell)) for cell in re.findall(r"M([\d.]+) ([\d.]+)h([\d.]+)v([\d.]+)", layer)]
    x, y, width, height = next(cell for cell in cells if min(cell[:2]) > 200)
    add(path, f'<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="none" stroke="#cc79a7" stroke-width="4"/>'
              f'<rect x="{x - width / 2}" y="{y - height / 2}" width="{2 * width}" height="{2 * height}" fill="none" stroke="#cc79a7" '
              'stroke-width="3" stroke-dasharray="9 6"/>')


def draw(program, pictures, pages):
    """Writes the pictures that the command draws: those of the tour, and those of the structures' pages."""
    def fase(*arguments):
        subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_cities(folder / "cities.aabt")
        fase("draw", folder / "cities.aabt", "--structure", "dynamic_bvh", "-o", pictures / "cities.svg")
        add_distance(pictures / "cities.svg")
        fase("run", "sleepers", "--count", 300, "--seconds", 4, "--trace", folder / "asleep.aabt")
        fase("draw", folder / "asleep.aabt", "--structure", "dynamic_bvh", "--frame", 200, "-o", pictures / "asleep.svg")
        fase("generate", "flat", "--count", 250, "--frames", 20, "-o", folder / "flat.aabt")
        for structure in STRUCTURES:
            fase("draw", folder / "flat.aabt", "--structure", structure, "--frame", 10, "-o", pictures / f"{structure}.svg")
        fase("run", "domino", "--count", 800, "--steps", 301, "--trace", folder / "domino.aabt")
        fase("draw", folder / "domino.aabt", "--structure", "all", "--frame", 300, "-o", f"{pages}/")
        add_enlarged_cell(pages / "loose_octree.svg")
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
