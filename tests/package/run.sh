#!/usr/bin/env bash
# package: the Debian package, in a fresh Debian of its own.
#   tests/package/run.sh
# In: the built program. Out: one line per test, then "N passed, N failed". Makes build/package; installs nothing on this machine itself.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
[ "$(id -u)" = 0 ] || { echo "a Debian of its own can only be made by root"; echo "0 passed, 1 failed"; exit 1; }
passed=0 failed=0
check() { # NAME COMMAND...
    local name=$1; shift
    if said=$("$@" 2>&1); then passed=$((passed + 1)); echo "pass: $name"; else failed=$((failed + 1)); echo "FAIL: $name"; printf '%s\n' "$said" | tail -n 20; fi
}
root=$PWD/build/package/root
in_root() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C "$@"; }

# Beside the rest: it is mostly downloads.
rm -rf "$root" && mkdir -p build/package
mirror=$(sed -n 's/^URIs: *//p; s/^deb [^h]*\(http[^ ]*\).*/\1/p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -n 1)
debootstrap --variant=minbase --include=systemd bookworm "$root" "$mirror" >build/package/debootstrap.log 2>&1 &
making=$!

build_twice() {
    deploy/package && cp build/package/axisgate_*.deb build/package/first.deb && deploy/package && cmp build/package/first.deb build/package/axisgate_*.deb
}
check "two builds of the same sources are equal" build_twice
deb=$(ls build/package/axisgate_*.deb)
check "lintian finds no error and no warning" bash -c "! lintian --fail-on error,warning --allow-root $deb 2>&1 | grep -E '^[EW]:'"
check "the bill of materials names every library and the page's parts" python3 - "$deb" <<'PY'
import gzip, io, json, subprocess, sys, tarfile
files = tarfile.open(fileobj=io.BytesIO(subprocess.run(["dpkg-deb", "--fsys-tarfile", sys.argv[1]], capture_output=True, check=True).stdout))
names = set(files.getnames())
document = json.loads(gzip.decompress(files.extractfile("./usr/share/doc/axisgate/axisgate.spdx.json.gz").read()))
listed = {p["name"] for p in document["packages"]}
depends = subprocess.run(["dpkg-deb", "--field", sys.argv[1], "Depends"], capture_output=True, text=True).stdout
for part in depends.split(","):
    name = part.split()[0]
    if name.startswith("lib"):
        assert name in listed or name == "libspdlog1.10-fmt9" and "libspdlog1.10" in listed, name
assert "preact" in listed and all(p.get("versionInfo") for p in document["packages"]), listed
for wanted in ("./usr/bin/axisgate", "./lib/systemd/system/axisgate.service", "./etc/axisgate/axisgate.toml", "./usr/share/man/man1/axisgate.1.gz", "./usr/share/man/man5/axisgate.toml.5.gz",
               "./usr/share/bash-completion/completions/axisgate", "./usr/lib/sysusers.d/axisgate.conf", "./usr/lib/tmpfiles.d/axisgate.conf", "./lib/udev/rules.d/60-axisgate.rules"):
    assert wanted in names, wanted
PY
completes() { bash -c '. build/package/axisgate-*/completion/axisgate; COMP_WORDS=(axisgate se); COMP_CWORD=1; _axisgate; [ "${COMPREPLY[*]}" = serve ] && COMP_WORDS=(axisgate serve --con); COMP_CWORD=2 && _axisgate && [ "${COMPREPLY[*]}" = --config ]'; }
check "the shell completes subcommands and options" completes
check "the man pages say every subcommand and key" bash -c "man -l --warnings build/package/axisgate-*/axisgate.1 2>&1 | grep -q 'twin' && for key in bind local_role pty_dir hot_cpu; do man -l build/package/axisgate-*/axisgate.toml.5 | grep -q \$key || exit 1; done"

fresh() { cat build/package/debootstrap.log; [ -e "$root/etc/debian_version" ]; }
wait "$making"
check "a fresh Debian is made" fresh
cp "$deb" "$root/axisgate.deb"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" && chmod +x "$root/usr/sbin/policy-rc.d"
check "it installs with what it depends on" in_root sh -c "apt-get install -y -q --no-install-recommends /axisgate.deb"
check "its user may use serial ports" in_root sh -c "id -nG axisgate | grep -w dialout"
check "its configuration is sound where it lies" in_root axisgate check --config /etc/axisgate/axisgate.toml
smoke() {
    mkdir -p "$root/run/axisgate"
    in_root sh -c 'mkdir -p /var/lib/axisgate && chown axisgate:axisgate /var/lib/axisgate'
    chroot --userspec=axisgate:axisgate "$root" env -i PATH=/usr/bin:/bin axisgate serve --config /etc/axisgate/axisgate.toml --set http.bind=127.0.0.1:18080 --set modbus.bind=127.0.0.1:11502 --set enip.bind=off >build/package/serve.log 2>&1 &
    local process=$! answer=
    for _ in $(seq 50); do answer=$(curl -s -m 2 http://127.0.0.1:18080/healthz) && break; sleep 0.1; done
    local barred
    barred=$(curl -s -m 2 -o /dev/null -w '%{http_code}' http://127.0.0.1:18080/api/v1/axes)
    kill "$process"; wait "$process"
    cat build/package/serve.log
    [[ $answer == *'"status":"ok"'* && $barred = 401 ]] || { echo "health $answer, axes without a sign-in $barred"; return 1; }
}
check "it serves as its user, and lets nobody in without a sign-in" smoke
check "an upgrade keeps database and changed configuration" in_root sh -c "echo '# mine' >>/etc/axisgate/axisgate.toml && sha256sum /var/lib/axisgate/axisgate.db >/before && apt-get install -y -q --reinstall /axisgate.deb && grep -q '# mine' /etc/axisgate/axisgate.toml && sha256sum -c /before"
# A gateway that runs in it, and a service manager that says that an axis moves: dpkg's way back from the refusal must not touch the process.
refused_upgrade() {
    local new=build/package/newer fake=$root/fake said process
    rm -rf "$new" && dpkg-deb -R "$deb" "$new" && sed -i 's/^Version: .*/&+newer/' "$new/DEBIAN/control" && dpkg-deb --root-owner-group -b "$new" "$root/newer.deb" >/dev/null || return 1
    mkdir -p "$fake" "$root/run/systemd/system"
    printf '#!/bin/sh\n[ "$1" != show ] || { echo "1 of 1 drives online, 1 moving"; exit 0; }\necho "$*" >>/asked\ncase "$*" in *start*|*stop*) kill "$(cat /gateway.pid)";; esac\n' >"$fake/systemctl"
    chmod +x "$fake/systemctl" && cp "$fake/systemctl" "$fake/deb-systemd-invoke" && : >"$root/asked"
    chroot --userspec=axisgate:axisgate "$root" env -i PATH=/usr/bin:/bin axisgate serve --config /etc/axisgate/axisgate.toml --set http.bind=127.0.0.1:18081 --set modbus.bind=127.0.0.1:11503 --set enip.bind=off >build/package/serve.log 2>&1 &
    process=$!
    for _ in $(seq 50); do curl -s -m 2 -o /dev/null http://127.0.0.1:18081/healthz && break; sleep 0.1; done
    echo "$process" >"$root/gateway.pid"
    said=$(chroot "$root" env -i PATH=/fake:/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C AXISGATE_WAIT_S=1 dpkg -i /newer.deb 2>&1) && { echo "not refused: $said"; kill "$process"; return 1; }
    local here; here=$(curl -s -m 2 http://127.0.0.1:18081/healthz)
    kill "$process"; wait "$process"
    rm -rf "$fake" "$root/run/systemd/system" "$root/newer.deb" "$new"
    echo "$said"; cat "$root/asked"
    [[ $said == *"axes are still moving"* && $here == *'"status":"ok"'* ]] && ! grep -q "restart\|stop" "$root/asked" && in_root dpkg-query -W -f='${db:Status-Abbrev}' axisgate | grep -q '^ii'
}
check "an upgrade that is refused because an axis moves leaves the gateway's process alone" refused_upgrade
check "removing keeps the database" in_root sh -c "apt-get remove -y -q axisgate && [ ! -e /usr/bin/axisgate ] && [ -e /var/lib/axisgate/axisgate.db ]"
check "purging leaves nothing" in_root sh -c "apt-get purge -y -q axisgate && [ ! -e /var/lib/axisgate ] && [ ! -e /etc/axisgate ] && [ ! -e /etc/systemd/system/multi-user.target.wants/axisgate.service ]"
rm -rf "$root"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
