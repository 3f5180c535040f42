"""What the tests of the program share."""

import pathlib
import subprocess

# For a program that hangs; one built for debugging may take a minute over a study.
SECONDS = 300


def run_program(test, program, words, code, **options):
    """Runs the program in the folder of a test, which asks for this exit code and no internal error; returns standard
    output and standard error."""
    done = subprocess.run([program, *map(str, words)], cwd=test.folder, capture_output=True, timeout=SECONDS, check=False,
                          **options)
    out, err = done.stdout.decode(), done.stderr.decode()
    test.assertEqual(done.returncode, code, out + err)
    test.assertNotIn("internal error", err)
    return out, err


def has_address_sanitizer(program):
    """Whether it was built with AddressSanitizer, which takes terabytes of addresses and memory of its own."""
    return b"__asan_init" in pathlib.Path(program).read_bytes()
