#!/bin/sh
# Browser tests: the page of the real program in Debian's Chromium without a window.
# In: AXISGATE_BIN (default build/release/axisgate), CHROMIUM (default /usr/bin/chromium-headless-shell), AXISGATE_BROWSER_PROCESSES (default 3).
# AXISGATE_PICTURES=1: pictures under build/browser, of each part in each language at three widths, light and dark, and of what tests come to. Out: counts.
# Arguments are test files; without any, all of them run.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
bin=${AXISGATE_BIN:-$root/build/release/axisgate}
chromium=${CHROMIUM:-/usr/bin/chromium-headless-shell}
[ -x "$bin" ] || { echo "browser: there is no program $bin; build it, or name it by AXISGATE_BIN" >&2; exit 2; }
[ -x "$chromium" ] || { echo "browser: there is no $chromium; apt-get install chromium-headless-shell, or name another by CHROMIUM" >&2; exit 2; }
case "$bin" in /*) ;; *) bin="$PWD/$bin" ;; esac
cd "$here"
# Installed anew only when the lock file is newer than what is there.
if [ ! -e node_modules/.package-lock.json ] || [ package-lock.json -nt node_modules/.package-lock.json ]; then
  npm ci --silent --no-fund --no-audit
fi
# Each wait of a test has a limit of its own and says what did not come; the limit here, which node applies to a whole file, too, is for one that hangs.
# Some files at a time: what a test waits for, another one uses: on two processors one file alone needs a third of its time.
export AXISGATE_BIN="$bin" CHROMIUM="$chromium"
if [ $# -eq 0 ]; then
  set -- ./*.test.mjs
  # A page that draws nothing would be waited for by every test.
  if ! node ./lib/draws.mjs; then echo "browser: 1 tests, 0 passed, 1 failed"; exit 1; fi
fi
exec node --test --test-concurrency="${AXISGATE_BROWSER_PROCESSES:-3}" --test-timeout=600000 \
  --test-reporter=spec --test-reporter-destination=stdout \
  --test-reporter=./lib/counts.mjs --test-reporter-destination=stdout "$@"
