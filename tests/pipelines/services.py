#!/usr/bin/env python3
"""The GitHub Action and the GitLab template, whose lines are run here as the services run them:
services.py S7200 SOURCE_DIR BUILD_DIR"""
import os
import shutil
import unittest
import xml.etree.ElementTree

from support import ENVIRONMENT, FAILED, FINE, S7200, SOURCE, UNUSABLE, Case, main

try:
    import yaml
except ImportError:
    yaml = None

PIPELINES = SOURCE / "tools/pipelines"
PASSES = SOURCE / "tests/programs/modbus_slave/line.yaml"
FAILS = SOURCE / "tests/bad_input/scenarios/wrong_answer.yaml"
WITHOUT = {**ENVIRONMENT, "PATH": os.environ["PATH"]}  # no s7200 on PATH


def read(path):
    return yaml.safe_load(path.read_text(encoding="utf-8"))


class Service(Case):
    def results(self, name):
        """(scenarios, failures) of a JUnit file."""
        suites = list(xml.etree.ElementTree.parse(self.folder / name).getroot().iter("testsuite"))
        return sum(int(suite.get("tests")) for suite in suites), sum(int(suite.get("failures")) for suite in suites)

    def checkout(self):
        """A checkout of s7200 whose packages.sh builds nothing, but says what it was asked and takes the command of this build."""
        tree = self.folder / "s7200"
        (tree / "tools").mkdir(parents=True)
        shutil.copytree(PIPELINES, tree / "tools/pipelines", ignore=shutil.ignore_patterns("__pycache__"))
        (tree / "tools/packages.sh").write_text(
            "needed_to_build=(cmake:cmake)\n"
            f"install_missing_packages() {{ echo install \"$@\" >>{self.folder}/log; }}\n"
            f"build() {{ echo build \"$@\" \"${{configured_with[@]}}\" >>{self.folder}/log; mkdir -p build/release/tools; "
            f"ln -sf {S7200} build/release/tools/s7200; echo built; }}\n", encoding="utf-8")
        return tree

    def built(self):
        return (self.folder / "log").read_text(encoding="utf-8").splitlines()


@unittest.skipUnless(yaml, "python3-yaml is not installed")
class GitHub(Service):
    def run_step(self, code, scenarios, options="", environment=ENVIRONMENT, folder=PIPELINES / "github", junit=None):
        action = read(PIPELINES / "github/action.yml")
        self.assertEqual(action["runs"]["using"], "composite")
        (step,) = action["runs"]["steps"]
        self.assertEqual(step["shell"], "bash")
        given = {"scenarios": scenarios, "options": options, **({"junit": junit} if junit else {})}
        variables = {}
        for name, value in step["env"].items():
            wanted = value.removeprefix("${{ inputs.").removesuffix(" }}")
            variables[name] = given.get(wanted, action["inputs"][wanted].get("default"))
        return self.ends(code, "bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"], cwd=self.folder,
                         env={**environment, **variables, "GITHUB_ACTION_PATH": str(folder)})

    def test_a_passing_scenario_passes_and_is_in_the_junit_file(self):
        self.run_step(FINE, f"{PASSES}\n")
        tests, failures = self.results("s7200-junit.xml")
        self.assertEqual((tests > 0, failures), (True, 0))

    def test_a_failing_scenario_fails_the_step_and_is_in_the_junit_file(self):
        done = self.run_step(FAILED, f"{PASSES}\n{FAILS}\n", junit="results.xml")
        self.assertIn("FAIL", done.stdout)
        self.assertEqual(self.results("results.xml")[1], 1)

    def test_the_summary_of_the_job_says_what_failed(self):
        summary = self.folder / "step summary"
        summary.touch()
        self.run_step(FAILED, f"{FAILS}\n", environment={**ENVIRONMENT, "GITHUB_STEP_SUMMARY": str(summary)})
        self.assertRegex(summary.read_text(encoding="utf-8"), r"## ✗ 1 scenario: 0 passed, 1 failed\n(?s:.*)\n- line \d+: ")

    def test_scenarios_and_options_may_have_blanks_in_them(self):
        folder = self.folder / "pump station"
        folder.mkdir()
        (folder / "one.yaml").write_text(f"program: {SOURCE}/stl_programs/modbus_slave.stl\nname: at rest\n"
                                         "steps: [{memory: {VW20: 0}}]\n", encoding="utf-8")
        self.run_step(FINE, "pump station", options="--only\nat rest\n--jobs\n2\n")
        self.assertEqual(self.results("s7200-junit.xml"), (1, 0))

    def test_blanks_at_the_ends_of_a_line_and_carriage_returns_are_no_part_of_a_word(self):
        self.run_step(FINE, f"  {PASSES}\t \r\n\r\n", options="--jobs \r\n 2\r\n")
        self.assertEqual(self.results("s7200-junit.xml")[1], 0)

    def test_without_scenarios_the_step_fails(self):
        self.assertIn("nothing to test", self.run_step(UNUSABLE, "").stderr)

    @unittest.skipIf(shutil.which("s7200", path=WITHOUT["PATH"]), "s7200 is installed here")
    def test_without_the_command_it_is_built_of_the_checkout_of_the_action(self):
        tree = self.checkout()
        done = self.run_step(FINE, str(PASSES), environment=WITHOUT, folder=tree / "tools/pipelines/github")
        self.assertEqual(self.built(), ["install cmake:cmake", "build release s7200 -DBUILD_TESTING=OFF"])
        self.assertNotIn("built", done.stdout, "what the build says is not among the results")


@unittest.skipUnless(yaml, "python3-yaml is not installed")
class GitLab(Service):
    def run_job(self, code, environment=ENVIRONMENT, **variables):
        job = self.job()
        script = "\n".join(job["script"])
        return self.ends(code, "bash", "-eo", "pipefail", "-c", script, cwd=self.folder,
                         env={**environment, **job["variables"], **variables})

    def job(self):
        return read(PIPELINES / "gitlab/s7200.yml")[".s7200-test"]

    def test_a_passing_scenario_passes_and_is_in_the_junit_file(self):
        self.run_job(FINE, S7200_SCENARIOS=str(PASSES))
        tests, failures = self.results("s7200-junit.xml")
        self.assertEqual((tests > 0, failures), (True, 0))

    def test_a_failing_scenario_fails_the_job_and_is_in_the_junit_file(self):
        self.run_job(FAILED, S7200_SCENARIOS=f"{PASSES} {FAILS}", S7200_OPTIONS="--jobs 2", S7200_JUNIT="results.xml")
        self.assertEqual(self.results("results.xml")[1], 1)

    def test_the_junit_file_is_kept_and_shown_whether_the_job_failed_or_not(self):
        artifacts = self.job()["artifacts"]
        self.assertEqual((artifacts["when"], artifacts["reports"]["junit"]), ("always", "$S7200_JUNIT"))

    @unittest.skipIf(shutil.which("s7200", path=WITHOUT["PATH"]), "s7200 is installed here")
    def test_without_the_command_it_is_built_of_the_checkout(self):
        self.checkout()
        self.run_job(FINE, environment=WITHOUT, S7200_SCENARIOS=str(PASSES))
        self.assertEqual(self.built(), ["install cmake:cmake", "build release s7200 -DBUILD_TESTING=OFF"])

    @unittest.skipIf(shutil.which("s7200", path=WITHOUT["PATH"]), "s7200 is installed here")
    def test_without_command_and_checkout_the_job_says_what_to_do(self):
        done = self.run_job(UNUSABLE, environment=WITHOUT, S7200_SCENARIOS=str(PASSES))
        self.assertIn("set S7200_CHECKOUT", done.stderr)


main()
