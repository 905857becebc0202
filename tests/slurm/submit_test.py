#!/usr/bin/env python3
"""Tests the scripts of integrations/slurm with stand-ins for Slurm and candela: the numbers and names that they
accept, and the arguments that they pass on.   usage: submit_test.py"""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "integrations/slurm"
CODE = "a[$(touch RAN)]"  # An arithmetic expression in bash, which runs what stands in it.
NOT_NUMBERS = ("", "x", "-1", "1.5", "0x10", "1e3", "0", "00", "9999999999", "8\n8", "\x1b[2J", CODE)

# Each writes down its arguments, a line each, and prints what the test wants.
STAND_INS = {
    "sbatch": 'printf "%s\\n" "$@" -- >>calls; printf "%s\\n" "$JOB"',
    "squeue": 'printf "%s\\n" "$@" -- >>calls; printf "%s" "$QUEUED"',
    "scontrol": 'echo "MaxArraySize            = $MOST"',
    "candela": """printf "%s\\n" "$@" -- >>calls
if [ "$1" = merge ]; then echo "$MISSING"
else printf '"samples_per_second": %s,\\n"width": 10,\\n"height": 10\\n' "$RATE"; fi""",
}
ANSWERS = {"JOB": "42", "QUEUED": "", "MOST": "1001", "MISSING": "0..8", "RATE": "1e+03"}


class Scripts(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="candela-")))
        (self.folder / "bin").mkdir()
        for name, body in STAND_INS.items():
            program = self.folder / "bin" / name
            program.write_text("#!/bin/sh\n" + body + "\n")
            program.chmod(0o755)
        (self.folder / "box.json").touch()

    def run_script(self, script, *arguments, **variables):
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("CANDELA", "SLURM"))}
        environment |= ANSWERS | variables | {"PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}"}
        (self.folder / "calls").unlink(missing_ok=True)
        result = subprocess.run(["bash", SCRIPTS / script, *map(str, arguments)], env=environment, cwd=self.folder,
                                capture_output=True, text=True, check=False, timeout=600)
        self.assertFalse((self.folder / "RAN").exists(), "code ran")
        return result

    def calls(self):
        path = self.folder / "calls"
        return path.read_text().split("--\n") if path.exists() else []

    def submit(self, *arguments, **variables):
        """Submits a picture of eight samples, and returns what that prints."""
        result = self.run_script("submit.sh", *(arguments or ("box.json", "--spp", 8, "-o", "box.exr")), **variables)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def assert_refused(self, message, result):
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn(message, result.stderr)
        self.assertNotIn("\x1b", result.stderr)
        self.assertFalse([call for call in self.calls() if call.startswith("--parsable")], "something was submitted")

    def test_what_is_not_a_number_is_refused(self):
        parts = self.folder / "box.parts"
        parts.mkdir()
        for text in NOT_NUMBERS:
            with self.subTest(text=text):
                def refused(message, *arguments, **variables):
                    self.assert_refused(message, self.run_script(
                        "submit.sh", *arguments, "box.json", "--spp", 8, "-o", "box.exr", **variables))

                (parts / "part-size").write_text(text)
                refused("box.parts/part-size: cannot use")
                (parts / "part-size").unlink()
                if "\n" not in text:
                    refused("MaxArraySize of scontrol show config: cannot use", "--part", 8, MOST=text)
                (parts / "part-size").unlink(missing_ok=True)
                self.assert_refused("--spp", self.run_script("submit.sh", "box.json", "--spp", text, "-o", "box.exr"))
                refused("--task-time: cannot use", "--task-time", text)
                if text:  # Otherwise it is not given.
                    refused("--part: cannot use", CANDELA_PART=text)
                if text not in ("", "1.5", "9999999999"):
                    refused("--speed: cannot use", CANDELA_SPEED=text)

    def test_numbers_are_decimal_whatever_they_begin_with(self):
        printed = self.submit("--part", "08", "box.json", "--spp", "010", "-o", "box.exr")
        self.assertIn(": tasks 0-1 of 8 sample(s) each", printed)
        (self.folder / "box.parts/part-0.exr").touch()
        (self.folder / "box.parts/part-size").write_text("008\n")
        printed = self.submit("--part", "8", "box.json", "--spp", "16", "-o", "box.exr", MISSING="08..16")
        self.assertIn(": tasks 1 of 8 sample(s) each", printed)

    def test_answers_of_other_programs_that_are_not_numbers_are_refused(self):
        result = self.run_script("submit.sh", "--part", 8, "box.json", "--spp", 8, "-o", "box.exr", JOB=CODE)
        self.assertEqual(result.returncode, 2)
        self.assertIn("sbatch printed", result.stderr)
        (self.folder / "box.parts/part-0.exr").touch()
        for text in ("8", "a..b", "0..8 x", f"0..{CODE}"):
            self.assert_refused("as missing samples", self.run_script(
                "submit.sh", "box.json", "--spp", 8, "-o", "box.exr", MISSING=text))
        result = self.run_script("submit.sh", "--folder", "new", "box.json", "--spp", 8, "-o", "box.exr", RATE='"x"')
        self.assertEqual(result.returncode, 2)
        self.assertIn("has no samples_per_second", result.stderr)

    def test_the_speed_is_measured(self):
        # 1000 samples a second of 100 pixels, so 600 a minute for each: 15 minutes are more than enough for 8.
        self.assertIn(": tasks 0 of 8 sample(s) each", self.submit())
        self.assertIn(": tasks 0-19 of 300 sample(s) each", self.submit(
            "--task-time", 1, "--folder", "new", "box.json", "--spp", 6000, "-o", "box.exr"))

    def test_any_name_is_handed_on_or_refused(self):
        for name in ("a,b", "50%", "%x-%j", "-o", "--spp", "two words", "*", "'\"$(touch RAN)", "ü"):
            with self.subTest(name=name):
                (self.folder / f"{name}.json").touch()
                self.submit("--part", 8, f"./{name}.json", "--spp", 8, "-o", f"{name}.exr", f"--output={name}.png")
                tasks, merge = [call.split("\n") for call in self.calls() if call.startswith("--parsable")]
                folder = str(self.folder / f"{name}.parts")
                self.assertIn(f"./{name}.json", tasks)
                self.assertIn(folder, tasks)
                safe = ("./" if name.startswith("-") else "") + name
                self.assertEqual(merge[-3:-1], [f"{safe}.exr", f"{safe}.png"])
                job = next(word for word in tasks if word.startswith("--job-name="))
                self.assertRegex(job, r"^--job-name=candela-[A-Za-z0-9._-]+$")
                logs = folder.replace("%", "%%")
                self.assertIn(f"--output={logs}/%x-%A-%a.log", tasks)
                self.assertIn(f"--output={logs}/merge.log", merge)
        for name in ("two\nlines", "back\\slash"):
            self.assert_refused("has a line feed or a backslash", self.run_script(
                "submit.sh", "box.json", "--spp", 8, "-o", f"{name}.exr"))
        self.assert_refused("a file as ./-x.json", self.run_script(
            "submit.sh", "-x.json", "--spp", 8, "-o", "box.exr"))

    def test_folders_of_one_name_have_jobs_of_their_own(self):
        names = set()
        for name in ("a/box", "b/box"):
            self.submit("--folder", name, "--part", 8, "box.json", "--spp", 8, "-o", "box.exr")
            names |= {line for call in self.calls() for line in call.split("\n") if line.startswith("--name=")}
        self.assertEqual(len(names), 2)

    def test_a_link_in_the_place_of_part_size_is_replaced(self):
        (self.folder / "box.parts").mkdir()
        (self.folder / "box.parts/part-size").symlink_to(self.folder / "other")
        self.submit("--part", 8, "box.json", "--spp", 8, "-o", "box.exr")
        self.assertFalse((self.folder / "other").exists())
        self.assertEqual((self.folder / "box.parts/part-size").read_text(), "8\n")

    def test_a_task_takes_only_numbers(self):
        def task(part=4, spp=10, **variables):
            return self.run_script("render.sbatch", "candela", "parts", part, spp, "box.json", **variables)

        self.assertEqual(task(SLURM_ARRAY_TASK_ID="2", SLURM_RESTART_COUNT="1").returncode, 0)
        self.assertIn("\n8..10\n-o\nparts/part-00000008.exr\n", self.calls()[0])
        self.assertIn("\nparts/part-00000008-1.json\n", self.calls()[0])
        for text in ("x", "", "-1", CODE):
            for result in (task(SLURM_ARRAY_TASK_ID=text), task(part=text, SLURM_ARRAY_TASK_ID="0"),
                           task(spp=text, SLURM_ARRAY_TASK_ID="0"),
                           task(SLURM_ARRAY_TASK_ID="0", SLURM_RESTART_COUNT=text or "x")):
                self.assertEqual(result.returncode, 2, text)
                self.assertIn("is not a number", result.stderr)
                self.assertEqual(self.calls(), [])


if __name__ == "__main__":
    unittest.main()
