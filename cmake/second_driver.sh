#!/bin/sh
# Runs every test on a second driver, and compares its images with those of the first: lavapipe of the Mesa in Debian
# 12's backports, a compiler that differs much from the stock one's. It is unpacked below build/, beside the system's,
# which stays as it is. Needs build/ci (sh cmake/test.sh) on Debian 12.   usage: sh cmake/second_driver.sh
set -eu
cd "$(dirname "$0")/.."
folder=$PWD/build/second-driver
candela=build/ci/candela
[ -x "$candela" ] || { echo "There is no $candela; run sh cmake/test.sh first." >&2; exit 1; }

# unpack NAME...: Debian packages of the backports, downloaded and unpacked into $folder/root without installing them.
unpack() {
    keyring=/usr/share/keyrings/debian-archive-keyring.gpg
    [ -f "$keyring" ] || { echo "There is no $keyring: this script needs Debian 12." >&2; exit 1; }
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Codename: bookworm' | head -n 1)
    [ -n "$mirror" ] || { echo "apt knows no mirror of Debian 12, which this script needs." >&2; exit 1; }
    mkdir -p "$folder/lists/partial" "$folder/packages"
    echo "deb [signed-by=$keyring] $mirror bookworm-backports main" >"$folder/sources.list"
    set -- $(printf '%s/bookworm-backports ' "$@")
    apt="apt-get -qq -o Dir::Etc::sourcelist=$folder/sources.list -o Dir::Etc::sourceparts=-
         -o Dir::State::lists=$folder/lists -o APT::Get::List-Cleanup=0 -o APT::Sandbox::User=root"
    $apt update
    (cd "$folder/packages" && $apt download "$@")
    for package in "$folder"/packages/*.deb; do
        dpkg-deb -x "$package" "$folder/root"
    done
}

libraries=$folder/root/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH 2>/dev/null || echo "$(uname -m)-linux-gnu")
if [ ! -f "$libraries/libvulkan_lvp.so" ]; then
    unpack mesa-vulkan-drivers libdrm2 libdrm-amdgpu1
fi
# The driver's description names its library without a folder.
icd=$folder/lvp_icd.json
echo '{"file_format_version": "1.0.0",
 "ICD": {"library_path": "'"$libraries/libvulkan_lvp.so"'", "api_version": "1.4.0"}}' >"$icd"

# second COMMAND...: runs it on the second driver.
second() {
    env VK_ICD_FILENAMES="$icd" LD_LIBRARY_PATH="$libraries" "$@"
}

"$candela" devices
second "$candela" devices
second ctest --preset ci -L 'unit|gpu|render|cli'

# Other seeds, so that the samples of the two images are independent and their difference is judged by its noise alone.
for scene in cornell-box cornell-glossy cornell-glass environment depth-of-field veach-mis showcase mesh; do
    options="--size 128x96 --spp 64 --sampler independent --aov variance --quiet"
    "$candela" render "scenes/$scene.json" $options --seed 1 -o "$folder/first.exr"
    second "$candela" render "scenes/$scene.json" $options --seed 2 -o "$folder/second.exr"
    echo "$scene:"
    "$candela" compare "$folder/second.exr" "$folder/first.exr" --z 0.001
done
