#!/usr/bin/env python3
"""Plants races in generated programs and counts which of them `s7200 inspect PROGRAM races` finds: run.py S7200 [COUNT [SEED]]

Each program has one planted race between its main program and an interrupt routine, among networks that share words with
interrupts in ways that are none: read and written in one instruction, under DISI, or so that it comes to the same. Found is a race if both its lines are
named. Everything else that is named is a false alarm. The same programs without the race must have no finding.
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile


class Program:
    """Lines of the main program, of subroutines and of interrupt routines."""

    def __init__(self, chance):
        self.chance = chance
        self.main, self.subroutines, self.interrupts = [], [], [[], []]
        self.next_word, self.next_label = 100, 0

    def memory(self, size=2):
        """The number of memory of its own."""
        self.next_word += 8
        return self.next_word - 8

    def condition(self):
        return self.chance.choice(["LD SM0.0", f"LD I0.{self.chance.randrange(8)}", f"LDN M{self.chance.randrange(8)}.{self.chance.randrange(8)}",
                                   f"LDW>= VW{4 * self.chance.randrange(8)}, {self.chance.randrange(-5, 5)}"])

    def subroutine(self, lines):
        self.subroutines.append(lines)
        return len(self.subroutines)

    def text(self, mark=None):
        """As STL; with the line numbers of the lines that begin with `mark`."""
        lines = ["LD SM0.1", "MOVB 5, SMB34", "MOVB 7, SMB35", "ATCH 0, 10", "ATCH 1, 11", "ENI", *self.main, "MEND"]
        for number, body in enumerate(self.subroutines, 1):
            lines += [f"SBR {number}", *body, "RET"]
        for number, body in enumerate(self.interrupts):
            lines += [f"INT {number}", *body, "RETI"]
        marked = [number for number, line in enumerate(lines, 1) if line.startswith("@")]
        return "\n".join(line.lstrip("@") for line in lines) + "\n", marked


# --- what is no race ---

def filler(p):
    for _ in range(p.chance.randrange(1, 5)):
        a, b = p.memory(), p.memory()
        p.main += p.chance.choice([[p.condition(), f"MOVW VW{a}, AC2", f"+I {p.chance.randrange(9)}, AC2", f"MOVW AC2, VW{b}"],
                                   [p.condition(), f"= Q0.{p.chance.randrange(8)}"],
                                   [p.condition(), f"TON T{p.chance.randrange(37, 60)}, 10"],
                                   [p.condition(), f"INCW VW{a}"],
                                   [p.condition(), f"MOVD &VB{a}, AC3", f"MOVW 1, *AC3"]])


def single(p):
    """One side counts, the other one looks, or sets, each in one instruction."""
    word, other = p.memory(), p.memory()
    routine = p.chance.randrange(2)
    p.interrupts[routine] += ["LD SM0.0", p.chance.choice([f"INCW VW{word}", f"MOVW {p.chance.randrange(99)}, VW{word}", f"MOVW VW{word}, VW{other}"])]
    p.main += [p.condition(), p.chance.choice([f"MOVW VW{word}, VW{p.memory()}", f"DECW VW{word}", f"MOVW 0, VW{word}"])]


def protected(p):
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    p.main += [p.condition(), "DISI", f"MOVW VW{word}, AC0", "+I 3, AC0", f"MOVW AC0, VW{word}", "ENI"]


def protected_call(p):
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    number = p.subroutine(["LD SM0.0", f"MOVW VW{word}, AC0", "+I 3, AC0", f"MOVW AC0, VW{word}"])
    p.main += ["LD SM0.0", "DISI", f"CALL {number}", "ENI"]


def accumulators(p):
    """Both use the same accumulators, which the CPU saves."""
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"MOVW VW{p.memory()}, AC0", "+I 1, AC0", f"MOVW AC0, VW{p.memory()}"]


def whole(p):
    double = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCD VD{double}"]
    p.main += [p.condition(), f"MOVD VD{double}, VD{p.memory()}"]


def handshake(p):
    bit = f"V{p.memory()}.0"
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"S {bit}, 1"]
    p.main += [f"LD {bit}", f"R {bit}, 1", f"INCW VW{p.memory()}"]


def detached(p):
    word, routine = p.memory(), p.chance.randrange(2)
    p.interrupts[routine] += ["LD SM0.0", f"INCW VW{word}"]
    p.main += ["LD SM0.0", f"DTCH {10 + routine}", f"MOVW VW{word}, AC0", "+I 3, AC0", f"MOVW AC0, VW{word}", f"ATCH {routine}, {10 + routine}"]


def threshold(p):
    """What comes between the two is lost as well if it comes before."""
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    p.main += [f"LDW>= VW{word}, {p.chance.randrange(1, 100)}", f"MOVW 0, VW{word}"]


def threshold_with_copy(p):
    """The copy is new or old, whatever becomes of the count."""
    word, other = p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}", f"INCW VW{other}"]
    p.main += [f"LDW>= VW{word}, {p.chance.randrange(1, 100)}", f"MOVW VW{other}, VW{p.memory()}", f"MOVW 0, VW{word}"]


def shown_and_reset(p):
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    p.main += ["LD SM0.0", f"MOVW VW{word}, VW{p.memory()}", "LD I1.1", f"MOVW 0, VW{word}"]


def mailbox(p):
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"MOVW 1, VW{word}"]
    p.main += ["LD I1.2", f"MOVW 0, VW{word}", f"LDW= VW{word}, 1", "= Q1.1"]


def pointer_elsewhere(p):
    first, index = p.memory(), p.memory()
    table = p.memory()
    p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{first}"]
    p.main += ["LD SM0.0", f"MOVD &VB{table}, AC1", f"FOR VW{index}, 1, 5", "LD SM0.0", "MOVW *AC1, AC0", "+I 1, AC0", "MOVW AC0, *AC1",
               "+D 2, AC1", "NEXT"]


def pair_copied(p):
    """Two words that the interrupt writes together, each looked at for itself."""
    first, second, to = p.memory(), p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{first}", f"+I 3, VW{second}"]
    p.main += [p.condition(), f"MOVW VW{first}, VW{to}", f"MOVW VW{second}, VW{to + 4}"]


def pair_protected(p):
    first, second = p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{first}", f"+I 3, VW{second}"]
    p.main += [p.condition(), "DISI", f"MOVW VW{first}, AC0", f"-I VW{second}, AC0", "ENI", f"MOVW AC0, VW{p.memory()}"]


def loop_protected(p):
    word, index = p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    p.main += ["LD SM0.0", f"FOR VW{index}, 1, 3", "LD SM0.0", "DISI", f"MOVW VW{word}, AC0", "+I 3, AC0", f"MOVW AC0, VW{word}", "ENI", "NEXT"]


HARMLESS = [filler, filler, single, protected, protected_call, accumulators, whole, handshake, detached, threshold, threshold_with_copy,
            shown_and_reset, mailbox, pointer_elsewhere, pair_copied, pair_protected, loop_protected]


# --- races ---

def between(p):
    """Instructions of others between the two accesses."""
    return [f"INCW VW{p.memory()}" for _ in range(p.chance.randrange(3))]


def accumulator(p):
    word = p.memory()
    width, add = p.chance.choice([("W", "+I"), ("D", "+D")])
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INC{width} V{width}{word}"]
    return [p.condition(), f"@MOV{width} V{width}{word}, AC0", f"{add} 5, AC0", *between(p), f"@MOV{width} AC0, V{width}{word}"]


def through_memory(p):
    word, copy = p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    return [p.condition(), f"@MOVW VW{word}, VW{copy}", f"SLW VW{copy}, 1", *between(p), f"@MOVW VW{copy}, VW{word}"]


def compare_and_reset(p):
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    return [f"@LDW= VW{word}, {p.chance.randrange(1, 100)}", *between(p), f"@MOVW 0, VW{word}"]


def pointer_of_main(p):
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    return [p.condition(), f"MOVD &VB{word}, AC1", "@MOVW *AC1, AC0", "+I 7, AC0", *between(p), "@MOVW AC0, *AC1"]


def pointer_of_interrupt(p):
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"MOVD &VB{word}, AC2", "INCW *AC2"]
    return [p.condition(), f"@MOVW VW{word}, AC0", "+I 7, AC0", f"@MOVW AC0, VW{word}"]


def pointer_in_memory(p):
    word, pointer = p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"MOVD &VB{word}, VD{pointer}", f"INCW *VD{pointer}"]
    return [p.condition(), f"@MOVW VW{word}, AC0", "+I 7, AC0", f"@MOVW AC0, VW{word}"]


def bytes_of_mask(p):
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCB VB{word}"]
    return [p.condition(), f"@MOVB VB{word}, AC0", "XORW 16#0055, AC0", f"@MOVB AC0, VB{word}"]


def in_subroutine(p):
    lines = p.chance.choice([accumulator, through_memory, compare_and_reset])(p)
    number = p.subroutine(lines)
    return ["LD SM0.0", f"CALL {number}"]


def interrupt_in_subroutine(p):
    word = p.memory()
    number = p.subroutine(["LD SM0.0", f"INCW VW{word}"])
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"CALL {number}"]
    return [p.condition(), f"@MOVW VW{word}, AC0", "+I 7, AC0", f"@MOVW AC0, VW{word}"]


def networks_apart(p):
    word, copy = p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    return ["LD SM0.0", f"@MOVW VW{word}, VW{copy}", p.condition(), "= Q1.0", "LD SM0.0", f"+I 1, VW{copy}", f"@MOVW VW{copy}, VW{word}"]


def torn_read(p):
    double, to = p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCD VD{double}"]
    return [p.condition(), f"@MOVW VW{double}, VW{to}", *between(p), f"@MOVW VW{double + 2}, VW{to + 2}"]


def torn_write(p):
    double, new, to = p.memory(), p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"MOVD VD{double}, VD{to}"]
    p.main += ["LD SM0.0", f"+D 16#00010001, VD{new}"]
    return ["LD SM0.0", f"@MOVW VW{new}, VW{double}", *between(p), f"@MOVW VW{new + 2}, VW{double + 2}"]


def self_holding(p):
    bit = f"V{p.memory()}.0"
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"{p.chance.choice('SR')} {bit}, 1"]
    return p.chance.choice([[f"@LD {bit}", "AN I1.0", f"@= {bit}"], ["LD I1.1", f"@O {bit}", "AN I1.0", f"@= {bit}"]])


def read_and_clear(p):
    word, copy = p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    return [p.condition(), p.chance.choice([f"@MOVW VW{word}, VW{copy}", f"@+I VW{word}, VW{copy}"]), *between(p), f"@MOVW 0, VW{word}"]


def pointer_in_loop(p):
    table = p.memory()
    p.memory()
    index = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{table + 2 * p.chance.randrange(5)}"]
    return ["LD SM0.0", f"MOVD &VB{table}, AC1", f"FOR VW{index}, 1, 5", "LD SM0.0", "@MOVW *AC1, AC0", "+I 1, AC0", "@MOVW AC0, *AC1", "+D 2, AC1",
            "NEXT"]


def two_subroutines(p):
    word = p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    reads = p.subroutine(["LD SM0.0", f"@MOVW VW{word}, AC0"])
    writes = p.subroutine(["LD SM0.0", "+I 2, AC0", f"@MOVW AC0, VW{word}"])
    return ["LD SM0.0", f"CALL {reads}", f"CALL {writes}"]


def scratch(p):
    word, new, to = p.memory(), p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"MOVW {p.chance.randrange(1000, 2000)}, VW{word}"]
    return [p.condition(), f"@MOVW VW{new}, VW{word}", f"+I 2, VW{word}", *between(p), f"@MOVW VW{word}, VW{to}"]


def count_of_table(p):
    table = p.memory()
    p.memory()
    p.main += ["LD SM0.1", f"MOVW 3, VW{table}"]
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"ATT VW{p.memory()}, VW{table}"]
    return ["LD SM0.0", f"@MOVW VW{table + 2}, AC0", "-I 1, AC0", f"@MOVW AC0, VW{table + 2}"]


def mixed_read(p):
    first, second = p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"+I {p.chance.randrange(1, 50)}, VW{first}", f"-I {p.chance.randrange(1, 50)}, VW{second}"]
    return [p.condition(), *p.chance.choice([[f"@MOVW VW{first}, AC0", *between(p), f"@-I VW{second}, AC0"],
                                             [f"@MOVW VW{first}, AC0", f"@MOVW VW{second}, AC1", "-I AC1, AC0"]]), f"MOVW AC0, VW{p.memory()}"]


def disi_in_loop(p):
    """The loop may run no pass."""
    word, index, last = p.memory(), p.memory(), p.memory()
    p.interrupts[p.chance.randrange(2)] += ["LD SM0.0", f"INCW VW{word}"]
    return ["LD SM0.0", f"FOR VW{index}, 1, VW{last}", "LD SM0.0", "DISI", "NEXT", "LD SM0.0", f"@MOVW VW{word}, AC0", "+I 5, AC0",
            f"@MOVW AC0, VW{word}", "ENI"]


RACES = [accumulator, through_memory, compare_and_reset, pointer_of_main, pointer_of_interrupt, pointer_in_memory, bytes_of_mask,
         in_subroutine, interrupt_in_subroutine, networks_apart, torn_read, torn_write, self_holding, read_and_clear, pointer_in_loop, two_subroutines,
         scratch, count_of_table, mixed_read, disi_in_loop]


def program(seed, race):
    p = Program(random.Random(seed))
    order = [p.chance.choice(HARMLESS) for _ in range(p.chance.randrange(6, 14))]
    for each in order[::2]:
        each(p)
    if race:
        p.main += race(p)
    for each in order[1::2]:
        each(p)
    return p.text()


def found_in(s7200, texts):
    """The races of programs: for each a list of what --json says."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [pathlib.Path(folder) / f"{number}.stl" for number in range(len(texts))]
        for path, text in zip(paths, texts):
            path.write_text(text, encoding="utf-8")
        done = subprocess.run([s7200, "inspect", *map(str, paths), "races", "--cpu", "224", "--json"], capture_output=True, text=True,
                              check=False, timeout=600)
        if done.returncode != 0:
            sys.exit(f"exit code {done.returncode}\n{done.stderr}")
        return [file["races"] for file in json.loads(done.stdout)["files"]]


def main():
    s7200, count, seed = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200, int(sys.argv[3]) if len(sys.argv) > 3 else 1
    kinds = [RACES[number % len(RACES)] for number in range(count)]
    planted = [program(seed + number, kind) for number, kind in enumerate(kinds)]
    harmless = [program(seed + number, None) for number in range(count)]
    found = lost = false_alarms = 0
    for kind, (text, lines), races in zip(kinds, planted, found_in(s7200, [text for text, _ in planted])):
        right = [race for race in races if [race["first"]["line"], race["last"]["line"]] == lines]
        found += bool(right)
        lost += any(race["lost"] for race in right)
        false_alarms += len(races) - len(right)
        if not right or len(right) != len(races):
            print(f"{kind.__name__}, planted in lines {lines}, named {[(race['first']['line'], race['last']['line']) for race in races]}\n{text}")
        elif not any(race["lost"] for race in right):
            print(f"{kind.__name__}, planted in lines {lines}: no instant found\n{text}")
    for (text, _), races in zip(harmless, found_in(s7200, [text for text, _ in harmless])):
        false_alarms += len(races)
        if races:
            print(f"no race, but named {[(race['first']['line'], race['last']['line']) for race in races]}\n{text}")
    instructions = sum(text.count("\n") for text, _ in planted + harmless)
    print(f"{count} races planted, {found} found, {lost} with an instant that loses the word; {false_alarms} false alarms in {instructions} "
          f"instructions")
    return 0 if found == lost == count and false_alarms == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
