#!/usr/bin/env python3
"""The manifests for winget and scoop: manifests.py S7200 SOURCE_DIR BUILD_DIR"""
import hashlib
import json
import re
import zipfile

import yaml

from support import FINE, SOURCE, Case, main

NAME = "s7200-1.2.3-windows"

# What winget's schema 1.6.0 asks of each of its files: the keys that must be there, and those that may.
REQUIRED = {
    "version": {"PackageIdentifier", "PackageVersion", "DefaultLocale", "ManifestType", "ManifestVersion"},
    "defaultLocale": {"PackageIdentifier", "PackageVersion", "PackageLocale", "Publisher", "PackageName", "License", "ShortDescription",
                      "ManifestType", "ManifestVersion"},
    "installer": {"PackageIdentifier", "PackageVersion", "Installers", "ManifestType", "ManifestVersion"},
}
ALLOWED = {"version": set(), "defaultLocale": {"Moniker", "Tags"},
           "installer": {"MinimumOSVersion", "InstallerType", "NestedInstallerType", "NestedInstallerFiles"}}


class Manifests(Case):
    def setUp(self):
        super().setUp()
        self.archive = self.folder / f"{NAME}.zip"
        with zipfile.ZipFile(self.archive, "w") as files:
            files.writestr(f"{NAME}/s7200.exe", "MZ")
        self.sum = hashlib.sha256(self.archive.read_bytes()).hexdigest()

    def made(self):
        self.ends(FINE, SOURCE / "tools/manifests", self.archive, "https://example.org/files", self.folder)
        return self.folder

    def winget(self):
        found = (yaml.safe_load(path.read_text(encoding="utf-8")) for path in self.made().glob("winget/*.yaml"))
        return {manifest["ManifestType"]: manifest for manifest in found}

    def test_winget_finds_the_keys_that_its_schema_asks_for_and_no_others(self):
        manifests = self.winget()
        self.assertEqual(set(manifests), set(REQUIRED))
        for kind, manifest in manifests.items():
            self.assertLessEqual(REQUIRED[kind], set(manifest))
            self.assertLessEqual(set(manifest), REQUIRED[kind] | ALLOWED[kind])
            self.assertEqual((manifest["PackageIdentifier"], manifest["PackageVersion"], manifest["ManifestVersion"]), ("s7200.s7200", "1.2.3", "1.6.0"))
            self.assertRegex(manifest["PackageIdentifier"], r"^[^\.\s\\/:*?\"<>|]{1,32}(\.[^\.\s\\/:*?\"<>|]{1,32}){1,7}$")
        text = manifests["defaultLocale"]
        self.assertTrue(3 <= len(text["ShortDescription"]) <= 256)
        self.assertLessEqual(len(text["Tags"]), 16)

    def test_winget_takes_the_program_out_of_the_zip(self):
        manifest = self.winget()["installer"]
        (file,), (installer,) = manifest["NestedInstallerFiles"], manifest["Installers"]
        self.assertEqual((manifest["InstallerType"], manifest["NestedInstallerType"], installer["Architecture"]), ("zip", "portable", "x64"))
        self.assertIn(file["RelativeFilePath"].replace("\\", "/"), zipfile.ZipFile(self.archive).namelist())
        self.assertEqual(installer["InstallerUrl"], f"https://example.org/files/{NAME}.zip")
        self.assertEqual(installer["InstallerSha256"], self.sum.upper())
        self.assertRegex(installer["InstallerSha256"], "^[A-F0-9]{64}$")

    def test_scoop_takes_the_program_out_of_the_zip(self):
        manifest = json.loads((self.made() / "scoop/s7200.json").read_text(encoding="utf-8"))
        self.assertLessEqual({"version", "homepage", "license"}, set(manifest))
        there = manifest["architecture"]["64bit"]
        self.assertEqual(there, {"url": f"https://example.org/files/{NAME}.zip", "hash": self.sum, "extract_dir": NAME})
        self.assertIn(f"{there['extract_dir']}/{manifest['bin']}", zipfile.ZipFile(self.archive).namelist())

    def test_a_zip_without_the_program_is_refused(self):
        with zipfile.ZipFile(self.archive, "w") as files:
            files.writestr("README.md", "")
        done = self.ends(1, SOURCE / "tools/manifests", self.archive, "https://example.org/", self.folder)
        self.assertRegex(done.stderr, re.escape(f"has no {NAME}/s7200.exe"))

    def test_a_zip_of_another_name_is_refused(self):
        done = self.ends(1, SOURCE / "tools/manifests", self.archive.rename(self.folder / "s7200.zip"), "https://example.org/", self.folder)
        self.assertIn("s7200.zip is not called s7200-VERSION-windows.zip", done.stderr)


main()
