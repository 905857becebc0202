#!/bin/sh
# Does what users do, in a fresh Debian 13, whose compiler, libraries and drivers are newer than those of Debian 12:
# `sh cmake/demo.sh` and `sh cmake/test.sh`, in a root folder below build/. Needs root, debootstrap, and a mirror of
# Debian that apt knows; where one of them is missing it says so and exits with 3.   usage: sh cmake/debian13.sh
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh
root=$PWD/build/debian13

# stop REASON
stop() {
    echo "Nothing was tried: $1."
    exit 3
}
# mirror: prints where apt finds Debian; nothing if apt does not know.
mirror() {
    # shellcheck disable=SC2016  # Apt replaces this.
    apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' 'Label: Debian' | head -n 1
}

[ "$(id -u)" -eq 0 ] || stop "a system in a folder needs root"
command -v apt-get >/dev/null || stop "this system has no apt-get"
[ -n "$(mirror)" ] || apt-get update -qq || true
from=$(mirror)
[ -n "$from" ] || stop "apt knows no mirror of Debian"
(install_packages night) || stop "debootstrap cannot be installed"
mkdir -p build
/usr/lib/apt/apt-helper download-file "${from%/}/dists/trixie/InRelease" build/debian13.release >/dev/null ||
    stop "the mirror that apt knows has no Debian 13, or cannot be reached"

rm -rf --one-file-system "$root"
debootstrap --variant=minbase --include=ca-certificates,mount trixie "$root" "$from" >build/debian13.log ||
    { tail -n 20 build/debian13.log; exit 1; }
# It reaches the mirror as this system does, and starts no services.
cp /etc/apt/apt.conf.d/* "$root/etc/apt/apt.conf.d"
cp /etc/resolv.conf /etc/hosts "$root/etc"
cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"
chmod +x "$root/usr/sbin/policy-rc.d"
mkdir "$root/root/candela" "$root/old"
tar --exclude=./build --exclude=./.git -cf - . | tar -xf - -C "$root/root/candela"

# All that runs there ends with the name spaces, and so do the mounts. In a chroot, the tests could mount nothing.
# shellcheck disable=SC2016  # The inner shells replace these.
unshare --mount --pid --fork --kill-child sh -eu -c '
    mount --bind "$1" "$1"
    cd "$1"
    mount -t proc proc proc
    mount --rbind /dev dev
    pivot_root . old
    exec chroot . sh -eu -c "umount -l /old
        cd /root/candela
        sh cmake/demo.sh
        sh cmake/test.sh
        dpkg-query -W g++ mesa-vulkan-drivers"' sh "$root"
rm -rf --one-file-system "$root"
