# Shared by deploy/run and deploy/test: installs Debian packages by name, builds the page and the program.
# In: the names of package lists and of build presets. Out: build/<preset>. Never installs silently, never downloads anything but packages.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"

say() { printf '== %s\n' "$*"; }
die() { printf 'deploy: %s\n' "$*" >&2; exit 1; }

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; elif command -v sudo >/dev/null; then sudo "$@"; else die "packages are missing and this is neither root nor is there sudo; install them by hand: $*"; fi
}

# install LIST...: what deploy/packages/LIST.txt name and the machine does not have
install_packages() {
    local wanted=() missing=() p list
    for list in "$@"; do
        while read -r p; do
            case $p in ''|'#'*) ;; *) wanted+=("$p") ;; esac
        done <"deploy/packages/$list.txt"
    done
    for p in "${wanted[@]}"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$p" 2>/dev/null)" = installed ] || missing+=("$p")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    say "installing Debian packages: ${missing[*]}"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# Node.js 20.19 or newer builds the page. Debian 12's own is 18: then its npm fetches a newer one by name, pinned in deploy/node.
node_is_new_enough() { node -e 'const [a, b] = process.versions.node.split(".").map(Number); process.exit(a > 20 || (a === 20 && b >= 19) ? 0 : 1)' 2>/dev/null; }
install_node() {
    if command -v npm >/dev/null && node_is_new_enough; then return 0; fi
    if ! command -v npm >/dev/null; then
        say "installing Debian packages: nodejs npm"
        as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq
        as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends nodejs npm >/dev/null
    fi
    node_is_new_enough && return 0
    npm_ci deploy/node
    PATH=$(dirname "$(ls "$top"/deploy/node/node_modules/node-linux-*/bin/node | head -n 1)"):$PATH
    export PATH
    node_is_new_enough || die "no Node.js of 20.19 or newer could be had; install one and try again"
}

# npm_ci FOLDER: exactly what its package-lock.json names; skipped if that has been done
npm_ci() {
    local stamp="$1/node_modules/.lock-of-this"
    cmp -s "$1/package-lock.json" "$stamp" && return 0
    say "npm packages of $1 (from its lock file)"
    (cd "$1" && npm ci --no-audit --no-fund --loglevel=error)
    cp "$1/package-lock.json" "$stamp"
}

build_page() {
    local newest
    newest=$(find web schema/openapi.yaml docs adapters/*/README.md gateway/doors/*/README.md -path web/node_modules -prune -o -path web/dist -prune -o -type f -newer web/dist/index.html -print 2>/dev/null | head -n 1) || true
    if [ -f web/dist/index.html ] && [ -z "$newest" ]; then return 0; fi
    install_node
    npm_ci web
    say "building the page"
    (cd web && npm run --silent build)
}

# gently COMMAND...: what builds without making a test wait that runs at the same time
gently() { NICE="nice -n 10" "$@"; }
# build PRESET [TARGET...]
build() {
    local preset=$1; shift
    say "building $preset"
    cmake --preset "$preset" >"build/$preset.configure.log" 2>&1 || { cat "build/$preset.configure.log" >&2; die "cmake could not configure $preset"; }
    if [ $# -gt 0 ]; then set -- --target "$@"; fi
    ${NICE:-} cmake --build "build/$preset" "$@"
}
mkdir -p build
