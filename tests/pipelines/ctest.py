#!/usr/bin/env python3
"""The module S7200Test of CMake in a project that uses it: ctest.py S7200 SOURCE_DIR BUILD_DIR"""
import os
import re
import shutil
import unittest
import xml.etree.ElementTree

from support import ENVIRONMENT, FAILED, FINE, S7200, SOURCE, Case, main, run

PROJECT = SOURCE / "tests/pipelines/ctest_project"
MODULES = SOURCE / "tools/pipelines/ctest"


class Project(Case):
    def configure(self, code=FINE, project=PROJECT, **options):
        words = [f"-D{name}={value}" for name, value in {"CMAKE_MODULE_PATH": MODULES, **options}.items()]
        return self.ends(code, "cmake", "-S", project, "-B", self.folder / "build", *words)

    def ctest(self, *words):
        return run("ctest", "--test-dir", self.folder / "build", *words)

    def test_each_scenario_is_a_test_and_fails_as_the_scenario_does(self):
        self.configure()
        shown = self.ctest().stdout
        self.assertEqual(re.findall(r"Test +#\d+: (\S+) \.+\s*(Passed|\*\*\*Failed)", shown),
                         [("plant.level", "Passed"), ("plant.wrong_level", "***Failed")])

    def test_options_and_junit_files_are_those_of_the_test(self):
        self.configure()
        self.ctest()
        for name, failures in (("level", "0"), ("wrong_level", "1")):
            (suite,) = xml.etree.ElementTree.parse(self.folder / f"build/plant.{name}.xml").getroot().iter("testsuite")
            self.assertEqual((suite.get("tests"), suite.get("failures")), ("1", failures))
        self.assertIn("limits.yaml", self.ctest("-N", "--verbose").stdout)

    def test_the_lines_of_the_readme_make_tests_of_a_project(self):
        lines = re.findall(r"(?m)^    (.+)$", (MODULES / "README.md").read_text(encoding="utf-8"))
        project = self.folder / "readme"
        (project / "scenarios").mkdir(parents=True)
        for name in ("plant.yaml", "scenarios/start.yaml", "scenarios/alarm.yaml"):
            (project / name).write_text("# empty\n", encoding="utf-8")
        text = "\n".join(["cmake_minimum_required(VERSION 3.20)", "project(readme LANGUAGES NONE)", *lines])
        (project / "CMakeLists.txt").write_text(text.replace("/usr/share/s7200/cmake", str(MODULES)), encoding="utf-8")
        self.configure(project=project)
        self.assertEqual(re.findall(r"Test +#\d+: (\S+)", self.ctest("-N").stdout), ["pump.start", "pump.alarm"])

    def changed(self, old, new):
        copy = self.folder / "project"
        shutil.copytree(PROJECT, copy)
        text = (copy / "CMakeLists.txt").read_text(encoding="utf-8")
        self.assertIn(old, text)
        (copy / "CMakeLists.txt").write_text(text.replace(old, new), encoding="utf-8")
        return copy

    def test_a_scenario_that_does_not_exist_is_refused(self):
        done = self.configure(FAILED, self.changed("level.yaml", "frob.yaml"))
        self.assertIn("there is no scenario", done.stderr)
        self.assertIn("scenarios/frob.yaml", done.stderr)

    def test_a_call_without_files_is_refused(self):
        self.assertIn("wants PREFIX FILES", self.configure(FAILED, self.changed("FILES", "")).stderr)

    @unittest.skipIf(shutil.which("s7200", path=os.environ["PATH"]), "s7200 is installed here")
    def test_without_the_command_the_project_is_not_configured(self):
        done = self.ends(FAILED, "cmake", "-S", PROJECT, "-B", self.folder / "build", f"-DCMAKE_MODULE_PATH={MODULES}",
                         env={**ENVIRONMENT, "PATH": os.environ["PATH"]})
        self.assertIn("s7200 is not on PATH", done.stderr)

    def test_the_command_on_path_is_used(self):
        self.configure()
        cache = (self.folder / "build/CMakeCache.txt").read_text(encoding="utf-8")
        self.assertTrue(os.path.samefile(re.search(r"S7200_COMMAND:FILEPATH=(.*)", cache).group(1), S7200))


main()
