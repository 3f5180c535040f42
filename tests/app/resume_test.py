#!/usr/bin/env python3
"""`udar resume` as a user meets it. That it gives the same bits is tried in tests/simulation and tests/reliability.

usage: resume_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from program import run_program

PROGRAM = ""

CASE = """\
[run]
end_time = "0.3 s"
[materials.rubber]
law = "elastic"
density = "1000 kg/m^3"
young_modulus = "1 GPa"
poisson_ratio = 0.3
[bodies.block]
material = "rubber"
velocity = ["0 m/s", "-1 m/s"]
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], at = ["-2 cm", "1 cm"], element_size = "0.5 cm" }
[obstacles.floor]
shape = "half_plane"
point = ["0 m", "0 m"]
normal = [0, 1]
"""


class Resume(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory(prefix="udar-resume-")
        self.folder = pathlib.Path(self.scratch.name)
        (self.folder / "a.toml").write_text(CASE)

    def tearDown(self):
        self.scratch.cleanup()

    def udar(self, *words, code=0):
        return run_program(self, PROGRAM, words, code)

    def interrupted(self, *more, sent=signal.SIGINT):
        """A run that was stopped on its way."""
        process = subprocess.Popen([PROGRAM, "run", "a.toml", "--no-report", "--output", "r", *more], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        process.stdout.readline()
        process.send_signal(sent)
        out = process.communicate()[0]
        self.assertEqual(process.returncode, 128 + sent, out)
        return out

    def test_goes_on_and_says_so(self):
        out = self.interrupted()
        self.assertIn("it can go on from here: udar resume r", out)
        out, _ = self.udar("resume", "r")
        self.assertRegex(out, r"a: 64 elements, 45 nodes, from step \d+ on -> r")
        summary = json.loads((self.folder / "r/summary.json").read_text())
        self.assertEqual((summary["stop_reason"], summary["resumed"], summary["case_name"]), ("end_time", 1, "a"))
        self.assertTrue((self.folder / "r/report.html").exists())
        self.assertFalse((self.folder / "r/checkpoint_a.bin").exists())
        self.assertIn("taken up again at step", (self.folder / "r/log.txt").read_text())
        out, _ = self.udar("resume", "r")
        self.assertIn("r: the run is complete, there is nothing to resume", out)

    def test_hung_up(self):
        self.interrupted(sent=signal.SIGHUP)
        self.udar("resume", "r", "--no-report", "--threads", 2)
        self.assertFalse((self.folder / "r/report.html").exists())

    def test_not_where_there_is_none(self):
        self.interrupted("--set", 'output.checkpoint="never"')
        _, err = self.udar("resume", "r", code=8)
        self.assertIn("there is no checkpoint in `r`", err)
        self.assertIn("udar run r/resolved.toml --output r --force", err)
        _, err = self.udar("resume", "nowhere", code=2)
        self.assertIn("`nowhere` is not there", err)
        (self.folder / "empty").mkdir()
        _, err = self.udar("resume", "empty", code=2)
        self.assertIn("is not the folder of a run", err)

    def test_damage(self):
        self.interrupted()
        for name in ["checkpoint_a.bin", "checkpoint_b.bin"]:
            (self.folder / "r" / name).write_bytes(b"udar checkpoint 1\n")
        before = {p: p.read_bytes() for p in (self.folder / "r").rglob("*") if p.is_file()}
        _, err = self.udar("resume", "r", code=8)
        self.assertIn("r/checkpoint_a.bin cannot be used: it was cut off", err)
        self.assertEqual(before, {p: p.read_bytes() for p in (self.folder / "r").rglob("*") if p.is_file()})

    def test_not_another_case(self):
        self.interrupted()
        path = self.folder / "r/resolved.toml"
        text = path.read_text()
        path.write_text(text.replace("1000", "1001"))
        _, err = self.udar("resume", "r", code=8)
        self.assertIn("r/resolved.toml is not the case that was running", err)
        path.write_text(text)
        shutil.rmtree(self.folder / "r/histories")
        _, err = self.udar("resume", "r", code=8)
        self.assertIn("checkpoint_a.bin cannot be used: cannot open r/histories/", err)

    def test_not_a_run_that_is_under_way(self):
        words = ["run", "a.toml", "--no-report", "--output", "r", "--set", "run.end_time=1 h", "--set",
                 'output.checkpoint="1 ms"']
        process = subprocess.Popen([PROGRAM, *words], cwd=self.folder, stdout=subprocess.PIPE)
        try:
            while not (self.folder / "r/checkpoint_a.bin").exists():
                time.sleep(0.01)
            for words in [["resume", "r"], ["run", "a.toml", "--output", "r"], ["run", "a.toml", "--output", "r", "--force"]]:
                _, err = self.udar(*words, code=2)
                self.assertIn("a run that is under way writes to `r`", err)
        finally:
            process.kill()
            process.communicate()

    def test_a_run_that_failed_would_fail_again(self):
        self.udar("run", "a.toml", "--no-report", "--output", "r", "--set", "bodies.block.velocity=[\"0 m/s\", \"-5 km/s\"]", "--set",
                  "run.stop_at_energy_error=1e-6", code=5)
        _, err = self.udar("resume", "r", code=5)
        self.assertIn("the run in `r` failed: it would fail again", err)
        self.assertIn("log.txt", err)

    def test_without_the_frames(self):
        self.interrupted("--set", 'output.fields_every="1 ms"')
        shutil.rmtree(self.folder / "r/fields")
        self.udar("resume", "r", "--no-report")
        self.assertTrue(any((self.folder / "r/fields").iterdir()))

    def test_bad_interval(self):
        for value in ["0 s", "often", "5 m"]:
            _, err = self.udar("run", "a.toml", "--set", f'output.checkpoint="{value}"', code=3)
            self.assertIn("output.checkpoint", err)
        _, err = self.udar("resume", code=2)
        self.assertIn("the folder of a run is needed", err)


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    del sys.argv[1:3]
    unittest.main()
