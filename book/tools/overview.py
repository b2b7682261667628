#!/usr/bin/env python3
"""The validation in one figure: each figure of each case over the limit that it has to keep.

    python3 book/tools/overview.py            writes validation/results/overview.svg
    python3 book/tools/overview.py --check    ends with code 1 where it is old

Read from the `*-checks.csv` of the fine results, or of the coarse ones where a case has no fine results.
Residuals of the ledger, which are round-off, are left out: they say that the books are complete, not that a
result is right.
"""

import csv
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import age

TARGET = age.ROOT / "validation/results/overview.svg"
LEFT, RIGHT, TOP, ROW = 190, 760, 62, 22
DECADES = 3  # to the left of the limit; what is smaller lies on the edge


def ratios(case):
    for fidelity in ["fine", "coarse"]:
        path = age.ROOT / f"validation/results/{fidelity}/{case}-checks.csv"
        if path.exists():
            with path.open(encoding="utf-8") as file:
                rows = [r for r in csv.DictReader(file) if "residual" not in r["figure"]]
            return fidelity, [float(r["value"]) / float(r["limit"]) for r in rows if float(r["limit"])]
    return "none", []


def place(ratio):
    decades = math.log10(max(ratio, 10.0**-DECADES))
    return RIGHT + (RIGHT - LEFT) * min(decades, 0.1) / DECADES


def picture(cases):
    rows = [(case, *ratios(case)) for case in cases]
    height = TOP + ROW * len(rows) + 34
    count = sum(len(r[2]) for r in rows)
    over = sum(r > 1 for row in rows for r in row[2])
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="830" height="{height}" viewBox="0 0 830 {height}" '
        'font-family="sans-serif" font-size="13">',
        f'<rect width="830" height="{height}" fill="white"/>',
        f'<text x="20" y="24" font-size="15">{count} figures of {len(rows)} cases, each over the limit that '
        f"it has to keep; {over or 'none'} over it</text>",
    ]
    bottom = TOP + ROW * len(rows)
    for k in range(DECADES + 1):
        x = RIGHT - (RIGHT - LEFT) * k / DECADES
        label = "limit" if k == 0 else f"1/{10**k}"
        colour = "#b00020" if k == 0 else "#cccccc"
        out.append(f'<line x1="{x:.1f}" y1="{TOP - 8}" x2="{x:.1f}" y2="{bottom}" stroke="{colour}"/>')
        out.append(f'<text x="{x:.1f}" y="{TOP - 14}" text-anchor="middle" fill="#555">{label}</text>')
    for number, (case, fidelity, values) in enumerate(rows):
        y = TOP + ROW * (number + 0.5)
        name = case if fidelity == "fine" else f"{case} (coarse)"
        out.append(f'<text x="{LEFT - 12}" y="{y + 4:.1f}" text-anchor="end">{name}</text>')
        out.append(f'<line x1="{LEFT}" y1="{y:.1f}" x2="{RIGHT}" y2="{y:.1f}" stroke="#eeeeee"/>')
        for value in values:
            fill = "#b00020" if value > 1 else "#1f5fa8"
            x = place(value)
            out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{fill}" fill-opacity="0.45"/>')
    note = f"Logarithmic; what is under 1/{10**DECADES} of its limit is at the left edge."
    out.append(f'<text x="20" y="{bottom + 24}" fill="#555">{note}</text></svg>')
    return "\n".join(out) + "\n"


def main():
    wanted = picture([case for case, _ in age.cases()])
    if sys.argv[1:] == ["--check"]:
        if not TARGET.exists() or TARGET.read_text(encoding="utf-8") != wanted:
            print(f"{TARGET.relative_to(age.ROOT)} is old: python3 book/tools/overview.py")
            return 1
        return 0
    TARGET.write_text(wanted, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
