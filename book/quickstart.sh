#!/usr/bin/env bash
# The commands of the quick start, in order, for a fresh clone. Made from book/src/quick-start.md by
# book/tools/quickstart.py; change them there.
set -euo pipefail
cd "$(dirname "$0")/.."
