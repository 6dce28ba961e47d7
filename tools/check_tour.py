#!/usr/bin/env python3
"""Holds docs/tour.md to the examples: its code is theirs, its output is what they print.

Usage: check_tour.py [--write] PROGRAMS [REPOSITORY]. PROGRAMS is the folder that holds example_NAME for each
examples/NAME.cpp (build/<preset>/examples). A block of ```cpp must be a run of whole lines of the example that was
named last before it, indented as there or less; a block of ```text must be all that this example prints. With --write
the blocks of output are renewed instead of checked; code is never written. Exit code 1 when something differs.
"""
import re
import subprocess
import sys
import textwrap
from pathlib import Path

PAGE = "docs/tour.md"
BLOCK = re.compile(r"examples/(\w+)\.cpp|^```(cpp|text)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def is_part_of(block, source):
    """Whether the block's lines stand in the source, one after the other, moved to the left alike."""
    wanted = textwrap.dedent(block).splitlines()
    lines = source.splitlines()
    return any(textwrap.dedent("\n".join(lines[i:i + len(wanted)])).splitlines() == wanted
               for i in range(len(lines) - len(wanted) + 1))


def printed_by(program):
    """All that a program prints; a program that fails fails the check."""
    done = subprocess.run([program], capture_output=True, text=True, timeout=120, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{program} ends with {done.returncode}: {done.stderr}")
    return done.stdout


def check(page, source_of, output_of):
    """(objections, the page with its outputs renewed). `source_of` and `output_of` take an example's name."""
    objections, example = [], None

    def look_at(found):
        nonlocal example
        if found[1]:
            example = found[1]
            return found[0]
        line = page.count("\n", 0, found.start()) + 1
        if example is None:
            objections.append(f"{PAGE}:{line}: a block before any example is named")
        elif found[2] == "cpp":
            if not is_part_of(found[3], source_of(example)):
                objections.append(f"{PAGE}:{line}: this code is not in examples/{example}.cpp")
        elif found[3] != output_of(example):
            objections.append(f"{PAGE}:{line}: examples/{example}.cpp prints something else")
            return f"```text\n{output_of(example)}```"
        return found[0]

    return objections, BLOCK.sub(look_at, page)


def main():
    arguments = [a for a in sys.argv[1:] if a != "--write"]
    programs = Path(arguments[0]).resolve()
    root = Path(arguments[1] if len(arguments) > 1 else Path(__file__).parent.parent).resolve()
    page = (root / PAGE).read_text(encoding="utf-8")
    objections, renewed = check(page, lambda name: (root / "examples" / f"{name}.cpp").read_text(encoding="utf-8"),
                                lambda name: printed_by(programs / f"example_{name}"))
    if len(arguments) < len(sys.argv) - 1:
        (root / PAGE).write_text(renewed, encoding="utf-8")
        objections = [text for text in objections if "prints something else" not in text]
    print("\n".join(objections) or f"{PAGE} shows what the examples are and print")
    sys.exit(1 if objections else 0)


if __name__ == "__main__":
    main()
