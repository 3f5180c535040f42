#!/usr/bin/env python3
"""The program `udar` and files made to do harm: every one ends with a message and a documented exit code, within 10 s
and 1 GB of memory.

usage: hostile_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest

from hostile_files import CASE, CASES, DIFF, FILES, FRAME, PICTURE, REPORT, SHORT_OF_MEMORY
from program import has_address_sanitizer

PROGRAM = ""
LIMITED = True  # not under the address sanitizer, which takes terabytes of addresses

DOCUMENTED = {0, 2, 3, 4, 5, 6, 7}  # 1 would be an internal error
MEMORY = 1 << 30  # bytes
SECONDS = 10


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
            if words == SHORT_OF_MEMORY and not LIMITED:
                continue  # what is refused depends on the limit; a large machine would take them on
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
        done = subprocess.run([PROGRAM, "check", "bad.toml"], cwd=self.folder, capture_output=True, timeout=SECONDS,
                              check=False)
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


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    LIMITED = not has_address_sanitizer(PROGRAM)
    if not LIMITED:
        SECONDS = 60
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
