#!/usr/bin/env python3
"""Pictures, plots and movies as a user makes them: `udar plot`, `picture`, `movie`, `check --picture`.

usage: pictures_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree
import zlib

from program import run_program

PROGRAM = ""
HAS_CONVERTER = shutil.which("rsvg-convert") is not None
HAS_ENCODER = shutil.which("ffmpeg") is not None

CASE = """\
[run]
end_time = "60 us"
gravity = ["0 m/s^2", "-9.81 m/s^2"]
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
spin = "100 rad/s"
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], at = ["-2 cm", "0 cm"], element_size = "0.5 cm" }
[bodies.lid]
material = "steel"
thickness = "1 cm"
mesh = { shape = "rectangle", size = ["2 cm", "1 cm"], at = ["4 cm", "1 cm"], element_size = "0.5 cm" }
[obstacles.stop]
shape = "half_plane"
point = ["0 m", "0 m"]
normal = [0, 1]
[obstacles.ram]
shape = "circle"
centre = ["9 cm", "2 cm"]
radius = "1 cm"
velocity = ["-5 m/s", "0 m/s"]
[supports.hold]
body = "lid"
nodes = { side = "left" }
move_x = "0 m"
[loads.gas]
body = "lid"
edges = { side = "top" }
pressure = "3 MPa"
[[observe.nodes]]
name = "corner"
body = "block"
at = ["-2 cm", "2 cm"]
[output]
fields_every = "20 us"
"""


def chunks_of(data):
    """The pieces of a PNG file, their checksums checked."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, found = 8, []
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + body)
        found.append((kind.decode(), body))
        at += 12 + size
    return found


class Pictures(unittest.TestCase):
    """One run for all tests of the class, which each make their files beside it."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="udar-test-")
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = pathlib.Path(cls.scratch.name)
        (cls.folder / "block.toml").write_text(CASE, encoding="utf-8")
        for name, words in {"one": [], "two": ["--set", 'bodies.block.mesh.element_size="0.25 cm"']}.items():
            subprocess.run([PROGRAM, "run", "block.toml", "--output", name, *words], cwd=cls.folder, check=True,
                           capture_output=True, timeout=60)
        cls.before = set(os.listdir(cls.folder))

    def tearDown(self):
        for name in set(os.listdir(self.folder)) - self.before:
            path = self.folder / name
            shutil.rmtree(path) if path.is_dir() else path.unlink()

    def udar(self, *words, code=0, **options):
        return run_program(self, PROGRAM, words, code, **options)

    def svg(self, name):
        """The texts of a well-formed drawing."""
        tree = ElementTree.parse(self.folder / name)
        self.assertEqual(tree.getroot().tag, "{http://www.w3.org/2000/svg}svg")
        return [node.text for node in tree.iter("{http://www.w3.org/2000/svg}text")]

    def only_new(self, *names):
        self.assertEqual(set(os.listdir(self.folder)) - self.before, set(names))

    def test_set_up(self):
        out, _ = self.udar("check", "block.toml", "--picture", "setup.svg")
        self.assertIn("setup.svg", out)
        texts = self.svg("setup.svg")
        for words in ["block: 80 m/s, 100 rad/s", "stop", "ram: 5 m/s", "gas: 3 MPa", "hold", "corner", "8 cm", "2 cm",
                      "gravity 9.81 m/s²"]:
            self.assertIn(words, texts)
        run = (self.folder / "one/setup.svg").read_text(encoding="utf-8")
        self.assertEqual((self.folder / "setup.svg").read_text(encoding="utf-8"), run)

    def test_picture(self):
        out, _ = self.udar("picture", "one", "--time", "41us", "--field", "sigma1", "--output", "a.svg")
        self.assertRegex(out, r"no frame at 41 µs; the nearest one, at 40\.\d+ µs, is taken")
        texts = self.svg("a.svg")
        self.assertIn("block", texts)
        self.assertIn("first principal stress [MPa]", texts)
        self.assertTrue(any(re.fullmatch(r"t = 40\.\d+ µs", text) for text in texts), texts)
        self.only_new("a.svg")

    def test_every_field(self):
        help_text, _ = self.udar("picture", "--help")
        fields = re.search(r"Fields:((?:.|\n)*?)\n\n", help_text).group(1)
        names = re.findall(r"\w+", fields)
        self.assertGreaterEqual(len(names), 20)
        for name in names:
            with self.subTest(name):
                self.udar("picture", "one", "--field", name, "--output", "a.svg")
                self.svg("a.svg")

    def test_options(self):
        self.udar("picture", "one", "--field", "sigma1", "--range", "-300..300 MPa", "--unit", "kgf/cm^2", "--no-mesh",
                  "--view", "-3 cm, -1cm, 3cm,3cm", "--smooth", "--output", "a.svg")
        texts = self.svg("a.svg")
        self.assertIn("first principal stress [kgf/cm²]", texts)
        self.assertTrue(any(text.endswith("3060") for text in texts), texts)  # 300 MPa / 98066.5 Pa
        self.udar("picture", "one", "--follow", "lid", "--output", "a.svg")

    def test_strip(self):
        self.udar("picture", "one", "--times", "0us,20us", "--time", "40us", "--field", "shear", "--output", "a.svg")
        texts = self.svg("a.svg")
        self.assertEqual(sum(text.startswith("t = ") for text in texts), 3)
        self.assertEqual(texts.count("largest shear stress [MPa]"), 1)
        self.udar("picture", "one", "two", "--time", "40us", "--field", "flows", "--output", "b.svg")
        texts = self.svg("b.svg")
        # The runs have other steps, so their frames are of other times.
        for run in ["one", "two"]:
            self.assertTrue(any(re.fullmatch(run + r", t = 40\.\d+ µs", text) for text in texts), texts)

    def test_plot(self):
        self.udar("plot", "one", "--output", "sheet.svg")
        texts = self.svg("sheet.svg")
        for words in ["block.velocity_y", "stop.force_y", "energy.kinetic", "corner.displacement_y", "time [µs]"]:
            self.assertIn(words, texts)
        self.udar("plot", "one", "two", "corner.displacement_y", "--from", "10us", "--to", "50us", "--title", "a & b",
                  "--output", "two.svg")
        texts = self.svg("two.svg")
        for words in ["a & b", "one: corner.displacement_y", "two: corner.displacement_y", "displacement [µm]"]:
            self.assertIn(words, texts)

    def test_mistakes(self):
        (self.folder / "kept.svg").write_text("mine")
        for words, message, cure in [
            (["plot", "one", "cornr.velocity_x", "--output", "kept.svg"], "has no history `cornr`",
             "did you mean `corner.velocity_x`?"),
            (["plot", "one", "corner.velocty_x", "--output", "kept.svg"], "no column", "did you mean `corner.velocity_x`?"),
            (["plot", "one", "--from", "1 m", "--output", "kept.svg"], "`--from`", "s"),
            (["plot", "one", "--from", "50us", "--to", "10us", "--output", "kept.svg"], "--to is not after", "later"),
            (["plot", "nothing", "--output", "kept.svg"], "`nothing` is not there", "a folder that `udar run` has made"),
            (["plot", ".", "--output", "kept.svg"], "`.` is not the folder of a run", "`udar run`"),
            (["plot", "one", "--output", "kept.jpg"], "`kept.jpg` does not end in", "--output"),
            (["plot", "one"], "a file to make is needed", "--output"),
            (["plot"], "the folder of a run is needed", "--help"),
            (["picture", "one", "--field", "sigma4", "--output", "kept.svg"], "no field `sigma4`", "did you mean `sigma"),
            (["picture", "one", "--time", "3", "--output", "kept.svg"], "`--time`", "s"),
            (["picture", "one", "--range", "5", "--output", "kept.svg"], "`5` is no range", "auto"),
            (["picture", "one", "--field", "sigma1", "--range", "9..1 MPa", "--output", "kept.svg"], "does not rise", "0..400"),
            (["picture", "one", "--field", "sigma1", "--range", "0..1 mm", "--output", "kept.svg"], "`--range`", "stress"),
            (["picture", "one", "--field", "sigma1", "--unit", "mm", "--output", "kept.svg"], "`mm` is no unit of", "Pa"),
            (["picture", "one", "--view", "0m,0m", "--output", "kept.svg"], "`0m,0m` is no view", "lower left"),
            (["picture", "one", "--follow", "blok", "--output", "kept.svg"], "no body `blok`", "did you mean `block`?"),
            (["movie", "one", "--output", "kept.avi"], "`kept.avi` does not end in", "--output"),
            (["movie", "one", "--from", "1 s", "--output", "kept.png"], "no frames in this time", "widen"),
            (["check", "block.toml", "--picture", "kept.bmp"], "`kept.bmp` does not end in", "--output"),
        ]:
            with self.subTest(words):
                out, err = self.udar(*words, code=2)
                self.assertEqual(out, "")
                self.assertTrue(err.startswith("error: "), err)
                self.assertIn(message, err)
                self.assertIn(cure, err)
        self.only_new("kept.svg")
        self.assertEqual((self.folder / "kept.svg").read_text(), "mine")

    def test_missing_programs(self):
        for words in [["picture", "one", "--output", "a.png"], ["plot", "one", "--output", "a.pdf"],
                      ["check", "block.toml", "--picture", "a.png"], ["movie", "one", "--output", "a.mp4"]]:
            with self.subTest(words):
                out, err = self.udar(*words, code=6, env={"PATH": ""})
                self.assertEqual(out, "")
                self.assertIn("`rsvg-convert` is not installed\n  = install the Debian package librsvg2-bin", err)
                self.assertIn("write .svg", err)
        self.udar("picture", "one", "--output", "a.svg", env={"PATH": ""})
        self.only_new("a.svg")

    def fake(self, name, text):
        """A program for PATH that does what `text` says."""
        folder = self.folder / "programs"
        folder.mkdir(exist_ok=True)
        (folder / name).write_text(f"#!/bin/sh\n{text}\n")
        (folder / name).chmod(0o755)
        return {"PATH": f"{folder}:/usr/bin:/bin"}

    def test_failure_replaces_nothing(self):
        environment = self.fake("rsvg-convert", "echo 'it is full' >&2; exit 1")
        for name in ["a.png", "a.pdf", "a.gif"]:
            (self.folder / name).write_text("mine")
        for words in [["picture", "one", "--output", "a.png"], ["plot", "one", "--output", "a.pdf"],
                      ["movie", "one", "--output", "a.png"], ["movie", "one", "--output", "a.gif"]]:
            if words[-1] == "a.gif" and not HAS_ENCODER:
                continue
            with self.subTest(words):
                _, err = self.udar(*words, code=6, env=environment)
                self.assertIn("`rsvg-convert` failed: it is full", err)
        self.only_new("a.png", "a.pdf", "a.gif", "programs")
        for name in ["a.png", "a.pdf", "a.gif"]:
            self.assertEqual((self.folder / name).read_text(), "mine")

    def test_interrupt_leaves_nothing(self):
        environment = self.fake("rsvg-convert", f"echo $$ >> {self.folder}/programs/pids; exec sleep 60")
        for number, code in {signal.SIGINT: 130, signal.SIGTERM: 143}.items():
            with self.subTest(number):
                pids = self.folder / "programs/pids"
                pids.unlink(missing_ok=True)
                with subprocess.Popen([PROGRAM, "movie", "one", "--output", "a.png"], cwd=self.folder, env=environment,
                                      stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
                    for _ in range(500):
                        if pids.exists() and pids.read_text().endswith("\n"):
                            break
                        time.sleep(0.02)
                    running.send_signal(number)
                    out, err = running.communicate(timeout=20)
                self.assertEqual(running.returncode, code, err)
                self.assertIn(b"a.png was not made", out)
                for pid in map(int, pids.read_text().split()):
                    self.assertFalse(pathlib.Path(f"/proc/{pid}").exists())
                self.only_new("programs")

    @unittest.skipUnless(HAS_CONVERTER, "rsvg-convert is not installed")
    def test_png_and_pdf(self):
        self.udar("picture", "one", "--output", "a.png", "--width", "640")
        head = chunks_of((self.folder / "a.png").read_bytes())[0][1]
        self.assertEqual(struct.unpack(">I", head[:4])[0], 640)
        self.udar("plot", "one", "--output", "a.pdf")
        self.assertEqual((self.folder / "a.pdf").read_bytes()[:5], b"%PDF-")

    @unittest.skipUnless(HAS_CONVERTER, "rsvg-convert is not installed")
    def test_animated_png(self):
        out, _ = self.udar("movie", "one", "--output", "a.png", "--width", "301", "--fps", "8")
        self.assertIn("a.png: 4 frames at 8 a second", out)
        chunks = chunks_of((self.folder / "a.png").read_bytes())
        kinds = [kind for kind, _ in chunks]
        self.assertEqual(kinds[0], "IHDR")
        self.assertEqual(kinds[-1], "IEND")
        self.assertEqual(kinds.count("acTL"), 1)
        self.assertLess(kinds.index("acTL"), kinds.index("IDAT"))
        self.assertEqual(kinds.count("fcTL"), 4)
        self.assertEqual(dict(chunks)["acTL"], struct.pack(">II", 4, 0))
        self.assertEqual(struct.unpack(">I", chunks[0][1][:4])[0], 300)
        numbers = [struct.unpack(">I", body[:4])[0] for kind, body in chunks if kind in ("fcTL", "fdAT")]
        self.assertEqual(numbers, list(range(len(numbers))))
        delay = next(body for kind, body in chunks if kind == "fcTL")[20:24]
        self.assertEqual(struct.unpack(">HH", delay), (125, 1000))
        # Every frame unpacks to all rows of the image.
        width, height = struct.unpack(">II", chunks[0][1][:8])
        packed = []
        for kind, body in chunks:
            if kind == "fcTL":
                packed.append(b"")
            elif kind in ("IDAT", "fdAT"):
                packed[-1] += body if kind == "IDAT" else body[4:]
        for data in packed:
            self.assertEqual(len(zlib.decompress(data)) % height, 0)
            self.assertGreaterEqual(len(zlib.decompress(data)), height * (1 + 3 * width))

    @unittest.skipUnless(HAS_CONVERTER, "rsvg-convert is not installed")
    def test_movie_without_encoder(self):
        programs = self.folder / "programs"
        programs.mkdir()
        (programs / "rsvg-convert").symlink_to(shutil.which("rsvg-convert"))
        out, _ = self.udar("movie", "one", "--output", "a.mp4", "--width", "200", env={"PATH": str(programs)})
        self.assertIn("`ffmpeg` is not installed (Debian: ffmpeg): making an animated PNG instead", out)
        self.only_new("a.png", "programs")
        _, err = self.udar("movie", "one", "--output", "a.mp4", "--width", "200", code=6, env={"PATH": str(programs)})
        self.assertIn("a.png is there already", err)

    @unittest.skipUnless(HAS_CONVERTER and HAS_ENCODER, "rsvg-convert or ffmpeg is not installed")
    def test_movie(self):
        for name, begin in {"a.mp4": b"ftyp", "a.webm": b"\x1a\x45\xdf\xa3", "a.gif": b"GIF89a"}.items():
            with self.subTest(name):
                self.udar("movie", "one", "--field", "sigma1", "--width", "301", "--output", name)
                self.assertIn(begin, (self.folder / name).read_bytes()[:16])
        self.only_new("a.mp4", "a.webm", "a.gif")


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
