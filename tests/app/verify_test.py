#!/usr/bin/env python3
"""`udar verify` as a user meets it.

usage: verify_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import html.parser
import json
import math
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

from program import run_program

PROGRAM = ""
SOURCE = pathlib.Path()


class Page(html.parser.HTMLParser):
    """What a page refers to, and whether its tags close."""

    def __init__(self, text):
        super().__init__()
        self.open, self.links, self.anchors, self.scripts = [], [], [], 0
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.scripts += tag == "script"
        if "href" in attributes:
            self.links.append(attributes["href"])
        if "id" in attributes:
            self.anchors.append(attributes["id"])
        if tag not in ("meta", "path", "circle", "rect"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag not in ("path", "circle", "rect"):
            assert self.open.pop() == tag, tag


class Verify(unittest.TestCase):
    """Quick problems only: the rest are tests of their own."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="udar-test-")
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def run_program(self, *words, code=0, **options):
        return run_program(self, PROGRAM, words, code, **options)

    def test_list_names_every_folder_once(self):
        out, _ = self.run_program("verify", "--list")
        listed = [line.split()[0] for line in out.splitlines() if line.startswith("  ")]
        folders = {path.parent.name for path in (SOURCE / "verification").glob("*/*.cpp")
                   if path.stem == path.parent.name}
        self.assertEqual(sorted(listed), sorted(folders))
        out, _ = self.run_program("verify", "--list", "simple-shear")
        self.assertEqual(out, "Rotation and large shear\n  simple-shear      large shear without an end\n")

    def test_wrong_words(self):
        _, err = self.run_program("verify", "simple-shar", code=2)
        self.assertIn("there is no problem `simple-shar`", err)
        self.assertIn("did you mean `simple-shear`?", err)
        self.assertIn("nothing was verified", err)
        _, err = self.run_program("verify", "simple-shar", "hertzz", code=2)
        self.assertIn("there is no problem `simple-shar`", err)
        self.assertIn("there is no problem `hertzz`", err)
        _, err = self.run_program("verify", "xyzzy", code=2)
        self.assertIn("`udar verify --list` shows all", err)
        _, err = self.run_program("verify", "simple-shear", "--only-long", code=2)
        self.assertIn("no long parts", err)
        _, err = self.run_program("verify", "--cores", "0", code=2)
        _, err = self.run_program("verify", "--bounds", "x", code=2)
        _, err = self.run_program("verify", "--outptu", "a", code=2)
        self.assertIn("did you mean `--output`?", err)

    def test_help_has_examples_and_the_exit_code(self):
        out, _ = self.run_program("verify", "--help")
        self.assertIn("udar verify --long --output verification", out)
        self.assertIn("Exit code 9 where a check fails", out)

    def test_table_and_summary(self):
        out, err = self.run_program("verify", "simple-shear")
        self.assertEqual(err, "")
        self.assertIn("simple-shear: large shear without an end\n", out)
        self.assertRegex(out, r"(?m)^    plastic strain +steps of 0\.1 +4\.99804 +4\.99868 +0\.0128 % +≤ 0\.0144 % +holds$")
        self.assertRegex(out, r"(?m)^    order of t_xy / G +2\.00 +2\.00 +≥ 1\.9 +holds$")
        self.assertRegex(out, r"(?m)^43 of 43 checks hold, of 1 problem, in [0-9.e-]+ s$")
        out, _ = self.run_program("verify", "simple-shear", "--brief")
        self.assertRegex(out, r"^ok    simple-shear +43 of +43 checks hold")
        self.assertNotIn("plastic strain", out)

    def test_the_order_is_that_of_the_list_whatever_ends_first(self):
        out, _ = self.run_program("verify", "simple-shear", "bar-on-wall", "integrators", "--brief", "--cores", "3")
        names = [line.split()[1] for line in out.splitlines()[:-1]]
        self.assertEqual(names, ["bar-on-wall", "simple-shear", "integrators"])

    def test_a_check_that_fails_is_told_and_gives_exit_code_9(self):
        # With the bounds of errors at a tenth the errors of the steps are too large; rounding still is within its own.
        out, err = self.run_program("verify", "simple-shear", "--bounds", "0.1", "--brief", "--output", "out", code=9)
        self.assertEqual(err, "")
        self.assertRegex(out, r"(?m)^FAILS simple-shear")
        self.assertIn("FAILS: simple-shear, elastic to gamma = 10\n", out)
        self.assertRegex(out, r"(?m)^    t_xy off, over G +steps of 0\.1 .*FAILS$")
        self.assertNotIn("difference of the two triangles", out)
        found = json.loads((self.folder / "out/verify.json").read_text(encoding="utf-8"))
        self.assertLess(found["checks_held"], found["checks"])
        self.assertEqual(found["bounds_times"], 0.1)
        for name in ("verification.html", "verification.md"):
            text = (self.folder / "out" / name).read_text(encoding="utf-8")
            self.assertIn("FAILS", text)
            self.assertIn("bounds of errors times 0.1", text)

    def test_files(self):
        self.run_program("verify", "bar-on-wall", "simple-shear", "--output", "out")
        out = self.folder / "out"
        found = json.loads((out / "verify.json").read_text(encoding="utf-8"))
        self.assertEqual(found["schema"], 1)
        self.assertEqual([p["id"] for p in found["problems"]], ["bar-on-wall", "simple-shear"])
        rows = [row for p in found["problems"] for part in p["parts"] for row in part["checks"]]
        self.assertEqual(len(rows), found["checks"])
        # What the program says holds does: computed here once more.
        for row in rows:
            self.assertTrue(row["holds"], row)
            if row["kind"] == "relative":
                error = abs(row["computed"] - row["exact"]) / abs(row["exact"])
                self.assertLessEqual(error, row["bound"])
                self.assertAlmostEqual(error, row["error"], delta=1e-12 * abs(error))
            if row["kind"] == "at_most":
                self.assertLessEqual(row["computed"], row["bound"])
        for part in (part for p in found["problems"] for part in p["parts"]):
            for series in part["series"]:
                sizes, errors = series["sizes"], series["errors"]
                orders = [math.log(errors[i] / errors[-1]) / math.log(sizes[i] / sizes[-1]) for i in (0, -2)]
                self.assertTrue(any(abs(order - series["order"]) < 1e-9 for order in orders), series["what"])
        # One page without scripts and without anything from elsewhere.
        text = (out / "verification.html").read_text(encoding="utf-8")
        page = Page(text)
        self.assertEqual(page.open, [])
        self.assertEqual(page.scripts, 0)
        self.assertEqual(len(page.anchors), len(set(page.anchors)))
        self.assertTrue(all(link.startswith("#") for link in page.links), page.links)
        self.assertIn("#bar-on-wall", page.links)
        self.assertNotIn("src=", text)
        self.assertIn("Saint-Venant", text)
        # The pictures that the Markdown names, each once, and no others.
        markdown = (out / "verification.md").read_text(encoding="utf-8")
        pictures = sorted(path.name for path in (out / "pictures").iterdir())
        named = [part.split(")")[0] for part in markdown.split("](pictures/")[1:]]
        self.assertEqual(sorted(named), pictures)
        for name in pictures:
            xml.etree.ElementTree.parse(out / "pictures" / name)

    def test_output_folder(self):
        self.run_program("verify", "integrators", "--output", "out", "--brief")
        self.assertTrue((self.folder / "out/pictures/verification-integrators-1.svg").exists())
        # An earlier verification is replaced, with its pictures, where that is wanted.
        _, err = self.run_program("verify", "simple-shear", "--output", "out", code=2)
        self.assertIn("`out` holds an earlier verification", err)
        self.assertIn("--force", err)
        self.assertTrue((self.folder / "out/pictures/verification-integrators-1.svg").exists())
        self.run_program("verify", "simple-shear", "--output", "out", "--brief", "--force")
        self.assertFalse((self.folder / "out/pictures/verification-integrators-1.svg").exists())
        # Anything else is not, and that is told before something is computed.
        (self.folder / "other").mkdir()
        (self.folder / "other/thesis.txt").write_text("mine", encoding="utf-8")
        out, err = self.run_program("verify", "simple-shear", "--output", "other", code=2)
        self.assertEqual(out, "")
        self.assertIn("holds something else", err)
        self.assertEqual([path.name for path in (self.folder / "other").iterdir()], ["thesis.txt"])
        _, err = self.run_program("verify", "simple-shear", "--output", "other/thesis.txt", code=2)
        self.assertIn("is no folder", err)
        self.run_program("verify", "simple-shear", "--output", "/dev/null/a", "--brief", code=6)

    def test_ctrl_c(self):
        with subprocess.Popen([PROGRAM, "verify", "hertz", "--cores", "1"], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE) as process:
            time.sleep(0.5)
            begin = time.monotonic()
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=30)
            self.assertLess(time.monotonic() - begin, 5)
        self.assertEqual(process.returncode, 130)
        self.assertIn(b"interrupted: 0 of 1 problems", out)
        self.assertEqual(err, b"")


if __name__ == "__main__":
    PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
