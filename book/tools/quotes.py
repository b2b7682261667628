#!/usr/bin/env python3
"""That parts of scenes in the tutorials are what the examples' files say.

    python3 book/tools/quotes.py

Each paragraph of a block fenced as `toml` in `tutorials/CASE.md` must stand, line by line, in a file of
`examples/CASE`; the examples are run by the tests. Whole files are included instead.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def paragraphs(page):
    """Each with the number of its first line."""
    for block in re.finditer(r"^```toml\n(.*?)^```$", page, re.M | re.S):
        line = page.count("\n", 0, block.start(1)) + 1
        for found in re.finditer(r"(?:[^\n]+\n)+", block[1]):
            if not found[0].startswith("{{#include"):
                yield line + block[1].count("\n", 0, found.start()), found[0]


def faults(root):
    for page in sorted((root / "book/src/tutorials").glob("*.md")):
        files = sorted((root / "examples" / page.stem).glob("*.toml"))
        texts = ["\n" + f.read_text(encoding="utf-8").rstrip("\n") + "\n" for f in files]
        for line, paragraph in paragraphs(page.read_text(encoding="utf-8")):
            if not any("\n" + paragraph in text for text in texts):
                first = paragraph.split("\n", 1)[0]
                yield f"{page.relative_to(root)}:{line}: `{first}` …: no scene of the example says this"


def main():
    found = list(faults(ROOT))
    print("\n".join(found) if found else "all parts of scenes are those of the examples")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
