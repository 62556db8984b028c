#!/usr/bin/env python3
"""Who may include whom. A layer sees itself and the layers above it in LAYERS, or only those it names.

Types low, bodies high: the types of instructions, of the trace and of the serial port stand below the CPU, what works on
the CPU stands above it. Run without arguments; every offence is printed, the exit code is 1 if there is any.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent

# name: what belongs to it, and the only other layers it sees (None: all before it)
LAYERS = {
    "base": (["interpreter/base/"], []),
    "stl": (["interpreter/stl/"], []),
    "model": (["interpreter/model/"], ["base"]),
    "instruction types": ([], ["base", "model"]),
    "program": (["interpreter/program/"], None),
    "serial port": ([], ["base"]),
    "trace records": ([], ["base", "serial port"]),
    "cpu": (["interpreter/cpu/"], None),
    "instruction bodies": (["interpreter/instructions/"], None),
    "trace writers": (["interpreter/trace/"], None),
    "line": (["serial_sim/"], ["base", "serial port"]),
    "simulation": ([], None),
    "tools": (["tools/"], None),
    "tests": (["tests/"], None),
}

# Files that belong to another layer than their folder does. One that would be in order in the layer of its folder, and
# could be included by all who do, is no exception: the check fails until it is struck off.
EXCEPTIONS = {
    "interpreter/model/instruction.hpp": "instruction types",
    "interpreter/base/serial_port.hpp": "serial port",
    "interpreter/trace/trace.hpp": "trace records",
    "serial_sim/field/field.hpp": "simulation",
    "serial_sim/field.cpp": "simulation",
    "serial_sim/field/field_script.hpp": "simulation",
    "serial_sim/field_script.cpp": "simulation",
    "serial_sim/system/simulation.hpp": "simulation",
    "serial_sim/simulation.cpp": "simulation",
}

# Libraries that only some files may see.
EXTERNAL = [
    (re.compile(r"CLI/"), re.compile(r"tools/[^/]*\.cpp|tests/.*\.cpp"), "CLI11 belongs into tools/*.cpp"),
    (re.compile(r"boost/asio"), re.compile(r"tools/bridge[^/]*\.cpp"), "Boost.Asio belongs into tools/bridge*.cpp"),
    (re.compile(r"boost/(?!asio)"), re.compile(r"interpreter/stl/parser\.cpp"),
     "Boost belongs into interpreter/stl/parser.cpp"),
    (re.compile(r"nlohmann/"), re.compile(r"(tools|tests)/.*"), "JSON belongs into tools"),
    (re.compile(r"yaml-cpp/"), re.compile(r"tools/scenario[^/]*\.cpp"), "yaml-cpp belongs into tools/scenario*.cpp"),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def layer_of_folder(path):
    return next((name for name, (folders, _) in LAYERS.items() if path.startswith(tuple(folders))), None)


def layer_of(path, exceptions):
    return exceptions.get(path) or layer_of_folder(path)


def sees(layer, other):
    order = list(LAYERS)
    only = LAYERS[layer][1]
    if other == layer:
        return True
    return other in only if only is not None else order.index(other) < order.index(layer)


def read_includes():
    """[(file, line number, bracket, included)]"""
    found = []
    for folder in ("interpreter", "serial_sim", "tools", "tests"):
        for path in sorted((TOP / folder).rglob("*.?pp")):
            name = path.relative_to(TOP).as_posix()
            for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
                match = INCLUDE.match(line)
                if match:
                    found.append((name, number, *match.groups()))
    return found


def exists(name):
    return (TOP / name).is_file() or (TOP / (name + ".in")).is_file()


def offences(includes, exceptions):
    for name, number, bracket, included in includes:
        own = layer_of(name, exceptions)
        for library, allowed, message in EXTERNAL:
            if library.match(included) and not allowed.fullmatch(name):
                yield f"{name}:{number}: {message}"
        is_ours = layer_of(included, exceptions) is not None
        if not is_ours:
            if bracket == '"':
                yield f"{name}:{number}: '{included}' is no path from the top of the tree"
            continue
        if bracket == "<" and not name.startswith("tests/install/consumer/"):
            yield f"{name}:{number}: '{included}' is ours: write it in quotes"
        if not exists(included):
            yield f"{name}:{number}: there is no {included}"
        elif own is None:
            yield f"{name}:{number}: {name} belongs to no layer"
        elif not sees(own, layer_of(included, exceptions)):
            yield f"{name}:{number}: {own} must not see {layer_of(included, exceptions)} ({included})"


def needless_exceptions(includes):
    for name in EXCEPTIONS:
        if not exists(name):
            yield f"exception for {name}: there is no such file"
        elif not list(offences(includes, {k: v for k, v in EXCEPTIONS.items() if k != name})):
            yield f"exception for {name}: no longer needed"


def main():
    includes = read_includes()
    found = list(offences(includes, EXCEPTIONS))
    if not found:
        found = list(needless_exceptions(includes))
    for line in found:
        print(line)
    print(f"{len(includes)} include lines, {len(found)} out of order")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
