"""Tests of tools/check_golden: bits that changed without a word in CHANGELOG.md are found."""

import hashlib
import pathlib
import subprocess
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_golden"
HASHES = "short-beam 100 0123456789abcdef\nstack 100 fedcba9876543210\n"
DIGEST = hashlib.sha256(HASHES.encode()).hexdigest()[:8]


def check(changes, hashes=HASHES):
    """Exit status and output of the checker on a tree with this CHANGELOG.md."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "tests" / "simulation").mkdir(parents=True)
        (root / "CHANGELOG.md").write_text(changes, encoding="utf-8")
        if hashes is not None:
            (root / "tests" / "simulation" / "golden_hashes.txt").write_text(hashes, encoding="utf-8")
        done = subprocess.run([CHECKER, folder], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr


class CheckGolden(unittest.TestCase):
    def test_named_with_a_reason(self):
        self.assertEqual(check(f"# Changes\n\n- golden hashes {DIGEST}: springs are met earlier.\n"), (0, ""))

    def test_not_named(self):
        for changes in ("# Changes\n", f"- golden hashes {DIGEST}:\n", "- golden hashes 00000000: another reason\n"):
            status, output = check(changes)
            self.assertEqual(status, 1, changes)
            self.assertIn(f"golden hashes {DIGEST}: why", output)

    def test_one_bit_changed(self):
        status, output = check(f"- golden hashes {DIGEST}: first ones\n", HASHES.replace("abcdef", "abcdee"))
        self.assertEqual(status, 1)
        self.assertIn("other bits than before", output)

    def test_no_hashes(self):
        for hashes in (None, ""):
            self.assertEqual(check(f"- golden hashes {DIGEST}: first ones\n", hashes)[0], 1)

    def test_the_project_itself(self):
        done = subprocess.run([CHECKER], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (0, ""))


if __name__ == "__main__":
    unittest.main()
