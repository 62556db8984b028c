#!/usr/bin/env python3
"""Completion of command lines, by the command itself and in three shells: completion.py S7200 SOURCE_DIR BUILD_DIR"""
import os
import pty
import re
import select
import shlex
import shutil
import subprocess
import time
import unittest

from support import ENVIRONMENT, FINE, S7200, SOURCE, Case, listed_verbs, main, run

SCRIPTS = SOURCE / "tools/completion"

# A command line up to the cursor, and what may stand there. None: a file.
LINES = (
    ("s7200 ru", ["run"]),
    ("s7200 help conv", ["convert"]),
    ("s7200 help west", ["westinghouse"]),
    ("s7200 run --times x --pari", ["--parity"]),
    ("s7200 run --parity ", ["even", "none", "odd"]),
    ("s7200 run --parity e", ["even"]),
    ("s7200 run --parity=o", ["odd"]),
    ("s7200 check --cpu 21", ["212", "214", "215", "216"]),
    ("s7200 check --no-warn double-t", ["double-timer"]),
    ("s7200 master --protocol free", ["freeport-pc"]),
    ("s7200 instructions MOV", ["MOVB", "MOVW", "MOVD", "MOVR"]),
    ("s7200 manual instr", ["instructions"]),
    ("s7200 run --times cpu214", ["cpu214", "cpu214_from_22x"]),
    ("s7200 run --times pump", None),
    ("s7200 run --times ", None),
    ("s7200 master westinghouse:pc12", ["westinghouse:pc1200", "westinghouse:pc1250"]),
    ("s7200 run --tcp 0 westinghouse:hp", ["westinghouse:hppc"]),
    ("s7200 master pump", None),
    ("s7200 master pump.stl loo", ["loopback"]),
    ("s7200 master pump.stl read 40001 diag", ["diagnostics"]),
    ("s7200 master --protocol ppi pump.stl set", ["set-clock"]),
    ("s7200 master westinghouse:hppc --protocol=hppc read-", ["read-register"]),
    ("s7200 check pump", None),
    ("s7200 run --trace pump", None),
    ("s7200 frob pump", None),
)


class Candidates(Case):
    def candidates(self, *words):
        done = self.ends(FINE, S7200, "complete", "--", *words)
        self.assertEqual(done.stderr, "")
        return [line.split("\t")[0] for line in done.stdout.splitlines()]

    def test_what_may_stand_at_the_cursor(self):
        for line, expected in LINES:
            words = line.split(" ")[1:]
            found = [word.split("=")[-1] for word in self.candidates(*words)]
            with self.subTest(line):
                self.assertEqual(found, expected or [])

    def test_verbs_are_those_of_the_help(self):
        helped = re.findall(r"(?m)^  ([\w-]+)  ", run(S7200, "--help").stdout.split("Verbs:")[1].split("Topics,")[0])
        self.assertEqual(self.candidates(""), helped)
        self.assertEqual(self.candidates(), helped)
        self.assertGreater(len(helped), 8)

    def test_options_are_those_of_the_help_with_what_they_mean(self):
        for verb in listed_verbs():
            helped = re.findall(r"(?m)^  (?:-\w,)?(--[\w-]+)", run(S7200, verb, "--help-all").stdout)
            self.assertEqual(sorted(self.candidates(verb, "--")), sorted(helped))
        self.assertIn("--json\tprint the results as JSON\n", run(S7200, "complete", "--", "check", "--js").stdout)

    def test_every_value_that_is_offered_is_taken(self):
        slave = str(SOURCE / "stl_programs/modbus_slave.stl")
        for option in ("--cpu", "--no-warn"):
            for value in self.candidates("check", option, ""):
                self.assertNotEqual(run(S7200, "check", option, value, slave).returncode, 2, f"{option} {value}")

    def test_what_follows_a_value_is_not_the_value_of_its_option(self):
        self.assertEqual(self.candidates("run", "--parity", "even", "--parit"), ["--parity"])
        self.assertEqual(self.candidates("run", "--trace", "--parity", ""), [], "--parity is the name of the trace here")

    def test_an_action_is_no_target(self):
        self.assertEqual(self.candidates("master", "--protocol", "hppc", "westinghouse:hp"), ["westinghouse:hppc"])
        self.assertEqual(self.candidates("master", "pump.stl", "westinghouse:hp"), [])


class Shell(Case):
    """Completes in a folder that has a file `pump.stl`."""

    def setUp(self):
        super().setUp()
        (self.folder / "pump.stl").write_text("MEND\n", encoding="utf-8")

    def completes_all_lines(self, complete):
        for line, expected in LINES:
            with self.subTest(line):
                ends = lambda words: sorted(re.split("[=:]", word)[-1] for word in words)  # fish sorts, bash has no more of it
                self.assertEqual(ends(complete(line)), ends(expected or ["pump.stl"]))


@unittest.skipUnless(shutil.which("bash"), "bash is not installed")
class Bash(Shell):
    def complete(self, line):
        # As readline splits it, for which = and : are words; and files where the function has nothing, as -o default has them.
        words = [word for part in line.split(" ") for word in (re.split("([=:])", part) if part else [""])]
        script = f"""
            source {shlex.quote(str(SCRIPTS / 's7200.bash'))}
            [[ $(complete -p s7200) == 'complete -o default -F _s7200 s7200' ]] || exit 9
            COMP_WORDS=({' '.join(map(shlex.quote, words))}) COMP_CWORD={len(words) - 1}
            _s7200 s7200 {shlex.quote(words[-1])} {shlex.quote(words[-2])}
            [ ${{#COMPREPLY[@]}} -gt 0 ] || COMPREPLY=($(compgen -f -- {shlex.quote(words[-1])}))
            printf '%s\\n' "${{COMPREPLY[@]}}" """
        return self.ends(FINE, "bash", "-c", script, cwd=self.folder).stdout.splitlines()

    def test_bash_completes(self):
        self.completes_all_lines(self.complete)

    def test_a_value_is_completed_right_after_the_equals_sign(self):
        self.assertEqual(self.complete("s7200 run --parity="), ["even", "none", "odd"])


@unittest.skipUnless(shutil.which("fish"), "fish is not installed")
class Fish(Shell):
    def complete(self, line):
        script = f"source {shlex.quote(str(SCRIPTS / 's7200.fish'))}; complete -C {shlex.quote(line)}"
        shown = self.ends(FINE, "fish", "--no-config", "-c", script, cwd=self.folder,
                          env={**ENVIRONMENT, "HOME": str(self.folder)}).stdout
        return [entry.split("\t")[0] for entry in shown.splitlines()]

    def test_fish_completes(self):
        self.completes_all_lines(self.complete)


@unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
class Zsh(Shell):
    """In a shell on a terminal, where a Tab is typed and the line is then printed as zsh has it."""

    def test_zsh_reads_the_function(self):
        self.ends(FINE, "zsh", "-n", SCRIPTS / "_s7200")

    def test_zsh_completes(self):
        for line, completed in (("s7200 ru", "s7200 run"), ("s7200 run --pari", "s7200 run --parity"),
                                ("s7200 run --parity=o", "s7200 run --parity=odd"), ("s7200 check pump", "s7200 check pump.stl")):
            with self.subTest(line):
                self.assertEqual(self.completed(line), completed.split())

    def completed(self, line):
        (self.folder / ".zshrc").write_text(
            f"fpath=({SCRIPTS} $fpath); autoload -U compinit; compinit -u -D; PS1='ready> '\n"
            "zle -N report; report() { print -r -- $BUFFER >line; exit }; bindkey '^X' report\n", encoding="utf-8")
        primary, secondary = pty.openpty()
        shell = subprocess.Popen(["zsh", "-i"], cwd=self.folder, stdin=secondary, stdout=secondary, stderr=secondary,
                                 env={**ENVIRONMENT, "ZDOTDIR": str(self.folder), "TERM": "dumb"}, start_new_session=True)
        os.close(secondary)
        try:
            self.read_until(primary, b"ready> ")
            os.write(primary, line.encode() + b"\t\x18")
            end = time.monotonic() + 60
            while shell.poll() is None and time.monotonic() < end:
                if select.select([primary], [], [], 0.05)[0]:
                    try:
                        os.read(primary, 4096)
                    except OSError:  # the shell has gone
                        break
            shell.wait(timeout=60)
        finally:
            shell.kill()
            shell.wait()
            os.close(primary)
        return (self.folder / "line").read_text(encoding="utf-8").split()

    def read_until(self, stream, mark):
        seen, end = b"", time.monotonic() + 60
        while mark not in seen:
            self.assertLess(time.monotonic(), end, seen)
            if select.select([stream], [], [], 0.1)[0]:
                seen += os.read(stream, 4096)


main()
