#!/usr/bin/env python3
"""The tarball for any Linux, made of a build: tarball.py S7200 SOURCE_DIR BUILD_DIR"""
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import unittest

from support import ENVIRONMENT, FINE, S7200, SOURCE, Case, main, run

LICENCES = [pathlib.Path("/usr/share/doc", package, "copyright") for package in ("libcli11-dev", "nlohmann-json3-dev", "wasi-libc")]


def packed(build, umask=0o022):
    """tools/build_tarball of a folder that has the command of the build."""
    (build / "tools").mkdir(parents=True)
    (build / "tools/s7200").symlink_to(S7200)
    return run(SOURCE / "tools/build_tarball", build, umask=umask, timeout=240)


@unittest.skipUnless(shutil.which("dpkg") and os.uname().machine == "x86_64" and all(file.exists() for file in LICENCES),
                     "this is no Debian on x86-64 with the packages that tools/packages.sh lists")
class Tarball(Case):
    def setUp(self):
        super().setUp()
        self.made = packed(self.folder / "build")
        self.assertEqual(self.made.returncode, FINE, self.made.stderr)
        self.archive = pathlib.Path(self.made.stdout.strip())
        self.ends(FINE, "tar", "-xf", self.archive, "-C", self.folder)
        (self.home,) = self.folder.glob("s7200-*-linux")

    def libraries(self):
        """{file: the package of this computer that has it}"""
        found = {}
        for line in run("ldd", S7200).stdout.splitlines():
            if path := re.search(r"(/\S+) \(", line):
                known = [f"{prefix}{path[1]}" for prefix in ("", "/usr")]
                package = run("dpkg", "-S", *known).stdout.split(":")[0]
                found[pathlib.Path(path[1]).name] = package
        return found

    def test_it_is_what_a_user_needs(self):
        """One test, because to pack a command takes seconds: the same bytes whatever the folder and the umask, each library with its
        licence, a link starts it, and in a root that has a shell and nothing else it answers."""
        again = packed(self.folder / "another folder", umask=0o077)
        self.assertEqual(again.returncode, FINE, again.stderr)
        sums = {hashlib.sha256(pathlib.Path(made.stdout.strip()).read_bytes()).hexdigest() for made in (self.made, again)}
        self.assertEqual(len(sums), 1)

        libraries = self.libraries()
        self.assertIn("ld-linux-x86-64.so.2", libraries)
        self.assertEqual({path.name for path in (self.home / "lib").iterdir()}, {*libraries, "s7200"})
        licences = {path.stem for path in (self.home / "licences").iterdir()}
        self.assertEqual(set(libraries.values()) - licences, set())

        (self.folder / "s7200").symlink_to(self.home / "s7200")
        self.assertRegex(self.ends(FINE, self.folder / "s7200", "--version").stdout, r"^s7200 [\d.]+\n$")
        if os.getuid() == 0:
            self.runs_alone()

    def runs_alone(self):
        """In a root with a shell, what the start script calls, and what these two need."""
        root = self.folder / "root"
        for command in ("sh", "dirname", "readlink"):
            program = pathlib.Path(shutil.which(command))
            needed = re.findall(r"(/\S+) \(", run("ldd", program).stdout)
            for file in (f"/bin/{command}", *needed):
                (root / file[1:]).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(program if file == f"/bin/{command}" else file, root / file[1:])
        shutil.copytree(self.home, root / "opt/s7200")
        done = subprocess.run([shutil.which("chroot"), root, "/opt/s7200/s7200", "send", "/opt/s7200/stl_programs/modbus_slave.stl", "--crc", "0103000a0001"],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                              env={**ENVIRONMENT, "PATH": "/bin", "ASAN_OPTIONS": "detect_leaks=0"})  # to look for leaks needs /proc
        self.assertEqual(done.returncode, FINE, done.stderr)
        self.assertIn("answer   01 03 02 00 00", done.stdout)


main()
