#!/usr/bin/env python3
"""A run with two threads beside other jobs on the same cores gets its fair share of speed, or nearly.

usage: busy_test.py PROGRAM SOURCE_FOLDER [unittest options]

Two threads beside two jobs on two cores: half of the cores is theirs, so a run may take twice as long as alone. Threads
that wait for each other lose some of it whenever one of them is put aside; four times as long is allowed. Threads that
yield while the other one is put aside need ten to sixty times as long. Each time is the least of several, taken in
turn, since the machine may have more to do.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = ""
CASE = pathlib.Path()
CORES = sorted(os.sched_getaffinity(0))[:2]
BUSY = [sys.executable, "-c", "while True: pass"]


def on_two_cores(command, **options):
    return subprocess.Popen(command, preexec_fn=lambda: os.sched_setaffinity(0, CORES), **options)


def stepping_seconds(jobs):
    """How long the run's steps take beside so many jobs, s."""
    busy = [on_two_cores(BUSY) for _ in range(jobs)]
    try:
        with tempfile.TemporaryDirectory(prefix="udar-test-") as folder:
            out = pathlib.Path(folder) / "run"
            run = on_two_cores([PROGRAM, "run", str(CASE), "--threads", "2", "--output", str(out),
                                "--set", "run.end_time=0.2 ms"], stdout=subprocess.DEVNULL)
            if run.wait(timeout=300) != 0:
                raise RuntimeError("the run failed")
            return json.loads((out / "summary.json").read_text())["stepping_seconds"]
    finally:
        for job in busy:
            job.kill()
            job.wait()


@unittest.skipIf(len(CORES) < 2, "needs two cores")
class BesideOthers(unittest.TestCase):
    def test_half_of_the_fair_share_of_speed_at_least(self):
        alone, beside = [], []
        for _ in range(5):
            alone.append(stepping_seconds(0))
            beside.append(stepping_seconds(2))
        print(f"alone {min(alone):.2f} s, beside two jobs {min(beside):.2f} s", file=sys.stderr)
        fair_share = 0.5
        self.assertLessEqual(min(beside), min(alone) / (0.5 * fair_share))


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    CASE = pathlib.Path(sys.argv[2]) / "cases/short-beam/short-beam.toml"
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
