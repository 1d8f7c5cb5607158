#!/usr/bin/env bash
# fuzz: runs every libFuzzer program of a build for a few seconds.
#   tests/fuzz/run.sh BUILD_DIR [NAME...]      NAME: part of a target's name
# In: BUILD_DIR/fuzz_*, seeds from tests/fuzz/seeds/<name> and adapters/*/fuzz/seeds/<name>, where <name> is the target without "fuzz_", and
# those that seeds.py makes of the makers' examples and of the API's description.
# Out: one line per target, then "N passed, N failed". What breaks a target is printed as base64: decode it into a file and give the file
# to the program to see it again. Each run starts from another seed, which it prints: FUZZ_SEED gives it again, on a quiet machine with the
# same result. FUZZ_SECONDS (6) and FUZZ_JOBS (2) change how long and how many at once. What a run found is kept where FUZZ_CORPUS says (a
# folder; a temporary one without it), so that the next can go on from there.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=${1:?usage: tests/fuzz/run.sh BUILD_DIR [NAME...]}
shift
seconds=${FUZZ_SECONDS:-6} seed=${FUZZ_SEED:-$(( $(od -An -N4 -tu4 /dev/urandom) % 2147483647 + 1 ))} jobs=${FUZZ_JOBS:-2}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "FUZZ_SEED=$seed"
python3 "$here/seeds.py" "$work/made"

one() {
    local program=$1 name log begun=$SECONDS status=0 folder f
    name=$(basename "$program")
    log=$work/$name.log
    local corpus=${FUZZ_CORPUS:-$work/corpora}/$name
    mkdir -p "$work/$name" "$corpus"
    for folder in "$here/seeds/${name#fuzz_}" "$here"/../../adapters/*/fuzz/seeds/"${name#fuzz_}" "$work/made/${name#fuzz_}"; do
        if [ -d "$folder" ]; then cp "$folder"/* "$corpus/"; fi
    done
    # 64 KiB is more than a door or a line takes at once; -timeout is for one input.
    timeout $((seconds + 60)) "$program" -max_total_time="$seconds" -seed="$seed" -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=256 -max_len=65536 \
        -print_final_stats=1 -artifact_prefix="$work/$name/" "$corpus" >"$log" 2>&1 || status=$?
    local runs cover
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -n 1)
    cover=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
    if [ "$status" = 0 ] && [ "${runs:-0}" -gt 0 ]; then
        echo "pass: $name (${runs} inputs, ${cover:-0} edges, $((SECONDS - begun)) s)"
        touch "$work/$name.passed"
    else
        echo "FAIL: $name (code $status, ${runs:-0} inputs, FUZZ_SEED=$seed)"
        grep -vE '^#[0-9]+' "$log" | tail -n 60 | cut -c1-400
        for f in "$work/$name"/crash-* "$work/$name"/timeout-* "$work/$name"/oom-* "$work/$name"/leak-*; do
            if [ -f "$f" ]; then echo "input ($(basename "$f"), base64): $(base64 -w0 "$f" | head -c 20000)"; fi
        done
        touch "$work/$name.failed"
    fi
}

for program in "$build"/fuzz_*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    if [ $# -gt 0 ]; then
        wanted=no
        for part in "$@"; do case $program in *"$part"*) wanted=yes ;; esac; done
        [ $wanted = yes ] || continue
    fi
    while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n || true; done
    one "$program" &
done
wait
passed=$(find "$work" -maxdepth 1 -name '*.passed' | wc -l)
failed=$(find "$work" -maxdepth 1 -name '*.failed' | wc -l)
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
