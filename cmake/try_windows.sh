#!/bin/sh
# Tries candela for Windows under Wine, with the system's driver, which Wine gives it: builds it (cmake/windows.sh), unpacks
# the archive into a folder whose name has a blank and letters beyond ASCII, and runs the self-test, the gallery, whose
# pictures must have the bits of those of build/release/candela, the unit tests, those tests of the command line that ask
# for nothing that only Linux has, and what a Python on Linux asks by the protocol. Needs the tests (sh cmake/test.sh).
# usage: sh cmake/try_windows.sh [OPTION OF CMAKE...], or: sh cmake/try_windows.sh quick [OPTION OF CMAKE...]
# quick: without optimization, and without the unit tests and those of the command line
set -eu
quick=
if [ "${1-}" = quick ]; then
    quick=quick
    shift
fi
cd "$(dirname "$0")/.."
if ! grep -qs '^VERSION_CODENAME=bookworm$' /etc/os-release || [ "$(uname -m)" != x86_64 ]; then
    echo "Nothing was tried: this needs Debian 12 on x86-64, and this is another system."
    exit 3
fi
linux=$PWD/build/release/candela
[ -x "$linux" ] || { echo "There is no $linux; run sh cmake/test.sh first." >&2; exit 1; }
sh cmake/windows.sh $quick "$@"
. cmake/sources.sh
if [ -z "$quick" ]; then
    folder=$PWD/build/windows
    root=$folder/root
    if [ ! -f "$root/lib/libgtest.a" ]; then
        cp -r /usr/src/googletest "$folder/source/"
        archive googletest "$root" "-DCMAKE_TOOLCHAIN_FILE=$PWD/cmake/mingw.cmake"
    fi
    cmake --preset windows -DCANDELA_VIEW=ON -DCANDELA_TESTS=ON
    cmake --build --preset windows --target unit_tests
fi
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
# Linux puts Wine's heap at random, one time in a thousand where Wine must have memory of its own (0x7ffe0000): it then ends
# with 1.
fixed=
if setarch -R true 2>/dev/null; then fixed="setarch -R"; fi
$fixed "$wine" wineboot --init
# What tests call instead of a program for Linux.
cat >"$folder/candela" <<END
#!/bin/sh
unset CANDELA_VALIDATION  # The layer is of Linux.
exec $fixed "$wine" "$program" "\$@"
END
chmod +x "$folder/candela"

"$folder/candela" --version
"$folder/candela" devices
"$folder/candela" selftest --effort quick
sh cmake/same_pictures.sh "$folder/candela"
/usr/bin/python3 tests/python/windows_test.py "$folder/candela" "$linux"
[ -z "$quick" ] || exit 0
# Without what asks for symbolic links, which the compiler's library lacks, or for a clock of CPU time finer than 1/64 s.
lacking='BenchBuild.MeasuresSpeed*:GltfFileTest.NamesNoFileOutside*:ObjTextures.ImagesOutOfReach*'
$fixed "$wine" build/windows/release/tests/unit_tests.exe --gtest_brief=1 "--gtest_filter=-$lacking"
# Without what needs signals, terminals, faults, full disks or windows as Linux has them, shows names that Windows refuses,
# or loads a library of Linux.
some='Usage.*:Compare.*:RenderOptionsTest.*:RenderFiles.*:LightingOptionsTest.*:BackgroundOptions.*:CatcherOptionsTest.*'
some=$some':Batch.*:BatchOptions.*:Cameras.*:CheckpointTest.*:Frames.*:Ids.*:Info.*:Instances.*:MergeTest.*:MotionLayer.*'
some=$some':PlotTest.*-RenderFiles.AttributesTell*:RenderFiles.ReportHas*:RenderFiles.CompiledKernels*:Batch.GoesOn*'
some=$some':Batch.Counts*:Batch.SaysOnce*:CheckpointTest.Signals*:CheckpointTest.AFullDisk*:PlotTest.ASinglePoint*'
CANDELA_TESTED_PROGRAM=$folder/candela build/release/tests/cli_tests --gtest_brief=1 "--gtest_filter=$some"
