#!/usr/bin/env bash
# clients: EtherNet/IP and Modbus clients of others against the real program, each in a network namespace of its own, because both need UDP 2222.
#   tests/clients/run.sh PROGRAM
# In: the built program, node, the packages of package-lock.json; the right to make network namespaces (root, or user namespaces).
# Out: a line per test, then "N passed, N failed". Never touches the machine's own network.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$(realpath "${1:?usage: tests/clients/run.sh PROGRAM}")
if [ "${2:-}" != inside ]; then
    if [ ! -e "$here/node_modules/.package-lock.json" ] || [ "$here/package-lock.json" -nt "$here/node_modules/.package-lock.json" ]; then
        (cd "$here" && npm ci --silent --ignore-scripts --omit=optional --no-fund --no-audit)
    fi
    alone=(unshare --net --mount); [ "$(id -u)" = 0 ] || alone=(unshare --user --map-root-user --net --mount)
    exec "${alone[@]}" "${BASH_SOURCE[0]}" "$program" inside
fi

# Here is the gateway's network; the clients' one belongs to a process that waits.
unshare --net sleep infinity &
other=$!
work=$(mktemp -d)
gateway=
dump=
trap '[ -z "$dump" ] || kill "$dump" 2>/dev/null || true; [ -z "$gateway" ] || kill "$gateway" 2>/dev/null || true; kill "$other" 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$work"' EXIT
until [ "$(readlink "/proc/$other/ns/net")" != "$(readlink /proc/self/ns/net)" ]; do sleep 0.01; done
there=(nsenter --net="/proc/$other/ns/net")
ip link set lo up
ip link add gateway type veth peer name scanner netns "$other"
ip addr add 192.0.2.1/24 dev gateway
ip link set gateway up
"${there[@]}" ip link set lo up
"${there[@]}" ip addr add 192.0.2.2/24 dev scanner
"${there[@]}" ip link set scanner up

"$program" serve --data "$work/data" --site "$here/site.json" --set http.bind=127.0.0.1:0 --set modbus.bind=192.0.2.1:1502 \
    --set enip.bind=192.0.2.1:44818 >"$work/out" 2>"$work/log" &
gateway=$!
for _ in $(seq 300); do grep -q '^ready' "$work/out" && break; kill -0 "$gateway" || break; sleep 0.1; done
grep -q '^ready' "$work/out" || { tail -n 30 "$work/log"; echo "the program did not begin"; echo "0 passed, 1 failed"; exit 1; }

# What passes is kept, and read by tshark at the end.
dumpcap -q -i gateway -B 64 -w "$work/clients.pcapng" -f "port 44818 or port 2222" 2>"$work/dumpcap" &
dump=$!
for _ in $(seq 100); do grep -q '^File:' "$work/dumpcap" && break; sleep 0.1; done

status=0
# The scanner's package never ends its timers: the runner ends when its tests have.
DEVICE=192.0.2.1 LOCAL=192.0.2.2 "${there[@]}" node --test --test-force-exit --test-concurrency=1 --test-timeout=60000 --test-reporter=tap "$here"/*.test.mjs >"$work/tap" || status=$?
grep -vE '^ *(---|\.\.\.|duration_ms|type:|TAP version)' "$work/tap" | grep -v '^ *$' || true
[ "$status" = 0 ] || tail -n 30 "$work/log"
count() { sed -n "s/^# $1 //p" "$work/tap" | tail -n 1; }
good=$(count pass) bad=$(count fail) ended=$(count cancelled)
bad=$((${bad:-1} + ${ended:-0}))
if [ "$status" != 0 ] && [ "$bad" = 0 ]; then bad=1; fi
sleep 0.5  # what is on its way to dumpcap
kill "$dump"; wait "$dump" || true
if /usr/bin/python3 "$here/../system/captures.py" "$work/clients.pcapng" 44818 2222; then
    echo "ok - tshark knows every frame of it"
    good=$((${good:-0} + 1))
else
    echo "not ok - tshark knows every frame of it"
    bad=$((bad + 1))
fi
echo "${good:-0} passed, $bad failed"
[ "$bad" = 0 ] && [ "${good:-0}" -gt 0 ]
