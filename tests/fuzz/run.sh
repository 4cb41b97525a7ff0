#!/usr/bin/env bash
# Builds the fuzzers and runs each for SECONDS (default 60), or COUNTx: so many executions; with NAMES
# only those (gltf solve ...).
#
#     tests/fuzz/run.sh 1000000x pcd xyz
#
# What they learn stays in build/dev/fuzz/corpus, findings in build/dev/fuzz/findings. Exit 1 on a finding.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

if [[ ${1:-60} == *x ]]; then
    limit=-runs=${1%x}
else
    limit=-max_total_time=${1:-60}
fi
shift || true
names=("$@")
if [ ${#names[@]} = 0 ]; then
    for source in tests/fuzz/*_fuzz.cpp; do
        name=$(basename "$source" _fuzz.cpp)
        names+=("$name")
    done
fi

cmake --preset dev >/dev/null
cmake --build build/dev --target fuzz | tail -n 1
./build/dev/bin/fuzz_seeds build/dev/fuzz/seeds

mkdir -p build/dev/fuzz/findings

# freed blocks that wait for a second use of theirs: the 256 MB of the default are fresh pages in each
# execution, half of its time
export ASAN_OPTIONS=quarantine_size_mb=4

# one reader or engine; its line tells what came of it
fuzz() {
    local name=$1
    local corpus=build/dev/fuzz/corpus/$name log=build/dev/fuzz/$name.log
    mkdir -p "$corpus" "build/dev/fuzz/seeds/$name"
    # short files reach as much, and what long ones cost files_test asks (hostile_files_test.cpp);
    # weights for rare features (entropic) take longer than a reader does
    local options=("$limit" -timeout=10 -rss_limit_mb=4096 -max_len=4096 -entropic=0
        -artifact_prefix="build/dev/fuzz/findings/$name-" -print_final_stats=1)
    if [ -f "tests/fuzz/$name.dict" ]; then
        options+=(-dict="tests/fuzz/$name.dict")
    fi
    if ./build/dev/bin/fuzz_"$name" "${options[@]}" "$corpus" "build/dev/fuzz/seeds/$name" \
        >"$log" 2>&1; then
        echo "$name: $(grep -o 'number_of_executed_units: [0-9]*' "$log" | grep -o '[0-9]*') runs, no findings"
    else
        echo "$name: finding, see $log" >&2
        tail -n 30 "$log" >&2
        return 1
    fi
}
export -f fuzz
export limit
printf '%s\n' "${names[@]}" | xargs -P "$(nproc)" -I{} bash -c 'set -euo pipefail; fuzz {}'
