"""The code of both READMEs runs, and is the same."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def code_of(page: Path) -> str:
    blocks = page.read_text(encoding="utf-8").split("```python\n")[1:]
    return next(block.split("```")[0] for block in blocks if "import membrane_contact" in block)


def test_the_readmes_print_a_force_and_a_bound(capsys: pytest.CaptureFixture[str]) -> None:
    first, second = code_of(ROOT / "README.md"), code_of(ROOT / "python" / "README.md")
    assert second.startswith(first)
    exec(second, {})  # noqa: S102: the README is ours
    assert capsys.readouterr().out == "they push with 7.955 over an area of 0.626\nenergy error at most 0.059\n"
