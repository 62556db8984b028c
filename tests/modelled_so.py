#!/usr/bin/env python3
"""The page of choices: what no manual says, and how it is modelled.

The choices stand where they are made, in comments that begin with "Not documented, modelled so:". Each ends with the test
that pins it, in brackets. This script puts them together as docs/MODELLED_SO.md. Choices about the Westinghouse PLCs are settings and
options with the mark of their reference, `L7`: the name of a test that pins one begins with it.

    tests/modelled_so.py          compare the committed page with the comments, and look for each test; exit code 1 if either fails
    tests/modelled_so.py --write  write the page
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/MODELLED_SO.md"
MARK = "Not documented, modelled so:"
HEAD = """# Not documented, modelled so

What no manual that we have says, and how it is modelled. `tests/modelled_so.py --write` makes this page from the comments in
the code. Each choice stands in one place and is pinned by the test named after it. If you know better from a real CPU, change
the comment, the code beside it and the test.
"""


def comment_blocks(path):
    """Runs of comment lines, as lists of their texts."""
    block = []
    for line in path.read_text(encoding="utf-8").splitlines():
        text = re.match(r"\s*///? ?(.*)", line)
        if text:
            block.append(text.group(1))
            continue
        if block:
            yield block
        block = []
    if block:
        yield block


def choices(block):
    """The choices of one comment block: what follows each mark, or the bullets below it."""
    items, listed = [], False
    for line in block:
        if MARK in line:
            listed = True
            rest = line.split(MARK, 1)[1].strip()
            items += [rest] if rest else []
        elif listed and line.startswith("- "):
            items.append(line[2:])
        elif not line.strip() or (items and items[-1].endswith("]")):
            listed = False
        elif listed and items:
            items[-1] += " " + line.strip()
    return items


def broken_marks(block):
    """How often the mark is broken over two lines, where it would not be seen."""
    return " ".join(line.strip() for line in block).count(MARK) - sum(line.count(MARK) for line in block)


def collected():
    for folder in ("interpreter", "serial_sim"):
        for path in sorted((ROOT / folder).rglob("*.[ch]pp")):
            blocks = list(comment_blocks(path))
            found = [item for block in blocks for item in choices(block)]
            broken = sum(broken_marks(block) for block in blocks)
            if found or broken:
                yield path.relative_to(ROOT), found, broken


def marks():
    """Those of settings, `{"coils", "M10",`, and of a master's options, `"--timeout [L10], --data-check [L4]"`."""
    for path in sorted((ROOT / "serial_sim" / "westinghouse").glob("*.[ch]pp")):
        yield from re.findall(r'(?:\{"\w+"|settings\(\s*rows),\s*"([A-Z]\d+)"', path.read_text(encoding="utf-8"))
    for path in sorted((ROOT / "tools" / "master").glob("*.cpp")):
        yield from re.findall(r"\[([A-Z]\d+)\]", path.read_text(encoding="utf-8"))


def main():
    page, tests, problems = HEAD, [], []
    for path, items, broken in collected():
        page += f"\n## {path}\n\n"
        if broken:
            problems.append(f"{path}: '{MARK}' is broken over two lines")
        for item in items:
            named = re.fullmatch(r"(.*?)\s*\[([\w.,/ ]+)\]", item)
            if not named:
                problems.append(f"{path}: no test named after: {item}")
                continue
            text = named.group(1).rstrip(".")
            tests += re.split(r",\s*", named.group(2))
            page += f"- {text[0].upper()}{text[1:]}. *{named.group(2)}*\n"
    sources = "\n".join(p.read_text(encoding="utf-8") for p in (ROOT / "tests").rglob("*_test.cpp"))
    vectors = {p.stem.removesuffix(".224") for p in (ROOT / "tests" / "vectors").glob("*.txt")}
    for test in tests:
        suite, _, name = test.partition(".")
        known = name in vectors if suite == "Vectors" else re.search(rf"TEST(_F|_P)?\({suite},\s*{name}\)", sources)
        if not known:
            problems.append(f"there is no test {test}")
    for mark in sorted(set(marks())):
        if not re.search(rf"TEST(_F|_P)?\(\w+,\s*{mark}[A-Z]", sources):
            problems.append(f"there is no test whose name begins with {mark}")
    if "--write" in sys.argv[1:]:
        PAGE.write_text(page, encoding="utf-8")
    elif not PAGE.exists() or PAGE.read_text(encoding="utf-8") != page:
        problems.append(f"{PAGE.name} is not current: run tests/modelled_so.py --write")
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
