#!/usr/bin/env python3
"""The TextMate grammar of STL, from the instruction table: grammar.py S7200 > syntaxes/s7200-stl.tmLanguage.json

A test compares the file with what this prints.
"""
import json
import re
import subprocess
import sys

HEADS = ("SBR", "INT", "LBL", "SCR", "LSCR", "SCRT", "SCRE", "MEND", "END", "CEND", "RET", "CRET", "RETI", "CRETI", "JMP", "CALL", "FOR",
         "NEXT", "STOP", "ATCH", "DTCH", "ENI", "DISI")
AREAS = {"constant.language.bit.s7200": r"(?:I|E|Q|A|M|SM|S|V|L)\d+\.[0-7]",
         "variable.other.memory.s7200": r"(?:[IEQAMSVL]|SM)[BWD]\d+|A[IQ]W\d+|AEW\d+|AAW\d+",
         "variable.other.element.s7200": r"(?:T|C|Z|HC|HZ)\d+",
         "variable.language.accumulator.s7200": r"AC[0-3]"}


def instructions(s7200):
    done = subprocess.run([s7200, "instructions", "--json", "--cpu", "226"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)["instructions"]


def alternatives(words):
    return "|".join(re.escape(word) for word in sorted(words, key=lambda word: (-len(word), word)))


def mnemonic(words, scope):
    return {"match": rf"(?i)^\s*({alternatives(words)})(?=\s|$|//)", "captures": {"1": {"name": scope}}}


def grammar(table):
    names = {one["mnemonic"] for one in table}
    control = {name for name in names if name in HEADS}
    contacts = {one["mnemonic"] for one in table if one["group"] in ("Bit logic", "Compare contacts")} - control
    patterns = [
        {"name": "comment.line.double-slash.s7200", "match": r"//.*$"},
        {"match": r"(?i)^\s*(NETWORK)(?:\s+(\d+))?", "captures": {"1": {"name": "keyword.other.network.s7200"},
                                                                  "2": {"name": "entity.name.section.s7200"}}},
        {"match": r"(?i)^\s*(SBR|INT)\s+(\d+)", "captures": {"1": {"name": "keyword.control.s7200"},
                                                             "2": {"name": "entity.name.function.s7200"}}},
        {"match": r"(?i)^\s*((?:END_)?(?:ORGANIZATION_BLOCK|SUBROUTINE_BLOCK|INTERRUPT_BLOCK|DATA_BLOCK|VAR)|VAR_INPUT|VAR_OUTPUT|"
                  r"VAR_IN_OUT|BEGIN|TITLE)\b", "captures": {"1": {"name": "keyword.other.block.s7200"}}},
        mnemonic(control, "keyword.control.s7200"),
        mnemonic(contacts, "keyword.operator.logical.s7200"),
        mnemonic(names - control - contacts, "support.function.s7200"),
        {"name": "string.quoted.double.s7200", "match": r'"[^"\n]*"'},
        {"name": "string.quoted.single.s7200", "match": r"'[^'\n]*'"},
        {"name": "constant.numeric.hex.s7200", "match": r"(?i)\b(?:16#[0-9A-F_]+|KH[0-9A-F]+)\b"},
        {"name": "constant.numeric.binary.s7200", "match": r"\b2#[01_]+\b"},
        {"name": "keyword.operator.pointer.s7200", "match": r"[*&](?=[A-Za-z])"},
        *({"name": scope, "match": rf"(?i)\b(?:{areas})\b"} for scope, areas in AREAS.items()),
        {"name": "constant.numeric.real.s7200", "match": r"[-+]?\b\d+(?:\.\d+(?:[Ee][-+]?\d+)?|[Ee][-+]?\d+)\b"},
        {"name": "constant.numeric.decimal.s7200", "match": r"[-+]?\bK?\d+\b"},
    ]
    return {"name": "S7-200 STL", "scopeName": "source.s7200-stl", "fileTypes": ["stl", "awl"], "patterns": patterns}


if __name__ == "__main__":
    print(json.dumps(grammar(instructions(sys.argv[1])), indent=2))
