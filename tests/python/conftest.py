"""Fixtures: the program under test, found through the environment variable MEMBRANES, and the cases."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from case_file import CASES
from program import Program


@pytest.fixture(scope="session")
def program(tmp_path_factory: pytest.TempPathFactory) -> Program:
    """The program under test; without it the tests fail, because a skipped check proves nothing."""
    executable = Path(os.environ.get("MEMBRANES", ""))
    if not (executable.is_absolute() and os.access(executable, os.X_OK) and executable.is_file()):
        pytest.fail(
            "the environment variable MEMBRANES has to hold the absolute path of the program: "
            'cargo build && MEMBRANES="$PWD/target/debug/membranes" python -m pytest tests/python',
            pytrace=False,
        )
    return Program(executable, tmp_path_factory.mktemp("membranes"))


@pytest.fixture(scope="session", params=CASES, ids=lambda case: case.stem)
def case(request: pytest.FixtureRequest) -> Path:
    """Each case file in turn."""
    return request.param
