#!/usr/bin/env python3
"""Fails on every relative link in the Markdown pages below a folder that leads to no file.

Usage: check_links.py FOLDER. Prints page and link of each offence.
"""
import re
import sys
from pathlib import Path


def dead_links(page):
    """The relative links of a page that lead nowhere."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)  # lambdas look like links
    return [target for target in re.findall(r"\]\(([^)#:]+)[)#]", text) if not (page.parent / target).exists()]


def main():
    folder = Path(sys.argv[1])
    pages = sorted(folder.rglob("*.md"))
    dead = [(page, target) for page in pages for target in dead_links(page)]
    for page, target in dead:
        print(f"{page}: found a link to {target}; expected an existing file")
    if not pages:
        print(f"{folder}: found no page; expected at least one")
    return 1 if dead or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
