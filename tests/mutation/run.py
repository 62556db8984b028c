#!/usr/bin/env python3
"""Mutation check: do the tests notice when an instruction is wrong?

Changes one thing at a time in the bodies of the instructions and in the rows of their table, builds, and runs the tests.
A mutant that no test notices survives and is printed. Works on a copy of the tree; the tree itself is not touched.

    tests/mutation/run.py                 every mutant (hours)
    tests/mutation/run.py --sample 100    so many, spread evenly over all
    tests/mutation/run.py --list          what would be changed
    tests/mutation/run.py --work DIR      keep the copy and its build there, so that a second run starts at once

Exit code 0 when at least 95 % of the mutants were noticed. A mutant that does not compile is not counted.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BODIES = "interpreter/instructions"
GOAL = 0.95

# What is changed into what. Each pattern is tried at each place where it stands.
IN_BODIES = [
    (r" <= ", " < "), (r" >= ", " > "), (r" < (?![\w:]+>)", " <= "), (r" > ", " >= "), (r" == ", " != "), (r" != ", " == "),
    (r" && ", " || "), (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " + "), (r" / ", " * "), (r" % ", " / "),
    (r" << ", " >> "), (r" >> ", " << "), (r" & ", " | "), (r" \| ", " & "), (r" \^ ", " & "), (r"\btrue\b", "false"),
    (r"\bfalse\b", "true"), (r"(?<![\w.'])(\d+)(?![\w.'])", lambda m: str(int(m.group(1)) + 1)), (r"\?([^:?]+):([^:;]+)", r"?\2:\1"),
    (r"if \(!", "if ("), (r"\bop\[0\]", "op[1]"), (r"\bop\[1\]", "op[0]"), (r"^(\s*)(cpu\.[^;]*;)$", r"\1;"), (r"^(\s*)return cpu\.", r"\1cpu."),
    (r"std::int16_t", "std::uint16_t"), (r"std::int32_t", "std::uint32_t"),
]
IN_ROWS = [
    (r"\bbox\(", "row("), (r"\bkFrom214\b", "kEveryCpu"), (r"\bkFrom215\b", "kEveryCpu"), (r"Width::Word", "Width::Byte"),
    (r"Width::Double", "Width::Word"), (r"Width::Byte", "Width::Word"), (r"\bkZero\b", "0"), (r"\bkOverflow\b", "0"),
    (r"\bkArithmetic\b", "0"), (r"\{1, 0\}", "{0, 0}"), (r"\{2, -1\}", "{1, -1}"), (r"\{0, 1\}", "{0, 0}"), (r"\btrue>", "false>"),
    (r"\bfalse>", "true>"), (r"std::int16_t", "std::uint16_t"), (r"std::uint16_t", "std::int16_t"), (r"std::int32_t", "std::uint32_t"),
    (r"Join::And", "Join::Or"), (r"Join::Or", "Join::And"), (r"Logic::And", "Logic::Or"), (r"Logic::Xor", "Logic::Or"),
    (r"Relation::GreaterEqual", "Relation::Greater"), (r"Relation::LessEqual", "Relation::Less"), (r"Relation::Equal", "Relation::NotEqual"),
    (r"\bnot_in_interrupt\b", "kAnywhere"), (r"only_in\(kMain,", "only_in(kAnywhere,"), (r"only_in\(kSubroutine,", "only_in(kAnywhere,"),
    (r"\bin_out\(", "in("), (r"\bin\(", "out("),
]


class Mutant:
    def __init__(self, path, number, before, after):
        self.path, self.number, self.before, self.after = path, number, before, after

    def __str__(self):
        return f"{self.path}:{self.number}\n  - {self.before.strip()}\n  + {self.after.strip()}"


def is_code(line):
    text = line.strip()
    return text and not text.startswith(("//", "#", "template <", "namespace", "enum", "static_assert", "inline constexpr"))


def mutants_of(path, patterns, rows_only):
    lines = (ROOT / path).read_text(encoding="utf-8").split("\n")
    in_rows = not rows_only
    for number, line in enumerate(lines, 1):
        if rows_only and re.match(r"  void \w+\(\) \{", line):
            in_rows = True
        if rows_only and line == "  }":
            in_rows = False
        if not in_rows or not is_code(line):
            continue
        code = re.sub(r'"[^"]*"|//.*', lambda m: "\0" * len(m.group(0)), line)  # no change inside texts and comments
        for pattern, replacement in patterns:
            for match in re.finditer(pattern, code):
                changed = match.expand(replacement) if isinstance(replacement, str) else replacement(match)
                after = line[: match.start()] + changed + line[match.end():]
                if "\0" not in changed and after != line:
                    yield Mutant(path, number, line, after)


def all_mutants():
    bodies = sorted(p.name for p in (ROOT / BODIES).glob("*.hpp") if p.name != "instruction.hpp")
    for name in bodies:
        yield from mutants_of(f"{BODIES}/{name}", IN_BODIES, rows_only=False)
    yield from mutants_of(f"{BODIES}/table.cpp", IN_ROWS, rows_only=True)


class Tests:
    """The copy, its build, and the tests from the quickest to the slowest."""

    TARGETS = ["unit_tests", "lockstep_test", "s7200"]

    def __init__(self, work, jobs):
        self.tree, self.build_dir, self.jobs = work / "tree", work / "build", jobs
        if not self.tree.exists():
            shutil.copytree(ROOT, self.tree, ignore=shutil.ignore_patterns("build", ".git"))
            shared = ROOT.parent / "shared"
            if shared.exists():
                (work / "shared").symlink_to(shared)
            self.call(["cmake", "-S", self.tree, "-B", self.build_dir, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0"])

    @staticmethod
    def call(command, timeout=900, env=None):
        try:
            return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=timeout, env=env).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def build(self):
        return self.call(["cmake", "--build", self.build_dir, "-j", str(self.jobs), "--target", *self.TARGETS], timeout=3600)

    def pass_all(self):
        unit = self.build_dir / "tests" / "unit_tests"
        lockstep = self.build_dir / "tests" / "reference_model" / "lockstep_test"
        return (self.call([unit, "--gtest_brief=1", "--gtest_filter=*Vectors*:InstructionTable*"], timeout=60)
                and self.call(["env", "S7200_LOCKSTEP_INSTRUCTIONS=20000", lockstep, "--gtest_filter=*Agrees*/0"], timeout=120)
                and self.call([unit, "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=-*Vectors*:InstructionTable*"], timeout=300)
                and self.call(["ctest", "--test-dir", self.build_dir, "-R", "bad_input"], timeout=300))

    def notice(self, mutant):
        """True or False; None when the mutant does not compile."""
        path = self.tree / mutant.path
        original = path.read_text(encoding="utf-8")
        lines = original.split("\n")
        lines[mutant.number - 1] = mutant.after
        path.write_text("\n".join(lines), encoding="utf-8")
        try:
            return not self.pass_all() if self.build() else None
        finally:
            path.write_text(original, encoding="utf-8")


def main():
    options = argparse.ArgumentParser(description="Mutation check of the instructions", epilog="Example: tests/mutation/run.py --sample 100")
    options.add_argument("--sample", type=int, metavar="N", help="so many mutants, spread evenly")
    options.add_argument("--list", action="store_true", help="print the mutants only")
    options.add_argument("--work", type=pathlib.Path, metavar="DIR", help="where the copy and its build are kept")
    options.add_argument("--jobs", type=int, default=2, metavar="N", help="compilers at a time (default 2)")
    chosen = options.parse_args()

    mutants = list(all_mutants())
    if chosen.sample and chosen.sample < len(mutants):
        mutants = [mutants[i * len(mutants) // chosen.sample] for i in range(chosen.sample)]
    if chosen.list:
        print("\n".join(map(str, mutants)))
        print(f"{len(mutants)} mutants")
        return 0

    work = chosen.work or pathlib.Path(tempfile.mkdtemp(prefix="s7200-mutation-"))
    work.mkdir(parents=True, exist_ok=True)
    tests = Tests(work.resolve(), chosen.jobs)
    if not tests.build() or not tests.pass_all():
        print("the tree itself does not build or pass its tests", file=sys.stderr)
        return 2

    noticed, survivors = 0, []
    for number, mutant in enumerate(mutants, 1):
        result = tests.notice(mutant)
        if result:
            noticed += 1
        elif result is False:
            survivors.append(mutant)
            print(f"survived: {mutant}", flush=True)
        print(f"\r{number} of {len(mutants)}", end="", file=sys.stderr, flush=True)
    if not chosen.work:
        shutil.rmtree(work)
    counted = noticed + len(survivors)
    print(f"\n{noticed} of {counted} mutants noticed ({100 * noticed / max(1, counted):.1f} %), "
          f"{len(mutants) - counted} did not compile")
    return 0 if noticed >= GOAL * counted else 1


if __name__ == "__main__":
    sys.exit(main())
