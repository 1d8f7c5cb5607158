#!/bin/bash
# Runs inside the emulated machine: gateway and twin on a real vcan interface, candump as witness.
# In: the program. Out: one line per check, "pass: ..." or "FAIL: ...". Never touches a network but this guest's own.
program=$1
export PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/dev/shm TMPDIR=/dev/shm
cd /dev/shm || exit 1   # the guest's own memory: all else belongs to the machine outside and can only be read
ip link set lo up
api=http://127.0.0.1:8080/api/v1

check() { # TEXT CONDITION...
    local text=$1; shift
    if "$@"; then echo "pass: $text"; else echo "FAIL: $text"; fi
}
# until SECONDS COMMAND...: true as soon as the command is
until_true() {
    local end=$((SECONDS + $1)); shift
    while ! "$@"; do [ $SECONDS -lt $end ] || return 1; sleep 0.2; done
}
field() { curl -s -m 10 "$api/$1" | jq -r "$2"; }
is() { [ "$(field "$1" "$2")" = "$3" ]; }
command() { curl -s -m 60 -H 'Content-Type: application/json' -d "$2" "$api/axes/$1/commands?wait=40" | jq -r .result; }
result_is() { local r; r=$(command "$1" "$2"); [ "$r" = "$3" ] || { echo "info: $2 -> $r"; false; }; }
captured() { grep -q "$1" candump.log; }

check "vcan0 can be made" ip link add dev vcan0 type vcan
ip link set vcan0 up
stdbuf -oL candump -L vcan0 >candump.log 2>/dev/null &
witness=$!

"$program" twin uim342 --line can:vcan0 --address 5 --address 6 >twin.log 2>&1 &
twin=$!
check "the twin is ready on the bus" until_true 60 grep -q '^ready ' twin.log

cat >site.json <<'SITE'
{"lines": [{"name": "can0", "uri": "can:vcan0", "family": "uim342", "bitrate": 1000000}],
 "drives": [{"name": "left", "line": "can0", "address": 5, "presence": "device"}, {"name": "right", "line": "can0", "address": 6, "presence": "auto"}],
 "axes": [{"name": "left", "drive": "left", "number": 1, "unit": "mm", "increments_per_unit": 3200},
          {"name": "right", "drive": "right", "number": 2, "unit": "mm", "increments_per_unit": 3200}], "mappings": []}
SITE
"$program" serve --data /dev/shm/data --site site.json >gateway.log 2>gateway.err &
gateway=$!
check "the gateway is ready" until_true 90 grep -q '^ready ' gateway.log
check "the left drive answers over SocketCAN" until_true 30 is axes/left .online true
check "and is not called simulated: for the gateway this is a real drive" is axes/left .simulated false
check "the right drive answers too" until_true 30 eval 'is axes/right .online true && is axes/right .simulated false'
check "enable" result_is left '{"command":"enable"}' done
check "move to 2 mm ends there" result_is left '{"command":"move_absolute","position":2,"velocity":5,"acceleration":50,"deceleration":50}' done
check "position is 6400 increments" is axes/left .position_increments 6400
check "the witness saw the move command of node 5" captured '042800A0#00190000'
check "the witness saw BG" captured '04280096#'
check "the witness saw the acknowledgement of BG from node 5" captured '05200016#00000000'

check "interface down: the line is down" eval 'ip link set vcan0 down; until_true 20 is lines/can0 .status.state down'
check "the axis is stale" until_true 20 is axes/left .stale true
check "interface up again: everything heals" eval 'ip link set vcan0 up; until_true 40 is axes/left .stale false'
check "and moves" result_is left '{"command":"move_relative","position":-1,"velocity":5}' done

kill $twin; wait $twin 2>/dev/null
check "without the drive: left is offline" until_true 30 is axes/left .online false
check "without the drive: the twin serves right, and says so" until_true 30 is axes/right .simulated true
"$program" twin uim342 --line can:vcan0 --address 5 --address 6 >twin2.log 2>&1 &
twin=$!
check "the drive is back: left heals by itself" until_true 60 is axes/left .online true
check "the drive is back: right is handed back at rest" until_true 60 is axes/right .simulated false

ip link del vcan0
check "interface gone: the line is down" until_true 20 is lines/can0 .status.state down
ip link add dev vcan0 type vcan && ip link set vcan0 up
check "interface back: the line is up again" until_true 40 is lines/can0 .status.state up

kill $gateway
check "the gateway ends when asked" until_true 20 eval '! kill -0 $gateway 2>/dev/null'
kill $twin $witness 2>/dev/null

# --- CANopen on a bus of its own: an independent client against the simulated drive, the gateway against an independent server
here=$(dirname "$0")
ip link add dev vcan1 type vcan && ip link set vcan1 up
"$program" twin cia402 --line can:vcan1 --address 9 >servo.log 2>&1 &
servo=$!
check "the simulated CiA 402 drive is ready on the bus" until_true 60 grep -q '^ready ' servo.log
timeout 120 /usr/bin/python3 "$here/canopen_client.py" vcan1 9 2>client.err || { echo "FAIL: python-can: the client came to its end"; while read -r line; do echo "info: $line"; done <client.err; }
kill $servo; wait $servo 2>/dev/null
/usr/bin/python3 "$here/canopen_server.py" vcan1 20 >server.log 2>server.err &
server=$!
check "a drive of another make is on the bus" until_true 60 grep -q '^ready' server.log
cat >site2.json <<'SITE'
{"lines": [{"name": "can1", "uri": "can:vcan1", "family": "cia402", "bitrate": 1000000}],
 "drives": [{"name": "other", "line": "can1", "address": 20, "presence": "device"}], "axes": [{"name": "other", "drive": "other", "number": 1}], "mappings": []}
SITE
"$program" serve --data /dev/shm/data2 --site site2.json >gateway2.log 2>gateway2.err &
gateway=$!
check "the gateway is ready on the second bus" until_true 90 grep -q '^ready ' gateway2.log
check "it finds the drive and sets it up" until_true 30 is axes/other .online true
check "its PDOs are heard: position" until_true 20 is axes/other .position_increments -4711
check "its state is switch on disabled" is axes/other .state switch_on_disabled
check "its name is read by segments" is 'axes/other/parameters/1008h' .value 'a drive of another make, by its long name'
check "a parameter is written" eval '[ "$(curl -s -m 10 -X PUT -H "Content-Type: application/json" -d "{\"value\":4000}" $api/axes/other/parameters/6081h | jq -r .value)" = 4000 ]'
check "and is there" is 'axes/other/parameters/6081h' .value 4000
kill $server; wait $server 2>/dev/null
check "without the drive: offline" until_true 30 is axes/other .online false
kill $gateway
check "the second gateway ends when asked" until_true 20 eval '! kill -0 $gateway 2>/dev/null'

# --- judges: a master and drives that were written from the standards alone, on buses of their own; one after the other, because each process costs
# seconds here
judges=$here/../clients/judges
ip link add dev vcan2 type vcan && ip link set vcan2 up
specimens=(slow sparse strict) pids=() named=()
for i in "${!specimens[@]}"; do
    "$program" twin cia402 --line can:vcan2 --address $((i + 1)) --specimen "${specimens[i]}" >specimen$i.log 2>&1 &
    pids+=($!)
    named+=("$((i + 1))=specimen ${specimens[i]}")
done
for i in "${!specimens[@]}"; do check "specimen ${specimens[i]} is on the bus" until_true 60 grep -q '^ready ' specimen$i.log; done
timeout 150 /usr/bin/python3 "$judges/canopen_master.py" vcan2 "${named[@]}" 2>master.err || echo "FAIL: the master came to its end: $(tail -n 1 master.err)"
kill "${pids[@]}"

ip link add dev vcan3 type vcan && ip link set vcan3 up
drives=("--mode-shown-ms 200 --sample-ms 4 --acknowledge-ms 300 --sdo-ms 70" "--pdo preop" "--pdo none --missing 6062,606C,6502,605A,1016,60C2")
lines='' axes=''
for i in "${!drives[@]}"; do
    lines+="${lines:+,}{\"name\": \"d$i\", \"line\": \"can3\", \"address\": $((i + 11)), \"presence\": \"device\"}"
    axes+="${axes:+,}{\"name\": \"d$i\", \"drive\": \"d$i\", \"number\": $((i + 1))}"
done
echo "{\"lines\": [{\"name\": \"can3\", \"uri\": \"can:vcan3\", \"family\": \"cia402\", \"bitrate\": 1000000, \"timing\": {\"reply_timeout_ms\": 3000}}], \"drives\": [$lines], \"axes\": [$axes], \"mappings\": []}" >site3.json
"$program" serve --data /dev/shm/data3 --site site3.json >gateway3.log 2>gateway3.err &
gateway=$!
check "the gateway is ready on the bus of the judges" until_true 90 grep -q '^ready ' gateway3.log
for i in "${!drives[@]}"; do
    # shellcheck disable=SC2086
    /usr/bin/python3 "$judges/canopen_drive.py" vcan3 $((i + 11)) ${drives[i]} >drive$i.log 2>drive$i.err &
    drive=$!
    check "drive ${drives[i]} is on the bus" until_true 60 grep -q '^ready' drive$i.log
    check "drive ${drives[i]}: found" until_true 40 is axes/d$i .online true
    check "drive ${drives[i]}: enabled" result_is d$i '{"command":"enable"}' done
    check "drive ${drives[i]}: moved" result_is d$i '{"command":"move_absolute","position":3000,"velocity":6000,"acceleration":50000,"deceleration":50000}' done
    check "drive ${drives[i]}: its place is shown" until_true 10 is axes/d$i .position_increments 3000
    check "drive ${drives[i]}: disabled" result_is d$i '{"command":"disable"}' done
    kill $drive
done
kill $gateway
check "the third gateway ends when asked" until_true 20 eval '! kill -0 $gateway 2>/dev/null'
while read -r line; do echo "info: $line"; done < <(tail -n 5 gateway3.err)
while read -r line; do echo "info: $line"; done < <(tail -n 5 gateway2.err)
while read -r line; do echo "info: $line"; done < <(tail -n 5 gateway.err)
