#!/usr/bin/env python3
"""The columns of the instruction table and of the operand rules are aligned.

clang-format leaves these rows alone, so that each is one line and a column can be read downwards. Within a block, which ends
at an empty line, the same column starts at the same place everywhere. Run without arguments; prints what is out of place, the
exit code is 1 if there is any.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
FILES = ["interpreter/instructions/table.cpp", "interpreter/instructions/operand_rules.hpp"]
CELL = re.compile(r"[{ ](\.\w+) = ")


def cells(line):
    """[(column, where it starts)] of the row itself, not of braces within one of its cells."""
    code = re.sub(r'"[^"]*"|//.*', lambda m: "x" * len(m.group(0)), line)
    depth, found = 0, []
    for place, character in enumerate(code):
        depth += {"{": 1, "}": -1}.get(character, 0)
        match = CELL.match(code, place)
        if match and depth == 1:
            found.append((match.group(1), match.start(1)))
    return found


def main():
    rows, offences = 0, []
    for name in FILES:
        expected = {}
        for number, line in enumerate((TOP / name).read_text(encoding="utf-8").split("\n"), 1):
            if not line:
                expected = {}
            row = cells(line)
            rows += bool(row)
            for column, place in row:
                first = expected.setdefault(column, (place, number))
                if place != first[0]:
                    offences.append(f"{name}:{number}: {column} starts in column {place + 1}, in line {first[1]} in column {first[0] + 1}")
    print("\n".join([*offences, f"{rows} rows, {len(offences)} cells out of place"]))
    return 1 if offences or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
