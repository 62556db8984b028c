#!/usr/bin/env python3
"""The package for arm64, as far as a few seconds show it: a small program with the libraries of the command, by the toolchain and in the
sysroot of tools/build_arm64, run by qemu and packed. The command itself takes minutes; tests/release has it.

    arm64.py S7200 SOURCE_DIR BUILD_DIR
"""
import re
import shutil
import unittest

from support import ENVIRONMENT, FINE, SOURCE, Case, main, run

PROJECT = f"""
cmake_minimum_required(VERSION 3.25)
project(s7200 VERSION 0.1.0 LANGUAGES CXX DESCRIPTION "Prints what its libraries are")
find_package(Boost 1.74 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(ZLIB REQUIRED)
find_library(EDIT_LIBRARY edit REQUIRED)
find_library(TERMINFO_LIBRARY tinfo REQUIRED)
add_executable(s7200 libraries.cpp)
target_link_libraries(s7200 PRIVATE Boost::headers fmt::fmt CLI11::CLI11 nlohmann_json::nlohmann_json yaml-cpp ZLIB::ZLIB
  ${{EDIT_LIBRARY}} ${{TERMINFO_LIBRARY}})
install(TARGETS s7200 COMPONENT command)
include({SOURCE}/cmake/package.cmake)
"""
LIBRARIES = """
#include <fmt/format.h>
#include <histedit.h>
#include <yaml-cpp/yaml.h>
#include <zlib.h>
#include <curses.h>
#include <term.h>

int main() {
  const bool edits = el_init("libraries", stdin, stdout, stderr) != nullptr;
  fmt::print("{} bytes a pointer, YAML of {}, zlib {}, {}, {}", sizeof(void*), YAML::Load("[1, 2]").size(), zlibVersion()[0],
             edits ? "lines are edited" : "no line editor", tigetnum("no_such_name") < 0 ? "terminals are known" : "no terminals");
}
"""


@unittest.skipUnless(all(map(shutil.which, ("aarch64-linux-gnu-g++", "qemu-aarch64", "cpack", "dpkg-shlibdeps"))),
                     "no compiler for arm64: apt-get install g++-aarch64-linux-gnu qemu-user dpkg-dev")
class Arm64(Case):
    def test_a_program_with_the_libraries_runs_and_its_package_names_them(self):
        fetched = run(SOURCE / "tools/build_arm64", "--sysroot", timeout=240)
        if fetched.returncode != FINE:
            self.skipTest(f"the libraries for arm64 cannot be fetched: {fetched.stderr}")
        sysroot = fetched.stdout.strip()
        (self.folder / "CMakeLists.txt").write_text(PROJECT, encoding="utf-8")
        (self.folder / "libraries.cpp").write_text(LIBRARIES, encoding="utf-8")
        build = self.folder / "build"
        self.ends(FINE, "cmake", "-G", "Ninja", "-S", self.folder, "-B", build, "--toolchain", SOURCE / "cmake/toolchains/aarch64-linux.cmake")
        self.ends(FINE, "cmake", "--build", build)
        self.assertEqual(self.ends(FINE, "qemu-aarch64", "-L", sysroot, build / "s7200").stdout,
                         "8 bytes a pointer, YAML of 2, zlib 1, lines are edited, terminals are known")

        self.ends(FINE, "cpack", "--config", build / "CPackConfig.cmake",
                  env={**ENVIRONMENT, "DEB_HOST_ARCH": "arm64", "DPKG_ADMINDIR": f"{sysroot}/var/lib/dpkg"})
        (package,) = (build / "packages").glob("s7200_*_arm64.deb")
        shown = self.ends(FINE, "dpkg-deb", "-I", package).stdout
        self.assertIn("\n Architecture: arm64\n", shown)
        needed = re.search(r"\n Depends: (.*)\n", shown).group(1)
        for library in ("libc6", "libstdc++6", "libgcc-s1", "libedit2", "libfmt9", "libtinfo6", "libyaml-cpp0.7", "zlib1g"):
            self.assertIn(f"{library} (>= ", needed)


main()
