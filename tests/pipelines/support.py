"""What the tests of tools/completion and tools/pipelines share: run with S7200 SOURCE_DIR BUILD_DIR as arguments."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

S7200, SOURCE, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:4])
FINE, FAILED, UNUSABLE = range(3)
ENVIRONMENT = {**os.environ, "PATH": f"{S7200.parent}:{os.environ['PATH']}", "NO_COLOR": "1", "LC_ALL": "C.UTF-8"}


def run(*command, **options):
    options = {"stdin": subprocess.DEVNULL, "capture_output": True, "text": True, "timeout": 120, "env": ENVIRONMENT, **options}
    return subprocess.run([str(word) for word in command], check=False, **options)


def listed_verbs():
    """[name] in the order of the help."""
    lines = run(S7200, "complete", "--", "").stdout.splitlines()
    return [line.split("\t")[0] for line in lines]


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def ends(self, code, *command, **options):
        done = run(*command, **options)
        self.assertEqual(done.returncode, code, f"{command}\n{done.stdout}{done.stderr}")
        return done


def main():
    result = unittest.TextTestRunner(stream=sys.stdout).run(unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"]))
    sys.exit(0 if result.wasSuccessful() else 1)
