#!/usr/bin/env python3
"""Finds broken links and missing pictures, without a network.

    python3 book/tools/links.py                  in the Markdown files of the repository
    python3 book/tools/links.py target/book      in the book as it was built

In Markdown: links and pictures, also to headings of other files and out of the book, what
`{{#include}}` names, and pages of the book that are not in its summary or stand there in vain.
In HTML: what `href` and `src` name, with its anchors. Links to the web are not followed.
"""

import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parent.parent.parent
# Their text becomes pages of the book, and their links are right there.
MADE_INTO_PAGES = ROOT / "crates/moldwarp-io/src/reference"
ELSEWHERE = re.compile(r"[a-zA-Z][a-zA-Z0-9+.-]*:|//")


def files(root):
    """Markdown files that are, or would be, committed."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    names = done.stdout.split("\n") if done.returncode == 0 else map(str, root.rglob("*.md"))
    there = (root / name for name in names if name and (root / name).exists())
    return sorted(path for path in there if MADE_INTO_PAGES not in path.parents)


def prose(text):
    """The text without code; a line stays a line."""
    blank = lambda found: re.sub(r"[^\n]", " ", found[0])
    text = re.sub(r"^ *(```+|~~~+)[^\n]*\n.*?^ *\1[^\n]*$", blank, text, flags=re.M | re.S)
    return re.sub(r"(?<!`)(`+)(?!`)(?:(?!\n\n).)+?(?<!`)\1(?!`)", blank, text, flags=re.S)


def slug(heading):
    """The anchor of a heading, as the repository's web view and mdBook both make it."""
    heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    heading = re.sub(r"[`*]", "", heading).strip().lower()
    return re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", heading))


@cache
def anchors(path):
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".html":
        return frozenset(re.findall(r'\b(?:id|name)="([^"]+)"', text))
    # Headings are looked for outside fences; code within a heading is part of it.
    text = re.sub(r"^ *(```+|~~~+)[^\n]*\n.*?^ *\1[^\n]*$", "", text, flags=re.M | re.S)
    found, seen = [], {}
    for heading in re.findall(r"^#{1,6} +(.+?) *#*$", text, re.M):
        name = slug(heading)
        found.append(f"{name}-{seen[name]}" if name in seen else name)
        seen[name] = seen.get(name, 0) + 1
    return frozenset(found + re.findall(r'\b(?:id|name)="([^"]+)"', text))


def broken(path, target, home):
    """Why the link does not lead anywhere, or None."""
    if not target or ELSEWHERE.match(target):
        return None
    name, _, anchor = unquote(target).partition("#")
    name = name.partition("?")[0]
    there = (path.parent / name).resolve() if name else path
    if name.startswith("/"):
        return "begins at the root of no one knows which server"
    if not there.exists():
        return f"{name} does not exist"
    if not there.is_relative_to(home):
        return f"{name} is outside the repository"
    if there.is_dir() and anchor:
        return f"{name} is a folder and has no anchors"
    if anchor and there.suffix in [".md", ".html"] and anchor not in anchors(there):
        return f"{there.name} has no heading #{anchor}"
    return None


def links(path):
    """Targets with the number of their line."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".html":
        patterns = [r'\b(?:href|src)="([^"]*)"']
    else:
        whole, text = text, prose(text)
        patterns = [r"\]\(([^)\s]+)(?:\s+\"[^\"]*\")?\)", r'\b(?:href|src)="([^"]*)"']
        for found in re.finditer(r"\{\{#include ([^}:\s]+)", whole):
            yield whole.count("\n", 0, found.start()) + 1, found[1]
    for pattern in patterns:
        for found in re.finditer(pattern, text):
            yield text.count("\n", 0, found.start()) + 1, found[1].replace("&amp;", "&")


def summary(src):
    """Pages without a place in the summary."""
    listed = re.findall(r"\]\(([^)]+)\)", (src / "SUMMARY.md").read_text(encoding="utf-8"))
    there = {str(p.relative_to(src)) for p in src.rglob("*.md")} - {"SUMMARY.md"}
    yield from (f"book/src/{page} is not in SUMMARY.md" for page in sorted(there - set(listed)))
    yield from (f"SUMMARY.md lists {page} twice" for page in set(listed) if listed.count(page) > 1)


def faults(root, built=None):
    if built:
        pages = [p for p in sorted(built.rglob("*.html")) if p.name not in ["404.html", "toc.html"]]
    else:
        pages = files(root)
        yield from summary(root / "book/src")
    for path in pages:
        for line, target in links(path):
            why = broken(path, target, root)
            if why:
                yield f"{path.relative_to(root)}:{line}: {target}: {why}"


def main():
    built = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None
    if built and not (built / "index.html").exists():
        print(f"{built} is no book: it has no index.html")
        return 1
    found = list(faults(ROOT, built))
    print("\n".join(found) if found else "no broken link")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
