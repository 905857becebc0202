#!/bin/sh
# Makes the wheel candela_lavapipe in build/wheel: Vulkan's loader, Mesa's driver for CPUs, its LLVM, and what they
# need besides glibc, as Debian's packages have them, with their copyright files. The package `candela` uses it where
# there is no other driver. Needs apt, for x86-64.   usage: sh cmake/lavapipe_wheel.sh
set -eu
cd "$(dirname "$0")/.."
folder=$PWD/build/wheel/lavapipe
lists=$folder/apt

# shellcheck disable=SC2016  # Apt replaces this.
mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' 'Created-By: Packages' 'Label: Debian' | head -n 1)
[ -n "$mirror" ] || { echo "apt knows no mirror of Debian." >&2; exit 1; }
mkdir -p "$lists/partial" "$lists/cache/archives/partial" "$folder/packages"
echo "deb [arch=amd64 signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror main" >"$lists/sources.list"
: >"$lists/status"  # Nothing is installed: so apt names all that they need.
apt="-qq -o Dir::Etc::sourcelist=$lists/sources.list -o Dir::Etc::sourceparts=- -o Dir::State::lists=$lists
     -o Dir::State::status=$lists/status -o Dir::Cache=$lists/cache -o APT::Get::List-Cleanup=0
     -o APT::Sandbox::User=$(id -un) -o APT::Architecture=amd64"
# shellcheck disable=SC2086  # The options are words.
apt-get $apt update
# shellcheck disable=SC2086
names=$(apt-get $apt --simulate --no-install-recommends install libvulkan1 mesa-vulkan-drivers |
    sed -n 's/^Inst \([^ ]*\).*/\1/p')
rm -rf "$folder/packages" "$folder/root" "$folder/files"
mkdir -p "$folder/packages" "$folder/root" "$folder/files"
# shellcheck disable=SC2086
(cd "$folder/packages" && apt-get $apt download $names)
for package in "$folder"/packages/*.deb; do
    name=$(basename "$package" | cut -d _ -f 1)
    dpkg-deb -x "$package" "$folder/root"
    dpkg-deb --fsys-tarfile "$package" | tar -t | grep '\.so' | sed "s|^\./|$name /|" >>"$folder/files/list" || true
    dpkg-deb -f "$package" Package Version Source >"$folder/files/$name.version"
done
python3 cmake/lavapipe_wheel.py "$folder" build/wheel
