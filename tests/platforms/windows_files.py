#!/usr/bin/env python3
"""The files that only s7200.exe has compile, with warnings as errors: windows_files.py SOURCE_FOLDER BUILD_FOLDER

To build the whole command for Windows takes too long for the test run (tests/windows has it); this holds the part of it that nobody else compiles.
Exit code 77, which a test run shows as skipped, if the compiler is missing.
"""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

COMPILER = "x86_64-w64-mingw32-g++-posix"
# Libraries that are headers, the same on every system, by links that keep the rest of /usr/include out of sight; as cmake/header_libraries.cmake.
HEADERS = ["fmt", "boost", "nlohmann", "CLI"]


def definitions(source):
    """Those of cmake/windows.cmake."""
    (words,) = re.findall(r"add_compile_definitions\((.*)\)", (source / "cmake/windows.cmake").read_text(encoding="utf-8"))
    return [f"-D{word}" for word in [*words.split(), "FMT_HEADER_ONLY"]]


def main():
    source, build = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    if shutil.which(COMPILER) is None:
        print(f"there is no {COMPILER}: apt-get install g++-mingw-w64-x86-64-posix")
        sys.exit(77)
    headers = build / "platforms/windows_headers"
    headers.mkdir(parents=True, exist_ok=True)
    for name in HEADERS:
        if not (headers / name).is_symlink():
            (headers / name).symlink_to(f"/usr/include/{name}")
    command = [COMPILER, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Werror",
               *definitions(source), "-I", source, "-isystem", headers]

    def compile_one(room):
        """All files of a room at once: most of the time goes into what they include. Backwards, so that in bridge/ the file that
        includes Windows' own headers, for which `far` is a macro, is the last."""
        unit = "".join(f'#include "{path}"\n' for path in sorted(room.glob("*.cpp"), reverse=True))
        return room, subprocess.run([*command, "-x", "c++", "-"], input=unit, capture_output=True, text=True, check=False)

    rooms = sorted({path.parent for path in source.glob("tools/*/windows/*.cpp")})
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as at_once:
        failed = [f"{room}:\n{done.stderr[:3000]}" for room, done in at_once.map(compile_one, rooms) if done.returncode != 0]
    print("\n".join(failed) or f"the files of {len(rooms)} rooms compile for Windows")
    sys.exit(1 if failed or not rooms else 0)


main()
