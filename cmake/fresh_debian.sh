# Sourced by scripts that try something in a fresh Debian, in a root folder: fresh_debian makes one, and run_in runs a
# command there.
# shellcheck shell=sh

# stop REASON: where this system cannot do it.
stop() {
    echo "Nothing was tried: $1."
    exit 3
}

# mirror: prints where apt finds Debian; nothing if apt does not know.
mirror() {
    # shellcheck disable=SC2016  # Apt replaces this.
    apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' 'Label: Debian' | head -n 1
}

# fresh_debian SUITE ROOT: a new system in the folder ROOT, which is emptied; its log is ROOT.log. It reaches the mirror as
# this system does, and starts no services. Stops without root, debootstrap, or a mirror of Debian that apt knows.
fresh_debian() {
    [ "$(id -u)" -eq 0 ] || stop "a system in a folder needs root"
    command -v apt-get >/dev/null || stop "this system has no apt-get"
    [ -n "$(mirror)" ] || apt-get update -qq || true
    from=$(mirror)
    [ -n "$from" ] || stop "apt knows no mirror of Debian"
    (install_packages night) || stop "debootstrap cannot be installed"
    mkdir -p "$(dirname "$2")"
    /usr/lib/apt/apt-helper download-file "${from%/}/dists/$1/InRelease" "$2.release" >/dev/null ||
        stop "the mirror that apt knows has no suite $1, or cannot be reached"
    rm -rf --one-file-system "$2"
    debootstrap --variant=minbase --include=ca-certificates,mount "$1" "$2" "$from" >"$2.log" ||
        { tail -n 20 "$2.log"; exit 1; }
    cp /etc/apt/apt.conf.d/* "$2/etc/apt/apt.conf.d"
    cp /etc/resolv.conf /etc/hosts "$2/etc"
    cp /etc/ssl/certs/ca-certificates.crt "$2/etc/ssl/certs"
    printf '#!/bin/sh\nexit 101\n' >"$2/usr/sbin/policy-rc.d"
    chmod +x "$2/usr/sbin/policy-rc.d"
    mkdir "$2/old"
}

# run_in ROOT SCRIPT: by sh -eu in that system. All that runs there ends with the name spaces, and so do the mounts. (In a
# chroot, tests could mount nothing.)
run_in() {
    # shellcheck disable=SC2016  # The inner shells replace these.
    unshare --mount --pid --fork --kill-child sh -eu -c '
        mount --bind "$1" "$1"
        cd "$1"
        mount -t proc proc proc
        mount --rbind /dev dev
        pivot_root . old
        exec chroot . sh -eu -c "umount -l /old
            $2"' sh "$1" "$2"
}
