#!/usr/bin/env python3
"""The Debian package of a build: package.py S7200 SOURCE_DIR BUILD_DIR"""
import gzip
import os
import pathlib
import re
import shutil
import unittest

from support import BUILD, ENVIRONMENT, FINE, SOURCE, Case, listed_verbs, main, run


@unittest.skipUnless(all(map(shutil.which, ("cpack", "dpkg-deb", "dpkg-shlibdeps", "file"))), "cpack cannot make Debian packages here")
class Package(Case):
    @classmethod
    def setUpClass(cls):
        # In a folder of this test's own, so that what a user has packed stays; without compression of data, which takes long.
        cls.made = run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", BUILD / "tests/pipelines/packages",
                       "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none", timeout=240)

    def setUp(self):
        super().setUp()
        self.assertEqual(self.made.returncode, FINE, self.made.stdout + self.made.stderr)
        (self.package,) = (BUILD / "tests/pipelines/packages").glob("s7200_*.deb")

    def unpacked(self):
        self.ends(FINE, "dpkg-deb", "-x", self.package, self.folder)
        return self.folder / "usr"

    def test_a_script_that_makes_packages_refuses_a_word_that_it_does_not_know(self):
        for script in ("release", "build_arm64", "build_windows"):
            done = self.ends(2, SOURCE / "tools" / script, "--pack")
            self.assertIn(f"{script} does not take '--pack'", done.stderr)
            self.assertIn(f"tools/{script} --packed", done.stderr)

    def test_the_control_file_says_what_it_is_and_what_it_needs(self):
        shown = self.ends(FINE, "dpkg-deb", "-I", self.package).stdout
        version = re.search(r"project\(s7200 VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
        self.assertRegex(shown, r"\n Description: Cycle-level interpreter .*\n  Runs the STL programs .*\n  \S")
        for line in ("Package: s7200", f"Version: {version}", "Section: electronics", "Maintainer: The s7200 authors"):
            self.assertIn(f"\n {line}\n", shown)
        needed = re.search(r"\n Depends: (.*)\n", shown).group(1)
        for library in ("libc6 (>= ", "libstdc++6 (>= ", "libedit2", "zlib1g", "libfmt9", "libyaml-cpp0.7"):
            self.assertIn(library, needed)

    def test_it_has_the_command_and_what_explains_it_and_nothing_to_build_with(self):
        shown = self.ends(FINE, "dpkg-deb", "-c", self.package).stdout
        files = set(re.findall(r"(?m)^-.* \./(\S+)$", shown))
        expected = {"usr/bin/s7200", "usr/share/doc/s7200/copyright", "usr/share/man/man1/s7200.1.gz",
                    *(f"usr/share/man/man1/s7200-{verb}.1.gz" for verb in listed_verbs()),
                    "usr/share/bash-completion/completions/s7200", "usr/share/zsh/vendor-completions/_s7200",
                    "usr/share/fish/vendor_completions.d/s7200.fish", "usr/share/s7200/stl_programs/modbus_slave.stl",
                    "usr/share/s7200/cmake/S7200Test.cmake"}
        for package in ("libcli11-dev", "libfmt-dev", "nlohmann-json3-dev", "wasi-libc"):
            if pathlib.Path(f"/usr/share/doc/{package}/copyright").exists():
                expected.add(f"usr/share/doc/s7200/licences/{package}.txt")
        self.assertEqual(expected - files, set())
        beside = {file for file in files - expected if not file.startswith("usr/share/s7200/")}
        self.assertEqual(beside, set())

    def test_its_command_runs_its_programs(self):
        usr = self.unpacked()
        done = self.ends(FINE, usr / "bin/s7200", "send", usr / "share/s7200/stl_programs/modbus_slave.stl", "--crc", "0103000a0001")
        self.assertIn("answer   01 03 02 00 00", done.stdout)

    def test_its_pages_are_those_of_its_command(self):
        usr = self.unpacked()
        for name, words in (("s7200", []), ("s7200-run", ["run"])):
            with gzip.open(usr / f"share/man/man1/{name}.1.gz", "rt", encoding="ascii") as page:
                self.assertEqual(page.read(), run(usr / "bin/s7200", "manual", *words).stdout)

    @unittest.skipUnless(shutil.which("man"), "man is not installed")
    def test_man_finds_its_pages(self):
        usr = self.unpacked()
        shown = self.ends(FINE, "man", "-M", usr / "share/man", "s7200-test", env={**ENVIRONMENT, "MANPAGER": "cat", "MANWIDTH": "100"}).stdout
        self.assertIn("--junit", shown)

    def test_its_licence_is_ours(self):
        self.assertEqual((self.unpacked() / "share/doc/s7200/copyright").read_bytes(), (SOURCE / "LICENSE").read_bytes())


os.umask(0o022)
main()
