#!/usr/bin/env python3
"""Which results of the validation are older than the code that makes them.

    python3 book/tools/age.py

A case's results are made by the solver (`crates/moldwarp/src`), by what all cases share and by the
case's own file, which the validation chapter names. The commit that results were made at stands in
`validation/results/*/made.csv`, written together with them; for results from before that file
existed it is the commit that brought them. Commits since then that touch the code are counted. Not
every such commit changes a result; that it does not is only known when the case is computed again.
"""

import csv
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SHARED = ["crates/moldwarp/src", "validation/src/setup.rs", "validation/src/exact"]


def git(*arguments, root=None):
    try:
        done = subprocess.run(
            ["git", *arguments], cwd=root or ROOT, capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def cases(root=None):
    """The cases in the order of the chapter, each with its files."""
    chapter = ((root or ROOT) / "book/src/validation.md").read_text(encoding="utf-8")
    for section in re.split(r"^## ", chapter, flags=re.MULTILINE)[1:]:
        found = re.search(r"Source:\s+((?:`validation/[^`]+`[,\s]*)+)", section)
        if found:
            yield section.split("\n", 1)[0].strip(), re.findall(r"`([^`]+)`", found[1])


def age(case, sources, folder, root=None):
    """The commit of the results and how many since touch the code; None for what is not known."""
    root = root or ROOT
    table = f"{folder}/{case}.csv"
    made = root / folder / "made.csv"
    commit, changed = None, False
    if made.exists():
        with made.open(encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["case"] == case:
                    commit = row["commit"].rstrip("+")
                    changed = row["commit"].endswith("+")
    commit = commit or git("log", "-1", "--format=%h", "--abbrev=7", "--", table, root=root)
    # Where history is cut off, its last commit seems to have brought everything.
    whole = git("rev-parse", "--is-shallow-repository", root=root) == "false"
    date = whole and commit and git("show", "-s", "--format=%cs", commit, root=root)
    if not date:
        return {"case": case, "commit": commit or "–", "date": "–", "since": None, "changed": changed}
    since = git("rev-list", "--count", f"{commit}..HEAD", "--", *SHARED, *sources, root=root)
    return {"case": case, "commit": commit, "date": date, "since": int(since), "changed": changed}


def ages(root=None):
    for case, sources in cases(root):
        for fidelity in ["fine", "coarse"]:
            folder = f"validation/results/{fidelity}"
            if ((root or ROOT) / folder / f"{case}.csv").exists():
                yield {"fidelity": fidelity, **age(case, sources, folder, root)}


def verdict(row):
    if row["since"] is None:
        return "not known: this clone does not have the history"
    changed = "made by code that was not committed; " if row["changed"] else ""
    if row["since"] == 0:
        return changed + "no" if not changed else changed + "nothing committed since"
    return f"{changed}yes, by {row['since']} commit{'s' if row['since'] > 1 else ''}"


def markdown(rows):
    """A row a case; the two kinds of results side by side."""
    cases = {}
    for row in rows:
        made = f"{row['commit']} ({row['date'].replace('-', '&#8209;')})"
        cases.setdefault(row["case"], {})[row["fidelity"]] = f"{made} | {verdict(row)}"
    lines = [
        "| case | fine: made at | code changed since | coarse: made at | code changed since |",
        "|---|---|---|---|---|",
    ]
    for case, kinds in cases.items():
        both = [kinds.get(fidelity, "– | –") for fidelity in ["fine", "coarse"]]
        lines.append(f"| [{case}](#{case}) | {both[0]} | {both[1]} |")
    head = git("log", "-1", "--format=%h of %cs", "--abbrev=7") or "an unknown commit"
    return "\n".join([*lines, "", f"(As of {head}.)"])


def main():
    rows = list(ages())
    old = [row for row in rows if row["since"] != 0 or row["changed"]]
    for row in rows:
        print(f"{row['case']:20} {row['fidelity']:7} {row['commit']:8} {row['date']:11} {verdict(row)}")
    print(f"{len(old)} of {len(rows)} results may be older than the code that makes them")
    return 0


if __name__ == "__main__":
    sys.exit(main())
