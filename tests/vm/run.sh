#!/usr/bin/env bash
# vm: boots Debian's own kernel under software emulation and runs gateway and twin against each other over a real vcan interface.
#   tests/vm/run.sh PROGRAM
# In: the built program; Debian's kernel package, by name. Out: what tests/vm/inside.sh says, and "N passed, N failed".
# Never installs the kernel: it is unpacked into a cache. The guest sees this machine's files read-only.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "$1")
cache=${AXISGATE_VM_CACHE:-$top/build/vm}
mkdir -p "$cache"

# --- the kernel, once
if [ ! -e "$cache/kernel/done" ]; then
    rm -rf "$cache/kernel"; mkdir -p "$cache/kernel"
    package=$(apt-cache depends linux-image-amd64 | sed -n 's/.*Depends: \(linux-image-[0-9][^ ]*\)$/\1/p' | head -n 1)
    [ -n "$package" ] || { echo "vm: apt knows no linux-image-amd64; run apt-get update" >&2; echo "0 passed, 1 failed"; exit 1; }
    # apt's own download user may not write here: a world-writable folder for the fetch alone.
    fetch=$(mktemp -d); chmod 777 "$fetch"
    (cd "$fetch" && apt-get download -q "$package" >/dev/null)
    dpkg-deb --fsys-tarfile "$fetch"/*.deb | tar -x -C "$cache/kernel" ./boot ./lib/modules
    rm -rf "$fetch"
    touch "$cache/kernel/done"
fi
kernel=$(ls "$cache"/kernel/boot/vmlinuz-*)
modules=$(ls -d "$cache"/kernel/lib/modules/*)

# --- the first root: busybox, modules, a way to this machine's files
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
mkdir -p "$root"/{bin,dev,proc,sys,host,modules,tmp}
cp "$(command -v busybox)" "$root/bin/busybox"
n=100
for m in virtio_ring virtio virtio_pci_legacy_dev virtio_pci_modern_dev virtio_pci netfs fscache 9pnet 9pnet_virtio 9p can can-raw can-dev vcan slcan; do
    file=$(find "$modules" -name "$m.ko*" | head -n 1)
    [ -n "$file" ] || continue   # built in
    case $file in
        *.xz) xz -dc "$file" >"$root/modules/$n-$m.ko" ;;
        *) cp "$file" "$root/modules/$n-$m.ko" ;;
    esac
    n=$((n + 1))
done
cat >"$root/init" <<INIT
#!/bin/busybox sh
/bin/busybox mount -t proc proc /proc
/bin/busybox mount -t sysfs sys /sys
/bin/busybox mount -t devtmpfs dev /dev
for m in /modules/*.ko; do /bin/busybox insmod \$m || echo "insmod \$m failed"; done
/bin/busybox mount -t 9p -o trans=virtio,version=9p2000.L,ro,cache=loose,msize=262144 host /host || echo "no host files"
for d in proc sys dev; do /bin/busybox mount -o bind /\$d /host/\$d; done
/bin/busybox mkdir -p /dev/pts /dev/shm
/bin/busybox mount -t devpts devpts /dev/pts
/bin/busybox mount -t tmpfs tmpfs /host/dev/shm
/bin/busybox mount -t tmpfs tmpfs /host/run
echo
/bin/busybox chroot /host /bin/bash $top/tests/vm/inside.sh $program 2>&1
echo "vm: the end"
/bin/busybox poweroff -f
INIT
chmod +x "$root/init"
(cd "$root" && find . | cpio -o -H newc --quiet) >"$cache/initrd"

# --- boot; bounded in time, whatever happens inside
log="$cache/console.log"
timeout -k 5 "${AXISGATE_VM_SECONDS:-420}" qemu-system-x86_64 -accel tcg -cpu max -m 1024 -smp 1 -nographic -no-reboot -nodefaults -serial stdio \
    -kernel "$kernel" -initrd "$cache/initrd" -append "console=ttyS0 quiet panic=-1 random.trust_cpu=on" \
    -fsdev local,id=host,path=/,security_model=none,readonly=on,multidevs=remap -device virtio-9p-pci,fsdev=host,mount_tag=host \
    </dev/null >"$log" 2>&1 || true
sed -n 's/\r$//; /^vm: /p; /^pass: /p; /^FAIL: /p; /^info: /p' "$log"
passed=$(grep -c '^pass: ' "$log" || true)
failed=$(grep -c '^FAIL: ' "$log" || true)
if ! grep -q '^vm: the end' "$log"; then
    tail -n 60 "$log"
    echo "FAIL: the guest did not come to its end"
    failed=$((failed + 1))
fi
[ "$passed" -gt 0 ] || failed=$((failed + 1))
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
