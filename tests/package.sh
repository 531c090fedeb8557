#!/usr/bin/env bash
# The Python package: checked, installed into an environment of its own as users install it, and tested. Needs what `tests/all.sh` needs;
# the rest goes into target/package.
set -euo pipefail
cd "$(dirname "$0")/.."
export CARGO_TARGET_DIR=$PWD/target CARGO_BUILD_JOBS=2

cargo fmt --check --manifest-path python/Cargo.toml
cargo clippy --manifest-path python/Cargo.toml --all-targets -- -D warnings

venv=$PWD/target/package
requirements=python/tests/requirements.txt
if ! cmp -s "$requirements" "$venv/installed.txt"; then
    rm -rf "$venv"
    python3 -m venv "$venv"
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check -r "$requirements"
    cp "$requirements" "$venv/installed.txt"
fi
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check ./python

cd python
"$venv/bin/python" -m mypy
"$venv/bin/stubtest" --mypy-config-file pyproject.toml --allowlist tests/stubtest_allowed.txt --ignore-unused-allowlist membrane_contact
# What the package computes is compared with the program, to the last bit.
(cd .. && cargo build --quiet --features osqp)
MEMBRANES=$CARGO_TARGET_DIR/debug/membranes "$venv/bin/python" -m pytest -q tests "$@"
