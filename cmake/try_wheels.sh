#!/bin/sh
# Makes the wheels and the portable archive, and tries them as users do: in a fresh virtual environment without the source
# tree; and in a Debian of nothing but Python, below build/, as an ordinary user, where the wheel alone says what to
# install, and with candela-lavapipe renders, and so does the program of the archive. Needs root, debootstrap, a mirror of
# Debian that apt knows, and an index of Python packages; where one of them is missing it says so and exits with 3.
# usage: sh cmake/try_wheels.sh
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh
. cmake/fresh_debian.sh
wheels=$PWD/build/wheel
root=$wheels/debian

[ "$(id -u)" -eq 0 ] || stop "a system in a folder needs root"
command -v apt-get >/dev/null || stop "this system has no apt-get"
[ "$(uname -m)" = x86_64 ] || stop "the wheels are for x86-64"
# shellcheck disable=SC2016  # Apt replaces this.
mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' 'Created-By: Packages' 'Label: Debian' | head -n 1)
[ -n "$mirror" ] || stop "apt knows no mirror of Debian"
(install_packages render wheel night) || stop "debootstrap cannot be installed"

sh cmake/wheel.sh
sh cmake/lavapipe_wheel.sh
mkdir -p "$wheels/index"
rm -f "$wheels"/index/candela*
# For the Python of the system and that of the Debian below, which is the same one.
"$wheels/tools/bin/pip" download --quiet --dest "$wheels/index" numpy
cp "$wheels"/candela_*.whl "$wheels/index"

cat >"$wheels/index/try.py" <<'END'
import candela, importlib.metadata, os, subprocess, sys, urllib.request
assert "site-packages" in candela.__file__
assert importlib.metadata.version("candela-render") == candela.__version__
scene = {"cameras": {"main": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40}},
         "film": {"size": [64, 48]}, "environment": {"radiance": 1},
         "materials": {"clay": {"type": "diffuse", "reflectance": 0.5}},
         "shapes": [{"type": "sphere", "radius": 1, "material": "clay"}]}
if sys.argv[1:] == ["no driver"]:
    try:
        candela.load(scene)
    except candela.Error as error:
        print("It says:", error)
        assert error.kind == "no_device" and "libvulkan1" in str(error) and "pip install candela-lavapipe" in str(error)
        sys.exit()
    sys.exit("It found a driver.")
if sys.argv[1:] == ["archive"]:
    from candela import _driver
    program = "/archive/bin/candela"
    subprocess.run([program, "selftest", "--effort", "quick"], env=_driver.environment(program), check=True)
image = candela.load(scene).render(spp=16)
# A white furnace: half of what a diffuse sphere of reflectance 0.5 sees is white.
assert abs(float(image.rgb[24, 32].mean()) - 0.5) < 0.05 and float(image.rgb[0, 0].mean()) == 1
for kind in ("png", "jpg", "webp", "exr"):
    image.save(f"/tmp/try.{kind}")
    os.remove(f"/tmp/try.{kind}")
assert candela.selftest().passed
server = subprocess.Popen([sys.executable, "-m", "candela.serve", "--port", "0", "-q"], stdout=subprocess.PIPE,
                          text=True)
address = server.stdout.readline().split()[1].rsplit("/", 1)[0]
assert b'"ok"' in urllib.request.urlopen(address + "/health").read()
server.terminate()
assert server.wait() == 0
print("Rendered on", [device.name for device in candela.devices() if device.default])
END

echo "== A fresh virtual environment"
fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
python3 -m venv "$fresh"
"$fresh/bin/pip" install --quiet --no-index --find-links "$wheels/index" candela-render
(cd / && env -i PATH=/usr/bin:/bin HOME="$fresh" "$fresh/bin/python" "$wheels/index/try.py")

echo "== A Debian of nothing but Python"
rm -rf --one-file-system "$root"
# shellcheck disable=SC2086  # The suite and the mirror.
debootstrap --variant=minbase --include=python3-venv "${mirror##* }" "$root" "${mirror%% *}" >"$wheels/debian.log" ||
    { tail -n 20 "$wheels/debian.log"; exit 1; }
cp -r "$wheels/index" "$root/wheels"
mkdir "$root/archive"
tar -C "$root/archive" --strip-components 1 -xzf "$wheels"/candela-*.tar.gz
# shellcheck disable=SC2016  # The inner shell replaces these.
unshare --mount --pid --fork --kill-child sh -eu -c '
    mount -t proc proc "$1/proc"
    mount --rbind /dev "$1/dev"
    exec chroot --userspec=nobody "$1" env -i PATH=/usr/bin:/bin HOME=/tmp/home sh -eu -c "
        cd /tmp
        python3 -m venv try
        try/bin/pip install --quiet --no-index --find-links /wheels candela-render
        try/bin/python /wheels/try.py \"no driver\"
        try/bin/pip install --quiet --no-index --find-links /wheels candela-lavapipe
        try/bin/python /wheels/try.py archive"' sh "$root"
rm -rf --one-file-system "$root"
ls -l "$wheels"/candela_*.whl
