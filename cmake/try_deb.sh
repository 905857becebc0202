#!/bin/sh
# Makes the package of Debian, twice, which must give the same bytes; has lintian check it; installs it in a fresh system
# of this one's release below build/, where the program renders, man finds its pages, zsh and fish complete its options,
# and a scene has its MIME type. Needs a build with the preset `release` that has a window, root, debootstrap, and a
# mirror of Debian that apt knows; where one of the last three is missing it says so and exits with 3.
# usage: sh cmake/try_deb.sh
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh
. cmake/fresh_debian.sh
folder=$PWD/build/deb
root=$folder/debian

# make NAME: the package in a folder of that name. The same date makes the same package.
make() {
    rm -rf "${folder:?}/$1"
    mkdir -p "$folder/$1"
    SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null || echo 0) \
        cpack -G DEB --config build/release/CPackConfig.cmake -B "$folder/$1" >"$folder/$1.log" ||
        { cat "$folder/$1.log"; exit 1; }
}
install_packages wheel  # dpkg-dev finds the packages of the libraries.
make one
make two
cmp "$folder"/one/candela_*.deb "$folder"/two/candela_*.deb

# shellcheck source=/dev/null
fresh_debian "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$root"
cp "$folder"/one/candela_*.deb "$root/candela.deb"
# shellcheck disable=SC2016  # The inner shells replace these.
run_in "$root" '
    export DEBIAN_FRONTEND=noninteractive HOME=/root
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends /candela.deb mesa-vulkan-drivers lintian fish zsh man-db groff \
        shared-mime-info libglib2.0-bin desktop-file-utils appstream >/install.log 2>&1 || { cat /install.log; exit 1; }
    lintian --allow-root --fail-on error,warning /candela.deb
    desktop-file-validate /usr/share/applications/candela.desktop
    appstreamcli validate --no-net /usr/share/metainfo/*.candela.metainfo.xml
    cd /tmp
    candela render /usr/share/candela/scenes/cornell-box.json --spp 1 --size 64x64 -o box.png
    candela view /usr/share/candela/scenes/cornell-box.json 2>&1 | grep -F "cannot open a window"
    # contains TEXT WHAT: fails, and shows it, if what came from WHAT has no such text.
    contains() { echo "$2" | grep -qF -- "$1" || { echo "No $1 in: $2"; exit 1; }; }
    for page in candela candela-render candela-view; do
        said=$(man --warnings "$page" 2>&1 >/dev/null)
        test -z "$said" || { echo "man $page: $said"; exit 1; }
    done
    contains "denoise-quality" "$(MANWIDTH=100 man candela-render)"
    contains "--denoise-quality" "$(fish -c "complete -C \"candela render --den\"")"
    contains "variance" "$(fish -c "complete -C \"candela render --denoise \"")"
    zsh -fc "autoload -U compinit; compinit -u; [[ \$_comps[candela] == _candela ]]"
    cp /usr/share/candela/scenes/cornell-box.json scene.candela.json
    contains "application/x-candela-scene+json" "$(gio info -a standard::content-type scene.candela.json)"
    contains "candela.desktop" "$(gio mime model/gltf-binary)"
    dpkg --remove candela >/dev/null
    test ! -e /usr/share/candela'
rm -rf --one-file-system "$root"
ls -l "$folder"/one/candela_*.deb
