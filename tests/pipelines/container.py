#!/usr/bin/env python3
"""The Containerfile, as far as it can be tried without a network: container.py S7200 SOURCE_DIR BUILD_DIR"""
import os
import re
import shutil
import unittest

from support import ENVIRONMENT, FINE, S7200, SOURCE, Case, main

CONTAINERFILE = SOURCE / "tools/pipelines/container/Containerfile"


def stages():
    """[[(instruction, its text)]], a list for each FROM. What ARG names before the first one is put in there."""
    text = re.sub(r"(?m)^#.*\n", "", CONTAINERFILE.read_text(encoding="utf-8")).replace("\\\n", "")
    found, named = [], {}
    for line in filter(None, text.split("\n")):
        instruction, words = line.split(" ", 1)
        if instruction == "ARG" and not found:
            named.update([words.split("=", 1)])
            continue
        if instruction == "FROM":
            words = re.sub(r"\$\{(\w+)\}", lambda name: named[name[1]], words)
            found.append([])
        found[-1].append((instruction, words.strip()))
    return found


def all_of(stage, instruction):
    return [words for name, words in stage if name == instruction]


@unittest.skipUnless(shutil.which("bash"), "bash is not installed")
class Container(Case):
    def setUp(self):
        super().setUp()
        self.build, self.final = stages()

    def copied(self):
        """The build stage's folder, with what it copies, and the commands of the build stage in it."""
        tree = self.folder / "s7200"
        tree.mkdir()
        for words in all_of(self.build, "COPY"):
            *sources, target = words.split()
            for source in sources:
                self.assertTrue((SOURCE / source).exists(), f"there is no {source} to copy")
                to = tree / target / source if target.endswith("/") else tree / target
                if (SOURCE / source).is_dir():
                    shutil.copytree(SOURCE / source, to)
                else:
                    shutil.copy(SOURCE / source, to)
        return tree

    def run_line(self, tree, line):
        """With cmake and cpack that say what they are asked, and without installing anything."""
        commands = self.folder / "commands"
        commands.mkdir(exist_ok=True)
        for name in ("cmake", "cpack", "apt-get"):
            (commands / name).write_text(f'#!/bin/sh\necho {name} "$@" >>{self.folder}/log\n', encoding="utf-8")
            (commands / name).chmod(0o755)
        self.ends(FINE, "bash", "-euo", "pipefail", "-c", line, cwd=tree, env={**ENVIRONMENT, "PATH": f"{commands}:{os.environ['PATH']}"})

    def test_the_lines_of_the_build_stage_run_in_bash_on_what_is_copied(self):
        tree = self.copied()
        for line in all_of(self.build, "RUN"):
            self.run_line(tree, line)
        log = (self.folder / "log").read_text(encoding="utf-8").splitlines()
        asked = [line for line in log if not line.startswith("apt-get")]
        self.assertEqual(asked[:2], ["cmake --preset release -DBUILD_TESTING=OFF", "cmake --preset release"])
        self.assertRegex(asked[2], r"^cmake --build --preset release --parallel \d+ --target s7200 page_file$")
        self.assertEqual(asked[3:], ["cpack --config build/release/CPackConfig.cmake"])

    def test_what_is_copied_can_be_configured(self):
        """With the options of the build stage: no file is missing that the build asks for."""
        (configure,) = re.findall(r"cmake (--preset release [^;]*);", " ".join(all_of(self.build, "RUN")))
        tree = self.copied()
        self.ends(FINE, "cmake", *configure.split(), cwd=tree)
        self.assertTrue((tree / "build/release/CPackConfig.cmake").exists())

    def test_all_that_is_installed_comes_from_the_one_list_of_packages(self):
        for line in all_of(self.build, "RUN"):
            self.assertNotIn("apt-get", line)
        installed = re.findall(r"apt-get install ([^&;]*)", " ".join(all_of(self.final, "RUN")))
        self.assertEqual([words.split()[-1] for words in installed], ["/tmp/s7200_*.deb"])

    def test_without_tests_no_package_is_needed_that_only_tests_use(self):
        needed = self.ends(FINE, "bash", "-c", 'source tools/packages.sh; echo "${needed_to_build[@]}"', cwd=SOURCE).stdout
        self.assertNotRegex(needed, "gtest|benchmark")

    def test_both_stages_are_one_slim_debian_12_by_its_digest(self):
        bases = [all_of(stage, "FROM")[0].split()[0] for stage in (self.build, self.final)]
        self.assertEqual(bases[0], bases[1])
        self.assertRegex(bases[0], r"^debian:12-slim@sha256:[0-9a-f]{64}$")

    def test_the_package_comes_from_where_cpack_puts_it(self):
        (copied,) = all_of(self.final, "COPY")
        where = re.search(r"CPACK_PACKAGE_DIRECTORY \$\{PROJECT_BINARY_DIR\}/(\w+)", (SOURCE / "cmake/package.cmake").read_text(encoding="utf-8"))
        self.assertEqual(copied, f"--from=build /s7200/build/release/{where.group(1)}/s7200_*.deb /tmp/")

    def test_the_command_that_is_shown_finds_its_scenarios_in_this_tree(self):
        for path in (CONTAINERFILE, CONTAINERFILE.parent / "README.md"):
            (words,) = re.findall(r"podman run .* s7200 s7200 (.*)", path.read_text(encoding="utf-8"))
            self.assertIn("modbus_slave", self.ends(FINE, S7200, *words.split(), "--list", cwd=SOURCE).stdout)

    def test_it_runs_as_a_plain_user_that_exists(self):
        (user,) = all_of(self.final, "USER")
        self.assertNotIn(user, ("root", "0"))
        names = [name for name, _ in self.final]
        created = next(i for i, (name, words) in enumerate(self.final) if name == "RUN" and re.search(rf"useradd .*{user}$", words))
        self.assertLess(created, names.index("USER"))

    def test_the_lines_of_the_final_stage_are_bash(self):
        for line in all_of(self.final, "RUN"):
            self.ends(FINE, "bash", "-n", "-c", line)


main()
