#!/usr/bin/env python3
"""The program `udar` as a user meets it: commands, messages, exit codes, folders, signals, full disks.

usage: app_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import json
import os
import pathlib
import pty
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from program import has_address_sanitizer, run_program

PROGRAM = ""
SHORT_BEAM = pathlib.Path()
VIEWER = False  # whether the program was built with the viewer

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
thickness = "1 cm"
velocity = ["0 m/s", "-80 m/s"]
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], at = ["-2 cm", "0 cm"], element_size = "0.5 cm" }
[obstacles.stop]
shape = "half_plane"
point = ["0 m", "0 m"]
normal = [0, 1]
friction = 0.35
[output]
fields_every = "30 us"
"""
WHOLE = {".udar-run", "case.toml", "resolved.toml", "version.txt", "summary.json", "log.txt", "setup.svg", "final.svg",
         "fields.pvd", "fields", "histories"}


class Program(unittest.TestCase):
    """A new folder for each test, in which the program runs."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="udar-test-")
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.write("block.toml", CASE)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def udar(self, *words, code=0, **options):
        return run_program(self, PROGRAM, words, code, **options)

    def summary(self, run):
        return json.loads((self.folder / run / "summary.json").read_text())

    def names(self, run):
        return {path.name for path in (self.folder / run).iterdir()}


class CommandLine(Program):
    def test_help(self):
        out, _ = self.udar("--help")
        self.assertIn("udar run cases/short-beam/short-beam.toml", out)
        self.assertIn("Exit codes", out)
        for command, word in {"run": "--output", "check": "--set", "report": "--limit", "keys": "udar keys friction",
                              "plot": "--from", "picture": "--times", "movie": "--fps", "diff": "--within"}.items():
            self.assertIn(command, out)
            text, _ = self.udar(command, "--help")
            self.assertIn("Example", text)
            self.assertIn(word, text)
            self.assertLessEqual(max(map(len, text.splitlines())), 110)

    def test_version(self):
        self.assertRegex(self.udar("--version")[0], r"^udar \d+\.\d+\.\d+ ")

    def test_wrong_commands(self):
        for words, message, cure in [
            ([], "a command is needed: run, resume, check, converge, sweep, diff, report, plot, picture, movie, keys or verify", "udar --help"),
            (["rnu", "block.toml"], "`rnu` is no command", "did you mean `run`?"),
            (["frobnicate"], "`frobnicate` is no command", "write run, resume, check, converge, sweep, diff, report, plot, picture, movie, keys or verify"),
            (["run"], "a case file is needed", "`udar run --help`"),
            (["report"], "the folder of a run is needed", "`udar report --help`"),
            (["report", "runs", "--frames", "1"], "--frames", "`udar report --help`"),
            (["report", "runs", "--limits=5"], "`--limits=5` is not understood", "did you mean `--limit`?"),
            (["report", "nowhere"], "`nowhere` is not there", "runs/short-beam"),
            (["report", "."], "is not the folder of a run", "runs/short-beam"),
            (["report", ".", "--limit", "many"], "`--limit many` is no size of a file", "25 MB"),
            (["report", ".", "--limit", "-1 MB"], "is no size of a file", "25 MB"),
            (["run", "block.toml", "--ouput", "x"], "`--ouput` is not understood", "did you mean `--output`?"),
            (["check", "block.toml", "--sett=a=b"], "`--sett=a=b` is not understood", "did you mean `--set`?"),
            (["run", "block.toml", "other.toml"], "`other.toml` is not understood", "`udar run --help`"),
            (["run", "block.toml", "--threads", "0"], "--threads", "`udar run --help`"),
            (["run", "block.toml", "--threads", "many"], "--threads", "`udar run --help`"),
            (["run", "block.toml", "--set"], "--set", "`udar run --help`"),
        ]:
            with self.subTest(words):
                out, err = self.udar(*words, code=2)
                self.assertEqual(out, "")
                self.assertTrue(err.startswith("error: "), err)
                self.assertIn(message, err)
                self.assertIn(cure, err)
        self.assertEqual(self.names("."), {"block.toml"})

    def test_keys(self):
        out, _ = self.udar("keys", "friction")
        self.assertIn("obstacles.NAME.friction", out)
        self.assertNotIn("end_time", out)
        self.assertGreater(len(self.udar("keys")[0].splitlines()), 100)


class BadCases(Program):
    def refused(self, name, code=3, words=()):
        out, err = self.udar("run", name, *words, code=code)
        self.assertEqual(out, "")
        self.assertTrue(err.endswith("nothing was run\n"), err)
        self.assertFalse((self.folder / "runs").exists())
        return err

    def test_unknown_key_with_line_and_caret(self):
        self.write("bad.toml", CASE.replace("yield_stress", "yeild_stress"))
        err = self.refused("bad.toml")
        self.assertIn("--> bad.toml:8:1\n", err)
        lines = err.splitlines()
        source = next(k for k, line in enumerate(lines) if "yeild_stress = " in line)
        self.assertEqual(lines[source + 1].index("^"), lines[source].index("yeild_stress"))
        self.assertIn("did you mean `yield_stress`?", err)

    def test_every_mistake_at_once(self):
        self.write("bad.toml", CASE.replace('"60 us"', '"60 mm"').replace('"-80 m/s"', '"-80"'))
        err = self.refused("bad.toml")
        self.assertIn("bad.toml:2:", err)
        self.assertIn("bad.toml:12:", err)
        self.assertIn("2 errors", err)

    def test_no_case_file(self):
        (self.folder / "folder.toml").mkdir()
        (self.folder / "binary.toml").write_bytes(bytes(range(256)) * 50)
        self.write("empty.toml", "")
        for name in ["missing.toml", "folder.toml", "binary.toml", "empty.toml", "missing/case.toml"]:
            with self.subTest(name):
                self.assertIn("error: ", self.refused(name))

    def test_errors_of_set_name_it(self):
        for assignment in ["bodies.block.thicknes=1 cm", "bodies.block.thickness=1 s", "nonsense"]:
            with self.subTest(assignment):
                err = self.refused("block.toml", words=["--set", assignment])
                self.assertIn("--set", err)
                self.assertIn(assignment, err)

    def test_step_above_the_stable_limit(self):
        for what in ["shorten", "stop", "continue"]:
            err = self.refused("block.toml", words=["--set", "run.time_step=1 ms", "--set", f"run.when_unstable={what}"])
            self.assertIn("above the stable limit", err)

    def test_warnings_do_not_stop(self):
        self.write("doubtful.toml", CASE + '[materials.unused]\nlaw = "elastic"\ndensity = "1 kg/m^3"\n'
                   'young_modulus = "1 MPa"\npoisson_ratio = 0\n')
        out, err = self.udar("check", "doubtful.toml")
        self.assertTrue(err.startswith("warning: "), err)
        self.assertIn("0 errors, 1 warning; nothing was run", out)


class Check(Program):
    def test_tells_all_and_writes_nothing(self):
        out, err = self.udar("check", "block.toml")
        self.assertEqual(err, "")
        for pattern in [
            r"block: 0\.0628 kg, 64 elements, 45 nodes\n",
            r"tresca, 7850 kg/m\^3, pressure waves 5473\.\d+ m/s, shear waves 3160\.\d+ m/s\n",
            r"stop: half_plane, friction 0\.35, springs of .* at each of 24 outer nodes\n",
            r"time step  .* automatic; stable up to .* ns, limited by block element \d+",
            r"steps      \d+, more as elements deform\n",
            r"memory     about .* MB\n",
            r"time       about .* s with 1 thread, and what writing the fields takes\n",
            r"0 errors, 0 warnings; nothing was run\n$",
        ]:
            self.assertRegex(out, pattern)
        self.assertEqual(self.names("."), {"block.toml"})

    def test_tells_how_bodies_touch(self):
        second = ('[bodies.lid]\nmaterial = "steel"\nmesh = { shape = "rectangle", size = ["4 cm", "1 cm"], '
                  'at = ["0 cm", "5 cm"], element_size = "5 mm" }\n'
                  '[[contact.pairs]]\nbody = "lid"\nother = "block"\nfriction = 0.1\n')
        self.write("two.toml", CASE + second)
        out, _ = self.udar("check", "two.toml")
        self.assertIn("contact    of all bodies with each other and themselves: friction 0, springs as stiff as", out)
        self.assertIn("block: with lid: friction 0.1", out)

    def test_is_right_about_memory(self):
        if has_address_sanitizer(PROGRAM):
            self.skipTest("the sanitizer keeps memory of its own")
        # 102 400 elements, and more frames than may wait for the disk.
        words = ["block.toml", "--set", "bodies.block.mesh.element_size=0.0125 cm", "--set", "output.fields_every=50 ns"]
        out, _ = self.udar("check", *words)
        told = float(re.search(r"memory     about (.*) MB", out)[1])
        run = subprocess.Popen([PROGRAM, "run", *words, "--set", "run.end_time=0.5 us", "--output", "out"],
                               cwd=self.folder, stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(run.pid, 0)
        run.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(run.returncode, 0)
        self.assertAlmostEqual(told, 1.024e-3 * usage.ru_maxrss, delta=0.1 * told)

    def test_is_right_about_steps(self):
        words = ["--set", "run.time_step=0.1 us"]
        out, _ = self.udar("check", "block.toml", *words)
        self.assertRegex(out, r"steps      600\n")
        self.assertRegex(out, r"time step  100 ns fixed; stable up to ")
        self.udar("run", "block.toml", *words, "--output", "out")
        self.assertEqual(self.summary("out")["steps"], 600)

    def test_says_how_fast_an_unstable_integrator_grows(self):
        out, _ = self.udar("check", "block.toml", "--set", "run.integrator=adams2", "--set", "run.time_step=0.2 us",
                           "--set", "run.when_unstable=continue")
        self.assertRegex(out, r"adams2 is never stable: the stiffest vibration grows by [\d.]+ % in each step")

    def test_supports_loads_and_observers(self):
        self.write("more.toml", CASE + """
[supports.hand]
body = "block"
nodes = { side = "left" }
move_x = "0 m"
[loads.air]
body = "block"
edges = { side = "top" }
pressure = "1 MPa"
[[observe.nodes]]
name = "corner"
body = "block"
at = ["2 cm", "2 cm"]
""")
        out, _ = self.udar("check", "more.toml")
        self.assertIn("hand: 5 nodes, x given", out)
        self.assertIn("air: 1 MPa on 8 edges", out)
        self.assertIn("observed   corner", out)


class Run(Program):
    def test_leaves_a_whole_folder(self):
        out, err = self.udar("run", "block.toml")
        self.assertEqual(err, "")
        self.assertEqual(self.names("runs/block"), WHOLE)
        self.assertEqual((self.folder / "runs/block/case.toml").read_text(), CASE)
        summary = self.summary("runs/block")
        self.assertEqual(summary["schema"], 1)
        self.assertEqual(summary["stop_reason"], "end_time")
        self.assertEqual(summary["case_name"], "block")
        self.assertIn(f"verdict: {summary['verdict']} ", out)
        self.assertIn("-> runs/block/report.html\n" if VIEWER else "-> runs/block\n", out)
        self.assertIn("look at report.html in a browser" if VIEWER else "no report.html: the page needs the viewer", out)
        self.assertIn("fields.pvd in ParaView", out)
        self.assertNotIn("\r", out)
        self.assertNotIn("\x1b", out)
        self.assertLessEqual(max(map(len, out.splitlines())), 130)
        self.assertEqual(sum(line.split()[:1] == ["step"] for line in out.splitlines()), 1)

    def test_without_a_report(self):
        for words in [["--no-report"], ["--set", "output.report=false"]]:
            out, _ = self.udar("run", "block.toml", "--force", *words)
            self.assertEqual(self.names("runs/block"), WHOLE - {"report.html"})
            self.assertIn("-> runs/block\n", out)
            self.assertIn("look at final.svg in a browser", out)
            self.assertNotIn("report.html", out)

    def test_summary_keeps_its_names(self):
        self.udar("run", "block.toml")
        summary = self.summary("runs/block")
        for name in ["elements", "nodes", "steps", "threads", "wall_seconds", "element_steps_per_second", "end_time",
                     "energy_error", "momentum_error", "spin_error", "identity_error", "verdict", "reasons", "stop_reason"]:
            self.assertIn(name, summary)
        for name in ["min", "max", "max_abs", "last"]:
            self.assertIn(name, summary["histories"]["block"]["velocity_y"])
        contact = summary["contacts"]["stop"]
        for name in ["first_touch", "last_separation", "duration", "duration_99", "impulse", "peak_force"]:
            self.assertIn(name, contact)
        for name in ["first_touch", "separation", "duration", "impulse", "peak_force", "velocity_before",
                     "velocity_after", "restitution"]:
            self.assertIn(name, contact["episodes"][0])

    def test_of_many_contacts_shows_the_hardest(self):
        row = "".join(f"""
[bodies.b{k:02}]
material = "steel"
velocity = ["{-k} m/s", "0 m/s"]
mesh = {{ shape = "rectangle", size = ["1 cm", "1 cm"], at = ["{k * 1.0001} cm", "0 cm"], element_size = "5 mm" }}
""" for k in range(24))
        case = CASE[:CASE.index("[bodies.block]")] + row
        self.write("row.toml", case.replace("60 us", "20 us"))
        out, _ = self.udar("run", "row.toml")
        contacts = self.summary("runs/row")["contacts"]
        self.assertEqual(len(contacts), 23)
        hardest = sorted(contacts, key=lambda name: -contacts[name]["peak_force"])
        rows = [line.split()[0] for line in out.splitlines() if line.startswith("b") and "/" in line.split()[0]]
        self.assertEqual(rows, sorted(hardest[:20]))
        self.assertIn("and 3 with less force, all in summary.json\n", out)

    def test_warns_of_deep_penetration(self):
        out, _ = self.udar("run", "block.toml", "--set", "obstacles.stop.stiffness=1e8 N/m")
        summary = self.summary("runs/block")
        self.assertGreater(summary["penetration_ratio"], 0.05)
        [warning] = summary["warnings"]
        self.assertIn("a node of body `block` sank into obstacle `stop` by", warning)
        self.assertIn("give [obstacles.stop] a larger `stiffness`", warning)
        self.assertIn(f"verdict: {summary['verdict']} (1 warning) ", out)
        self.assertIn(f"  warning: {warning}\n", out)
        self.assertIn(f"  warning: {warning}\n", (self.folder / "runs/block/log.txt").read_text())

    def test_never_replaces_unasked(self):
        self.udar("run", "block.toml")
        first = (self.folder / "runs/block/summary.json").read_bytes()
        self.udar("run", "block.toml")
        out, _ = self.udar("run", "block.toml")
        self.assertEqual(self.names("runs"), {"block", "block-2", "block-3"})
        self.assertIn("-> runs/block-3", out)
        self.assertEqual((self.folder / "runs/block/summary.json").read_bytes(), first)

    def test_force(self):
        self.udar("run", "block.toml", "--output", "here")
        _, err = self.udar("run", "block.toml", "--output", "here", code=2)
        self.assertIn("--force", err)
        self.udar("run", "block.toml", "--output", "here", "--force", "--set", "run.end_time=10 us")
        self.assertAlmostEqual(self.summary("here")["end_time"], 1e-5)
        self.udar("run", "block.toml", "--force")
        self.udar("run", "block.toml", "--force")
        self.assertEqual(self.names("runs"), {"block"})

    def test_force_does_not_touch_what_is_not_ours(self):
        (self.folder / "mine").mkdir()
        self.write("mine/thesis.tex", "years of work")
        _, err = self.udar("run", "block.toml", "--output", "mine", "--force", code=2)
        self.assertIn("not the results of a run", err)
        self.assertEqual(self.names("mine"), {"thesis.tex"})

    def test_set(self):
        self.udar("run", "block.toml", "--set", 'bodies.block.mesh.element_size="1 cm"', "--set", "run.end_time=20 us")
        summary = self.summary("runs/block")
        self.assertEqual(summary["elements"], 16)
        self.assertAlmostEqual(summary["end_time"], 2e-5)
        self.assertIn("--set 'run.end_time=20 us'", (self.folder / "runs/block/log.txt").read_text())

    def test_threads_change_nothing(self):
        size = ["--set", "bodies.block.mesh.element_size=1 mm", "--set", "run.end_time=5 us"]
        for threads in [1, 3]:
            self.udar("run", "block.toml", *size, "--threads", threads, "--output", f"t{threads}")
            self.assertEqual(self.summary(f"t{threads}")["threads"], threads)
        for name in ["histories/block.csv", "histories/energy.csv", "fields/bodies_000001.vtu"]:
            self.assertEqual((self.folder / "t1" / name).read_bytes(), (self.folder / "t3" / name).read_bytes())

    def test_strange_names(self):
        for name in ["a b.toml", "--x.toml", "it's.toml", "$(touch x).toml", "été.toml"]:
            self.write(name, CASE)
            self.udar("run", "./" + name, "--output", "out of " + name)
            self.assertEqual(self.names("out of " + name), WHOLE)
        self.assertFalse((self.folder / "x").exists())

    def test_numerical_stop(self):
        out, err = self.udar("run", "block.toml", "--set", "run.integrator=adams2", "--set", "run.time_step=0.5 us",
                             "--set", "run.when_unstable=continue", "--set", "run.end_time=1 s",
                             "--set", "output.fields_every=20 us", code=5)
        self.assertTrue(err.startswith("error: "), err)
        self.assertIn("Likely cause", err)
        self.assertIn("verdict: bad", out)
        self.assertEqual(self.names("runs/block"), WHOLE)
        summary = self.summary("runs/block")
        self.assertEqual(summary["stop_reason"], "numerical")
        self.assertIsNotNone(summary["ledger"]["elastic"])
        frames = re.findall(r'timestep="([^"]*)"', (self.folder / "runs/block/fields.pvd").read_text())
        self.assertEqual(float(frames[-1]), summary["end_time"])


    def stops(self, *changes):
        """A run that cannot go on: its error, once the folder is found to be whole, with the last good state in it."""
        words = [word for change in changes for word in ("--set", change)]
        out, err = self.udar("run", "block.toml", *words, code=5)
        self.assertTrue(err.startswith("error: "), err)
        self.assertIn("verdict: bad", out)
        self.assertEqual(self.names("runs/block"), WHOLE)
        summary = self.summary("runs/block")
        self.assertEqual(summary["stop_reason"], "numerical")
        self.assertEqual(summary["reasons"][0], err.removeprefix("error: ").rstrip("\n"))
        # Told of the step that failed; saved is the one before.
        self.assertIn(f"(step {summary['steps'] + 1}, h = ", err)
        for number in ("energy_error", "momentum_error", "spin_error"):
            self.assertIsNotNone(summary[number])
        frames = re.findall(r'timestep="([^"]*)"', (self.folder / "runs/block/fields.pvd").read_text())
        self.assertEqual(float(frames[-1]), summary["end_time"])
        self.assertIn("failed: block element", (self.folder / "runs/block/final.svg").read_text())
        self.assertIn("stopped by: numerical", (self.folder / "runs/block/log.txt").read_text())
        for part in (" of body `block`", " m", " at t = ", "Likely cause: ", "Cure: "):
            self.assertIn(part, err)
        return err

    def test_a_velocity_that_is_far_out(self):
        err = self.stops("bodies.block.velocity.1=-100 km/s")
        self.assertRegex(err, r"element \d+ of body `block` \(nodes \d+, \d+, \d+\) near \(.*\) m turned inside out")

    def test_a_step_that_collapses(self):
        # The end is so far away that a step which falls by a little would take for ever.
        err = self.stops("run.end_time=4.6e5 s", "output.fields_every=1e4 s")
        self.assertRegex(err, r"the stable limit collapsed to 5\.\S+ s .*: element \d+ of body `block`")

    def test_a_load_that_runs_away(self):
        self.write("block.toml", CASE + '[loads.wind]\nbody = "block"\nedges = { side = "top" }\npressure = "1e15 Pa"\n')
        self.stops()


class Report(Program):
    """The page is a line here: what is tested is what udar puts into it."""

    def setUp(self):
        super().setUp()
        self.write("page.html", "<!doctype html><!-- the run -->")
        self.udar("run", "block.toml", "--no-report", "--set", "output.fields_every=2 us")

    def report(self, *words, run="runs/block", code=0):
        return self.udar("report", run, "--template", "page.html", *words, code=code)

    def test_of_an_old_run(self):
        out, err = self.report()
        self.assertEqual(err, "")
        self.assertRegex(out, r"^runs/block/report.html: \S+ kB, 31 frames\n$")
        text = (self.folder / "runs/block/report.html").read_text()
        run = json.loads(re.search(r'id="run">(.*?)</script>', text).group(1))
        self.assertEqual(run["format"], 1)
        self.assertEqual(run["case_text"], CASE)
        self.assertEqual(run["summary"], self.summary("runs/block"))
        self.assertEqual(run["left_out"], [])
        self.udar("run", "block.toml", "--force", "--no-report")
        self.assertNotIn("report.html", self.names("runs/block"))

    def test_choices(self):
        out, _ = self.report("--limit", "50 kB", "--output", "small.html")
        self.assertLessEqual((self.folder / "small.html").stat().st_size, 50000)
        self.assertIn("accelerations are left out: they are in fields/\n", out)
        self.assertNotIn("report.html", self.names("runs/block"))
        out, _ = self.report("--fields", "plastic_strain,max_shear", "--frames", "2")
        self.assertIn(", 2 frames\n", out)
        for words, code, part in [(["--limit", "3 kB"], 2, "give it more with --limit"),
                                  (["--fields", "plastic_strian"], 2, "did you mean `plastic_strain`?"),
                                  (["--output", "no/such/place.html"], 6, "the folder does not exist")]:
            with self.subTest(words):
                self.assertIn(part, self.report(*words, code=code)[1])

    def test_without_the_viewer(self):
        if VIEWER:
            self.udar("report", "runs/block")
            self.assertIn("report.html", self.names("runs/block"))
        else:
            _, err = self.udar("report", "runs/block", code=6)
            self.assertIn("the page needs the viewer", err)
            self.assertIn("apt install nodejs npm", err)

    def test_a_full_disk_leaves_no_half_page(self):
        self.udar("report", "runs/block", "--template", "page.html", code=6,
                  preexec_fn=small_files(9000))
        self.assertEqual(self.names("runs/block"), WHOLE - {"report.html"})


def small_files(most):
    """For preexec_fn: no file may become larger than so many bytes. What a program writes at its end of the lines that
    ran (scripts/coverage) would be cut off, too, and goes elsewhere."""
    def limit():
        os.environ["GCOV_PREFIX"] = os.path.join(tempfile.gettempdir(), "udar-gcov")
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
    return limit


class Signals(Program):
    def start(self):
        """A run that would take hours, after its first steps."""
        self.write("long.toml", CASE.replace('"60 us"', '"100 s"').replace('"30 us"', '"10 s"'))
        run = subprocess.Popen([PROGRAM, "run", "long.toml"], cwd=self.folder, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
        self.addCleanup(lambda: run.poll() is None and run.kill())
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.stdout.close)
        self.assertIn(b"long: 64 elements", run.stdout.readline())
        time.sleep(0.1)
        return run

    def test_a_signal_saves_everything(self):
        for number, code in [(signal.SIGINT, 130), (signal.SIGTERM, 143)]:
            with self.subTest(number):
                run = self.start()
                begin = time.monotonic()
                run.send_signal(number)
                out, err = run.communicate(timeout=20)
                self.assertLess(time.monotonic() - begin, 5)  # one second and a busy machine
                self.assertEqual(run.returncode, code, err)
                self.assertEqual(err, b"")
                self.assertIn(b"interrupted", out)
        for folder in ["runs/long", "runs/long-2"]:
            self.assertEqual(self.names(folder), WHOLE | {"checkpoint_a.bin"})
            summary = self.summary(folder)
            self.assertEqual(summary["stop_reason"], "interrupted")
            self.assertGreater(summary["steps"], 0)


class Disks(Program):
    def test_a_file_size_limit_stops_the_run_with_a_message(self):
        # Every step writes rows, and soon a history is too long.
        few = 60000
        out, err = self.udar("run", "block.toml", "--set", "run.end_time=10 ms", "--set", "output.histories_every=1 ns",
                             code=6, preexec_fn=small_files(few))
        self.assertTrue(err.startswith("error: cannot write runs/block/histories/"), err)
        self.assertIn("ulimit -f", err)
        self.assertIn("verdict: bad", out)
        summary = self.summary("runs/block")
        self.assertEqual(summary["stop_reason"], "disk")
        self.assertIn("cannot write", summary["reasons"][0])
        self.assertLess(summary["end_time"], 0.01)

    def test_a_limit_that_the_frames_reach_stops_the_run_with_a_message(self):
        # Frames in every step, and soon their index is too long. It is written while the run goes on.
        few = 60000
        out, err = self.udar("run", "block.toml", "--set", "run.end_time=100 ms", "--set", "output.fields_every=1 ns",
                             code=6, preexec_fn=small_files(few))
        self.assertIn("error: cannot write runs/block/fields.pvd", err)
        self.assertIn("ulimit -f", err)
        self.assertIn("verdict: bad", out)
        summary = self.summary("runs/block")
        self.assertEqual(summary["stop_reason"], "disk")
        self.assertLess(summary["end_time"], 0.1)
        index = self.folder / "runs/block/fields.pvd"
        if index.exists():  # as it was when it was last renewed
            for name in re.findall(r'file="([^"]*)"', index.read_text()):
                self.assertGreater((self.folder / "runs/block" / name).stat().st_size, 0)

    def test_a_disk_that_takes_nothing(self):
        _, err = self.udar("run", "block.toml", code=6,
                           preexec_fn=small_files(0))
        self.assertTrue(err.startswith("error: cannot write"), err)

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_a_folder_that_may_not_be_written(self):
        self.folder.chmod(0o500)
        self.addCleanup(lambda: self.folder.chmod(0o700))
        _, err = self.udar("run", "block.toml", code=6)
        self.assertIn("choose another folder with --output", err)

    def test_a_file_in_the_place_of_the_folder(self):
        self.write("runs", "")
        _, err = self.udar("run", "block.toml", code=6)
        self.assertIn("runs/block", err)

    def test_full_standard_output(self):
        with open("/dev/full", "wb") as full:
            done = subprocess.run([PROGRAM, "check", "block.toml"], cwd=self.folder, stdout=full,
                                  stderr=subprocess.PIPE, check=False)
        self.assertEqual(done.returncode, 6)
        self.assertIn(b"cannot write to the standard output: No space left on device", done.stderr)

    def test_full_standard_output_does_not_lose_a_run(self):
        with open("/dev/full", "wb") as full:
            done = subprocess.run([PROGRAM, "run", "block.toml"], cwd=self.folder, stdout=full, stderr=subprocess.PIPE,
                                  check=False)
        self.assertEqual(done.returncode, 6)
        self.assertEqual(self.summary("runs/block")["stop_reason"], "end_time")

    def test_a_closed_pipe_is_no_error(self):
        reading, writing = os.pipe()
        os.close(reading)
        done = subprocess.run([PROGRAM, "keys"], cwd=self.folder, stdout=writing, stderr=subprocess.PIPE, check=False)
        os.close(writing)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stderr, b"")


class Terminal(Program):
    def test_status_line_is_rewritten_in_place_and_fits(self):
        self.write("longer.toml", CASE.replace('"60 us"', '"20 ms"').replace('"30 us"', '"20 ms"'))
        ours, theirs = pty.openpty()
        subprocess.run(["stty", "cols", "60"], stdin=theirs, check=True)
        run = subprocess.Popen([PROGRAM, "run", "longer.toml"], cwd=self.folder, stdout=theirs, stderr=theirs)
        os.close(theirs)
        text = b""
        try:
            while piece := os.read(ours, 4096):
                text += piece
        except OSError:  # the other end is closed
            pass
        os.close(ours)
        self.assertEqual(run.wait(), 0)
        lines = text.decode().split("\r\n")
        status = next(line for line in lines if line.startswith("\r"))
        for rewritten in status.split("\r")[1:]:
            self.assertTrue(rewritten.endswith("\x1b[K"))
            self.assertLess(len(rewritten) - len("\x1b[K"), 60)
        self.assertIn(" 100 ", status.split("\r")[-1])


class ShortBeam(Program):
    def test_the_main_case(self):
        out, _ = self.udar("check", SHORT_BEAM)
        self.assertIn("beam: 3.14 kg, 12800 elements, 6601 nodes", out)
        self.assertIn("pressure waves 5475.59 m/s", out)
        self.udar("run", SHORT_BEAM, "--set", 'bodies.beam.mesh.element_size="1 cm"', "--set", "run.end_time=0.1 ms")
        summary = self.summary("runs/short-beam")
        self.assertEqual(summary["elements"], 800)
        self.assertEqual(summary["verdict"], "good")
        for name in ["corner", "lower_edge", "top", "middle", "bottom", "beam", "stop", "energy", "momentum"]:
            self.assertIn(name, summary["histories"])


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
    SHORT_BEAM = SOURCE / "cases/short-beam/short-beam.toml"
    VIEWER = (SOURCE / "viewer/dist/viewer.html").is_file()
    WHOLE |= {"report.html"} if VIEWER else set()
    unittest.main()
