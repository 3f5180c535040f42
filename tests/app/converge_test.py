#!/usr/bin/env python3
"""Studies as a user makes them: `udar converge` and `udar sweep`.

usage: converge_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import csv
import fcntl
import json
import math
import os
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
SOURCE = pathlib.Path()

CASE = """\
[run]
end_time = "60 us"
[materials.steel]
law = "tresca"
density = "7850 kg/m^3"
young_modulus = "196 GPa"
poisson_ratio = 0.25
yield_stress = "235 MPa"
[bodies.block]
material = "steel"
velocity = ["0 m/s", "-40 m/s"]
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], at = ["-2 cm", "0 cm"], element_size = "0.5 cm" }
[obstacles.stop]
shape = "half_plane"
point = ["0 m", "0 m"]
normal = [0, 1]
friction = 0.2
[[observe.nodes]]
name = "corner"
body = "block"
at = ["-2 cm", "2 cm"]
[output]
fields_every = "20 us"
"""

# Long enough to be caught in the middle.
SLOW = ["--set", "run.end_time=5 ms", "--set", "output.fields_every=1 ms"]


class Studies(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        (self.folder / "block.toml").write_text(CASE)

    def tearDown(self):
        shutil.rmtree(self.folder)

    def run_program(self, *words, code=0):
        return run_program(self, PROGRAM, words, code)

    def study(self, name="study"):
        return json.loads((self.folder / name / "study.json").read_text())

    def rows(self):
        return list(csv.DictReader((self.folder / "study/study.csv").read_text().splitlines()))

    def converge(self, *words, code=0):
        return self.run_program("converge", "block.toml", "--output", "study", "--no-report", *words, code=code)

    def runs(self, folder="study"):
        return sorted(p.name for p in (self.folder / folder / "runs").iterdir() if p.is_dir())


def named(items, name, **others):
    found = [i for i in items if i["name"] == name and all(i[k] == v for k, v in others.items())]
    return found[-1]


class Convergence(Studies):
    def test_a_grid_of_meshes_and_steps(self):
        out, _ = self.converge("--mesh", "3", "--step", "2")
        self.assertIn("6 of 6 runs done", out)
        study = self.study()
        self.assertEqual(self.runs(), [f"mesh{i}-step{j}" for i in (1, 2, 3) for j in (1, 2)])
        self.assertEqual([run["elements"] for run in study["runs"]], [64, 64, 256, 256, 1024, 1024])
        for mesh in range(3):
            whole, half = study["runs"][2 * mesh : 2 * mesh + 2]
            self.assertAlmostEqual(whole["longest_step"] / half["longest_step"], 2, delta=0.01)
        self.assertEqual(study["element_sizes"], [0.005, 0.0025, 0.00125])
        # A number of the study is that of the run's own summary.
        touch = named(study["quantities"], "contacts.stop.duration_99")
        for run, value in zip(study["runs"], touch["values"]):
            summary = json.loads((self.folder / "study/runs" / run["name"] / "summary.json").read_text())
            self.assertEqual(summary["contacts"]["stop"]["duration_99"], value)
        self.assertEqual(touch["value"], touch["values"][-1])
        self.assertEqual(touch["mesh"]["values"], touch["values"][1::2])  # at the finer step
        self.assertEqual(touch["step"]["values"], touch["values"][4:])  # of the finest mesh
        self.assertEqual(touch["step"]["verdict"], "unknown")  # of two levels
        rows = self.rows()
        row = next(r for r in rows if r["name"] == touch["name"])
        self.assertEqual([float(row[run["name"]]) for run in study["runs"]], touch["values"])
        self.assertEqual(row["unit"], "s")
        text = (self.folder / "study/study.md").read_text()
        self.assertIn("contacts.stop.duration_99", text)
        self.assertNotIn("nan", text.lower())
        times = {field["time"] for field in study["fields"]}
        self.assertEqual(len(times), 3)

    def test_report_makes_page_and_plots_anew(self):
        self.converge("--mesh", "2", "--step", "1")
        self.assertFalse((self.folder / "study/study.html").exists())
        (self.folder / "page.html").write_text("<p><!-- the run -->")
        out, _ = self.run_program("report", "study", "--template", "page.html")
        self.assertIn("study/study.html: ", out)
        self.assertIn("study/plots: ", out)
        page = (self.folder / "study/study.html").read_text()
        text = page.split('id="run">')[1].split("</script>")[0]
        inside = json.loads(text)
        self.assertEqual(inside["study"], self.study())
        self.assertEqual([run["name"] for run in inside["runs"]], ["mesh1-step1", "mesh2-step1"])
        plot = (self.folder / "study/plots/corner.displacement_y.svg").read_text()
        self.assertIn(">5 mm<", plot)
        self.assertIn(">2.5 mm<", plot)
        self.run_program("report", "study", "--template", "page.html", "--limit", "20 kB", "--output", "small.html", code=2)
        self.assertFalse((self.folder / "small.html").exists())
        self.run_program("report", "study", "--template", "page.html", "--limit", "900 kB", "--output", "small.html")
        self.assertLessEqual((self.folder / "small.html").stat().st_size, 900_000)

    def test_what_is_done_is_not_done_again(self):
        self.converge("--mesh", "2", "--step", "1")
        summary = self.folder / "study/runs/mesh1-step1/summary.json"
        before = summary.stat().st_mtime_ns
        out, _ = self.converge("--mesh", "3", "--step", "1")
        self.assertIn("3 of 3 runs done", out)
        self.assertEqual(summary.stat().st_mtime_ns, before)
        self.converge("--mesh", "3", "--step", "1", "--force")
        self.assertNotEqual(summary.stat().st_mtime_ns, before)

    def test_what_may_spoil_a_study_is_told(self):
        # Not yet off the stop: no contact time, and nobody takes the end of the run for one.
        out, _ = self.converge("--mesh", "2", "--step", "1", "--set", "run.end_time=5 us", "--set", "output.fields_every=never")
        self.assertNotIn("contact time", out)
        names = [q["name"] for q in self.study()["quantities"]]
        self.assertIn("contacts.stop.peak_force", names)
        self.assertNotIn("contacts.stop.duration_99", names)
        out, _ = self.converge("--mesh", "1", "--step", "2", "--force", "--set", "run.time_step=5.17e-7 s",
                               "--set", "bodies.block.velocity.1=-80 m/s")
        self.assertIn("steps were shortened", out)
        self.assertGreater(self.study()["runs"][0]["shortened_steps"], 0)

    def test_another_case_is_refused(self):
        self.converge("--mesh", "2", "--step", "1")
        before = (self.folder / "study/study.json").read_text()
        _, err = self.converge("--mesh", "2", "--step", "1", "--set", "obstacles.stop.friction=0.3", code=2)
        self.assertIn("holds a run of another case", err)
        self.assertIn("--force", err)
        self.assertEqual((self.folder / "study/study.json").read_text(), before)

    def test_fixed_steps_follow_the_elements(self):
        self.converge("--mesh", "2", "--ratio", "4", "--step", "2", "--set", "run.time_step=2e-7 s")
        for name, step in (("mesh1-step1", 2e-7), ("mesh1-step2", 1e-7), ("mesh2-step1", 5e-8), ("mesh2-step2", 2.5e-8)):
            run = named(self.study()["runs"], name)
            self.assertAlmostEqual(run["longest_step"] / step, 1, delta=1e-12)

    def test_kill_loses_only_the_runs_in_flight(self):
        words = [PROGRAM, "converge", "block.toml", "--mesh", "4", "--step", "1", "--output", "study", "--no-report", *SLOW]
        with subprocess.Popen(words, cwd=self.folder, stdout=subprocess.DEVNULL, start_new_session=True) as study:
            # The costly runs come first and take longest: another one ends before.
            self.wait_for(lambda: any(self.folder.glob("study/runs/*/summary.json")))
            os.killpg(study.pid, signal.SIGKILL)
        done = {p.parent.name: p.stat().st_mtime_ns for p in self.folder.glob("study/runs/*/summary.json")}
        self.assertIn(len(done), (1, 2, 3))
        self.wait_for(self.nobody_holds_the_study)
        self.converge("--mesh", "4", "--step", "1", *SLOW)
        for name, before in done.items():
            self.assertEqual((self.folder / "study/runs" / name / "summary.json").stat().st_mtime_ns, before, name)
        self.assertEqual([run["state"] for run in self.study()["runs"]], ["done"] * 4)

    def test_nobody_else_works_in_the_folder(self):
        (self.folder / "study").mkdir()
        with (self.folder / "study/.udar-study").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            _, err = self.converge("--mesh", "2", code=2)
        self.assertIn("another udar works in", err)

    def test_ctrl_c_keeps_what_is_done(self):
        words = [PROGRAM, "converge", "block.toml", "--mesh", "4", "--step", "1", "--output", "study", "--no-report", *SLOW]
        with subprocess.Popen(words, cwd=self.folder, stdout=subprocess.PIPE) as study:
            self.wait_for(lambda: (self.folder / "study/runs/mesh4-step1/histories/energy.csv").exists())
            study.send_signal(signal.SIGINT)
            out = study.communicate(timeout=30)[0].decode()
            self.assertEqual(study.returncode, 130, out)
        self.assertIn("the same command goes on from here", out)
        self.assertFalse((self.folder / "study/study.json").exists())
        self.converge("--mesh", "4", "--step", "1", *SLOW)
        self.assertEqual([run["state"] for run in self.study()["runs"]], ["done"] * 4)
        # The run in flight went on from its checkpoint.
        summary = json.loads((self.folder / "study/runs/mesh4-step1/summary.json").read_text())
        self.assertEqual(summary["resumed"], 1)

    def test_a_level_that_fails_is_told_and_the_others_are_shown(self):
        # The energy error falls with the step: the coarsest mesh is stopped, the others are not.
        errors = [run["energy_error"] for run in self.errors_of_levels()]
        self.assertGreater(errors[0], 1.5 * errors[1])
        limit = math.sqrt(errors[0] * errors[1])
        out, _ = self.run_program("converge", "block.toml", "--mesh", "3", "--step", "1", "--output", "failing",
                                  "--no-report", "--set", f"run.stop_at_energy_error={limit}", code=5)
        self.assertIn("1 failed", out)
        self.assertIn("mesh1-step1 failed", out)
        study = self.study("failing")
        self.assertEqual([run["state"] for run in study["runs"]], ["failed", "done", "done"])
        self.assertIn("energy", study["runs"][0]["reason"])
        touch = named(study["quantities"], "contacts.stop.duration_99")
        self.assertIsNone(touch["values"][0])
        self.assertEqual(len(touch["mesh"]["values"]), 2)
        self.assertIn("failed", (self.folder / "failing/study.md").read_text())

    def errors_of_levels(self):
        self.converge("--mesh", "3", "--step", "1")
        return self.study()["runs"]

    def test_other_machines_take_the_list(self):
        out, _ = self.converge("--mesh", "2", "--step", "2", "--list")
        self.assertIn("4 commands of 4 runs", out)
        self.assertEqual(self.runs(), [])
        lines = (self.folder / "study/runs.txt").read_text().splitlines()
        path = f"{pathlib.Path(PROGRAM).parent}:{os.environ['PATH']}"
        for line in reversed(lines):
            subprocess.run(["sh", "-c", line], cwd=self.folder, env={**os.environ, "PATH": path}, check=True,
                           stdout=subprocess.DEVNULL)
        self.assertIn("0 commands of 4 runs", self.converge("--mesh", "2", "--step", "2", "--list")[0])
        before = {p: p.stat().st_mtime_ns for p in self.folder.glob("study/runs/*/summary.json")}
        self.assertEqual(len(before), 4)
        self.converge("--mesh", "2", "--step", "2")
        self.assertEqual({p: p.stat().st_mtime_ns for p in before}, before)
        self.assertEqual([run["state"] for run in self.study()["runs"]], ["done"] * 4)

    def test_histories_are_aligned_and_averaged(self):
        def change(*words):
            self.converge("--mesh", "2", "--step", "1", "--set", "bodies.block.mesh.at=[\"-2 cm\", \"0.1 mm\"]", *words)
            study = self.study()
            self.assertEqual(study["comparison"], {"aligned": "--align" in words, "window": 1e-5 if len(words) > 1 else None})
            return named(study["histories"], "stop.force_y")["mesh_l2"]["differences"][0]

        plain = change()
        self.assertLess(change("--window", "10 us"), 0.5 * plain)
        self.assertNotEqual(change("--align"), plain)

    def test_all_levels_fail(self):
        out, _ = self.converge("--mesh", "2", "--step", "2", "--set", "run.stop_at_energy_error=1e-12", code=5)
        self.assertIn("0 of 4 runs done, 4 failed", out)
        self.assertEqual(self.study()["quantities"], [])
        text = (self.folder / "study/study.md").read_text()
        self.assertIn("the energy books are", text)
        self.assertNotIn("Refining", text)

    def test_bad_words(self):
        for words, told in (
            (["--mesh", "1", "--step", "1"], "one mesh with one step"),
            (["--tolerance", "2"], "between 0 and 1"),
            (["--tolerance", "2 mm"], "--tolerance"),
            (["--window", "3 m"], "--window"),
            (["--mesh", "0"], "--mesh"),
            (["--ratio", "1"], "--ratio"),
            (["--set", "bodies.block.mesh.element_size=3 cm"], "element"),
        ):
            with self.subTest(words=words):
                run = subprocess.run([PROGRAM, "converge", "block.toml", "--output", "bad", *words], cwd=self.folder,
                                     capture_output=True, timeout=60, check=False)
                self.assertIn(run.returncode, (2, 3, 4))
                self.assertIn(told, run.stderr.decode())
                self.assertFalse((self.folder / "bad").exists())
        (self.folder / "mine").mkdir()
        (self.folder / "mine/thesis.txt").write_text("precious")
        _, err = self.run_program("converge", "block.toml", "--output", "mine", code=2)
        self.assertIn("holds files that are not a study", err)
        self.assertEqual([p.name for p in (self.folder / "mine").iterdir()], ["thesis.txt"])
        out, _ = self.converge("--mesh", "2", "--step", "1", "--show", "stop.duraton_99")
        self.assertIn("warning: no run has a number `stop.duraton_99`; did you mean `stop.duration_99`?", out)
        _, err = self.converge("--mesh", "2", "--step", "1", "--window", "60 us", code=2)
        self.assertIn("--window is as long as the run", err)

    def wait_for(self, ready):
        for _ in range(3000):
            if ready():
                return
            time.sleep(0.01)
        self.fail("it did not come")

    def nobody_holds_the_study(self):
        with (self.folder / "study/.udar-study").open("r+") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                return False
        return True


class Orders(Studies):
    """The command finds the orders that theory tells; verification/convergence/README.md."""

    def solve(self, case, *words):
        self.run_program("converge", SOURCE / "verification/convergence" / case, "--step", "1", "--output", "study",
                         "--no-report", *words)
        return self.study()

    def test_a_smooth_wave(self):
        study = self.solve("cosine-wave.toml", "--mesh", "4")
        self.assertGreaterEqual(named(study["histories"], "node.displacement_x")["mesh_l2"]["order"], 1.9)
        self.assertGreaterEqual(named(study["histories"], "element.stress_x")["mesh_l2"]["order"], 0.9)
        self.assertGreaterEqual(named(study["fields"], "displacement")["mesh_l2"]["order"], 1.9)
        self.assertGreaterEqual(named(study["fields"], "stress_x")["mesh_l2"]["order"], 0.9)
        # u = A / w sin(w t) cos(k x); the exact largest values lie within the error bars.
        wave_number = 2 * math.pi / 0.4
        modulus = 200e9 * 0.7 / (1.3 * 0.4)
        amplitude = 0.01 / (math.sqrt(modulus / 7850) * wave_number)
        for name, exact in (
            ("histories.node.displacement_x.max_abs", amplitude * math.cos(wave_number * 0.04)),
            ("histories.element.stress_x.max_abs", modulus * amplitude * wave_number * math.sin(wave_number * 0.04)),
        ):
            q = named(study["quantities"], name)
            self.assertLessEqual(abs(q["value"] - exact), q["mesh"]["error"], name)
            self.assertLess(abs(q["mesh"]["extrapolated"] - exact), 0.3 * abs(q["value"] - exact), name)

    def test_a_jump(self):
        study = self.solve("bar-on-wall.toml", "--mesh", "5")
        self.assertAlmostEqual(named(study["fields"], "displacement")["mesh_l2"]["order"], 1, delta=0.2)
        self.assertAlmostEqual(named(study["fields"], "stress_x")["mesh_l2"]["order"], 1 / 3, delta=0.1)


class Sweeps(Studies):
    def sweep(self, *words, code=0):
        return self.run_program("sweep", "block.toml", "--output", "study", "--no-report", *words, code=code)

    def test_every_combination(self):
        self.sweep("--vary", "obstacles.stop.friction=0:0.4:0.2", "--vary", "materials.steel.yield_stress=235 MPa,400 MPa")
        study = self.study()
        self.assertEqual(study["varied"], ["obstacles.stop.friction", "materials.steel.yield_stress"])
        self.assertEqual([run["values"] for run in study["runs"]],
                         [[f, y] for f in (0, 0.2, 0.4) for y in (235e6, 400e6)])
        rows = self.rows()
        self.assertEqual([row["obstacles.stop.friction"] for row in rows], ["0", "0", "0.2", "0.2", "0.4", "0.4"])
        for row in rows:
            summary = json.loads((self.folder / "study/runs" / row["run"] / "summary.json").read_text())
            self.assertEqual(float(row["ledger.plastic [J]"]), summary["ledger"]["plastic"])
        # More yield stress, less flow.
        plastic = [float(row["ledger.plastic [J]"]) for row in rows]
        for weak, strong in zip(plastic[::2], plastic[1::2]):
            self.assertGreater(weak, strong)
        self.assertIn("| run-1 | 0 | 235 MPa |", (self.folder / "study/study.md").read_text())

    def test_words_and_vectors(self):
        self.sweep("--vary", 'bodies.block.velocity=["0 m/s", "-20 m/s"],["5 m/s", "-40 m/s"]', "--vary",
                   "bodies.block.mesh.diagonals=right,crossed")
        study = self.study()
        self.assertEqual([run["state"] for run in study["runs"]], ["done"] * 4)
        self.assertEqual([run["texts"][1] for run in study["runs"]], ["right", "crossed"] * 2)
        self.assertEqual(study["runs"][0]["values"], [None, None])

    def test_bad_words(self):
        for vary, told in (
            ("obstacles.stop.friction", "does not say what to vary"),
            ("obstacles.stop.friction=", "an empty value"),
            ("obstacles.stop.friction=0.1,,0.2", "an empty value"),
            ("obstacles.stop.friction=0.1,0.1", "twice"),
            ("obstacles.stop.friction=0:1:-0.1", "no end"),
            ("obstacles.stop.fricton=0.1,0.2", "did you mean `friction`?"),
            ("obstacles.stop.friction=0.1,lots", "friction"),
            ("obstacles.stop.friction=0:1:1e-9", "has more than 10000 values"),
            ("bodies.block.thickness=1:2 cm", "is no range"),
        ):
            with self.subTest(vary=vary):
                run = subprocess.run([PROGRAM, "sweep", "block.toml", "--output", "bad", "--vary", vary],
                                     cwd=self.folder, capture_output=True, timeout=60, check=False)
                self.assertIn(run.returncode, (2, 3))
                self.assertIn(told, run.stderr.decode())
                self.assertFalse((self.folder / "bad").exists())


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv[1])
    SOURCE = pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
