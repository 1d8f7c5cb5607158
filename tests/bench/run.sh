#!/usr/bin/env bash
# bench: runs every benchmark of a release build, in about a quarter of an hour, of which `tail` takes half. For an idle machine; not a part of the ordinary tests.
#   tests/bench/run.sh BUILD_DIR [NAME...]      NAME: round, specimen, rehearse, recorder, write, tail, mcode, linmot, cia402, cia402_program, program, modbus, modbus_program, modbus_rtu, enip, dds, http, stream, page, scope, overview
# In: BUILD_DIR/bench_* and BUILD_DIR/axisgate; node and Chromium for what a browser shows. Out: per figure the ratio, the limit it is measured against, and both figures; at the end
# "N passed, N failed", where what is beyond its limit has failed.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=${1:?usage: tests/bench/run.sh BUILD_DIR [NAME...]}
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0

find_program() {
    local p
    for p in "$build/$1" "$build/tests/bench/$1"; do
        if [ -x "$p" ]; then echo "$p"; return; fi
    done
    echo "$build/$1"
}
# bench NAME SECONDS COMMAND...: counts the lines that have a limit; a program that ends without them has failed
bench() {
    local name=$1 limit=$2 status=0 kept broken; shift 2
    if [ ${#wanted[@]} -gt 0 ] && ! printf '%s\n' "${wanted[@]}" | grep -qx "$name"; then return; fi
    echo "== $name"
    timeout "$limit" "$@" >"$work/$name.log" 2>"$work/$name.err" || status=$?
    cat "$work/$name.log"
    broken=$(grep -c 'NOT KEPT' "$work/$name.log") || true
    kept=$(grep -cE ' limit [<>]= *[0-9.e+]+ +kept' "$work/$name.log") || true
    if [ "$status" -gt 1 ] || { [ "$status" = 1 ] && [ "$broken" = 0 ]; } || [ $((kept + broken)) = 0 ]; then
        echo "    $name ended with code $status"
        tail -n 20 "$work/$name.err"
        broken=$((broken + 1))
    fi
    passed=$((passed + kept)); failed=$((failed + broken))
}

wanted=("$@")
echo "load of the machine before: $(cut -d' ' -f1-3 /proc/loadavg), processors: $(nproc)"
bench round 60 "$(find_program bench_round)"
bench specimen 300 "$(find_program bench_specimen)"
bench rehearse 300 /usr/bin/python3 "$here/bench_rehearse.py" "$(find_program axisgate)"
bench recorder 120 "$(find_program bench_recorder)"
bench write 60 "$(find_program bench_write)" "$(find_program axisgate)"
bench tail 900 "$(find_program bench_tail)" "$(find_program axisgate)"
bench mcode 20 "$(find_program bench_mcode)"
bench linmot 60 "$(find_program bench_linmot)"
bench cia402 60 "$(find_program bench_cia402)"
bench cia402_program 120 /usr/bin/python3 "$here/bench_cia402_program.py" "$(find_program axisgate)"
bench program 60 /usr/bin/python3 "$here/bench_program.py" "$(find_program axisgate)"
bench modbus_program 120 /usr/bin/python3 "$here/bench_modbus_program.py" "$(find_program axisgate)" "$(find_program bench_modbus)"
bench modbus_rtu 60 /usr/bin/python3 "$here/bench_modbus_rtu.py" "$(find_program axisgate)"
bench enip 120 /usr/bin/python3 "$here/bench_enip_program.py" "$(find_program axisgate)" "$(find_program bench_enip)"
bench dds 150 "$(find_program bench_dds)" "$(find_program axisgate)"
bench modbus 100 "$(find_program bench_modbus)" --seconds 1.5
bench http 60 /usr/bin/python3 "$here/bench_http_program.py" "$(find_program axisgate)" "$(find_program bench_http)"
bench stream 60 /usr/bin/python3 "$here/bench_stream_program.py" "$(find_program axisgate)" "$(find_program bench_stream)"
# What a browser shows. Chromium and the packages of tests/browser must be there; run.sh of that folder installs the latter.
AXISGATE_BIN=$(realpath "$(find_program axisgate)")
export AXISGATE_BIN
bench page 120 node "$here/bench_page.mjs"
bench scope 150 node "$here/bench_scope.mjs"
bench overview 120 node "$here/bench_overview.mjs"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
