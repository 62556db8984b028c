#!/usr/bin/env python3
"""The page of choices: what no manual says, and how it is modelled.

The choices stand where they are made, in comments that begin with "Not documented, modelled so:". Each ends with the test
that pins it, in brackets. This script puts them together as MODELLED_SO.md.

    tests/modelled_so.py          compare the committed page with the comments, and look for each test; exit code 1 if not so
    tests/modelled_so.py --write  write the page
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "MODELLED_SO.md"
MARK = "Not documented, modelled so:"
HEAD = """# Not documented, modelled so

What no manual that we have says, and how it is modelled. Made from the comments in the code by `tests/modelled_so.py --write`;
each choice stands in one place and is pinned by the test named behind it. Who knows better from a real CPU: change the comment,
the code beside it and the test.
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
    """The choices of one comment block: what stands behind the mark, or the bullets below it."""
    lines = iter(block)
    for line in lines:
        if MARK not in line:
            continue
        rest = line.split(MARK, 1)[1].strip()
        items = [rest] if rest else []
        for more in lines:
            if more.startswith("- "):
                items.append(more[2:])
            elif not more.strip() or (items and items[-1].endswith("]")):
                break
            elif items:
                items[-1] += " " + more.strip()
        yield from items


def collected():
    for folder in ("interpreter", "serial_sim"):
        for path in sorted((ROOT / folder).rglob("*.[ch]pp")):
            found = [item for block in comment_blocks(path) for item in choices(block)]
            if found:
                yield path.relative_to(ROOT), found


def main():
    page, tests, problems = HEAD, [], []
    for path, items in collected():
        page += f"\n## {path}\n\n"
        for item in items:
            named = re.fullmatch(r"(.*?)\s*\[([\w.,/ ]+)\]", item)
            if not named:
                problems.append(f"{path}: no test named behind: {item}")
                continue
            text = named.group(1).rstrip(".")
            tests += re.split(r",\s*", named.group(2))
            page += f"- {text[0].upper()}{text[1:]}. *{named.group(2)}*\n"
    sources = "\n".join(p.read_text(encoding="utf-8") for p in (ROOT / "tests").rglob("*_test.cpp"))
    vectors = {p.stem for p in (ROOT / "tests" / "vectors").glob("*.txt")}
    for test in tests:
        suite, _, name = test.partition(".")
        known = name in vectors if suite == "Vectors" else re.search(rf"TEST(_F|_P)?\({suite},\s*{name}\)", sources)
        if not known:
            problems.append(f"there is no test {test}")
    if "--write" in sys.argv[1:]:
        PAGE.write_text(page, encoding="utf-8")
    elif not PAGE.exists() or PAGE.read_text(encoding="utf-8") != page:
        problems.append(f"{PAGE.name} is not current: run tests/modelled_so.py --write")
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
