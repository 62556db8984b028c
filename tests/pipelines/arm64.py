#!/usr/bin/env python3
"""The package for arm64, as far as a few seconds show it: what tools/build_arm64 links with, its toolchain, and what its package needs. The
command itself takes minutes; tests/release has it.

    arm64.py S7200 SOURCE_DIR BUILD_DIR
"""
import re
import shutil
import unittest

from support import ENVIRONMENT, FINE, SOURCE, Case, main, run


@unittest.skipUnless(all(map(shutil.which, ("aarch64-linux-gnu-g++", "qemu-aarch64", "cpack", "dpkg-shlibdeps"))),
                     "no compiler for arm64: apt-get install g++-aarch64-linux-gnu qemu-user dpkg-dev")
class Arm64(Case):
    def setUp(self):
        super().setUp()
        made = run(SOURCE / "tools/build_arm64", "--sysroot", timeout=240)
        if made.returncode != FINE:
            self.skipTest(f"the libraries for arm64 cannot be fetched: {made.stderr}")
        self.sysroot = made.stdout.strip()

    def test_a_program_with_its_libraries_runs_and_its_package_names_them(self):
        self.ends(FINE, "cmake", "-G", "Ninja", "-S", SOURCE / "tests/pipelines/arm64_project", "-B", self.folder, f"-DS7200_SOURCE={SOURCE}",
                  "--toolchain", SOURCE / "cmake/toolchains/aarch64-linux.cmake")
        self.ends(FINE, "cmake", "--build", self.folder)
        self.assertEqual(self.ends(FINE, "qemu-aarch64", "-L", self.sysroot, self.folder / "s7200").stdout,
                         "8 bytes a pointer, YAML of 2, zlib 1, lines are edited, terminals are known\n")
        self.ends(FINE, "cpack", "--config", self.folder / "CPackConfig.cmake",
                  env={**ENVIRONMENT, "DEB_HOST_ARCH": "arm64", "DPKG_ADMINDIR": f"{self.sysroot}/var/lib/dpkg"})
        (package,) = (self.folder / "packages").glob("s7200_*_arm64.deb")
        shown = self.ends(FINE, "dpkg-deb", "-I", package).stdout
        self.assertIn("\n Architecture: arm64\n", shown)
        needed = re.search(r"\n Depends: (.*)\n", shown).group(1)
        for library in ("libc6 (>= ", "libstdc++6 (>= ", "libgcc-s1 (>= ", "libedit2 (>= ", "libfmt9 (>= ", "libtinfo6 (>= ", "libyaml-cpp0.7 (>= ", "zlib1g (>= "):
            self.assertIn(library, needed)


main()
