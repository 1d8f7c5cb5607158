#!/usr/bin/env bash
# From an empty site to a moving, mapped axis, with curl and jq alone: lines, drive, axis, parameters, snapshot, mapping, recipe, register.
# In: the address of a running gateway (first argument, default http://127.0.0.1:8080), AXISGATE_MODBUS (ADDRESS:PORT, default asked of the
# gateway), AXISGATE_TOKEN if it wants one. Out: what was done, step by step; 0 if the axis stands where the recipe has sent it.
# Never touches a site that is not empty.
set -euo pipefail

base=${1:-http://127.0.0.1:8080}
api=$base/api/v1
say() { printf '\n== %s\n' "$*"; }

# call METHOD PATH [JSON]: the answer on standard output; on a refusal its sentence and the end.
call() {
  local method=$1 path=$2 body=${3-} answer status
  local head=(-H 'Accept: application/json, application/problem+json')
  [ -z "$body" ] || head+=(-H 'Content-Type: application/json' -d "$body")
  [ -z "${AXISGATE_TOKEN-}" ] || head+=(-H "Authorization: Bearer $AXISGATE_TOKEN")
  answer=$(curl -sS --max-time 60 -X "$method" "${head[@]}" -w '\n%{http_code}' "$api$path")
  status=${answer##*$'\n'}
  answer=${answer%$'\n'*}
  if [ "$status" -ge 400 ]; then
    printf '%s %s: %s: %s\n' "$method" "$path" "$status" "$(jq -r '.detail // .' <<<"$answer" 2>/dev/null || printf '%s' "$answer")" >&2
    exit 1
  fi
  printf '%s' "$answer"
}
# has METHOD PATH: whether this gateway has the route.
has() { curl -sS --max-time 10 -X OPTIONS -D - -o /dev/null "$api$2" | tr -d '\r' | grep -qi "^allow:.*$1"; }
# until_true TEXT PATH FILTER: asks again until the jq filter holds, at most 20 s.
until_true() {
  local n
  for n in $(seq 100); do
    if call GET "$2" | jq -e "$3" >/dev/null; then return; fi
    sleep 0.2
  done
  printf '%s: not within 20 s (asked %s times)\n' "$1" "$n" >&2
  exit 1
}

say "Is the site empty?"
call GET /site | jq -e '(.lines + .drives + .axes) | length == 0' >/dev/null || { echo "the site is not empty: start a gateway with a fresh --data folder" >&2; exit 1; }

say "A line, looked over for drives"
call POST /lines '{"name":"can0","uri":"twin","family":"uim342","bitrate":1000000}' | jq -c '{name, family, uri}'
call POST /lines/can0/scan '{"from":5,"to":20,"limit_s":30}' >/dev/null
until_true "the scan" /lines/can0/scan '.state != "running"'
call GET /lines/can0/scan | jq -c '{state, asked, found: [.found[].address]}'

say "A drive (simulated until the real one answers), and its axis in millimetres"
call POST /drives '{"name":"feeder","line":"can0","address":5,"presence":"auto"}' | jq -c '{name, address, family}'
call POST /axes '{"name":"feeder","drive":"feeder","channel":1,"number":1,"unit":"mm","increments_per_unit":3200,"position_min":-10,"position_max":200}' | jq -c '{name, number, unit}'
until_true "the drive answers" /axes/feeder '.online'

say "Parameters, acknowledged by the drive and stored"
for p in AC=640000 DC=640000; do
  call PUT "/axes/feeder/parameters/${p%=*}" "{\"value\":${p#*=}}" | jq -c "{parameter: \"${p%=*}\", result, value}"
done

if has POST /axes/feeder/snapshots; then
  say "A snapshot of all parameters, to compare with later"
  call POST /axes/feeder/snapshots '{"name":"commissioned","comment":"first set-up","from":"device"}' | jq -c '{n, name}'
fi

say "Registers: the position in millimetres as a float at unit 2, address 0; the acceleration behind it"
call POST /mappings '{"unit":2,"address":0,"axis":"feeder","point":"position_units","type":"f32"}' | jq -c '{id, unit, address, point, type}'
call POST /mappings '{"unit":2,"address":2,"axis":"feeder","point":"AC","type":"u32","access":"RW"}' | jq -c '{id, unit, address, point, type}'

say "A recipe: switch on, move there and back, check, switch off"
# shellcheck disable=SC2016 # ${target} is the recipe's own
call PUT /recipes/first-motion '{
  "description": "first motion of the feeder",
  "parameters": {"target": {"type": "number", "default": 25, "min": 0, "max": 200, "unit": "mm"}},
  "steps": [
    {"write_register": {"unit": 2, "address": 2, "type": "u32", "value": 500000}},
    {"enable": {"axis": "feeder"}},
    {"repeat": {"times": 2, "steps": [
      {"command": {"axis": "feeder", "command": "move_absolute", "position": "${target}", "velocity": 60, "acceleration": 300, "deceleration": 300, "wait_s": 30}},
      {"command": {"axis": "feeder", "command": "move_absolute", "position": 0, "velocity": 60, "wait_s": 30}}]}},
    {"command": {"axis": "feeder", "command": "move_absolute", "position": "${target}", "velocity": 60, "wait_s": 30}},
    {"check": {"axis": "feeder", "point": "position", "is": "${target}", "tolerance": 0.05, "text": "at the target"}},
    {"message": "the feeder stands at ${target} mm"}
  ]}' | jq -c '{name, steps: (.steps | length)}'
call POST /recipes/first-motion/run '{"dry_run":true}' | jq -c '{checked: .steps, axes}'
run=$(call POST /recipes/first-motion/run '{"arguments":{"target":40}}' | jq -r .n)
until_true "the end of the run" "/recipes/first-motion/runs/$run" '.state != "running" and .state != "stopping"'
call GET "/recipes/first-motion/runs/$run" | jq -r '.steps[] | "\(.state)\t\(.step)\t\(.pointer)\t\(.text)"'
call GET "/recipes/first-motion/runs/$run" | jq -e '.state == "done"' >/dev/null || { call GET "/recipes/first-motion/runs/$run" | jq -r .text >&2; exit 1; }

say "The axis, as the page sees it"
call GET /axes/feeder | jq -c '{state, position, target_reached, simulated}'
call GET /axes/feeder | jq -e '.position > 39.9 and .position < 40.1' >/dev/null

modbus=${AXISGATE_MODBUS-$(call GET /about | jq -r '[.doors[]? | select(.name == "modbus") | .address][0] // ""')}
if [ -n "$modbus" ] && command -v mbpoll >/dev/null; then
  say "The same, as a PLC sees it: unit 2, address 0, at $modbus"
  mbpoll -m tcp -p "${modbus##*:}" -a 2 -t 4:float -B -0 -r 0 -c 1 -1 -q "${modbus%:*}" | grep '^\[0\]'
fi

say "Switched off. Done."
call POST '/axes/feeder/commands?wait=5' '{"command":"disable"}' | jq -c '{result}'
