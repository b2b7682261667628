#!/usr/bin/env bash
# Builds the Python package in a virtual environment of its own, and tests it: pytest, with the
# notebooks, and mypy. Needs Rust and Python 3.11 or newer.
#
#     scripts/python_test.sh [ARGUMENTS OF PYTEST]
set -euo pipefail
cd "$(dirname "$0")/.."
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}"
venv="$CARGO_TARGET_DIR/python"
python3 -m venv --clear "$venv"
"$venv/bin/pip" install --quiet --disable-pip-version-check "maturin>=1.7,<2"
# As a user would install it, but unoptimised as tests are: fat LTO would take minutes.
PATH="$venv/bin:$PATH" MATURIN_PEP517_ARGS="--profile dev --locked" \
    "$venv/bin/pip" install --quiet --disable-pip-version-check --no-build-isolation \
    "./crates/moldwarp-py[test]"
cargo build --quiet --locked -p moldwarp-cli
cd crates/moldwarp-py
"$venv/bin/mypy" --strict --config-file pyproject.toml python/moldwarp tests measure.py
MOLDWARP_COMMAND="$CARGO_TARGET_DIR/debug/moldwarp" "$venv/bin/python" -m pytest -q "$@"
