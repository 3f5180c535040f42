"""Tests of tools/check_layers: every kind of violation, planted, is found, and nothing else."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_layers"


def check(files):
    """Exit status and output of the checker on a tree of {path: text}."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder) / "udar" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        done = subprocess.run([sys.executable, CHECKER, folder], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr


class CheckLayers(unittest.TestCase):
    good = {
        "base/vec2.hpp": "#include <cmath>\n",
        "mesh/mesh.hpp": '#include "udar/base/vec2.hpp"\n',
        "parallel/pool.hpp": "#include <thread>\n",
        "step/step.hpp": '#include "udar/mesh/mesh.hpp"\n',
    }

    def assert_found(self, name, text, reason):
        status, output = check({**self.good, name: text})
        self.assertEqual(status, 1, output)
        self.assertIn(reason, output)
        self.assertIn(f"udar/{name}:", output)
        self.assertEqual(len(output.splitlines()), 1, output)

    def test_a_good_tree_passes(self):
        self.assertEqual(check(self.good), (0, ""))

    def test_upward(self):
        self.assert_found("base/a.cpp", '#include "udar/mesh/mesh.hpp"\n', "base may include no other layer")

    def test_sideways(self):
        self.assert_found("case/a.cpp", '// first line\n#include "udar/step/step.hpp"\n', "case may include")
        self.assert_found("material/a.hpp", '  #  include "udar/mesh/mesh.hpp"\n', "material may include")

    def test_report_never_includes_the_solver(self):
        self.assert_found("report/a.cpp", '#include "udar/mesh/mesh.hpp"\n', "report may include base, results")

    def test_threads(self):
        self.assert_found("step/a.cpp", "#include <mutex>\n", "only parallel may know threads")

    def test_spelling(self):
        self.assert_found("mesh/a.cpp", '#include "mesh.hpp"\n', "included as udar/")
        self.assert_found("mesh/a.cpp", '#include "udar/mesh/../base/vec2.hpp"\n', "included as udar/")
        self.assert_found("mesh/a.cpp", '#include "udar/mesh/gone.hpp"\n', "no such file")
        self.assert_found("mesh/a.cpp", "#include <udar/mesh/mesh.hpp>\n", "with quotes")

    def test_unknown_layer(self):
        self.assert_found("physics/a.cpp", "", "this layer is unknown")

    def test_the_project_itself(self):
        done = subprocess.run([sys.executable, CHECKER], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (0, ""))


if __name__ == "__main__":
    unittest.main()
