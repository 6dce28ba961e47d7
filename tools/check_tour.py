#!/usr/bin/env python3
"""Checks that the code and output in docs/tour.md are those of the examples.

Usage: check_tour.py [--write] PROGRAMS [REPOSITORY]. PROGRAMS is the folder that holds example_NAME for each
examples/NAME.cpp (build/<preset>/examples); the command `fase` is expected in the folder above it. Each block belongs to the
example named last before it. A ```cpp block must be consecutive full lines of that example, with the same or less indentation; a
```text block must be its full output. A ```console block holds commands after "$ ", each with its output, in which … stands for any
text; they run in one empty folder, in the order of the page. With --write the tool updates the ```text blocks instead of checking
them; it never writes code or the output of commands. Exit code 1 when something differs.
"""
import os
import re
import subprocess
import sys
import tempfile
import textwrap
from pathlib import Path

PAGE = "docs/tour.md"
BLOCK = re.compile(r"examples/(\w+)\.cpp|^```(cpp|text|console)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


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


def output_of_command(command, folder, programs):
    """Runs a command by the shell in a folder, with the programs of another folder. Returns its output and errors."""
    path = f"{programs}{os.pathsep}{os.environ.get('PATH', '')}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=120, check=False, cwd=folder,
                          env=os.environ | {"PATH": path})
    return done.stdout + (f"{done.stderr}exit code {done.returncode}\n" if done.returncode != 0 else "")


def commands_of(block):
    """Yields each command of a console block with the output that it must have."""
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        command, _, expected = part.partition("\n")
        yield command, expected


def fits(expected, output):
    """Whether an output is the expected one, in which … stands for any text."""
    return re.fullmatch(".*".join(re.escape(part) for part in expected.split("…")), output, re.DOTALL) is not None


def check(page, source_of, output_of, run=None):
    """Returns the errors and the page with updated outputs. `source_of` and `output_of` take the name of an example, `run` a
    command; without it commands are not checked."""
    errors, example = [], None

    def check_block(found):
        nonlocal example
        if found[1]:
            example = found[1]
            return found[0]
        line = page.count("\n", 0, found.start()) + 1
        if found[2] == "console":
            for command, expected in commands_of(found[3]) if run else []:
                output = run(command)
                if not fits(expected, output):
                    errors.append(f"{PAGE}:{line}: found output that differs from `{command}`, which prints\n{output}")
        elif example is None:
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
    with tempfile.TemporaryDirectory() as folder:
        has_command = (programs.parent / "fase").exists()  # builds of the library alone have none
        errors, updated = check(page, lambda name: (root / "examples" / f"{name}.cpp").read_text(encoding="utf-8"),
                                lambda name: output_of_program(programs / f"example_{name}"),
                                (lambda command: output_of_command(command, folder, programs.parent)) if has_command else None)
    if len(arguments) < len(sys.argv) - 1:
        (root / PAGE).write_text(updated, encoding="utf-8")
        errors = [text for text in errors if "found output that differs from examples" not in text]
    print("\n".join(errors) or f"{PAGE} agrees with the examples and the command")
    sys.exit(1 if errors else 0)


if __name__ == "__main__":
    main()
