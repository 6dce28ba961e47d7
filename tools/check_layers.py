#!/usr/bin/env python3
"""Holds the tree to the drawing of ARCHITECTURE.md: fails on every include that the drawing does not allow.

Usage: check_layers.py [REPOSITORY]. Prints file:line of each offence. Checked: an include of a layer, or of a room of a layer, that may
not be included; an include that is not written from the repository's root or names no file; files that include each other in
a circle; a folder that the drawing does not have.
"""
import re
import sys
from pathlib import Path

# The drawing: a layer, and the layers right below it. A layer may include itself and all that is reached from it.
BELOW = {
    "core": [],
    "math": ["core"],
    "geometry": ["math"],
    "broad": ["geometry"],
    "narrow": ["geometry"],
    "pairs": ["broad"],
    "dynamics": ["geometry"],
    "query": ["broad"],
    "world": ["narrow", "dynamics", "pairs"],
    "drawing": ["math"],
    "scene": ["world"],
    "record": ["world", "drawing"],
    "level": ["broad", "drawing"],
    "atlas": ["core"],
}
# Folders inside a layer ("rooms"). A room may include the layer's own headers and the rooms named here; its headers are internal: other
# layers may not include them, save those that are named here as shared. Files directly in a layer may include all of its rooms.
ROOMS = {
    "broad": {
        "boxes": [],
        "search": ["boxes"],
        "builders": ["boxes", "search"],
        "sweep": ["boxes", "search"],
        "uniform_grid": ["boxes", "search"],
        "row_grid": ["boxes", "search"],
        "plane_tree": ["boxes", "search", "builders"],
        "dynamic_bvh": ["boxes", "search", "builders"],
        "wide_bvh": ["boxes", "search", "builders"],
    },
    "geometry": {"detail": [], "shapes": ["detail"]},
    "narrow": {"detail": [], "pairs": ["detail"], "seams": ["detail"]},
    "level": {"detail": [], "compiler": ["detail"], "visibility": ["detail"]},
    "record": {"recording": [], "trace": [], "export": ["recording"]},
    "scene": {"detail": [], "generate": [], "gltf": ["detail", "generate"]},
}
# Rooms whose headers other layers may include: (layer, room): layers.
SHARED_ROOMS = {
    ("core", "detail"): set(BELOW),
    ("math", "detail"): {"geometry", "broad", "narrow", "query", "dynamics", "world"},
    ("geometry", "shapes"): set(BELOW),
    ("broad", "boxes"): {"level"},
    ("broad", "builders"): {"level"},
    ("broad", "search"): {"query", "pairs"},
    ("broad", "row_grid"): {"pairs"},
    ("dynamics", "solver"): {"world"},
    ("narrow", "seams"): {"world"},
    ("pairs", "detail"): {"world"},
}
# Headers directly in `fase/`: what a component's users include. They may include every layer of their component and below.
UMBRELLAS = {"fase/collision.hpp", "fase/world.hpp", "fase/io.hpp", "fase/fase.hpp"}
COMPONENTS = {
    "fase/collision.hpp": ["core", "math", "geometry", "broad", "narrow", "pairs", "query"],
    "fase/world.hpp": ["dynamics", "world"],
    "fase/io.hpp": ["drawing", "scene", "record", "level", "atlas"],
}
# Programs and tests may include every layer, themselves, and these folders.
PROGRAMS = {"cli": ["bench", "viewer"], "bench": [], "examples": [], "viewer": [], "tests": ["bench", "cli"]}
GENERATED = {"fase/core/version.hpp"}  # written by CMake into the build folder

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')
SOURCE_ENDINGS = {".hpp", ".cpp", ".h", ".inl"}


def reached_from(layer):
    """The layer itself and every layer that an arrow path leads to."""
    reached, to_do = set(), [layer]
    while to_do:
        name = to_do.pop()
        if name not in reached:
            reached.add(name)
            to_do += BELOW[name]
    return reached


def place_of(path):
    """Where a path from the root belongs: ("fase", layer) or (program folder, None)."""
    parts = Path(path).parts
    if parts[0] == "fase" and len(parts) > 2:
        return "fase", parts[1]
    return parts[0], None


def room_of(path):
    """The room of a layer's file: "row_grid" of fase/broad/row_grid/set.hpp; None of a file directly in the layer."""
    parts = Path(path).parts
    return parts[2] if parts[0] == "fase" and len(parts) > 3 else None


def room_objection(path, name):
    """Why a file may not include that header of a room; None when it may."""
    layer, room = place_of(path)[1], room_of(path)
    target_layer, target = place_of(name)[1], room_of(name)
    if target is None:
        return None
    if place_of(path)[0] == "examples":
        return None if target == "shapes" else "is internal: examples include public headers only"
    if place_of(path)[0] != "fase" or path in UMBRELLAS:
        return None
    if layer == target_layer:
        allowed = ROOMS.get(layer, {}).get(room, [])
        if room is None or room == target or target in allowed:
            return None
        return f"{layer}/{room} may include of its layer's rooms only {', '.join(allowed) or 'itself'}"
    if layer in SHARED_ROOMS.get((target_layer, target), set()):
        return None
    return f"{target_layer}/{target} is internal to {target_layer}"


def includes_of(root, path):
    """(line number, quote or bracket, included name) of each include of a file."""
    text = (root / path).read_text(encoding="utf-8", errors="replace")
    for number, line in enumerate(text.splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found[1], found[2]


def objection(root, path, quote, name):
    """Why a file may not have this include; None when it may."""
    folder, layer = place_of(path)
    target_folder, target_layer = place_of(name)
    ours = target_folder == "fase" or target_folder in PROGRAMS
    if quote == "<":
        return "own headers are included with quotes" if target_folder == "fase" else None
    if not ours:
        return "is not written from the repository's root" if not name.endswith(".inc") else None
    if name not in GENERATED and not (root / name).is_file():
        return "names no file"
    if folder == "fase":
        if target_folder != "fase":
            return "the library may not include a program, a benchmark or a test"
        if name in UMBRELLAS:
            return None if path in UMBRELLAS else "is for users of the library"
        if path not in UMBRELLAS and target_layer not in reached_from(layer):
            return f"{layer} may include only {', '.join(sorted(reached_from(layer)))}"
    elif target_folder not in ("fase", folder, *PROGRAMS[folder]):
        return f"{folder} may not include {target_folder}"
    return room_objection(path, name)


def first_circle(graph):
    """A list of files that include each other in a circle, the first one again at its end; [] when there is none."""
    state = {}  # file: 1 while on the path, 2 when done
    for start in sorted(graph):
        path, to_do = [], [(start, False)]
        while to_do:
            file, leaving = to_do.pop()
            if leaving:
                state[file] = 2
                path.pop()
            elif state.get(file) == 1:
                return path[path.index(file):] + [file]
            elif file not in state:
                state[file] = 1
                path.append(file)
                to_do.append((file, True))
                to_do += [(next_file, False) for next_file in graph.get(file, []) if state.get(next_file) != 2]
    return []


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    offences, graph, files = [], {}, 0
    for top in ["fase", *PROGRAMS]:
        for file in sorted((root / top).rglob("*")):
            if file.suffix not in SOURCE_ENDINGS or "node_modules" in file.parts:
                continue
            path = file.relative_to(root).as_posix()
            files += 1
            if top == "fase" and path not in UMBRELLAS and place_of(path)[1] not in BELOW:
                offences.append(f"{path}:1: lies in no layer of the drawing")
                continue
            for number, quote, name in includes_of(root, path):
                why = objection(root, path, quote, name)
                if why:
                    offences.append(f'{path}:{number}: includes "{name}": {why}')
                elif quote == '"':
                    graph.setdefault(path, []).append(name)
    for umbrella, layers in COMPONENTS.items():
        if not (root / umbrella).is_file():
            continue
        included = {name for _, _, name in includes_of(root, umbrella)}
        public = {file.relative_to(root).as_posix() for layer in layers for file in (root / "fase" / layer).glob("*.hpp")}
        for name in sorted(public - included):
            offences.append(f"{umbrella}:1: misses {name}, which is public")
    circle = first_circle(graph)
    if circle:
        offences.append("a circle of includes: " + " -> ".join(circle))
    print("\n".join(offences) or f"{files} files keep to the drawing")
    sys.exit(1 if offences else 0)


if __name__ == "__main__":
    main()
