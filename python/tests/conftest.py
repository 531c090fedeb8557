"""What all tests share: a mesh, a pair, and the program to compare with."""

from __future__ import annotations

import os

import pytest

# Before anyone imports matplotlib: no windows.
os.environ["MPLBACKEND"] = "Agg"

import membrane_contact as mc
from helpers import PAIR, Program, find_program


@pytest.fixture(scope="session")
def mesh() -> mc.Mesh:
    """The unit square in 8 by 8 cells: 81 vertices, 128 triangles."""
    return mc.Mesh.rectangle(8)


@pytest.fixture(scope="session")
def solution(mesh: mc.Mesh) -> mc.Solution:
    """The pair of the README on it."""
    return mc.solve(mesh, **PAIR)


@pytest.fixture(scope="session")
def program(tmp_path_factory: pytest.TempPathFactory) -> Program:
    """The program: that of the variable MEMBRANES, else the one that cargo has built, else the one in this package."""
    return Program(find_program(), tmp_path_factory.mktemp("membranes"))
