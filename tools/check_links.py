#!/usr/bin/env python3
"""Fails on every relative link in the Markdown pages below a folder that leads to no file, or to no heading of a page.

Usage: check_links.py FOLDER. Prints page and link of each offence.
"""
import re
import sys
from functools import lru_cache
from pathlib import Path


def without_code_blocks(page):
    """The text of a page without fenced blocks, in which lambdas look like links and comments like headings."""
    return re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)


@lru_cache(maxsize=None)
def anchors(page):
    """The anchors that GitHub gives the headings of a page: lower case, without punctuation, hyphens for spaces."""
    found = set()
    for heading in re.findall(r"^#+ +(.*?) *$", without_code_blocks(page), flags=re.MULTILINE):
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)  # of a link, its text
        anchor = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
        repeated, count = anchor, 0
        while repeated in found:
            count += 1
            repeated = f"{anchor}-{count}"
        found.add(repeated)
    return found


def dead_links(page):
    """The relative links of a page that lead nowhere."""
    def leads_somewhere(target):
        name, _, anchor = target.partition("#")
        path = (page.parent / name) if name else page
        return path.exists() and (not anchor or path.suffix != ".md" or anchor in anchors(path.resolve()))

    return [target for target in re.findall(r"\]\(([^)\s:]+)\)", without_code_blocks(page)) if not leads_somewhere(target)]


def main():
    folder = Path(sys.argv[1])
    pages = sorted(folder.rglob("*.md"))
    dead = [(page, target) for page in pages for target in dead_links(page)]
    for page, target in dead:
        print(f"{page}: found a link to {target}; expected an existing file or heading")
    if not pages:
        print(f"{folder}: found no page; expected at least one")
    return 1 if dead or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
