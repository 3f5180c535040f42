#!/usr/bin/env python3
"""The program `udar` and files made to do harm: every one ends with a message and a documented exit code, within 10 s
and 1 GB of memory, and nothing is written or started elsewhere.

usage: hostile_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import os
import pathlib
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
import zlib

PROGRAM = ""
LIMITED = True  # not under the address sanitizer, which takes terabytes of addresses

DOCUMENTED = {0, 2, 3, 4, 5, 6, 7}  # 1 would be an internal error
MEMORY = 1 << 30  # bytes
SECONDS = 10

MATERIAL = '[materials.a]\nlaw = "elastic"\ndensity = "7850 kg/m^3"\nyoung_modulus = "200 GPa"\npoisson_ratio = 0.3\n'
RUN = '[run]\nend_time = "20 us"\n'
CASE = RUN + MATERIAL + """
[bodies.block]
material = "a"
velocity = ["0 m/s", "-10 m/s"]
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], element_size = "1 cm" }
[obstacles.stop]
shape = "half_plane"
point = ["0 m", "0 m"]
normal = [0, 1]
[output]
fields_every = "10 us"
"""


def body(name="block", size="1 cm", mesh=None, at="0 m"):
    mesh = mesh or f'{{ shape = "rectangle", size = ["4 cm", "2 cm"], at = ["{at}", "0 m"], element_size = "{size}" }}'
    return f'[bodies.{name}]\nmaterial = "a"\nmesh = {mesh}\n'


def with_mesh(mesh):
    return RUN + MATERIAL + body(mesh=mesh)


def vtu(points, cells, arrays, data=b"", appended="_"):
    """A frame whose header says what it likes."""
    text = ('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64" '
            'compressor="vtkZLibDataCompressor">\n<UnstructuredGrid>\n'
            f'<Piece NumberOfPoints="{points}" NumberOfCells="{cells}">\n{arrays}</Piece></UnstructuredGrid>\n'
            f'<AppendedData encoding="raw">{appended}')
    return text.encode() + data


def array(name, kind="Float64", offset=0, components=3):
    return f'<DataArray Name="{name}" type="{kind}" NumberOfComponents="{components}" format="appended" offset="{offset}"/>\n'


def points(offset=0):
    return "<Points>\n" + array("Points", offset=offset) + "</Points>\n"


def blocks(*sizes, block=1 << 15, last=0, packed=b""):
    return struct.pack(f"<{3 + len(sizes)}Q", len(sizes), block, last, *sizes) + packed


def pvd(*entries):
    return ('<?xml version="1.0"?>\n<VTKFile type="Collection"><Collection>\n' +
            "".join(f'<DataSet timestep="{time}" part="0" file="{name}"/>\n' for time, name in entries) +
            "</Collection></VTKFile>\n").encode()


bomb = zlib.compress(bytes(1 << 29), 9)

# What a case file may try. The words are a part of the message that must come.
CASES = {
    "nanometre elements": (with_mesh('{ shape = "rectangle", size = ["4 cm", "2 cm"], element_size = "1 nm" }'), "far too many elements"),
    "a billion elements": (with_mesh('{ shape = "rectangle", size = ["1 m", "1 m"], element_size = "33 um" }'), "of memory at least"),
    "a billion in a disc": (with_mesh('{ shape = "disc", radius = "1 m", element_size = "60 um" }'), "of memory at least"),
    "a billion in a ring": (with_mesh('{ shape = "ring", outer_radius = "2 m", inner_radius = "1 m", element_size = "0.15 mm" }'), "of memory at least"),
    "a long thin ring": (with_mesh('{ shape = "ring", outer_radius = "100000.001 km", inner_radius = "100000 km", element_size = "1 m" }'), "of memory at least"),
    "fine along a side": (with_mesh('{ shape = "rectangle", size = ["1 m", "1 m"], element_size = "10 cm", finest_size = "0.1 um", finest_side = "top" }'), "of memory at least"),
    "fine in a wide place": (with_mesh('{ shape = "rectangle", size = ["1 m", "1 m"], element_size = "10 cm", finest_size = "40 um", finest_at = ["0.5 m", "0.5 m"], finest_within = "1 m" }'), "of memory at least"),
    "many bodies": (RUN + MATERIAL + "".join(body(f"b{k}", size="0.05 mm", at=f"{k} m") for k in range(30)), "of memory at least"),
    "many obstacles": (RUN + MATERIAL + body(size="20 um", mesh='{ shape = "rectangle", size = ["1 m", "20 um"], element_size = "20 um" }') +
                       "".join(f'[obstacles.o{k}]\nshape = "circle"\ncentre = ["0 m", "-9 m"]\nradius = "1 m"\n' for k in range(9000)), "of memory at least"),
    "infinite time": (CASE.replace('"20 us"', '"1e400 s"'), "too large"),
    "nan": (CASE.replace('"20 us"', '"nan s"'), "unreadable"),
    "nested lists": ("a = " + "[" * 400000 + "]" * 400000, "nested"),
    "nested tables": ("a = " + "{a=" * 200000 + "1" + "}" * 200000, "nested"),
    "a key of many parts": (".".join("a" * 400000) + " = 1", "too many parts"),
    "a long line": ('a = "' + "x" * 1000000 + '"', "unknown key"),
    "a long name": (f'[bodies.{"a" * 900000}]\n', "impossible name"),
    "a list of a million": ("[output]\nfields_at = [" + "1," * 500000 + "]\n", ""),
    "too large": ("#" * (1 << 21), "too large"),
    "a hundred thousand keys": ("".join(f"k{k} = 1\n" for k in range(90000)), "unknown key"),
    "ten thousand bodies": (RUN + MATERIAL + "".join(f"[bodies.b{k}]\n" for k in range(30000)), "missing"),
    "many supports of rigid bodies": (RUN + MATERIAL + "".join(f"[bodies.b{k}]\nrigid = true\n[supports.s{k}]\nbody = \"b{k}\"\n" for k in range(12000)), "missing"),
    "the same key again": ("[run]\n" * 100000, "given twice"),
    "zero bytes": (CASE.encode()[:300] + b"\0" + CASE.encode()[300:], "binary"),
    "broken UTF-8": (CASE.encode() + b'x = "\xff\xfe\xc0\xaf"\n', "UTF-8"),
    "UTF-16": (CASE.encode("utf-16"), "UTF-16"),
    "signs that turn text": (CASE + 'x\u202e = "\u202e"\n', ""),
    "terminal commands": (CASE + '"\\u001b[2J" = 1\n', "unknown key"),
    "nothing": ("", "missing"),
}

# What the files of a run may try: the file, its content, the command that reads it.
FRAME = "fields/bodies_000000.vtu"
PICTURE = ["picture", "run", "--output", "x.svg"]
REPORT = ["report", "run"]
DIFF = ["diff", "run", "whole"]
FILES = {
    "more points than bytes": (FRAME, vtu(10**18, 1, points()), PICTURE),
    "points that overflow": (FRAME, vtu(2**64 - 1, 1, points()), PICTURE),
    "points times nine": (FRAME, vtu(2**61, 0, array("x", components=9)), PICTURE),
    "a bomb": (FRAME, vtu(2**24, 0, points(), blocks(len(bomb), block=1 << 29, packed=bomb)), PICTURE),
    "arrays that share a bomb": (FRAME, vtu(2**20, 0, points() + "<PointData>\n" + "".join(array(f"f{k}") for k in range(200)) + "</PointData>\n",
                                            blocks(len(bomb), block=1 << 29, packed=bomb)), REPORT),
    "empty blocks without end": (FRAME, vtu(0, 0, points() + "<PointData>\n" + array("x") * 200 + "</PointData>\n",
                                            blocks(*[8] * 50000, block=0, packed=zlib.compress(b"") * 50000)), REPORT),
    "a block that ends beyond the file": (FRAME, vtu(1, 0, points(), blocks(2**63, block=24)), PICTURE),
    "an offset beyond the file": (FRAME, vtu(1, 0, points(2**63)), PICTURE),
    "a header without end": (FRAME, b"<VTKFile " + b'a="' * 300000, PICTURE),
    "a million tags": (FRAME, b"<a>" * 300000, REPORT),
    "an index that leads out": ("fields.pvd", pvd((0, "../../../../etc/passwd")), PICTURE),
    "an index of absolute paths": ("fields.pvd", pvd((0, "/etc/passwd")), PICTURE),
    "an index of no times": ("fields.pvd", pvd(("nan", FRAME), ("inf", FRAME)), PICTURE),
    "an index that names a folder": ("fields.pvd", pvd((0, "fields")), PICTURE),
    "the same frame many times": ("fields.pvd", pvd(*((k * 1e-9, FRAME) for k in range(15000))), PICTURE),
    "an index that is no text": ("fields.pvd", bytes(range(256)) * 4000, PICTURE),
    "a summary of brackets": ("summary.json", b"[" * 1000000, REPORT),
    "a summary of huge numbers": ("summary.json", b'{"schema": 1, "elements": 1e308, "steps": -1e400, "threads": 1e99}', REPORT),
    "a summary of wrong kinds": ("summary.json", b'{"schema": 1, "bodies": {"a": [1]}, "contacts": [[[]]]}', DIFF),
    "a history of columns": ("histories/block.csv", b"," * 1000000 + b"\n", DIFF),
    "a history of long lines": ("histories/block.csv", b"time [s],x\n" + b"1" * 1000000 + b",2\n", DIFF),
    "a history of not-a-numbers": ("histories/block.csv", b"time [s],velocity_y [m/s]\n" + b"nan,nan\n" * 1000, DIFF),
    "a log without end": ("log.txt", b"case " * 200000, REPORT),
    "a resolved case that is none": ("resolved.toml", b"[" * 1000000, PICTURE + ["--follow", "block"]),
}


class Hostile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="udar-hostile-"))
        (cls.folder / "case.toml").write_text(CASE)
        cls.udar("run", "case.toml", "--output", "whole", "--no-report")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def udar(cls, *words, **options):
        """Runs the program within the limits."""
        def limit():
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            if LIMITED:
                resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        return subprocess.run([PROGRAM, *map(str, words)], cwd=cls.folder, capture_output=True, timeout=SECONDS, check=False,
                              stdin=subprocess.DEVNULL, preexec_fn=limit, **options)

    def told(self, done, codes=frozenset(DOCUMENTED)):
        """The message of a program that did not succeed, which is no bug and harmless to a terminal."""
        err = done.stderr.decode()
        self.assertIn(done.returncode, codes, err[:2000])
        if done.returncode != 0:
            self.assertTrue("error: " in err, err[:2000])
        self.assertNotIn("internal error", err)
        for text in (err, done.stdout.decode()):
            self.assertFalse([c for c in text if ord(c) < 32 and c != "\n" or c in "\x7f\u202e"], text[:500])
        self.assertLess(len(err), 100000)
        return err

    def test_case_files(self):
        for name, (text, words) in CASES.items():
            with self.subTest(name):
                (self.folder / "bad.toml").write_bytes(text.encode() if isinstance(text, str) else text)
                before = set(self.folder.iterdir())
                for command in ["check", "run"]:
                    err = self.told(self.udar(command, "bad.toml"), codes=DOCUMENTED - {0})
                    self.assertIn(words, err)
                self.assertEqual(set(self.folder.iterdir()), before)

    def test_too_many_elements_without_a_limit(self):
        text, words = CASES["a billion elements"]
        (self.folder / "bad.toml").write_text(text.replace("33 um", "33.1 nm").replace('"1 m", "1 m"', '"1 mm", "1 mm"'))
        done = subprocess.run([PROGRAM, "check", "bad.toml"], cwd=self.folder, capture_output=True, timeout=SECONDS, check=False)
        if 200e9 < os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"):
            self.skipTest("this machine has the memory")
        self.assertEqual(done.returncode, 7)
        self.assertIn(words, done.stderr.decode())

    def test_files_of_a_run(self):
        for name, (file, content, words) in FILES.items():
            with self.subTest(name):
                shutil.rmtree(self.folder / "run", ignore_errors=True)
                shutil.copytree(self.folder / "whole", self.folder / "run")
                (self.folder / "run" / file).write_bytes(content)
                self.told(self.udar(*words))

    def test_what_is_no_file(self):
        (self.folder / "pipe").exists() or os.mkfifo(self.folder / "pipe")
        os.makedirs(self.folder / "folder.toml", exist_ok=True)
        (self.folder / "loop").is_symlink() or os.symlink("loop", self.folder / "loop")
        for name in ["pipe", "folder.toml", "loop", "/dev/zero", "/dev/null", "/proc/self/mem"]:
            for command in [["check"], ["run"], ["diff", "whole"]]:
                with self.subTest(name, command=command):
                    self.told(self.udar(*command, name), codes=DOCUMENTED - {0})
        for name in ["summary.json", "fields.pvd", FRAME, "histories/block.csv", "log.txt"]:
            for kind in ["pipe", "folder", "link"]:
                with self.subTest(name, kind=kind):
                    shutil.rmtree(self.folder / "run", ignore_errors=True)
                    shutil.copytree(self.folder / "whole", self.folder / "run")
                    path = self.folder / "run" / name
                    path.unlink()
                    if kind == "pipe":
                        os.mkfifo(path)
                    elif kind == "folder":
                        path.mkdir()
                    else:
                        path.symlink_to("/dev/zero")
                    for words in [PICTURE, REPORT, DIFF]:
                        self.told(self.udar(*words))

    def test_a_pipe_that_somebody_writes(self):
        reading, writing = os.pipe()
        writer = threading.Timer(0.3, lambda: (os.write(writing, CASE.encode()), os.close(writing)))
        writer.start()
        done = subprocess.run([PROGRAM, "check", f"/dev/fd/{reading}"], capture_output=True, timeout=SECONDS, check=False,
                              pass_fds=[reading])
        writer.join()
        os.close(reading)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"0 errors", done.stdout)


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
        for name in ["it's $(touch x)", "-n;touch x"]:
            with self.subTest(name):
                folder = self.folder / f"{name}.toml"
                folder.write_text(CASE)
                self.udar("sweep", f"./{name}.toml", "--vary", "obstacles.stop.friction=0,0.1", "--list", "--output", f"./{name}")
                for line in (self.folder / name / "runs.txt").read_text().splitlines():
                    path = f"{pathlib.Path(PROGRAM).parent}:{os.environ['PATH']}"
                    subprocess.run(["sh", "-c", line], cwd=self.folder, env={**os.environ, "PATH": path}, check=True, stdout=subprocess.DEVNULL)
                self.assertIn("2 of 2 runs done", self.udar("sweep", f"./{name}.toml", "--vary", "obstacles.stop.friction=0,0.1",
                                                            "--output", f"./{name}", "--no-report")[0])
        self.assertFalse(list(self.folder.rglob("x")))

    def test_the_log_repeats_the_run_in_a_shell(self):
        (self.folder / "it's.toml").write_text(CASE)
        self.udar("run", "./it's.toml", "--output", "run", "--set", "run.end_time='10 us'", "--set", "obstacles.stop.friction=0.1")
        line = next(line for line in (self.folder / "run/log.txt").read_text().splitlines() if "udar run" in line)
        words = subprocess.run(["sh", "-c", "printf '%s\\n' " + line[line.index("udar run"):]], capture_output=True, check=True).stdout
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
        for words in [["run", "case.toml", "--force", "--output", "mine"], ["sweep", "case.toml", "--vary", "obstacles.stop.friction=0,0.1",
                                                                            "--force", "--output", "mine"],
                      ["run", "case.toml", "--force", "--output", "."], ["run", "case.toml", "--force", "--output", ".."]]:
            with self.subTest(words):
                _, err = self.udar(*words, code=2)
                self.assertIn("holds files that are not", err)
        self.untouched()


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    LIMITED = "libasan" not in subprocess.run(["ldd", PROGRAM], capture_output=True, text=True, check=True).stdout
    if not LIMITED:
        SECONDS = 60
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
