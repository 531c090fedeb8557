#!/usr/bin/env bash
# Runs every fuzzer for the given number of seconds (default 60), or those that are named after it. What they find to be new
# goes to fuzz/corpus, what breaks to fuzz/artifacts: mend it, and keep the input under tests/hostile/corpus.
set -euo pipefail
cd "$(dirname "$0")"

seconds=${1:-60}
fuzzers=("${@:2}")
[ ${#fuzzers[@]} -gt 0 ] || mapfile -t fuzzers < <(cargo fuzz list)
# Without sanitizers the stable toolchain does: the sources hold no unsafe code.
cargo fuzz build -s none
for fuzzer in "${fuzzers[@]}"; do
    mkdir -p "corpus/$fuzzer"
    corpora=("corpus/$fuzzer" "../tests/hostile/corpus/$fuzzer")
    [ "$fuzzer" != gmsh ] || corpora+=(../tests/data/gmsh)
    options=(-max_total_time="$seconds" -timeout=5 -rss_limit_mb=2048 -max_len=8192 -print_final_stats=1)
    [ ! -f "dictionaries/$fuzzer.dict" ] || options+=(-dict="dictionaries/$fuzzer.dict")
    echo "== $fuzzer"
    cargo fuzz run -s none "$fuzzer" "${corpora[@]}" -- "${options[@]}" 2>&1 | tail -n 12
done
