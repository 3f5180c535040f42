#!/usr/bin/env python3
"""Names of files and folders made to do harm: they reach no shell, no terminal and no other folder.

usage: names_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from hostile_files import CASE

PROGRAM = ""


class Scratch(unittest.TestCase):
    """A new folder with a case for each test."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="udar-names-")
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "case.toml").write_text(CASE)

    def udar(self, *words, code=0):
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, timeout=60, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout.decode(), done.stderr.decode()


class Names(Scratch):
    """Names are only names: no shell, no options, no commands to the terminal, no way out of the folder."""

    NAMES = ["a b", "it's", '"quoted"', ";touch x", "$(touch x)", "`touch x`", "a\nb", "-rf", "--help", "&touch x&", "*",
             "\x1b[2J", "%s%n", "été"]

    def test_of_cases_folders_and_pictures(self):
        for name in self.NAMES:
            with self.subTest(name):
                (self.folder / f"{name}.toml").write_text(CASE)
                run = self.folder / "runs" / name
                self.udar("run", f"./{name}.toml")
                self.assertTrue((run / "summary.json").is_file())
                self.udar("picture", f"runs/{name}", "--output", f"./{name}.svg")
                self.udar("plot", f"runs/{name}", "block.velocity_y", "--output", f"./{name}2.svg")
                self.udar("diff", f"runs/{name}", f"./runs/{name}", "--output", f"./{name}.csv")
                for ending in [".svg", "2.svg", ".csv"]:
                    self.assertTrue((self.folder / (name + ending)).is_file())
        self.assertFalse(list(self.folder.rglob("x")))

    @unittest.skipIf(shutil.which("rsvg-convert") is None, "there is no rsvg-convert")
    def test_of_pictures_that_another_program_makes(self):
        self.udar("run", "case.toml", "--output", "run")
        for name in self.NAMES:
            with self.subTest(name):
                self.udar("picture", "run", f"--output={name}.png")
                self.assertEqual((self.folder / f"{name}.png").read_bytes()[:4], b"\x89PNG")
        self.assertFalse(list(self.folder.rglob("x")))

    def test_of_studies_whose_commands_go_to_a_shell(self):
        environment = {**os.environ, "PATH": f"{pathlib.Path(PROGRAM).parent}:{os.environ['PATH']}"}
        vary = ["--vary", "obstacles.stop.friction=0,0.1"]
        for name in ["it's $(touch x)", "-n;touch x"]:
            with self.subTest(name):
                folder = self.folder / f"{name}.toml"
                folder.write_text(CASE)
                self.udar("sweep", f"./{name}.toml", *vary, "--list", "--output", f"./{name}")
                for line in (self.folder / name / "runs.txt").read_text().splitlines():
                    subprocess.run(["sh", "-c", line], cwd=self.folder, env=environment, check=True,
                                   stdout=subprocess.DEVNULL)
                self.assertIn("2 of 2 runs done", self.udar("sweep", f"./{name}.toml", *vary, "--output", f"./{name}",
                                                            "--no-report")[0])
        self.assertFalse(list(self.folder.rglob("x")))

    def test_the_log_repeats_the_run_in_a_shell(self):
        (self.folder / "it's.toml").write_text(CASE)
        self.udar("run", "./it's.toml", "--output", "run", "--set", "run.end_time='10 us'", "--set", "obstacles.stop.friction=0.1")
        line = next(line for line in (self.folder / "run/log.txt").read_text().splitlines() if "udar run" in line)
        words = subprocess.run(["sh", "-c", "printf '%s\\n' " + line[line.index("udar run"):]], capture_output=True,
                               check=True).stdout
        self.assertEqual(words.decode().splitlines(), ["udar", "run", "./it's.toml", "--set", "run.end_time='10 us'", "--set",
                                                       "obstacles.stop.friction=0.1"])

    def test_in_messages(self):
        for words in [["run", "\x1b[2J.toml"], ["\x1b[2J"], ["run", "case.toml", "--\x1b[2J"], ["report", "\x1b[2J"],
                      ["plot", "\x1b[2J", "--output", "a.svg"], ["sweep", "case.toml", "--vary", "\x1b[2J=1"]]:
            with self.subTest(words):
                done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, timeout=60, check=False)
                self.assertIn(done.returncode, {2, 3})
                self.assertNotIn(b"\x1b", done.stderr + done.stdout)


class Folders(Scratch):
    """What is written stays where it was asked for, and replaces nothing unasked."""

    def setUp(self):
        super().setUp()
        (self.folder / "mine").mkdir()
        (self.folder / "mine/thesis.svg").write_text("years of work")

    def untouched(self):
        self.assertEqual([p.name for p in (self.folder / "mine").iterdir()], ["thesis.svg"])
        self.assertEqual((self.folder / "mine/thesis.svg").read_text(), "years of work")

    def test_a_run_folder_that_is_a_link(self):
        (self.folder / "empty").mkdir()
        (self.folder / "runs").mkdir()
        for target in ["mine", "empty", "nowhere"]:
            link = self.folder / "runs/case"
            link.symlink_to(self.folder / target)
            for words in [["--output", "runs/case"], ["--output", "runs/case", "--force"], ["--force"]]:
                with self.subTest(target, words=words):
                    _, err = self.udar("run", "case.toml", *words, code=2)
                    self.assertIn("is a link", err)
            link.unlink()
        self.assertEqual(list((self.folder / "empty").iterdir()), [])
        self.assertFalse((self.folder / "nowhere").exists())
        self.untouched()
        # Whoever writes the slash means the folder.
        link.symlink_to(self.folder / "empty")
        self.udar("run", "case.toml", "--output", "runs/case/")
        self.assertTrue((self.folder / "empty/summary.json").is_file())

    def test_links_in_a_run_folder(self):
        self.udar("run", "case.toml", "--output", "run")
        for name in ["fields", "histories"]:
            shutil.rmtree(self.folder / "run" / name)
            (self.folder / "run" / name).symlink_to(self.folder / "mine")
            _, err = self.udar("run", "case.toml", "--output", "run", "--force", code=2)
            self.assertIn("is a link", err)
            (self.folder / "run" / name).unlink()
            (self.folder / "run" / name).mkdir()
        for name in ["summary.json", "report.html", "log.txt", "setup.svg", "case.toml", ".udar-run"]:
            (self.folder / "run" / name).unlink(missing_ok=True)
            (self.folder / "run" / name).symlink_to(self.folder / "mine/thesis.svg")
            self.udar("run", "case.toml", "--output", "run", "--force", code=2 if name == ".udar-run" else 0)
        self.untouched()

    def test_links_in_a_study(self):
        words = ["sweep", "case.toml", "--vary", "obstacles.stop.friction=0,0.1", "--output", "study"]
        self.udar(*words)
        for name in ["plots", "runs"]:
            with self.subTest(name):
                (self.folder / "study" / name).rename(self.folder / "kept")
                (self.folder / "study" / name).symlink_to(self.folder / "mine")
                done = subprocess.run([PROGRAM, *(["report", "study"] if name == "plots" else words)], cwd=self.folder,
                                      capture_output=True, timeout=60, check=False)
                self.assertIn(b"is a link", done.stdout + done.stderr)
                (self.folder / "study" / name).unlink()
                (self.folder / "kept").rename(self.folder / "study" / name)
        log = self.folder / "study/runs/run-1.txt"
        log.unlink()
        log.symlink_to(self.folder / "mine/thesis.svg")
        self.udar(*words, "--force", code=6)
        self.untouched()

    def test_force_on_foreign_folders(self):
        for words in [["run", "case.toml", "--force", "--output", "mine"],
                      ["sweep", "case.toml", "--vary", "obstacles.stop.friction=0,0.1", "--force", "--output", "mine"],
                      ["run", "case.toml", "--force", "--output", "."], ["run", "case.toml", "--force", "--output", ".."]]:
            with self.subTest(words):
                _, err = self.udar(*words, code=2)
                self.assertIn("holds files that are not", err)
        self.untouched()


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
