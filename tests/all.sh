#!/usr/bin/env bash
# Runs ALL tests: Rust (OSQP included), documentation, and the independent check in Python.
# Needs a Rust toolchain, a C compiler, Python 3 with venv, git. What else is needed (CMake, qpsolvers, ...) goes into a
# virtual environment under target/, made here on the first run and again when the requirements change.
set -euo pipefail
cd "$(dirname "$0")/.."

venv=$PWD/target/venv
requirements=tests/python/requirements.txt
if ! cmp -s "$requirements" "$venv/installed.txt"; then
    rm -rf "$venv"
    python3 -m venv "$venv" || { echo "error: python3 -m venv failed: install Python 3 with its venv module" >&2; exit 1; }
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check -r "$requirements"
    cp "$requirements" "$venv/installed.txt"
fi
export PATH="$venv/bin:$PATH"

cargo test --features osqp "$@"
MEMBRANES=$PWD/target/debug/membranes python -m pytest -q tests/python
