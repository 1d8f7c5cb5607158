#!/usr/bin/env bash
# system: the real program from outside, with independent clients.
#   tests/system/run.sh PROGRAM [NAME...]     NAME: part of a test's name
# In: the built program. Out: one line per test, then "N passed, N failed". Uses Debian's Python, whatever else is installed.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
exec /usr/bin/python3 "$here/main.py" "$@"
