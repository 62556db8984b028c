#!/usr/bin/env python3
"""The manual pages: manual.py S7200 SOURCE_DIR BUILD_DIR"""
import re
import shutil
import unittest

from support import FINE, S7200, UNUSABLE, Case, listed_verbs, main, run


def page(*verb):
    return run(S7200, "manual", *verb).stdout


@unittest.skipUnless(shutil.which("groff"), "groff is not installed")
class Pages(Case):
    def formatted(self, *verb):
        done = self.ends(FINE, "groff", "-man", "-ww", "-Tutf8", "-P-c", input=page(*verb), stdin=None)
        self.assertEqual(done.stderr, "")
        return re.sub(r".\x08", "", done.stdout)

    def test_groff_has_nothing_to_say_of_any_page(self):
        for verb in ([], *([verb] for verb in listed_verbs())):
            with self.subTest(verb):
                self.assertIn("NAME", self.formatted(*verb))

    def test_every_option_of_the_help_is_on_the_page_of_its_verb(self):
        for verb in listed_verbs():
            shown = self.formatted(verb)
            options = re.findall(r"(?m)^  (?:-\w,)?(--[\w-]+)", run(S7200, verb, "--help-all").stdout)
            self.assertIn("--help", options)
            for option in options:
                with self.subTest(f"{verb} {option}"):
                    self.assertRegex(shown, rf"(?m)^ +(-\w,)?{option}\b")

    def test_the_example_of_the_help_is_on_the_page_as_it_is_typed(self):
        for verb in listed_verbs():
            shown = self.formatted(verb)
            for example in re.findall(r"(?m)^Example: (.*)", run(S7200, verb, "--help").stdout):
                self.assertIn(f" {example}\n", shown)

    def test_a_page_has_its_sections_in_the_usual_order(self):
        headings = re.findall(r"(?m)^([A-Z]+(?: [A-Z]+)?)$", self.formatted("run"))
        self.assertEqual(headings, ["NAME", "SYNOPSIS", "ARGUMENTS", "OPTIONS", "NOTES", "EXIT STATUS", "EXAMPLES", "SEE ALSO"])

    def test_the_page_of_test_has_its_own_exit_status(self):
        self.assertIn("a scenario failed", self.formatted("test"))
        self.assertIn("a CPU in STOP", " ".join(self.formatted("check").split()), "the others have that of every verb")

    def test_the_page_of_the_command_names_every_verb(self):
        shown = self.formatted()
        for verb in listed_verbs():
            self.assertRegex(shown, rf"(?m)^ +{verb}\b")
            self.assertIn(f"s7200-{verb}(1)", shown.replace("\N{HYPHEN}", "-"))


class Verb(Case):
    def test_a_page_is_ascii_and_always_the_same(self):
        for verb in listed_verbs():
            self.assertTrue(page(verb).isascii())
            self.assertEqual(page(verb), page(verb))

    def test_a_word_that_is_not_a_verb_has_no_page(self):
        done = self.ends(UNUSABLE, S7200, "manual", "frob")
        self.assertEqual((done.stdout, done.stderr), ("", "s7200: error: 'frob' is not a verb; 's7200 --help' lists them\n"))

    def test_verbs_for_packages_and_shells_are_not_listed(self):
        for hidden in ("manual", "complete"):
            self.assertNotIn(hidden, listed_verbs())
            self.assertNotRegex(run(S7200, "--help").stdout, rf"(?m)^  {hidden}\b")
            self.assertNotIn(hidden, run(S7200, "frobnicate").stderr)
            self.assertIn("Example: s7200 ", self.ends(FINE, S7200, hidden, "--help").stdout)


main()
