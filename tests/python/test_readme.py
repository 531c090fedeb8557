"""The Python code of the README does what it says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from program import Program

ROOT = Path(__file__).resolve().parents[2]
PLATE = ROOT / "examples" / "plate.toml"


def test_the_readme_loads_an_exported_program(
    program: Program, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = [block.split("```")[0] for block in readme.split("```python\n")[1:]]
    code = next(block for block in blocks if "np.load" in block)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "plate").symlink_to(program.export(PLATE, "npz"))
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    exec(code, names)  # noqa: S102: the README is ours
    qp = program.problem(PLATE).qp
    assert (names["P"] != qp.P).nnz == 0
    assert (names["A"] != qp.A).nnz == 0
    np.testing.assert_array_equal(names["q"], qp.q)
    np.testing.assert_array_equal(names["b"], qp.b)
