#!/usr/bin/env python3
"""Makes `book/quickstart.sh` from the quick start's code blocks, so that what a newcomer types is run.

    python3 book/tools/quickstart.py            writes it
    python3 book/tools/quickstart.py --check    ends with code 1 where it is old

Blocks fenced as `bash` are taken as they are, in order; others are not commands for everyone.
"""

import re
import sys
from pathlib import Path

BOOK = Path(__file__).resolve().parent.parent

HEAD = """#!/usr/bin/env bash
# The commands of the quick start, in order, for a fresh clone. Made from book/src/quick-start.md by
# book/tools/quickstart.py; change them there.
set -euo pipefail
cd "$(dirname "$0")/.."
"""


def script(page):
    heading, parts = None, [HEAD]
    for found in re.finditer(r"^## ([^\n]+)$|^```bash\n(.*?)^```$", page, re.MULTILINE | re.DOTALL):
        if found[1]:
            heading = found[1]
            continue
        if heading:
            parts.append(f"\n# {heading}\n")
            heading = None
        parts.append(found[2])
    return "".join(parts)


def main():
    wanted = script((BOOK / "src/quick-start.md").read_text(encoding="utf-8"))
    path = BOOK / "quickstart.sh"
    if sys.argv[1:] == ["--check"]:
        if not path.exists() or path.read_text(encoding="utf-8") != wanted:
            print("book/quickstart.sh is not what the quick start says: python3 book/tools/quickstart.py")
            return 1
        return 0
    path.write_text(wanted, encoding="utf-8")
    path.chmod(0o755)
    return 0


if __name__ == "__main__":
    sys.exit(main())
