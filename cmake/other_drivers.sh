#!/bin/sh
# Tests candela on two drivers other than the system's, and compares their images with those of the system's driver:
#   lavapipe of the Mesa in Debian 12's backports, whose compiler differs much from the stock one's;
#   SwiftShader, of Chromium, which shares nothing with Mesa: four lanes, denormal numbers flushed to zero, and texel
#   buffers of no more than 65 536 elements.
# Both are downloaded once and unpacked below build/; the system's driver stays as it is. Needs build/release (sh
# cmake/test.sh) and Debian 12; on other systems it says so and exits with 3. Prints how long each step took.
#
# usage: sh cmake/other_drivers.sh          the tests vk, gpu and render, on both
#        sh cmake/other_drivers.sh quick    SwiftShader alone, and what a foreign driver breaks first
set -eu
cd "$(dirname "$0")/.."
extent=${1:-full}
folder=$PWD/build/other-drivers
packages=$folder/packages
mesa=$folder/root/usr/lib/x86_64-linux-gnu
chromium=$folder/root/usr/lib/chromium
candela=build/release/candela

case $extent in
    full | quick) ;;
    *) echo "usage: sh cmake/other_drivers.sh [quick]" >&2; exit 2 ;;
esac
if ! grep -qs '^VERSION_CODENAME=bookworm$' /etc/os-release || [ "$(uname -m)" != x86_64 ]; then
    echo "Nothing was tried: the other drivers come as packages of Debian 12 for x86-64, and this is another system."
    exit 3
fi
[ -x "$candela" ] || { echo "There is no $candela; run sh cmake/test.sh first." >&2; exit 1; }

# mirror SUITE: prints where apt finds it; nothing if apt does not know.
mirror() {
    # shellcheck disable=SC2016  # Apt replaces this.
    apt-get indextargets --format '$(REPO_URI)' "Codename: $1" | head -n 1
}

# unpack SUITE MIRROR NAME...: downloads packages and unpacks them into $folder/root, without installing them. Apt works
# with lists of its own, so that it needs no root and asks for the mirror's current versions.
unpack() {
    suite=$1
    [ -n "$2" ] || { echo "apt knows no mirror of Debian 12." >&2; exit 1; }
    lists=$folder/apt/$suite
    mkdir -p "$lists/partial" "$lists/cache/archives/partial" "$packages"
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $2 $suite main" >"$lists/sources.list"
    apt="apt-get -qq -o Dir::Etc::sourcelist=$lists/sources.list -o Dir::Etc::sourceparts=- -o Dir::State::lists=$lists
         -o Dir::Cache=$lists/cache -o APT::Get::List-Cleanup=0 -o APT::Sandbox::User=$(id -un)"
    $apt update
    shift 2
    for name in "$@"; do
        rm -f "$packages/$name"_*.deb  # From an earlier try.
        (cd "$packages" && $apt download "$name/$suite")
        dpkg-deb -x "$packages/$name"_*.deb "$folder/root"
    done
}

# describe LIBRARY: prints the manifest of a driver, for Vulkan's loader. The packages' own manifests do not say where
# the library is now.
describe() {
    echo '{"file_format_version": "1.0.0", "ICD": {"library_path": "'"$1"'", "api_version": "1.2.0"}}'
}

# on DRIVER COMMAND...: runs it on only that driver. (Mesa's needs the libdrm beside it, SwiftShader needs none.)
on() {
    icd=$folder/$1.json
    shift
    env VK_ICD_FILENAMES="$icd" VK_DRIVER_FILES="$icd" LD_LIBRARY_PATH="$mesa" "$@"
}

# step NAME COMMAND...: runs it, and prints how long it took.
step() {
    echo "== $1"
    begin=$(date +%s)
    name=$1
    shift
    "$@"
    echo "== $name: $(($(date +%s) - begin)) s"
}

# tests DRIVER EFFORT PRESET CTEST-OPTION...: runs tests on that driver, with the validation layer.
tests() {
    driver=$1
    effort=$2
    preset=$3
    shift 3
    echo "effort: $effort"
    on "$driver" CANDELA_TEST_EFFORT="$effort" ctest --preset "$preset" "$@"
}

# compare DRIVER SIZE SCENE...: compares its images with those of the system's driver. The seeds differ, so that the
# samples are independent and the difference is judged only by its noise.
compare() {
    driver=$1
    options="--size $2 --spp 64 --sampler independent --aov variance --quiet"
    shift 2
    # shellcheck disable=SC2086  # The options are words.
    for scene in "$@"; do
        echo "$scene:"
        "$candela" render "scenes/$scene.json" $options --seed 1 -o "$folder/first.exr"
        on "$driver" "$candela" render "scenes/$scene.json" $options --seed 2 -o "$folder/second.exr"
        "$candela" compare "$folder/second.exr" "$folder/first.exr" --z 0.001
    done
}

if [ ! -f "$folder/swiftshader.json" ]; then
    if [ -n "$(mirror bookworm-security)" ]; then
        unpack bookworm-security "$(mirror bookworm-security)" chromium-common
    else
        unpack bookworm "$(mirror bookworm)" chromium-common
    fi
    describe "$chromium/libvk_swiftshader.so" >"$folder/swiftshader.json"
fi
if [ "$extent" = full ] && [ ! -f "$folder/mesa.json" ]; then
    unpack bookworm-backports "$(mirror bookworm)" libdrm2 libdrm-amdgpu1 mesa-vulkan-drivers
    describe "$mesa/libvulkan_lvp.so" >"$folder/mesa.json"
fi
dpkg-deb -W "$packages"/chromium-common_*.deb
"$candela" devices
on swiftshader "$candela" devices
if [ "$extent" = quick ]; then
    # Beside the rest: most of it is one thread that compiles. Both in full, even if one fails.
    (step "SwiftShader: selftest" on swiftshader "$candela" selftest --effort quick) >"$folder/selftest.txt" 2>&1 &
    selftest=$!
    # Records, exponentials, rays of extreme directions and sizes, and identical bits, of the scene that has everything.
    # The statistics of pictures, other rays and states in files are left to the selftest, which covers them in brief.
    some='^gpu\.(RecordsTest|ExponentialTest|TraversalTest\.(AMillionfold|AxisParallel|Distances|TheNearestHit))'
    some=$some'|IdentityTest.(ManySmall|Texel|Tuned|ACrop|SamplesThat).*/Everything'
    (
        step "SwiftShader: tests" tests swiftshader quick ci -R "$some"
        # Its compiler would take 21 GB for lemons without vk/ways_around.h.
        step "SwiftShader: images" compare swiftshader 64x48 lemons
    ) &
    rest=$!
    passed=1
    wait "$rest" || passed=0
    wait "$selftest" || passed=0
    cat "$folder/selftest.txt"
    [ "$passed" = 1 ]
    exit
fi

dpkg-deb -W "$packages"/mesa-vulkan-drivers_*.deb
on mesa "$candela" devices
set -- cornell-box cornell-glossy cornell-glass environment depth-of-field veach-mis showcase mesh lemons materials
step "Mesa: selftest" on mesa "$candela" selftest
step "Mesa: tests" tests mesa full ci --parallel "$(nproc)" -L '^(vk|gpu|render)$'
step "Mesa: slow tests" tests mesa full slow --parallel "$(nproc)" -R '^(gpu|render)[.]'
step "Mesa: images" compare mesa 128x96 "$@"
# SwiftShader takes 30 to 70 times as long as lavapipe: a sixteenth of the samples, a quarter of the pixels.
step "SwiftShader: selftest" on swiftshader "$candela" selftest --effort quick
# Without ConvergenceTest: its bounds hold only for one number of samples, and what they judge, an estimate, is the
# host's work. Without what compiles a kernel that many scenes share: only lavapipe gets these, for which SwiftShader's
# compiler would take 9 GB and more. Without the slow tests: others do the same with fewer samples.
left_out='ConvergenceTest|SharedKernelTest[.](TheirPictures|Others)|TunedForLavapipeOrNot/Textured'
echo "left out: $left_out and the slow tests; the script says why"
step "SwiftShader: tests" tests swiftshader quick ci --parallel "$(nproc)" -L '^(vk|gpu|render)$' -E "$left_out"
step "SwiftShader: images" compare swiftshader 64x48 "$@"
