#!/usr/bin/env python3
"""The plug-in of pytest and its example: pytest_plugin.py S7200 SOURCE_DIR BUILD_DIR"""
import os
import shutil
import subprocess
import tomllib
import unittest

from support import ENVIRONMENT, FAILED, FINE, SOURCE, Case, main

FOLDER = SOURCE / "tools/pipelines/pytest"
QUIET = {**ENVIRONMENT, "PYTHONDONTWRITEBYTECODE": "1"}


def can_import(module):
    return shutil.which("pytest-3") and subprocess.run(["/usr/bin/python3", "-c", f"import {module}"], capture_output=True, check=False).returncode == 0


@unittest.skipUnless(shutil.which("pytest-3"), "python3-pytest is not installed")
class Plugin(Case):
    def pytest(self, code, text, environment=QUIET):
        (self.folder / "test_it.py").write_text(f"SLAVE = {str(SOURCE / 'stl_programs/modbus_slave.stl')!r}\n{text}", encoding="utf-8")
        return self.ends(code, "pytest-3", "-p", "pytest_s7200", "-p", "no:cacheprovider", self.folder,
                         env={**environment, "PYTHONPATH": str(FOLDER)}).stdout

    @unittest.skipUnless(can_import("pymodbus"), "python3-pymodbus is not installed")
    def test_the_example_passes(self):
        self.assertIn("3 passed", self.ends(FINE, "pytest-3", FOLDER / "example", env=QUIET).stdout)

    def test_a_plc_has_a_port_while_the_test_runs_and_none_after_it(self):
        self.pytest(FINE, "import os\nports = []\n"
                          "def test_one(s7200_plc):\n"
                          "    ports.extend([s7200_plc(SLAVE).port, s7200_plc(SLAVE, speed=1, ready=0).port])\n"
                          "    assert ports[0] != ports[1] and all(map(os.path.exists, ports))\n"
                          "def test_two():\n    assert ports and not any(map(os.path.lexists, ports))\n")

    def test_what_a_plc_printed_is_returned_when_it_is_stopped(self):
        self.pytest(FINE, "def test_it(s7200_plc):\n"
                          "    plc = s7200_plc(SLAVE, '--set', 'VW20=1234', '--dump', 'VW20')\n"
                          "    assert '1234' in plc.stop() and plc.stop() == plc.stop()\n")

    def test_memory_and_inputs_are_read_and_written_while_it_runs(self):
        (self.folder / "copy.stl").write_text("NETWORK 1\nLD I0.3\n= Q0.1\nLD SM0.0\nMOVW VW0, VW2\nMEND\n", encoding="utf-8")
        self.pytest(FINE, "import time\n"
                          "def test_it(s7200_plc):\n"
                          f"    plc = s7200_plc({str(self.folder / 'copy.stl')!r}, '--set', 'VW0=-5', speed=100)\n"
                          "    assert plc.memory['VW2'] == -5 and plc.memory['Q0.1'] == 0\n"
                          "    plc.inputs['I0.3'] = 1\n"
                          "    plc.memory['VW0'] = 7\n"
                          "    time.sleep(0.2)\n"
                          "    assert plc.memory['VW2'] == 7 and plc.memory['Q0.1'] == 1\n"
                          "    plc.force('I0.3', 0)\n"
                          "    time.sleep(0.2)\n"
                          "    assert plc.memory['Q0.1'] == 0\n"
                          "    plc.unforce('I0.3')\n"
                          "    time.sleep(0.2)\n"
                          "    assert plc.memory['Q0.1'] == 1\n"
                          "    with plc.at('50ms'):\n"
                          "        assert plc.memory['VW2'] == -5\n"
                          "    assert plc.memory['VW2'] == 7\n")

    def test_an_assertion_about_memory_says_who_wrote_it(self):
        (self.folder / "count.stl").write_text("NETWORK 1\nLD SM0.1\nMOVW 5, VW2\nMEND\n", encoding="utf-8")
        shown = self.pytest(FAILED, f"def test_it(s7200_plc):\n    assert s7200_plc({str(self.folder / 'count.stl')!r}).memory['VW2'] == 6\n")
        self.assertIn("VW2 is 5: VW2 was 16#0000 (0), became 16#0005 (5)", shown)
        self.assertIn("MOVW", shown)

    def test_an_address_that_does_not_exist_is_refused_in_words(self):
        shown = self.pytest(FAILED, "def test_it(s7200_plc):\n    s7200_plc(SLAVE).memory['VW99999']\n")
        self.assertIn("Refused", shown)
        self.assertIn("VW99999", shown)

    def test_a_plc_whose_messages_nobody_reads_runs_on(self):
        self.pytest(FINE, "def test_it(s7200_plc):\n"
                          "    plc = s7200_plc(SLAVE)\n"
                          "    for _ in range(2000):\n"
                          "        plc._ask('evaluate', expression='VB0:64', context='repl')\n"
                          "    assert plc.memory['VW20'] == 0\n")

    def test_when_a_plc_cannot_be_stopped_the_others_are_all_the_same(self):
        shown = self.pytest(FAILED, "import os, pytest_s7200, signal\n"
                                    "ports = []\n"
                                    "def test_one(s7200_plc):\n"
                                    "    plcs = [s7200_plc(SLAVE) for _ in range(3)]\n"
                                    "    ports.extend(plc.port for plc in plcs)\n"
                                    "    plcs[1]._session._process.send_signal(signal.SIGSTOP)\n"
                                    "    pytest_s7200.PATIENCE = 1\n"
                                    "def test_two():\n"
                                    "    assert [os.path.lexists(port) for port in ports] == [False, True, False]\n")
        self.assertIn("2 passed, 1 error", shown)

    def test_a_program_with_errors_fails_the_test_with_what_s7200_says(self):
        (self.folder / "wrong.stl").write_text("FROB\n", encoding="utf-8")
        shown = self.pytest(FAILED, f"def test_it(s7200_plc):\n    s7200_plc({str(self.folder / 'wrong.stl')!r})\n")
        self.assertIn("unknown instruction 'FROB'", shown)

    @unittest.skipIf(shutil.which("s7200", path=os.environ["PATH"]), "s7200 is installed here")
    def test_without_the_command_the_test_fails_and_says_so(self):
        shown = self.pytest(FAILED, "def test_it(s7200_plc):\n    pass\n", {**QUIET, "PATH": os.environ["PATH"]})
        self.assertIn("s7200 is not on PATH", shown)


class Metadata(Case):
    def test_the_entry_point_is_the_plug_in(self):
        project = tomllib.loads((FOLDER / "pyproject.toml").read_text(encoding="utf-8"))
        (module,) = project["project"]["entry-points"]["pytest11"].values()
        self.assertEqual(project["tool"]["setuptools"]["py-modules"], [module])
        self.assertTrue((FOLDER / f"{module}.py").exists())


main()
