#!/usr/bin/env python3
"""The libraries that know no operating system say the same on every system: builds them for one, lets them have the same
conversation with the same programs, all but `mingw` also with the engine of the page, and compares what is printed with what the
native build prints, byte by byte.

    run.py SYSTEM NATIVE_CONVERSATION NATIVE_ENGINE_LINES SOURCE_FOLDER BUILD_FOLDER

Exit code 77, which a test run shows as skipped, if the compiler or what runs its programs is missing; the package is named.
"""
import dataclasses
import os
import pathlib
import shutil
import subprocess
import sys

from engine_messages import messages

HERE = pathlib.Path(__file__).resolve().parent
SKIPPED = 77
WINE = "/usr/lib/wine/wine64"  # Debian has no link to it in /usr/bin
NODE = """
const {WASI} = require('wasi'), fs = require('fs');
const wasi = new WASI({version: 'preview1'});
WebAssembly.instantiate(fs.readFileSync(process.argv[1]), wasi.getImportObject ? wasi.getImportObject()
    : {wasi_snapshot_preview1: wasi.wasiImport}).then(({instance}) => wasi.start(instance));
"""
FOR_WASM = "clang-19 lld-19 llvm-19 binaryen wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32 nodejs"
FOR_MINGW = {"x86_64-w64-mingw32-g++-posix": "g++-mingw-w64-x86-64-posix", WINE: "wine64"}


@dataclasses.dataclass
class System:
    preset: str
    needed: dict  # packages by the commands that they bring
    start: callable  # the command that runs a program
    lacks: callable = lambda: ""  # why nothing here can run its programs
    engine: str = ""  # the target that the engine of the page is; empty to leave it out
    start_engine: callable = None  # the command that runs it, if it is another than that of programs
    flags: str = "-O1 -DNDEBUG"  # of the compiler, for a quick build; empty: those of the preset


def node(program):
    return ["node", "--no-warnings", "--single-threaded", "--experimental-wasi-unstable-preview1", "-e", NODE, program]


def lacks_tail_calls():
    """Asks Node to read a module whose only function ends in a tail call of itself."""
    module = "0061736d01000000010401600000030201000a0601040012000b"
    program = f"process.exit(WebAssembly.validate(Buffer.from('{module}', 'hex')) ? 0 : 1)"
    found = subprocess.run(["node", "-e", program], check=False).returncode == 0
    return "" if found else "this Node has no tail calls of WebAssembly; version 20 has them"


def module(engine):
    return ["node", "--no-warnings", "--single-threaded", "--experimental-wasi-unstable-preview1", HERE / "engine.mjs", engine]


SYSTEMS = {
    "wasm": System("wasm", {"clang++-19": FOR_WASM, "node": FOR_WASM}, node, engine="engine", start_engine=module),
    "wasm-tail-calls": System("wasm-tail-calls", {"clang++-19": FOR_WASM, "node": FOR_WASM}, node, lacks_tail_calls, "engine", module),
    "mingw": System("mingw", FOR_MINGW, lambda program: [WINE, program], flags="-Og -DNDEBUG"),
    "mingw-engine": System("mingw", FOR_MINGW, lambda program: [WINE, program], engine="engine_lines", flags="-Og -DNDEBUG"),
    # What users run is optimised at link time, which no other build of the tests is.
    "release": System("release", {}, lambda program: [program], flags=""),
}


def programs(source):
    return [source / "stl_programs/modbus_slave.stl", source / "stl_programs/text_commands.stl", HERE / "reals.awl"]


def said(command, text, name):
    result = subprocess.run(command, input=text, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False,
                            env=os.environ | {"WINEDEBUG": "-all"})
    if result.returncode != 0 or not result.stdout:
        sys.exit(f"{' '.join(map(str, command))} < {name}: exit code {result.returncode}\n"
                 f"{result.stderr.decode()[-2000:]}{result.stdout.decode(errors='replace')[-500:]}")
    return result.stdout


def first_difference(native, other):
    pairs = zip(native.split(b"\n") + [b"(the end)"], other.split(b"\n") + [b"(the end)"])
    number, (ours, theirs) = next((number, pair) for number, pair in enumerate(pairs, 1) if pair[0] != pair[1])
    return f"line {number}\n  native: {ours.decode(errors='replace')}\n  there:  {theirs.decode(errors='replace')}"


def build(system, source, build_folder):
    """Configures and builds a preset in a folder of the native build, so that the next run finds it there. Returns the programs."""
    preset = system.preset
    folder = build_folder / "platforms" / preset
    quickly = [f"-DCMAKE_CXX_FLAGS_RELEASE={system.flags}"] if system.flags else []
    for command in (["cmake", "--preset", preset, "-B", folder, *quickly],
                    ["cmake", "--build", folder, "--target", "conversation", *filter(None, [system.engine])]):
        result = subprocess.run(command, cwd=source, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if result.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}:\n{result.stdout.decode()[-6000:]}")
    where = folder / ("tests/platforms" if system.engine == "engine_lines" else "tools/faces/page/engine")
    return program_in(folder / "tests/platforms", "conversation"), program_in(where, system.engine) if system.engine else None


def program_in(folder, name):
    built = [path for path in folder.glob(f"{name}*") if path.is_file() and path.suffix in ("", ".exe", ".wasm")]
    return built[0] if len(built) == 1 else sys.exit(f"{folder} has {len(built)} programs {name}")


def skip(why):
    print(why)
    sys.exit(SKIPPED)


def compare(native, there, text, name):
    """How many lines are the same."""
    expected, heard = said(native, text, name), said(there, text, name)
    if heard != expected:
        sys.exit(f"{name}: {first_difference(expected, heard)}")
    return len(expected.splitlines())


def main():
    system, native, native_engine = SYSTEMS[sys.argv[1]], sys.argv[2], sys.argv[3]
    source, build_folder = pathlib.Path(sys.argv[4]), pathlib.Path(sys.argv[5])
    for command, packages in system.needed.items():
        if shutil.which(command) is None:
            skip(f"there is no {command}: apt-get install {packages}")
    if why := system.lacks():
        skip(why)
    program_file, engine = build(system, source, build_folder)
    lines = sum(compare([native], system.start(program_file), program.read_bytes(), program.name) for program in programs(source))
    print(f"{len(programs(source))} conversations of {lines} lines in all are those of the native build; "
          f"the program has {program_file.stat().st_size / 1e6:.2f} MB")
    if engine is None:
        return
    said_by_page = "".join(text + "\n" for text in messages(source)).encode()
    replies = compare([native_engine], (system.start_engine or system.start)(engine), said_by_page, "messages of a page")
    print(f"{replies} replies of the engine are those of the native build; it has {engine.stat().st_size / 1e6:.2f} MB")


main()
