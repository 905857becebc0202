# Sourced by libcxx.sh, wheel.sh and windows.sh: builds libraries from Debian's sources, in $folder, of
# the build type $type or else Release.
# shellcheck shell=sh
# shellcheck disable=SC2154  # The scripts that source this one set $folder, and may set $type.

# source_of NAME...: downloads and unpacks Debian's sources, with lists of apt's own.
source_of() {
    lists=$folder/apt
    # shellcheck disable=SC2016  # Apt replaces this.
    mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' 'Created-By: Packages' 'Label: Debian' | head -n 1)
    [ -n "$mirror" ] || { echo "apt knows no mirror of Debian." >&2; exit 1; }
    mkdir -p "$lists/partial" "$lists/cache/archives/partial" "$folder/source"
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror main" >"$lists/sources.list"
    apt="apt-get -qq -o Dir::Etc::sourcelist=$lists/sources.list -o Dir::Etc::sourceparts=- -o Dir::State::lists=$lists
         -o Dir::Cache=$lists/cache -o APT::Get::List-Cleanup=0 -o APT::Sandbox::User=$(id -un)"
    $apt update
    mkdir -p "$folder/licenses"
    : >"$folder/licenses/versions"
    (cd "$folder/source" && $apt source --download-only "$@")
    for name in "$@"; do
        rm -rf "$folder/source/$name"
        # Apt has checked the files; dpkg-source knows no keys, and says so at length.
        dpkg-source --no-check -x "$folder/source/$name"_*.dsc "$folder/source/$name" >/dev/null
        license "$name" "$folder/source/$name/debian/copyright"
        version=$(sed -n 's/^Version: //p' "$folder/source/$name"_*.dsc)
        echo "$name $version" >>"$folder/licenses/versions"
    done
}

# archive NAME ROOT OPTION...: builds a library from source as an archive, and installs it into ROOT.
archive() {
    name=$1 root=$2
    shift 2
    cmake -G Ninja -S "$folder/source/$name" -B "$folder/source/$name/build" "-DCMAKE_BUILD_TYPE=${type:-Release}" \
        -DBUILD_SHARED_LIBS=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_TESTING=OFF -DZLIB_USE_STATIC_LIBS=ON \
        -DCMAKE_PREFIX_PATH="$root" -DCMAKE_INSTALL_PREFIX="$root" --no-warn-unused-cli "$@" >"$folder/$name.log"
    cmake --build "$folder/source/$name/build" --target install >>"$folder/$name.log"
}

# license NAME FILE: keeps that of a library.
license() {
    cp "$2" "$folder/licenses/$1.txt"
}
