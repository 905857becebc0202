#!/bin/sh
# Tries the add-on as a new user does: Debian 13's own Blender in a root folder below build/, which stays; the zip is installed
# by Blender, and the viewport of a window, which Xvfb shows, is switched to candela. Leaves screenshots in build/window, to be
# looked at. Needs root, debootstrap, a mirror of Debian that apt knows, and 2 GB; where one is missing it exits with 3.
#   usage: sh tests/blender/window.sh [PROGRAM]   (build/release/candela)
set -eu
cd "$(dirname "$0")/../.."
program=${1:-build/release/candela}
root=$PWD/build/debian13-window

# stop REASON
stop() {
    echo "Nothing was tried: $1."
    exit 3
}
[ "$(id -u)" -eq 0 ] || stop "a system in a folder needs root"
command -v debootstrap >/dev/null || stop "debootstrap is not installed"
if [ ! -e "$root/ready" ]; then
    # shellcheck disable=SC2016  # Apt replaces this.
    from=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' 'Label: Debian' | head -n 1)
    [ -n "$from" ] || stop "apt knows no mirror of Debian"
    rm -rf --one-file-system "$root"
    mkdir -p build
    debootstrap --variant=minbase --include=ca-certificates trixie "$root" "$from" >build/window.log || stop "see build/window.log"
    cp /etc/apt/apt.conf.d/* "$root/etc/apt/apt.conf.d"
    cp /etc/resolv.conf /etc/hosts "$root/etc"
    cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs"
    chroot "$root" apt-get update -qq
    chroot "$root" env DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends blender python3-numpy xvfb xauth \
        mesa-vulkan-drivers libvulkan1 libgl1-mesa-dri libegl1 libglfw3 'libstb0*' imagemagick >>build/window.log 2>&1
    touch "$root/ready"
fi

sh cmake/blender.sh "$program"
rm -rf build/window "$root/root/try"
mkdir -p build/window "$root/root/try"
cp build/blender/candela-*.zip tests/blender/window.py "$root/root/try"
# The libraries of the program that Debian 13 has in other versions only.
cp "$program" "$root/root/try/program"
for library in $(chroot "$root" ldd /root/try/program | sed -n 's/^\t\(.*\) => not found$/\1/p'); do
    cp -L "$(ldd "$program" | sed -n "s/^\t$library => \([^ ]*\) .*/\1/p")" "$root/usr/local/lib"
done
chroot "$root" ldconfig
# All that runs there ends with the name spaces, and so do the mounts.
# shellcheck disable=SC2016  # The inner shell replaces these.
unshare --mount --pid --fork --kill-child sh -eu -c '
    mount -t proc proc "$1/proc"
    mount --rbind /dev "$1/dev"
    exec chroot "$1" sh -eu -c "
        export HOME=/root LIBGL_ALWAYS_SOFTWARE=1
        blender --version | head -n 1
        blender --command extension install-file --repo user_default --enable /root/try/candela-*.zip
        blender --background --python-expr \"import bpy; bpy.context.preferences.view.show_splash = False; bpy.ops.wm.save_userpref()\"
        timeout 900 xvfb-run -a -s \"-screen 0 1024x640x24\" blender --window-geometry 0 0 1024 640 \
            --python /root/try/window.py -- /root/try bl_ext.user_default.candela"' sh "$root" 2>&1 | tee build/window/log
cp "$root"/root/try/*.png build/window
ls build/window
