#!/usr/bin/env bash
# Runs the paper's four examples cut short, and opens their reports in Chromium: scripts/report_test.sh
# Needs npm, and Chromium or CHROMIUM=PATH; says so and does nothing where one is missing. MOLDWARP=PATH names
# the program; without it, it is built.
set -euo pipefail
cd "$(dirname "$0")/.."
if ! command -v npm >/dev/null; then
    echo "report_test: skipped, there is no npm"
    exit 0
fi
if [ -z "${CHROMIUM:-}" ] && ! command -v chromium >/dev/null && ! command -v chromium-browser >/dev/null \
    && ! command -v google-chrome >/dev/null; then
    echo "report_test: skipped, there is no Chromium"
    exit 0
fi
[ -d viewer/node_modules ] || npm --prefix viewer ci --no-audit --no-fund --loglevel=error

# The committed script is what its sources make.
kept=$(mktemp)
cp crates/moldwarp-io/src/report/viewer.js "$kept"
npm --prefix viewer run --silent build
if ! cmp -s "$kept" crates/moldwarp-io/src/report/viewer.js; then
    echo "report_test: crates/moldwarp-io/src/report/viewer.js was not what viewer/ makes; it is now"
    exit 1
fi

moldwarp=${MOLDWARP:-}
if [ -z "$moldwarp" ]; then
    cargo build --locked -p moldwarp-cli
    moldwarp=${CARGO_TARGET_DIR:-target}/debug/moldwarp
fi
out=$(mktemp -d)
trap 'rm -rf "$out" "$kept"' EXIT
run() {
    "$moldwarp" run "examples/$1" --out "$out/$1" --report "${@:2}" >"$out/$1.log" 2>&1 || {
        cat "$out/$1.log"
        exit 1
    }
}
run absorbing-column --set title="</script><img src=x onerror=alert(1)> & '\"" --set output.frames=8 --set stages.0.duration="0.5 s"
run drop-anchor --set output.frames=4 --set stages.0.duration="8 ms"
run dynamic-probing --set output.frame_interval="4 ms" --set stages.0.duration="8 ms" --set stages.1.duration="4 ms"
run tunnel-face --set output.frame_interval="0.1 s" --set stages.1.duration="0.3 s"
npm --prefix viewer run --silent test -- "$out"/*/
