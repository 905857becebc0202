#!/bin/sh
# Does what users do, in a fresh Debian 13, whose compiler, libraries and drivers are newer than those of Debian 12:
# `sh cmake/demo.sh` and `sh cmake/test.sh`, in a root folder below build/. Needs root, debootstrap, and a mirror of
# Debian that apt knows; where one of them is missing it says so and exits with 3.   usage: sh cmake/debian13.sh
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh
. cmake/fresh_debian.sh
root=$PWD/build/debian13

fresh_debian trixie "$root"
mkdir "$root/root/candela"
tar --exclude=./build --exclude=./.git -cf - . | tar -xf - -C "$root/root/candela"
run_in "$root" '
    cd /root/candela
    sh cmake/demo.sh
    sh cmake/test.sh
    dpkg-query -W g++ mesa-vulkan-drivers'
rm -rf --one-file-system "$root"
