#!/usr/bin/env python3
"""Mutation check: do the tests notice when an instruction, a timer, or a condition for passing over scans is wrong?

Changes one thing at a time in the bodies of the instructions, in the rows of their table, in the rules of their operands, and
in what decides which scans are passed over, and runs the tests from the quickest to the slowest until one fails. A mutant that
no test notices survives and is printed.

    tests/mutation/run.py                 every mutant
    tests/mutation/run.py --sample 100    so many, spread evenly over all
    tests/mutation/run.py --list          what would be changed
    tests/mutation/run.py --of FILE       the mutants of this file only; may be given more than once
    tests/mutation/run.py --results FILE  keeps what became of each mutant; what the FILE says was noticed is not run again,
                                          so that a second run goes on, or tries the survivors only
    tests/mutation/run.py --work DIR      keeps the copy of the tree and its build, so that a second run starts at once

Works on a copy of the tree. There the interpreter is a shared library, and a mutant is table.cpp with its bodies, built
alone, that the tests find in front of it (LD_PRELOAD): a second or two, and nothing is linked again. The chains of contacts
take as long as all the rest, and are built with it only when the change is in them or in what they are made of. A file about
scans that are passed over is such a library by itself. CXX names the compiler
(clang++ where there is one): Clang is twice as quick, and has the fast loop without optimisation; GCC has not, so that the
links of the fast loop are changed with Clang only.

equivalent.txt lists mutants that provably change nothing, each with the reason; they are not counted.
Exit code 0 when at least 95 % of those counted were noticed. A mutant that does not compile is not counted.
"""
import argparse
import collections
import concurrent.futures
import itertools
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BODIES = "interpreter/instructions"
TABLE = f"{BODIES}/table.cpp"
RULES = f"{BODIES}/operand_rules.hpp"
CHAINS = f"{BODIES}/contact_chains.cpp"
LINKS = [f"{BODIES}/linked.hpp", CHAINS]
CHAINS_ARE_MADE_OF = [*LINKS, f"{BODIES}/bit_logic.hpp"]
STEADY_SCANS = ["interpreter/cpu/steady_scans.cpp", "interpreter/cpu/idle/idle_scans.cpp", "interpreter/cpu/idle/footprint.cpp",
                "interpreter/cpu/units/timers.cpp", "interpreter/analysis/effects/looks.cpp"]
# Of other files what those about scans hang on: these lines only, each file a library by itself too.
BESIDE_STEADY_SCANS = {"interpreter/cpu/cpu.cpp": r"touched = true", "interpreter/cpu/units/clock.cpp": r"/ second \+ 1",
                       "interpreter/cpu/scan.cpp": r"scan_begin \+= by|update_clocks\(core, s, s\.scan_begin\)|^  s\.next_clock = |scans [%>]|s\.scans \+="}
COMPILER = os.environ.get("CXX") or shutil.which("clang++") or "c++"
EQUIVALENT = pathlib.Path(__file__).resolve().parent / "equivalent.txt"
GOAL = 0.95

# What is changed into what. Each pattern is tried at each place where it stands.
IN_BODIES = [
    (r" <= ", " < "), (r" >= ", " > "), (r" < (?![\w:]+>)", " <= "), (r" > ", " >= "), (r" == ", " != "), (r" != ", " == "),
    (r" && ", " || "), (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " + "), (r" / ", " * "), (r" % ", " / "),
    (r" << ", " >> "), (r" >> ", " << "), (r" & ", " | "), (r" \| ", " & "), (r" \^ ", " & "), (r"\btrue\b", "false"),
    (r"\bfalse\b", "true"), (r"(?<![\w.'])(\d+)(?![\w.'])", lambda m: str(int(m.group(1)) + 1)), (r"\?([^:?]+):([^:;]+)", r"?\2:\1"),
    (r"if \(!", "if ("), (r"\bop\[0\]", "op[1]"), (r"\bop\[1\]", "op[0]"), (r"^(\s*)((?:core\.|\w+::\w+\(core)[^;]*;)$", r"\1;"), (r"^(\s*)return core\.", r"\1core."),
    (r"std::int16_t", "std::uint16_t"), (r"std::int32_t", "std::uint32_t"),
]
IN_ROWS = [
    (r"\bkBox\b", "kCoil"), (r"\bkBox\b", "kPowered"), (r"\bkShiftBox\b", "kCoil"), (r"\bkShiftBox\b", "kBox"), (r"\bkPowered\b", "kCoil"),
    (r"\bkPowered\b", "kBox"), (r"\bkLoop\b", "kCoil"), (r"\bkCpu22x\b", "kEveryCpu"), (r"\bkCpu22xRelease2\b", "kCpu22x"),
    (r"\bkPush\b", "kTop"), (r"\bkTop\b", "kPush"), (r"\bkTwoToOne\b", "kTop"), (r"\bkTwoInputs\b", "kCoil"),
    (r"\bkThreeInputs\b", "kTwoInputs"), (r"\bkFrom214\b", "kEveryCpu"), (r"\bkFrom215\b", "kEveryCpu"), (r"\bkZero\b", "0"),
    (r"\bkOverflow\b", "0"), (r"\bkArithmetic\b", "0"), (r"\bkUnsignedArithmetic\b", "kZero"), (r"\bkMultiplyDivide\b", "kArithmetic"),
    (r"\bkShiftFlags\b", "kZero"), (r"\bkNotInInterrupt\b", "kAnywhere"), (r"allowed = k(Main|Subroutine|Interrupt)\b", "allowed = kAnywhere"),
    (r"outside_segments = true", "outside_segments = false"), (r"\btrue>", "false>"), (r"\bfalse>", "true>"),
    (r"std::int16_t", "std::uint16_t"), (r"std::uint16_t", "std::int16_t"), (r"std::int32_t", "std::uint32_t"),
    (r"<And\b", "<Or"), (r"<Or\b", "<And"), (r"Logic::And", "Logic::Or"), (r"Logic::Xor", "Logic::Or"),
    (r"\bGreaterEqual\b", "Greater"), (r"\bLessEqual\b", "Less"), (r"\bEqual\b", "NotEqual"),
    (r"\bkInOut", "kIn"), (r"\bkIn\d?(?=Byte|Word|Dword|Real)", "kOut"), (r"Byte\b", "Word"), (r"Word\b", "Byte"), (r"Dword\b", "Word"),
    (r"Usint\b", "Byte"), (r"Int\b", "Word"), (r"Dint\b", "Dword"), (r"\bkOnCore<", "kOnMemory<"), (r"\bkOnStack<", "kOnMemory<"),
]
IN_RULES = [
    (r"Width::Byte", "Width::Word"), (r"Width::Word", "Width::Byte"), (r"Width::Double", "Width::Word"), (r"Role::InOut", "Role::In"),
    (r"Role::Out", "Role::In"), (r"Sign::\w+", "Sign::Either"), (r"(?<![\w.'])(\d+)(?![\w.'])", lambda m: str(int(m.group(1)) + 1)),
    (r"\bkLargestByte\b", "254"), (r"\btrue\b", "false"), (r"\bkMemoryTC\b", "kMemory"), (r"\bkRead(Word|Dword)\b", "kValue"),
    (r"\bkWriteWord\b", "kWordValue"), (r"\bkWordValue\b", "kValue"), (r"\bkValue\b", "kMemory"),
]
# A case, a statement or a condition left out, a sum or an extreme turned round.
CONDITION = r"if \(((?:[^()]|\((?:[^()]|\([^()]*\))*\))*)\)"
IN_STEADY_SCANS = IN_BODIES + [
    (r"^(\s*)case [\w:]+:", r"\1"), (r"^(\s*)[\w.*()\[\]>-]+(?:\([^;]*\)| [+|&]?= [^;]*);", r"\1;"), (CONDITION, r"if (false && (\1))"),
    (CONDITION, r"if (true || (\1))"), (r" \+= ", " -= "), (r" \|= ", " = "), (r"std::min\b", "std::max"), (r"std::max\b", "std::min"),
    (r"(?<=return )[^;()&]*(?:\([^()]*\)[^;()&]*)* && ", ""), (r" && [^&;]+?(?=;$| &&)", ""), (r"(?<= && )[^&]+ &&$", ""), (r" &&$", " ||"),
]
WHEN_IT_PAYS = re.compile("stake|look_at_|kAskAgain|kBesides|kFurthest|done|patience_|wait_|learn_at_|worth_|kFirst|kCheckEvery")  # not what is passed over

class Mutant:
    """One line changed. `nth` tells apart equal lines of a file, so that a mutant is known again when lines move."""

    def __init__(self, path, number, nth, before, after):
        self.path, self.number, self.nth, self.before, self.after = path, number, nth, before, after

    def text(self):
        return (self.path, unaligned(self.before), unaligned(self.after))

    def key(self):
        return json.dumps([*self.text(), self.nth])

    def __str__(self):
        return f"{self.path}:{self.number}\n  - {self.before.strip()}\n  + {self.after.strip()}"


def unaligned(line):
    """A row is the same row when its columns move."""
    return re.sub(r"\s+", " ", line).strip()


def is_code(line):
    text = line.strip()
    return text and not text.startswith(("//", "#", "template <", "namespace", "enum", "static_assert"))


def is_row(line):
    return is_code(line) and "{." in line


def is_about_scans(mutant):
    return mutant.path in STEADY_SCANS or mutant.path in BESIDE_STEADY_SCANS


def mutants_of(path, patterns, is_changed):
    lines = (ROOT / path).read_text(encoding="utf-8").split("\n")
    seen = {}
    for number, line in enumerate(lines, 1):
        if not is_changed(line):
            continue
        nth = seen[unaligned(line)] = seen.get(unaligned(line), -1) + 1
        code = re.sub(r'"[^"]*"|//.*', lambda m: "\0" * len(m.group(0)), line)  # no change inside texts and comments
        variants = {}
        for pattern, replacement in patterns:
            for match in re.finditer(pattern, code):
                changed = match.expand(replacement) if isinstance(replacement, str) else replacement(match)
                after = line[: match.start()] + changed + line[match.end():]
                if "\0" not in changed and after != line:
                    variants[after] = Mutant(path, number, nth, line, after)
        yield from variants.values()


def all_mutants(with_links):
    for path in [*sorted((ROOT / BODIES).glob("*.hpp")), ROOT / CHAINS]:
        name = f"{BODIES}/{path.name}"
        if name != RULES and (name not in LINKS or with_links):
            yield from mutants_of(name, IN_BODIES, is_code)
    for name in STEADY_SCANS:
        yield from mutants_of(name, IN_STEADY_SCANS, lambda line: is_code(line) and not WHEN_IT_PAYS.search(line))
    for name, lines in BESIDE_STEADY_SCANS.items():
        yield from mutants_of(name, IN_STEADY_SCANS, re.compile(lines).search)
    yield from mutants_of(RULES, IN_RULES, is_row)
    yield from mutants_of(TABLE, IN_ROWS, is_row)


def equivalents():
    """{text of a mutant: reason}. A file that names a mutant that does not exist, or gives no reason, is an error."""
    known, found, path, before, after = {m.text() for m in all_mutants(with_links=True)}, {}, None, None, None
    for number, line in enumerate(EQUIVALENT.read_text(encoding="utf-8").split("\n"), 1):
        if line.startswith("- "):
            before = unaligned(line[2:])
        elif line.startswith("+ "):
            after = unaligned(line[2:])
        elif line.startswith("= "):
            if (path, before, after) not in known:
                sys.exit(f"{EQUIVALENT}:{number}: there is no such mutant (see --list)")
            found[(path, before, after)] = line[2:]
        elif line and not line.startswith("#"):
            path = line
    return found


class Tests:
    """The copy, its build, and the tests from the quickest to the slowest."""

    TARGETS = ["interpreter_tests", "program_tests", "lockstep_test", "generate_vectors", "s7200"]
    STAGES = ["steady scans", "vectors", "lock-step", "unit tests", "whole programs", "wrong programs", "programs that go wrong", "vectors as generated", "reference page"]
    SECONDS, KILOBYTES = 120, 4_000_000  # of processor time and memory; what needs more hangs
    # What every mutant includes and no mutant changes.
    PRECOMPILED = ["algorithm", "array", "bit", "cmath", "numeric", "optional", "type_traits", "interpreter/cpu/core.hpp",
                   "interpreter/model/instruction.hpp"]

    def __init__(self, work):
        self.work, self.tree, self.build_dir = work, work / "tree", work / "build"
        self.compiler = [COMPILER, "-std=c++20", "-O0", "-fPIC", "-w"]
        unit, programs = self.build_dir / "tests/unit/interpreter_tests", self.build_dir / "tests/programs/program_tests"
        lockstep = self.build_dir / "tests/reference_model/lockstep_test"
        command, page = self.build_dir / "tools/s7200", self.tree / BODIES / "REFERENCE.md"
        bad_input = [sys.executable, self.tree / "tests/bad_input/run.py", command]
        quick, no_matter = "*Vectors*:InstructionTable*", "Parser.*:Document.*:Encoding.*"  # texts and files
        self.stages = dict(zip(self.STAGES, [
            [unit, "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=Looks.*:SteadyScans.*:IdleScans.*"],
            [unit, "--gtest_brief=1", "--gtest_fail_fast", f"--gtest_filter={quick}"],
            ["env", "S7200_LOCKSTEP_INSTRUCTIONS=20000", lockstep, "--gtest_fail_fast", "--gtest_filter=*Agrees*"],
            [unit, "--gtest_brief=1", "--gtest_fail_fast", f"--gtest_filter=-{quick}:{no_matter}"],
            [programs, "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=-Tip41.*"],
            [*bad_input, "programs"],
            [*bad_input, "runtime"],
            [self.build_dir / "tests/vectors/generate_vectors", "--check", self.tree / "tests/vectors"],
            ["bash", "-c", '"$0" instructions --markdown | diff -q - "$1"', command, page],
        ], strict=True))

    def call(self, command, **others):
        """Whether it ends well within its limits; what it started ends with it."""
        limited = ["bash", "-c", f'ulimit -t {self.SECONDS} -v {self.KILOBYTES}; exec "$@"', "-", *map(str, command)]
        with subprocess.Popen(limited, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True, **others) as process:
            try:
                return process.wait(timeout=10 * self.SECONDS) == 0
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                return False

    def refresh(self):
        """The copy becomes what the tree is; files that are the same stay untouched, so that little is built again."""
        def copy(source, target):
            if not os.path.exists(target) or pathlib.Path(source).read_bytes() != pathlib.Path(target).read_bytes():
                shutil.copy(source, target)
        shutil.copytree(ROOT, self.tree, ignore=shutil.ignore_patterns("build", ".git"), copy_function=copy, dirs_exist_ok=True)
        for path in self.tree.rglob("*"):
            if path.is_file() and not (ROOT / path.relative_to(self.tree)).exists():
                path.unlink()
        shared = ROOT.parent / "shared"
        if shared.exists() and not (self.work / "shared").exists():
            (self.work / "shared").symlink_to(shared)

    def build(self, jobs):
        self.refresh()
        precompiled = self.work / "precompiled.hpp"
        precompiled.write_text("".join(f'#include "{name}"\n' if "/" in name else f"#include <{name}>\n" for name in self.PRECOMPILED))
        steps = [["cmake", "-S", self.tree, "-B", self.build_dir, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O1",
                  "-DBUILD_SHARED_LIBS=ON"],
                 ["cmake", "--build", self.build_dir, "-j", jobs, "--target", *self.TARGETS],
                 [*self.compiler, "-I", self.tree, "-x", "c++-header", precompiled, "-o", f"{precompiled}.gch"]]
        for step in steps:
            subprocess.run(list(map(str, step)), check=True, stdout=subprocess.DEVNULL)

    def what_notices(self, mutant):
        """Name of the first stage that fails, "" when none does, None when the mutant does not compile."""
        with tempfile.TemporaryDirectory(dir=self.work) as folder:
            place = pathlib.Path(folder)
            library, sources = place / "mutant.so", [self.tree / TABLE]
            if mutant:
                lines = (self.tree / mutant.path).read_text(encoding="utf-8").split("\n")
                lines[mutant.number - 1] = mutant.after
                changed = place / mutant.path
                changed.parent.mkdir(parents=True)
                changed.write_text("\n".join(lines), encoding="utf-8")
                if is_about_scans(mutant):
                    sources = [self.tree / mutant.path]
                if mutant.path in CHAINS_ARE_MADE_OF:
                    sources.append(self.tree / CHAINS)
                sources = [changed if self.tree / mutant.path == source else source for source in sources]
            # A changed header is found before that of the tree.
            if not self.call([*self.compiler, "-include", self.work / "precompiled.hpp", "-I", place, "-I", self.tree, "-shared", *sources,
                              "-o", library, f"-L{self.build_dir}/interpreter", "-ls7200_interpreter",
                              f"-Wl,-rpath,{self.build_dir}/interpreter"]):
                return None
            return self.first_failure({**os.environ, "LD_PRELOAD": str(library)}, mutant and is_about_scans(mutant))

    def first_failure(self, environment, about_scans):
        """Instructions leave the tests of steady scans to the unit tests, of which they are a part."""
        for name, command in self.stages.items():
            if name == "steady scans" and not about_scans:
                continue
            if not self.call(command, env=environment, cwd=self.work):
                return name
        return ""


class Results:
    """{key of a mutant: stage that noticed it, "" or None}, and the file they are kept in."""

    def __init__(self, path):
        self.path, self.of, self.lock = path, {}, threading.Lock()
        if path and path.exists():
            for line in path.read_text(encoding="utf-8").splitlines():
                entry = json.loads(line)
                self.of[json.dumps(entry["mutant"])] = entry["noticed_by"]

    def open(self, mutant):
        return self.of.get(mutant.key(), "") == ""

    def add(self, mutant, noticed_by):
        with self.lock:
            self.of[mutant.key()] = noticed_by
            if self.path:
                with self.path.open("a", encoding="utf-8") as file:
                    file.write(json.dumps({"mutant": json.loads(mutant.key()), "noticed_by": noticed_by}) + "\n")


def run_all(mutants, results, work, jobs):
    tests = Tests(work)
    tests.build(jobs)
    begin = time.monotonic()
    noticed_by = tests.what_notices(None)
    if noticed_by != "":
        sys.exit(f"the tree itself does not pass: {noticed_by or 'does not compile'}")
    print(f"built; all tests take {time.monotonic() - begin:.1f} s; {len(mutants)} mutants to run", file=sys.stderr, flush=True)
    numbers = itertools.count(1)

    def run_one(mutant):
        results.add(mutant, tests.what_notices(mutant))
        number = next(numbers)
        if sys.stderr.isatty() or number % 50 == 0:
            print(f"\r{number} of {len(mutants)}", end="" if sys.stderr.isatty() else "\n", file=sys.stderr, flush=True)

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(run_one, mutants))
    print(file=sys.stderr)


def report(mutants, results, reasons):
    """Prints what became of the mutants; whether enough were noticed."""
    noticed, survivors, unchanged, uncompiled = collections.Counter(), [], [], []
    wrong_reasons = 0
    for mutant in mutants:
        noticed_by, reason = results.of[mutant.key()], reasons.get(mutant.text())
        if noticed_by is None:
            uncompiled.append(mutant)
        elif noticed_by:
            noticed[noticed_by] += 1
            if reason:
                wrong_reasons += 1
                print(f"is to change nothing and was noticed by: {noticed_by}: {mutant}\n  = {reason}")
        else:
            (unchanged if reason else survivors).append(mutant)
    for mutant in unchanged:
        print(f"changes nothing: {mutant}\n  = {reasons[mutant.text()]}")
    for mutant in survivors:
        print(f"survived: {mutant}")
    print(f"{len(uncompiled):6}  did not compile\n{len(unchanged):6}  change nothing\n{len(survivors):6}  survived")
    for stage in Tests.STAGES:
        print(f"{noticed[stage]:6}  noticed by: {stage}")
    counted = noticed.total() + len(survivors)
    print(f"{noticed.total()} of {counted} mutants noticed ({100 * noticed.total() / max(1, counted):.1f} %)")
    return noticed.total() >= GOAL * counted and not wrong_reasons


def main():
    options = argparse.ArgumentParser(description="Mutation check of the instructions",
                                      epilog="Example: nice tests/mutation/run.py --results /tmp/mutants.json")
    options.add_argument("--sample", type=int, metavar="N", help="so many mutants, spread evenly")
    options.add_argument("--list", action="store_true", help="print the mutants only")
    options.add_argument("--of", action="append", metavar="FILE", help="the mutants of this file only; may be given more than once")
    options.add_argument("--results", type=pathlib.Path, metavar="FILE", help="keep what became of each; do not run again what was noticed")
    options.add_argument("--work", type=pathlib.Path, metavar="DIR", help="where the copy and its build are kept")
    options.add_argument("--jobs", type=int, default=2, metavar="N", help="mutants at a time (default 2)")
    chosen = options.parse_args()

    mutants = list(all_mutants(with_links="clang" in COMPILER))
    reasons = equivalents()
    if chosen.of:
        mutants = [m for m in mutants if m.path in chosen.of]
    if chosen.sample and chosen.sample < len(mutants):
        mutants = [mutants[i * len(mutants) // chosen.sample] for i in range(chosen.sample)]
    if chosen.list:
        print("\n".join(map(str, mutants)))
        print(f"{len(mutants)} mutants")
        return 0

    results = Results(chosen.results)
    to_run = [m for m in mutants if results.open(m)]
    if to_run:
        work = chosen.work or pathlib.Path(tempfile.mkdtemp(prefix="s7200-mutation-"))
        work.mkdir(parents=True, exist_ok=True)
        run_all(to_run, results, work.resolve(), chosen.jobs)
        if not chosen.work:
            shutil.rmtree(work)
    return 0 if report(mutants, results, reasons) else 1


if __name__ == "__main__":
    sys.exit(main())
