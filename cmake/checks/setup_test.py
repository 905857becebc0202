#!/usr/bin/env python3
"""Tests setup.sh against a system of stubs: what it installs, what it says first, and when it stops; and what debian13.sh
says where it cannot run."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = [line.split() for line in (ROOT / "cmake/packages.txt").read_text().splitlines() if line[0] != "#"]
NAMES = {name for name, when, *_ in PACKAGES if when in ("render", "test", "optional")}

STUBS = {
    "dpkg-query": 'for name; do :; done; case " $ABSENT " in *" $name "*) exit 1 ;; *) printf installed ;; esac',
    "apt-cache": 'case " $UNKNOWN " in *" $2 "*) exit 100 ;; esac',
    "apt-get": 'echo "apt-get $*, frontend ${DEBIAN_FRONTEND:-none}"',
    "sudo": 'echo "sudo"; exec "$@"',
    "id": "echo $USER_ID",
}


def install(absent="", unknown="", user_id=0, without=()):
    """Runs install_packages where packages are `absent`, or `unknown` to apt, and `without` some commands."""
    with tempfile.TemporaryDirectory() as path:
        for name, body in STUBS.items():
            if name not in without:
                stub = Path(path, name)
                stub.write_text("#!/bin/sh\n" + body + "\n")
                stub.chmod(0o755)
        for name in ("env", "grep"):
            os.symlink(shutil.which(name), Path(path, name))
        return subprocess.run(
            ["/bin/sh", "-c", "set -eu; . cmake/setup.sh; install_packages render test optional; echo done"],
            cwd=ROOT, env={"PATH": path, "ABSENT": absent, "UNKNOWN": unknown, "USER_ID": str(user_id)},
            capture_output=True, text=True, check=False)


class Setup(unittest.TestCase):
    def test_nothing_missing_means_no_call_and_no_word(self):
        result = install()
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "done\n", ""))

    def test_each_package_is_named_before_it_is_installed(self):
        result = install(absent="g++ spirv-tools")
        self.assertEqual(result.returncode, 0, result.stderr)
        words = result.stdout.split("\n")
        self.assertEqual(words[1], "apt-get update -qq, frontend none")
        self.assertRegex(words[3], r"^  g\+\+ +compiles the program$")
        self.assertRegex(words[4], r"^  spirv-tools +prepares SPIR-V for lavapipe; finds invalid SPIR-V in tests$")
        self.assertRegex(words[5], r"^apt-get install -y .* g\+\+ spirv-tools, frontend noninteractive$")
        self.assertEqual(words[6:], ["done", ""])

    def test_others_than_root_use_sudo(self):
        result = install(absent="g++", user_id=1000)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.count("sudo\napt-get"), 2)

    def test_without_root_and_sudo_it_lists_what_is_missing_and_stops(self):
        result = install(absent="g++", user_id=1000, without=("sudo",))
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        self.assertRegex(result.stderr, r"^Packages are missing, and without root or sudo none can be installed. "
                                        r"Install these yourself[^\n]*\n  g\+\+ +compiles the program\n$")

    def test_without_apt_it_lists_everything_and_stops(self):
        result = install(without=("apt-get", "apt-cache", "dpkg-query"))
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        self.assertTrue(result.stderr.startswith("This system has no apt-get. Install these yourself"))
        self.assertEqual({line.split()[0] for line in result.stderr.splitlines()[1:]}, NAMES)

    def test_an_optional_package_that_apt_does_not_know_is_done_without(self):
        optional = " ".join(name for name, when, *_ in PACKAGES if when == "optional")
        self.assertEqual(install(absent=optional, unknown=optional).stdout, "done\n")
        self.assertIn(f" {optional}, frontend", install(absent=optional).stdout)

    def test_a_failed_installation_stops_the_script(self):
        STUBS["apt-get"], stub = "exit 100", STUBS["apt-get"]
        self.addCleanup(STUBS.__setitem__, "apt-get", stub)
        result = install(absent="g++")
        self.assertEqual(result.returncode, 100)
        self.assertNotIn("done", result.stdout)


class Debian13(unittest.TestCase):
    def said(self, user_id=0, answer="", without_debootstrap=False):
        """What it says where it tries nothing; apt-get prints the answer, and installs nothing."""
        with tempfile.TemporaryDirectory() as path:
            for name, body in (STUBS | {"apt-get": 'echo "$ANSWER"; [ "$1" != install ]'}).items():
                stub = Path(path, name)
                stub.write_text("#!/bin/sh\n" + body + "\n")
                stub.chmod(0o755)
            result = subprocess.run(
                ["/bin/sh", "cmake/debian13.sh"], cwd=ROOT, capture_output=True, text=True, check=False,
                env={"PATH": f"{path}:/usr/bin:/bin", "ANSWER": answer, "USER_ID": str(user_id),
                     "ABSENT": "debootstrap" if without_debootstrap else "", "UNKNOWN": ""})
        self.assertEqual(result.returncode, 3, result.stderr)
        return result.stdout.splitlines()[-1]

    def test_it_says_why_it_tries_nothing(self):
        self.assertEqual(self.said(user_id=1000), "Nothing was tried: a system in a folder needs root.")
        self.assertEqual(self.said(), "Nothing was tried: apt knows no mirror of Debian.")
        self.assertEqual(self.said(answer="none:/", without_debootstrap=True),
                         "Nothing was tried: debootstrap cannot be installed.")
        self.assertEqual(self.said(answer="none:/"),
                         "Nothing was tried: the mirror that apt knows has no suite trixie, or cannot be reached.")


if __name__ == "__main__":
    unittest.main()
