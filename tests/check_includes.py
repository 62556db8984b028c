#!/usr/bin/env python3
"""Who may include whom, which libraries each room sees, which words it does not use; and each type's name is its own.

A folder is a room; ROOMS says what each sees besides itself. There are no exceptions: a file that cannot stand in its room
belongs in another. Run without arguments; every offence is printed, the exit code is 1 if there is any.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent

INTERPRETER = ["interpreter/base", "interpreter/stl", "interpreter/model", "interpreter/program", "interpreter/analysis",
               "interpreter/trace", "interpreter/cpu", "interpreter/instructions"]
SERIAL_SIM = ["serial_sim/line", "serial_sim/faults", "serial_sim/peers", "serial_sim/modbus", "serial_sim/pc_protocol",
              "serial_sim/westinghouse", "serial_sim/field", "serial_sim/system", "serial_sim/record"]
CORE = INTERPRETER + SERIAL_SIM
SESSION = ["tools/session/past", "tools/session/causes"]
COMMANDS = SESSION + ["tools/session/words", "tools/session/stops", "tools/session/observers", "tools/session/commands"]

ROOMS = {
    "interpreter/base": [],
    "interpreter/stl": ["interpreter/base"],
    "interpreter/model": ["interpreter/base"],
    "interpreter/program": ["interpreter/base", "interpreter/stl", "interpreter/model"],
    "interpreter/analysis": INTERPRETER[:4],
    "interpreter/trace": INTERPRETER[:4],
    "interpreter/cpu": INTERPRETER[:6],
    "interpreter/instructions": INTERPRETER[:7],
    "serial_sim/line": ["interpreter/base"],
    "serial_sim/faults": ["interpreter/base", "serial_sim/line"],
    "serial_sim/peers": ["interpreter/base", "serial_sim/line"],
    "serial_sim/modbus": ["interpreter/base", "serial_sim/line", "serial_sim/faults", "serial_sim/peers"],
    "serial_sim/pc_protocol": ["interpreter/base", "serial_sim/line", "serial_sim/peers"],
    "serial_sim/westinghouse": ["interpreter/base", "serial_sim/line", "serial_sim/peers", "serial_sim/modbus"],
    "serial_sim/field": INTERPRETER,
    "serial_sim/system": INTERPRETER + ["serial_sim/line", "serial_sim/faults", "serial_sim/peers", "serial_sim/field"],
    "serial_sim/record": CORE,
    "tools/host": ["interpreter/base"],
    "tools/views": CORE,
    "tools/record": CORE + ["tools/views"],
    "tools/measuring": CORE + ["tools/host", "tools/views"],
    "tools/coverage": CORE + ["tools/views"],
    "tools/yaml": INTERPRETER,
    "tools/json": ["interpreter/base"],
    "tools/plan": CORE + ["tools/host", "tools/yaml"],
    "tools/rig": CORE + ["tools/host", "tools/views", "tools/record", "tools/json", "tools/plan"],
    "tools/session/past": CORE + ["tools/views", "tools/plan", "tools/rig"],
    "tools/session/causes": CORE + ["tools/views", "tools/plan", "tools/rig", "tools/session/past"],
    "tools/session/words": CORE + ["tools/views", "tools/plan", "tools/rig"] + SESSION,
    "tools/session/stops": CORE + ["tools/views", "tools/plan", "tools/rig"] + COMMANDS[:3],
    "tools/session/observers": CORE + ["tools/views", "tools/plan", "tools/rig"] + SESSION,
    "tools/session/commands": CORE + ["tools/views", "tools/json", "tools/plan", "tools/rig"] + COMMANDS,
    "tools/slave": CORE + ["tools/host", "tools/views", "tools/plan", "tools/rig"],
    "tools/bridge": CORE + ["tools/host", "tools/views", "tools/plan", "tools/rig"],
    "tools/master": CORE + ["tools/host", "tools/views", "tools/plan", "tools/rig", "tools/slave"],
    "tools/calibration": CORE + ["tools/host", "tools/views", "tools/plan", "tools/rig", "tools/slave"],
    "tools/scenario": CORE + ["tools/host", "tools/views", "tools/measuring", "tools/coverage", "tools/yaml", "tools/plan", "tools/rig", "tools/slave"] + SESSION,
    "tools/mutants": CORE + ["tools/views", "tools/measuring", "tools/coverage", "tools/scenario"],
    "tools/trials": CORE + ["tools/views", "tools/coverage", "tools/scenario"],
    "tools/compare": CORE + ["tools/views", "tools/scenario", "tools/trials"],
    "tools/fuzzing": CORE + ["tools/views", "tools/scenario", "tools/trials"] + SESSION,
    "tools/recordings": CORE + ["tools/views", "tools/json", "tools/yaml", "tools/scenario"],
    "tools/faces/files": ["interpreter/base", "tools/host", "tools/session/commands"],
    "tools/faces/console": CORE + ["tools/host", "tools/views", "tools/plan", "tools/rig"] + COMMANDS,
    "tools/faces/dap": CORE + ["tools/host", "tools/views", "tools/json", "tools/plan", "tools/rig"] + COMMANDS,
    "tools/faces/page": CORE + ["tools/views", "tools/json", "tools/plan", "tools/rig"] + COMMANDS,
    "tools/faces/page/engine": CORE + ["tools/views", "tools/yaml", "tools/json", "tools/plan", "tools/rig", "tools/faces/page"] + COMMANDS,
    "tools/faces/page/server": CORE + ["tools/host", "tools/views", "tools/json", "tools/plan", "tools/rig", "tools/faces/page"] + COMMANDS,
}
ROOMS["tools/command"] = list(ROOMS)
ROOMS["tests"] = list(ROOMS)

# What only some rooms may include, by the beginning of its name.
LIBRARIES = {
    "CLI/": ["tools/command", "tests"],
    "boost/asio": ["tools/bridge", "tools/host/net/web_server.cpp"],
    "boost/": ["interpreter/stl/parser.cpp", "tools/bridge", "tools/host/net/web_server.cpp"],
    "nlohmann/": ["tools", "tests"],
    "yaml-cpp/": ["tools/yaml"],
    "zip.h": ["tools/recordings"],
    "histedit.h": ["tools/command"],
    "curses.h": ["tools/command"],
    "term.h": ["tools/command"],
    "sys/socket.h": ["tools/host", "tools/bridge", "tools/slave", "tests"],
    "netinet/": ["tools/host", "tools/bridge", "tools/slave", "tests"],
    "arpa/": ["tools/host", "tools/bridge", "tools/slave", "tests"],
    "netdb.h": ["tools/host", "tools/bridge", "tools/slave", "tests"],
}

# Words of the program text, without comments, that only some rooms may use.
WORDS = {
    r"\bstderr\b|\bstd::c(err|log|out)\b|\bstdout\b|\bfmt::print\b": ["tools/command", "tests"],
    r"\bk(Fine|CheckFailed|Unusable|CpuFatal)\b|\b_?exit\(": ["tools/command", "tests"],
    r"\bstd::(ranges::)?(views|subrange)\b": [],  # Clang 14 cannot read those of libstdc++ 12; base/text/joined.hpp for texts
    r"\b(fs|filesystem)::path\(": ["interpreter/base/file_path.hpp", "tools/host/posix", "tools/command/posix", "tests"],  # a text is no path on Windows: file_path()
    r"\bTempDir\b": ["tests/support/scratch_folder.cpp"],  # one folder for all tests that run beside each other
    r"\bmodbus\b": ["serial_sim/modbus", "serial_sim/westinghouse", "serial_sim/record", "tools", "tests"],
    r"\bpc_protocol\b": ["serial_sim/pc_protocol", "tools/master", "tools/recordings", "tests"],
    r"\bwestinghouse\b": ["serial_sim/westinghouse", "tools/plan", "tools/master", "tools/recordings", "tools/command", "tests"],
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"', re.S)


def room_of(path):
    """The longest that holds it."""
    return max((room for room in ROOMS if path.startswith(room + "/")), key=len, default=None)


def is_among(path, places):
    return any(path == place or path.startswith(place + "/") for place in places)


def sources():
    for folder in ("interpreter", "serial_sim", "tools", "tests"):
        yield from (path for path in sorted((TOP / folder).rglob("*.?pp")))


def exists(name):
    return any(path.is_file() for path in (TOP / name, TOP / (name + ".in"), (TOP / name).with_suffix(".py")))


def offences_of_include(name, bracket, included):
    for library, allowed in LIBRARIES.items():
        if included.startswith(library) and not is_among(name, allowed):
            yield f"{included} belongs in {', '.join(allowed)}"
    room, other = room_of(name), room_of(included)
    if other is None:
        if bracket == '"':
            yield f"'{included}' is not a path from the top of the tree"
        return
    if bracket == "<" and not name.startswith("tests/install/consumer/"):
        yield f"'{included}' is ours: write it in quotes"
    if not exists(included):
        yield f"there is no {included}"
    elif other != room and other not in ROOMS[room]:
        yield f"{room} must not see {other} ({included})"


def offences_of(path):
    name, text = path.relative_to(TOP).as_posix(), path.read_text(encoding="utf-8")
    if room_of(name) is None:
        yield f"{name}:1: belongs to no room"
        return
    for number, line in enumerate(text.split("\n"), 1):
        if match := INCLUDE.match(line):
            for offence in offences_of_include(name, *match.groups()):
                yield f"{name}:{number}: {offence}"
    code = COMMENT_OR_TEXT.sub(lambda match: "\n" * match.group().count("\n"), text)
    for words, allowed in WORDS.items():
        if not is_among(name, allowed):
            for match in re.finditer(words, code):
                yield f"{name}:{code.count(chr(10), 0, match.start()) + 1}: '{match.group()}' belongs in {', '.join(allowed)}"


DEFINITION = re.compile(r"^(?:struct|class|enum class|union) (\w+)\b(?!::)[^;]*$|^namespace ([\w:]+) \{")


def types_defined_in(path):
    """Of a header, with their namespaces; those inside other types stand further right."""
    namespace = ""
    for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
        if match := DEFINITION.match(line):
            namespace = match[2] or namespace
            if match[1]:
                yield f"{namespace}::{match[1]}", number


def offences_of_types():
    """Two types of one name break C++'s one-definition rule, and no compiler sees it."""
    first = {}
    for path in sources():
        if path.suffix != ".hpp" or path.is_relative_to(TOP / "tests"):
            continue
        name = path.relative_to(TOP).as_posix()
        for defined, number in types_defined_in(path):
            if defined in first:
                yield f"{name}:{number}: {defined} is defined in {first[defined]} too"
            first.setdefault(defined, f"{name}:{number}")


LONGEST_VERB = 119  # lines


def offences_of_verbs():
    """A verb is its options, a call and what it prints."""
    for path in sorted((TOP / "tools/command/verbs").glob("cmd_*.cpp")):
        lines = path.read_text(encoding="utf-8").count("\n")
        if lines > LONGEST_VERB:
            yield f"{path.relative_to(TOP)}:1: {lines} lines, {LONGEST_VERB} are enough for a verb"


MOST_FILES = 25


def offences_of_floors():
    """A newcomer sees what is on a floor at one glance."""
    for room in (room for room in ROOMS if room != "tests"):
        for floor in [TOP / room, *(path for path in (TOP / room).rglob("*") if path.is_dir())]:
            files = sum(path.is_file() and path.name != "CMakeLists.txt" for path in floor.iterdir())
            if files > MOST_FILES:
                yield f"{floor.relative_to(TOP)}:1: {files} files on one floor, {MOST_FILES} are enough"


def main():
    found = [offence for path in sources() for offence in offences_of(path)] + list(offences_of_types())
    found += [*offences_of_verbs(), *offences_of_floors()]
    for line in found:
        print(line)
    print(f"{len(list(sources()))} files, {len(found)} offences")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
