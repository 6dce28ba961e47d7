#!/usr/bin/env python3
"""Checks that the code and output in docs/tour.md are those of the examples.

Usage: check_tour.py [--write] PROGRAMS [REPOSITORY]. PROGRAMS is the folder that holds example_NAME for each
examples/NAME.cpp (build/<preset>/examples). Each block belongs to the example named last before it. A ```cpp block must be
consecutive full lines of that example, with the same or less indentation; a ```text block must be its full output. With --write
the tool updates the output blocks instead of checking them; it never writes code. Exit code 1 when something differs.
"""
import re
import subprocess
import sys
import textwrap
from pathlib import Path

PAGE = "docs/tour.md"
BLOCK = re.compile(r"examples/(\w+)\.cpp|^```(cpp|text)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def is_part_of(block, source):
    """Whether the block is a run of consecutive source lines, apart from common indentation."""
    expected = textwrap.dedent(block).splitlines()
    lines = source.splitlines()
    return any(textwrap.dedent("\n".join(lines[i:i + len(expected)])).splitlines() == expected
               for i in range(len(lines) - len(expected) + 1))


def output_of_program(program):
    """Returns the output of a program. Raises when the program fails."""
    done = subprocess.run([program], capture_output=True, text=True, timeout=120, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{program} ends with {done.returncode}: {done.stderr}")
    return done.stdout


def check(page, source_of, output_of):
    """Returns the errors and the page with updated outputs. `source_of` and `output_of` take the name of an example."""
    errors, example = [], None

    def check_block(found):
        nonlocal example
        if found[1]:
            example = found[1]
            return found[0]
        line = page.count("\n", 0, found.start()) + 1
        if example is None:
            errors.append(f"{PAGE}:{line}: found a block before the first example name")
        elif found[2] == "cpp":
            if not is_part_of(found[3], source_of(example)):
                errors.append(f"{PAGE}:{line}: found code that is not in examples/{example}.cpp")
        elif found[3] != output_of(example):
            errors.append(f"{PAGE}:{line}: found output that differs from examples/{example}.cpp; update with --write")
            return f"```text\n{output_of(example)}```"
        return found[0]

    return errors, BLOCK.sub(check_block, page)


def main():
    arguments = [a for a in sys.argv[1:] if a != "--write"]
    programs = Path(arguments[0]).resolve()
    root = Path(arguments[1] if len(arguments) > 1 else Path(__file__).parent.parent).resolve()
    page = (root / PAGE).read_text(encoding="utf-8")
    errors, updated = check(page, lambda name: (root / "examples" / f"{name}.cpp").read_text(encoding="utf-8"),
                                lambda name: output_of_program(programs / f"example_{name}"))
    if len(arguments) < len(sys.argv) - 1:
        (root / PAGE).write_text(updated, encoding="utf-8")
        errors = [text for text in errors if "found output that differs" not in text]
    print("\n".join(errors) or f"{PAGE} agrees with the examples")
    sys.exit(1 if errors else 0)


if __name__ == "__main__":
    main()
