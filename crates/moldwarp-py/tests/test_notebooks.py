"""The notebooks run from top to bottom, coarse; what they assert holds."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

NOTEBOOKS = Path(__file__).resolve().parents[1] / "notebooks"

COARSE = {
    "quick-start": 'END = "0.4 s"',
    "tunnel-face": 'COLLAPSE = "0.3 s"',
    "drop-anchor": 'END = "15 ms"',
    "dynamic-probing": 'END = "20 ms"',
    "friction-sweep": "FRICTIONS = np.array([0.0, 0.2, 0.6])\nSLIDE = 0.3  # s",
}
"""What the cell tagged `parameters` of each is replaced by."""


def test_each_notebook_is_executed() -> None:
    assert {path.stem for path in NOTEBOOKS.glob("*.ipynb")} == set(COARSE)


def test_the_code_of_notebooks_has_right_types(tmp_path: Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    api = pytest.importorskip("mypy.api")
    for path in NOTEBOOKS.glob("*.ipynb"):
        cells = nbformat.read(path, as_version=4).cells
        code = "\n\n".join(cell.source for cell in cells if cell.cell_type == "code")
        (tmp_path / f"{path.stem.replace('-', '_')}.py").write_text(code + "\n", encoding="utf-8")
    config = NOTEBOOKS.parent / "pyproject.toml"
    said, _, failed = api.run(["--strict", "--config-file", str(config), str(tmp_path)])
    assert not failed, said


@pytest.mark.parametrize("name", COARSE)
def test_notebook(name: str) -> None:
    nbclient = pytest.importorskip("nbclient")
    import nbformat

    os.environ.setdefault("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    for cell in notebook.cells:
        assert not cell.get("outputs"), f"{name}.ipynb is kept without outputs"
        if "parameters" in cell.metadata.get("tags", []):
            cell.source = COARSE[name]
    client = nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(NOTEBOOKS)}})
    client.execute()
    for page in NOTEBOOKS.glob("*.html"):
        page.unlink()
    pictures = [o for cell in notebook.cells for o in cell.get("outputs", []) if "image/png" in o.get("data", {})]
    assert pictures
    kept = os.environ.get("MOLDWARP_PICTURES")
    if kept:
        # To be looked at.
        import base64

        for number, output in enumerate(pictures):
            path = Path(kept) / f"{name}-{number}.png"
            path.write_bytes(base64.b64decode(output["data"]["image/png"]))
