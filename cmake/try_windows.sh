#!/bin/sh
# Tries candela for Windows under Wine, with the system's driver, which Wine gives it: builds it (cmake/windows.sh), unpacks
# the archive into a folder whose name has a blank and letters beyond ASCII, and runs the self-test, the gallery, whose
# pictures must have the bits of those of build/release/candela, and what a Python on Linux asks by the protocol.
# Needs build/release and Xvfb (sh cmake/test.sh).
# usage: sh cmake/try_windows.sh [OPTION OF CMAKE...]
set -eu
cd "$(dirname "$0")/.."
if ! grep -qs '^VERSION_CODENAME=bookworm$' /etc/os-release || [ "$(uname -m)" != x86_64 ]; then
    echo "Nothing was tried: this needs Debian 12 on x86-64, and this is another system."
    exit 3
fi
linux=$PWD/build/release/candela
[ -x "$linux" ] || { echo "There is no $linux; run sh cmake/test.sh first." >&2; exit 1; }
sh cmake/windows.sh "$@"
folder=$PWD/build/windows/tried
place="$folder/Zoë's pictures"
rm -rf "$folder"
mkdir -p "$place"
(cd "$place" && cmake -E tar xf "$folder"/../candela-*.zip)
program=$(echo "$place"/candela-*/candela.exe)

export WINEPREFIX="$folder/wine" WINEDEBUG=-all
# Wine's Vulkan needs a display.
Xvfb -displayfd 3 -screen 0 1280x800x24 3>"$folder/display" 2>"$folder/xvfb.log" &
trap 'kill $!' EXIT
while [ ! -s "$folder/display" ]; do sleep 0.1; done
DISPLAY=:$(cat "$folder/display")
export DISPLAY
wine=$(command -v wine64 || echo /usr/lib/wine/wine64)
"$wine" wineboot --init
# What tests call instead of a program for Linux.
cat >"$folder/candela" <<END
#!/bin/sh
exec "$wine" "$program" "\$@"
END
chmod +x "$folder/candela"

"$folder/candela" --version
"$folder/candela" devices
"$folder/candela" selftest --effort quick
for scene in scenes/*.json; do
    [ "$scene" != scenes/scene.schema.json ] || continue
    for system in linux windows; do
        program=$linux
        [ "$system" = linux ] || program=$folder/candela
        "$program" render "$scene" --size 64x48 --spp 4 --quiet -o "$folder/$system.png" --report "$folder/$system.report.json"
    done
    python3 - "$scene" "$folder" <<'END'
import json, sys
scene, folder = sys.argv[1:]
one, other = (json.load(open(f"{folder}/{system}.report.json"))["image_hash"] for system in ("linux", "windows"))
print(f"{scene}: {one} on Linux, {other} on Windows")
sys.exit(one != other)
END
done
/usr/bin/python3 tests/python/windows_test.py "$folder/candela" "$linux"
