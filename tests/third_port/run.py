#!/usr/bin/env python3
"""A third port is rows: adds them to a copy of the CPU and the line, builds that, and lets programs use the port.

    tests/third_port/run.py [FOLDER]     where the copy and its build are kept; a second run builds what changed [a temporary one]

AFTER and INSTEAD are the whole recipe, which interpreter/model/README.md has in words. Takes some minutes, so it is run by hand.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
HERE = "tests/third_port/third_port_test.cpp"

# By file: what stands there, and what follows it in the copy, or stands there instead of it.
AFTER = {
    "interpreter/model/events.hpp": [("kCounter5Reached = 33,", " kPort2Received = 34, kPort2Sent = 35, kPort2Message = 36,")],
    "interpreter/model/cpu_model.cpp": [
        ('{event::kCounter5Reached, Queue::Io, 23, 23, kCpu22x, "HSC5: current value = preset value"},', """
      {event::kPort2Received, Queue::Communication, 6, 6, kCpu226, "port 2: character received"},
      {event::kPort2Sent, Queue::Communication, 7, 7, kCpu226, "port 2: transmit complete"},
      {event::kPort2Message, Queue::Communication, 8, 8, kCpu226, "port 2: message received"},"""),
        ('{186, 194, Modelled, "receive message, port 1", kTwoPorts},', """
      {240, 240, Modelled, "Freeport: control of port 2", kCpu226}, {246, 254, Modelled, "receive message, port 2", kCpu226},""")],
    "interpreter/model/errors.hpp": [("Port1Busy = 0x0B,", " Port2Busy = 0x0C,")],
    "interpreter/model/errors.cpp": [
        ('return "XMT or RCV while port 1 is sending or receiving a message, or is not in Freeport mode";', """
    case RunError::Port2Busy:
      return "XMT or RCV while port 2 is sending or receiving a message, or is not in Freeport mode";""")],
    "interpreter/model/ports.hpp": [
        ("event::kPort1Sent, event::kPort1Message, RunError::Port1Busy},", """
    {sm::byte(240), sm::byte(246), sm::kForced, event::kPort2Received, event::kPort2Sent, event::kPort2Message, RunError::Port2Busy},""")],
}
INSTEAD = {
    "interpreter/model/cpu_model.hpp": [("kEvents = 34;", "kEvents = 37;")],
    "interpreter/model/ports.hpp": [("std::array<PortInfo, 2> kPorts", "std::array<PortInfo, 3> kPorts")],
    "interpreter/model/cpus/cpu22x.cpp": [('release2("226", kCpu226, {10240, 550, 64}, 2,', 'release2("226", kCpu226, {10240, 550, 64}, 3,')],
}
PROJECT = f"""
cmake_minimum_required(VERSION 3.25)
project(third_port LANGUAGES CXX)
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_EXTENSIONS OFF)
set(S7200_OPTIMISE_AT_LINK_TIME OFF)
set(CMAKE_UNITY_BUILD ON)
set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
find_package(Boost 1.74 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(GTest REQUIRED)
find_package(Python3 REQUIRED)
add_subdirectory(interpreter)
add_subdirectory(serial_sim)
add_executable(third_port_test {HERE})
target_compile_definitions(third_port_test PRIVATE SLAVE="{ROOT}/stl_programs/modbus_slave.stl")
target_link_libraries(third_port_test PRIVATE serial_sim GTest::gtest GTest::gtest_main)
"""


def with_rows(name, text):
    for found, row in AFTER.get(name, []):
        assert text.count(found) == 1, f"{name} has {text.count(found)} times: {found}"
        text = text.replace(found, found + row)
    for found, other in INSTEAD.get(name, []):
        assert text.count(found) == 1, f"{name} has {text.count(found)} times: {found}"
        text = text.replace(found, other)
    return text


def write(path, text):
    """Only what changed, so that only that is built again."""
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def copy(folder):
    listed = subprocess.run(["git", "ls-files", "interpreter", "serial_sim", "stl_programs", HERE], cwd=ROOT, check=True, capture_output=True, text=True)
    for name in listed.stdout.splitlines():
        write(folder / name, with_rows(name, (ROOT / name).read_text(encoding="utf-8")))
    write(folder / "CMakeLists.txt", PROJECT)


def run(folder):
    copy(folder)
    build = folder / "build"
    subprocess.run(["cmake", "-G", "Ninja", "-S", folder, "-B", build, "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-Og"],
                   check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", build, "--target", "third_port_test"], check=True)
    return subprocess.run([build / "third_port_test"], check=False).returncode


if len(sys.argv) > 2 or sys.argv[1:2] == ["--help"]:
    sys.exit(__doc__)
if len(sys.argv) == 2:
    sys.exit(run(pathlib.Path(sys.argv[1]).resolve()))
made = tempfile.mkdtemp()
try:
    sys.exit(run(pathlib.Path(made)))
finally:
    shutil.rmtree(made)
