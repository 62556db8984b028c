#!/usr/bin/env python3
"""The libraries that know no operating system say the same on every system: builds them for one, lets them have the same
conversation with the same programs, and compares what is printed with what the native build prints, byte by byte.

    run.py SYSTEM NATIVE_CONVERSATION SOURCE_FOLDER BUILD_FOLDER

Exit code 77, which a test run shows as skipped, if the compiler or what runs its programs is missing; the package is named.
"""
import dataclasses
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SKIPPED = 77
WINE = "/usr/lib/wine/wine64"  # Debian has no link to it in /usr/bin
NODE = """
const {WASI} = require('wasi'), fs = require('fs');
const wasi = new WASI({version: 'preview1'});
WebAssembly.instantiate(fs.readFileSync(process.argv[1]), wasi.getImportObject ? wasi.getImportObject()
    : {wasi_snapshot_preview1: wasi.wasiImport}).then(({instance}) => wasi.start(instance));
"""
FOR_WASM = "clang-19 lld-19 llvm-19 wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32 nodejs"


@dataclasses.dataclass
class System:
    preset: str
    needed: dict  # packages by the commands that they bring
    start: callable  # the command that runs a program
    lacks: callable = lambda: ""  # why nothing here can run its programs


def node(program):
    return ["node", "--no-warnings", "--single-threaded", "--experimental-wasi-unstable-preview1", "-e", NODE, program]


def lacks_tail_calls():
    """Asks Node to read a module whose only function ends in a tail call of itself."""
    module = "0061736d01000000010401600000030201000a0601040012000b"
    program = f"process.exit(WebAssembly.validate(Buffer.from('{module}', 'hex')) ? 0 : 1)"
    found = subprocess.run(["node", "-e", program], check=False).returncode == 0
    return "" if found else "this Node has no tail calls of WebAssembly; version 20 has them"


SYSTEMS = {
    "wasm": System("wasm", {"clang++-19": FOR_WASM, "node": FOR_WASM}, node),
    "wasm-tail-calls": System("wasm-tail-calls", {"clang++-19": FOR_WASM, "node": FOR_WASM}, node, lacks_tail_calls),
    "mingw": System("mingw", {"x86_64-w64-mingw32-g++-posix": "g++-mingw-w64-x86-64-posix", WINE: "wine64"},
                    lambda program: [WINE, program]),
}


def programs(source):
    return [source / "stl_programs/modbus_slave.stl", source / "stl_programs/text_commands.stl", HERE / "reals.awl"]


def said(command, program):
    with open(program, "rb") as listing:
        result = subprocess.run(command, stdin=listing, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False,
                                env=os.environ | {"WINEDEBUG": "-all"})
    if result.returncode != 0 or not result.stdout:
        sys.exit(f"{' '.join(map(str, command))} < {program.name}: exit code {result.returncode}\n"
                 f"{result.stderr.decode()[-2000:]}{result.stdout.decode(errors='replace')[-500:]}")
    return result.stdout


def first_difference(native, other):
    pairs = zip(native.split(b"\n") + [b"(the end)"], other.split(b"\n") + [b"(the end)"])
    number, (ours, theirs) = next((number, pair) for number, pair in enumerate(pairs, 1) if pair[0] != pair[1])
    return f"line {number}\n  native: {ours.decode(errors='replace')}\n  there:  {theirs.decode(errors='replace')}"


def build(preset, source, build_folder):
    """Configures and builds a preset in a folder of the native build, so that the next run finds it there."""
    folder = build_folder / "platforms" / preset
    quickly = "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"
    for command in (["cmake", "--preset", preset, "-B", folder, quickly],
                    ["cmake", "--build", folder, "--target", "conversation"]):
        result = subprocess.run(command, cwd=source, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if result.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}:\n{result.stdout.decode()[-6000:]}")
    built = [path for path in (folder / "tests/platforms").glob("conversation*") if path.is_file()]
    return built[0] if len(built) == 1 else sys.exit(f"{folder} has {len(built)} programs")


def skip(why):
    print(why)
    sys.exit(SKIPPED)


def main():
    system, native, source, build_folder = SYSTEMS[sys.argv[1]], sys.argv[2], pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
    for command, packages in system.needed.items():
        if shutil.which(command) is None:
            skip(f"there is no {command}: apt-get install {packages}")
    if why := system.lacks():
        skip(why)
    program_file = build(system.preset, source, build_folder)
    lines = 0
    for program in programs(source):
        expected = said([native], program)
        heard = said(system.start(program_file), program)
        if heard != expected:
            sys.exit(f"{program.name}: {first_difference(expected, heard)}")
        lines += len(expected.splitlines())
    print(f"{len(programs(source))} conversations of {lines} lines in all are those of the native build; "
          f"the program has {program_file.stat().st_size / 1e6:.2f} MB")


main()
