#!/usr/bin/env python3
"""Renders a scene on a cluster of Slurm's own daemons, two nodes on this computer, while tasks are killed and a node is
drained.   usage: slurm_test.py CANDELA"""
import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from cluster import PROGRAMS, Cluster, wait_until

CANDELA = os.path.abspath(sys.argv.pop(1))
ROOT = Path(__file__).resolve().parents[2]
SUBMIT = ROOT / "integrations/slurm/submit.sh"
SCENE = ROOT / "scenes/cornell-box.json"
NAME = "%x, 50%"  # Of the picture; Slurm replaces %x in names of logs, and has lists with commas.
ACTIVE = ("PENDING", "CONFIGURING", "RUNNING", "COMPLETING", "REQUEUED")  # States of a job that has not ended.


class Slurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="candela-", dir="/tmp")))
        cls.cluster = cls.enterClassContext(Cluster(folder))

    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="candela-", dir="/tmp")))
        self.parts = self.folder / f"{NAME}.parts"

    def candela(self, *arguments):
        return subprocess.run([CANDELA, *map(str, arguments)], capture_output=True, text=True, check=True).stdout

    def submit(self, part, spp, size, candela=CANDELA, check=True):
        """Submits a picture; returns what that prints, and the numbers of the jobs."""
        # On one thread of the CPU a task takes seconds, so that it can be ended midway.
        printed = self.cluster.run(
            SUBMIT, "--part", part, SCENE, "--spp", spp, "--size", size, "-o", self.folder / f"{NAME}.exr",
            "-o", self.folder / f"{NAME}.png", "--checkpoint-every", "0.1s", "--device", "llvmpipe",
            check=check, CANDELA=str(candela), LP_NUM_THREADS="1")
        return printed, [line.split()[1].rstrip(":") for line in printed.splitlines() if line.startswith("Job ")]

    def drain(self):
        """Lets no job begin until the test ends, and cancels its jobs then."""
        self.addCleanup(self.cluster.set_nodes, "n1,n2", "RESUME")
        self.addCleanup(self.cluster.run, "scancel", "--me")
        self.cluster.set_nodes("n1,n2", "DRAIN")

    def end_of(self, job):
        wait_until(f"the end of job {job}", lambda: self.cluster.state(job) not in ACTIVE)
        return self.cluster.state(job)

    def merge_log(self):
        return (self.parts / "merge.log").read_text()

    def running_task(self, part):
        """(job, first sample, process) of a running task that has written a checkpoint."""
        for line in self.cluster.run("squeue", "--noheader", "--states=R", "--array", "--format=%i %K").splitlines():
            job, index = line.split()
            if "_" not in job:
                continue
            first = int(index) * part
            if (self.parts / f"part-{first:08}.state").exists():
                for process in Path("/proc").glob("[0-9]*"):
                    with contextlib.suppress(OSError):
                        words = (process / "cmdline").read_bytes().split(b"\0")
                        if words[0] == os.fsencode(CANDELA) and f"{first}..{first + part}".encode() in words:
                            return job, first, int(process.name)
        return None

    def end_in_the_middle(self, part, end):
        """Ends a task by end(job, process), and has Slurm run it again; returns its first sample."""
        while True:  # A task may come to its own end before that.
            job, first, process = wait_until("a task in its middle", lambda: self.running_task(part))
            end(job, process)
            if self.end_of(job) == "FAILED":
                self.cluster.run("scontrol", "requeue", job)
                return first

    def reports(self, first):
        return [json.loads(path.read_text()) for path in sorted(self.parts.glob(f"part-{first:08}-*.json"))]

    def test_tasks_that_are_ended_and_a_node_that_is_drained_cost_no_sample(self):
        part, spp, size = 24, 192, "224x224"
        # The merge waits for the last task, so that none that failed is taken for ended before it is run again.
        self.cluster.set_nodes("n1,n2", "DRAIN")
        _, (tasks, merge) = self.submit(part, spp, size)
        self.cluster.run("scontrol", "hold", f"{tasks}_{spp // part - 1}")
        self.cluster.set_nodes("n1,n2", "RESUME")

        def kill(_, process):
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)

        def terminate(job, _):  # The batch script alone gets the signal, which is the program by then.
            self.cluster.run("scancel", "--batch", "--signal=TERM", job, check=False)

        killed = self.end_in_the_middle(part, kill)
        ended = self.end_in_the_middle(part, terminate)
        self.cluster.set_nodes("n2", "DRAIN")
        wait_until("a drained node", lambda: "drained" in self.cluster.run(
            "sinfo", "--noheader", "--nodes=n2", "--format=%T"))
        self.cluster.set_nodes("n2", "RESUME")
        self.cluster.run("scontrol", "release", f"{tasks}_{spp // part - 1}")
        self.assertEqual(self.end_of(merge), "COMPLETED", self.merge_log())
        self.assertIn("merged 8 parts: samples 0..192\n", self.merge_log())
        self.assertTrue((self.folder / f"{NAME}.png").exists())

        # The picture of one run, but for the rounding that merge promises: 3 units of 2^-24 in every mean.
        self.candela("render", SCENE, "--spp", spp, "--size", size, "-o", self.folder / "one.exr", "--quiet")
        self.candela("compare", self.folder / f"{NAME}.exr", self.folder / "one.exr", "--relmse", (3 * 2**-24) ** 2)
        for first in (killed, ended):  # A task that went on has the bits of one that was never ended.
            alone = self.candela("render", SCENE, "--samples", f"{first}..{first + part}", "--size", size,
                                 "-o", self.folder / "alone.exr", "--quiet", "--report", "-")
            self.assertEqual(self.reports(first)[-1]["image_hash"], json.loads(alone)["image_hash"])

        # No sample was rendered twice that a report or a checkpoint knows of.
        samples = 224 * 224 * part
        for first in range(0, spp, part):
            rendered = [report["rendered_samples"] for report in self.reports(first)]
            self.assertEqual(len(rendered), 2 if first == ended else 1)
            if first == killed:  # What was before the checkpoint has no report.
                self.assertLess(rendered[0], samples)
            else:
                self.assertEqual(sum(rendered), samples)

    def test_what_failed_is_submitted_by_the_same_command(self):
        failing = self.folder / "failing"
        failing.write_text(f'#!/bin/sh\ncase $* in *"render "*" 4..8 "*) exit 4 ;; esac\nexec {CANDELA} "$@"\n')
        failing.chmod(0o755)
        _, (_, merge) = self.submit(4, 14, "32x32", candela=failing)
        self.assertEqual(self.end_of(merge), "FAILED")
        self.assertIn("Nothing was merged. These samples are missing; the same submit.sh again submits them: 4..8\n",
                      self.merge_log())
        printed, (_, merge) = self.submit(4, 14, "32x32")
        self.assertIn(": tasks 1 of 4 sample(s) each\n", printed)
        self.assertEqual(self.end_of(merge), "COMPLETED", self.merge_log())
        self.assertIn("merged 4 parts: samples 0..14\n", self.merge_log())

        # More samples: the last task was not whole. Nothing missing: the merge alone.
        printed, (_, merge) = self.submit(4, 20, "32x32")
        self.assertIn(": tasks 3-4 of 4 sample(s) each\n", printed)
        self.assertEqual(self.end_of(merge), "COMPLETED", self.merge_log())
        self.assertIn("merged 5 parts: samples 0..20\n", self.merge_log())
        _, (merge,) = self.submit(4, 20, "32x32")
        self.assertEqual(self.end_of(merge), "COMPLETED", self.merge_log())

        # A part that cannot be read is missing, with its checkpoint and without.
        for part in (self.parts / "part-00000004.exr", self.parts / "part-00000012.exr"):
            os.truncate(part, part.stat().st_size - 1)
        (self.parts / "part-00000012.state").unlink()
        printed, (_, merge) = self.submit(4, 20, "32x32")
        self.assertIn(": tasks 1,3 of 4 sample(s) each\n", printed)
        self.assertEqual(self.end_of(merge), "COMPLETED", self.merge_log())
        self.assertEqual(self.merge_log().count("merged 5 parts: samples 0..20\n"), 3, self.merge_log())

    def test_a_part_is_what_half_of_the_time_allows(self):
        def submitted(*options):
            return self.cluster.run(SUBMIT, "--folder", self.folder / str(len(options)), *options, SCENE, "--spp", 14,
                                    "--size", "16x16", "-o", self.folder / "a.exr", CANDELA=CANDELA)

        self.drain()
        self.assertIn(": tasks 0-2 of 6 sample(s) each\n", submitted("--speed", "3", "--task-time", "4"))
        printed = submitted()  # Within five seconds, this computer renders more of so small a picture.
        self.assertIn("Measuring the speed of this machine", printed)
        self.assertIn(": tasks 0 of 14 sample(s) each\n", printed)

    def test_what_makes_no_sense_is_refused(self):
        def refusal(*arguments):
            result = subprocess.run([SUBMIT, *map(str, arguments)], env=self.cluster.environment | {"CANDELA": CANDELA},
                                    cwd=self.folder, capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 2, result.stdout)
            return result.stderr

        self.assertIn("--spp is missing", refusal(SCENE, "-o", "a.exr"))
        self.assertIn("no output given", refusal(SCENE, "--spp", 4))
        self.assertIn('--spp: cannot use "0"', refusal(SCENE, "--spp", 0, "-o", "a.exr"))
        self.assertIn('--part: cannot use "x"', refusal("--part", "x", SCENE, "--spp", 4, "-o", "a.exr"))
        self.assertIn("--adaptive is not for parts", refusal(SCENE, "--adaptive", "--spp", 4, "-o", "a.exr"))
        self.assertIn("no.json does not exist", refusal("no.json", "--spp", 4, "-o", "a.exr"))
        self.assertIn("--spp is not an option of submit.sh", refusal("--spp", 4, SCENE))
        self.assertIn("2000 tasks of 1 sample(s) are more than Slurm allows",
                      refusal("--part", 1, SCENE, "--spp", 2000, "-o", "a.exr"))
        # While jobs of a picture wait, it is not submitted once more.
        self.drain()
        _, jobs = self.submit(4, 8, "32x32")
        self.assertIn("jobs of this picture are still in the queue: " + " ".join(jobs),
                      refusal("--folder", self.parts, SCENE, "--spp", 8, "-o", "a.exr"))


if __name__ == "__main__":
    absent = [program for program in PROGRAMS if shutil.which(program) is None]
    if absent:
        print(f"skipped: {', '.join(absent)} not installed (packages slurm-wlm and munge)")
        sys.exit()
    unittest.main()
