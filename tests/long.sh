#!/usr/bin/env bash
# The long tests: rates on five levels up to 250,000 vertices, a thousand random problems for each invariance, files with
# every number of threads. After `tests/all.sh`, which makes what they need. Random problems come from a new seed in every
# run; it is printed, and `PROPTEST_RNG_SEED=... bash tests/long.sh` repeats it.
set -euo pipefail
cd "$(dirname "$0")/.."
export PATH="$PWD/target/venv/bin:$PATH"
cargo test --features osqp --test it -- --ignored "$@"
