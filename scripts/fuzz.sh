#!/usr/bin/env bash
# Fuzzes every reader and the whole job (pipeline) in turn, SECONDS each (default 300), and stops at the first find. TARGET...: only
# these. A reader has ten seconds for an input, the whole job sixty.
# Needs cargo-fuzz (cargo install cargo-fuzz) and a C++ compiler; a stable toolchain does.
# Usage: scripts/fuzz.sh [SECONDS [TARGET...]]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# Coverage of the code that runs is a nightly flag of the compiler.
export RUSTC_BOOTSTRAP=1

seconds=${1:-300}
targets=("${@:2}")
if [ ${#targets[@]} -eq 0 ]; then
    mapfile -t targets < <(cargo fuzz list)
fi
for target in "${targets[@]}"; do
    printf '\n== %s\n' "$target"
    mkdir -p "fuzz/corpus/$target"
    limit=10
    [ "$target" != pipeline ] || limit=60
    # Without sanitizers: all of the code is safe Rust. What memory it takes is counted by the targets.
    cargo fuzz run --sanitizer none "$target" "fuzz/corpus/$target" "fuzz/seeds/$target" -- \
        -max_total_time="$seconds" -rss_limit_mb=1024 -timeout="$limit" -print_final_stats=1
done
printf '\nnothing found\n'
