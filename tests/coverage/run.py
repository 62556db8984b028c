#!/usr/bin/env python3
"""Line coverage of the library: which lines of interpreter/ do the tests execute?

    tests/coverage/run.py              builds the preset `coverage` (GCC), runs all tests, prints coverage file by file
    tests/coverage/run.py --no-run     prints what the counters of the last run say
    tests/coverage/run.py serial_sim   the same for another folder

Behind each file stand the lines that no test executes. Needs gcov, which comes with GCC. Exit code 0 when at least 95 % of
the lines are executed.
"""
import argparse
import collections
import itertools
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BUILD = ROOT / "build" / "coverage"
GOAL = 0.95


def run_tests(jobs):
    subprocess.run(["cmake", "--preset", "coverage"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", "--preset", "coverage", "-j", str(jobs)], cwd=ROOT, check=True, stdout=sys.stderr)
    for counters in BUILD.rglob("*.gcda"):
        counters.unlink()
    return subprocess.run(["ctest", "--preset", "coverage", "-j", str(jobs)], cwd=ROOT, check=False, stdout=sys.stderr).returncode == 0


def executions(folder):
    """{file: {line: how often}}, over all programs of the build: a header counts wherever it is included."""
    found = collections.defaultdict(collections.Counter)
    for counters in sorted(BUILD.rglob("*.gcda")):
        text = subprocess.run(["gcov", "--json-format", "--stdout", counters], cwd=BUILD, check=True, capture_output=True).stdout
        for line in text.splitlines():
            for file in json.loads(line)["files"]:
                path = pathlib.Path(os.path.normpath(BUILD / file["file"]))
                if not path.is_relative_to(ROOT / folder):
                    continue
                for entry in file["lines"]:
                    found[path.relative_to(ROOT)][entry["line_number"]] += entry["count"]
    return found


def ranges(numbers):
    """[3, 4, 5, 9] as `3-5 9`."""
    texts = []
    for _, group in itertools.groupby(enumerate(numbers), lambda pair: pair[1] - pair[0]):
        run = [number for _, number in group]
        texts.append(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}")
    return " ".join(texts)


def report(found):
    """Prints the table; the part of the lines that is executed."""
    all_lines = all_executed = 0
    for path, lines in sorted(found.items()):
        missed = sorted(number for number, count in lines.items() if count == 0)
        executed = len(lines) - len(missed)
        all_lines, all_executed = all_lines + len(lines), all_executed + executed
        print(f"{100 * executed / len(lines):6.1f} %  {executed:4} of {len(lines):4}  {path}  {ranges(missed)}".rstrip())
    print(f"{100 * all_executed / all_lines:6.1f} %  {all_executed} of {all_lines} lines")
    return all_executed / all_lines


def main():
    options = argparse.ArgumentParser(description="Line coverage by the tests", epilog="Example: nice tests/coverage/run.py")
    options.add_argument("folder", nargs="?", default="interpreter", help="whose lines (default interpreter)")
    options.add_argument("--no-run", action="store_true", help="print what the last run has counted")
    options.add_argument("--jobs", type=int, default=2, metavar="N", help="compilers and tests at a time (default 2)")
    chosen = options.parse_args()
    if not chosen.no_run and not run_tests(chosen.jobs):
        print("tests fail: what they execute is not what is to be measured", file=sys.stderr)
        return 2
    found = executions(chosen.folder)
    if not found:
        print(f"no line of {chosen.folder} has been counted", file=sys.stderr)
        return 2
    return 0 if report(found) >= GOAL else 1


if __name__ == "__main__":
    sys.exit(main())
