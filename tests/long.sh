#!/usr/bin/env bash
# The long tests: rates on five levels up to 250,000 vertices. After `tests/all.sh`, which makes what they need.
set -euo pipefail
cd "$(dirname "$0")/.."
export PATH="$PWD/target/venv/bin:$PATH"
cargo test --features osqp --test it -- --ignored "$@"
