#!/usr/bin/env bash
# The commands of the quick start, in order, for a fresh clone. Made from book/src/quick-start.md by
# book/tools/quickstart.py; change them there.
set -euo pipefail
cd "$(dirname "$0")/.."

# The first run
cargo run --release -- run examples/absorbing-column

# The first picture
python3 -m venv out/python
out/python/bin/pip install pyvista
out/python/bin/python scripts/render.py out/absorbing-column --field displacement --component z \
    --time 0.4 --output out/first-picture.png

# What to open in ParaView
out/python/bin/python scripts/check_vtu.py out/absorbing-column/particles.pvd out/absorbing-column/mesh.pvd

# The three bottoms
cargo run --release -- run examples/absorbing-column/dashpot.toml
cargo run --release -- run examples/absorbing-column/rigid.toml

# Change something
cargo run --release -- run examples/absorbing-column --out out/stiff \
    --set boundaries.1.virtual_thickness="0.1 m"
cargo run --release -- check examples/absorbing-column
cargo run --release -- new absorbing-column my-case
cargo run --release -- run my-case
