#!/usr/bin/env bash
# What the crate is made of: licences, sources and doubles of its dependencies, and the Rust that it needs at least.
# Each check has a negative test that must fail. `cargo deny` comes from crates.io into target/tools on the first run.
# Vulnerabilities need the network beyond crates.io, so they are for whoever has it: `cargo deny check advisories`.
set -euo pipefail
cd "$(dirname "$0")/.."

version=0.20.2
tools=$PWD/target/tools
export PATH="$tools/bin:$PATH"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() { echo "error: $1" >&2; exit 1; }

# Licences, sources, doubles: deny.toml has the list. An exception that is needed no more is an error, too.
[ "$(cargo deny --version 2>/dev/null)" = "cargo-deny $version" ] ||
    CARGO_TARGET_DIR=$tools/build cargo install --quiet --locked --root "$tools" "cargo-deny@$version"
deny() { cargo deny --log-level "$1" --config "$2" check -D unmatched-skip -D unnecessary-skip "${@:3}"; }
deny warn deny.toml licenses bans sources
sed '/"Zlib"/s/, "Zlib"//; /syn@2/d' deny.toml > "$scratch/strict.toml"
for check in licenses bans; do
    ! deny off "$scratch/strict.toml" $check 2> /dev/null || fail "the check of $check finds nothing"
done

# No dependency asks for a later Rust than this crate says.
needing_later() {
    cargo metadata --locked --all-features --format-version 1 | python3 -c '
import json, sys
number = lambda version: tuple(map(int, (version.split(".") + ["0"])[:2]))
packages = json.load(sys.stdin)["packages"]
stated = sys.argv[1] or next(p["rust_version"] for p in packages if p["name"] == "membrane-contact")
for package in packages:
    if package["rust_version"] and number(package["rust_version"]) > number(stated):
        print(package["name"], package["version"], "needs Rust", package["rust_version"])' "$1"
}
later=$(needing_later "")
[ -z "$later" ] || fail "$later"
[ -n "$(needing_later 1.70)" ] || fail "the check of the Rust that dependencies need finds nothing"

# Nor does the crate itself: clippy knows since when the standard library has what. One release earlier lacks some of it.
cargo clippy --quiet --lib -- -D clippy::incompatible_msrv
echo 'msrv = "1.87.0"' > "$scratch/clippy.toml"
! CLIPPY_CONF_DIR=$scratch cargo clippy --quiet --lib -- -D clippy::incompatible_msrv 2> /dev/null ||
    fail "the check of the Rust that this crate needs finds nothing"
