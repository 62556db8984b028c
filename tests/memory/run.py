#!/usr/bin/env python3
"""A command needs no more memory for a long run than for a short one: run.py S7200 SOURCE_DIR [--week]

With --week, prints the table of tests/README.md: what each command needs for a simulated week.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

S7200, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
WEEK = "--week" in sys.argv[3:]
SLAVE = SOURCE / "stl_programs/modbus_slave.stl"
LONG_SCAN = SOURCE / "tests/programs/long_scan.stl"  # 0.4 s: its trace has a line for each
MINUTE, HOUR, DAY = 60, 3600, 86_400
MOST_GROWTH = 2048  # kB; what the C library does with small pieces makes some hundred
OF_THE_PAST = 256 * 1024  # kB; the debugger keeps so much to go back to, however long it runs (tools/session/past/README.md)

# An A every 50 ms, 9600 8E1, and Q0.0 that follows it.
BEACON = ("LD SM0.1\nMOVB 16#49, SMB30\nMOVB 1, VB0\nMOVB 16#41, VB1\nMOVB 50, SMB34\nATCH 0, 10\nENI\nMEND\n"
          "INT 0\nLD SM0.0\nXMT VB0, 0\nLDN Q0.0\n= Q0.0\nRETI\n")


class Case:
    """Written as in a shell; TIME is the length of the run."""

    def __init__(self, command, exit_code=0, name=None):
        self.command, self.exit_code, self.name = command, exit_code, name or command


def cases(seconds):
    minutes = seconds // MINUTE
    timed = f"TIME --trace trace.txt --output output.csv --capture line.vcd --capture line.pcap --json"
    return [
        Case("run SLAVE --for TIME"),
        Case(f"run LONG_SCAN --for {timed} --input pulses.csv --memory memory.json --fault noise:ber=1e-6",
             name="run LONG_SCAN with everything that it writes"),
        Case("run BEACON --for HOURS --output output.csv --capture line.vcd --capture line.pcap",
             name="run, an answer every 50 ms, a tenth of the time, with its captures"),
        Case("run BEACON --for TENFOLD --capture line.pcap --fault cut",
             name="run, an answer every 50 ms on a line that is cut, ten times as long, with its capture"),
        Case("send SLAVE --crc 020300000001 --timeout TIME --timeline", 1),
        Case("send SLAVE --crc 020300000001 --timeout TIME --timeline --json", 1),
        Case("send FLICKER 01 --timeout HOURS --timeline --json", 1,
             name="send --timeline, an interrupt every 50 ms, a tenth of the time"),
        Case("test waits.yaml"),
        Case("test waits.yaml --json --junit results.xml --record transcript.yaml --force"),
        Case("test waits.yaml --against SLAVE"),
        Case(f"test --random {minutes * 40} --target SLAVE --json --record transcript.yaml --force --junit results.xml",
             name="test --random, forty requests a minute"),
        Case(f"test --random {minutes * 40} --target SLAVE --against SLAVE", name="test --random --against, forty requests a minute"),
        Case(f"master SLAVE read 40001 --every 60s --count {minutes}"),
        Case(f"master SLAVE read 40001 --every 60s --count {minutes} --json --capture line.pcap"),
        Case(f"master SLAVE read 40001 --continuous --count {minutes} -v"),
        Case("debug SLAVE -x 'continue TIME'"),
    ]


def waits(seconds):
    """No wait is longer than a day."""
    parts = [DAY] * (seconds // DAY) + [seconds % DAY] * (seconds % DAY > 0)
    steps = "".join(f"  - {{wait: {part}s}}\n  - {{read: holding 0, expect: accepted}}\n" for part in parts)
    return f"program: {SLAVE}\nsteps:\n  - {{read: holding 0, expect: accepted}}\n{steps}"


def peak(case, seconds, folder):
    """Of its memory, in kB. The last figure before the end is not the end's, but growth takes longer than 2 ms."""
    (folder / "waits.yaml").write_text(waits(seconds), encoding="utf-8")
    (folder / "pulses.csv").write_text(f"10ms,I0.0,pulses,10Hz,{seconds}s\n", encoding="utf-8")
    (folder / "beacon.stl").write_text(BEACON, encoding="utf-8")
    (folder / "flicker.stl").write_text(BEACON.replace("XMT VB0, 0\n", ""), encoding="utf-8")
    words = {"SLAVE": SLAVE, "LONG_SCAN": LONG_SCAN, "BEACON": "beacon.stl", "FLICKER": "flicker.stl", "TIME": f"{seconds}s",
             "HOURS": f"{seconds // 10}s", "TENFOLD": f"{seconds * 10}s"}
    command = re.sub("|".join(words), lambda word: str(words[word.group()]), case.command)
    arguments = [word.strip("'") for word in re.findall(r"'[^']*'|\S+", command)]
    with open(folder / "errors", "w+", encoding="utf-8") as errors:
        process = subprocess.Popen([S7200, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=errors)
        most = 0
        while process.poll() is None:
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
            if found := re.search(r"VmHWM:\s+(\d+) kB", status):
                most = max(most, int(found.group(1)))
            time.sleep(0.002)
        errors.seek(0)
        if process.returncode != case.exit_code:
            raise AssertionError(f"exit code {process.returncode}: {command}\n{errors.read()}")
    return most


class LongRuns(unittest.TestCase):
    def test_they_need_no_more_memory_than_short_ones(self):
        for case, longer in zip(cases(5 * MINUTE), cases(HOUR)):
            with self.subTest(case.name), tempfile.TemporaryDirectory() as folder:
                short = peak(case, 5 * MINUTE, pathlib.Path(folder))
                self.assertGreater(short, 0)
                most = OF_THE_PAST if case.name.startswith("debug") else MOST_GROWTH
                self.assertLess(peak(longer, HOUR, pathlib.Path(folder)) - short, most)


def print_table():
    print("| a simulated week, and an hour of the same | week | hour |\n|---|---|---|")
    for hour, week in zip(cases(HOUR), cases(7 * DAY)):
        with tempfile.TemporaryDirectory() as folder:
            of_hour = peak(hour, HOUR, pathlib.Path(folder))
            of_week = peak(week, 7 * DAY, pathlib.Path(folder))
        print(f"| `{week.name}` | {of_week / 1024:.1f} MB | {of_hour / 1024:.1f} MB |", flush=True)


if __name__ == "__main__":
    if WEEK:
        print_table()
    else:
        result = unittest.TextTestRunner(stream=sys.stdout).run(unittest.defaultTestLoader.loadTestsFromTestCase(LongRuns))
        sys.exit(0 if result.wasSuccessful() else 1)
