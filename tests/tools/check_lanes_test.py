"""Tests of tools/check_lanes: a fused multiply-add and a shared function, planted in objects, are found."""

import functools
import pathlib
import platform
import shutil
import subprocess
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_lanes"
PLAIN = "double f(double a, double b, double c) { return a * b + c; }\n"
# As std::max would be: the linker takes any one of them.
SHARED = "template <class T> [[gnu::noinline]] T twice(T a) { return a + a; }\ndouble g(double a) { return twice(a); }\n"
COMPILERS = [name for name in ("g++", "clang++-14") if shutil.which(name)]


@functools.lru_cache(maxsize=None)
def compiled(compiler, source, options):
    """Bytes of an object."""
    with tempfile.NamedTemporaryFile(suffix=".o") as file:
        command = [compiler, "-x", "c++", "-O2", *options, "-c", "-o", file.name, "-"]
        subprocess.run(command, input=source, text=True, check=True)
        return pathlib.Path(file.name).read_bytes()


def check(compiler, objects):
    """Exit status and output of the checker on a build of {target: (source, options)}."""
    with tempfile.TemporaryDirectory() as folder:
        for target, (source, options) in objects.items():
            path = pathlib.Path(folder) / "CMakeFiles" / f"{target}.dir" / "src" / "a.cpp.o"
            path.parent.mkdir(parents=True)
            path.write_bytes(compiled(compiler, source, tuple(options)))
        done = subprocess.run([CHECKER, folder], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr


@unittest.skipUnless(platform.machine() in ("x86_64", "AMD64"), "asks the compiler for instructions of x86-64")
class CheckLanes(unittest.TestCase):
    exact = ["-mfma", "-ffp-contract=off"]
    fused = ["-mfma", "-ffp-contract=fast"]
    good = {"udar_lanes_step_avx2": (PLAIN, exact), "udar_step": (PLAIN, []), "udar_contact": (SHARED, [])}

    def assert_found(self, target, source, options, reason):
        for compiler in COMPILERS:
            status, output = check(compiler, {**self.good, target: (source, options)})
            self.assertEqual(status, 1, compiler)
            self.assertIn(f"{target}.dir/src/a.cpp.o has {reason}", output)
            self.assertEqual(output.count(" has "), 1, output)

    def test_a_good_build_passes(self):
        for compiler in COMPILERS:
            self.assertEqual(check(compiler, self.good), (0, ""))

    def test_a_fused_multiply_add_in_any_layer(self):
        for target in ("udar_lanes_step_avx2", "udar_base", "udar_material", "udar_contact", "udar_model", "udar_mesh",
                       "udar_step", "udar_case", "udar_output"):
            self.assert_found(target, PLAIN, self.fused, "fused multiply-adds")

    def test_its_kinds(self):
        for expression in ("a * b - c", "c - a * b", "-(a * b) - c"):
            source = f"double f(double a, double b, double c) {{ return {expression}; }}\n"
            self.assert_found("udar_step", source, self.fused, "fused multiply-adds")

    def test_one_that_is_called_by_name(self):
        source = "#include <cmath>\ndouble f(double a, double b, double c) { return std::fma(a, b, c); }\n"
        self.assert_found("udar_output", source, ["-mfma"], "fused multiply-adds")

    def test_a_function_that_the_linker_may_take_for_other_units(self):
        self.assert_found("udar_lanes_step_avx2", SHARED, [], "functions that the linker may take")

    def test_a_build_that_is_none(self):
        for objects in ({}, {"udar_step": (PLAIN, [])}, {"udar_lanes_step_avx2": (PLAIN, [])}):
            status, output = check(COMPILERS[0], objects)
            self.assertEqual(status, 1)
            self.assertIn("it is not built", output)


if __name__ == "__main__":
    unittest.main()
