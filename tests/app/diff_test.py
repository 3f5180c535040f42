#!/usr/bin/env python3
"""`udar diff` as a user meets it.

usage: diff_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from program import run_program

PROGRAM = ""

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
velocity = ["5 m/s", "-80 m/s"]
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], at = ["-2 cm", "0.01 cm"], element_size = "0.5 cm" }
[obstacles.stop]
shape = "half_plane"
point = ["0 m", "0 m"]
normal = [0, 1]
friction = 0.35
[[observe.nodes]]
name = "corner"
body = "block"
at = ["-2 cm", "2.01 cm"]
[output]
fields_every = "20 us"
"""


class Diff(unittest.TestCase):
    """A few runs for all tests of the class."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="udar-test-")
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = pathlib.Path(cls.scratch.name)
        (cls.folder / "block.toml").write_text(CASE, encoding="utf-8")
        for name, words in {
            "one": ["--threads", "1"],
            "again": ["--threads", "2"],
            "late": ["--set", 'bodies.block.mesh.at=["-2 cm", "0.05 cm"]', "--set", 'observe.nodes.0.at=["-2 cm", "2.05 cm"]'],
            "fine": ["--set", 'bodies.block.mesh.element_size="0.25 cm"'],
        }.items():
            subprocess.run([PROGRAM, "run", "block.toml", "--no-report", "--output", name, *words], cwd=cls.folder,
                           check=True, capture_output=True, timeout=60)
        cls.before = set(os.listdir(cls.folder))

    def tearDown(self):
        for name in set(os.listdir(self.folder)) - self.before:
            path = self.folder / name
            shutil.rmtree(path) if path.is_dir() else path.unlink()

    def udar(self, *words, code=0, **options):
        return run_program(self, PROGRAM, words, code, **options)

    def rows(self, history, run="one"):
        with open(self.folder / run / "histories" / f"{history}.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def test_same_bits(self):
        for words in [("one", "one"), ("one", "again"), ("one/", "./again")]:
            out, err = self.udar("diff", *words, "--within", "0 %")
            self.assertEqual(err, "")
            self.assertTrue(out.startswith("the same bits\n"), out)
            self.assertIn("within 0 %: all of ", out)

    def test_one_changed_digit(self):
        shutil.copytree(self.folder / "one", self.folder / "changed")
        path = self.folder / "changed/histories/corner.csv"
        lines = path.read_text().splitlines(keepends=True)
        cells = lines[31].split(",")
        cells[3] = repr(float(cells[3]) + 1)
        lines[31] = ",".join(cells)
        path.write_text("".join(lines))
        out, _ = self.udar("diff", "one", "changed")
        self.assertRegex(out, r"^not the same bits: first in corner\.velocity_x at [\d.]+ us\n")
        self.assertIn("the same rows in both: ", out)
        table = [line for line in out.splitlines() if line.startswith("corner.")]
        self.assertEqual(len(table), 1)
        self.assertIn("corner.velocity_x", table[0])

    def test_changed_frame(self):
        shutil.copytree(self.folder / "one", self.folder / "changed")
        frame = sorted((self.folder / "changed/fields").glob("bodies_*.vtu"))[1]
        data = bytearray(frame.read_bytes())
        data[-40] ^= 1
        frame.write_bytes(data)
        out, _ = self.udar("diff", "one", "changed")
        self.assertRegex(out, r"^not the same bits: first in fields/bodies_000001\.vtu at 20\.\d+ us\n")

    def test_other_mesh(self):
        out, err = self.udar("diff", "one", "fine")
        self.assertEqual(err, "")
        lines = out.splitlines()
        self.assertRegex(lines[0], r"^not the same bits: first in \w+\.\w+ at ")
        self.assertIn("the cases differ in 1 key:", out)
        self.assertIn("  bodies.block.mesh.element_size: 0.005 m -> 0.0025 m", lines)
        head = next(k for k, line in enumerate(lines) if line.startswith("history "))
        for word in ["unit", "rms difference", "largest difference", "when", "part at"]:
            self.assertIn(word, lines[head])
        self.assertTrue(lines[head + 21].startswith("in % of the rms"), lines[head + 21])
        self.assertRegex(out, r"\d+ more differ less \(--all shows them\)")
        self.assertRegex(out, r"contacts\.stop\.peak_force: .* MN|kN -> ")
        everything, _ = self.udar("diff", "one", "fine", "--all")
        self.assertNotIn("--all", everything)
        self.assertIn("histories.corner.displacement_y.min: ", everything)
        self.assertLessEqual(max(map(len, lines)), 140)

    def test_files(self):
        self.udar("diff", "one", "fine", "--output", "d.csv")
        self.udar("diff", "one", "fine", "--output", "d.json")
        data = json.loads((self.folder / "d.json").read_text())
        with open(self.folder / "d.csv", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([row["name"] for row in table], [c["name"] for c in data["columns"]])
        self.assertFalse(data["same_bits"])
        column = next(c for c in data["columns"] if c["name"] == "corner.displacement_y")
        row = next(r for r in table if r["name"] == "corner.displacement_y")
        self.assertEqual(float(row["l2"]), column["l2"])
        # The same integrals by another way: fine sampling of both curves.
        a, b = ([(float(r["time [s]"]), float(r["displacement_y [m]"])) for r in self.rows("corner", run)]
                for run in ("one", "fine"))

        def value(rows, time):
            k = next(i for i in range(1, len(rows)) if rows[i][0] >= time)
            (t0, v0), (t1, v1) = rows[k - 1], rows[k]
            return v0 + (v1 - v0) * (time - t0) / (t1 - t0)

        end = min(a[-1][0], b[-1][0])
        times = [end * (i + 0.5) / 3000 for i in range(3000)]
        mean = sum((value(a, t) - value(b, t)) ** 2 for t in times) / len(times)
        size = sum(value(b, t) ** 2 for t in times) / len(times)
        self.assertAlmostEqual(column["l2"] / mean**0.5, 1, delta=1e-4)
        self.assertAlmostEqual(column["size"] / size**0.5, 1, delta=1e-4)
        self.assertAlmostEqual(column["span"], end, delta=1e-12)
        self.assertEqual(len(data["case"]), 1)

    def test_align(self):
        plain, _ = self.udar("diff", "one", "late", "--only", "stop", "--output", "plain.json")
        out, _ = self.udar("diff", "one", "late", "--only", "stop", "--align", "--output", "aligned.json")
        touch = [json.loads((self.folder / run / "summary.json").read_text())["contacts"]["stop"]["first_touch"]
                 for run in ("one", "late")]
        self.assertIn("B is moved by -5.", out)  # 0.04 cm at 80 m/s
        l2 = []
        for name in ["plain", "aligned"]:
            data = json.loads((self.folder / f"{name}.json").read_text())
            l2.append(next(c["relative_l2"] for c in data["columns"] if c["name"] == "stop.force_y"))
        self.assertAlmostEqual(data["moved"], touch[0] - touch[1], delta=1e-15)
        # A step earlier or later remains: the meshes are the same, the steps fall elsewhere.
        self.assertLess(l2[1], 0.25 * l2[0])
        self.assertNotIn("moved", plain)

    def test_within(self):
        self.udar("diff", "one", "fine", "--only", "block.velocity_y", "--within", "15 %")
        out, _ = self.udar("diff", "one", "fine", "--only", "block.velocity_y", "corner.acceleration_y", "--within", "1 %",
                           code=9)
        self.assertIn("not within 1 %: ", out)
        self.assertIn("worst corner.acceleration_y", out)
        shift, _ = self.udar("diff", "one", "one", "--only", "corner.velocity_y", "--shift", "-10 us", "--within", "0.1 %",
                             code=9)
        self.assertTrue(shift.startswith("the same bits\nB is moved by -10 us"), shift)

    def test_window_and_times(self):
        def parts(*words):
            self.udar("diff", "one", "fine", "--only", "corner.acceleration_y", *words, "--output", "d.json")
            return json.loads((self.folder / "d.json").read_text())["columns"][0]

        self.assertLess(parts("--window", "20 us")["l2"], 0.5 * parts()["l2"])
        cut = parts("--from", "20 us", "--to", "30us")
        self.assertAlmostEqual(cut["span"], 1e-5, delta=1e-12)
        self.assertAlmostEqual(cut["from"], 2e-5, delta=1e-12)

    def test_table(self):
        rows = self.rows("corner")
        # A spreadsheet of another country: 10 us late, mm, decimal commas, comments, a hole.
        text = "\ufeff# from the laboratory\r\nZeit [ms];\"Weg, unten [mm]\";Temperatur [°C]\r\n"
        for k, row in enumerate(rows):
            values = [1e3 * (float(row["time [s]"]) + 1e-5), 1e3 * float(row["displacement_y [m]"])]
            text += ";".join(repr(v).replace(".", ",") for v in values) + ";\r\n"
            if k == 30:
                text += repr(values[0]).replace(".", ",") + ";;\r\n"
        self.write("lab.csv", text)
        words = ["--map", "Weg, unten=corner.displacement_y", "--shift", "-10 us", "--within", "0.001 %"]
        out, _ = self.udar("diff", "one", "lab.csv", *words)
        self.assertTrue(out.startswith("one against lab.csv: 1 column\nB is moved by -10 us"), out)
        self.assertIn("1 row of corner.displacement_y", out)
        self.assertIn("only in B: Temperatur", out)
        self.assertIn("within 0.001 %: all of 1 column", out)
        self.udar("diff", "one", "lab.csv", "--map", "Weg, unten=corner.displacement_y", "--within", "1 %", code=9)
        # A is the table: B is moved the other way.
        self.udar("diff", "lab.csv", "one", "--map", "Weg, unten=corner.displacement_y", "--shift", "10 us", "--within",
                  "0.001 %")

    def test_table_of_own_names(self):
        rows = self.rows("corner")
        text = "t [us]\tcorner.velocity_y [cm/s]\n"
        text += "".join(f"{1e6 * float(r['time [s]'])!r}\t{200 * float(r['velocity_y [m/s]'])!r}\n" for r in rows)
        self.write("twice.tsv", text)
        self.udar("diff", "one", "twice.tsv", "--output", "d.json")
        column, = json.loads((self.folder / "d.json").read_text())["columns"]
        self.assertEqual(column["name"], "corner.velocity_y")
        self.assertAlmostEqual(column["relative_l2"], 0.5, delta=1e-12)  # |v - 2v| of 2v
        self.assertAlmostEqual(column["relative_max"], 0.5, delta=1e-12)
        out, _ = self.udar("diff", "one", "one/histories/corner.csv", "--within", "0 %")
        self.assertIn("6 columns", out)

    def test_killed_run(self):
        shutil.copytree(self.folder / "one", self.folder / "killed")
        (self.folder / "killed/summary.json").unlink()
        path = self.folder / "killed/histories/corner.csv"
        text = path.read_bytes()
        path.write_bytes(text[:len(text) // 2])
        out, _ = self.udar("diff", "one", "killed", "--only", "corner", "--within", "0 %")
        self.assertIn("ends earlier in B", out)
        self.assertIn("killed: summary.json is missing", out)

    def test_mistakes(self):
        (self.folder / "empty").mkdir()
        (self.folder / "kept.csv").write_text("t [ms],x [mm]\n1,2\n3,4\n")
        for words, message, cure in [
            (["one"], "two runs are needed", "`udar diff --help`"),
            (["one", "nothing"], "`nothing` is not there", "`udar run`"),
            (["one", "empty"], "`empty` is not the folder of a run", "`udar run`"),
            (["one", "fine", "--only", "cornr"], "there is no history `cornr`", "did you mean `corner`?"),
            (["one", "fine", "--only", "corner.velocty_y"], "no history", "did you mean `corner.velocity_y`?"),
            (["one", "fine", "--from", "2 ms"], "no time that both have", "--from"),
            (["one", "fine", "--shift", "1 s"], "no time that both have", "--shift"),
            (["one", "fine", "--from", "30us", "--to", "20us"], "--to is not after --from", "later"),
            (["one", "fine", "--window", "3 m"], "`--window`", "s"),
            (["one", "fine", "--within", "much"], "`--within much` is no part of a value", "2 %"),
            (["one", "fine", "--tolerance", "-1 %"], "`--tolerance -1 %` is no part", "2 %"),
            (["one", "fine", "--map", "a=b"], "both are runs", "--map"),
            (["one", "fine", "--output", "kept.txt"], "does not end in .csv or .json", "--output"),
            (["one", "kept.csv", "--map", "x=corner.displacement_y", "--output", "kept.csv"], "would replace", "--output"),
            (["one", "kept.csv"], "no column of `kept.csv` is a history of `one`", '--map "x='),
            (["one", "kept.csv", "--map", "x=corner.velocity_y"], "wrong unit in the column `x [mm]`", "[m/s]"),
            (["one", "kept.csv", "--map", "x=corner.displacement_z"], "no history `corner.displacement_z`",
             "did you mean `corner.displacement_x`?"),
            (["one", "kept.csv", "--map", "x=corner.displacement_y", "--align"], "no first touch", "--shift"),
            (["one", "kept.csv", "--map", "x=corner.displacement_y"], "no time that both have", "--shift"),
        ]:
            with self.subTest(words):
                out, err = self.udar("diff", *words, code=2)
                self.assertEqual(out, "")
                self.assertTrue(err.startswith("error: "), err)
                self.assertIn(message, err)
                self.assertIn(cure, err)
        _, err = self.udar("diff", "one", "kept.csv", "--map", "x=corner.velocity_y", code=2)
        self.assertIn("--> kept.csv:1:1", err)
        self.assertIn("nothing was compared", err)
        _, err = self.udar("diff", "one", "gone.csv", code=2)
        self.assertIn("`gone.csv` is not there", err)
        self.assertEqual((self.folder / "kept.csv").read_text(), "t [ms],x [mm]\n1,2\n3,4\n")

    def test_names_from_strangers(self):
        self.write("odd.csv", "t,corner.velocity_y,\"\x1b[31mred\"\n0,1,2\n1,1,2\n")
        out, _ = self.udar("diff", "one", "odd.csv")
        self.assertNotIn("\x1b", out)


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
