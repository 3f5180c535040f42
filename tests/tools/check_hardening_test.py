"""Tests of tools/check_hardening: programs that lack one thing each are refused for just that."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_hardening"

# A copy whose length is known only when it runs makes a checked one; the array wants a protected stack.
SOURCE = r"""
#include <cstdio>
#include <cstring>
int main(int count, char** words) {
  char copy[64];
  std::strcpy(copy, words[count - 1]);
  return std::printf("%s", copy) < 0;
}
"""
HARD = ["-O2", "-fPIE", "-pie", "-fstack-protector-strong", "-U_FORTIFY_SOURCE", "-D_FORTIFY_SOURCE=2",
        "-Wl,-z,relro,-z,now,-z,noexecstack"]


@unittest.skipIf(shutil.which("g++") is None, "there is no g++")
class CheckHardening(unittest.TestCase):
    def check(self, *options):
        """Exit status and complaints about a program built with these options."""
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder) / "program.cpp"
            source.write_text(SOURCE, encoding="utf-8")
            program = pathlib.Path(folder) / "program"
            subprocess.run(["g++", "-w", *HARD, *options, "-o", program, source], check=True)
            done = subprocess.run([sys.executable, CHECKER, program], capture_output=True, text=True, check=False)
            self.assertEqual(done.stderr, "")
            return done.returncode, done.stdout.splitlines()

    def test_a_hard_program_passes(self):
        self.assertEqual(self.check(), (0, []))

    def test_what_lacks_is_named(self):
        for options, words in [
            (["-fno-PIE", "-no-pie"], "not position-independent"),
            (["-Wl,-z,norelro"], "relocations stay writable"),
            (["-Wl,-z,lazy"], "looked up late"),
            (["-fno-stack-protector"], "no stack protector"),
            (["-U_FORTIFY_SOURCE"], "no checked functions"),
            (["-Wl,-z,execstack"], "the stack may be executed"),
            (["-Wl,-rpath,/tmp"], "names folders for libraries"),
        ]:
            with self.subTest(words):
                status, lines = self.check(*options)
                self.assertEqual(status, 1)
                self.assertEqual(len(lines), 1, lines)
                self.assertIn(words, lines[0])

    def test_what_is_no_program(self):
        for path in [CHECKER, "/no/such/file"]:
            done = subprocess.run([sys.executable, CHECKER, path], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(str(path), done.stdout)


if __name__ == "__main__":
    unittest.main()
