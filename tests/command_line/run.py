#!/usr/bin/env python3
"""The `s7200` command as its users meet it: run.py S7200 SOURCE_DIR verbs|options|json|json_page|inspect|coverage|compare|fuzz|files|scenarios|input|readme|times|systems"""
import base64
import contextlib
import csv
import fnmatch
import glob
import html
import itertools
import json
import os
import pathlib
import pty
import random
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import termios
import time
import unittest
import xml.etree.ElementTree
import zlib

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from modbus_crc import framed  # noqa: E402

S7200, SOURCE, GROUP = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
SLAVE = str(SOURCE / "stl_programs/modbus_slave.stl")
LOG = str(SOURCE / "tests/recordings/plant.log")
FAST_SLAVE = (SOURCE / "stl_programs/modbus_slave.stl").read_text(encoding="utf-8").replace(  # loses characters with some tables of times
    "MOVB    6, SMB34 ", "MOVB    5, SMB34 ").replace("MOVB    16#49, SMB30", "MOVB    16#41, SMB30")
LONG_REQUEST = "0110000000" + "3c78" + "5a" * 120
MEASURE = str(SOURCE / "stl_programs/measure_times.stl")
EXPORTS = SOURCE / "tests/exports"
TIP = SOURCE.parent / "shared/seeds/tip41_modbus_rtu_slave.txt"
VERBS = [name.replace("_", "-")
         for name in re.findall(r"^void add_(\w+)\(CLI::App", (SOURCE / "tools/command/verbs/commands.hpp").read_text(encoding="utf-8"), re.M)]
FINE, FAILED, UNUSABLE, FATAL = range(4)


def s7200(*arguments, **options):
    options = {"stdin": subprocess.DEVNULL, "capture_output": True, "text": True, "timeout": 120, **options}
    return subprocess.run([S7200, *map(str, arguments)], check=False, **options)


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def program(self, text, name="program.stl"):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def ends(self, code, *arguments, **options):
        done = s7200(*arguments, **options)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        return done

    def json(self, code, *arguments):
        return json.loads(self.ends(code, *arguments).stdout)


class Verbs(Case):
    def test_there_are_verbs(self):
        self.assertIn("send", VERBS)
        listed = s7200("--help").stdout
        for verb in VERBS:
            self.assertRegex(listed, rf"(?m)^  {verb}\b")

    def test_help_of_every_verb_has_an_example(self):
        for verb in VERBS:
            with self.subTest(verb):
                done = self.ends(FINE, verb, "--help")
                self.assertIn(f"Example: s7200 {verb}", done.stdout)
                self.assertEqual(done.stderr, "")

    @staticmethod
    def width(text):
        return max(map(len, text.split("\n")))

    TOPICS = re.findall(r'HelpTopic\{"([\w-]+)"', (SOURCE / "tools/command/help/help_topics.cpp").read_text(encoding="utf-8"))

    def test_help_fits_a_screen(self):
        for words in ([], *([verb] for verb in VERBS), ["manual"], ["complete"], ["help"]):
            with self.subTest(words):
                shown = self.ends(FINE, *words, "--help").stdout
                self.assertLessEqual(shown.count("\n"), 40)
                self.assertLessEqual(self.width(shown), 100)

    def test_help_all_has_every_option_and_no_line_of_more_than_100_columns(self):
        for verb in VERBS:
            with self.subTest(verb):
                shown = self.ends(FINE, verb, "--help-all").stdout
                self.assertLessEqual(self.width(shown), 100)
                options = {word.split("\t")[0] for word in s7200("complete", "--", verb, "--").stdout.split("\n") if word}
                self.assertEqual(set(re.findall(r"(?m)^  (?:-\w,)?(--[\w-]+)", shown)), options)
                short = set(re.findall(r"(?m)^  (?:-\w,)?(--[\w-]+)", self.ends(FINE, verb, "--help").stdout))
                self.assertLessEqual(short, options)
                self.assertGreater(len(short), 0)
                if short != options:
                    self.assertIn(f"s7200 {verb} --help-all shows all {len(options)} options", s7200(verb, "--help").stdout)

    def test_every_topic_is_listed_and_printed_in_lines_that_fit(self):
        listed = self.ends(FINE, "help").stdout.split("Topics,")[1]
        self.assertGreater(len(self.TOPICS), 10)
        for topic in self.TOPICS:
            with self.subTest(topic):
                self.assertRegex(listed, rf"(?m)^  {topic} ")
                shown = self.ends(FINE, "help", topic)
                self.assertEqual(shown.stderr, "")
                self.assertLessEqual(self.width(shown.stdout), 100)
                self.assertGreater(shown.stdout.count("\n"), 3)

    def test_a_topic_that_a_help_names_is_there(self):
        for verb in VERBS:
            shown = " ".join(s7200(verb, "--help-all").stdout.split())
            for list_of in re.findall(r"s7200 help TOPIC has the lists: ([\w, -]+)", shown):
                self.assertLessEqual(set(list_of.strip().split(", ")), set(self.TOPICS), verb)
            for topic in re.findall(r"s7200 help (?!TOPIC)([\w-]+)", shown):
                self.assertIn(topic, self.TOPICS, verb)

    def test_help_is_as_wide_as_its_terminal(self):
        for columns in (60, 80, 200):
            with self.subTest(columns):
                here, there = pty.openpty()
                termios.tcsetwinsize(there, (40, columns))
                done = subprocess.run([S7200, "run", "--help"], stdout=there, timeout=60, check=True)
                shown = os.read(here, 65536).decode().replace("\r\n", "\n")
                os.close(there)
                os.close(here)
                lines = [line for line in shown.split("\n") if not line.startswith(("Usage:", "Example:"))]
                self.assertLessEqual(max(map(len, lines)), min(columns, 100))

    def test_examples_of_our_programs_work(self):
        for verb in VERBS:
            example = re.search(r"Example: s7200 (.*)", s7200(verb, "--help").stdout).group(1)
            if "tip41" in example or ">" in shlex.split(example) or verb in ("bench", "view"):  # view ends when it is interrupted
                continue
            with self.subTest(example):
                self.assertLess(s7200(*shlex.split(example), cwd=SOURCE).returncode, UNUSABLE, example)

    def test_version(self):
        for word in ("--version", "-V", "version"):
            self.assertRegex(self.ends(FINE, word).stdout, r"^s7200 \d+\.\d+\.\d+\n$")

    def test_help_as_people_type_it(self):
        self.assertEqual(self.ends(FINE, "help").stdout, self.ends(FINE, "--help").stdout)
        for verb in VERBS:
            helped = self.ends(FINE, "help", verb).stdout
            self.assertEqual(helped[:helped.find("\nTables of execution times") if verb == "times" else None], self.ends(FINE, verb, "--help").stdout)
        for word in ("help", "version"):
            self.assertEqual(self.ends(FINE, "help", word).stdout, self.ends(FINE, "--help").stdout)
        self.assertIn("'frob' is not a verb or a topic; 's7200 help' lists them\n", self.ends(UNUSABLE, "help", "frob").stderr)
        self.assertIn("'fault' is not a verb or a topic; did you mean faults?\n", self.ends(UNUSABLE, "help", "fault").stderr)

    def test_an_unknown_option_before_the_verb_is_named(self):
        for arguments, said in ((["--json"], "a verb is missing, and there is no option --json before one\n"),
                                (["--verison"], "a verb is missing, and there is no option --verison before one; did you mean --version?\n"),
                                (["--json", "check", SLAVE], "there is no option --json before the verb\n")):
            self.assertIn(f"s7200: error: {said}", self.ends(UNUSABLE, *arguments).stderr)

    def test_quoted_input_is_shortened(self):
        for arguments in (["send", SLAVE, "01" * 3000 + "x"], ["send", SLAVE, "--text", "A" * 6000 + "\\q"], ["x" * 300],
                          ["run", SLAVE, "--set", "V" * 300], ["run", SLAVE, "--for", "1" * 300], ["master", SLAVE, "x" * 300],
                          ["run", SLAVE, "--scans", "1" * 300], ["instructions", "X" * 300], ["--" + "x" * 300],
                          ["run", SLAVE, "--cpu", "2" * 300], ["run", SLAVE, "--fault", "x" * 300, "--tcp", "x" * 300]):
            done = self.ends(UNUSABLE, *arguments)
            message = done.stderr.split("\n")[0]
            self.assertIn("...", message)
            self.assertLess(len(message), 320)

    def test_numbers_out_of_range_are_said_to_be(self):
        for option, value, said in (("--for", "1000000000h", "'1000000000h' is out of range (0 ns to 10000 h)"),
                                    ("--for", "10001h", "'10001h' is out of range (0 ns to 10000 h)"),
                                    ("--for", "1e5s", "'1e5s' is not a duration"), ("--scans", "0", "'0' is out of range (1 or more)"),
                                    ("--scans", "9" * 30, f"'{'9' * 30}' is out of range"), ("--scans", "2.5", "'2.5' is not a whole number"),
                                    ("--speed", "0", "'0' is out of range (0.001 to 1000)"), ("--speed", "1001", "'1001' is out of range"),
                                    ("--speed", "nan", "'nan' is not a number"), ("--speed", "1e999", "'1e999' is out of range")):
            self.assertIn(said, self.ends(UNUSABLE, "run", SLAVE, option, value).stderr)

    def test_german_mnemonics_are_explained_as_check_does(self):
        self.assertIn("U is a German mnemonic; write A\n", self.ends(UNUSABLE, "instructions", "u").stderr)
        self.assertIn("unknown instruction 'MOWV'; did you mean MOVW (copy word IN to OUT)?\n", self.ends(UNUSABLE, "instructions", "MOWV").stderr)

    def test_a_word_that_is_not_a_verb_gets_the_nearest_one(self):
        for word, meant in (("chek", "check"), ("RUN", "run"), ("sned", "send"), ("tests", "test"), ("Help", "help")):
            done = self.ends(UNUSABLE, word)
            self.assertEqual((done.stdout, done.stderr.split("\n")[0]),
                             ("", f"s7200: error: '{word}' is not a verb; did you mean {meant}?"))
        done = self.ends(UNUSABLE, "frobnicate")
        self.assertIn(f"'frobnicate' is not a verb; there are {', '.join(VERBS)}, help, version ", " ".join(done.stderr.split()))
        self.assertLessEqual(self.width(done.stderr), 100)
        self.assertIn(f"'{SLAVE}' is a file, and the verb before it is missing", self.ends(UNUSABLE, SLAVE).stderr)
        self.assertIn("the verb is missing", self.ends(UNUSABLE).stderr)

    def test_usage_errors_name_the_option_and_its_verb(self):
        done = self.ends(UNUSABLE, "send", SLAVE, "01", "--baud", "1")
        self.assertEqual(done.stderr, "s7200: error: --baud: '1' is out of range (50 to 1000000)\n"
                                      "'s7200 send --help' shows how it is used\n")

    def test_a_frame_torn_apart_by_its_blanks_is_recognised(self):
        torn = ["01", "03", "00", "0a", "00", "01"]
        note = "put it in quotes: '01 03 00 0a 00 01'"
        self.assertIn(note, self.ends(FAILED, "send", SLAVE, "--crc", *torn, "--timeout", "50ms").stderr)
        self.assertIn(note, self.ends(FAILED, "master", SLAVE, "raw", *torn, "--crc", "--timeout", "50ms").stderr)
        self.assertNotIn("quotes", self.ends(FINE, "send", SLAVE, "--crc", " ".join(torn)).stderr)
        echo = self.program(Json.ECHO)
        self.assertNotIn("quotes", self.ends(FINE, "send", echo, "ab", "cd").stderr, "frames of one byte have their answers")

    def test_frames_may_be_written_as_other_tools_have_them(self):
        for frame in ("01 03 00 0a 00 02 crc", "01-03-00-0a-00-02-e4-09", "0x01 0x03 0x00 0x0a 0x00 0x02 0xe4 0x09", "01:03:00:0A:00:02:E4:09"):
            self.assertIn("request  01 03 00 0a 00 02 e4 09\n", self.ends(FINE, "send", SLAVE, frame).stdout)
        for frame, hint in ((":0103000A0002F0", "--text"), ("crc", "in quotes"), ("read 40011:2", "s7200 master")):
            self.assertIn(hint, self.ends(UNUSABLE, "send", SLAVE, frame).stderr)

    def test_a_launch_takes_further_files_and_values_by_their_places(self):
        def message(number, command, **arguments):
            body = json.dumps({"seq": number, "type": "request", "command": command, "arguments": arguments})
            return f"Content-Length: {len(body)}\r\n\r\n{body}"
        stream = message(1, "initialize", adapterID="s7200") + message(2, "launch", program=str(EXPORTS / "pump.awl"),
            **{"with": [str(EXPORTS / "pump_symbols.txt")], "set": {"VW10": "0x10"}, "cpu": "CPU 224"}, stopOnEntry=True)
        stream += message(3, "configurationDone") + message(4, "evaluate", expression="Pump") + message(5, "evaluate", expression="VW10")
        said = s7200("dap", stdin=None, input=stream + message(6, "disconnect")).stdout
        self.assertIn('"result":"0"', said)
        self.assertIn('"result":"16#0010 (16)"', said)

    def test_polling_in_simulation_says_how_often(self):
        for options in (["--every", "1s"], ["--every", "1s", "--json"], ["--continuous", "--json"], ["--continuous", "-v"]):
            done = self.ends(UNUSABLE, "master", SLAVE, "read", "40001", *options)
            self.assertEqual(done.stdout, "")
            self.assertIn("without --count never ends", done.stderr)
            self.ends(FINE, "master", SLAVE, "read", "40001", *options, "--count", "2")

    def test_a_simulated_plc_of_another_make_is_a_target(self):
        result = self.json(FINE, "master", "westinghouse:pc1200", "--plc", "HR1=1234,FFFB", "--plc", "slave=02", "--station", 2, "--json",
                           "read", "40001:2", "write", "40003=7", "read", "40003", "exception-status", "general-read", "0:0:4")
        self.assertEqual([e["verdict"] for e in result["exchanges"]], ["right"] * 5)
        self.assertEqual([e["values"] for e in result["exchanges"]], [[0x1234, 0xFFFB], None, [7], None, None])
        self.assertEqual(result["exchanges"][4]["bytes"], "3412fbff")
        self.assertEqual((result["target"], result["mode"]), ("westinghouse:pc1200", None))
        self.assertIn("illegal function", self.ends(FAILED, "master", "westinghouse:pc503", "read", "30001").stdout)

    def test_a_simulated_plc_of_another_make_is_tested_and_new_for_each_scenario(self):
        yaml = self.program("timeout: 300ms\nscenarios:\n"
                            "  - {name: writes, steps: [{read: 40001, expect: [16#1234], latency: 1ms..100ms}, {write: 40001, values: [7]},"
                            " {read: 40001, expect: [7]}]}\n"
                            "  - {name: new, steps: [{at: 2s, read: 40001, expect: [16#1234]}]}\n"
                            "  - {name: inside, set: {VW0: 1}, steps: [{read: 40001}]}\n", "peer.yaml")
        peer = ["--target", "westinghouse:pc1200", "--plc", "HR1=1234"]
        for jobs in ("1", "3"):
            result = self.json(FINE, "test", yaml, *peer, "--jobs", jobs, "--json")
            self.assertEqual([(one["name"], one["outcome"]) for one in result["scenarios"]],
                             [("writes", "passed"), ("new", "passed"), ("inside", "skipped")])
        self.ends(FAILED, "test", yaml, *peer[:2])
        self.ends(FINE, "test", yaml, *peer, "--plc", "baud=19200")
        self.ends(FAILED, "test", yaml, *peer, "--baud", 19200)
        late = self.program("steps: [{read: 40001, latency: 100ms..200ms}]\n", "late.yaml")
        self.assertIn("latency is not what was expected", self.ends(FAILED, "test", late, *peer).stdout, "times are exact in simulation")
        transcript = self.folder / "recorded.yaml"
        self.ends(FINE, "test", yaml, *peer, "--record", transcript)
        self.ends(FINE, "test", transcript, *peer, "--tolerance", "0s", "--record", self.folder / "again.yaml")
        random = ["test", "--random", 30, *peer, "--json"]
        self.assertEqual(self.json(FINE, *random)["scenarios"][0]["exchanges"], self.json(FINE, *random)["scenarios"][0]["exchanges"])
        self.ends(FINE, "test", yaml, *peer, "--against", peer[1])
        self.assertIn("DIFFER", self.ends(FAILED, "test", yaml, *peer, "--against", SLAVE).stdout)
        conformance = self.json(FAILED, "test", "--conformance", SOURCE / "tests/conformance/modbus_slave.yaml", *peer, "--json")
        self.assertGreater(sum(one["outcome"] == "passed" for one in conformance["scenarios"]), 20)

    def test_targets_that_a_verb_cannot_have_are_refused_by_name(self):
        yaml = self.program("steps: [{read: 40001}]\n", "one.yaml")
        system = self.program(Systems.SYSTEM, "system.yaml")
        for arguments, why in ((["test", yaml, "--target", "westinghouse:pc9"], "'pc9' is not a PLC that speaks modbus here"),
                               (["test", yaml, "--target", "westinghouse:pc1200", "--plc", "colour=red"], "--plc: 'colour=red' is not a setting"),
                               (["test", yaml, "--target", SLAVE, "--plc", "slave=02"], "--plc needs westinghouse:MODEL as --target or --against"),
                               (["test", yaml, "--target", SLAVE, "--at", "bus"], "--at names a place in a system file"),
                               (["test", yaml, "--target", "westinghouse:pc1200", "--times-band", "5"], "the target must be a program"),
                               (["test", yaml, "--target", SLAVE, "--protocol", "westnet"], "--protocol needs westinghouse:MODEL as --target or --against"),
                               (["send", "westinghouse:pc1200", "01"], "'s7200 send' is about an S7-200; 's7200 master' asks this PLC, 's7200 run' serves it to others"),
                               (["debug", "westinghouse:pc1200", "-x", "quit"], "'s7200 debug' is about an S7-200; 's7200 master' asks this PLC"),
                               (["calibrate", "westinghouse:pc1200"], "'westinghouse:pc1200' is not an S7-200"),
                               (["calibrate", system], "is a system file: name the PROGRAM")):
            with self.subTest(arguments):
                self.assertIn(why, self.ends(UNUSABLE, *arguments).stderr)

    def test_a_register_that_is_not_there_is_not_set(self):
        for setting, why in (("HR9999=1", "HR9999 is not there: holding_registers=2048"), ("HR2048=1,2", "HR2049 is not there"),
                             ("CR1025=1", "CR1025 is not there: coils=1024"), ("IR257=1", "input_registers=256"), ("IN1025=1", "inputs=1024")):
            self.assertIn(why, self.ends(UNUSABLE, "master", "westinghouse:pc1200", "slave-id", "--plc", setting).stderr)
        self.ends(FINE, "master", "westinghouse:pc1200", "--plc", "HR2047=1,2", "read", "holding", "2046:2")
        cells_first = ["--plc", "HR1=1234", "--plc", "holding_word=0010"]  # which moves HR1
        self.assertIn("16#1234", self.ends(FINE, "master", "westinghouse:pc1200", *cells_first, "read", "holding", "0").stdout)
        self.ends(FINE, "master", "westinghouse:pc1200", "--plc", "holding_registers=9999", "--plc", "HR9999=1", "read", "holding", 9998)

    def test_the_line_of_a_simulated_plc_is_captured_and_decoded_in_its_protocol(self):
        for protocol, model, words, said in (
                ("modbus", "pc1200", ["write", "40001=7", "read", "40001", "general-read", "0:0:2"],
                 ["station 1, write register 40001 = 16#0007", "register 40001 written: 16#0007", "station 1, read holding registers 40001, 1 of them",
                  "1 register: 16#0007", "station 1, read file record: extended memory 0000:0000, 2 bytes", "references of kind 16#33: 07 00"]),
                ("pc1000-lan", "pc1200", ["unit", "5", "read", "16#4000"],
                 ["address unit 16#05", "keyswitch in stop, fault register 16#0000", "read 2 bytes from word 16#4000 on", "00 00"]),
                ("westnet", "pc1200", ["address", "17", "open"],
                 ["address 00.11.00", "PLC 00.11.00 addressed", "open session", "session open"]),
                ("hppc", "hppc", ["read", "16#80000:2"], ["read 2 bytes from 16#80000 on", "2 bytes: 8a 00"])):
            with self.subTest(protocol):
                files = [self.folder / f"{protocol}.pcap", self.folder / f"{protocol}.vcd"]
                self.ends(FINE, "master", f"westinghouse:{model}", "--protocol", protocol, *words, "--capture", files[0], "--capture", files[1])
                decoded = self.json(FINE, "decode", files[0], "--protocol", protocol, "--json")
                self.assertEqual([frame["text"] for frame in decoded["frames"]], said)
                self.assertEqual([frame["kind"] for frame in decoded["frames"]], ["request", "answer"] * (len(said) // 2))
                self.assertGreater(min(frame["latency_us"] for frame in decoded["frames"][1::2]), 1000)
                levels = files[1].read_text(encoding="utf-8")
                self.assertIn("\n0r\n", levels)
                self.assertIn("\n0t\n", levels)
        loader = self.folder / "loader.pcap"
        self.ends(FINE, "master", "westinghouse:pc503", "--protocol", "pc500-loader", "read", "QB0:4", "--capture", loader)
        decoded = self.json(FINE, "decode", loader, "--protocol", "pc500-loader", "--json")
        self.assertIn("bytes 16#EF80…EF83", [frame["text"] for frame in decoded["frames"]])
        self.assertIn("00 00 00 00 00 12 34 56 78", [frame["text"] for frame in decoded["frames"]])
        self.assertEqual({key: decoded["summary"][key] for key in ("requests", "answered", "need_no_answer", "wrong", "strays")},
                         {"requests": 8, "answered": 7, "need_no_answer": 1, "wrong": 0, "strays": 0})
        self.ends(FINE, "master", "westinghouse:pc503", "--protocol", "pc500-loader", "--plc", "dle=plain", "--dle", "plain",
                  "--plc", "M[9000]=10,03,10,10", "read", "16#9000:4", "--capture", loader)
        plain = self.json(FINE, "decode", loader, "--protocol", "pc500-loader", "--dle", "plain", "--json")
        self.assertIn("00 00 00 00 00 10 03 10 10", [frame["text"] for frame in plain["frames"]])
        self.assertEqual(plain["summary"]["wrong"], 0)
        doubled = self.json(FINE, "decode", loader, "--protocol", "pc500-loader", "--json")
        self.assertGreater(doubled["summary"]["wrong"], 0)
        self.assertIn("--dle plain: modbus has no such option; it is for pc500-loader", self.ends(UNUSABLE, "decode", loader, "--dle", "plain").stderr)
        lan = ("--protocol", "pc1000-lan", "--data-check", "xor")
        self.ends(FINE, "master", "westinghouse:pc1200", *lan, "--plc", "data_check=xor", "unit", "5", "write", "16#4000=16#1234", "read", "16#4000",
                  "--capture", loader)
        self.assertEqual(self.json(FINE, "decode", loader, *lan, "--json")["summary"]["wrong"], 0)
        by_sum = self.json(FINE, "decode", loader, *lan[:2], "--json")
        self.assertEqual(by_sum["summary"]["wrong"], 2)
        self.assertIn("write 2 bytes from word 16#4000 on: 34 12; wrong data check: it is the XOR of the data, not the sum",
                      [frame["text"] for frame in by_sum["frames"]])
        self.assertIn("--data-check xor: modbus has no such option; it is for pc1000-lan, westnet", self.ends(UNUSABLE, "decode", loader, "--data-check", "xor").stderr)
        self.assertIn("neither in .vcd", self.ends(UNUSABLE, "master", "westinghouse:pc1200", "slave-id", "--capture", "x.txt").stderr)
        loud = self.folder / "LINE.PCAP"
        self.ends(FINE, "master", "westinghouse:pc1200", "slave-id", "--capture", loud)
        self.assertIn("report slave id", self.ends(FINE, "decode", loud).stdout)

    # Every action of each protocol, and what nobody answers.
    RECORDED = {
        "modbus": ("westinghouse:pc1200",
                   ["read", "40001:3", "00001:9", "10001", "30001", "write", "40001=5", "40001=1,2", "00001=on", "00001=1,0,1", "loopback", "1",
                    "diagnostics", "2", "exception-status", "slave-id", "general-read", "0:0:2", "general-write", "0:0=1,2", "read", "49999",
                    "function", "65", "00"],
                   ["station", "9", "read", "40001", "write", "40001=5", "loopback", "5"]),
        "freeport-pc": ("stl_programs/freeport_host_slave.stl", ["read", "VB100:4", "MB8", "IB0", "write", "VB100=1,2"], ["station", "9", "read", "VB1"]),
        "pc1000-lan": ("westinghouse:pc1200",
                       ["unit", "5", "write", "16#4000=16#1234,-1", "read", "16#4000:2", "set", "16#4000.0", "reset", "16#4000.2", "retest", "unit",
                        "erase", "read", "16#4000"], ["unit", "6"]),
        "westnet": ("westinghouse:pc1200",
                    ["local", "address", "17", "session", "open", "write", "0=16#1234", "read", "0", "set", "0.1", "reset", "0.1", "retest", "close",
                     "remote", "status"], []),
        "pc500-loader": ("westinghouse:pc503", ["read", "QB0:2", "write", "QB1=16,3", "read", "QB1:2", "block", "1", "blocks", "parameters"], []),
        "hppc": ("westinghouse:hppc",
                 ["write-register", "1=16#1234,5", "read-register", "1:2", "write", "16#ABFFC=1,2", "read", "16#ABFFC:4", "bits",
                  "16#ABFFE=16#F000/16#FF00", "monitor", "w:16#ABFFE", "b:16#ABFFC", "resync", "parameters", "0", "read", "16#FFFFF:2"], []),
        "ppi": ("idle.stl",
                ["read", "VB100:4", "VW100:2", "VD20:real", "M31.7", "QB0", "SMB0", "AIW0", "T37", "C5", "write", "VB100=65,66", "VW100=-5",
                 "M31.7=1", "C5=0", "stop", "run", "set-clock", "2026-11-22T15:45:30", "clock", "status"], ["station", "9", "read", "VB0"])}

    def recorded(self, protocol, words, *options):
        """What the master says of its exchanges, and what its capture says."""
        target = self.RECORDED[protocol][0]
        if target.endswith(".stl"):
            target = self.program("LD SM0.0\nMOVW VW0, VW2\nMEND\n", target) if protocol == "ppi" else SOURCE / target
        options = (*options, *(("--cpu", 226) if protocol == "freeport-pc" else ()))
        capture = self.folder / f"{protocol}.pcap"
        done = s7200("master", target, "--protocol", protocol, *words, *options, "--json", "--capture", capture)
        self.assertLess(done.returncode, UNUSABLE, done.stderr)
        return json.loads(done.stdout)["exchanges"], self.json(FINE, "decode", capture, "--protocol", protocol, "--json"), capture

    def test_a_capture_says_of_every_action_what_the_master_said(self):
        for protocol, (_, words, _) in self.RECORDED.items():
            for options in ([], ["--pause", "0ms"]):
                with self.subTest(protocol=protocol, options=options):
                    exchanges, decoded, _ = self.recorded(protocol, [*words, *words], *options)
                    summary = decoded["summary"]
                    self.assertEqual((summary["wrong"], summary["strays"]), (0, 0), [f["text"] for f in decoded["frames"] if not f["right"]])
                    self.assertEqual(summary["answered"] + summary["need_no_answer"], summary["requests"])
                    self.assertEqual({e["verdict"] for e in exchanges} - {"right", "exception"}, set())
                    self.assertTrue(all(e["attempts"] == 1 or e["verdict"] == "exception" for e in exchanges))
                    answers = "".join(f["bytes"] for f in decoded["frames"] if f["kind"] == "answer")
                    for exchange in exchanges:
                        self.assertIn(exchange["response"], answers)
                        answers = answers.split(exchange["response"], 1)[1]
                    if protocol == "pc500-loader":
                        texts = [frame["text"] for frame in decoded["frames"]]
                        self.assertEqual((texts.count("start of a session"), texts.count("session closed")), (len(exchanges), len(exchanges)))

    def test_a_capture_has_every_attempt_as_a_request_and_none_as_its_answer(self):
        for protocol, (_, words, silent) in self.RECORDED.items():
            if not silent:
                continue
            with self.subTest(protocol):
                exchanges, decoded, capture = self.recorded(protocol, [*silent, *silent], "--retries", "2", "--timeout", "200ms")
                summary = decoded["summary"]
                self.assertEqual({e["verdict"] for e in exchanges}, {"silent"})
                self.assertEqual([summary[key] for key in ("requests", "answered", "wrong", "strays")], [sum(e["attempts"] for e in exchanges), 0, 0, 0])

    def test_what_an_hppc_is_asked_before_a_repetition_can_be_set(self):
        silent = ["--protocol", "hppc", "westinghouse:hppc", "--fault", "missing:of=answer,character=each", "parameters", "--retries", "1"]
        def requests(*options):
            capture = self.folder / "hppc.pcap"
            s7200("master", *silent, *options, "--capture", capture)
            frames = json.loads(self.ends(FINE, "decode", capture, "--protocol", "hppc", "--json").stdout)["frames"]
            return [(frame["bytes"].startswith("0c"), frame["at_us"]) for frame in frames if frame["kind"] == "request"]
        usual, plain = requests(), requests("--no-resync", "--before-retry", "20ms")
        self.assertEqual([resync for resync, _ in usual], [False, True, False])
        self.assertEqual([resync for resync, _ in plain], [False, False])
        self.assertGreater(usual[1][1] - usual[0][1], plain[1][1] - plain[0][1])
        self.ends(UNUSABLE, "master", "westinghouse:pc1200", "read", "40001", "--no-resync")

    def test_a_capture_with_silence_and_repetition_plays_back_as_it_was(self):
        for protocol, arguments in (("modbus", ["--program", SLAVE]), ("ppi", ["--program", self.folder / "idle.stl"])):
            with self.subTest(protocol):
                _, words, silent = self.RECORDED[protocol]
                target = SLAVE if protocol == "modbus" else self.program("LD SM0.0\nMOVW VW0, VW2\nMEND\n", "idle.stl")
                capture, scenario = self.folder / "played.pcap", self.folder / f"{protocol}.yaml"
                chosen = ["read", "40011:2", "write", "40011=5", "read", "40011"] if protocol == "modbus" else [w for w in words if w != "clock"]
                s7200("master", target, "--protocol", protocol, *chosen, *silent, "--retries", "1", "--timeout", "200ms", "--capture", capture)
                done = self.ends(FINE, "import-capture", capture, "--protocol", protocol, *arguments, "-o", scenario)
                text = scenario.read_text(encoding="utf-8")
                self.assertIn("expect: silence\n", text, "a read that nobody answers is certain")
                self.assertEqual("may be its late echo" in text, protocol == "modbus", "and a write is not")
                self.assertEqual("may be its late echo" in done.stderr, protocol == "modbus")
                self.ends(FINE, "test", scenario)

    def test_the_masters_timeout_tells_a_late_echo_from_a_request_repeated(self):
        log = self.program("0.000 01 06 00 00 00 01 48 0a\n0.250 01 06 00 00 00 01 48 0a\n", "late.log")
        kinds = lambda *options: [frame["kind"] for frame in self.json(FINE, "decode", log, "--json", *options)["frames"]]
        self.assertEqual(kinds(), ["request", "request"])
        self.assertEqual(kinds("--timeout", "1s"), ["request", "answer"])

    def test_a_capture_of_a_simulated_plc_becomes_a_scenario(self):
        capture, scenario = self.folder / "lan.pcap", self.folder / "lan.yaml"
        self.ends(FINE, "master", "westinghouse:pc1200", "--protocol", "westnet", "address", "17", "write", "5=7", "read", "5", "--capture", capture)
        self.ends(FINE, "import-capture", capture, "--protocol", "westnet", "-o", scenario)
        text = scenario.read_text(encoding="utf-8")
        for part in ("- send: 09 00 00 11 00 1a\n", "expect: 05 05 00 01 00 0b 07 00 07\n", "write 2 bytes from word 16#0005 on: 07 00; done"):
            self.assertIn(part, text)

    def test_what_a_simulated_plc_of_any_protocol_was_asked_is_asked_again(self):
        for protocol, (target, words, _) in self.RECORDED.items():
            if not target.startswith("westinghouse:"):
                continue
            with self.subTest(protocol):
                capture, scenario = self.folder / f"{protocol}.pcap", self.folder / f"{protocol}.yaml"
                s7200("master", target, "--protocol", protocol, *words, "--capture", capture)
                self.ends(FINE, "import-capture", capture, "--protocol", protocol, "-o", scenario)
                named = "" if protocol == "modbus" else f", such as westinghouse:MODEL with --protocol {protocol}"
                self.assertIn(f"Run by s7200 test --target TARGET{named}.\n", scenario.read_text(encoding="utf-8"))
                self.ends(FINE, "test", scenario, "--target", target, "--protocol", protocol)

    def test_a_program_that_a_scenario_cannot_name_is_refused(self):
        for program, why in (("nowhere.stl", "cannot read nowhere.stl"), ("plant.yaml", "--program plant.yaml: the scenario names an STL file or a document here"),
                             ("-", "--program -: the scenario names")):
            self.assertIn(why, self.ends(UNUSABLE, "import-capture", LOG, "--program", program).stderr)

    def test_a_recording_of_ppi_names_the_station_of_the_program(self):
        program, capture, scenario = self.program("LD SM0.0\nMOVW VW0, VW2\nMEND\n"), self.folder / "ppi.pcap", self.folder / "ppi.yaml"
        self.ends(FINE, "master", "--protocol", "ppi", program, "--ppi-station", "9", "--station", "9", "read", "VW0", "--capture", capture)
        self.ends(FINE, "import-capture", capture, "--protocol", "ppi", "--program", program, "-o", scenario)
        self.assertIn("    ppi_station: 9\n", scenario.read_text(encoding="utf-8"))
        self.ends(FINE, "test", scenario)
        self.assertIn("no request to station 77 in it; the stations that are asked: 9",
                      self.ends(UNUSABLE, "import-capture", capture, "--protocol", "ppi", "--station", "77").stderr)

    def test_a_recording_of_the_second_port_is_played_there(self):
        capture, scenario = self.folder / "port1.pcap", self.folder / "port1.yaml"
        self.ends(FINE, "master", "--protocol", "ppi", SLAVE, "--cpu", "226", "--port", "1", "write", "VW20=1234,-5", "read", "VW20:2", "--capture", capture)
        play = ["import-capture", capture, "--protocol", "ppi", "--program", SLAVE, "-o", scenario, "--force"]
        self.ends(FINE, *play, "--cpu", "226", "--port", "1")
        self.assertIn("    port: 1\n", scenario.read_text(encoding="utf-8"))
        self.ends(FINE, "test", scenario)
        self.assertIn("CPU 214 has no port 1", self.ends(UNUSABLE, *play, "--port", "1").stderr)
        scenario.write_text(scenario.read_text(encoding="utf-8").replace("cpu: 226", "cpu: 224"), encoding="utf-8")
        self.assertIn("CPU 224 has no port 1", self.ends(UNUSABLE, "test", scenario).stderr)

    def test_levels_are_read_by_the_receiver_of_the_simulated_line(self):
        capture, scenario = self.folder / "line.vcd", self.folder / "levels.yaml"
        sent = self.json(FINE, "send", SLAVE, "--crc", "010300000001", "--json", "--capture", capture)["exchanges"][0]
        decoded = self.json(FINE, "decode", capture, "--json")
        self.assertEqual([frame["bytes"] for frame in decoded["frames"]], [sent["request"], sent["response"]])
        self.assertAlmostEqual(decoded["summary"]["shortest_latency_us"], sent["latency_us"], delta=1)
        self.assertEqual(decoded["line"], "9600 baud, 8 data bits, even parity, 1 stop bit")
        self.ends(FINE, "import-capture", capture, "--program", SLAVE, "-o", scenario)
        self.ends(FINE, "test", scenario)
        self.assertIn("; 9600 baud fit better", self.ends(FAILED, "decode", capture, "--baud", "300").stderr)

    def test_a_capture_shows_what_was_on_the_line_whoever_sent_it(self):
        capture, levels = self.folder / "line.pcap", self.folder / "line.vcd"
        done = s7200("send", SLAVE, "--crc", "0103000a0001", "--fault", "flip:character=3,bit=5,of=answer", "--json", "--capture", capture,
                     "--capture", levels)
        exchange, = json.loads(done.stdout)["exchanges"]
        self.assertEqual(exchange["response"][4:6], "22", "2 characters of data, and bit 5")
        frames = [frame["bytes"] for frame in self.json(FINE, "decode", capture, "--json")["frames"]]
        self.assertEqual(frames, [exchange["request"], exchange["response"]])
        dump = levels.read_text(encoding="utf-8")
        self.assertIn("$var wire 1 l line $end", dump)
        self.assertGreater(dump.count("l\n"), dump.count("t\n"))

    def test_several_ppi_masters_on_a_line_and_stations_that_spa_makes_the_same_are_warned_of(self):
        netr = self.program("LD SM0.1\nMOVB 2, SMB30\nLD SM0.0\nNETR VB100, 0\nMEND\n", "netr.stl")
        spa = self.program("LD SM0.1\nSPA 3, 0\nMEND\n", "spa.stl")
        for program, said in ((netr, "line 'bus' has several PPI masters, with NETR or NETW: a, b"), (spa, "PPI station 3 on line 'bus' is a, b")):
            system = self.program(f"plcs:\n  a: {{program: {program}, cpu: 224}}\n  b: {{program: {program}, cpu: 224}}\n"
                                  "lines: {bus: {stations: [a, b]}}\n", "twice.yaml")
            self.assertIn(said, s7200("run", system, "--for", "50ms").stderr)

    def test_two_masters_that_ask_at_once_are_mixed_in_the_capture(self):
        asked = {"a": ("40001", "010300000001840a"), "b": ("40008", "01030007000135cb")}
        peers = "".join(f"  {name}: {{polls: [{{read: {address}}}], every: 1h}}\n" for name, (address, _) in asked.items())
        system = self.program(f"plcs: {{slave: {{program: {SLAVE}}}}}\npeers:\n{peers}"
                              "lines: {bus: {stations: [slave, a, b], contention: space, capture: [both.pcap]}}\n", "both.yaml")
        self.ends(FINE, "run", system, "--for", "1500ms", cwd=self.folder)
        frames = [frame["bytes"] for frame in self.json(FAILED, "decode", self.folder / "both.pcap", "--json")["frames"]]
        first, second = (bytes.fromhex(frame) for _, frame in asked.values())
        self.assertEqual(frames, [bytes(one & other for one, other in zip(first, second)).hex()], "space wins, bit by bit")

    def test_a_recording_names_the_cpu_that_its_program_is_to_run_on(self):
        program = self.program("LD SM0.1\nMOVB 16#49, SMB30\nMEND\n", "idle.stl")
        log = self.program("0.000 01 03 00 00 00 01 84 0a\n", "silent.log")
        scenario = self.folder / "cpu.yaml"
        self.ends(FINE, "import-capture", log, "--program", program, "--cpu", "226", "-o", scenario)
        self.assertIn("    cpu: 226\n", scenario.read_text(encoding="utf-8"))
        self.ends(FINE, "test", scenario)
        self.assertIn("--cpu requires --program", self.ends(UNUSABLE, "import-capture", log, "--cpu", "226").stderr)

    def test_a_recording_of_a_faster_line_asks_for_its_rate(self):
        log = self.program("0.0000 10 03 04 5c 63 16\n0.0010 e5\n0.0012 10 03 04 5c 63 16\n0.0020 e5\n", "fast.log")
        said = "most frames begin before the one before can be over at 9600 baud: name the rate of the line with --baud"
        self.assertIn(said, self.ends(FINE, "decode", log, "--protocol", "ppi").stderr)
        self.assertNotIn("--baud", self.ends(FINE, "decode", log, "--protocol", "ppi", "--baud", "187500").stderr)

    def test_a_wrong_answer_in_a_recording_is_neither_counted_nor_expected_again(self):
        log = self.program("0.000 TX 01 03 00 00 00 01 84 0a\n0.020 RX 01 03 02 12 34 b5 34\n", "damaged.log")
        decoded = self.json(FINE, "decode", log, "--json")
        self.assertEqual([decoded["summary"][key] for key in ("requests", "answered", "wrong", "shortest_latency_us")], [1, 0, 1, None])
        self.assertEqual([frame["unanswered"] for frame in decoded["frames"]], [False, False], "an answer came, a wrong one")
        refused = self.ends(UNUSABLE, "import-capture", log).stderr
        self.assertIn("line 1: left out: its answer (line 2): wrong CRC", refused)
        self.assertIn("no request in it that can be asked again", refused)
        more = self.program(log.read_text(encoding="utf-8") + "0.100 TX 01 03 00 00 00 01 84 0a\n0.120 RX 01 03 02 12 34 b5 33\n", "damaged.log")
        done = self.ends(FINE, "import-capture", more)
        self.assertIn("line 1: left out", done.stderr)
        self.assertEqual(done.stdout.count("- send:"), 1)
        self.assertIn("expect: 01 03 02 12 34 b5 33\n", done.stdout)

    def test_a_row_of_a_recording_that_is_not_read_is_named_and_is_no_missing_answer(self):
        asked, said = "TX 01 03 00 00 00 01 84 0a\n", "RX 01 03 02 12 34 b5 33"
        log = self.program(f"0.000 {asked}0.020 {said} ok\n1.000 {asked}1.020 RX 01 03 02 1? 34 b5 33\n", "unread.log")
        decoded = self.json(FINE, "decode", log, "--json")
        self.assertEqual([frame["kind"] for frame in decoded["frames"]], ["request", "answer", "request", "unread"])
        self.assertEqual([decoded["summary"][key] for key in ("answered", "wrong", "not_read", "possible_answers_not_read")], [1, 0, 1, 1])
        shown = self.ends(FINE, "decode", log)
        self.assertIn("line 4: left out: cannot tell what '1?' next to its bytes means", shown.stderr)
        self.assertIn("line 2: 'ok' beside the bytes: not read, as the bytes are a right frame without it", shown.stderr)
        self.assertIn("rows not read: 1 (1 may be the answer to a request)", shown.stdout)
        done = self.ends(FINE, "import-capture", log)
        self.assertNotIn("silence\n", done.stdout)
        self.assertEqual(done.stdout.count("- send:"), 1)
        for text in (done.stdout, done.stderr):
            self.assertIn("line 3: left out: what follows it (line 4) may be its answer", text)

    def test_pieces_and_echoes_of_a_recording_are_said_and_played_as_whole_answers(self):
        log = self.folder / "two_wires.log"
        log.write_text("10:00:00.000 TX 01 03 00 0a 00 02 e4 09\n10:00:00.040 RX 01 03 00 0a 00 02 e4 09 01 03\n"
                       "10:00:00.056 RX 04 12 34 56 78 81 07\n", encoding="utf-8")
        for verb in ("decode", "import-capture"):
            done = self.ends(FINE, verb, log)
            self.assertEqual(done.stderr, "s7200: note: line 2: an answer in 2 pieces: joined, as only the whole is right\n"
                             "s7200: note: line 2: the echo of a request: an adapter for two wires hears what it sends; that is not an answer\n")
        self.assertIn("expect: 01 03 04 12 34 56 78 81 07", done.stdout)
        frames = self.json(FINE, "decode", log, "--json")
        self.assertEqual([frame["kind"] for frame in frames["frames"]], ["request", "echo", "answer"])
        self.assertEqual((frames["summary"]["answered"], frames["summary"]["echoes"], frames["summary"]["strays"]), (1, 1, 0))

    def test_a_decoding_that_is_interrupted_ends_its_json(self):
        log = self.folder / "long.log"
        log.write_text("".join(f"{i}.000 TX 01 03 00 00 00 01 84 0A\n{i}.040 RX 01 03 02 12 34 B5 33\n" for i in range(100_000)), encoding="utf-8")
        process = subprocess.Popen([S7200, "decode", log, "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, bufsize=0)
        self.addCleanup(process.kill)
        beginning = process.stdout.read(1)
        process.send_signal(signal.SIGINT)
        rest, error = process.communicate(timeout=120)
        self.assertEqual((process.returncode, error), (FAILED, b"s7200: note: interrupted\n"))
        results = json.loads(beginning + rest)
        self.assertLess(len(results["frames"]), 200_000)
        self.assertGreater(results["summary"]["requests"], 0)

    def test_what_is_interrupted_while_it_is_read_still_writes_its_results(self):
        for command, results in ((["decode", "-", "--json"], {"form": None, "frames": []}), (["check", "-", "--json"], {"files": []})):
            process = subprocess.Popen([S7200, *command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.addCleanup(process.kill)
            process.stdin.write(b"0.000 TX 01 03\n")
            process.stdin.flush()
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(60), FAILED, command)
            self.assertEqual(process.stderr.read(), b"s7200: note: interrupted\n")
            said = json.loads(process.stdout.read())
            self.assertEqual({key: said[key] for key in results}, results)

    def interrupted_while_reading(self, fifo, beginning, *arguments):
        """What is printed by a verb that waits for more of a file when it is interrupted."""
        path = self.folder / fifo
        os.mkfifo(path)
        process = subprocess.Popen([S7200, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        with path.open("wb", buffering=0) as writer:
            writer.write(beginning)
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            out, error = process.communicate(timeout=120)
        path.unlink()
        self.assertEqual((process.returncode, error), (FAILED, b"s7200: note: interrupted\n"), arguments)
        return out

    def test_test_that_is_interrupted_while_it_reads_writes_json_and_junit_without_a_scenario(self):
        scenario, junit, recorded, marked = (self.folder / name for name in ("long.yaml", "junit.xml", "recorded.yaml", "out.md"))
        said = json.loads(self.interrupted_while_reading("long.yaml", b"steps:\n", "test", scenario, "--json", "--junit", junit))
        self.assertEqual((said["scenarios"], said["passed"], said["failed"]), ([], 0, 0))
        (case,) = xml.etree.ElementTree.parse(junit).getroot().iter("testcase")
        self.assertEqual(case.find("error").get("message"), "interrupted before anything was run")
        self.interrupted_while_reading("long.yaml", b"steps:\n", "test", scenario, "--markdown", marked)
        self.assertIn("- interrupted before anything was run\n", marked.read_text(encoding="utf-8"))
        self.assertEqual(self.interrupted_while_reading("long.yaml", b"steps:\n", "test", scenario, "--record", recorded), b"")
        self.assertFalse(recorded.exists())

    def test_inspect_that_is_interrupted_says_so_in_its_json(self):
        said = json.loads(self.interrupted_while_reading("long.stl", b"LD I0.0\n", "inspect", self.folder / "long.stl", "races", "--json"))
        self.assertEqual((said["interrupted"], said["files"]), (True, []))
        self.assertFalse(self.json(FINE, "inspect", self.program("LD I0.0\n= Q0.0\nMEND\n"), "races", "--json")["interrupted"])

    def test_import_capture_that_is_interrupted_while_it_reads_writes_json_and_no_file(self):
        log, imported = self.folder / "long.log", self.folder / "imported.yaml"
        for to in ([], ["-o", imported]):
            said = json.loads(self.interrupted_while_reading("long.log", b"0.000 TX 01 03\n", "import-capture", log, "--json", *to))
            self.assertEqual((said["file"], said["output"], said["scenario"]), (str(log), None, None))
        self.assertFalse(imported.exists())

    def test_a_recording_of_which_no_frame_is_right_fails(self):
        log = self.folder / "wrong.log"
        log.write_text("TX 01 03 00 0a 00 02 e4 00\nRX 01 03 04 12 34 56 78 81 00\n", encoding="utf-8")
        self.assertEqual(self.json(FAILED, "decode", log, "--json")["summary"]["wrong"], 2)
        self.assertIn("wrong frames: 2", self.ends(FAILED, "decode", log).stdout)
        log.write_text("TX 01 03 00 0a 00 02 e4 09\nRX 01 03 04 12 34 56 78 81 00\n", encoding="utf-8")
        self.ends(FINE, "decode", log)

    def test_a_program_is_no_recording(self):
        self.assertIn("it is a program in STL, not a recording", self.ends(UNUSABLE, "decode", SLAVE).stderr)

    def test_the_topic_of_recordings_names_every_form(self):
        said = " ".join(self.ends(FINE, "help", "recordings").stdout.split()) + " ".join(s7200("decode", "--help-all").stdout.split())
        for part in ("a recording (s7200 help recordings);", "the decoder list that DSView exports", "pcap of a serial line, as --capture writes it (link types 147 to 162)", "of Modbus TCP, or of Modbus RTU in TCP", "CSV with a frame or a character in each row",
                     "text logs with a frame or a character in each line", "5 ms without it"):
            self.assertIn(part, said)

    def test_a_simulated_plc_is_run_behind_a_bridge_or_not_at_all(self):
        for arguments, why in ((["westinghouse:pc1200"], "nobody asks westinghouse:pc1200: give it a bridge, such as --pty LINK"),
                               (["westinghouse:pc9", "--tcp", "0"], "no 'pc9' speaks modbus in simulation"),
                               (["westinghouse:pc1200", "--tcp", "0", "--plc", "colour=red"], "--plc: 'colour=red' is not a setting of this PLC"),
                               (["westinghouse:pc1200", "--tcp", "0", "--protocol", "pc1000-lan"], "give --plc sync=ignored"),
                               (["westinghouse:pc1200", "--tcp", "0", "--protocol", "ppi"], "'ppi' is not a protocol; there are modbus, pc1000-lan,"),
                               (["westinghouse:pc1200", "--tcp", "0", "--set", "VW0=1"], "--set needs a PROGRAM to run"),
                               (["westinghouse:pc1200", "--tcp", "0", "--scans", "5"], "--scans needs a PROGRAM to run"),
                               (["westinghouse:pc1200", "--tcp", "0", "--cpu", "226"], "--cpu needs a PROGRAM to run"),
                               (["westinghouse:pc1200", "symbols.txt", "--tcp", "0"], "symbols.txt beside westinghouse:pc1200"),
                               ([SLAVE, "--plc", "slave=02"], "--plc needs westinghouse:MODEL"),
                               ([SLAVE, "--protocol", "modbus"], "--protocol needs westinghouse:MODEL")):
            with self.subTest(arguments):
                self.assertIn(why, self.ends(UNUSABLE, "run", *arguments).stderr)
        result = self.json(FINE, "run", "westinghouse:pc1200", "--tcp", "0", "--for", "50ms", "--json")
        self.assertEqual((result["stop_reason"], result["plcs"], [b["name"] for b in result["bridges"]]), ("time", [], ["bridge"]))

    def test_a_system_without_an_s7200_is_captured_at_its_other_plc_and_set_as_that(self):
        system = self.program("peers:\n"
                              "  pc1200: {westinghouse: modbus, settings: [plc=pc1200, 'HR1=1234']}\n"
                              "  master: {polls: [{read: 40001}], every: 1s}\n"
                              "lines: {field: {stations: [master, pc1200], capture: [field.pcap]}}\n", "system.yaml")
        self.assertIn("master: 1 request, 1 answered", self.ends(FINE, "run", system, "--for", "1500ms").stdout)
        decoded = self.json(FINE, "decode", self.folder / "field.pcap", "--json")
        self.assertEqual([frame["text"] for frame in decoded["frames"]], ["station 1, read holding registers 40001, 1 of them", "1 register: 16#1234"])
        faster = self.program(f"plcs: {{first: {{program: {SLAVE}, station: 9}}}}\n"
                              "peers:\n"
                              "  pc1200: {westinghouse: modbus, settings: [baud=19200, parity=even, 'HR1=1234']}\n"
                              "  master: {polls: [{read: 40001}], every: 1s}\n"
                              "lines: {field: {stations: [first, master, pc1200], baud: 19200, capture: [faster.pcap]}}\n", "faster.yaml")
        self.ends(FINE, "run", faster, "--for", "1500ms")
        decoded = self.json(FINE, "decode", self.folder / "faster.pcap", "--baud", "19200", "--json")
        self.assertEqual([frame["right"] for frame in decoded["frames"]], [True, True], "the line's rate counts, not that of its first PLC")
        for text, why in (("peers: {m: {polls: [{read: 40001}]}}\nlines: {l: {stations: [m], capture: [x.pcap]}}\n", "no PLC is on line 'l'"),
                          ("peers: {p: {westinghouse: pc1000-lan}}\nlines: {l: {stations: [p]}}\n", "settings: [sync=ignored]")):
            self.assertIn(why, self.ends(UNUSABLE, "run", self.program(text, "wrong.yaml")).stderr)

    def test_a_line_with_a_simulated_plc_has_its_faults(self):
        result = self.json(FAILED, "master", "westinghouse:pc1200", "--fault", "flip:character=2,bit=0,exchange=2", "--json",
                           "exception-status", "exception-status", "exception-status")
        self.assertEqual([e["verdict"] for e in result["exchanges"]], ["right", "silent", "right"])
        self.assertEqual([f["count"] for f in result["faults"]], [1])

    def test_a_line_with_a_simulated_plc_is_set_on_both_ends(self):
        self.ends(FINE, "master", "westinghouse:pc1200", "--plc", "baud=19200", "slave-id")
        self.ends(FAILED, "master", "westinghouse:pc1200", "--plc", "baud=19200", "--baud", 9600, "slave-id")

    def test_what_makes_no_sense_for_a_simulated_plc_is_refused(self):
        for arguments, why in ((["westinghouse:pc9", "slave-id"], "no 'pc9' speaks modbus in simulation: pc503,"),
                               (["westinghouse:", "slave-id"], "no '' speaks modbus in simulation"),
                               (["westinghouse:pc1200", "--plc", "slave=0", "slave-id"],
                                "--plc: slave: '0' is not a hexadecimal number from 01 to FF"),
                               (["westinghouse:pc1200", "--plc", "frob=1", "slave-id"], "'frob=1' is not a setting of this PLC; there are slave,"),
                               ([SLAVE, "--plc", "slave=02", "slave-id"], "--plc needs westinghouse:MODEL"),
                               (["westinghouse:pc1200", "--protocol", "freeport-pc", "read", "VB0"],
                                "PLCs of westinghouse:MODEL do not speak freeport-pc; they speak modbus, pc1000-lan, westnet, pc500-loader, hppc"),
                               (["westinghouse:pc1200", "--set", "VW0=1", "slave-id"], "--set needs a PROGRAM to run in simulation"),
                               (["westinghouse:pc1200", "slave-id", "--continuous", "--json"], "without --count never ends")):
            with self.subTest(arguments):
                self.assertIn(why, self.ends(UNUSABLE, "master", *arguments).stderr)

    def test_a_refusal_is_an_exception_in_modbus_alone(self):
        westnet = ["master", "--protocol", "westnet", "westinghouse:pc1200", "--plc", "session=00.22.00", "address", "17"]
        capture = self.folder / "refused.pcap"
        out = self.ends(FAILED, *westnet, "open", "status", "--count", 2, "--capture", capture).stdout
        self.assertIn("\n  error 16#12: PLC in session with another computer\n", out)
        self.assertRegex(out, r"requests: \d+ right, \d+ error, 0 silent")
        self.assertNotIn("exception", out)
        self.assertIn("error 16#12: PLC in session", self.ends(FINE, "decode", capture, "--protocol", "westnet").stdout)
        self.assertIn("\n  error 16#15: refused (NAK)\n", self.ends(FAILED, "master", "--protocol", "pc500-loader", "westinghouse:pc503", "block", "2").stdout)
        self.assertIn("error 16#", self.ends(FAILED, "master", "--protocol", "hppc", "westinghouse:hppc", "read", "16#FFFFF:2").stdout)
        ppi = ["master", "--protocol", "ppi", self.program("LD SM0.0\nMOVW VW0, VW2\nMEND\n"), "--cpu", "224", "--capture", capture]
        self.assertIn("\n  error 16#05: outside the memory of this CPU\n", self.ends(FAILED, *ppi, "read", "VB10000").stdout)
        self.assertIn("VB10000: error 16#05: outside", self.ends(FINE, "decode", capture, "--protocol", "ppi").stdout)
        self.assertIn("\n  exception 2: illegal data address\n", self.ends(FAILED, "master", "westinghouse:pc1200", "read", "49999").stdout)

    def test_the_identification_of_a_cpu_is_read_over_ppi(self):
        capture, trace = self.folder / "ppi.pcap", self.folder / "trace.txt"
        for cpu, said in (("226", "CPU 226, release 02.00"), ("226r1", "CPU 226, release 01.00"), ("214", "CPU 214, release 01.00")):
            out = self.identified(cpu, capture, trace)
            self.assertIn(f"\n  {said}\n", out)
            decoded = self.ends(FINE, "decode", capture, "--protocol", "ppi").stdout
            self.assertIn("read identification", decoded)
            self.assertIn(f"identification = {said}", decoded)
            self.assertIn("PPI station 0 reads the CPU's identification", trace.read_text(encoding="utf-8"))
            capture.unlink()
            trace.unlink()

    def identified(self, cpu, capture, trace):
        return self.ends(FINE, "master", "--protocol", "ppi", self.program("LD SM0.0\nMOVW VW0, VW2\nMEND\n"), "--cpu", cpu, "identification",
                         "--capture", capture, "--trace", trace).stdout

    def test_registers_that_the_parameter_table_of_an_hppc_does_not_have_are_not_there(self):
        ask = ["master", "--protocol", "hppc", "westinghouse:hppc", "read-register"]
        self.ends(FINE, *ask, "2048")
        for wrong in ("2049", "2047:3"):
            out = self.ends(FAILED, *ask, wrong).stdout
            self.assertIn("by the parameter table there are 2048 holding registers", out)
            self.assertNotIn("at attempt", out)

    def test_of_what_only_the_cpu_writes_the_mode_switch_alone_is_set(self):
        self.ends(FINE, "run", SLAVE, "--scans", "2", "--set", "SM0.7=0")
        self.assertIn("--set: SM0.6 cannot be set: only the CPU writes", self.ends(UNUSABLE, "run", SLAVE, "--set", "SM0.6=1").stderr)

    def test_a_westinghouse_slave_is_asked_at_any_of_its_stations(self):
        self.ends(FINE, "master", "westinghouse:pc1200", "--plc", "slave=FF", "--station", "255", "read", "40001")

    def test_no_ppi_master_joins_a_line_where_a_plc_is_one(self):
        netr = self.program("LD SM0.1\nMOVB 2, SMB30\nMOVB 3, VB101\nMOVD &VB200, VD102\nMOVB 4, VB106\nLD SM0.0\nNETR VB100, 0\nMEND\n", "netr.stl")
        idle = self.program("LD SM0.0\nMOVW VW0, VW2\nMEND\n")
        ask, why = ["master", "--protocol", "ppi", "--cpu", "224"], "is a PPI master, too (SMB30 = 16#02): how masters pass the token on is not modelled"
        self.assertIn("port 0 " + why, self.ends(UNUSABLE, *ask, netr, "read", "VW0").stderr)
        self.assertIn(why, self.ends(UNUSABLE, *ask, netr, "--times-band", "2", "read", "VW0").stderr)
        self.assertIn(why, self.json(UNUSABLE, *ask, netr, "read", "VW0", "--json")["error"])
        system = self.program(f"plcs:\n  slave: {{program: {idle}, ppi_station: 3}}\n  asker: {{program: {netr}, cpu: 224}}\n"
                              "lines: {bus: {stations: [slave, asker]}}\n", "ppi.yaml")
        self.assertIn("port 0 of asker " + why, self.ends(UNUSABLE, "master", "--protocol", "ppi", system, "--station", "3", "--after", "1s", "read", "VW0").stderr)

    def test_a_cpu_that_its_program_has_stopped_answers_a_ppi_master_and_no_other(self):
        stops = self.program("LD SM0.0\nINCW VW10\nLDW= VW10, 500\nSTOP\nMEND\n")
        system = self.program(f"plcs: {{a: {{program: {stops}, cpu: 224}}}}\nlines: {{x: {{stations: [a]}}}}\n", "stops.yaml")
        for target in ([stops, "--cpu", "224"], [system, "--at", "x"]):
            done = self.ends(FINE, "master", "--protocol", "ppi", *target, "--after", "2s", "read", "VW10", "run", "wait", "1s", "read", "VW10", "status")
            self.assertRegex(done.stdout, r"(?s)VW10 .* 500\nrun .*  done\n.*VW10 +16#[0-9A-F]{4} +\d{4,}\n.*a slave, ready")
            self.assertIn("the CPU went to STOP before the first request", self.ends(FAILED, "master", *target, "--after", "2s", "read", "40001").stderr)

    def test_in_stop_requests_are_sent_if_somebody_on_the_line_may_answer(self):
        stops = self.program("LD SM0.0\nTON T37, +10\nLD T37\nSTOP\nMEND\n")
        self.assertIn("10 00 02 00 02 16", self.ends(FINE, "send", stops, "--after", "3s", "100200494b16").stdout, "its port speaks PPI")
        system = self.program(f"plcs: {{a: {{program: {stops}}}}}\npeers: {{p: {{westinghouse: modbus, settings: [slave=05, parity=even]}}}}\n"
                              "lines: {l: {stations: [p, a], parity: even, baud: 9600}}\n", "beside.yaml")
        self.ends(FINE, "master", system, "--at", "l", "--after", "2s", "--station", "5", "read", "40001")

    def test_a_master_is_told_of_another_that_has_asked_on_its_line(self):
        for protocol in ("modbus", "lan"):
            gateway = [SOURCE / f"stl_programs/systems/gateway_pc1200_{protocol}.yaml", "--at", "office", "read", "40001:2"]
            self.assertEqual(self.ends(FINE, "master", *gateway).stderr, "")
            done = s7200("master", *gateway, "--every", "300ms", "--count", "8")
            self.assertIn("panel is a master on line office, too: what both ask at the same time collides", done.stderr)

    def test_a_ppi_master_at_the_station_that_it_asks_is_doubted(self):
        ask = ["master", "--protocol", "ppi", self.program("LD SM0.0\nMOVW VW0, VW2\nMEND\n"), "read", "VW0"]
        said = "note: station 2 is the master's own, too, and on a line each station has another: --own-station NUMBER"
        self.assertIn(said, self.ends(FINE, *ask, "--own-station", "2").stderr)
        for fine in (["--own-station", "1"], []):
            self.assertNotIn("own, too", self.ends(FINE, *ask, *fine).stderr)

    def test_what_cannot_be_asked_is_refused_with_what_is_wrong(self):
        ppi, westnet = ["master", "--protocol", "ppi", SLAVE], ["master", "--protocol", "westnet", "westinghouse:pc1200"]
        for arguments, why in (([*ppi, "clock", "frob"], "'frob' is neither an action nor part of clock; write it as: clock"),
                               ([*ppi, "--cpu", "224", "read", "VB99999"], "'VB99999' does not exist on any CPU: V memory has 10240 bytes at most"),
                               ([*westnet, "--station", "9", "local"], "--station: messages of westnet name no station"),
                               ([*westnet, "station", "9", "local"], "'station' is not an action"),
                               (["master", "--protocol", "pc500-loader", "westinghouse:pc503", "--station", "9", "blocks"], "messages of pc500-loader name no station"),
                               (["master", "--protocol", "pc500-loader", "westinghouse:pc2000", "blocks"],
                                "no 'pc2000' speaks pc500-loader in simulation: pc503 does; it speaks modbus"),
                               (["master", SOURCE / "tests/programs/systems/other_plcs.yaml", "read", "40001"],
                                "there are several lines, plant, yard: name one of them (--at NAME)")):
            with self.subTest(arguments):
                self.assertIn(why, self.ends(UNUSABLE, *arguments).stderr)

    def test_what_mbpoll_prints_is_decoded_and_without_its_frames_refused(self):
        log = self.program("Set rtu baudrate=9600\nmbpoll 1.0-0 - FieldTalk(tm) Modbus(R) Master Simulator\n-- Polling slave 1...\n"
                           "[01][03][00][00][00][01][84][0A]\nWaiting for a confirmation...\n<01><03><02><12><34><B5><33>\n[1]: \t4660\n", "mbpoll.log")
        done = self.json(FINE, "decode", log, "--json")
        self.assertEqual((done["form"], [done["summary"][key] for key in ("requests", "answered", "wrong", "strays")]), ("mbpoll", [1, 1, 0, 0]))
        brief = self.program("mbpoll 1.0-0\n-- Polling slave 1...\n[1]: \t4660\n", "brief.log")
        for verb in ("decode", "import-capture"):
            self.assertIn("no frames found; mbpoll prints frames only with its option -v", self.ends(UNUSABLE, verb, brief).stderr)

    def test_a_recording_in_another_protocol_is_named(self):
        log = self.program("10 02 00 49 4B 16\n10 00 02 00 02 16\n10 02 00 5C 5E 16\nE5\n", "ppi.log")
        self.assertIn("it looks like ppi: --protocol ppi", self.ends(FAILED, "decode", log).stderr)
        self.assertEqual(self.ends(FINE, "decode", log, "--protocol", "ppi").stderr, "")

    def test_a_plc_on_the_pc1000_lan_is_read_and_written(self):
        lan = ["master", "--protocol", "pc1000-lan", "westinghouse:pc1200"]
        out = self.ends(FINE, *lan, "--plc", "fault=0204", "unit", "5", "write", "16#4000=16#1234,-1", "read", "16#4000:2", "set", "16#4000.0",
                        "reset", "16#4000.2", "retest", "unit", "erase", "read", "16#4000").stdout.split("\n")
        self.assertEqual(out[1], "  keyswitch in stop, fault mode, fault register 16#0204")
        self.assertEqual(out[3], "  words 16#4000…4001 written")
        self.assertEqual(out[5:7], ["  16#4000  16#1234   4660", "  16#4001  16#FFFF  65535"])
        self.assertEqual([out[8], out[10], out[12]], ["  bit set", "  bit reset", "  retest accepted"])
        self.assertEqual([out[14], out[16], out[18]],
                         ["  keyswitch in stop, fault register 16#0000", "  memory erased", "  16#4000  16#0000      0"])
        result = self.json(FAILED, *lan, "--json", "read", "16#4000", "unit", "6", "unit", "5", "read", "0")
        self.assertEqual([(e["verdict"], e["attempts"]) for e in result["exchanges"]], [("silent", 3), ("silent", 3), ("right", 1), ("right", 1)])
        self.assertEqual([e["station"] for e in result["exchanges"]], [None, 6, 5, None])
        without = [*lan, "--no-sync", "unit", "5"]
        self.ends(FAILED, *without)
        self.ends(FINE, *without, "--plc", "sync=ignored")
        for words, why in ((["read", "16#4000:129"], "129 words; a block has 128 at most"), (["read", "65535:2"], "run past 16#FFFF"),
                           (["write", "5"], "a value is missing"), (["set", "5"], "a bit is missing"), (["set", "5.16"], "bit 16 is not from 0 to 15"),
                           (["unit", "256"], "unit 256 is not from 0 to 255"), (["write", "5=65536"], "value 65536 is not from")):
            self.assertIn(why, self.ends(UNUSABLE, *lan, *words).stderr)

    def test_a_plc_over_westnet_is_addressed_and_taken_in_session(self):
        westnet = ["master", "--protocol", "westnet", "westinghouse:pc1200"]
        out = self.ends(FINE, *westnet, "local", "address", "17", "session", "open", "session", "write", "0=16#1234", "read", "0", "close",
                        "remote", "status").stdout.split("\n")
        self.assertEqual(out[1::2][:6], ["  this computer is at 00.01.00", "  PLC 00.11.00 addressed", "  no session", "  session open",
                                         "  session of 00.01.00", "  word 16#0000 written"])
        self.assertEqual(out[13], "  16#0000  16#1234   4660")
        self.assertEqual(out[15::2][:3], ["  session closed", "  addressed is 00.11.00", "  no error"])
        result = self.json(FAILED, *westnet, "--plc", "session=00.22.00", "--json", "address", "17", "read", "0", "status", "address", "18.1",
                           "open")
        self.assertEqual([e["verdict"] for e in result["exchanges"]], ["right", "exception", "right", "right", "exception"])
        self.assertEqual(result["exchanges"][1]["exception"], {"code": 0x12, "name": "PLC in session with another computer"})
        self.assertEqual(result["exchanges"][4]["exception"], {"code": 2, "name": "invalid drop addressed"})
        for words, why in ((["address", "255"], "drop 255 is not from 1 to 254"), (["address", "1.2"], "subdrop 2 is not from 0 to 1")):
            self.assertIn(why, self.ends(UNUSABLE, *westnet, *words).stderr)

    def test_a_plc_at_its_loader_port_is_read_and_written_in_sessions(self):
        loader = ["master", "--protocol", "pc500-loader", "westinghouse:pc503"]
        out = self.ends(FINE, *loader, "read", "QB0:2", "write", "QB1=16,3", "read", "QB1:2", "block", "1", "blocks", "parameters").stdout
        for line in ("  16#EF80  16#12     18", "  16#EF81  16#34     52", "  bytes 16#EF81…EF82 written", "  16#EF81  16#10     16",
                     "  16#EF82  16#03      3", "  DB001 at 16#8024, 2 data words", "  DB001 at 16#8024", "  PIQ          16#EF80",
                     "  program end  16#CFFF"):
            self.assertIn(line + "\n", out)
        self.assertIn("  DB001 at 16#8024\n", self.ends(FINE, *loader, "--plc", "directory=db1", "--directory", "db1", "blocks").stdout)
        for dle in ([], ["--plc", "dle=plain", "--dle", "plain"]):
            longer = self.ends(FINE, *loader, *dle, "--plc", "tail_bytes=3", "parameters").stdout
            self.assertIn("  program end  16#CFFF\n  more         00 00 00\n", longer, "what it means is not documented")
        plain = self.json(FINE, *loader, "--plc", "dle=plain", "--dle", "plain", "--plc", "M[9000]=10,03", "--json", "read", "16#9000:2")
        self.assertEqual(plain["exchanges"][0]["values"], [0x10, 3])
        refused = self.json(FAILED, *loader, "--json", "block", "2")["exchanges"][0]
        self.assertEqual((refused["exception"], refused["attempts"]), ({"code": 0x15, "name": "refused (NAK)"}, 3))
        self.assertEqual(self.json(FINE, *loader, "--json", "raw", "02")["exchanges"][0]["response"], "1006")
        noisy = self.json(FINE, *loader, "--fault", "parity:character=1,exchange=3", "--json", "read", "QB0")["exchanges"][0]
        self.assertEqual((noisy["attempts"], noisy["values"]), (2, [0x12]))
        for words, why in ((["read", "QB128"], "byte of QB 128 is not from 0 to 127"), (["read", "16#8000:513"], "513 bytes; a session has 512 at most"),
                           (["read", "16#FFFF:2"], "run past 16#FFFF"), (["write", "QB0"], "a value is missing")):
            self.assertIn(why, self.ends(UNUSABLE, *loader, *words).stderr)
        self.assertIn("'x' is not a way to send", self.ends(UNUSABLE, *loader, "--dle", "x", "blocks").stderr)

    def test_an_hppc_at_its_loader_port_has_registers_bytes_and_monitors(self):
        hppc = ["master", "--protocol", "hppc", "westinghouse:hppc"]
        out = self.ends(FINE, *hppc, "write-register", "1=16#1234,5", "read-register", "1:2", "read", "16#ABFFC:4", "bits",
                        "16#ABFFE=16#F000/16#FF00", "monitor", "w:16#ABFFE", "b:16#ABFFC", "resync", "parameters", "0").stdout
        for line in ("  registers 1…2 written", "  R00001  16#1234   4660", "  R00002  16#0005      5", "  16#ABFFC  16#05      5",
                     "  16#ABFFF  16#12     18", "  bits of the word at 16#ABFFE written", "  status 16#00", "  16#ABFFE  16#F034  61492",
                     "  in step", "  parameter table at 16#80000"):
            self.assertIn(line + "\n", out)
        self.assertLess(out.index("  16#ABFFE  16#F034"), out.index("  16#ABFFC  16#05      5", out.index("status 16#00")), "in the order asked")
        example = self.json(FINE, *hppc, "--plc", "table=example", "--plc", "M[ABFFE]=34,12", "--json", "read-register", "1")["exchanges"][0]
        self.assertEqual((example["values"], example["notation"]), ([0x1234], "R00001"))
        wrong = self.json(FAILED, *hppc, "--json", "read", "16#FFFFF:2", "raw", "08 00 20 40 00 30 1f e2")["exchanges"]
        self.assertEqual([e["exception"]["name"] for e in wrong], ["invalid operand", "illegal opcode"])
        self.assertEqual([e["attempts"] for e in wrong], [1, 1])
        self.ends(FINE, *hppc, "--plc", "fcs=polynomial", "--fcs", "polynomial", "read", "16#80002:2")
        self.ends(FAILED, *hppc, "--fcs", "polynomial", "read", "16#80002:2")
        noisy = self.json(FINE, *hppc, "--fault", "flip:character=7,bit=0,exchange=1", "--json", "read", "16#80000:2")["exchanges"][0]
        self.assertEqual((noisy["attempts"], noisy["values"]), (2, [0x8A, 0]))
        for words, why in ((["read", "16#100000"], "is not from 0 to 1048575"), (["monitor", "x:1"], "is not a size with an address"),
                           (["bits", "1=2"], "is not a pattern with its mask"), (["read-register", "0"], "register 0 is not from 1")):
            self.assertIn(why, self.ends(UNUSABLE, *hppc, *words).stderr)
        self.assertIn("'x' is not a frame check", self.ends(UNUSABLE, *hppc, "--fcs", "x", "resync").stderr)

    def test_an_hppc_of_another_layout_is_understood_by_master_and_decode(self):
        heard = self.folder / "hppc.pcap"
        layout = ["--bit-write", "mask_first", "--monitor-address-bytes", "4", "--read-request", "number"]
        out = self.ends(FINE, "master", "--protocol", "hppc", "westinghouse:hppc", *layout, "--plc", "bit_write=mask_first", "--plc", "read_request=number",
                        "--plc", "monitor_address_bytes=4", "--plc", "M[00000]=12,34", "--capture", heard, "read", "0:2", "bits",
                        "16#ABFFE=16#F000/16#FF00", "monitor", "w:16#ABFFE").stdout
        for line in ("  16#00001  16#34     52", "  bits of the word at 16#ABFFE written", "  16#ABFFE  16#F000  61440"):
            self.assertIn(line + "\n", out)
        texts = [frame["text"] for frame in self.json(FINE, "decode", heard, "--protocol", "hppc", *layout, "--json")["frames"]]
        for text in ("read 2 bytes from 16#00000 on", "write bits of the word at 16#ABFFE: 16#F000, those of the mask 16#FF00",
                     "status 16#00, 16#ABFFE is 16#F000"):
            self.assertIn(text, texts)
        self.assertIn("not with --read-request number", self.ends(UNUSABLE, "master", "--protocol", "hppc", "westinghouse:hppc", *layout,
                                                                  "read", "16#80000").stderr)

    def test_a_cpu_212_has_no_clock_to_set(self):
        idle = self.program("LD SM0.0\nINCW VW0\nMEND\n")
        self.assertIn("CPU 212 has no time-of-day clock", self.ends(UNUSABLE, "run", idle, "--cpu", "212", "--clock", "2026-11-21 10:00:00").stderr)
        self.assertIn("function not available", self.ends(FAILED, "master", "--protocol", "ppi", idle, "--cpu", "212", "clock").stdout)
        scenario = self.program(f"program: {idle}\ncpu: 212\nclock: 2026-11-21 10:00:00\nsteps: [wait: 1ms]\n", "clock.yaml")
        self.assertIn("CPU 212 has no time-of-day clock", self.ends(UNUSABLE, "test", scenario).stderr)

    def test_a_key_of_a_plc_is_an_option_and_a_key_of_systems_and_scenarios(self):
        counts = self.program("LD SM0.0\nTON T37, 32767\nMEND\n")
        timed = ["run", counts, "--for", "200s", "--dump", "T37", "--json"]
        usual = self.json(FINE, *timed)["dump"]["T37"]["values"][0]
        fast = self.json(FINE, *timed, "--clock-error", "1000ppm")["dump"]["T37"]["values"][0]
        self.assertEqual(fast - usual, 2, "0.2 s in 200 s")
        system = self.program(f"plcs: {{a: {{program: {counts}, clock_error: 1000ppm, dump: [T37]}}}}\nlines: {{l: {{stations: [a]}}}}\n", "fast.yaml")
        self.assertEqual(self.json(FINE, "run", system, "--for", "200s", "--json")["plcs"][0]["dump"]["T37"]["values"][0], fast)
        scenario = self.program(f"program: {counts}\nclock_error: 1000ppm\nsteps: [wait: 199950ms, memory: {{T37: {fast}}}]\n", "fast_scenario.yaml")
        record = self.folder / "fast_record.yaml"
        self.ends(FINE, "test", scenario, "--record", record)
        self.assertIn("\n    clock_error: 1000ppm\n", record.read_text(encoding="utf-8"))
        self.assertIn("'1' is not from -1000ppm to 1000ppm", self.ends(UNUSABLE, *timed, "--clock-error", "1").stderr)

    def test_a_port_that_does_not_speak_ppi_any_more_is_named_after_the_session(self):
        idle = self.program("LD SM0.0\nINCW VW0\nMEND\n")
        ppi = ["master", "--protocol", "ppi", idle, "--timeout", "50ms"]
        note = "port 0 is in Freeport mode: it does not speak PPI there"
        self.assertIn(note, self.ends(FAILED, *ppi, "write", "SMB30=9", "read", "VB0").stderr)
        self.assertIn(note, self.ends(FAILED, *ppi, "--set", "SMB30=9", "read", "VB0").stderr)
        self.assertNotIn(note, self.ends(FINE, *ppi, "read", "VB0").stderr)

    def test_a_finding_of_a_system_names_its_plc_once(self):
        scenario = self.program(f"system: {SOURCE}/stl_programs/systems/gateway.yaml\nsteps:\n  - {{memory: {{VW0: 1}}, on: pump}}\n", "finding.yaml")
        self.assertIn("VW0 of pump is 4660, expected 1", self.ends(FAILED, "test", scenario).stdout)

    def test_strict_ends_at_the_first_run_time_error(self):
        wrong = self.program("LD SM0.0\nINCW VW0\nMOVD 0, *VD100\nINCW VW2\nMEND\n")
        preset = ["--set", "VD100=16#7F000000"]
        self.assertEqual(self.json(FINE, "run", wrong, *preset, "--scans", "3", "--json")["errors"][0]["count"], 3)
        for real_time in ([], ["--realtime"]):
            done = self.ends(FAILED, "run", wrong, *preset, "--strict", "--json", "--dump", "VW0", "--dump", "VW2", *real_time)
            result = json.loads(done.stdout)
            self.assertEqual((result["stop_reason"], result["errors"][0]["count"]), ("run-time error", 1))
            self.assertEqual([result["dump"][word]["values"] for word in ("VW0", "VW2")], [[1], [0]])
            self.assertIn("--strict", done.stderr)
        self.assertEqual(self.json(FINE, "run", SLAVE, "--strict", "--json")["stop_reason"], "time")
        fatal = self.program("LD SM0.0\nLDB= *VD100, 1\nMEND\n", "fatal.stl")
        self.assertEqual(self.json(FATAL, "run", fatal, *preset, "--strict", "--json")["stop_reason"], "fatal")

    def test_strict_ends_the_exchanges(self):
        echo = self.program(Json.ECHO.replace("XMT VB0, 0", "XMT VB0, 0\nMOVD 0, *VD100"))
        preset = ["--set", "VD100=16#7F000000", "--json"]
        self.assertEqual(len(self.json(FINE, "send", echo, "ab", "cd", *preset)["exchanges"]), 2)
        self.assertEqual(len(self.json(FAILED, "send", echo, "ab", "cd", *preset, "--strict")["exchanges"]), 1)
        master = ["master", echo, "raw", "abcd", "raw", "abcd", "--count", "3", *preset, "--strict"]
        self.assertEqual(len(self.json(FAILED, *master)["exchanges"]), 1)

    def test_port_1_of_a_cpu_with_two(self):
        text = Json.ECHO.replace("XMT VB0, 0", "XMT VB0, 1").replace("SMB30", "SMB130").replace("ATCH 0, 8", "ATCH 0, 25")
        echo = self.program(text)
        on_port_1 = [echo, "--cpu", "226", "--port", "1"]
        self.assertEqual(self.json(FINE, "send", *on_port_1, "ab", "--json")["exchanges"][0]["response"], "ab")
        self.assertRegex(self.ends(FINE, "send", *on_port_1, "ab", "--timeline").stdout, "port 1 received  ab")
        self.assertIn("answer   none", self.ends(FAILED, "send", echo, "--cpu", "226", "ab").stdout)
        for cpu, port in (("214", "1"), ("224", "1")):
            done = self.ends(UNUSABLE, "send", SLAVE, "--cpu", cpu, "--port", port, "ab")
            self.assertIn(f"CPU {cpu} has no port {port}", done.stderr)

    def test_wrong_usage(self):
        for arguments in ([], ["frobnicate"], ["--frobnicate"], ["check"], ["run"], ["send"], ["import"],
                          ["run", SLAVE, "--frob"],
                          ["run", SLAVE, "--for", "5"], ["run", SLAVE, "--for", "-1s"], ["run", SLAVE, "--scans", "0"],
                          ["run", SLAVE, "--scans", "x"],
                          ["run", SLAVE, "--cpu", "999"], ["run", SLAVE, "--set", "VW100"],
                          ["run", SLAVE, "--set", "VB0=256"], ["run", SLAVE, "--set", "VB9999=1"], ["run", SLAVE, "--dump", "VB4090:10"],
                          ["run", SLAVE, "--dump", "X"],
                          ["run", SLAVE, "--trace-instructions"], ["run", SLAVE, "--times", "missing.csv"],
                          ["run", SLAVE, "--times", SLAVE], ["run", "missing.stl"], ["run", str(SOURCE)], ["send", SLAVE],
                          ["send", SLAVE, "0"], ["send", SLAVE, "xy"], ["send", SLAVE, "01", "--baud", "1"],
                          ["send", SLAVE, "01", "--parity", "mark"], ["send", SLAVE, "01", "--data-bits", "9"],
                          ["send", SLAVE, "--text", "\\q"], ["send", SLAVE, "--text", ""], ["send", SLAVE, "--text", "f\u00fcnf"],
                          ["send", SLAVE, "--text"], ["send", SLAVE, "--frames", "missing.txt"], ["instructions", "FROB"], ["times", "--csv", "--json"],
                          ["import", "missing.txt"], ["master"], ["master", SLAVE], ["master", SLAVE, "frob"],
                          ["master", SLAVE, "read"], ["master", SLAVE, "read", "40000"], ["master", SLAVE, "read", "20001"],
                          ["master", SLAVE, "read", "17"], ["master", SLAVE, "read", "40001:126"],
                          ["master", SLAVE, "read", "40001:0"], ["master", SLAVE, "read", "40001", "--station", "0"],
                          ["master", SLAVE, "read", "40001", "station", "248"], ["master", SLAVE, "write", "40001"],
                          ["master", SLAVE, "write", "10001=1"], ["master", SLAVE, "write", "30001=1"],
                          ["master", SLAVE, "write", "40001=65536"], ["master", SLAVE, "write", "00001=2"],
                          ["master", SLAVE, "raw", "0x"], ["master", SLAVE, "slave-id", "1"], ["master", SLAVE, "wait", "1"],
                          ["master", SLAVE, "slave-id", "--as", "frob"], ["master", SLAVE, "slave-id", "--continuous", "--every", "1s"],
                          ["master", "tcp://host", "slave-id"], ["master", "udp://host:1", "slave-id"]):
            with self.subTest(arguments):
                done = self.ends(UNUSABLE, *arguments)
                self.assertEqual(done.stdout, "")
                self.assertGreater(len(done.stderr), 10)

    def test_wrong_faults_are_refused_at_their_place(self):
        for spec, column, message, caret in (
                ("flop:bit=1", 1, "there is no fault 'flop'; there are noise, flip, ", "^~~~"),
                ("flip:character=3,bit=8", 22, "bit: '8' is not a bit: 0 (sent first) to 7, start, parity or stop", "^"),
                ("flip:bit=0…7", 10, "bit: '0…7' is not a bit", "^~~"),
                ("gap", 1, "gap needs length=VALUE (time, bits), for example gap:character=4,length=10ms", "^~~"),
                (":bit=1", 1, "a fault is missing here", "^")):
            for verb in (["run", SLAVE], ["send", SLAVE, "01"]):
                with self.subTest(spec):
                    done = self.ends(UNUSABLE, *verb, "--fault", "echo", "--fault", spec)
                    self.assertEqual(done.stdout, "")
                    self.assertIn(f"s7200: error: --fault, column {column}: {message}", done.stderr)
                    self.assertIn(f"\n  {spec}\n  {' ' * (column - 1)}{caret}\n", done.stderr)

    def test_a_slave_that_misbehaves_in_whole_frames(self):
        ask = ["send", SLAVE, "--crc", "--set", "VW20=16#1234", "0103000a0001", "0103000b0002"]
        answers = lambda *faults: re.findall(r"^answer   ([0-9a-f ]+?|none)(?:   after (.*) ms| within .*)?$", s7200(*ask, *(word for fault in faults for word in ("--fault", fault))).stdout, re.M)
        whole = lambda text: framed(bytes.fromhex(text)).hex(" ")
        plain = answers()
        self.assertEqual([frame for frame, _ in plain], [whole("0103021234"), whole("01030400000000")])
        for fault, first, second in (("answer:exception=6", "018306", "018306"), ("answer:station=7", "0703021234", "07030400000000"),
                                     ("answer:function=4", "0104021234", "01040400000000"), ("answer:short", "010302", "0103040000"),
                                     ("answer:stale", "0103021234", "0103021234"), ("answer:exception=4,every=2", "0103021234", "018304")):
            with self.subTest(fault):
                self.assertEqual([frame for frame, _ in answers(fault)], [whole(first), whole(second)])
        self.assertEqual([frame for frame, _ in answers("answer:silent,exchange=1")], ["none", whole("01030400000000")])
        late = answers("answer:delay=300ms,exchange=1")
        self.assertAlmostEqual(float(late[0][1]) - float(plain[0][1]), 300, places=2)
        self.assertEqual(answers("answer:delay=300ms,exchange=1", "answer:exception=6,exchange=1")[0], (whole("018306"), late[0][1]))
        self.assertEqual([frame for frame, _ in answers("answer:twice,exchange=1")][1], whole("01030400000000"))
        again = s7200(*ask, "--fault", "answer:twice")  # that of the last request comes when nobody asks anymore
        self.assertEqual(re.findall(r"^unasked  ([0-9a-f ]+)$", again.stdout, re.M), [whole("0103021234"), whole("01030400000000")])
        self.assertEqual(self.json(FINE, *ask, "--fault", "answer:twice", "--json")["unasked"], framed(bytes.fromhex("01030400000000")).hex())

    def test_help_lists_every_fault(self):
        table = (SOURCE / "serial_sim/faults/README.md").read_text(encoding="utf-8").split("| fault |")[1].split("\n\n")[0]
        kinds = re.findall(r"(?m)^\| `(\w+)`", table)
        self.assertGreater(len(kinds), 10)
        listed = s7200("help", "faults").stdout
        for kind in kinds:
            self.assertRegex(listed, rf"(?m)^  {kind}\b")
        for verb in ("run", "send", "master", "debug"):
            self.assertIn("s7200 help faults", s7200(verb, "--help").stdout)

    def test_messages_go_to_standard_error(self):
        wrong = self.program("LD SM0.0\nFROB\nMEND\n")
        for verb in (["run", wrong], ["send", wrong, "01"]):
            done = self.ends(FAILED, *verb)
            self.assertEqual(done.stdout, "")
            self.assertIn(f"{wrong}:2:1: error: unknown instruction 'FROB'\nFROB\n^~~~\n", done.stderr)

    def test_exit_codes_of_what_the_program_does(self):
        self.ends(FINE, "run", self.program("LD SM0.0\nMEND\n"), "--scans", "2")
        self.ends(FATAL, "run", self.program("LD SM0.0\nLBL 1\nJMP 1\nMEND\n"))
        self.ends(FAILED, "send", self.program("LD SM0.0\nMEND\n"), "01", "--timeout", "10ms")

    def test_scans_end_a_run_and_so_does_the_time_given_with_them(self):
        slow = self.program("LD SM0.0\nMEND\n")
        for arguments, reason, scans in ((["--scans", "3"], "scans", 3), (["--scans", "3", "--for", "1s"], "scans", 3),
                                         (["--scans", "1000000", "--for", "50ms"], "time", None)):
            result = self.json(FINE, "run", slow, *arguments, "--json")
            self.assertEqual(result["stop_reason"], reason)
            self.assertTrue(scans is None and result["time_ns"] >= 50_000_000 or result["scans"] == scans, result)

    def test_a_scan_that_never_ends_ends_the_run(self):
        endless = self.program("LD SM0.0\nLBL 1\nWDR\nJMP 1\nMEND\n")
        done = self.ends(FAILED, "run", endless, "--scans", "2", "--json")
        result = json.loads(done.stdout)
        self.assertEqual((result["stop_reason"], result["scans"]), ("endless scan", 0))
        self.assertIn("error: scan 1 has lasted 10 s and is not over", done.stderr)
        self.assertEqual(self.json(FINE, "run", endless, "--scans", "2", "--for", "1s", "--json")["stop_reason"], "time")

    def test_long_scans_are_no_endless_ones(self):
        """Each of 2 s, kept alive by WDR."""
        long_scan = self.program("LD SM0.0\nFOR VW0, 1, 12000\nWDR\nNEXT\nMEND\n")
        result = self.json(FINE, "run", long_scan, "--scans", "12", "--json")
        self.assertEqual((result["stop_reason"], result["scans"]), ("scans", 12))
        self.assertGreater(result["time_ns"], 10_000_000_000)

    WARNED = "LD I0.0\n= Q0.0\nLD I0.1\n= Q0.0\nLBL 1\nMEND\n"

    def test_help_lists_every_warning_and_each_can_be_switched_off(self):
        listed = self.ends(FINE, "help", "warnings").stdout.split("\n", 1)[1]
        names = re.findall(r"(?m)^  ([a-z-]+)  +[a-zA-Z]", listed)
        self.assertGreater(len(names), 10)
        self.ends(FINE, "check", SLAVE, *(f"--no-warn={name}" for name in names))
        path = self.program(self.WARNED)
        for arguments, left in (([], ["double-coil", "unused-label"]), (["--no-warn", "double-coil"], ["unused-label"]),
                                (["--no-warn", "unused-label", "--no-warn", "double-coil"], []), (["--no-warnings"], [])):
            done = self.ends(FINE, "check", *arguments, path)
            self.assertEqual(re.findall(r"(?m)warning: .* \[(.*)\]$", done.stderr), left)
            self.assertIn(f"fine, 6 instructions for CPU 214{f', {len(left)} warning' if left else ''}", done.stdout)
            (result,) = self.json(FINE, "check", *arguments, path, "--json")["files"]
            self.assertEqual([d["name"] for d in result["diagnostics"]], left)
        self.assertIn("there is no warning 'frob'", self.ends(UNUSABLE, "check", path, "--no-warn", "frob").stderr)

    def test_only_check_warns(self):
        self.assertEqual(self.ends(FINE, "run", self.program(self.WARNED), "--scans", "1").stderr, "")

    def test_check_and_run_say_how_a_text_from_elsewhere_was_read(self):
        path = self.program("1  LD\u00A0\u00A0SM0.0\n2  MOVB 16＃2A， VB0\n")
        note = f"note: {path}: read as plain text: no-break and other Unicode blanks, full-width signs, line numbers; the first in line 1\n"
        done = self.ends(FINE, "check", "--cpu", "224", path)
        self.assertIn("fine, 3 instructions for CPU 224", done.stdout)
        self.assertEqual(done.stderr.count(note), 1)
        (result,) = self.json(FINE, "check", "--cpu", "224", path, "--json")["files"]
        self.assertEqual(f"note: {result['notes'][0]}\n", note)
        self.assertIn(note, self.ends(FINE, "run", path, "--cpu", "224", "--scans", "1").stderr)

    def test_a_listing_for_a_cpu_22x_runs_without_ends_and_with_default_names(self):
        path = self.program("MAIN\nNetwork 1\nLD SM0.1\nMOVB 50, SMB34\nATCH INT_0, 10\nCALL SBR_0\nENI\n"
                            "SBR_0\nNetwork 1\nLD SM0.0\nMOVW 7, VW2\nINT_0\nNetwork 1\nLD SM0.0\nINCW VW0\n")
        done = self.ends(FINE, "run", path, "--cpu", "224", "--for", "1s", "--dump", "VW0:2")
        self.assertRegex(done.stdout, r"(?m)^VW0 +16#001[34] +(19|20)$")
        self.assertRegex(done.stdout, r"(?m)^VW2 +16#0007 +7$")
        self.assertIn("the main program has no MEND", self.ends(FAILED, "check", "--cpu", "214", path).stderr)

    def test_a_cause_is_said_once_with_how_often_and_where_else(self):
        path = self.program("LD SM0.0\n" + "".join(f"MOVB 1, VB{n}\nCALL {n % 64}\n" for n in range(1024, 1124)) + "MEND\n" +
                            "".join(f"SBR {n}\nRET\n" for n in range(64)))
        done = self.ends(FAILED, "check", "--cpu", "212", path)
        self.assertEqual(len(re.findall(": error: ", done.stderr)), 2)
        self.assertIn(f"{path}:2:9: error: VB1024 does not exist on CPU 212\nMOVB 1, VB1024\n        ^~~~~~\n"
                      "hint: V memory is VB0 to VB1023\nalso: 99 more, in lines 4, 6, 8, 10, 12, 14, 16, 18, 20 … 200\n",
                      done.stderr)
        self.assertRegex(done.stdout, r"errors with 2 causes, \d+ warnings for CPU 212; fine for CPU 214, 215, 216 or 22x\n$")
        (result,) = self.json(FAILED, "check", "--cpu", "212", path, "--json")["files"]
        errors = [d for d in result["diagnostics"] if d["severity"] == "error"]
        self.assertEqual(len({d["cause"] for d in errors}), 2)
        self.assertGreater(len(errors), 200, "machines are given each place")

    def test_no_colour_away_from_a_terminal(self):
        wrong = self.program("FROB\n")
        for environment in ({}, {"NO_COLOR": "1"}):
            done = s7200("check", wrong, env={**os.environ, **environment})
            self.assertNotIn("\x1b", done.stdout + done.stderr)

    def test_colour_on_a_terminal(self):
        wrong = self.program("FROB\n")
        for environment, coloured in (({"NO_COLOR": ""}, True), ({"NO_COLOR": "1"}, False)):
            try:
                primary, secondary = os.openpty()
            except OSError as error:
                self.skipTest(f"no terminal can be opened here: {error}")
            done = s7200("check", wrong, capture_output=False, stdout=subprocess.DEVNULL, stderr=secondary,
                         env={**os.environ, **environment})
            os.close(secondary)
            written = os.read(primary, 10_000)
            os.close(primary)
            self.assertEqual(done.returncode, FAILED)
            self.assertEqual(b"\x1b" in written, coloured)


class Options(Case):
    """Every option of every verb, from the lists that --help prints: each number and each text with a form has its range, and
    what is not in it ends with exit code 2 and a message that names the option."""
    NONSENSE = ("nan", "-nan", "inf", "-1", "1e999", "0x10", "1_000", "5,0", "99999999999999999999999", "-")
    ANY_TEXT = ("TABLE", "DIR", "FILE", "FILE.stl", "FILE.html", "LINK", "DEVICE", "TARGET", "PATTERN", "DESCRIPTION", "COMMANDS", "TEXT")  # by their type in the help
    BEGINNING = {"check": [SLAVE], "inspect": [SLAVE, "xref"], "why": [SLAVE, "Q0.0"], "compare": [SLAVE, SLAVE], "fuzz": [SLAVE, "--runs", "1"], "import": [SLAVE], "convert": [SLAVE, "--to", "iec"], "run": [SLAVE], "send": [SLAVE, "01"], "test": ["missing.yaml"],
                 "master": [SLAVE, "slave-id"], "decode": [LOG], "import-capture": [LOG], "debug": [SLAVE, "-x", "quit"], "view": [SLAVE], "dap": [SLAVE], "instructions": [], "times": [], "calibrate": [MEASURE], "bench": []}

    @staticmethod
    def listed(verb):
        """[(option, type, help)] of those that take a value."""
        options = re.findall(r"(?m)^  (?:-\w,)?(--[\w-]+)(?: (\S+))?(.*(?:\n {30}.*)*)", s7200(verb, "--help-all").stdout)
        return [(name, kind, " ".join(text.split())) for name, kind, text in options if kind]

    def refused(self, verb, option, value):
        with self.subTest(f"{verb} {option} '{value}'"):
            done = self.ends(UNUSABLE, verb, *self.BEGINNING[verb], option, value)
            self.assertEqual(done.stdout, "")
            self.assertRegex(done.stderr, rf"(?m)^s7200: error: {option}\b")

    def test_the_lists_are_read(self):
        kinds = {verb: {name: kind for name, kind, _ in self.listed(verb)} for verb in VERBS}
        self.assertEqual((kinds["run"]["--scans"], kinds["run"]["--speed"], kinds["run"]["--for"]), ("N", "N", "TIME"))
        self.assertEqual((kinds["send"]["--baud"], kinds["send"]["--dump"]), ("N", "ADDRESS[:COUNT]"))
        self.assertEqual((kinds["master"]["--cpu"], kinds["master"]["--trace"]), ("TYPE", "FILE"))
        self.assertNotIn("--json", kinds["run"])
        self.assertGreater(sum(map(len, kinds.values())), 100)

    def test_nonsense_is_refused_by_name(self):
        """The first verb that has an option is given all of it. Other verbs take the option from the same row of the table of
        keys, and are given one value each."""
        asked = set()
        for verb in VERBS:
            for option, kind, text in self.listed(verb):
                if kind not in self.ANY_TEXT:
                    row = option, kind, text
                    for value in self.NONSENSE if row not in asked else self.NONSENSE[:1]:
                        self.refused(verb, option, value)
                    asked.add(row)

    def test_no_option_takes_an_empty_value(self):
        for verb in VERBS:
            for option, _, _ in self.listed(verb):
                self.refused(verb, option, "")

    def test_numbers_end_where_the_help_says(self):
        count = 0
        for verb in VERBS:
            for option, kind, text in self.listed(verb):
                if kind != "N":
                    continue
                given = re.search(r"\(([\d.]+) (?:to|or) ([\d.]+|more)\)", text)
                self.assertIsNotNone(given, f"the range of {verb} {option}")
                least, most = given.groups()
                wrong = [float(least) / 2] if "." in least else [int(least) - 1]
                wrong.append(2**64 if most == "more" else int(most) + 1)
                for value in wrong:
                    self.refused(verb, option, value)
                count += 1
        self.assertGreater(count, 20)

    def test_durations_end_at_10000_hours(self):
        for verb in VERBS:
            for option, kind, _ in self.listed(verb):
                if kind == "TIME":
                    for value in ("10001h", "-1s", "1", "nans", "1e3s", "0x1s", "99999999999999999999h", "1 s s"):
                        self.refused(verb, option, value)
        self.refused("bench", "--each", "0s")
        self.refused("master", "--every", "0s")

    def test_addresses_values_counts_and_ports_have_their_ranges(self):
        for value in ("VW0=nan", "VW0=-32769", "VW0=65536", "VB0=99999999999999999999999", "VD0=1e999", "VW0=", "VW0=1=1",
                      "VB5000=1", "M0.8=1", "VD0:real=nan", "VW0:real=1"):
            self.refused("run", "--set", value)
        for value in ("VB0:-1", "VB0:0", "VB0:99999999999999999999", "VB0:4097", "VB0:nan", "VW0:real", "VD0:real:0", "M0.0:2"):
            self.refused("run", "--dump", value)
        for bridge in ("--tcp", "--rtu-over-tcp", "--modbus-tcp"):
            for value in ("65536", "127.0.0.1:99999", "plant:502", "::1:502", "127.0.0.1:", "1.2.3.400:1"):
                self.refused("run", bridge, value)
        for value in ("2026-02-30 10:00:00", "1989-12-31 10:00:00", "2026-01-01 24:00:00", "now"):
            self.refused("run", "--clock", value)

    def test_parameters_of_faults_have_their_ranges(self):
        examples = re.findall(r"(?m)^  (\w+:\w+=\S+) ", s7200("help", "faults").stdout)
        self.assertGreater(len(examples), 10)
        for spec in ("break:from=10001h", "noise:ber=1e-4,for=10001h", "gap:length=2h", "flip:character=1000001"):
            self.refused("run", "--fault", spec)
        extra = ["flip:probability=1", "flip:exchange=1", "flip:every=1", "flip:seed=1", "noise:ber=1e-4,from=1s,for=1s"]
        for example in examples + extra:
            for place in re.finditer(r"=([^,]+)", example):
                for value in ("nan", "-1", "1e999", "99999999999999999999999", ""):
                    self.refused("run", "--fault", example[:place.start(1)] + value + example[place.end(1):])

    def test_numbers_in_actions_of_the_master_have_their_ranges(self):
        for action in ("read 40001:{}", "read {}", "read holding {}", "write 40001={}", "write 00001={}", "loopback {}",
                       "diagnostics {}", "read-file {}:1:1", "read-file 1:{}:1", "read-file 1:1:{}", "write-file 1:1={}",
                       "general-read 1:1:{}", "function {}", "function 3 {}", "raw {}", "station {}", "wait {}"):
            for value in ("nan", "1e999", "99999999999999999999999", ""):
                with self.subTest(action.format(value)):
                    done = self.ends(UNUSABLE, "master", SLAVE, *[word.format(value) for word in action.split()])
                    self.assertTrue(done.stderr.startswith("s7200: error: "), done.stderr)


class Json(Case):
    def test_check(self):
        good, wrong = self.program("LD SM0.0\nMEND\n"), self.program("LD VB0\nMEND\n", "wrong.stl")
        fine, failed = self.json(FAILED, "check", "--json", good, wrong)["files"]
        for result in (fine, failed):
            self.assertEqual(list(result), ["file", "ok", "cpu", "fine_for", "kind", "encoding", "instructions",
                                            "left_out", "notes", "stand_ins", "diagnostics"])
        self.assertEqual((fine["ok"], fine["instructions"], fine["diagnostics"]), (True, 2, []))
        self.assertEqual((failed["ok"], failed["instructions"]), (False, 0))
        first = failed["diagnostics"][0]
        self.assertEqual(list(first), ["severity", "line", "column", "length", "message", "hint", "name", "cause"])
        self.assertEqual((first["severity"], first["line"], first["column"], first["length"]), ("error", 1, 4, 3))

    def test_run(self):
        path = self.program("LD SM0.0\nMOVW 16#1234, VW2\nMOVD 0, *VD100\nMEND\n")
        result = self.json(FINE, "run", path, "--scans", "3", "--set", "VD100=16#7F000000", "--dump", "VB0:4",
                           "--dump", "VW2", "--dump", "V2.1", "--json")
        self.assertEqual(list(result), ["s7200", "stop_reason", "time_ns", "scans", "shortest_scan_ns", "longest_scan_ns", "instructions", "mode", "errors",
                                        "errors_not_listed", "faults", "dump"])
        self.assertEqual((result["stop_reason"], result["scans"]), ("scans", 3))
        self.assertEqual((result["instructions"], result["mode"]), (12, "RUN"))
        self.assertEqual(result["dump"], {"VB0:4": {"type": "byte", "hex": "00001234", "values": [0, 0, 0x12, 0x34]},
                                          "VW2": {"type": "word", "hex": "1234", "values": [0x1234]},
                                          "V2.1": {"type": "bit", "hex": "01", "values": [1]}})
        several = self.json(FINE, "run", path, "--scans", "3", "--set", "VD100=16#7F000000,VW8=5", "--dump", "VB0:4,VW8", "--json")
        self.assertEqual({name: each["values"] for name, each in several["dump"].items()},
                         {"VB0:4": [0, 0, 0x12, 0x34], "VW8": [5]})
        error = result["errors"][0]
        self.assertEqual((error["code"], error["fatal"], error["line"], error["count"]), ("0006", False, 3, 3))
        self.assertEqual(self.json(FINE, "run", path, "--for", "7ms", "--json")["stop_reason"], "time")

    def test_run_to_stop(self):
        stopped = self.json(FINE, "run", self.program("LD SM0.0\nSTOP\nMEND\n"), "--json")
        self.assertEqual((stopped["stop_reason"], stopped["mode"]), ("stop", "STOP"))
        fatal = self.json(FATAL, "run", self.program("LD SM0.0\nLBL 1\nJMP 1\nMEND\n"), "--json")
        self.assertEqual((fatal["stop_reason"], fatal["errors"][-1]["code"]), ("fatal", "0003"))
        self.assertAlmostEqual(fatal["time_ns"], 300e6, delta=1e6)

    ECHO = ("LD SM0.1\nMOVB 16#09, SMB30\nMOVB 1, VB0\nATCH 0, 8\nENI\nMEND\n"
            "INT 0\nLD SM0.0\nMOVB SMB2, VB1\nXMT VB0, 0\nRETI\n")

    def test_send(self):
        path = self.program(self.ECHO)
        result = self.json(FINE, "send", path, "AB", " cd ", "--json", "--dump", "VB1")
        self.assertEqual(list(result), ["s7200", "exchanges", "mode", "errors", "errors_not_listed", "faults", "dump"])
        self.assertEqual((result["mode"], result["dump"]["VB1"]["values"]), ("RUN", [0xCD]))
        first, second = result["exchanges"]
        for exchange, character in ((first, "ab"), (second, "cd")):
            self.assertEqual(list(exchange), ["request", "response", "latency_us"])
            self.assertEqual((exchange["request"], exchange["response"]), (character, character))
            self.assertTrue(0 < exchange["latency_us"] < 2000)
        silent = self.json(FAILED, "send", self.program("LD SM0.0\nMEND\n"), "0102", "--crc", "--timeout", "10ms", "--json")
        self.assertEqual(silent["exchanges"], [{"request": "010281e1", "response": None, "latency_us": None}])

    def test_send_timeline(self):
        (exchange,) = self.json(FINE, "send", self.program(self.ECHO), "ab", "--timeline", "--json")["exchanges"]
        received, transmit, sent = exchange["timeline"]
        self.assertEqual((received["kind"], received["characters"]), ("received", "ab"))
        self.assertEqual((received["routine"], received["served"]), (0, 1))
        self.assertEqual((transmit["kind"], transmit["place"], transmit["why"]), ("transmit", "INT 0", "line 10: XMT     VB0, 0"))
        self.assertEqual((sent["kind"], sent["characters"]), ("sent", "ab"))
        self.assertTrue(received["at_us"] < transmit["at_us"] < sent["at_us"])

    def test_master(self):
        result = self.json(FAILED, "master", SLAVE, "write", "40011=-5", "read", "40011", "10001:2", "slave-id", "--as", "signed",
                           "--dump", "VW20", "--json")
        self.assertEqual(list(result), ["s7200", "target", "exchanges", "statistics", "mode", "errors", "errors_not_listed",
                                        "faults", "dump", "error"])
        self.assertEqual((result["target"], result["error"]), (SLAVE, None))
        self.assertEqual(result["dump"], {"VW20": {"type": "word", "hex": "fffb", "values": [-5]}})
        write, read, inputs, refused = result["exchanges"]
        for exchange in result["exchanges"]:
            self.assertEqual(list(exchange), ["action", "at_us", "station", "function", "area", "first", "notation", "count",
                                              "request", "response", "latency_us", "attempts", "verdict", "fault", "exception",
                                              "values", "decoded", "bytes", "remark"])
        self.assertEqual((write["action"], write["function"], write["first"], write["count"], write["values"]),
                         ("write 40011=-5", 6, 10, 1, None))
        self.assertEqual((read["area"], read["notation"], read["values"], read["decoded"]), ("holding", "40011", [65531], [-5]))
        self.assertEqual((inputs["area"], inputs["notation"], inputs["values"]), ("inputs", "10001", [0, 0]))
        self.assertEqual((refused["verdict"], refused["exception"]), ("exception", {"code": 1, "name": "illegal function"}))
        self.assertEqual({k: v for k, v in result["statistics"].items() if k != "latency_us"},
                         {"requests": 4, "right": 3, "exception": 1, "silent": 0, "wrong": 0, "repeated": 0})
        self.assertEqual(list(result["statistics"]["latency_us"]), ["least", "mean", "p99", "most"])

    def test_master_with_faults(self):
        result = self.json(FAILED, "master", SLAVE, "read", "40001", "--fault", "parity:character=2,of=answer", "--json")
        self.assertEqual(result["exchanges"][0]["fault"], "characters with wrong parity")
        self.assertEqual((len(result["faults"]), result["faults"][0]["count"]), (1, 1))

    def test_master_in_simulated_time(self):
        polled = self.json(FINE, "master", SLAVE, "read", "40001", "--every", "10min", "--count", "3", "--json")["exchanges"]
        first, second, third = (e["at_us"] for e in polled)
        self.assertAlmostEqual(second - first, 600e6, places=3)
        self.assertAlmostEqual(third - second, 600e6, places=3)
        silent = self.json(FAILED, "master", self.program("LD SM0.0\nMEND\n"), "slave-id", "--timeout", "10ms", "--json")
        self.assertEqual((silent["exchanges"][0]["verdict"], silent["statistics"]["latency_us"]), ("silent", None))
        stopped = self.program("LD SM0.0\nLBL 1\nJMP 1\nMEND\n")
        self.assertEqual(self.ends(FATAL, "master", stopped, "slave-id").stdout, "")
        result = self.json(FATAL, "master", stopped, "slave-id", "--json")
        self.assertEqual((result["exchanges"], result["mode"], result["errors"][0]["code"]), ([], "STOP", "0003"))
        self.assertIn("not ready", result["error"])

    def test_send_text(self):
        program = SOURCE / "stl_programs/text_commands.stl"
        first, second, third, fourth = self.json(FAILED, "send", program, "--text", "SET 04D2\\r", "474554", "--text=\\r", "0d",
                                                 "--json", "--timeout", "20ms", "--pause", "1ms")["exchanges"]
        self.assertEqual((first["unasked"], first["unasked_text"]), (b"READY\r\n".hex(), "READY\r\n"))
        self.assertNotIn("unasked", second)
        self.assertEqual((first["request"], first["request_text"]), (b"SET 04D2\r".hex(), "SET 04D2\r"))
        self.assertEqual((first["response"], first["response_text"]), (b"OK\r\n".hex(), "OK\r\n"))
        self.assertEqual((second["request_text"], second["response"]), ("GET", None))
        self.assertEqual(third["response_text"], "VALUE 04D2\r\n")
        self.assertNotIn("request_text", third)
        self.assertEqual(fourth["response"], None)

    def test_faults(self):
        read, flip = "0103000a0001", "flip:character=3,bit=5,every=2"
        send = ["send", SLAVE, "--crc", read, read, "--timeout", "50ms"]
        done = self.ends(FAILED, *send, "--fault", flip, "--fault", "echo", "--json")
        first, second = json.loads(done.stdout)["exchanges"]
        self.assertEqual(list(first), ["request", "response", "latency_us", "echo", "faults"])
        self.assertEqual((first["response"], first["echo"]), ("0103020000b844", first["request"]))
        self.assertEqual(first["faults"], [{"fault": "echo", "count": 1, "impossible": 0}])
        self.assertEqual((second["response"], second["echo"]), (None, "01032" + first["request"][5:]))
        self.assertEqual(second["faults"][0], {"fault": flip, "count": 1, "impossible": 0})
        self.assertIn(f"s7200: note: fault {flip}: 1×\ns7200: note: fault echo: 2×\n", done.stderr)
        self.assertEqual(self.ends(FAILED, *send, "--fault", flip, "--fault", "echo", "--json").stdout, done.stdout)
        shown = self.ends(FAILED, *send, "--fault", "echo", "--fault", flip).stdout
        self.assertIn("request  01 03 00 0a 00 01 a4 08\necho     01 03 20 0a 00 01 a4 08\nanswer   none within 50 ms", shown)

    def test_a_damaged_answer_is_not_one_to_rely_on(self):
        send = ["send", SLAVE, "--crc", "0103000a0001"]
        for fault in ("parity:character=3", "framing:character=3", "flip:character=3,bit=5", "missing:character=3"):
            done = self.ends(FAILED, *send, "--fault", f"{fault},of=answer", "--json")
            self.assertTrue(json.loads(done.stdout)["exchanges"][0]["damaged"], fault)
            self.assertIn("note: 1 of 1 answers damaged\n", done.stderr)
        self.ends(FINE, *send)
        echo = self.program(self.ECHO)
        self.ends(FINE, "send", echo, "ab", "--fault", "flip:of=answer")  # no CRC is asked for

    def test_faults_that_cannot_be_are_said(self):
        done = self.ends(FINE, "send", self.program(self.ECHO), "ab", "--fault", "parity")
        self.assertIn("note: fault parity: 0×, and 1× the format of the character had no such bit", done.stderr)

    def test_faults_counted_in_the_past_are_said_to_be(self):
        commands = "continue 2s; fault parity:character=8; send 01 03 00 0a 00 01 crc; continue 50ms"
        past = "note: faults are counted up to where the session stands, in the past\n"
        self.assertNotIn(past, self.ends(FINE, "debug", SLAVE, "-x", commands).stderr)
        self.assertIn("note: fault parity:character=8: 0×\ns7200: " + past, self.ends(FINE, "debug", SLAVE, "-x", commands + "; at 2005ms").stderr)

    def test_faults_of_a_run(self):
        result = self.json(FINE, "run", SLAVE, "--for", "1s", "--fault", "noise:ber=0.01", "--fault", "break:from=500ms", "--json")
        noise, line_break = result["faults"]
        self.assertEqual((noise["fault"], line_break), ("noise:ber=0.01", {"fault": "break:from=500ms", "count": 1,
                                                                           "impossible": 0}))
        self.assertTrue(50 < noise["count"] < 150)

    def test_tables(self):
        (row,) = self.json(FINE, "instructions", "MOVW", "--json")["instructions"]
        for key in ("mnemonic", "group", "syntax", "meaning", "modelled", "operands", "needs_power_flow", "flags",
                    "allowed", "cpus", "time_us"):
            self.assertIn(key, row)
        self.assertGreater(len(self.json(FINE, "instructions", "--json")["instructions"]), 100)
        for row in self.json(FINE, "times", "--json")["times"]:
            self.assertEqual(list(row), ["mnemonics", "form", "base_us", "per_unit_us", "unit", "marker", "source", "uncertainty_percent",
                                     "base_within_us", "per_unit_within_us"])

    def test_reals_are_shown_where_they_are(self):
        path = self.program("LD SM0.0\nMOVR 1.5, VD20\nMOVD VD20, VD24\nMOVR VD20, AC1\nMEND\n")
        result = self.json(FINE, "run", path, "--scans", "1", "--dump", "VD20:2", "--dump", "VD24:real", "--dump", "VD24",
                           "--dump", "AC1", "--set", "VD28:real=2", "--dump", "VD24:2:real", "--dump", "VD28", "--json")["dump"]
        bits = 0x3FC00000
        self.assertEqual(result["VD20:2"], {"type": "dword", "hex": "3fc000003fc00000", "values": [bits, bits], "reals": [1.5, None]})
        self.assertEqual(result["VD24:real"], {"type": "real", "hex": "3fc00000", "values": [1.5]})
        self.assertEqual(result["VD24"], {"type": "dword", "hex": "3fc00000", "values": [bits]})
        self.assertEqual(result["VD24:2:real"]["values"], [1.5, 2.0])
        self.assertEqual((result["AC1"]["reals"], result["VD28"]["hex"]), ([1.5], "40000000"))
        text = self.ends(FINE, "run", path, "--scans", "1", "--dump", "VD20:2", "--dump", "VD24:real", "--dump", "AC1").stdout
        self.assertIn("VD20     16#3FC00000  1069547520             1.5\nVD24     16#3FC00000  1069547520\n"
                      "VD24     16#3FC00000             1.5\nAC1      16#3FC00000  1069547520             1.5\n", text)
        for bits, shown in (("16#7FC00000", "nan"), ("16#FF800000", "-inf"), ("16#3DCCCCCD", 0.1)):
            self.assertEqual(self.json(FINE, "run", self.program("LD SM0.0\nMEND\n"), "--scans", "1", "--set", f"VD0={bits}",
                                       "--dump", "VD0:real", "--json")["dump"]["VD0:real"]["values"], [shown])

    def test_what_the_list_of_errors_leaves_out_is_said(self):
        path = self.program("LD SM0.0\n" + "MOVD 0, *VD100\n" * 18 + "MEND\n")
        arguments = ["run", path, "--scans", "2", "--set", "VD100=16#7F000000"]
        result = self.json(FINE, *arguments, "--json")
        self.assertEqual((len(result["errors"]), result["errors_not_listed"]), (16, 4))
        self.assertIn("and 4 more run-time errors at other places: the first 16 places are kept, a trace shows all\n",
                      self.ends(FINE, *arguments).stdout)
        few = self.program("LD SM0.0\nMOVD 0, *VD100\nMEND\n", "few.stl")
        self.assertEqual(self.json(FINE, "run", few, *arguments[2:], "--json")["errors_not_listed"], 0)

    def test_a_name_that_is_not_utf8_does_no_harm(self):
        name = os.fsencode(str(self.folder)) + b"/caf\xe9.stl"
        with open(name, "w", encoding="utf-8") as file:
            file.write("LD SM0.0\nMEND\n")
        for verb in (["check"], ["master", "slave-id", "--timeout", "10ms"]):
            done = s7200(verb[0], os.fsdecode(name), *verb[1:], "--json", text=False)
            self.assertIn("caf\ufffd.stl", json.dumps(json.loads(done.stdout.decode("utf-8")), ensure_ascii=False))

    def test_list_of_scenarios(self):
        path = self.program("name: one\nsteps: [{wait: 1ms}]\n", "a.yaml")
        self.assertEqual(self.json(FINE, "test", "--list", "--json", path)["scenarios"],
                         [{"file": str(path), "line": 1, "name": "one"}])

    def test_import(self):
        document, out = self.program(Files.DOCUMENT, "page.txt"), self.folder / "out.stl"
        result = self.json(FINE, "import", document, "--json")
        self.assertEqual((result["document"], result["instructions"], result["output"]), (str(document), 3, None))
        self.assertEqual(result["stl"], self.ends(FINE, "import", document).stdout)
        result = self.json(FINE, "import", document, "-o", out, "--json")
        self.assertEqual((result["output"], result["stl"]), (str(out), None))

    def test_bench(self):
        for model in ("212", "215", "216"):
            fits = self.ends(FINE if model != "212" else FAILED, "bench", "--cpu", model, "--each", "1ms")
            self.assertEqual("modbus_slave.stl has errors" in fits.stderr, model == "212")
        silent = self.program("LD SM0.0\nMEND\n")
        self.assertIn("did not answer", self.ends(UNUSABLE, "bench", silent, "--each", "1ms").stderr)
        before = self.json(FINE, "bench", "--each", "1ms", "--json")
        for figure in before["figures"]:
            self.assertEqual(list(figure), ["name", "unit", "per_second", "takes", "ratio"])
            self.assertIsNone(figure["ratio"])
            self.assertEqual(figure["per_second"] is None, figure["takes"] is not None)
        names = [figure["name"] for figure in before["figures"]]
        self.assertIn("1900 instructions, mixed", names)
        self.assertIn("check, 100000 lines", names)
        self.assertEqual({figure["name"]: figure["unit"] for figure in before["figures"] if figure["takes"]},
                         {"the same, events traced": "times as long", "a day, polled every second": "s", "start to first output": "ms"})
        self.assertLess({"instruction trace", "nobody talking", "nobody talking, tip-like"}, set(names))
        del before["figures"][1]
        file = self.program(json.dumps(before), "before.json")
        for figure, name in zip(self.json(FINE, "bench", "--each", "1ms", "--json", "--against", file)["figures"], range(20)):
            self.assertEqual(figure["ratio"] is None, name == 1, "it has no figure to compare with")
        compared = self.ends(FINE, "bench", "--each", "1ms", "--against", file).stdout
        self.assertIn(f'"2.00 times" is twice as fast as in {file}\n', compared.splitlines(True)[0])
        self.assertRegex(compared, r"first scan .* \d+\.\d\d times\n")
        self.assertRegex(compared, r"start to first output +\d+\.\d\d ms  \d+\.\d\d times\n")
        slower = self.program(json.dumps(before | {"figures": [{"name": "start to first output", "takes": 1e6}]}), "slower.json")
        self.assertGreater(self.json(FINE, "bench", "--each", "1ms", "--json", "--against", slower)["figures"][-1]["ratio"], 100)
        for key, other in (("program", "other.stl"), ("cpu", "224"), ("times", "my.csv"), ("no_skip", True), ("build", "?")):
            changed = self.program(json.dumps(before | {key: other}), "changed.json")
            self.assertIn(f"was measured with {key} {json.dumps(other)}, this with", self.ends(FINE, "bench", "--each", "1ms", "--against", changed).stderr)
        self.assertEqual(self.ends(FINE, "bench", "--each", "1ms", "--against", file).stderr, "")
        for figure in (0, -1, "many"):
            bad = self.program(json.dumps(before | {"figures": [{"name": "first scan", "per_second": figure}]}), "bad.json")
            self.assertIn("a rate above 0", self.ends(UNUSABLE, "bench", "--each", "1ms", "--against", bad).stderr)
        for wrong in ("missing.json", self.program("[1]", "list.json"), self.program("{", "half.json")):
            self.assertIn("cannot read", self.ends(UNUSABLE, "bench", "--each", "1ms", "--against", wrong).stderr)

    def test_bench_that_is_interrupted_prints_the_figures_measured_until_then(self):
        for by in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            process = subprocess.Popen([S7200, "bench", "--each", "1s", "--json"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True)
            self.addCleanup(process.kill)
            time.sleep(2)
            process.send_signal(by)
            out, error = process.communicate(timeout=120)
            self.assertEqual((process.returncode, error), (FAILED, "s7200: note: interrupted\n"))
            measured = [figure["name"] for figure in json.loads(out)["figures"]]
            self.assertNotIn("start to first output", measured, "the last one")
            self.assertIn(measured[:1], ([], ["first scan"]))

    def test_a_signal_before_a_verb_has_begun_what_it_completes_ends_it_with_exit_code_1(self):
        for by in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            for verb in ("check", "import", "run"):
                process = subprocess.Popen([S7200, verb, "/dev/stdin"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                self.addCleanup(process.kill)
                process.stdin.write(b"// more than a pipe holds, so it reads\n" * 10_000)
                process.stdin.flush()
                process.send_signal(by)
                self.assertEqual((process.communicate(timeout=120)[1], process.returncode), (b"s7200: note: interrupted\n", FAILED), (verb, by))

    def test_bench_runs_every_scan_of_all_its_programs_if_asked(self):
        fast, slow = (self.json(FINE, "bench", "--each", "20ms", "--json", *more)["figures"] for more in ([], ["--no-skip"]))
        rates = lambda figures: {figure["name"]: figure["per_second"] for figure in figures}
        if self.json(FINE, "bench", "--each", "1ms", "--json")["build"] != "Release":
            self.assertRegex(self.ends(FINE, "bench", "--each", "1ms").stdout, r"^modbus_slave\.stl: .* \(\w+ build, not Release\)\n")
            return self.assertEqual(rates(fast).keys(), rates(slow).keys(), "this build never passes scans over")
        for name in ("nobody talking", "nobody talking, tip-like"):
            self.assertGreater(rates(fast)[name], 20 * rates(slow)[name], name)

    def test_bench_saves_its_programs_and_overwrites_none(self):
        folder = self.folder / "saved"
        self.assertIn("cannot make the folder", self.ends(UNUSABLE, "bench", "--save-programs", folder / "below").stderr)
        for beside in (["--against", "x.json"], ["--json"], [SLAVE]):
            self.assertRegex(self.ends(UNUSABLE, "bench", "--save-programs", folder, *beside).stderr, "(--save-programs excludes|excludes --save-programs)")
        self.assertEqual(self.ends(FINE, "bench", "--save-programs", folder).stdout, "")
        for count in (340, 1900, 4000):
            self.assertEqual(self.json(FINE, "run", folder / f"mixed_{count}.stl", "--cpu", "226XM", "--scans", "2", "--json")["instructions"], 2 * count)
        self.assertEqual(len((folder / "listing_1000000.stl").read_text(encoding="utf-8").splitlines()), 1_000_000)
        for file in folder.iterdir():
            file.unlink()
        (folder / "mixed_1900.stl").write_text("mine", encoding="utf-8")
        self.assertIn("mixed_1900.stl exists", self.ends(UNUSABLE, "bench", "--save-programs", folder).stderr)
        self.assertEqual((folder / "mixed_1900.stl").read_text(encoding="utf-8"), "mine")
        self.assertEqual(len(list(folder.iterdir())), 1, "all or none")

    def test_every_scan_run_gives_the_same_as_scans_passed_over(self):
        timers = self.program("LD SM0.5\nTON T37, 3\nLD T37\n= Q0.0\nMEND\n")
        for arguments in (["run", SLAVE, "--for", "30s", "--json"], ["run", timers, "--for", "30s", "--json", "--dump", "T37"],
                          ["run", timers, "--for", "5s", "--trace", "-"], ["master", SLAVE, "read", "40001", "--json"],
                          ["send", SLAVE, "--crc", "0103000a0001", "0103000a0001", "--pause", "5s", "--json"],
                          ["test", "--random", "20", "--target", SLAVE, "--json"]):
            with self.subTest(arguments):
                self.assertEqual(self.ends(FINE, *arguments).stdout, self.ends(FINE, *arguments, "--no-skip").stdout)


class StandardInput(Case):
    """`-` as a PROGRAM."""

    def fed(self, code, program, *arguments, **options):
        """What a verb makes of a program that comes through a pipe."""
        text = program if isinstance(program, str) else pathlib.Path(program).read_text(encoding="utf-8")
        return self.ends(code, *arguments, stdin=None, input=text, **options)

    def test_every_verb_reads_a_program_from_it(self):
        for arguments in (["check"], ["run", "--scans", "2"], ["send", "--crc", "0103000a0001"], ["import"],
                          ["master", "read", "40001"], ["debug", "-x", "step"], ["bench", "--each", "1ms"]):
            verb, *rest = arguments
            with self.subTest(verb):
                shown, fed = self.ends(FINE, verb, SLAVE, *rest), self.fed(FINE, pathlib.Path(SLAVE), verb, "-", *rest)
                if verb != "bench":  # which prints how fast it was
                    self.assertEqual(fed.stdout.replace("standard input", SLAVE), shown.stdout)

    def test_the_names_that_linux_has_for_it_do_as_well(self):
        for name in ("-", "/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"):
            for options in ({"input": "LD SM0.0\nFROB\nMEND\n", "stdin": None},
                            {"stdin": open(self.program("LD SM0.0\nFROB\nMEND\n"), encoding="utf-8")}):
                done = self.ends(FAILED, "check", name, **options)
                self.assertIn("standard input:2:1: error: unknown instruction 'FROB'\nFROB\n^~~~\n", done.stderr)
                if options["stdin"]:
                    options["stdin"].close()

    def test_what_comes_through_a_pipe_is_checked_for_the_other_cpus_too(self):
        text = "LD SM0.0\nINCB VB0\nMEND\n"
        for name in ("-", "/dev/stdin"):
            self.assertIn("fine for CPU 215, 216 or 22x\n", self.fed(FAILED, text, "check", name, "--cpu", "214").stdout)
        (result,) = json.loads(self.fed(FAILED, text, "check", "-", "--cpu", "214", "--json").stdout)["files"]
        self.assertEqual((result["file"], result["fine_for"][:3]), ("-", ["215", "216", "221r1"]))

    def test_a_document_can_go_from_import_to_check(self):
        document = self.program(Files.DOCUMENT, "page.txt")
        done = subprocess.run(["bash", "-c", f'"{S7200}" import "{document}" | "{S7200}" check --cpu 215 -'], timeout=60,
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (FINE, "standard input: fine, 3 instructions for CPU 215\n"))

    def test_the_debugger_then_needs_its_commands_elsewhere(self):
        for arguments in ([], ["-i", "-x", "step"]):
            done = self.fed(UNUSABLE, pathlib.Path(SLAVE), "debug", "-", *arguments)
            self.assertIn("the program comes from standard input, so the commands cannot", done.stderr)
        commands = self.program("step\n", "commands.txt")
        self.fed(FINE, pathlib.Path(SLAVE), "debug", "-", "--commands", commands)

    def test_it_is_read_once(self):
        done = self.fed(UNUSABLE, "LD SM0.0\nMEND\n", "check", "-", "-")
        self.assertIn("cannot read standard input: it has been read already", done.stderr)
        self.assertIn("cannot read standard input: ",
                      subprocess.run(["bash", "-c", f'"{S7200}" check - <&-'], capture_output=True, text=True, timeout=60,
                                     check=False).stderr)

    def test_scenarios_name_it_as_their_program_target_or_against(self):
        """Several scenarios on several CPUs share what was read once."""
        steps = "steps:\n  - {read: holding 0, expect: [0]}\n"
        named = self.program('program: "-"\ntimeout: 200ms\nscenarios:\n' +
                             "".join(f"  - name: on {cpu}\n    cpu: {cpu}\n    steps: [{{read: holding 0, expect: [0]}}]\n"
                                     for cpu in (214, 215)), "named.yaml")
        self.assertIn("2 passed", self.fed(FINE, pathlib.Path(SLAVE), "test", named).stdout)
        unnamed = self.program("timeout: 200ms\n" + steps, "unnamed.yaml")
        self.assertIn("1 passed", self.fed(FINE, pathlib.Path(SLAVE), "test", unnamed, "--target", "-").stdout)
        self.assertIn("same", self.fed(FINE, pathlib.Path(SLAVE), "test", unnamed, "--target", SLAVE, "--against", "-").stdout)
        record = self.folder / "record.yaml"
        self.fed(FINE, pathlib.Path(SLAVE), "test", named, "--record", record)
        self.fed(FINE, pathlib.Path(SLAVE), "test", record)


class Scenarios(Case):
    """`s7200 test`: exit codes, files, output for machines."""
    HEAD = f"program: {SLAVE}\ntimeout: 200ms\n"
    GOOD = HEAD + "name: good\nsteps:\n  - {read: holding 0, expect: [0]}\n"
    BAD = HEAD + "name: <bad> & \"ugly\"\nsteps:\n  - {read: holding 0, expect: exception 2}\n"

    def test_exit_codes(self):
        good, bad = self.program(self.GOOD, "good.yaml"), self.program(self.BAD, "bad.yaml")
        self.assertIn("1 scenario: 1 passed", self.ends(FINE, "test", good).stdout)
        self.assertIn("1 passed, 1 failed", self.ends(FAILED, "test", good, bad).stdout)
        skipped = self.program(self.GOOD + "skip_without: no/such/file\n", "skipped.yaml")
        self.assertIn("no/such/file is not there", self.ends(FINE, "test", skipped).stdout)
        stops = self.program("LD SM0.0\nLBL 1\nJMP 1\nMEND\n")
        self.assertIn("FATAL error 0003", self.ends(FAILED, "test", self.program(
            f"program: {stops}\nafter: 0\nsteps: [{{wait: 1s}}]\n", "fatal.yaml")).stdout)

    def test_wrong_usage(self):
        good = self.program(self.GOOD, "good.yaml")
        wrong = self.program(self.HEAD + "steps: [{wait: 5}]\n", "wrong.yaml")
        without = self.program("steps: [{wait: 1ms}]\n", "without.yaml")
        broken = self.program("FROB\n", "broken.stl")
        (self.folder / "empty").mkdir()
        for arguments in ([], ["missing.yaml"], [wrong], [good, wrong], [without], [self.folder / "empty"],
                          [good, "--only", "nothing has this name"], [good, "--jobs", "0"], ["--random", "5"],
                          [good, "--ignore-timing"], [good, "--tolerance", "1ms"], [good, "--conformance", good],
                          [good, "--with", wrong], [good, "--with", self.program("frob: 1\n", "with.yaml")],
                          [good, "--target", broken], [good, "--target", "missing.stl"], [good, "--against", "tcp://nohost"],
                          [good, "--record", "no/such/folder/file"], [good, "--junit", "no/such/folder/file"], [good, "--markdown", "no/such/folder/file"],
                          [good, "--target", "/dev/ttyNoSuchDevice"],
                          ["--conformance", self.program("functions: [3]\n", "slave.yaml"), "--target", "modbus-tcp://localhost"]):
            with self.subTest(arguments):
                done = self.ends(UNUSABLE, "test", *arguments)
                self.assertEqual(done.stdout, "")
                self.assertGreater(len(done.stderr), 10)

    def test_mistakes_are_told_at_their_place(self):
        wrong = self.program("steps:\n  - {wait: 1ms, frob: 1}\n", "wrong.yaml")
        self.assertIn(f"{wrong}:2:17: error: 'frob' has no place beside 'wait'\n  - {{wait: 1ms, frob: 1}}\n"
                      "                ^~~~\nhint: known: ", self.ends(UNUSABLE, "test", wrong).stderr)

    def test_json(self):
        good, bad = self.program(self.GOOD, "good.yaml"), self.program(self.BAD, "bad.yaml")
        result = self.json(FAILED, "test", "--json", good, bad)
        self.assertEqual((result["passed"], result["failed"], result["skipped"], result["not_run"]), (1, 1, 0, 0))
        first, second = result["scenarios"]
        self.assertEqual(list(first), ["file", "line", "name", "outcome", "reason", "time_ns", "checks", "skipped_steps",
                                       "findings", "exchanges"])
        self.assertEqual(list(first["exchanges"][0]), ["line", "request", "response", "latency_us"])
        self.assertEqual(list(second["findings"][0]), ["line", "column", "note", "loop", "what", "expected", "found",
                                                       "expected_bytes", "found_bytes", "why"])
        self.assertEqual((second["outcome"], second["findings"][0]["line"]), ("failed", 5))

    def test_junit(self):
        good, bad, out = self.program(self.GOOD, "good.yaml"), self.program(self.BAD, "bad.yaml"), self.folder / "out.xml"
        skipped = self.program(self.GOOD + "skip_without: 'no \u00e9 <file>'\n", "skipped.yaml")
        self.ends(FAILED, "test", good, bad, skipped, "--junit", out)
        suites = xml.etree.ElementTree.parse(out).getroot()
        self.assertEqual((suites.get("tests"), suites.get("failures"), suites.get("skipped")), ("3", "1", "1"))
        cases = suites.findall("testsuite/testcase")
        self.assertEqual(cases[1].get("name"), '<bad> & "ugly"')
        self.assertIn("exception 2: illegal data address", cases[1].find("failure").text)
        self.assertIsNone(cases[0].find("failure"))
        self.assertIn("<file> is not there", cases[2].find("skipped").get("message"))

    def test_markdown(self):
        good, bad, out = self.program(self.GOOD, "good.yaml"), self.program(self.BAD, "bad.yaml"), self.folder / "out.md"
        skipped = self.program(self.GOOD + "skip_without: no_file\n", "skipped.yaml")
        self.ends(FAILED, "test", good, bad, skipped, "--markdown", out)
        text = out.read_text(encoding="utf-8")
        self.assertTrue(text.startswith("<!-- Results of s7200 test -->\n## ✗ 3 scenarios: 1 passed, 1 failed, 1 skipped\n\n| file |"), text)
        self.assertIn(f"| {bad} | 0 | 1 | 0 | 0 |\n".replace("_", "\\_"), text)
        self.assertIn('### ✗ \\<bad\\> \\& "ugly"\n', text, "names are text")
        self.assertRegex(text, r"\n- line 5: .*exception 2: illegal data address")
        self.assertRegex(text, r"\n    s7200 debug \S*bad\.yaml --only ")
        self.assertRegex(text, r"\n- good: \S*/no\\_file is not there\n")
        self.ends(FINE, "test", good, "--markdown", out)
        self.assertIn("## ✓ 1 scenario: 1 passed\n", out.read_text(encoding="utf-8"))
        self.ends(UNUSABLE, "test", self.program("steps:\n  - {wait: 5}\n", "wrong.yaml"), "--markdown", out)
        self.assertRegex(out.read_text(encoding="utf-8"), r"## ✗ nothing was run: 1 mistake\n\n- \S*wrong\.yaml:2:\d+: ")
        self.assertIn("--against neither records nor writes JUnit or Markdown", self.ends(UNUSABLE, "test", good, "--markdown", out, "--against", SLAVE).stderr)

    def test_junit_has_what_its_readers_show(self):
        """Jenkins: class and name, message, text. GitLab: file. GitHub: file and line, message."""
        folder = self.folder / "plant" / "line.2"
        folder.mkdir(parents=True)
        file, out = folder / "slave.yaml", self.folder / "out.xml"
        file.write_text(f"program: {SLAVE}\ntimeout: 200ms\nscenarios:\n  - name: one\n    steps:\n"
                        "      - {read: holding 0, expect: exception 2}\n      - memory: {VW20: 5, VD24: 1.5}\n"
                        "  - name: two\n    steps:\n      - wait: 1s\n      - {read: holding 0, at: 500ms}\n"
                        "  - {name: three, steps: [{read: holding 0, expect: [0]}]}\n", encoding="utf-8")
        self.ends(FAILED, "test", "plant/line.2/slave.yaml", "--junit", out, cwd=self.folder)
        suites = xml.etree.ElementTree.parse(out).getroot()
        (suite,) = suites
        for element in (suites, suite):
            self.assertEqual([element.get(key) for key in ("tests", "failures", "errors", "skipped")], ["3", "2", "0", "0"])
            self.assertGreaterEqual(float(element.get("time")), 0)
        one, two, three = suite
        self.assertEqual([case.get("file") for case in suite], ["plant/line.2/slave.yaml"] * 3)
        self.assertEqual([case.get("line") for case in suite], ["4", "8", "12"])
        self.assertEqual({case.get("classname") for case in suite}, {"plant.line.2.slave"})
        failure = one.find("failure")
        self.assertEqual(failure.get("message"), "line 6: answer to 01 03 00 00 00 01 84 0a: expected exception 2: illegal data "
                         "address, found 1 register: 16#0000; and 2 more findings")
        self.assertEqual((failure.get("type"), two.find("failure").get("type")), ("expectation", "run"))
        for text in ("slave.yaml:6:10", "expected  01 83 02", "slave.yaml:7:9", "VD24 is "):
            self.assertIn(text, failure.text)
        self.assertRegex(two.find("failure").get("message"), r"^line 11: begin: expected a request at 500 ms, found it is ")
        self.assertIsNone(three.find("failure"))
        properties = {p.get("name"): p.get("value") for p in three.findall("properties/property")}
        self.assertEqual(list(properties), ["program", "cpu", "simulated_time_ns", "checks", "skipped_steps"])
        self.assertEqual((properties["checks"], properties["cpu"]), ("1", "214"))

    def test_what_checks_nothing_does_not_pass_in_silence(self):
        for text in ("", "# nothing\n", "---\n", "null\n", self.HEAD, self.HEAD + "steps:\n", self.HEAD + "steps: []\n",
                     self.HEAD + "steps: [{repeat: 2, steps: []}]\n", self.HEAD + "scenarios:\n",
                     self.HEAD + "scenarios: []\n", self.HEAD + "scenarios: [{name: a, steps: []}]\n"):
            with self.subTest(text):
                self.assertEqual(self.ends(UNUSABLE, "test", self.program(text, "empty.yaml")).stdout, "")
        asks = self.program(self.HEAD + "steps: [{read: holding 0}]\n", "asks.yaml")
        done = self.ends(FINE, "test", asks)
        self.assertIn("(nothing was expected, so nothing was checked)", done.stdout)
        self.assertIn("note: nothing was checked: no step that was done expects anything", done.stderr)
        skipped = self.program(self.GOOD + "skip_without: no/such/file\n", "skipped.yaml")
        self.assertIn("note: nothing was checked: every scenario was skipped", self.ends(FINE, "test", skipped).stderr)
        self.assertNotIn("note", self.ends(FINE, "test", asks, self.program(self.GOOD, "good.yaml")).stderr)
        self.assertNotIn("note", self.ends(FINE, "test", asks, "--record", self.folder / "out.yaml").stderr)
        self.assertEqual(self.json(FINE, "test", asks, "--json")["scenarios"][0]["checks"], 0)

    def test_the_examples_of_the_description_pass(self):
        description = (SOURCE / "tests/programs/README.md").read_text(encoding="utf-8")
        examples = re.findall(r"(?s)```yaml\n(.*?)```", description)
        self.assertGreater(len(examples), 1)
        for example in examples:
            self.ends(FINE, "test", self.program(example.replace("../../..", str(SOURCE)), "example.yaml"))

    def test_a_tab_is_said_with_its_place_and_what_to_do(self):
        path = self.program("steps:\n  - wait: 1ms\n\t- wait: 1ms\n", "tab.yaml")
        self.assertEqual(self.ends(UNUSABLE, "test", path).stderr,
                         f"{path}:3:1: error: a tab in the indentation: YAML takes blanks only\n\t- wait: 1ms\n^\n"
                         "hint: replace the tabs by blanks; most editors do so for a whole file\n")

    TEXT = ("timeout: 10s\nsteps:\n  - {send: {text: 'SET 0102\\r'}, expect: {text: 'OK\\r\\n'}}\n  - memory: {VW0: 258}\n"
            "  - {send: {text: 'GET\\r'}, expect: {text: 'VALUE 01\\?2\\r\\n'}, listen: 300ms}\n")

    def test_text_over_a_pty(self):
        """The program says ALARM by itself while nothing is sent."""
        program, link, live = str(SOURCE / "stl_programs/text_commands.stl"), self.folder / "plc", self.folder / "live.yaml"
        inputs = self.program("time,address,value\n" + "".join(
            f"{second}s,I0.0,{(second + 1) % 2}\n" for second in range(1, 100)), "inputs.csv")
        run = subprocess.Popen([S7200, "run", program, "--input", str(inputs), "--pty", str(link), "--for", "100s"],
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        text, deadline = self.program(self.TEXT, "text.yaml"), time.monotonic() + 60
        target = ["--target", link, "--parity", "none"]
        while (done := s7200("test", text, *target)).returncode != FINE:  # until it is there, and no ALARM comes in between
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.1)
        self.assertIn("1 of 3 steps skipped", done.stdout)
        alarm = self.program("steps:\n  - {receive: {text: 'ALARM\\r\\n'}, timeout: 30s, latency: ..29s, at: 1ms..}\n", "alarm.yaml")
        self.ends(FINE, "test", alarm, *target, "--record", live)
        self.assertRegex(live.read_text(encoding="utf-8"), r"(?m)^      - receive: \{text: 'ALARM\\r\\n'\}\n        timeout: 30 s\n"
                         r"        latency: ")
        until = self.program("steps:\n  - wait_until: {VW0: 5}\n", "until.yaml")
        self.assertIn("(needs a program in simulation: line 2, 'wait_until')", self.ends(FINE, "test", until, *target).stdout)

    def test_output_is_the_same_with_several_jobs(self):
        folder = SOURCE / "tests/programs/modbus_slave"
        self.assertEqual(self.ends(FINE, "test", folder, "--jobs", "4").stdout, self.ends(FINE, "test", folder).stdout)

    def test_only_list_and_fail_fast(self):
        good, bad = self.program(self.GOOD, "good.yaml"), self.program(self.BAD, "bad.yaml")
        self.assertEqual(self.ends(FINE, "test", good, bad, "--list").stdout, f'{good}\n  good\n{bad}\n  <bad> & "ugly"\n')
        self.assertIn("1 scenario: 1 passed", self.ends(FINE, "test", good, bad, "--only", "GOOD").stdout)
        done = self.ends(FAILED, "test", bad, good, "--fail-fast")
        self.assertIn("1 scenario: 0 passed, 1 failed", done.stdout)
        self.assertIn("1 scenario was not run", done.stderr)

    def test_a_transcript_replays_and_is_not_overwritten_unasked(self):
        good, out = self.program(self.GOOD, "good.yaml"), self.folder / "transcript.yaml"
        self.ends(FINE, "test", good, "--record", out)
        written = out.read_text(encoding="utf-8")
        self.ends(FINE, "test", out)
        self.assertIn("--force", self.ends(UNUSABLE, "test", good, "--record", out).stderr)
        self.assertEqual(out.read_text(encoding="utf-8"), written)
        self.ends(FINE, "test", out, "--record", out, "--force")
        other = self.program(out.read_text(encoding="utf-8").replace("expect: 01 03 02 00 00", "expect: 01 03 02 00 01"), "o.yaml")
        self.ends(FAILED, "test", other)

    def test_a_live_run_is_recorded_and_replays_in_simulation(self):
        link, live = self.folder / "plc", self.folder / "live.yaml"
        slave = subprocess.Popen([S7200, "run", SLAVE, "--pty", str(link), "--for", "120s"], stdin=subprocess.DEVNULL,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(slave.wait)
        self.addCleanup(slave.kill)
        good, deadline = self.program(self.GOOD, "good.yaml"), time.monotonic() + 60

        while s7200("test", good, "--target", link).returncode != FINE:  # until the link is there and the first scan has ended
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)
        steps = self.program("timeout: 10s\nsteps:\n  - {write: holding 5, value: 7, expect: echo}\n  - memory: {VW10: 7}\n"
                             "  - {read: holding 5, expect: [7]}\n", "steps.yaml")
        done = self.ends(FINE, "test", steps, "--target", link, "--record", live, "--tolerance", "9s")
        self.assertIn("1 of 3 steps skipped", done.stdout)
        self.assertNotIn("memory", live.read_text(encoding="utf-8"))
        self.ends(FINE, "test", live, "--target", SLAVE)
        self.ends(FINE, "test", live, "--target", link)

    def test_only_earlier_results_are_overwritten(self):
        good, pipe, xml = self.program(self.GOOD, "good.yaml"), self.folder / "pipe", self.folder / "out.xml"
        os.mkfifo(pipe)
        for arguments, why in ((["--junit", good], "is not a JUnit file of s7200 test"), (["--markdown", good], "is not a Markdown file of s7200 test"), (["--record", good, "--force"], "is not a transcript"),
                               (["--junit", pipe], "not a file"), (["--record", pipe, "--force"], "not a file"),
                               *([[option, "-"], "'-' is none"] for option in ("--junit", "--markdown", "--record"))):
            with self.subTest(arguments):
                self.assertIn(why, self.ends(UNUSABLE, "test", good, *arguments).stderr)
        self.assertEqual(good.read_text(encoding="utf-8"), self.GOOD)
        self.assertTrue(pipe.is_fifo())
        for _ in range(2):
            self.ends(FINE, "test", good, "--junit", xml, "--markdown", self.folder / "out.md")

    def test_a_missing_program_fails_its_scenario_and_the_others_run(self):
        good, out = self.program(self.GOOD, "good.yaml"), self.folder / "out.xml"
        missing = self.program("program: no.stl\nsteps: [{wait: 1ms}]\n", "missing.yaml")
        broken = self.program(f"program: {self.program('FROB', 'broken.stl')}\nsteps: [{{wait: 1ms}}]\n", "broken.yaml")
        done = self.ends(FAILED, "test", missing, broken, good, "--junit", out)
        self.assertIn("3 scenarios: 1 passed, 2 failed", done.stdout)
        self.assertIn(f"{missing}:1:1: program: no.stl", done.stdout)
        self.assertIn("cannot read ", done.stdout)
        self.assertIn(f"{self.folder}/broken.stl:1:1: ", done.stdout)
        cases = xml.etree.ElementTree.parse(out).getroot().findall("testsuite/testcase")
        self.assertEqual([case.find("failure").get("type") for case in cases[:2]], ["run", "run"])
        self.assertIsNone(cases[2].find("failure"))
        self.assertEqual(self.json(FAILED, "test", missing, good, "--json")["failed"], 1)
        self.ends(UNUSABLE, "test", missing)  # there is no program for any of them

    def test_known_gaps_are_counted_apart_and_turn_red_when_they_pass(self):
        gap = self.program(self.BAD + "expected_failure: not yet\n", "gap.yaml")
        self.assertIn("1 scenario: 0 passed, 1 expected failure", self.ends(FINE, "test", gap).stdout)
        passes = self.program(self.GOOD + "expected_failure: not yet\n", "passes.yaml")
        self.assertIn("it passes although it is an expected failure: remove the mark", self.ends(FAILED, "test", passes).stdout)
        described = (f"program: {SLAVE}\nfunctions: [3]\nholding_registers: {{count: 1000}}\nexpected_failures:\n  ")
        kept = self.program(described + "SL-crc: it is kept\n", "kept.yaml")
        self.assertIn("remove the mark", self.ends(FAILED, "test", "--conformance", kept, "--only", "SL-crc").stdout)
        unknown = self.program(described + "SL-frob: it is none\n", "unknown.yaml")
        self.assertIn("has no rule 'SL-frob'", self.ends(UNUSABLE, "test", "--conformance", unknown).stderr)

    def test_against(self):
        good = self.program(self.GOOD, "good.yaml")
        self.assertIn("same", self.ends(FINE, "test", good, "--against", SLAVE).stdout)
        slower = self.program(pathlib.Path(SLAVE).read_text(encoding="utf-8").replace("MOVB    6, SMB34", "MOVB    9, SMB34"), "slower.stl")
        self.assertIn("the first different time", self.ends(FAILED, "test", good, "--against", slower).stdout)
        self.ends(FINE, "test", good, "--against", slower, "--ignore-timing")
        self.ends(FINE, "test", good, "--against", slower, "--tolerance", "10ms")
        (result,) = self.json(FAILED, "test", good, "--against", slower, "--json")["comparisons"]
        self.assertEqual(list(result), ["file", "name", "skipped", "exchanges", "same", "difference"])

    def test_conformance(self):
        description = self.program(f"program: {SLAVE}\nfunctions: [3]\nholding_registers: {{count: 1000}}\n", "slave.yaml")
        done = s7200("test", "--conformance", description, "--json")
        rules = {r["rule"]["id"]: r for r in json.loads(done.stdout)["scenarios"]}
        self.assertEqual(done.returncode, FAILED, "function 6 is there and must be refused")
        self.assertEqual(rules["AP-06-write"]["outcome"], "skipped")
        self.assertEqual(rules["AP-illegal-function"]["outcome"], "failed")
        self.assertEqual(rules["SL-gap-2"]["rule"]["severity"], "should")
        self.assertEqual(rules["SL-gap-2"]["outcome"], "failed")
        xml_file = self.folder / "out.xml"
        s7200("test", "--conformance", description, "--junit", xml_file)
        suites = xml.etree.ElementTree.parse(xml_file).getroot()
        cases = {case.get("name").split()[0]: case for case in suites.iter("testcase")}
        self.assertIsNotNone(cases["AP-illegal-function"].find("failure"))
        self.assertIsNone(cases["SL-gap-2"].find("failure"), "what only should be done fails no build")
        self.assertIsNotNone(cases["SL-gap-2"].find("skipped"))
        self.assertEqual(int(suites.get("failures")), len(list(suites.iter("failure"))))
        self.assertEqual(int(suites.get("skipped")), len(list(suites.iter("skipped"))))
        wrong = self.program("station: 300\n", "wrong.yaml")
        self.assertIn(f"values for ${{…}} are from {wrong}", self.ends(UNUSABLE, "test", "--conformance", wrong).stderr)


class Systems(Case):
    """System files, where a PROGRAM can be."""
    SYSTEM = f"""plcs:
  slave: {{program: {SLAVE}, copies: 2, station: 4, set: {{VW0: 16#0102}}, dump: [VW0]}}
peers:
  master: {{polls: [{{station: 4..5, read: 40001}}], every: 125ms}}
lines:
  bus: {{stations: [master, slave]}}
"""

    def test_results_in_words_and_as_json(self):
        system = self.program(self.SYSTEM, "system.yaml")
        shown = self.ends(FINE, "run", system, "--for", "1990ms").stdout
        self.assertRegex(shown, r"\Aended by time after 1.99 s: 2 PLCs, 1 master, 1 line\n")
        self.assertRegex(shown, r"(?m)^slave2: \d+ scans, \d+ instructions, CPU 214 in RUN\n  VW0 +16#0102")
        self.assertRegex(shown, r"(?m)^master: 16 requests, 16 answered, after ")
        results = self.json(FINE, "run", system, "--for", "1990ms", "--json")
        self.assertEqual([plc["name"] for plc in results["plcs"]], ["slave1", "slave2"])
        self.assertEqual(results["plcs"][0]["dump"]["VW0"]["hex"], "0102")
        self.assertEqual((results["masters"][0]["requests"], results["masters"][0]["wrong"]), (16, 0))

    def test_a_system_is_tested_from_the_place_that_is_named(self):
        system = self.program(f"plcs:\n  a: {{program: {SLAVE}, station: 4, set: {{VW20: 16#0102}}}}\n  b: {{program: {SLAVE}, station: 5}}\n"
                              "lines:\n  north: {stations: [a]}\n  south: {stations: [b]}\n", "system.yaml")
        yaml = self.program("station: 4\ntimeout: 300ms\nscenarios:\n  - {name: first, steps: [{read: 40011, expect: [16#0102]},"
                            " {write: 40011, values: [7]}]}\n  - {name: new, steps: [{read: 40011, expect: [16#0102], latency: 1ms..100ms}]}\n"
                            "  - {name: inside, steps: [{set: {VW0: 1}}]}\n", "system_test.yaml")
        result = self.json(FINE, "test", yaml, "--target", system, "--at", "north", "--jobs", "2", "--json")
        self.assertEqual([one["outcome"] for one in result["scenarios"]], ["passed", "passed", "skipped"])
        self.ends(FAILED, "test", yaml, "--target", system, "--at", "b")
        self.assertIn("DIFFER", self.ends(FAILED, "test", yaml, "--target", system, "--against", SLAVE, "--at", "north").stdout)
        self.ends(FINE, "test", "--random", 20, "--station", 5, "--target", system, "--at", "south")
        stopped = self.program("LD SM0.0\nSTOP\nMEND\n", "stopped.stl")
        bridged = system.read_text(encoding="utf-8").replace("[b]", "[b, pc]") + "bridges: {pc: {tcp: 0}}\n"
        for arguments, why in (([system], "there are several lines, north, south"), ([system, "--at", "west"], "'west'"),
                               ([self.program("plcs: {a: {program: none.stl}}\nlines: {l: {stations: [a]}}\n", "bad.yaml")], "cannot read"),
                               ([self.folder / "none.yaml"], "cannot read"), ([self.program(bridged, "bridged.yaml"), "--at", "a"], "follows the clock"),
                               ([self.program(f"plcs: {{a: {{program: {stopped}}}}}\nlines: {{l: {{stations: [a]}}}}\n", "stop.yaml")],
                                "line l, beside a: the CPU went to STOP")):
            with self.subTest(arguments):
                self.assertIn(why, self.ends(UNUSABLE, "test", yaml, "--target", *arguments).stderr)

    def test_a_cpu_in_stop_leaves_the_others_on_its_line_to_answer(self):
        stopped = self.program("LD SM0.0\nSTOP\nMEND\n", "stopped.stl")
        system = self.program(f"plcs:\n  a: {{program: {stopped}}}\n  b: {{program: {SLAVE}, station: 4, set: {{VW20: 7}}}}\n"
                              "lines: {l: {stations: [a, b]}}\n", "system.yaml")
        scenario = self.program("steps: [{read: 40011, station: 4, expect: [7]}]\n", "reads.yaml")
        self.ends(FINE, "test", scenario, "--target", system)

    def test_a_band_asks_a_cpu_in_stop_as_send_does(self):
        stopped = self.program("LD SM0.0\nSTOP\nMEND\n", "stopped.stl")
        status, accepted = "10 02 00 49 4b 16", "answer   10 00 02 00 02 16"  # in STOP its port speaks PPI
        self.assertIn(accepted, self.ends(FINE, "send", stopped, status).stdout)
        self.assertIn("answered: 4 of 4 tables", self.ends(FINE, "send", stopped, status, "--times-band", "2").stdout)

    def test_a_plc_that_is_off_at_the_end_is_said_to_be(self):
        system = self.program(f"plcs: {{a: {{program: {SLAVE}}}}}\nlines: {{l: {{stations: [a]}}}}\nevents: [{{at: 1ms, power_off: a}}]\n", "off.yaml")
        self.assertRegex(self.ends(FINE, "run", system, "--for", "10ms").stdout, r"CPU 214 without power\n")

    def test_a_constant_of_the_system_file_is_shown_as_it_was_written(self):
        system = self.program(f"plcs: {{a: {{program: {SLAVE}, constants: {{SMB30: 16#45}}, trace: a.trace, trace_instructions: true}}}}\n"
                              "lines: {l: {stations: [a]}}\n", "constants.yaml")
        self.ends(FINE, "run", system, "--for", "5ms")
        trace = (self.folder / "a.trace").read_text(encoding="utf-8")
        self.assertRegex(trace, r"MOVB +16#45, SMB30\b")
        self.assertNotRegex(trace, "MOVB .*SMB30 .*9600 baud")

    def test_a_duration_without_a_unit_is_told_that_it_needs_one(self):
        system = self.program(self.SYSTEM.replace("stations: [master, slave]", "stations: [master, slave], turn_round: 1"), "unit.yaml")
        self.assertIn("'1' is not a duration with its unit, of a day at most", self.ends(UNUSABLE, "run", system).stderr)

    def test_what_is_recorded_of_each_plc_and_line(self):
        text = self.SYSTEM.replace("copies: 2, ", "trace: slave.trace, ").replace("4..5", "4").replace(
            "stations: [master, slave]", "stations: [master, slave], capture: [bus.pcap]")
        self.ends(FINE, "run", self.program(text, "system.yaml"), "--for", "1500ms")
        self.assertIn("XMT", (self.folder / "slave.trace").read_text(encoding="utf-8"))
        self.assertGreater((self.folder / "bus.pcap").stat().st_size, 100)

    def test_a_mistake_is_shown_with_its_place(self):
        system = self.program(self.SYSTEM.replace("[master, slave]", "[master, slvae]"), "system.yaml")
        done = self.ends(UNUSABLE, "run", system)
        self.assertIn("system.yaml:6:28: error: there is no station 'slvae'", done.stderr)
        self.assertIn("^~~~~", done.stderr)
        wrong = self.program("LD VB0\nMEND\n", "wrong.stl")
        done = self.ends(FAILED, "run", self.program(self.SYSTEM.replace(SLAVE, "wrong.stl"), "broken.yaml"))
        self.assertIn(f"{wrong}:1:", done.stderr)

    def test_every_scan_of_a_system_can_be_run(self):
        system = self.program(f"plcs: {{a: {{program: {SLAVE}, station: 4}}}}\nlines: {{l: {{stations: [a]}}}}\n", "system.yaml")
        scenario = self.program("steps: [{read: 40011, station: 4, expect: [0]}, {wait: 2s}, {read: 40011, station: 4, expect: [0]}]\n", "reads.yaml")
        own = self.program("system: system.yaml\nsteps: [{wait: 2s}]\n", "own.yaml")
        for verb in (["run", system, "--for", "3s", "--json"], ["test", scenario, "--target", system, "--json"], ["test", own, "--json"]):
            self.assertEqual(self.ends(FINE, *verb).stdout, self.ends(FINE, *verb, "--no-skip").stdout, verb)
        self.assertIn("--no-skip needs a PROGRAM to run", self.ends(UNUSABLE, "run", "westinghouse:pc1200", "--no-skip").stderr)

    def test_options_about_one_plc_and_other_verbs_are_refused(self):
        system = self.program(self.SYSTEM, "system.yaml")
        self.assertIn("--set is about one PLC", self.ends(UNUSABLE, "run", system, "--set", "VW0=1").stderr)
        self.assertIn("--capture is about one line: the system file says it of each, with the key 'capture: [FILE.pcap]' of the line",
                      self.ends(UNUSABLE, "send", system, "01", "--capture", "x.pcap").stderr)
        self.assertIn("with the key 'faults: [FAULT]' of the line", self.ends(UNUSABLE, "run", system, "--fault", "parity").stderr)
        for verb in (["send", system, "01"], ["master", system, "read", "40001"]):
            self.assertIn("--cpu is about one PLC", self.ends(UNUSABLE, *verb, "--cpu", "224").stderr)
            self.assertIn("--times-band is about one PLC", self.ends(UNUSABLE, *verb, "--times-band", "2").stderr)
        self.assertIn("names the files of its programs itself", self.ends(UNUSABLE, "run", system, SLAVE).stderr)
        self.assertIn("is a system file, which 's7200 run', 'send', 'master', 'test', 'debug', 'view' and 'dap' take",
                      self.ends(UNUSABLE, "bench", system).stderr)
        self.assertIn("is a system file", self.ends(UNUSABLE, "check", system).stderr)
        for verb in ("debug", "view", "dap"):
            self.assertIn("--set is about one PLC", self.ends(UNUSABLE, verb, system, "--set", "VW0=1").stderr)

    GATEWAY = SOURCE / "stl_programs/systems/gateway.yaml"

    def test_frames_go_onto_a_line_and_are_answered_by_who_is_there(self):
        system = self.program(self.SYSTEM, "system.yaml")
        done = self.ends(FINE, "send", system, "--crc", "050300000001")
        self.assertRegex(done.stdout, r"(?m)05 03 02 01 02 .*\n(.*\n)*slave1:\n  VW0 +16#0102")
        results = self.json(FAILED, "send", system, "--crc", "050300000001", "090300000001", "--timeout", "50ms", "--json")
        self.assertEqual([exchange["response"] is None for exchange in results["exchanges"]], [False, True])
        self.assertEqual([plc["mode"] for plc in results["plcs"]], ["RUN", "RUN"])

    def test_the_place_in_a_system_is_a_line_or_a_plc(self):
        frame = ["--crc", "050300000001"]
        self.assertIn("there are several lines, office, field: name one of them, or a PLC (--at NAME)",
                      self.ends(UNUSABLE, "send", self.GATEWAY, *frame).stderr)
        latencies = {place: self.json(FINE, "send", self.GATEWAY, *frame, "--at", place, "--json")["exchanges"][0]["latency_us"]
                     for place in ("office", "gateway", "field", "gateway.1", "pump")}
        self.assertEqual(latencies["office"], latencies["gateway"])
        self.assertEqual(latencies["field"], latencies["gateway.1"])
        self.assertEqual(latencies["field"], latencies["pump"])
        self.assertGreater(latencies["office"], latencies["pump"], "by the way over the gateway and back")
        for place, why in (("attic", "there is no line or PLC 'attic': the lines are office, field, the PLCs gateway, pump"),
                           ("pump.1", "port 1 of 'pump' is on no line")):
            self.assertIn(why, self.ends(UNUSABLE, "send", self.GATEWAY, *frame, "--at", place).stderr)
        self.assertIn("a PROGRAM has --port", self.ends(UNUSABLE, "send", SLAVE, *frame, "--at", "bus").stderr)

    def test_a_full_line_has_no_place_for_one_more_master(self):
        done = self.ends(UNUSABLE, "master", SOURCE / "stl_programs/systems/polled_slaves.yaml", "read", "40001")
        self.assertIn("line 'bus' has 32 stations already, as many as a line takes", done.stderr)

    def test_a_bridge_follows_the_clock_and_is_refused_where_none_does(self):
        text = self.SYSTEM.replace("lines:", "bridges: {panel: {tcp: 127.0.0.1:0}}\nlines:").replace("slave]", "slave, panel]")
        done = self.ends(UNUSABLE, "send", self.program(text, "system.yaml"), "01")
        self.assertIn("bridge 'panel' of", done.stderr)

    def test_a_master_joins_a_line(self):
        done = self.ends(FINE, "master", self.GATEWAY, "--at", "office", "--station", "5", "read", "40001")
        self.assertIn("1234", done.stdout)
        results = self.json(FINE, "master", self.GATEWAY, "--at", "pump", "--station", "5", "read", "40001", "--json")
        self.assertEqual(results["exchanges"][0]["values"], [0x1234])
        self.assertEqual([line["name"] for line in results["lines"]], ["office", "field"])

    def test_a_timeline_has_the_station_beside_each_event(self):
        shown = self.ends(FINE, "send", self.GATEWAY, "--at", "office", "--crc", "050300000001", "--timeline").stdout
        self.assertRegex(shown, r"(?m)^ +ms  station  at the port")
        self.assertRegex(shown, r"(?m)^ +[\d.]+  gateway  (port 0 )?event 23 ")
        self.assertRegex(shown, r"(?m)^ +[\d.]+  pump     received  05 ")
        rows = self.json(FINE, "send", self.GATEWAY, "--at", "office", "--crc", "050300000001", "--timeline",
                         "--json")["exchanges"][0]["timeline"]
        self.assertEqual({row["station"] for row in rows}, {"gateway", "pump"})
        self.assertEqual([row["at_us"] for row in rows], sorted(row["at_us"] for row in rows))

    def test_a_trace_of_a_system_has_all_stations_in_the_order_of_time(self):
        trace = self.folder / "all.txt"
        for verb in (["run", self.program(self.SYSTEM, "system.yaml"), "--for", "1200ms"],
                     ["send", self.GATEWAY, "--at", "field", "--crc", "050300000001"]):
            self.ends(FINE, *verb, "--trace", trace, "--trace-events")
            first, *lines = trace.read_text(encoding="utf-8").splitlines()
            self.assertEqual(first, "# station, time in ms, what")
            self.assertEqual({line.split()[0] for line in lines}, {"slave1", "slave2"} if verb[0] == "run" else {"gateway", "pump"})
            times = [float(line.split()[1]) for line in lines]
            self.assertEqual(times, sorted(times))
        self.assertIn("cannot both have standard output",
                      self.ends(UNUSABLE, "run", self.GATEWAY, "--trace", "-", "--json").stderr)

    def test_a_trace_of_a_system_says_what_happens_in_the_field(self):
        events = ("events:\n  - {at: 1s, cut: bus, after: slave1}\n  - {at: 1100ms, mend: bus}\n"
                  "  - {at: 1200ms, fault: \"parity:character=2\", line: bus, station: slave1}\n  - {at: 1250ms, clear_faults: bus}\n"
                  "  - {at: 1300ms, power_off: slave2}\n  - {at: 1350ms, set: {VW0: 5, SMB30: 9}, plc: slave2}\n"
                  "  - {at: 1800ms, power_on: slave2}\n  - {at: 1850ms, set: {VW0: 5}, plc: slave2}\n"
                  "  - {at: 1850ms, set: {VW0: 6}, plc: slave2}\n  - {at: 1850ms, set: {VW0: 5, I0.3: 1}, plc: slave2}\n"
                  "  - {at: 1900ms, power_off: master}\n")
        trace = self.folder / "all.txt"
        self.ends(FINE, "run", self.program(self.SYSTEM + events, "system.yaml"), "--for", "2s", "--trace", trace, "--trace-events")
        lines = trace.read_text(encoding="utf-8").splitlines()[1:]
        self.assertEqual([re.sub(" +", " ", line) for line in lines
                          if re.search("power|cable|fault|programming device", line)],
                         ["bus 1000.000000 cable cut after slave1", "bus 1100.000000 cable whole again",
                          "bus 1200.000000 fault parity:character=2 of slave1", "bus 1250.000000 no fault any more",
                          "slave2 1300.000000 power off", "slave2 1350.000000 a programming device sets VW0 to 16#0005, SMB30 to 16#09: no effect, the PLC has no power",
                          "slave2 1800.000000 power on", "slave2 1850.000000 a programming device sets VW0 to 16#0005",
                          "slave2 1850.000000 a programming device sets VW0 to 16#0006",
                          "slave2 1850.000000 a programming device sets VW0 to 16#0005, I0.3 to 16#1", "master 1900.000000 power off"])
        off = [line for line in lines if line.startswith("slave2") and 1300 < float(line.split()[1]) < 1800]
        self.assertEqual(len(off), 1, "a PLC without power hears nothing")
        times = [float(line.split()[1]) for line in lines]
        self.assertEqual(times, sorted(times))

    def test_what_happens_to_a_plc_is_in_its_own_trace_and_in_the_timeline(self):
        events = ("events:\n  - {at: 104ms, cut: bus, after: slave1}\n  - {at: 105ms, power_off: slave2}\n"
                  "  - {at: 111ms, plc: slave1, set: {VW0: 7}}\n")
        slaves = f"plcs:\n  slave1: {{program: {SLAVE}, trace: one.txt}}\n  slave2: {{program: {SLAVE}, station: 2, trace: two.txt}}\n"
        system = self.program(slaves + "lines: {bus: {stations: [slave1, slave2]}}\n" + events, "system.yaml")
        done = self.ends(FINE, "send", system, "--after", "100ms", "--crc", "010300000001", "--timeline").stdout
        for row in (r" 5\.000  slave2   power off\n", r" 4\.000  slave1   line bus: cable cut after slave1\n",
                    r" 11\.000  slave1   a programming device sets VW0 to 16#0007\n"):
            self.assertRegex(done, row)
        one, two = ((self.folder / name).read_text(encoding="utf-8") for name in ("one.txt", "two.txt"))
        self.assertIn("    104.000000  line bus: cable cut after slave1\n", one)
        self.assertIn("    111.000000  a programming device sets VW0 to 16#0007\n", one)
        self.assertNotIn("power off", one)
        self.assertTrue(two.endswith("    105.000000  power off\n"), "a PLC without power hears nothing")

    def test_stations_that_are_set_to_another_format_are_named(self):
        system = lambda parity: self.program(
            f"plcs: {{slave: {{program: {SLAVE}, station: 2}}}}\n"
            f"peers: {{old: {{westinghouse: modbus, settings: [slave=05, parity={parity}]}}}}\nlines: {{bus: {{stations: [slave, old]}}}}\n", "format.yaml")
        said = "note: bus: old is set to 9600 baud 8O1, slave to 9600 baud 8E1: they do not understand each other"
        for verb, arguments in (("run", ["--for", "100ms"]), ("send", ["--crc", "020300000001"]), ("master", ["--station", "2", "read", "40001"])):
            self.assertIn(said, self.ends(FINE, verb, system("odd"), *arguments).stderr)
            self.assertNotIn("understand", self.ends(FINE, verb, system("even"), *arguments).stderr)

    def test_a_capture_of_two_others_has_request_and_answer_apart(self):
        netr = self.program("LD SM0.1\nMOVB 4, VB0\nSPA VB0, 0\nMOVB 2, SMB30\nMOVB 3, VB101\nMOVD &VB200, VD102\nMOVB 4, VB106\n"
                            "LD SM0.0\nINCW VW1000\nLDW= VW1000, 3\nNETR VB100, 0\nMEND\n", "netr.stl")
        idle = self.program("LD SM0.0\nMOVW VW0, VW2\nMEND\n", "idle.stl")
        system = self.program(f"plcs:\n  watcher: {{program: {idle}, ppi_station: 9}}\n  master: {{program: {netr}, cpu: 224}}\n"
                              f"  slave: {{program: {idle}, ppi_station: 3, set: {{VD200: 16#01020304}}}}\n"
                              "lines: {bus: {stations: [watcher, master, slave], capture: [bus.pcap]}}\n", "ppi.yaml")
        self.ends(FINE, "run", system, "--for", "500ms")
        frames = self.json(FINE, "decode", self.folder / "bus.pcap", "--protocol", "ppi", "--json")["frames"]
        self.assertEqual([frame["kind"] for frame in frames], ["request", "answer"] * 2)
        self.assertEqual(frames[1]["bytes"], "e5")
        self.assertIn("VB200:4 = 16#01 16#02 16#03 16#04", frames[3]["text"])

    def test_every_verb_leaves_alone_what_the_files_of_a_system_file_have_not_written(self):
        system = self.program(f"plcs: {{slave: {{program: {SLAVE}, trace: trace.txt, output: out.csv, memory: memory.json}}}}\n"
                              "lines: {bus: {stations: [slave], capture: [bus.pcap, bus.vcd]}}\n", "plant.yaml")
        scenario = self.program("system: plant.yaml\nsteps: [wait: 1ms]\n", "plant_test.yaml")
        verbs = (["run", system, "--for", "1ms"], ["send", system, "--crc", "010300000001"], ["master", system, "read", "40001"],
                 ["debug", system, "-x", "quit"])
        for name in ("trace.txt", "out.csv", "memory.json", "bus.pcap", "bus.vcd"):
            mine = self.program("mine", name)
            for verb in verbs:
                self.assertIn("left alone", self.ends(UNUSABLE, *verb).stderr, f"{verb[0]} {name}")
            self.ends(FINE, "test", scenario)
            self.assertEqual(mine.read_text(encoding="utf-8"), "mine")
            mine.unlink()

    def test_a_system_file_is_known_by_its_name_in_any_case(self):
        text = f"plcs: {{slave: {{program: {SLAVE}}}}}\nlines: {{bus: {{stations: [slave]}}}}\n"
        for name in ("bus.YML", "bus.Yaml"):
            self.assertIn("1 PLC, 1 line", self.ends(FINE, "run", self.program(text, name), "--for", "1ms").stdout)

    def test_a_master_that_joins_a_lan_drives_the_sync_signal_there(self):
        idle = self.program("LD SM0.1\nMOVB 16#09, SMB30\nMEND\n", "idle.stl")
        lan = ("plcs: {{beside: {{program: {}}}}}\npeers: {{old: {{westinghouse: pc1000-lan, settings: [unit=05, \"W[0]=1234\"]{}}}}}\n"
               "lines: {{lan: {{stations: [beside, old]}}}}\n")
        ask = ["master", "--protocol", "pc1000-lan"]
        system = self.program(lan.format(idle, ", sync: master"), "lan.yaml")
        self.assertIn("16#1234", self.ends(FINE, *ask, system, "unit", "5", "read", "0").stdout)
        self.assertIn("no answer", self.ends(FAILED, *ask, system, "--no-sync", "unit", "5").stdout)
        steps = ("steps:\n  - {send: 0A 05 00 00 00 0F, expect: any}\n"
                 "  - {send: 05 00 00 01 00 06, expect: 05 00 00 01 00 06 34 12 46}\n")
        self.program("peers: {old: {westinghouse: pc1000-lan, settings: [unit=05, \"W[0]=1234\"], sync: master}}\n"
                     "lines: {lan: {stations: [old]}}\n", "alone.yaml")
        for named in ("lan.yaml", "alone.yaml"):
            scenario = self.program(f"system: {named}\n{steps}", "scenario.yaml")
            self.assertIn("1 passed", self.ends(FINE, "test", scenario).stdout, f"{named}: requests of a scenario drive it too")
        silent = self.program(lan.format(idle, ""), "silent.yaml")
        self.assertIn("sync: master", self.ends(UNUSABLE, *ask, silent, "unit", "5").stderr)

    def test_why_knows_that_a_program_receives_with_rcv(self):
        shown = self.ends(FINE, "debug", self.GATEWAY, "--at", "office", "-x",
                          "continue 1030ms; break unanswered; send 01 03 00 00 00 01 crc; continue 20ms; why").stdout
        self.assertIn(": no RCV waits; the last one, RCV VB100, 0 in line 29", shown)
        self.assertNotIn("event 8 is not attached", shown)

    def test_record_names_the_bytes_that_differ(self):
        shown = self.ends(FINE, "debug", SLAVE, "-x", "continue 100ms; send 01 03 00 0a 00 01 crc; continue 5ms; set VW50=77; "
                          f"continue; display VW50; record {self.folder / 'recorded.yaml'}").stdout
        self.assertIn("VW50 is 16#0000 (0), expected 16#004D; nothing has written it since power-up; ", shown)

    def test_the_debugger_steps_and_goes_back_with_all_stations(self):
        system = self.program(self.SYSTEM, "system.yaml")
        shown = self.ends(FINE, "debug", system, "--at", "slave2", "-x",
                          "continue 1s; break event 8 served; station slave1; continue 1s; station slave1; rstep; station").stdout
        self.assertRegex(shown, r"now at slave2\nslave2: breakpoint 1, event 8 served, hit for the first time")
        self.assertIn("in the past; going forward plays what has run", shown)
        self.assertRegex(shown, r"\n> slave1  \d+\.\d+ ms .*\n  slave2  \d+\.\d+ ms ")
        self.assertIn("VW0", shown.splitlines()[-1] + shown.splitlines()[-3], "--dump of the system file, by PLC")
        done = self.ends(FINE, "debug", self.GATEWAY, "-x", "step; station")
        self.assertIn("note: gateway is in view, the first of 2 PLCs on 2 lines; 'station NAME' goes over to another one", done.stderr)
        self.assertRegex(done.stdout, r"\n> gateway ")
        full = SOURCE / "stl_programs/systems/polled_slaves.yaml"
        done = self.ends(UNUSABLE, "debug", full, "--at", "slave31", "-x", "continue 20ms; send read 40001 station 31")
        self.assertIn("there is no place for one more master", done.stderr)

    def test_a_session_with_a_system_becomes_a_scenario_and_a_file_that_is_loaded(self):
        system = self.program(f"plcs:\n  slave: {{program: {SLAVE}, copies: 2, station: 4}}\nlines:\n  bus: {{stations: [slave]}}\n",
                              "system.yaml")
        scenario, saved = self.folder / "here.yaml", self.folder / "here.json"
        self.ends(FINE, "debug", system, "-x",
                  "continue 100ms; station slave2; set VW20=16#1234; display VW20; continue 50ms; send read 40011 station 5; continue; continue 20ms; "
                  f"save {saved}; record {scenario}")
        text = scenario.read_text(encoding="utf-8")
        for part in ('system: "system.yaml"', 'on: slave2', "16#1234"):
            self.assertIn(part, text.replace('on: "slave2"', "on: slave2"))
        self.assertIn("1 passed", self.ends(FINE, "test", scenario).stdout)
        loaded = self.ends(FINE, "debug", system, "-x", f"load {saved}; station slave2; expect VW20 = 16#1234; who VW20").stdout
        self.assertIn("by 'set VW20', from outside", loaded)
        done = self.ends(UNUSABLE, "debug", SLAVE, "-x", f"load {saved}")
        self.assertIn("it is of a system, not of one program", done.stderr)

    def test_a_bridge_of_a_system_is_served_while_the_debugger_runs(self):
        link = self.folder / "desk"
        system = self.program(f"plcs:\n  slave: {{program: {SLAVE}, copies: 2, station: 4}}\n"
                              f"bridges:\n  desk: {{pty: {link}}}\nlines:\n  bus: {{stations: [slave, desk]}}\n", "system.yaml")
        done = self.ends(FINE, "debug", system, "-x", "continue 30ms; station")
        self.assertIn("masters outside get no answers", done.stderr)
        self.assertRegex(done.stdout, r"> slave1  3\d\.\d+ ms")
        self.assertIn("follows the clock", self.ends(UNUSABLE, "send", system, "01").stderr)

    def test_a_scenario_names_a_system_and_whom_its_steps_are_about(self):
        self.program(self.SYSTEM, "system.yaml")
        head = "system: system.yaml\nsteps:\n"
        for steps, why in (("  - {read: holding 0, on: slvae1}", "there is no line or PLC 'slvae1'"),
                           ("  - power_off: slvae1", "there is no PLC or peer 'slvae1'"),
                           ("  - cut: bus", "a cut without 'after'"),
                           ("  - wait: 2 scans", "scans of which PLC?"),
                           ("  - power_cycle: memory kept", "'power_cycle' is about a program")):
            self.assertIn(why, self.ends(UNUSABLE, "test", self.program(head + steps + "\n", "scenario.yaml")).stderr)
        wrong = self.program(f"program: {SLAVE}\nsteps:\n  - {{wait: 1ms, on: bus}}\n", "wrong.yaml")
        self.assertIn("'on' names a PLC or a line of a system", self.ends(UNUSABLE, "test", wrong).stderr)
        self.assertIn("is a system file, which a scenario names", self.ends(UNUSABLE, "test", self.folder / "system.yaml").stderr)
        both = self.program("system: system.yaml\ncpu: 224\nsteps: [wait: 1ms]\n", "both.yaml")
        self.assertIn("'cpu' is of one program", self.ends(UNUSABLE, "test", both).stderr)
        gateway = self.program(f"system: {self.GATEWAY}\nsteps: [{{read: holding 0}}]\n", "gateway.yaml")
        self.assertIn("there are several lines, office, field", self.ends(UNUSABLE, "test", gateway).stderr)

    def test_settings_in_the_table_of_keys_are_those_of_their_protocols(self):
        row = next(line for line in self.ends(FINE, "run", "--keys").stdout.splitlines() if line.startswith("| `settings: LIST`"))
        examples = re.findall(r"`(\[[^`]+\])` of ([\w-]+\w)", row)
        self.assertEqual([protocol for _, protocol in examples], ["modbus", "pc1000-lan"])
        for settings, protocol in examples:
            system = self.program(f"peers: {{p: {{westinghouse: {protocol}, settings: {settings}}}}}\nlines: {{l: {{stations: [p]}}}}\n", "keys.yaml")
            self.ends(FINE, "run", system)

    def test_what_does_nothing_in_a_system_is_said(self):
        system = self.program(self.SYSTEM + "events:\n  - {at: 1s, power_on: slave2}\n  - {at: 3s, power_off: slave2}\n  - {at: 4s, power_off: slave2}\n", "system.yaml")
        done = self.ends(FINE, "run", system, "--for", "2s")
        self.assertIn("warning: 'slave2' has power already: this does nothing", done.stderr)
        self.assertIn("warning: 'slave2' has no power already: this does nothing", done.stderr)
        self.assertIn("the run ended before 2 events, the first at 3 s: --for says how long to run", done.stderr)
        self.assertNotIn("the run ended before", self.ends(FINE, "run", system, "--for", "5s").stderr)

    def test_a_memory_that_is_not_as_expected_is_that_of_a_named_plc(self):
        self.program(self.SYSTEM, "system.yaml")
        scenario = self.program("system: system.yaml\nsteps:\n  - {memory: {VB4094: 99}, on: slave2}\n", "scenario.yaml")
        self.assertIn("VB4094 of slave2", self.ends(FAILED, "test", scenario).stdout)

    def test_nothing_is_set_in_a_plc_without_power(self):
        self.program(self.SYSTEM, "system.yaml")
        scenario = self.program("system: system.yaml\nsteps:\n  - power_off: slave2\n  - {set: {VW0: 7}, on: slave2}\n", "scenario.yaml")
        shown = self.ends(FAILED, "test", scenario).stdout
        self.assertRegex(shown, r"set of slave2.*")
        self.assertIn("it has none: nothing was set", shown)

    def test_what_another_master_asks_is_no_answer_though_it_reads_like_one(self):
        system = self.program(f"plcs: {{slave: {{program: {SLAVE}, station: 1}}}}\n"
                              "peers: {panel: {polls: [{station: 9, write: 40001, value: 5}], starts: 1050ms, timeout: 100ms}}\n"
                              "lines: {x: {stations: [panel, slave]}}\n", "system.yaml")
        scenario = self.program("system: system.yaml\nsteps:\n  - {write: holding 0, value: 5, station: 9, expect: echo, at: 1s}\n", "scenario.yaml")
        self.assertIn("the request of another master, and no answer", self.ends(FAILED, "test", scenario).stdout)
        asked = ["--after", "1s", "--crc", "090600000005"]
        self.assertIn("the request of another master, and no answer", self.ends(FAILED, "send", system, *asked).stdout)
        self.assertIn("the request of another master, and no answer",
                      self.ends(FAILED, "master", system, "--station", "9", "--after", "1s", "write", "40001=5").stdout)

    def test_what_a_program_asks_that_is_a_master_itself_is_no_answer(self):
        system = self.program(f"plcs: {{m: {{program: {SOURCE}/stl_programs/modbus_master.stl, cpu: 224, set: {{I0.1: 1}}}}}}\n"
                              "lines: {l: {stations: [m]}}\n", "asks.yaml")
        sent = self.ends(FAILED, "send", system, "--after", "1999ms", "--crc", "02030000000a")
        self.assertIn("         the request of another master, and no answer\n", sent.stdout)
        self.assertIn("1 of 1 frames had no answer: another master's request came first", sent.stderr)
        asked = self.ends(FAILED, "master", system, "--after", "1999ms", "--station", "2", "read", "40001").stdout
        self.assertIn("answer of station 1, not 2: a request, so somebody else is a master, too", asked)

    def test_plcs_of_another_make_alone_are_asked_by_send_and_master(self):
        others = SOURCE / "tests/programs/systems/other_plcs.yaml"
        asked = self.ends(FINE, "master", others, "--at", "yard", "--station", "5", "read", "40001", "write", "40001=7", "read", "40001")
        self.assertRegex(asked.stdout, r"(?s)  40001 +0  16#9ABC.*  40001 +0  16#0007")
        sent = self.ends(FINE, "send", others, "--at", "yard", "--crc", "050300000001", "--timeline")
        self.assertIn("answer   05 03 02 9a bc", sent.stdout)
        late = self.ends(FAILED, "send", others, "--at", "yard", "--crc", "050300000001", "--after", "600ms")
        self.assertIn("none within", late.stdout, "its power is off by then")
        capture = self.program(f"peers: {{boiler: {{westinghouse: hppc}}}}\nlines: {{x: {{stations: [boiler], capture: [x.pcap]}}}}\n", "hppc.yaml")
        shown = self.json(FINE, "master", capture, "--protocol", "hppc", "write-register", "1=5", "read-register", "1", "--json")
        self.assertEqual([exchange["verdict"] for exchange in shown["exchanges"]], ["right", "right"])
        self.assertEqual(shown["lines"], [{"name": "x", "faults": []}])
        self.assertIn("holding register 1 at 16#ABFFE", self.ends(FINE, "decode", self.folder / "x.pcap", "--protocol", "hppc").stdout)
        self.assertIn("--set", self.ends(UNUSABLE, "send", others, "--at", "yard", "01", "--set", "VB0=1").stderr)
        self.assertIn("there is no line 'tank': the lines are plant, yard", self.ends(UNUSABLE, "send", others, "--at", "tank", "01").stderr)

    def test_instructions_are_not_shown_of_plcs_of_another_make(self):
        others = SOURCE / "tests/programs/systems/other_plcs.yaml"
        self.assertIn("'s7200 debug' shows instructions, and simulated PLCs of another make have none; 's7200 send', 'master' and 'test' ask them",
                      self.ends(UNUSABLE, "debug", others, "--at", "yard", "-x", "step").stderr)

    def test_plcs_of_another_make_alone_are_a_target_of_scenarios(self):
        others = SOURCE / "tests/programs/systems/other_plcs.yaml"
        scenario = self.program("timeout: 60ms\nsteps:\n  - {read: holding 0, station: 5, expect: [16#9ABC]}\n", "scenario.yaml")
        self.ends(FINE, "test", scenario, "--target", others, "--at", "yard")
        self.assertIn("there are several lines, plant, yard: name one of them (--at NAME)",
                      self.ends(UNUSABLE, "test", scenario, "--target", others).stderr)
        transcript = self.folder / "transcript.yaml"
        self.ends(FINE, "test", SOURCE / "tests/programs/systems/without_s7200.yaml", "--record", transcript)
        self.ends(FINE, "test", transcript)

    def test_a_finding_says_which_station_and_shows_all_on_the_line(self):
        self.program(self.SYSTEM, "system.yaml")
        scenario = self.program("system: system.yaml\nsteps:\n  - {memory: {VW0: 7}, on: slave2}\n"
                                "  - {read: holding 0, station: 4, on: slave1, expect: [7]}\n", "scenario.yaml")
        shown = self.ends(FAILED, "test", scenario).stdout
        self.assertRegex(shown, r"VW0 of slave2")
        self.assertRegex(shown, r"(?m)^ +[\d.]+  slave2 +received  04 ")
        done = self.ends(UNUSABLE, "test", scenario, "--target", SLAVE)
        self.assertIn("which --target cannot replace", done.stdout)

    def test_a_slow_cpu_is_polled_for_a_second_and_the_latency_is_that_of_its_answer(self):
        slow = SOURCE / "tests/programs/long_scan.stl"
        asked = self.json(FINE, "master", "--protocol", "ppi", slow, "--cpu", "226", "--ppi-baud", "187500", "status", "write", "VB100=7", "read", "VB100",
                          "--json")["exchanges"]
        self.assertEqual([each["attempts"] for each in asked], [1, 1, 1])
        self.assertAlmostEqual(asked[0]["latency_us"], 58.667)
        self.assertGreater(asked[1]["latency_us"] + asked[2]["latency_us"], 60_000, "a scan takes 73 ms, and a request waits for its end")

    def test_ports_in_ppi_mode_have_the_rate_of_the_system_block(self):
        ask = ["master", "--protocol", "ppi", SLAVE, "--cpu", "226", "--port", "1", "status", "write", "VW20=4660", "read", "VW20"]
        self.assertIn("after 1.146 ms", self.ends(FINE, *ask).stdout)
        for rates in ("187500", "9600,187500"):
            shown = self.ends(FINE, *ask, "--ppi-baud", rates).stdout
            self.assertIn("after 58.667 us", shown)
            self.assertIn("16#1234", shown)
        self.ends(FAILED, *ask, "--ppi-baud", "19200", "--baud", "9600")
        for arguments, why in ((["--ppi-baud", "187500"], "--ppi-baud: PPI at 187500 baud needs CPU 22x"),
                               (["--ppi-baud", "9600,19200"], "--ppi-baud: CPU 214 has no port 1 for the second rate"),
                               (["--ppi-baud", "38400"], "--ppi-baud: '38400' is not a rate of PPI; write 9600, 19200 or"),
                               (["--ppi-station", "3,4"], "--ppi-station: CPU 214 has no port 1 for the second station"),
                               (["--ppi-station", "0"], "--ppi-station: '0' is not a PPI station from 1 to 126"),
                               (["--ppi-second", "later"], "--ppi-second: 'later' is not what a port does with a second request")):
            self.assertIn(why, self.ends(UNUSABLE, "run", SLAVE, *arguments, "--scans", "1").stderr)
        system = self.program(f"plcs: {{a: {{program: {SLAVE}, cpu: 226, ppi_baud: \"9600,187500\"}}}}\nlines: {{l: {{stations: [a.1]}}}}\n",
                              "system.yaml")
        self.assertIn("after 58.667 us", self.ends(FINE, "master", "--protocol", "ppi", system, "status").stdout)
        for option in ("--ppi-baud", "--ppi-station", "--ppi-second"):
            self.assertIn(f"{option} is about one PLC", self.ends(UNUSABLE, "run", system, option, "19").stderr)

    def test_what_becomes_of_a_masters_second_request_is_chosen(self):
        program = self.program("LD SM0.0\nINCW VW0\nMEND\n")
        ask = "68 1b 1b 68 02 00 6c 32 01 00 00 00 01 00 0e 00 00 04 01 12 0a 10 02 00 04 00 01 84 00 03 20 8f 16"
        for second, says in (("replaces", "e5"), ("refused", "10 00 02 02 04 16")):
            steps = f"program: {program}\nppi_second: {second}\nsteps:\n  - {{send: {ask}, expect: e5}}\n  - {{send: {ask}, expect: {says}}}\n"
            scenario, transcript = self.program(steps, f"{second}.yaml"), self.folder / f"{second}-transcript.yaml"
            self.ends(FINE, "test", scenario, "--record", transcript)
            self.assertEqual("ppi_second: refused" in transcript.read_text(encoding="utf-8"), second == "refused")
            self.ends(FINE, "test", transcript)
            self.assertIn(says, self.ends(FINE, "send", program, "--ppi-second", second, ask, ask).stdout)

    def test_a_master_forces_values_and_the_trace_says_what_it_does(self):
        program = self.program("LD SM0.0\nR Q0.0, 1\nTON T37, 10\nMEND\n")
        done = self.ends(FINE, "master", "--protocol", "ppi", program, "--cpu", "224", "--trace", "-", "force", "Q0.0=1", "VB500=9",
                         "read", "M0.3", "T37", "C5", "AIW0", "unforce", "Q0.0").stdout
        for said in ("Q0.0 forced", "Q0.0 no longer forced", "PPI station 0 forces Q0.0", "PPI station 0 forces VB500",
                     "PPI station 0 unforces Q0.0", *(f"PPI station 0 reads {what}\n" for what in ("M0.3", "T37", "C5", "AIW0"))):
            self.assertIn(said, done)
        self.assertIn("error 16#03: not allowed", self.ends(FAILED, "master", "--protocol", "ppi", program, "--cpu", "224", "force", "SMB30=1").stdout)

    def test_ports_in_ppi_mode_are_at_the_station_of_the_system_block(self):
        program = self.program("LD SM0.0\nINCW VW0\nMEND\n")
        ask = ["master", "--protocol", "ppi", program, "--ppi-station", "9"]
        self.assertIn("station 9, VW20", self.ends(FINE, *ask, "--station", "9", "read", "VW20").stdout)
        self.assertIn("no answer", self.ends(FAILED, *ask, "read", "VW20").stdout)
        plcs = "plcs: {{a: {{program: {0}{1}}}, b: {{program: {0}}}}}\nlines: {{l: {{stations: [a, b]}}}}\n"
        apart = self.program(plcs.format(program, ", ppi_station: 9"), "apart.yaml")
        self.assertNotIn("warning", self.ends(FINE, "run", apart, "--for", "1s").stderr)
        self.assertIn("station 9, VW20", self.ends(FINE, "master", "--protocol", "ppi", apart, "--station", "9", "read", "VW20").stdout)
        same = self.program(plcs.format(program, ""), "same.yaml")
        self.assertIn("warning: PPI station 2 on line 'l' is a, b: they answer at the same time, and the answers collide",
                      self.ends(FINE, "run", same, "--for", "1s").stderr)
        scenario = self.program(f"program: {program}\nppi_station: 9\nsteps:\n  - send: 10 09 00 49 52 16\n    expect: 10 00 09 00 09 16\n", "scenario.yaml")
        transcript = self.folder / "transcript.yaml"
        self.ends(FINE, "test", scenario, "--record", transcript)
        self.assertIn('ppi_station: "9"', transcript.read_text(encoding="utf-8"))
        self.ends(FINE, "test", transcript)

    def test_a_scenario_and_a_recorded_session_keep_the_rate_of_ppi(self):
        program = self.program("LD SM0.0\nINCW VW0\nMEND\n")
        ask = "68 1b 1b 68 02 00 6c 32 01 00 00 00 01 00 0e 00 00 04 01 12 0a 10 02 00 04 00 01 84 00 03 20 8f 16"
        scenario = self.program(f"program: {program}\ncpu: 224\nppi_baud: 187500\nsteps:\n  - send: {ask}\n    expect: e5\n    latency: 50us..70us\n",
                                "scenario.yaml")
        self.ends(FINE, "test", scenario)
        transcript, session = self.folder / "transcript.yaml", self.folder / "session.yaml"
        self.ends(FINE, "test", scenario, "--record", transcript)
        self.assertIn('ppi_baud: "187500"', transcript.read_text(encoding="utf-8"))
        self.ends(FINE, "test", transcript)
        self.ends(FINE, "debug", program, "--cpu", "224", "--ppi-baud", "187500", "-x", f"continue 10ms; send {ask}; continue 20ms; record {session}")
        self.assertIn('ppi_baud: "187500"', session.read_text(encoding="utf-8"))
        self.ends(FINE, "test", session)
        self.assertIn("'38400' is not a rate of PPI", self.ends(UNUSABLE, "test", self.program("program: x.stl\nppi_baud: 38400\nsteps: []\n", "wrong.yaml")).stderr)

    def test_a_master_of_a_system_is_switched_off_and_on(self):
        system = self.program(self.SYSTEM + "events: [{at: 1120ms, power_off: master}, {at: 1300ms, power_on: master}]\n", "system.yaml")
        self.assertRegex(self.ends(FINE, "run", system, "--for", "2250ms").stdout, r"(?m)^master: 2 requests, 2 answered, after ")
        bridged = self.program(self.SYSTEM.replace("lines:", "bridges: {outside: {tcp: 0}}\nlines:").replace("slave]", "slave, outside]")
                               + "events: [{at: 1s, power_off: outside}]\n", "bridged.yaml")
        self.assertIn("'outside' is a bridge, which has no power to switch", self.ends(UNUSABLE, "run", bridged, "--for", "1s").stderr)

    def test_a_scenario_of_a_system_is_replayed_from_its_transcript(self):
        self.program(self.SYSTEM, "system.yaml")
        scenario = self.program("system: system.yaml\nsteps:\n  - {read: holding 0, station: 5, on: slave2}\n  - power_off: slave2\n"
                                "  - {read: holding 0, station: 5, on: bus, timeout: 50ms}\n  - {cut: bus, after: slave1}\n", "scenario.yaml")
        transcript = self.folder / "transcript.yaml"
        self.ends(FINE, "test", scenario, "--record", transcript)
        text = transcript.read_text(encoding="utf-8")
        for part in ('system: "system.yaml"', "- power_off: slave2", "on: slave2", "after: slave1", "expect: silence"):
            self.assertIn(part, text)
        self.ends(FINE, "test", transcript)


class JsonPage(Case):
    """tools/JSON.md and what is printed have the same keys."""
    maxDiff = None

    def documented(self):
        """{verb: its keys}"""
        keys = {verb: set() for verb in VERBS}
        for section in (SOURCE / "tools/JSON.md").read_text(encoding="utf-8").split("\n## ")[1:]:
            heading, rest = section.split("\n", 1)
            for verb in VERBS if heading == "Every verb" else heading.split(", "):
                keys[verb] |= set(re.findall(r"(?m)^\| `([^`]+)` \|", rest))
        return keys

    def keys(self, value, path=""):
        """Every key in it, written as on the page."""
        if isinstance(value, list):
            return set().union(*(self.keys(element, path) for element in value)) if value else set()
        if not isinstance(value, dict):
            return set()
        found = set()
        for key, inner in value.items():
            here = path + ("ADDRESS" if path == "dump." else key)
            found |= ({here} if path != "dump." else set()) | self.keys(inner, here + ("[]." if isinstance(inner, list) else "."))
        return found

    def system(self):
        return self.program(f"plcs: {{slave: {{program: {SLAVE}}}}}\n"
                            "peers: {master: {polls: [{station: 1, read: 40001}]}}\nbridges: {panel: {tcp: 127.0.0.1:0}}\n"
                            "lines: {bus: {stations: [slave, master, panel], faults: [{fault: \"flip:exchange=9\", station: slave}]}}\n",
                            "system.yaml")

    def alone(self):
        """The same without the bridge, which follows the clock."""
        text = pathlib.Path(self.system()).read_text(encoding="utf-8")
        return self.program(text.replace("bridges: {panel: {tcp: 127.0.0.1:0}}\n", "").replace(", panel]", "]"), "alone.yaml")

    SEQUENCE = ("NETWORK 1 // steps\nLD SM0.1\nS S0.0, 1\nNETWORK 2\nLSCR S0.0\nNETWORK 3\nLD I0.0\nSCRT S0.1\nNETWORK 4\nSCRE\n"
                "NETWORK 5\nLSCR S0.1\nNETWORK 6\nLD SM0.0\n= Q0.0\nNETWORK 7\nSCRE\nNETWORK 8\nLD S0.1\n= Q0.1\n"
                "NETWORK 9\nLD I0.5\nR S0.0, 2\nNETWORK 10\nLD I0.6\nMOVB 0, SB0\nS M3.0, 1\nNETWORK 11\nLD M3.0\n= Q0.2\nMEND\n")
    TOLD_TWICE = "LD I0.0\nA I0.1\n= M0.0\nLD M0.0\n= M0.1\nLD M0.0\n= M0.2\nLD M0.1\nA M0.2\n= Q0.0\nMEND\n"
    CALLS_ITSELF = "LD SM0.1\nATCH 0, 10\nENI\nLD SM0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\nCALL 1\nRET\nINT 0\nRETI\n"
    CALLS_NOTHING = "LD SM0.0\nMOVB 1, VB0\nMEND\nSBR 1\nLD SM0.0\nMOVB 1, VB9\nRET\n"
    WIDE = "NETWORK 1 // as long as it may be\nLD I0.0 // start\n" + "A M0.0\n" * 12 + "= Q0.0\nMOVB 1, VB0\nMEND\n"

    @staticmethod
    def ask_over_tcp(port):
        """As soon as somebody serves there."""
        for _ in range(100):
            with contextlib.suppress(ConnectionRefusedError), socket.create_connection(("127.0.0.1", port)) as client:
                time.sleep(0.5)  # the first scan puts the port in Freeport mode
                client.sendall(bytes.fromhex("0103000a0001a408"))
                return client.recv(1)
            time.sleep(0.05)
        return None

    def runs(self):
        echo, wrong = self.program(Json.ECHO, "echo.stl"), self.program("LD VB0\nMEND\n", "wrong.stl")
        faulty = self.program("// CPU 224\nLD SM0.0\nMOVR 1.5, VD20\nMOVD 0, *VD100\n"
                              "LD SM0.1\nCALL MBUS_INIT, 0, 2, 9600, 2, 0, 128, 32, 100, &VB1000, M0.1, MB1\n",
                              "faulty.stl")  # of several files: with a stand-in
        stopped = self.program("LD SM0.0\nSTOP\nMEND\n", "stopped.stl")
        good, bad = self.program(Scenarios.GOOD, "good.yaml"), self.program(Scenarios.BAD, "bad.yaml")
        gap = self.program(Scenarios.BAD + "expected_failure: not yet\n", "gap.yaml")
        hasty = self.program("LD SM0.1\nMOVB 16#1D, SMB30\nATCH 0, 8\nENI\nMEND\nINT 0\nMOVB 1, VB0\nMOVB 65, VB1\nXMT VB0, 0\nRETI\n",
                             "hasty.stl")  # answers at 300 baud before the stop bit of the request has ended
        waits = self.program("LD SM0.1\nMOVB 16#09, SMB30\nMOVB 5, SMB34\nATCH 0, 8\nATCH 1, 10\nENI\nMEND\nINT 0\nRETI\nINT 1\n"
                             "LD SM0.0\nFILL 0, VW100, 200\nFILL 0, VW100, 200\nRETI\n", "waits.stl")  # INT 0 waits for INT 1
        slave = self.program(f"program: {SLAVE}\nfunctions: [3]\nholding_registers: {{count: 1000}}\n", "slave.yaml")
        primary, secondary = os.openpty()
        self.addCleanup(os.close, primary)
        self.addCleanup(os.close, secondary)
        plant = ["--dump", "VD20", "--dump", "VB0:4", "--fault", "flip:exchange=9", "--set", "VD100=16#7F000000"]
        yield from (["check", echo, wrong], ["check", SOURCE / "tests/programs/libraries/slave.awl", "--cpu", "224"], ["import", self.program(Files.DOCUMENT, "page.txt")],
                    ["why", *Inspect.PUMP, "Pump"], ["why", *Inspect.PUMP, "Fault", "not"], ["why", *Inspect.PUMP, "Level_High", "not", "--set", "I0.0=1"],
                    ["compare", *Compare.CHANGED], ["compare", self.program("LD SM0.1\nATCH 0, 10\nENI\nMEND\nINT 0\nRETI\n", "old.stl"), SLAVE, "--cpu", "214"],
                    ["compare", EXPORTS / "timer_old.stl", EXPORTS / "timer_new.stl"], ["compare", EXPORTS / "timer_old.stl", self.program("LD I0.0\n= Q0.0\nSTOP\nMEND\n", "stops.stl"), "--runs", "1"],
                    ["compare", self.program("LD I0.0\n= Q0.0\nLD M5.0\n= M5.1\nMEND\n", "one.stl"), self.program("LD I0.0\n= Q0.0\nLD M5.0\n= M5.2\nLD M5.3\nMEND\n", "two.stl"), "--runs", "5"],
                    ["fuzz", EXPORTS / "trusting_slave.stl", "--runs", "5000", "--seconds", "60"], ["fuzz", EXPORTS / "timer_old.stl", "--runs", "1"],
                    ["compare", echo, self.program("// CPU 224\n" + Json.ECHO, "other.stl")],
                    ["inspect", self.program(self.SEQUENCE, "sequence.stl"), "steps"], ["inspect", self.program(self.SEQUENCE, "sequence.stl")],
                    ["why", self.program(self.TOLD_TWICE, "told_twice.stl"), "Q0.0"],
                    ["inspect", *Inspect.PUMP], ["inspect", SLAVE, "xref"], ["inspect", SLAVE, "xref", "VW4"], ["inspect", SLAVE, "calls"],
                    ["inspect", self.program("LD SM0.1\nDISI\nMEND\n", "disabled.stl"), "calls"],
                    ["inspect", self.program("LD I0.0\nLD I0.1\nCTU C5, 12\nTON T37, 5\nMOVB 16#81, SMB31\nMEND\n", "eeprom.stl"), "map"],
                    ["inspect", *Inspect.PUMP, "map"], ["inspect", EXPORTS / "races.awl", "races"], ["inspect", self.program(self.CALLS_ITSELF, "calls_itself.stl"), "races"],
                    ["inspect", self.program(self.CALLS_NOTHING, "calls_nothing.stl"), "map"], ["inspect", EXPORTS / "races.awl", "shared"], ["inspect", SLAVE, "bounds"], ["inspect", *Inspect.PUMP, "document"],
                    ["inspect", self.program("LD SM0.1\nMOVB 9, SMB30\nMOVB 5, SMB34\nATCH 0, 10\nATCH 1, 8\nENI\nLD M0.0\nFOR VW2, 1, VW4\nNEXT\nLD M0.0\nXMT VB9, 0\nMEND\nINT 0\nLD SM0.0\nFOR VW0, 1, AC0\nNEXT\nRETI\nINT 1\nLD SM0.0\nS M0.0, 1\nRETI\n", "loop.stl"), "bounds"], ["inspect", SOURCE / "tests/programs/libraries/slave.awl", "map"],
                    ["inspect", self.program(self.WIDE, "wide.stl"), "ladder"],
                    ["import", "--compare", self.program(Files.DRAWING.replace("LD", "LDN"), "drawn.txt")], ["run", faulty, *plant],
                    ["check", EXPORTS / "broken.awl", EXPORTS / "pump_symbols.txt"], ["convert", SLAVE, "--to", "microdos"],
                    ["run", faulty, "--for", "20ms", "--realtime"], ["send", faulty, "01", "--timeout", "10ms", *plant],
                    ["master", faulty, "slave-id", "--timeout", "10ms", *plant],
                    ["master", SLAVE, "read", "40001", "write", "40001=1", "slave-id"],
                    ["send", SOURCE / "stl_programs/text_commands.stl", "--text", "GET\\r"],
                    ["send", waits, "01020304050607", "--timeline", "--timeout", "10ms"],
                    ["send", SLAVE, "--crc", "0103000a0001", "--fault", "answer:twice"],
                    ["send", SLAVE, "0103000a00010000", "--timeline", "--timeout", "50ms"],
                    ["send", hasty, "41", "--baud", "300", "--parity", "none"], ["instructions"], ["instructions", "MOVB"], ["times"], ["times", "cpu214", "cpu214_from_22x"], ["times", "--check", "cpu214"],
                    ["times", "--band-table", "1"],
                    ["calibrate", MEASURE, "--each", "1s"], ["decode", LOG], ["import-capture", LOG],
                    ["send", SLAVE, "--crc", "0103000a0001", "--times-band", "2"], ["master", SLAVE, "read", "40001", "--times-band", "2"],
                    ["send", stopped, "01", "--times-band", "2"], ["master", stopped, "read", "40001", "--times-band", "2"],
                    ["test", good, "--times-band", "2"], ["test", good, "--coverage"], ["run", SLAVE, "--coverage"], ["run", waits, "--profile"], ["test", good, "--profile"], ["test", good, "--mutants"], ["bench", "--each", "1ms"],
                    ["test", good, bad, gap], ["test", good, "--against", SLAVE], ["test", "--conformance", slave, "--only", "SL-crc"],
                    ["test", good, "--list"], ["run", self.system(), "--for", "50ms"],
                    ["send", self.alone(), "0103000a0001", "--timeline"], ["master", self.alone(), "read", "40001"])
        yield from (["run", SLAVE, "--for", "50ms", *bridge]
                    for bridge in (["--pty", self.folder / "plc"], ["--tcp", "0"], ["--rfc2217", "0"], ["--rtu-over-tcp", "0"], ["--modbus-tcp", "0"],
                                   ["--device", os.ttyname(secondary)]))
        deaf = self.program("LD SM0.1\nMOVB 16#09, SMB30\nMEND\n", "deaf.stl")
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        threading.Thread(target=self.ask_over_tcp, args=(port,), daemon=True).start()
        yield ["run", deaf, "--for", "3s", "--tcp", str(port)]
        line = [["--fault", f"{fault}:of=answer"] for fault in ("parity", "framing")] + [["--fault", "echo"]]
        yield from (["send", SLAVE, "--crc", "0103000a0001", "--timeline", "--timeout", "50ms", *fault] for fault in line)

    def test_the_page_and_what_is_printed_agree(self):
        documented = self.documented()
        printed = {verb: set() for verb in VERBS}
        for arguments in self.runs():
            verb = arguments[0]
            with self.subTest(arguments):
                done = s7200(*arguments, "--json")
                result = json.loads(done.stdout)
                self.assertEqual(list(result)[0], "s7200")
                self.assertEqual((result["s7200"]["verb"], f"s7200 {result['s7200']['version']}\n"),
                                 (verb, s7200("--version").stdout))
                printed[verb] |= self.keys(result)
        self.assertEqual({verb: keys - documented[verb] for verb, keys in printed.items()}, {verb: set() for verb in VERBS},
                         "printed, and not on the page")
        for verb in ("debug", "view", "dap"):
            del documented[verb]
        self.assertEqual({verb: keys - printed[verb] for verb, keys in documented.items()},
                         {verb: set() for verb in VERBS if verb not in ("debug", "view", "dap")}, "on the page, and never printed")


class Compare(Case):
    CHANGED = [EXPORTS / "pump.awl", EXPORTS / "pump_new.awl",
               *(word for side, of in (("old", "pump"), ("new", "pump_new")) for part in ("symbols", "data")
                 for word in (f"--with-{side}", EXPORTS / f"{of}_{part}.txt"))]

    def test_the_exit_code_says_whether_the_cpu_gets_the_same(self):
        self.ends(FINE, "compare", SLAVE, SLAVE)
        self.ends(FAILED, "compare", *self.CHANGED)
        renamed = self.program("LD I0.0 // another comment\n= Q0.0\nMEND\n", "renamed.stl")
        self.assertIn("only what people read differs", self.ends(FINE, "compare", self.program("LD I0.0\n= Q0.0\nMEND\n", "old.stl"), renamed).stdout)

    def test_it_takes_two_programs(self):
        self.assertIn("OLD and NEW; 1 program given", self.ends(UNUSABLE, "compare", SLAVE).stderr)
        self.assertIn("3 programs given", self.ends(UNUSABLE, "compare", SLAVE, SLAVE, SLAVE).stderr)
        self.assertIn("missing.stl", self.ends(UNUSABLE, "compare", SLAVE, "missing.stl").stderr)
        self.assertIn("missing.txt", self.ends(UNUSABLE, "compare", SLAVE, SLAVE, "--with-new", "missing.txt").stderr)

    def test_a_program_with_errors_is_compared_as_far_as_it_goes(self):
        done = self.ends(FAILED, "compare", self.program("LD I0.0\n= Q0.0\nMEND\n", "old.stl"), self.program("LD I0.0\n= QB0\nMEND\n", "new.stl"))
        self.assertIn("what they are in is left out", done.stderr)
        self.assertIn("1 changed" if "same" in done.stdout else "1 network changed", done.stdout)

    def test_what_they_do_is_compared_and_written_as_a_scenario(self):
        old, new = EXPORTS / "timer_old.stl", EXPORTS / "timer_new.stl"
        written = self.folder / "timer.yaml"
        for _ in range(2):  # its own file is replaced
            self.assertIn("Q0.1: old 1, new 0", self.ends(FAILED, "compare", old, new, "--write", written).stdout)
        self.ends(FINE, "test", written)
        self.ends(FAILED, "test", written, "--target", new)
        self.assertNotIn("Behaviour", self.ends(FAILED, "compare", old, new, "--structure").stdout)
        mine = self.program("mine", "mine.yaml")
        self.assertIn("mine.yaml", self.ends(UNUSABLE, "compare", old, new, "--write", mine).stderr)
        self.assertIn("--watch", self.ends(UNUSABLE, "compare", old, new, "--watch", "VX").stderr)

    def test_it_keeps_to_100_columns(self):
        for line in self.ends(FAILED, "compare", *self.CHANGED).stdout.splitlines():
            self.assertLessEqual(len(line), 100, line)


class Fuzz(Case):
    TRUSTING = EXPORTS / "trusting_slave.stl"

    def test_what_is_found_is_written_as_scenarios_that_fail(self):
        found = self.folder / "found"
        done = self.ends(FAILED, "fuzz", self.TRUSTING, "--seconds", "10", "--runs", "5000", "--write", found)
        self.assertIn("run-time error 0006", done.stdout)
        self.assertIn("run-time error 0091", done.stdout)
        scenarios = sorted(found.iterdir())
        self.assertGreaterEqual(len(scenarios), 2)
        for scenario in scenarios:
            self.ends(FAILED, "test", scenario)

    @unittest.skipUnless(TIP.exists(), "there is no tip")
    def test_the_faults_of_the_tip_are_found_within_ten_seconds(self):
        done = self.ends(FAILED, "fuzz", TIP, "--seconds", "10", "--json")
        found = {(finding["code"], finding["by"]["instruction"].split()[0]) for finding in json.loads(done.stdout)["findings"]}
        self.assertLessEqual({("0092", "BMW"), ("0092", "BMB"), ("0006", "BMB"), ("0006", "MOVB")}, found)

    def test_a_good_program_has_no_findings_and_says_what_was_tried(self):
        good = self.program("LD I0.0\n= Q0.0\nMEND\n", "good.stl")
        self.assertIn("Nothing was found", self.ends(FINE, "fuzz", good, "--runs", "100").stdout)

    def test_rules_and_writes(self):
        program = self.program("LD I0.0\n= Q0.0\nLD I0.1\n= Q0.1\nMOVW 1, VW100\nMEND\n", "rules.stl")
        self.assertIn("never Q0.0 AND Q0.1", self.ends(FAILED, "fuzz", program, "--runs", "500", "--never", "Q0.0 AND Q0.1").stdout)
        self.assertIn("--writes", self.ends(FAILED, "fuzz", program, "--runs", "500", "--writes", "VB0..VB50").stdout)
        self.ends(FINE, "fuzz", program, "--runs", "500", "--writes", "VB0..VB50", "--writes", "VB100:2")
        for wrong in (["--never", "Q0.0 AND"], ["--writes", "QB0"], ["--writes", "VB9..VB1"]):
            self.assertIn(wrong[0], self.ends(UNUSABLE, "fuzz", program, *wrong).stderr)
        self.assertIn("cannot be run", self.ends(FAILED, "fuzz", self.program("LD VB0\nMEND\n")).stderr)
        self.ends(UNUSABLE, "fuzz", program, program)


class Coverage(Case):
    """What scenarios and runs have tried of a program."""
    FOLDER = SOURCE / "tests/programs/modbus_slave"

    def test_our_scenarios_try_every_contact_of_our_slave(self):
        shown = self.json(FINE, "test", self.FOLDER, "--coverage", "--json")["coverage"]
        self.assertEqual([one["program"] for one in shown], [str(SLAVE)])
        for what in ("networks", "instructions", "contacts", "deciding"):
            self.assertEqual(shown[0][what]["tried"], shown[0][what]["all"], what)
        self.assertEqual(shown[0]["untried"], [])
        self.assertEqual({one["why"] for one in shown[0]["constant"]}, {"SM0.0 is always 1"})

    def test_a_test_with_coverage_is_the_same_test(self):
        for arguments in (["--jobs", 1], ["--jobs", 3]):
            records = self.folder / f"without{arguments[1]}.yaml", self.folder / f"with{arguments[1]}.yaml"
            self.ends(FINE, "test", self.FOLDER, *arguments, "--record", records[0])
            self.ends(FINE, "test", self.FOLDER, *arguments, "--record", records[1], "--coverage")
            self.assertEqual(*(record.read_text(encoding="utf-8") for record in records))
        plain, covered = (self.json(FINE, "run", SLAVE, "--for", "3s", "--json", *more) for more in ([], ["--coverage"]))
        del covered["coverage"]
        self.assertEqual(plain, covered)

    def test_too_little_coverage_fails_like_a_test(self):
        some = ["test", self.FOLDER, "--only", "reads holding"]
        done = self.ends(FAILED, *some, "--coverage-at-least", "90%")
        self.assertIn("instructions 44.7%, contacts 11.4%", done.stderr)
        self.assertNotIn("never tried", done.stdout, "--coverage shows that")
        self.ends(FINE, *some, "--coverage-at-least", "11")
        self.ends(FAILED, *some, "--coverage-at-least", "12")
        self.ends(FAILED, "run", SLAVE, "--coverage-at-least", "90%")
        for wrong in ("90 %x", "-1", "101%", "nan", "half"):
            self.assertIn("is not a share from 0% to 100%", self.ends(UNUSABLE, *some, "--coverage-at-least", wrong).stderr)
        self.assertIn("leave out --against", self.ends(UNUSABLE, *some, "--coverage", "--against", SLAVE).stderr)

    def test_files_are_known_and_written_again(self):
        page, lcov, junit = (self.folder / name for name in ("page.html", "lcov.info", "junit.xml"))
        for _ in range(2):
            self.ends(FINE, "test", self.FOLDER, "--coverage-html", page, "--coverage-lcov", lcov, "--junit", junit)
        self.assertIn('<span class="tried">', page.read_text(encoding="utf-8"))
        records = lcov.read_text(encoding="utf-8")
        self.assertIn(f"SF:{SLAVE}\n", records)
        self.assertEqual(records.count("\nDA:"), int(re.search(r"\nLF:(\d+)\n", records)[1]))
        self.assertEqual(records.count("\nBRDA:"), 2 * 70)
        self.assertIn('<property name="coverage_contacts" value=', junit.read_text(encoding="utf-8"))
        own = self.program("mine", "mine.html")
        self.assertIn("mine.html", self.ends(UNUSABLE, "test", self.FOLDER, "--coverage-html", own).stderr)
        self.assertEqual(own.read_text(encoding="utf-8"), "mine")
        self.assertIn("'-' is none", self.ends(UNUSABLE, "test", self.FOLDER, "--coverage-lcov", "-").stderr)

    def test_the_profile_of_a_run_adds_up_to_its_time(self):
        folded = self.folder / "folded.txt"
        for _ in range(2):
            result = self.json(FINE, "run", SLAVE, "--for", "3s", "--profile", "--profile-folded", folded, "--json")
        profile = result["profile"][0]
        self.assertEqual(profile["time_ns"], result["time_ns"])
        self.assertEqual(sum(routine["time_ns"] for routine in profile["routines"]) + profile["system_ns"], result["time_ns"])
        self.assertEqual(sum(int(line.rsplit(" ", 1)[1]) for line in folded.read_text(encoding="utf-8").splitlines()), result["time_ns"])
        self.assertEqual(profile["scans"]["most_ns"], result["longest_scan_ns"])
        del result["profile"]
        self.assertEqual(result, self.json(FINE, "run", SLAVE, "--for", "3s", "--json"))
        shown = self.ends(FINE, "run", SLAVE, "--profile").stdout
        self.assertIn("worst: ", shown)
        self.assertLessEqual(max(map(len, shown.split("\n"))), 100, shown)

    def test_mutants_name_what_no_scenario_notices(self):
        some = ["test", self.FOLDER, "--only", "writes one coil", "--mutants"]
        shown = self.ends(FINE, *some).stdout
        self.assertIn("not noticed:", shown)
        self.assertLessEqual(max(map(len, shown.split("\n"))), 100, shown)
        one, two = (self.json(FINE, *some, "--jobs", jobs, "--json")["mutants"][0] for jobs in (1, 2))
        self.assertEqual(one, two)
        self.assertEqual(one["noticed"] + len(one["survivors"]), one["mutants"])
        self.assertEqual([each["line"] for each in one["survivors"]], sorted(each["line"] for each in one["survivors"]))
        self.assertIn("--mutants runs changed programs", self.ends(UNUSABLE, *some, "--coverage").stderr)

    def test_text_keeps_to_100_columns(self):
        for program in ([SLAVE], Inspect.PUMP):
            shown = self.ends(FINE, "run", *program, "--coverage").stdout
            self.assertIn("never tried:", shown)
            self.assertLessEqual(max(map(len, shown.split("\n"))), 100, shown)


class Inspect(Case):
    PUMP = [EXPORTS / "pump.awl", EXPORTS / "pump_symbols.txt", EXPORTS / "pump_data.txt"]

    def test_views_keep_to_100_columns_and_need_no_colour(self):
        for view in ("overview", "xref", "calls", "map", "steps", "races", "shared", "ladder", "bounds"):
            for program in ([SLAVE], self.PUMP):
                with self.subTest(view=view, program=program):
                    shown = self.ends(FINE, "inspect", *program, view).stdout
                    self.assertGreater(shown.count("\n"), 0)
                    self.assertNotIn("\x1b", shown)
                    self.assertLessEqual(max(map(len, shown.split("\n"))), 100)

    def test_a_drawn_program_reads_back_as_the_same_instructions(self):
        for program in ([SLAVE], self.PUMP):
            drawn = self.program(self.ends(FINE, "inspect", *program, "ladder").stdout, "drawn.txt")
            back = self.program(self.ends(FINE, "import", "--from", "ladder", drawn).stdout, "back.stl")
            again = self.ends(FINE, "inspect", back, "ladder").stdout
            elements = [re.sub(r"(?m)^(    [^ │┌└].*|.*, network .*|//.*)\n|^\d+", "", text) for text in (drawn.read_text(encoding="utf-8"), again)]
            self.assertEqual(*elements)

    def test_a_drawn_program_with_parameters_reads_back_with_them(self):
        path = EXPORTS / "parameters.awl"
        for source in (path, self.program(self.ends(FINE, "inspect", path, "ladder").stdout, "drawn.txt")):
            back = self.program(self.ends(FINE, "import", *(["--from", "ladder"] if source != path else []), source).stdout, "back.awl")
            self.assertIn("VAR_INPUT\n", back.read_text(encoding="utf-8"))
            self.ends(FINE, "check", back, "--cpu", "224")
            self.assertRegex(self.ends(FINE, "compare", path, back, "--cpu", "224").stdout, "The programs are the same|The CPU gets the same")

    def test_the_picture_of_the_docs_is_what_is_drawn(self):
        written = self.folder / "ladder.svg"
        for _ in range(2):  # what the option wrote it may replace
            self.ends(FINE, "inspect", SOURCE / "tests/exports/pump.awl", SOURCE / "tests/exports/pump_symbols.txt", "ladder", "MAIN", "--svg", written)
        self.assertEqual(written.read_text(encoding="utf-8"), (SOURCE / "docs/ladder.svg").read_text(encoding="utf-8"))
        own = self.program("mine", "mine.svg")
        self.assertIn("mine.svg", self.ends(UNUSABLE, "inspect", SLAVE, "ladder", "--svg", own).stderr)
        self.assertIn("no picture", self.ends(UNUSABLE, "inspect", SLAVE, "xref", "--svg", written).stderr)
        self.assertTrue(self.ends(FINE, "inspect", SLAVE, "ladder", "--ascii").stdout.isascii())

    def test_what_is_not_there_is_said_with_what_is_near(self):
        self.assertIn("there is no view 'xreff'; did you mean xref?", self.ends(UNUSABLE, "inspect", SLAVE, "xreff").stderr)
        self.assertEqual(self.ends(FINE, "inspect", SLAVE).stdout, self.ends(FINE, "inspect", SLAVE, "overview").stdout)
        self.assertIn("SBR_63", self.ends(UNUSABLE, "inspect", SLAVE, "xref", "SBR_99").stderr)
        self.assertIn("near it the program uses", self.ends(FINE, "inspect", SLAVE, "xref", "VW3").stdout)
        self.assertIn("calls keeps to routines and networks", self.ends(UNUSABLE, "inspect", SLAVE, "calls", "VW0").stderr)
        self.assertIn("cannot read", self.ends(UNUSABLE, "inspect", "missing.stl", "xref").stderr)

    def test_symbols_that_share_memory_are_worth_a_look(self):
        program = self.program("LD SM0.0\nMOVW 5, Speed\nINCB Retry\nFILL 0, Table, 4\nMOVW 1, Limit\nMOVB VB130, Low\nMEND\n", "shared.stl")
        symbols = self.program("Symbol\tAddress\nSpeed\tVW130\nRetry\tVB131\nTable\tVW200\nLimit\tVW206\nTables_first_bit\tV200.0\nLow\tVB0\n", "shared.txt")
        shown = self.ends(FINE, "inspect", program, symbols).stdout
        self.assertIn('  "Speed" has "Retry" in it, VB131: shared.stl:2, shared.stl:3\n', shown)
        self.assertIn('in shared.stl:4 begins at "Table" and goes on over "Limit"\n', shown)

    def test_a_message_or_a_table_that_may_become_longer_than_its_symbol_is_worth_a_look(self):
        text = "LD SM0.1\nMOVB {}, SMB94\nMOVW 5, Table\nLD I0.0\nRCV Buffer, 0\nATT VW2, Table\nMEND\n"
        symbols = self.program("Symbol\tAddress\nBuffer\tVB100\nStation\tVB120\nTable\tVW400\nLimit\tVW412\n", "rooms.txt")
        def shown(most):
            return self.ends(FINE, "inspect", self.program(text.format(most), "rooms.stl"), symbols, "--cpu", "224").stdout
        self.assertIn('in rooms.stl:5 begins at "Buffer" and may go on over "Station"\n', shown(20))
        self.assertNotIn('"Station"\n', shown(19))
        self.assertNotIn('"Station"\n', shown("VB90"), "how many characters it may have is not known")
        self.assertIn('in rooms.stl:6 begins at "Table" and may go on over "Limit"\n', shown(19))

    def test_the_user_may_say_how_often_a_loop_runs(self):
        program = self.program("LD SM0.0\nFOR VW0, 1, VW2\nINCW VW4\nNEXT\nMEND\n", "loop.stl")
        def bounds(*more):
            return json.loads(self.ends(FINE, "inspect", program, "bounds", "--json", *more).stdout)["files"][0]["bounds"]
        self.assertIsNone(bounds()["loops"][0]["times"])
        stated = bounds("--loop", "2=7")
        self.assertEqual(stated["loops"][0]["times"], 7)
        self.assertEqual(stated["routines"][0]["loops_without_bound"], [])
        self.assertGreater(stated["scan_ns"], bounds()["scan_ns"])
        self.assertIn("there are loops in lines 2", self.ends(UNUSABLE, "inspect", program, "bounds", "--loop", "3=7").stderr)
        self.assertIn("for example --loop 445=8", self.ends(UNUSABLE, "inspect", program, "bounds", "--loop", "2").stderr)
        self.assertIn("views bounds and document", self.ends(UNUSABLE, "inspect", program, "xref", "--loop", "2=7").stderr)

    def test_why_answers_from_a_first_scan_and_from_kept_memory(self):
        self.assertIn("2 contacts have to change:", self.ends(FINE, "why", *self.PUMP, "Pump").stdout)
        self.assertEqual(self.ends(FINE, "why", *self.PUMP, "Pump", "not", "--set", "I0.0=1", "--set", "I0.1=1").stdout, "Pump holds now\n")
        self.assertEqual(self.ends(FINE, "why", *self.PUMP, "not", "Pump").stdout, self.ends(FINE, "why", *self.PUMP, "Pump", "NOT").stdout)
        plant = self.folder / "plant.json"
        self.ends(FINE, "run", *self.PUMP, "--for", "1s", "--memory", plant, "--set", "VW10=7")
        kept = self.ends(FINE, "why", *self.PUMP, "VW10", "<", "5", "not", "--memory", plant)
        self.assertIn("VW10 < 5 does not hold: VW10 is 7", kept.stdout)
        self.assertIn("count as 0 unless --set", kept.stderr)
        self.assertIn("VW10 > 5 does not hold: VW10 is 0", self.ends(FINE, "why", *self.PUMP, "VW10", ">", "5").stdout)

    def test_why_keeps_what_is_set_where_the_first_scan_initialises_it(self):
        path = self.program("LD SM0.1\nR M0.0, 1\nLD M0.0\nA I0.0\n= Q0.0\nMEND\n")
        shown = self.ends(FINE, "why", path, "Q0.0", "not", "--set", "M0.0=1").stdout
        self.assertIn("M0.0=1 and I0.0=0", shown)
        self.assertIn("1 contact has to change:", shown)

    def test_why_takes_the_bit_of_a_timer_from_its_value_and_preset(self):
        path = self.program("LD I0.0\nTON T37, VW10\nLD I0.1\nTOF T38, 20\nLD T37\n= Q0.0\nMEND\n")
        preset = ["--set", "I0.0=1", "--set", "VW10=20"]
        self.assertIn("T37 is 1: ", self.ends(FINE, "why", path, "T37", *preset, "--set", "T37=27").stdout)
        self.assertIn("T37 is 0: in 500 ms (1.5 s of 2 s have passed)", self.ends(FINE, "why", path, "T37", *preset, "--set", "T37=15").stdout)
        self.assertEqual(self.ends(FINE, "why", path, "T37", "not", *preset, "--set", "T37=20").stdout, "T37 holds now\n")

    def test_why_says_what_it_cannot_answer(self):
        self.assertIn("an address is missing", self.ends(UNUSABLE, "why", *self.PUMP).stderr)
        self.assertIn("'XX' is not an address", self.ends(UNUSABLE, "why", *self.PUMP, "XX").stderr)
        self.assertIn("cannot use missing.json", self.ends(UNUSABLE, "why", *self.PUMP, "Pump", "--memory", "missing.json").stderr)
        self.assertIn("--set: 'Z'", self.ends(UNUSABLE, "why", *self.PUMP, "Pump", "--set", "Z=1").stderr)
        self.assertIn("takes one program", self.ends(UNUSABLE, "why", SLAVE, SOURCE / "stl_programs/scale.stl", "Q0.0").stderr)
        self.ends(FAILED, "why", EXPORTS / "broken.awl", "Q0.0")

    def test_a_program_with_errors_is_inspected_as_far_as_it_goes(self):
        done = self.ends(FAILED, "inspect", self.program("LD I0.0\nMOVW VB1, VW10\n= Q0.0\nMEND\n"), "xref")
        self.assertIn("has errors: what they are in is left out", done.stderr)
        self.assertIn("Q0.0 (output)", done.stdout)

    def test_the_document_is_one_page_of_well_formed_html_that_needs_nothing_else(self):
        symbols = self.program("<i>Name</i>\tQ0.0\t<script>\n", "symbols.txt")
        for program in ([SLAVE], self.PUMP, [self.program("LD I0.0\n= Q0.0 // </pre><b>\nMEND\n"), symbols]):
            page = self.ends(FINE, "inspect", *program, "document").stdout
            body = re.sub(r"<!doctype html>|<meta [^>]*>", "", page)
            xml.etree.ElementTree.fromstring(body)
            anchors, links = set(re.findall(r' id="([^"]+)"', page)), set(re.findall(r' href="#([^"]+)"', page))
            self.assertEqual(anchors, links)
            self.assertEqual(re.findall(r'href="(?!#)|src=|<script|<b>|<i>', page), [])

    def test_several_programs_are_shown_with_their_names(self):
        shown = self.ends(FINE, "inspect", SLAVE, SOURCE / "stl_programs/scale.stl", "xref", "SM0.0").stdout
        self.assertRegex(shown, r"(?m)^\S*modbus_slave\.stl$")
        self.assertRegex(shown, r"(?m)^\S*scale\.stl$")


class Files(Case):
    DOCUMENT = "A page of prose.\n\nNETWORK 1\nLD SM0.0 // always\nMOVB 1, VB0\nMEND\n"

    def test_import_and_read_back(self):
        document, out = self.program(self.DOCUMENT, "page.txt"), self.folder / "out.stl"
        self.ends(FINE, "import", document, "-o", out)
        written = out.read_text(encoding="utf-8")
        self.assertIn("// always", written)
        self.assertNotIn("prose", written)
        self.ends(FINE, "check", out)
        self.assertEqual(self.ends(FINE, "import", out).stdout, written)

    DRAWING = "    │ I0.0             Q0.0\n1   ├─┤   ├──────────(     )\n    │\n2   ├────────────────( MEND  )\n\nLD I0.0\n= Q0.0\nMEND\n"

    def test_drawings_are_read_and_set_against_the_stl(self):
        page = self.program(self.DRAWING, "page.txt")
        self.assertEqual(self.ends(FINE, "import", "--from", "ladder", page).stdout, "NETWORK 1\nLD      I0.0\n=       Q0.0\n\nNETWORK 2\nMEND\n")
        self.assertEqual(self.ends(FINE, "import", "--compare", page).stdout,
                         f"{page}: 2 networks drawn, 2 of them like the STL; 0 errors, 0 warnings\n")
        other = self.program(self.DRAWING.replace("LD I0.0", "LDN I0.0"), "other.txt")
        done = self.ends(FAILED, "import", "--compare", other)
        self.assertIn(f"{other}:1:", done.stderr.replace(f"{other}:2:", f"{other}:1:"))
        self.assertIn("runs under different conditions", done.stderr)
        self.assertEqual(self.json(FAILED, "import", "--compare", other, "--json")["same"], 1)
        self.assertIn("no ladder drawing", self.ends(FAILED, "import", "--from", "ladder", SLAVE).stderr)

    def test_import_leaves_existing_files_alone(self):
        document, out = self.program(self.DOCUMENT, "page.txt"), self.folder / "out.stl"
        out.write_text("mine", encoding="utf-8")
        self.assertIn("--force", self.ends(UNUSABLE, "import", document, "-o", out).stderr)
        self.assertEqual(out.read_text(encoding="utf-8"), "mine")
        self.ends(FINE, "import", document, "-o", out, "--force")
        self.assertNotEqual(out.read_text(encoding="utf-8"), "mine")

    def test_an_empty_file_holds_nothing_and_is_written(self):
        document, empty = self.program(self.DOCUMENT, "page.txt"), self.folder / "empty"
        for arguments in (["import", document, "-o"], ["run", SLAVE, "--for", "1ms", "--trace"], ["run", SLAVE, "--for", "1ms", "--memory"],
                          ["test", self.program("program: %s\nsteps: [wait: 1ms]\n" % SLAVE, "one.yaml"), "--junit"]):
            empty.write_text("", encoding="utf-8")
            self.ends(FINE, *arguments, empty)
            self.assertGreater(empty.stat().st_size, 0, arguments)

    def test_import_never_overwrites_what_it_reads(self):
        document, link = self.program(self.DOCUMENT, "page.txt"), self.folder / "link.txt"
        os.link(document, link)
        for out in (document, link):
            done = self.ends(UNUSABLE, "import", document, "-o", out, "--force")
            self.assertIn("the command reads this file", done.stderr)
        self.assertEqual(document.read_text(encoding="utf-8"), self.DOCUMENT)

    ARTICLE = ("A lamp follows a switch and tells how often it did so.\nThe switch is at the first input of the controller.\n\n"
               "NETWORK 1\nLD I0.0\n{}\n= Q0.0\nMEND\n\nNobody is liable for what it does.\n")

    def test_a_document_loses_no_statement_without_a_word(self):
        path = self.program(self.ARTICLE.format("U I0.2\nSPB 3\nCAL 50\nADL"), "damaged.txt")
        for verb in ("check", "import", "run", "send", "master", "debug", "bench"):
            more = {"send": ["01"], "master": ["slave-id"]}.get(verb, [])
            done = self.ends(FAILED, verb, path, *more)
            for line, said in ((6, "U is a German mnemonic"), (7, "SPB is a German mnemonic"), (8, "CAL is a mnemonic of IEC 61131-3"),
                               (9, "damaged STL line: ADL")):
                self.assertIn(f"{path}:{line}:1: error: {said}", done.stderr)
        listing = self.program("NETZWERK 1\nU I0.0\nSPB 3\nL 5\nT AW0\n= Q0.0\nMEND\n", "listing.txt")
        for verb in ("check", "import"):  # the heading is read; check says that AW0 is German too, import that nothing was written
            self.assertEqual(len(re.findall(": error: ", self.ends(FAILED, verb, listing).stderr)), 5)

    def test_the_text_left_out_of_a_listing_is_counted(self):
        path = self.program(self.ARTICLE.format("Page 3\nThe lamp is on from here."), "article.txt")
        said = f"s7200: note: {path}: 2 lines of its listing left out as text: 6, 7\n"
        self.assertEqual(self.ends(FINE, "check", path).stderr, said)
        self.assertIn(said, self.ends(FINE, "import", path).stderr)
        self.assertEqual(self.json(FINE, "check", path, "--json")["files"][0]["left_out"], [6, 7])
        self.assertEqual(self.json(FINE, "import", path, "--json")["left_out"], [6, 7])
        self.assertEqual(self.ends(FINE, "run", path, "--scans", "2").stderr, said)

    PUMP = [EXPORTS / "pump.awl", EXPORTS / "pump_symbols.txt", EXPORTS / "pump_data.txt"]
    TIMES = "mnemonic;form;base_us;per_unit_us;unit;marker;source\nMOVB;;80,5;;;measured;eigene Messung, Füllstand\n"

    def test_tables_of_spreadsheets_are_read_as_windows_writes_them(self):
        rows, table = "time;address;value;;\r\n0,02s;Level_High;1;;\r\n", self.folder / "table.csv"
        for encoding in ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "cp1252"):
            with self.subTest(encoding):
                table.write_bytes(rows.encode(encoding))
                done = self.ends(FINE, "run", *self.PUMP, "--input", table, "--for", "100ms", "--dump", "I0.0", "--json")
                self.assertEqual(json.loads(done.stdout)["dump"]["I0.0"]["values"], [1])
                table.write_bytes(self.TIMES.encode(encoding))
                shown = self.ends(FINE, "times", "--times", table, "--csv").stdout
                self.assertIn('MOVB,,80.5,,,measured,"eigene Messung, Füllstand"', shown)

    def test_umlauts_of_symbols_in_inputs_may_be_in_the_code_page_of_a_spreadsheet(self):
        symbols = self.program("Symbol\tAddress\nFüllstand\tAIW0\nStörung\tI0.3\n", "symbols.txt")
        program, rows = self.program("LD Störung\nMOVW Füllstand, VW0\nMEND\n"), self.folder / "in.csv"
        rows.write_bytes("10ms;Störung;1\n20ms;Füllstand;1234\n".encode("cp1252"))
        result = self.json(FINE, "run", program, symbols, "--input", rows, "--for", "100ms", "--dump", "VW0", "--json")
        self.assertEqual(result["dump"]["VW0"]["values"], [1234])

    def test_scenarios_and_yaml_in_utf_16_are_read(self):
        scenario = self.folder / "good.yaml"
        scenario.write_bytes(Scenarios.GOOD.encode("utf-16"))
        self.ends(FINE, "test", scenario)

    def test_a_symbol_stands_beside_its_address_in_a_dump(self):
        done = self.ends(FINE, "run", *self.PUMP, "--for", "200ms", "--dump", "Longest_Run", "--dump", "VW100", "--dump", '"Fault lamp"')
        self.assertIn("VW100    16#012C         300  Longest_Run\nVW100    16#012C         300\nQ0.1     0  \"Fault lamp\"\n", done.stdout)

    def test_a_table_that_cannot_be_read_makes_no_errors_of_its_symbols(self):
        done = self.ends(UNUSABLE, "check", self.PUMP[0], "missing.txt")
        self.assertNotIn("defined symbol", done.stdout + done.stderr)
        self.assertIn("pump.awl is not checked: its symbols may be in a file that cannot be read", done.stderr)
        self.assertIn("fine", self.ends(UNUSABLE, "check", SLAVE, "missing.txt").stdout)

    def test_a_table_after_the_program_of_master_is_no_action(self):
        done = self.ends(UNUSABLE, "master", self.PUMP[0], self.PUMP[1], "read", "40001")
        self.assertIn(f"'{self.PUMP[1]}' is a file, and an action is expected here; another file of the program's project is given with "
                      f"--with {self.PUMP[1]}\n", done.stderr)

    def test_single_quotes_of_the_console_of_windows_are_named(self):
        hint = "the console of Windows holds words together with double quotes only"
        for words in (["run", "'pump", "station.awl'"], ["why", SLAVE, "Q0.0", "--set", "'VW10=5'"], ["debug", SLAVE, "-x", "'print", "VB0'"]):
            with self.subTest(words):
                self.assertIn(hint, self.ends(UNUSABLE, *words).stderr)
        self.assertNotIn(hint, self.ends(UNUSABLE, "run", "missing.stl").stderr)

    DEAF = "LD SM0.1\nMOVB 16#09, SMB30\nMEND\n"

    def asked_over_tcp(self, program, *options):
        """A program that a client asks twice over a bridge, and what it prints when it ends."""
        process = subprocess.Popen([S7200, "run", str(program), "--tcp", "0", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        port = int(re.search(r":(\d+)", process.stderr.readline()).group(1))
        with socket.create_connection(("127.0.0.1", port)) as client:
            time.sleep(0.5)  # the first scan puts the port in Freeport mode
            for _ in range(2):
                client.sendall(bytes.fromhex("0103000a0001a408"))
                time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        return process.communicate(timeout=60)[0]

    def test_a_run_behind_a_bridge_says_why_requests_got_no_answer(self):
        said = self.asked_over_tcp(self.program(self.DEAF))
        self.assertRegex(said, r"why 2 requests got no answer, the first 01 03 00 0a 00 01 a4 08, sent at [\d.]+ ms:\n"
                               r"  [\d.]+ ms  no answer to 8 characters since [\d.]+ ms: event 8 is not attached; no instruction has attached it since "
                               r"power-up, and the program has no ATCH for event 8 and no RCV; SMB30, which puts the port in Freeport mode, was set at "
                               r"[\d.]+ ms by MOVB 16#9, SMB30 in line 2\n")
        self.assertNotIn("got no answer", self.asked_over_tcp(SLAVE))
        listener = self.program("LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 8\nENI\nMEND\nINT 0\nLD SM0.0\nMOVB SMB2, VB0\nRETI\n")
        self.assertNotIn("got no answer", self.asked_over_tcp(listener), "it never speaks")

    NEEDS_WITH = (["send", "--text", "x", "--timeout", "10ms"], ["master", "slave-id", "--timeout", "10ms"])

    def test_an_export_with_its_symbols_and_data_is_a_program_for_every_verb(self):
        self.assertIn("fine, 33 instructions", self.ends(FINE, "check", *self.PUMP).stdout)
        self.assertIn("fine, 33 instructions", self.ends(FINE, "check", *reversed(self.PUMP)).stdout)
        run = self.ends(FINE, "run", *self.PUMP, "--scans", "2", "--dump", "VW100", "--dump", "VB220:9").stdout
        self.assertRegex(run, r"VW100 .* 300\n")
        self.assertIn("05 44 52 41 49 4e 01 02 03", run)
        self.ends(FINE, "debug", *self.PUMP, "-x", "list")
        with_parts = [word for part in self.PUMP[1:] for word in ("--with", part)]
        for verb, *rest in self.NEEDS_WITH:
            done = self.ends(FAILED, verb, self.PUMP[0], *rest, *with_parts)  # it does not talk on its port
            self.assertNotIn("symbol", done.stderr)
        scenario = self.program(f"program: {self.PUMP[0]}\nwith: [{self.PUMP[1]}, {self.PUMP[2]}]\n"
                                "steps: [{wait: 10ms}, {memory: {VW100: 300}}]\n", "pump.yaml")
        self.ends(FINE, "test", scenario)

    def test_a_symbol_table_may_be_csv_and_a_status_chart_is_left_out_with_a_note(self):
        self.ends(FINE, "check", EXPORTS / "pump.awl", EXPORTS / "pump_symbols.csv")
        done = self.ends(FINE, "run", EXPORTS / "pump.awl", EXPORTS / "pump_symbols.csv", EXPORTS / "pump_chart.txt", "--scans", "1")
        said = "pump_chart.txt is a status chart: nothing of it is part of the program"
        self.assertIn(said, done.stderr)
        self.assertIn(said, self.ends(FINE, "check", EXPORTS / "pump.awl", EXPORTS / "pump_symbols.csv", EXPORTS / "pump_chart.txt").stderr)
        files = f"program: {EXPORTS}/pump.awl\nwith: [{EXPORTS}/pump_symbols.txt, {EXPORTS}/pump_chart.txt]\n"
        scenario = self.program(files + "steps: [{wait: 10ms}, {memory: {M0.0: 0}}]\n", "chart.yaml")
        self.assertIn(said, self.ends(FINE, "test", scenario).stderr)
        system = self.program("plcs:\n  pump:\n    " + files.replace("\n", "\n    ") + "copies: 2\nlines: {bus: {stations: [pump]}}\n",
                              "chart_system.yaml")
        self.assertEqual(self.ends(FINE, "run", system, "--for", "10ms").stderr.count(said), 1)

    def test_messages_name_the_file_the_block_and_the_network(self):
        done = self.ends(FAILED, "check", EXPORTS / "broken.awl", EXPORTS / "pump_symbols.txt")
        self.assertIn(f"{EXPORTS}/broken.awl:6:16: error: the bits of a byte are 0 to 7 (MAIN, network 2)\n", done.stderr)
        self.assertIn("on import Micro/WIN would leave out 2 networks: MAIN, network 2; Work, network 1", done.stderr)
        twice = self.program("Pump\tQ0.0\nPump\tQ0.1\n", "twice.txt")
        self.assertIn(f"{twice}:2:1: error: Pump is defined twice", self.ends(FAILED, "check", SLAVE, twice).stderr)

    def test_exports_come_in_the_encodings_of_their_countries(self):
        text = (EXPORTS / "pump.awl").read_text(encoding="utf-8").replace("// Pump", "// {}").replace("\n", "\r\n")
        for encoding, comment in (("utf-8-sig", "Pumpe für Öl"), ("utf-16", "Pumpe"), ("cp1252", "Pumpe für Öl"), ("gbk", "水泵运行"),
                                  ("cp932", "ポンプ運転中"), ("cp1251", "Насос включён")):
            path = self.folder / f"{encoding}.awl"
            path.write_bytes(text.replace("{}", comment).encode(encoding))
            self.assertIn(comment, self.ends(FINE, "import", path).stdout)
            self.ends(FINE, "run", path, EXPORTS / "pump_symbols.txt", "--scans", "1")

    def test_parameters_need_a_cpu_22x_and_run_on_it(self):
        path = EXPORTS / "parameters.awl"
        self.assertIn("they need CPU 22x; choose one, such as CPU 224", self.ends(FAILED, "check", path, "--cpu", "214").stderr)
        self.assertRegex(self.ends(FINE, "run", path, "--cpu", "224", "--scans", "2", "--dump", "VW20").stdout, r"VW20 .* 10\n")

    def test_convert_reads_back_as_the_same_program(self):
        for notation in ("iec", "microdos", "microwin", "german"):
            out = self.folder / f"{notation}.awl"
            self.ends(FINE, "convert", SLAVE, "--to", notation, "-o", out)
            self.assertIn("--force", self.ends(UNUSABLE, "convert", SLAVE, "--to", notation, "-o", out).stderr)
            answer = self.ends(FINE, "send", out, "--crc", "0103000a0002").stdout
            self.assertEqual(answer, self.ends(FINE, "send", SLAVE, "--crc", "0103000a0002").stdout)
        self.assertIn("neither an address", self.ends(FAILED, "convert", EXPORTS / "pump.awl", "--to", "iec").stderr)
        self.ends(FINE, "convert", *self.PUMP, "--to", "iec")

    def test_a_document_without_routine_ends_is_converted_for_a_cpu_22x(self):
        text = "Hi all,\nI have this on a CPU 224 and it does not work:\n\nLD SM0.1\nMOVB 16#09, SMB30\nATCH INT_0, 8\nENI\n\nINT_0:\nLD SM0.0\nMOVB SMB2, VB100\n"
        done = self.ends(FINE, "convert", self.program(text, "post.txt"), "--to", "iec")
        self.assertIn("MOVB    SMB2, VB100", done.stdout)

    def test_numbered_instructions_of_another_make_are_no_recording(self):
        text = "0 LD X000\n1 OR Y000\n2 ANI X001\n3 OUT Y000\n4 LD M8002\n5 MOV K10 D0\n6 OUT T0 K50\n7 END\n"
        self.assertIn("Mitsubishi", self.ends(FAILED, "check", self.program(text, "fx.txt")).stderr)

    def test_convert_keeps_names_among_blocks_and_writes_their_table(self):
        out, table = self.folder / "pump.awl", self.folder / "pump_symbols.txt"
        done = self.ends(FINE, "convert", *self.PUMP, "--to", "microwin", "-o", out)
        self.assertIn(f"its symbols are in {table}", done.stderr)
        self.assertIn('A       "Level low"\n', out.read_text(encoding="utf-8"))
        self.assertIn("Level low\tI0.1\tlower level switch, closed when wet\n", table.read_text(encoding="utf-8"))
        self.ends(FINE, "run", out, table, "--scans", "2")
        again = self.ends(UNUSABLE, "convert", *self.PUMP, "--to", "microwin", "-o", out)
        self.assertIn(f"{out} exists; --force overwrites it", again.stderr)
        out.unlink()
        self.assertIn(f"{table} exists; --force overwrites it", self.ends(UNUSABLE, "convert", *self.PUMP, "--to", "microwin", "-o", out).stderr)
        self.assertFalse(out.exists(), "written although its table could not be")
        self.assertIn("needs their symbol table", self.ends(FINE, "convert", *self.PUMP, "--to", "microwin").stderr)
        result = json.loads(self.ends(FINE, "convert", *self.PUMP, "--to", "microwin", "--json").stdout)
        self.assertIn("Pump\tQ0.0\tcontactor\n", result["symbols"])

    RCV = "LD SM0.1\nMOVB 16#09, SMB30\nRCV VB100, 0\nMEND\n"

    def test_the_cpu_is_what_the_head_of_the_program_says(self):
        named = self.program("// CPU 226\n" + self.RCV, "named.stl")
        done = self.ends(FINE, "check", named)
        self.assertIn("for CPU 226", done.stdout)
        self.assertNotIn("assumed", done.stderr)
        self.assertIn("for CPU 224", self.ends(FINE, "check", named, "--cpu", "224").stdout)

    def test_the_cpu_is_what_the_folder_says_if_the_program_names_none(self):
        program, settings = self.program(self.RCV), self.program("cpu: 222\n", "s7200.yaml")
        self.assertIn("for CPU 222", self.ends(FINE, "check", program).stdout)
        for text, why in (("cpu: 225\n", "s7200.yaml:1: there is no model of CPU '225'; modelled: 212"),
                          ("cpux: 224\n", "s7200.yaml:1: there is no setting 'cpux'; a folder has one: cpu"),
                          ("cpu: [\n", "s7200.yaml:1: "), ("- 224\n", "write for example cpu: 224")):
            settings.write_text(text, encoding="utf-8")
            for verb in (["check"], ["run", "--scans", "1"]):
                self.assertIn(why, self.ends(UNUSABLE, *verb, program).stderr)

    def test_the_cpu_is_the_first_that_can_run_the_program_if_nothing_names_one(self):
        program = self.program(self.RCV)
        done = self.ends(FINE, "run", program, "--scans", "1")
        self.assertIn("program.stl does not run on a CPU 214; CPU 224 is assumed, --cpu names another", done.stderr)
        plain = self.ends(FINE, "run", SLAVE, "--scans", "1")
        self.assertEqual(plain.stderr, "")
        for head, said in (("CPU 313C", "program.stl names a CPU 313C in its head, which is not modelled; CPU 224 is assumed, --cpu names another"),
                           ("CPU 226CN", "program.stl names a CPU 226 CN in its head, which is taken for a CPU 226")):
            self.assertIn(said, self.ends(FINE, "run", self.program(f"// {head}\n" + self.RCV), "--scans", "1").stderr)

    def test_scenarios_and_systems_find_the_cpu_in_the_same_way(self):
        self.program("// CPU 226\n" + self.RCV, "named.stl")
        self.program(self.RCV, "unnamed.stl")
        scenario = self.program("scenarios:\n  - {name: a, program: named.stl, port: 1, steps: [{memory: {SMB30: 9}}]}\n"
                                "  - {name: b, program: unnamed.stl, steps: [{memory: {SMB30: 9}}]}\n", "both.yaml")
        self.assertIn("unnamed.stl does not run on a CPU 214; CPU 224 is assumed", self.ends(FINE, "test", scenario).stderr)
        system = self.program("plcs:\n  a: {program: named.stl}\n  b: {program: unnamed.stl}\n"
                              "lines: {l: {stations: [a, b]}}\n", "system.yaml")
        done = self.ends(FINE, "run", system, "--for", "10ms", "--json")
        self.assertEqual([plc["cpu"] for plc in json.loads(done.stdout)["plcs"]], ["226", "224"])
        self.assertIn("PLC 'b' names no CPU", done.stderr)

    def test_a_folder_of_scenarios_may_have_settings(self):
        self.program("cpu: 224\n", "s7200.yaml")
        self.program(self.RCV, "unnamed.stl")
        self.program("program: unnamed.stl\nsteps: [{memory: {SMB30: 9}}]\n", "only.yaml")
        self.assertIn("1 scenario: 1 passed", self.ends(FINE, "test", self.folder).stdout)

    def test_outputs_go_into_waves_for_sigrok_if_the_file_ends_in_vcd(self):
        program = self.program("LD SM0.5\n= Q0.3\nMEND\n", "blink.stl")
        waves = self.folder / "outputs.vcd"
        self.ends(FINE, "run", program, "--for", "3s", "--output", waves)
        text = waves.read_text(encoding="utf-8")
        self.assertIn("$var wire 1 q0.3 Q0.3 $end", text)
        self.assertGreaterEqual(text.count("1q0.3\n"), 3)
        self.ends(FINE, "run", program, "--for", "1s", "--output", waves)  # its own file is written anew

    def test_a_wrong_table_of_times_is_reported_where_the_scenario_names_it(self):
        scenario = self.program(f"name: a\nprogram: {SLAVE}\ntimes: nosuch.csv\nsteps: [{{wait: 1ms}}]\n", "times.yaml")
        self.assertRegex(self.ends(UNUSABLE, "test", scenario).stderr, r"times\.yaml:3:8: error: cannot read .*nosuch\.csv")

    def test_convert_prints_no_program_that_is_wrong(self):
        wrong = self.program("MOVB 1000, VW0\nXYZ 5\n", "wrong.stl")
        done = self.ends(FAILED, "convert", wrong, "--to", "microwin")
        self.assertEqual(done.stdout, "")
        self.assertIn("unknown instruction 'XYZ'", done.stderr)

    def test_convert_finds_the_cpu_as_check_does(self):
        program = self.program("CPU: 224 REL 02.01\nLD I0.0\n= Q0.0\n", "head.stl")
        self.assertIn("= ", self.ends(FINE, "convert", program, "--to", "iec").stdout)
        self.assertIn("the main program has no MEND", self.ends(FAILED, "convert", program, "--cpu", "214", "--to", "iec").stderr)
        wrong = self.program("LD I0.0\nRCV VB100, 0\nMOVB VW0, VB2\n", "wrong.stl")
        for verb in (["check", wrong], ["convert", wrong, "--to", "iec"]):
            said = self.ends(FAILED, *verb).stderr
            self.assertIn("CPU 224 is assumed", said)
            self.assertEqual(said.count("error: ") - said.count("nothing was written"), 1, said)

    def test_a_recording_that_is_given_for_a_program_names_decode(self):
        rows = "".join(f'"Async Serial","data",{0.5 + i / 1000:.3f},0.001,0x{byte:02X}\n'
                       for i, byte in enumerate(bytes.fromhex("010300000001840A")))
        for name, text in (("logic.csv", "name,type,start_time,duration,data\n" + rows),
                           ("log.txt", "> 01 03 00 00 00 01 84 0A\n< 01 03 02 00 05 78 47\n")):
            recording = self.program(text, name)
            for verb in (["check"], ["run", "--for", "1ms"]):
                said = self.ends(UNUSABLE, *verb, recording).stderr
                self.assertIn(f"not a program: s7200 decode {recording}", said)
            self.ends(FINE, "decode", recording)
        for separator, point in ((",", "."), (";", ",")):
            levels = "".join(f"{i}{point}0{separator}{level}\n" for i, level in enumerate("1010"))
            self.assertIn("it is a recording of a line (levels), not a program",
                          self.ends(UNUSABLE, "check", self.program(f"Zeit [s]{separator}Kanal 0\n{levels}", "levels.csv")).stderr)
        table = self.program("Symbol,Address,Data\nPump,Q0.0,01\nLamp,Q0.1,02\n", "table.csv")
        self.ends(FINE, "check", self.program("LD Pump\n= Lamp\nMEND\n"), table)

    def test_a_ladder_drawing_has_one_message(self):
        for text, code in (("   I0.0    I0.1    Q0.0\n--] [-----]/[-----( )--\n", UNUSABLE),
                           ("LD I0.0\n= Q0.0\n--| |--|/|--( )--\n   I0.1 I0.2  Q0.1\nMEND\n", FAILED)):
            said = self.ends(code, "check", self.program(text)).stderr
            self.assertEqual(said.count("this is a ladder drawing, not STL"), 1, said)
            self.assertEqual(said.count("error: "), 1, said)

    def test_parts_of_a_project_alone_ask_for_the_rest(self):
        table = self.program("Pump\tQ0.0\n", "table.txt")
        self.assertIn("give the file with the program too", self.ends(FAILED, "check", table).stderr)
        block = self.program("SUBROUTINE_BLOCK S:SBR0\nBEGIN\nNETWORK 1\nLD SM0.0\n= M0.0\nEND_SUBROUTINE_BLOCK\n", "s.awl")
        done = self.ends(FAILED, "check", block)
        self.assertIn("there is no main program (ORGANIZATION_BLOCK)", done.stderr)
        self.assertNotIn("MEND", done.stderr)
        library = self.program("LD SM0.1\nCALL USS_INIT, 1, 1, M0.0\nMEND\n", "library.stl")
        self.assertIn("USS_INIT is a routine of the USS protocol library, which is in no export and has no stand-in here",
                      self.ends(FAILED, "check", library, "--cpu", "224").stderr)

    LIBRARY = SOURCE / "tests/programs/libraries"
    USED = "MBUS_INIT and MBUS_SLAVE are in no export: our stand-in modbus_slave.awl is used, with times of our own"

    def test_the_routines_of_a_library_have_stand_ins_in_every_verb(self):
        slave = self.LIBRARY / "slave.awl"
        answered = ["send", slave, "--cpu", "224", "--crc", "010300000001"]
        for verb in (["check", slave, "--cpu", "224"], ["run", slave, "--cpu", "224", "--scans", "2"], answered,
                     ["master", slave, "--cpu", "224", "read", "40001"], ["debug", slave, "--cpu", "224", "-x", "step 100"],
                     ["run", self.LIBRARY / "systems/line.0.yaml", "--for", "10ms"]):
            self.assertIn(self.USED, self.ends(FINE, *verb).stderr, verb)
            refused = self.ends(FAILED, verb[0], "--no-stand-ins", *verb[1:])
            self.assertIn("error: MBUS_INIT and MBUS_SLAVE are in no export", refused.stderr)
            self.assertIn("write a subroutine of this name with the same parameters", refused.stderr)
        self.assertIn("1 register: 16#0000", self.ends(FINE, *answered).stdout)

    def test_why_names_the_file_of_a_line_of_a_stand_in(self):
        said = self.ends(FAILED, "send", self.LIBRARY / "slave.awl", "--cpu", "224", "010300000001").stdout
        (place,) = re.findall(r"the contact in (stand-in:modbus_slave\.awl:\d+)", said)
        stopped = self.ends(FINE, "debug", self.LIBRARY / "slave.awl", "--cpu", "224", "-x", f"break {place}").stdout
        self.assertRegex(stopped, r"breakpoint 1 in SBR 61 stand-in:modbus_slave\.awl:\d+: LDW<> ")

    def test_scenarios_say_which_stand_ins_they_had(self):
        steps = "steps: [{read: holding 0, expect: accepted}]\n"
        of_program = self.program(f"program: {self.LIBRARY}/slave.awl\ncpu: 224\nafter: 20ms\n{steps}", "library.yaml")
        of_system = self.program(f"system: {self.LIBRARY}/systems/line.0.yaml\n"
                                 "steps: [{wait: 20ms}, {errors: none, on: slave}]\n", "system.yaml")
        for scenario in (of_program, of_system):
            self.assertEqual(self.ends(FINE, "test", scenario, scenario).stderr.count(self.USED), 1)
            self.assertIn("MBUS_INIT and MBUS_SLAVE are in no export", self.ends(UNUSABLE, "test", scenario, "--no-stand-ins").stdout)

    def test_check_json_names_the_stand_ins_and_their_memory(self):
        (checked,) = self.json(FINE, "check", self.LIBRARY / "slave.awl", "--cpu", "224", "--json")["files"]
        self.assertEqual(checked["stand_ins"], [{"file": "stand-in:modbus_slave.awl", "routines": ["MBUS_INIT", "MBUS_SLAVE"],
                                                 "memory": "VB7822:370"}])

    def test_convert_leaves_the_calls_of_a_library_to_micro_win(self):
        converted = self.ends(FINE, "convert", self.LIBRARY / "small_slave.stl", "--to", "microwin").stdout
        self.assertIn("CALL    MBUS_INIT, 1, 5, 19200", converted)
        self.assertNotIn("mb_crc", converted)
        self.ends(FINE, "check", self.program(converted, "converted.awl"), "--cpu", "224")

    def test_a_stand_in_may_be_changed_and_given_with_the_program(self):
        libraries = SOURCE / "stl_programs/libraries"
        files = [libraries / name for name in ("modbus_slave.awl", "modbus_crc.awl", "modbus_slave_symbols.csv", "port_0_symbols.csv")]
        done = self.ends(FINE, "check", self.LIBRARY / "slave.awl", *files, "--cpu", "224")
        self.assertEqual(done.stderr, "")
        self.assertIn("fine", done.stdout)

    def test_symbols_name_memory_in_scenarios_too(self):
        program = self.program("LD SM0.0\nINCW VW20\nMEND\n", "count.stl")
        table = self.program("Counter\tVW20\n", "names.txt")
        scenario = self.program(f"program: {program}\nwith: [{table}]\nset: {{Counter: 5}}\n"
                                "steps: [{wait: 10ms}, {memory: {Counter: 6..}}]\n", "counter.yaml")
        self.ends(FINE, "test", scenario)

    def test_convert_writes_the_code_page_of_a_windows(self):
        german, out = self.program("LD SM0.0 // für\n= M0.0\nMEND\n", "fuer.stl"), self.folder / "fuer.awl"
        self.ends(FINE, "convert", german, "--to", "microwin", "--encoding", "Windows-1252", "-o", out)
        self.assertIn("// für".encode("windows-1252"), out.read_bytes())
        self.ends(FINE, "check", out)
        chinese = self.program("MEND // 中\n", "chinese.stl")
        done = self.ends(UNUSABLE, "convert", chinese, "--to", "iec", "--encoding", "Windows-1252", "-o", self.folder / "c.stl")
        self.assertIn("the character U+4E2D does not exist in Windows-1252; nothing was written", done.stderr)
        self.assertFalse((self.folder / "c.stl").exists())

    def test_symbols_name_memory_to_set_and_to_show(self):
        table = self.program("Speed\tVW20\n\"Pump 1\"\tQ0.3\n", "names.txt")
        done = self.ends(FINE, "run", SLAVE, table, "--scans", "1", "--set", "Speed=7", "--dump", "speed", "--dump", '"Pump 1"')
        self.assertRegex(done.stdout, r'VW20 .* 7  speed\nQ0\.3 .* 0  "Pump 1"\n')
        self.assertIn("'Spood' is not an address or a symbol; did you mean Speed?",
                      self.ends(UNUSABLE, "run", SLAVE, table, "--set", "Spood=1").stderr)

    def test_a_byte_order_mark_is_no_part_of_a_text(self):
        mark = "\ufeff"
        inputs, frames = self.program(mark + "1ms,I0.0,1\n", "in.csv"), self.program(mark + "0103000a0001\n", "frames.txt")
        commands = self.program(mark + "step\n", "commands.txt")
        times = self.program(mark + self.ends(FINE, "times", "--csv").stdout, "times.csv")
        self.ends(FINE, "run", SLAVE, "--input", inputs, "--times", times, "--scans", "2")
        self.ends(FINE, "send", SLAVE, "--crc", "--frames", frames)
        self.ends(FINE, "debug", SLAVE, "--commands", commands)
        with open(commands, encoding="utf-8") as script:
            self.ends(FINE, "debug", SLAVE, stdin=script)
        self.ends(FINE, "test", self.program(f"{mark}program: {SLAVE}\ninput: {inputs}\nsteps: [wait: 1ms]\n", "scenario.yaml"))
        kept = self.folder / "kept.json"
        self.ends(FINE, "run", SLAVE, "--memory", kept)
        kept.write_text(mark + kept.read_text(encoding="utf-8"), encoding="utf-8")
        self.ends(FINE, "run", SLAVE, "--memory", kept)

    def test_import_that_fails_writes_nothing(self):
        out = self.folder / "out.stl"
        self.ends(FAILED, "import", self.program("LD SM0.0\nMOVB 16#, VB0\nMEND\n"), "-o", out)
        self.assertFalse(out.exists())

    def test_trace_overwrites_only_traces(self):
        path, out = self.program(Json.ECHO), self.folder / "run.trace"
        self.ends(FINE, "run", path, "--trace", out, "--scans", "3")
        self.ends(FINE, "run", path, "--trace", out, "--trace-instructions", "--scans", "3")
        self.assertIn("MOVB", out.read_text(encoding="utf-8"))
        mine = self.program("mine\n", "mine.txt")
        self.assertIn("left alone", self.ends(UNUSABLE, "run", path, "--trace", mine).stderr)
        self.assertEqual(mine.read_text(encoding="utf-8"), "mine\n")
        self.assertIn("SMB30 = 16#09", self.ends(FINE, "run", path, "--trace", "-", "--scans", "3").stdout)

    def test_a_trace_ends_with_what_rcv_still_waits_for(self):
        path = self.program("LD SM0.1\nMOVB 9, SMB30\nMOVB 16#B0, SMB87\nMOVB 16#0D, SMB89\nMOVW 5, SMW90\nMOVB 10, SMB94\n"
                            "RCV VB100, 0\nMEND\n")
        self.assertIn("     60.000000  the run ends, and RCV at port 0 still waits for the first character of a message; the line has been idle for 5 ms\n",
                      self.ends(FINE, "run", path, "--cpu", "224", "--for", "60ms", "--trace", "-").stdout)
        self.assertIn("RCV at port 0 still waits for the end of its message: the character 16#0D or 10 characters (2 so far)\n",
                      self.ends(FAILED, "send", path, "41 42", "--cpu", "224", "--after", "50ms", "--trace", "-").stdout)
        self.assertNotIn("the run ends", self.ends(FINE, "run", SLAVE, "--for", "60ms", "--trace", "-").stdout)

    def test_a_stream_that_is_not_the_protocol_is_said_with_what_is_wrong(self):
        for stream, said in (("hello\r\n", "'hello' is not a line of a header"), ("Content-Length: 99999999\r\n\r\n", "is longer than"),
                             ("Content-Length: 5\r\n\r\n{", "has ended within a message"),
                             ("Content-Length: 5\r\n\r\nhello", "'hello' is not JSON"),
                             ("Content-Length: 3\r\n\r\n[5]", "'[5]' is not a JSON object")):
            done = self.ends(UNUSABLE, "dap", stdin=None, input=stream)
            self.assertRegex(done.stderr, f"^s7200: error: standard input .*{re.escape(said)}")
        initialize = 'Content-Length: 54\r\n\r\n{"seq": 1, "type": "request", "command": "initialize"}'
        for wrong in ("hello\r\n", "Content-Length: 99999999\r\n\r\n", "Content-Length: 5\r\n\r\nhello"):
            done = self.ends(FINE, "dap", stdin=None, input=initialize + wrong + initialize)
            self.assertEqual(done.stdout.count('"supportsStepBack":true'), 2, "the session lives")
            self.assertIn('"event":"output","body":{"category":"stderr","output":"skipped what is not a message: ', done.stdout)
            self.assertEqual(done.stderr, "")
        self.assertEqual(self.ends(FINE, "dap", stdin=None, input="").stdout, "")
        done = self.ends(FINE, "dap", stdin=None, input='Content-Length: 54\r\n\r\n{"seq": 1, "type": "request", "command": "initialize"}')
        self.assertTrue(done.stdout.startswith("Content-Length: "))
        self.assertIn('"supportsStepBack":true', done.stdout)

    def test_what_the_libraries_say_reaches_nobody(self):
        for arguments, said in ((("run", SLAVE, "--for"), "--for needs a value: TIME"), (("run",), "PROGRAM is missing"),
                                (("run", SLAVE, "--for", "1s", "--for", "2s"), "--for stands here 2 times, and takes one value"),
                                (("run", SLAVE, "--parity", "frob"), "--parity: frob is not one of "),
                                (("import", SLAVE, "--as", "frob"), "--as"), (("run", SLAVE, "--frob", "7"), "there is no option --frob"),
                                (("run", SLAVE, "--trace-events"), "--trace-events requires --trace"),
                                (("dap", "--listen", "0", "--allow", "frob"), "'frob' is not an attribute that writes or opens something")):
            self.assertIn(said, self.ends(UNUSABLE, *arguments).stderr)

    def test_a_server_of_other_computers_is_refused(self):
        self.assertIn("only this computer itself is served", self.ends(UNUSABLE, "dap", "--listen", "0.0.0.0:0").stderr)

    def test_a_saved_session_is_loaded_with_the_same_options_only_and_names_those_that_differ(self):
        rows, saved = self.program("10ms,I0.0,1\n", "inputs.csv"), self.folder / "saved.json"
        path = self.program("LD SM0.1\nMOVB 9, SMB30\nLD I0.0\n= Q0.0\nMEND\n")
        given = ("--input", rows, "--fault", "noise:ber=1e-9", "--set", "VW20=5", "--gap", "2ms", "--clock", "2026-11-21 10:00:00")
        self.ends(FINE, "debug", path, *given, "-x", f"continue 20ms; save {saved}")
        self.ends(FINE, "debug", path, *given, "-x", f"load {saved}; expect Q0.0 and VW20 = 5")
        done = self.ends(UNUSABLE, "debug", path, "-x", f"load {saved}")
        for said in ("it was saved with other options: --gap 2 ms (here none)", "--clock 26-11-21 10:00:00 (here ",
                     "--fault noise:ber=1e-09 (here none)", "--set VW20=5 (here none)", "--input with digest "):
            self.assertIn(said, done.stderr)
        other = self.program("10ms,I0.1,1\n", "other.csv")
        done = self.ends(UNUSABLE, "debug", path, "--input", other, *given[2:], "-x", f"load {saved}")
        self.assertRegex(done.stderr, r"other options: --input with digest \w+ \(here with digest \w+\)")

    def test_the_debugger_has_the_plant_around_the_cpu_too(self):
        files = {option: self.folder / name for option, name in {
            "--trace": "run.trace", "--output": "outputs.csv", "--capture": "line.pcap", "--memory": "memory.json"}.items()}
        rows = self.program("10ms,I0.0,1\n", "inputs.csv")
        path = self.program("LD SM0.1\nMOVB 9, SMB30\nLD I0.0\n= Q0.0\nTODR VB100\nMEND\n")
        done = self.ends(FINE, "debug", path, "--set", "VW20=16#1234", "--input", rows, "--clock", "2026-11-21 10:00:00", "--fault",
                         "noise:ber=1e-9", *itertools.chain(*files.items()), "--dump", "VB100:8", "-x",
                         "continue 20ms; print VW20; send 01 02; continue 100ms")
        self.assertIn("16#1234", done.stdout)
        self.assertRegex(done.stdout, r"(?m)^VB100 +26 11 21 10 00 00 00 07")
        self.assertIn("Q0.0", files["--output"].read_text(encoding="utf-8"))
        self.assertIn("SMB30 = 16#09", files["--trace"].read_text(encoding="utf-8"))
        self.assertGreater(len(files["--capture"].read_bytes()), 24)  # more than the head of a file of frames
        self.assertEqual(json.loads(files["--memory"].read_text(encoding="utf-8"))["clock"]["year"], 26)

    def test_what_the_debugger_plays_again_is_recorded_once(self):
        records = []
        for commands in ("continue 100ms; send 01 03 00 0a 00 02 crc; continue; continue 100ms",
                         "continue 100ms; at 20ms; rs; step 3; at end; send 01 03 00 0a 00 02 crc; continue; at 110ms; rc; who SMB2; "
                         "at end; continue 100ms"):
            names = [self.folder / f"{len(records)}.{kind}" for kind in ("trace", "vcd", "pcap")]
            self.ends(FINE, "debug", SLAVE, "--trace", names[0], "--capture", names[1], "--capture", names[2], "-x", commands)
            records.append([name.read_bytes() for name in names])
        self.assertEqual(records[0], records[1])

    def test_a_branch_goes_on_in_traces_and_ends_captures_and_says_so(self):
        trace, vcd = self.folder / "run.trace", self.folder / "line.vcd"
        done = self.ends(FINE, "debug", SLAVE, "--trace", trace, "--capture", vcd, "-x",
                         "continue 100ms; at 20ms; set VW0=1; send 01; continue 90ms")
        self.assertIn("a new branch begins here; what ran up to 100.", done.stdout)
        self.assertIn("run.trace, ", done.stdout)
        self.assertIn("traces go on with what is new, after what ran before; captures of the line end", done.stdout)
        times = [int(line[1:]) for line in vcd.read_text(encoding="utf-8").split("\n") if line.startswith("#")]
        self.assertEqual(times, sorted(times))
        self.assertLess(times[-1], 101_000_000)

    def test_a_session_with_a_fault_of_the_line_is_recorded_as_a_scenario(self):
        recorded = self.folder / "faulted.yaml"
        self.ends(FINE, "debug", SLAVE, "-x", "continue 100ms; fault flip:character=3,bit=5; send 01 03 00 0a 00 01 crc; continue; "
                  f"fault none; send 01 03 00 0a 00 01 crc; continue; record {recorded}")
        self.assertIn("fault: flip:character=3,bit=5", recorded.read_text(encoding="utf-8"))
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_session_whose_line_has_faults_from_the_start_is_recorded_as_a_scenario(self):
        recorded = self.folder / "from_the_start.yaml"
        self.ends(FINE, "debug", SLAVE, "--fault", "flip:character=3,bit=5", "--fault", "missing:of=answer,character=2", "-x",
                  f"continue 100ms; send 01 03 00 0a 00 01 crc; continue; record {recorded}")
        text = recorded.read_text(encoding="utf-8")
        self.assertIn("fault: flip:character=3,bit=5", text)
        self.assertIn("fault: missing:", text)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_session_at_port_1_is_recorded_as_a_scenario(self):
        recorded = self.folder / "port1.yaml"
        program = self.program("LD SM0.1\nMOVB 16#09, SMB130\nATCH 1, 25\nENI\nMEND\nINT 1\nLD SM0.0\nMOVB SMB2, VB1\nMOVB 1, VB0\nXMT VB0, 1\nRETI\n", "port1.stl")
        self.ends(FINE, "debug", program, "--cpu", "226", "--port", "1", "-x", f"continue 100ms; send 41; continue; record {recorded}")
        self.assertIn("port: 1", recorded.read_text(encoding="utf-8"))
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_place_that_is_set_or_displayed_twice_stands_once_in_a_recorded_scenario(self):
        recorded = self.folder / "twice.yaml"
        self.ends(FINE, "debug", SLAVE, "-x", "continue 100ms; set VB2000=5 VW2000=1 VB2000=7; continue 100ms; display VB2000:2; "
                  f"display VB2001; record {recorded}")
        text = recorded.read_text(encoding="utf-8")
        self.assertIn("set: {VW2000: 16#0001, VB2000: 16#07}", text)
        self.assertIn("memory: {VB2000: 16#07, VB2001: 16#01}", text)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_session_with_power_cycles_is_recorded_as_a_scenario(self):
        for power, kept in (("power 1h", 9), ("power lost", 0)):
            recorded = self.folder / f"{power.replace(' ', '_')}.yaml"
            self.ends(FINE, "debug", SLAVE, "-x", f"set MB14=9 VW20=16#1234; continue 100ms; {power}; expect MB14 = {kept}; continue 100ms; "
                      f"set VW20=16#4321; {power}; set VW20=5; continue 100ms; send 01 03 00 0a 00 01 crc; continue; display MB14 VW20; "
                      f"record {recorded}")
            text = recorded.read_text()
            again = self.ends(UNUSABLE, "debug", SLAVE, "-x", f"record {recorded}")
            self.assertIn(f"{recorded} exists; 'record {recorded} !' replaces it", again.stderr)
            self.assertEqual(recorded.read_text(), text, "somebody may have added to it")
            self.assertEqual(text.count("power_cycle: memory " + ("kept" if kept else "lost")), 2, text)
            self.assertIn(f"MB14: 16#{kept:02X}", text)
            self.ends(FINE, "test", recorded)
        system = SOURCE / "stl_programs/systems/two_masters.yaml"
        done = self.ends(UNUSABLE, "debug", system, "-x", f"continue 20ms; power all; continue 20ms; record {self.folder}/system.yaml")
        self.assertIn("power was switched off and on, for which scenarios of a system have no step", done.stderr)
        saved = self.folder / "saved.json"
        self.ends(FINE, "debug", SLAVE, "-x", f"continue 20ms; power; continue 20ms; save {saved}")
        done = self.ends(UNUSABLE, "debug", SLAVE, "-x", f"load {saved}; record {self.folder}/loaded.yaml")
        self.assertIn("loaded after power had been switched off", done.stderr)

    def test_what_was_expected_before_power_went_off_is_recorded_too(self):
        program = self.program("LD I0.0\n= Q0.0\nMEND\n", "power.stl")
        session = "input I0.0=1; continue 100ms; expect Q0.0 = 1; power 1s; print Q0.0; continue 100ms; power; "
        for end, expected in (("record", ["Q0.0: 16#1", "Q0.0: 16#0"]),
                              ("continue 20ms; expect QB0 = 1; record", ["Q0.0: 16#1", "Q0.0: 16#0", "QB0: 16#01"]),
                              ("back 2; continue 20ms; expect QB0 = 1; record", ["Q0.0: 16#1", "Q0.0: 16#0", "QB0: 16#01"])):
            recorded = self.folder / "before.yaml"
            done = self.ends(FINE, "debug", program, "-x", f"{session}{end} {recorded} !")
            self.assertNotIn("left out", done.stdout)
            text = recorded.read_text(encoding="utf-8")
            self.assertEqual([step.replace('"', "") for step in re.findall(r"- memory: \{(.*)\}", text)], expected, text)
            self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_session_in_which_requests_were_given_up_is_recorded_as_a_scenario(self):
        ask = "send 01 03 00 0a 00 01 crc; "
        recorded = self.folder / "given_up.yaml"
        self.ends(FINE, "debug", SLAVE, "-x", f"continue 100ms; {ask} send cancel; continue 20ms; {ask} continue 3ms; send cancel; continue 100ms; "
                  f"{ask} continue 10ms; send cancel; continue 100ms; {ask} continue; display VW20; record {recorded}")
        text = recorded.read_text(encoding="utf-8")
        self.assertEqual(text.count("- send:"), 3, text)
        self.assertIn("- send: 01 03 00\n", text)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)
        done = self.ends(FINE, "debug", SLAVE, "-x", f"continue 100ms; {ask} continue 25ms; send cancel; continue 100ms; record {recorded} !")
        self.assertIn("left out: a request was given up within its answer at ", done.stdout)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)
        advised = re.search(r"'(at [\d.]+ ms)', 'fork' and 'continue' lead to the end of that answer; then record", done.stdout)
        done = self.ends(FINE, "debug", SLAVE, "-x", f"continue 100ms; {ask} continue 25ms; send cancel; {advised[1]}; fork; continue; record {recorded} !")
        self.assertIn("answer   01 03 02", done.stdout)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_request_right_after_one_that_was_given_up_is_recorded_as_a_scenario(self):
        recorded, ask = self.folder / "joined.yaml", "send 01 03 00 0a 00 01 crc; "
        at_once = f"continue 100ms; send 02 03 04; continue 1500us; send cancel; {ask} continue; continue 10ms; "
        self.ends(FINE, "debug", SLAVE, "-x", f"{at_once} record {recorded}")
        self.assertIn("- send: 02 03 01 03 00 0a 00 01 a4 08\n", recorded.read_text(encoding="utf-8"))
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)
        done = self.ends(FINE, "debug", SLAVE, "--gap", "2ms", "-x", f"{at_once.replace('1500us', '3500us')} record {recorded} !")
        self.assertIn("which no step can do with gaps between characters: 'continue 20ms' before 'send'", done.stdout)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_what_is_forced_and_the_mode_are_recorded_and_replay_to_the_same_answers(self):
        recorded = self.folder / "forced.yaml"
        ask = "send 01 03 00 0a 00 01 crc; continue; continue 10ms; "
        done = self.ends(FINE, "debug", SLAVE, "-x", f"continue 100ms; force VW20=16#4711 I0.3=1; {ask} mode stop; continue 50ms; mode run; continue 100ms; "
                         f"{ask} set VW20=5; {ask} unforce I0.3; unforce all; set VW20=6; {ask} display VW20 I0.3; record {recorded}")
        self.assertNotIn("left out", done.stdout)
        text = recorded.read_text(encoding="utf-8")
        for step in ("- force: {VW20: 16#4711, I0.3: 16#1}", "- set_mode: stop", "- set_mode: run", "- unforce: [I0.3]", "- unforce: [VW20]"):
            self.assertIn(step, text)
        self.assertEqual(text.count("02 47 11 4b b8"), 3, "what is forced, after the change to RUN and after 'set' too")
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)
        stopped = self.folder / "stopped.yaml"
        self.ends(FINE, "debug", SLAVE, "-x", f"continue 100ms; mode stop; continue 50ms; record {stopped}")
        self.assertIn("1 passed", self.ends(FINE, "test", stopped).stdout)

    def test_a_session_with_a_system_whose_line_has_faults_from_the_start_is_recorded(self):
        system = self.program(f"plcs:\n  slave: {{program: {SLAVE}, copies: 2, station: 4}}\n"
                              "lines:\n  bus: {stations: [slave], faults: ['flip:character=3,bit=5,exchange=1']}\n", "system.yaml")
        recorded = self.folder / "faulted.yaml"
        ask = "send 04 03 00 0a 00 01 crc; continue; continue 10ms; "
        done = self.ends(FINE, "debug", system, "-x", f"continue 100ms; {ask} force VW20=7; fault parity station=slave1; {ask} fault none; {ask} "
                         f"mode stop; display VW20; continue 10ms; record {recorded}")
        self.assertNotIn("left out", done.stdout)
        text = recorded.read_text(encoding="utf-8")
        self.assertEqual(text.count("expect: silence"), 1, text)
        self.assertIn("- set_mode: stop\n        on: slave1", text)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_part_of_an_accumulator_on_display_is_recorded_as_the_whole(self):
        program = self.program("LD SM0.1\nMOVD 16#12345678 AC1\nMEND\n", "part.stl")
        self.ends(FINE, "debug", program, "-x", f"continue 10ms; display AC1:byte; record {self.folder}/part.yaml")
        self.assertIn("memory: {AC1: 16#12345678}", (self.folder / "part.yaml").read_text(encoding="utf-8"))
        self.ends(FINE, "test", self.folder / "part.yaml")

    def test_what_cannot_be_recorded_is_left_out_and_says_what_to_do(self):
        ask, record = "send 01 03 00 0a 00 01 crc; ", f"record {self.folder / 'late.yaml'} !"
        done = self.ends(UNUSABLE, "debug", SLAVE, "-x", f"continue 100ms; {ask} continue 3ms; {record}")
        self.assertIn("a request is under way: 01 03 00 0a 00 01 a4 08; 'continue' runs to its end, 'send cancel' gives it up; then record", done.stderr)
        done = self.ends(FINE, "debug", SLAVE, "-x", f"continue 100ms; {ask} continue 3ms; set VW20=5; continue; display VW20; {record}")
        self.assertIn("1 passed", self.ends(FINE, "test", self.folder / "late.yaml").stdout)
        self.assertIn("left out: how it stands at the end, which is another without the rest: ", done.stdout)
        self.assertRegex(done.stdout, r"left out: what was done at 10\d\.\d+ ms came while a request or its answer was under way, .*: do it before 'send', or after")
        done = self.ends(FINE, "debug", SLAVE, "-x", f"continue 100ms; {ask} break sent; continue; continue 1ms; set VW20=5; continue; {record}")
        self.assertRegex(done.stdout, r"under way, .*: do it before 'send', or after the answer and the silence that ends it")

    def test_record_after_rwhy_says_how_the_whole_session_is_recorded(self):
        path = self.folder / "unanswered.yaml"
        session = "continue 1s; break unanswered; send 02 03 00 0a 00 01 crc; continue; rwhy"
        done = self.ends(UNUSABLE, "debug", SLAVE, "-x", f"{session}; record {path}")
        self.assertRegex(done.stderr, r"a request is under way: 02 03 .*; 'at end' goes to 20\d\d\.\d+ ms, up to where it has run; then record")
        self.ends(FINE, "debug", SLAVE, "-x", f"{session}; at end; record {path}")
        self.assertIn("expect: silence", path.read_text(encoding="utf-8"))
        self.assertIn("1 passed", self.ends(FINE, "test", path).stdout)
        done = self.ends(FINE, "debug", SLAVE, "-x", f"{session}; at 500ms; expect VW20 = 0; record {path} !")
        self.assertRegex(done.stdout, r"what has run after that, up to 20\d\d\.\d+ ms, is not in it: 'at end' goes there")

    def test_what_is_done_directly_at_the_end_of_an_answer_of_a_system_is_recorded_as_a_scenario(self):
        system = self.program(f"plcs: {{s: {{program: {SLAVE}, station: 1, copies: 6}}, m: {{program: {SOURCE}/stl_programs/modbus_master.stl, cpu: 224}}}}\n"
                              "lines: {l: {stations: [s]}, k: {stations: [m]}}\n", "several.yaml")
        recorded = self.folder / "directly.yaml"
        ask = "; ".join(f"station s{n}; send 0{n} 03 00 0a 00 01 crc; continue" for n in (3, 1, 6, 3))
        self.ends(FINE, "debug", "--at", "s1", system, "-x", f"continue 100ms; {ask}; station s1; set VW20=4; {ask}; record {recorded}")
        self.assertEqual(recorded.read_text(encoding="utf-8").count("- send:"), 8)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_session_is_recorded_from_a_station_of_another_line_than_that_of_the_last_request(self):
        system = self.program(f"plcs: {{a: {{program: {SLAVE}, station: 1}}, b: {{program: {SLAVE}, station: 1}}}}\n"
                              "lines: {one: {stations: [a]}, two: {stations: [b]}}\n", "lines.yaml")
        self.ends(FINE, "debug", "--at", "b", system, "-x", "continue 100ms; send 01 03 00 0a 00 01 crc; continue; station a; send 01 03 00 00 00 05 crc; "
                  f"continue; station b; record {self.folder / 'other.yaml'}")

    def test_a_recorded_session_expects_what_was_printed_and_expected_and_lets_answers_be_late(self):
        recorded = self.folder / "lives.yaml"
        self.ends(FINE, "debug", SLAVE, "-x", "continue 100ms; send 01 06 00 0a 12 34 crc; continue; continue 20ms; print VW20; expect VW20 = 16#1234; "
                  f"continue 20ms; set VW20=7; continue 20ms; print VW20; record {recorded}")
        text = recorded.read_text(encoding="utf-8")
        self.assertIn("tolerance: 5 ms", text)
        self.assertRegex(text, r'memory: \{"?VW20"?: "?16#1234"?\}')
        self.assertRegex(text, r'memory: \{"?VW20"?: "?16#0007"?\}')
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_session_that_would_test_nothing_is_not_recorded(self):
        for commands in ("continue 10ms", "continue 10ms; set VW20=5; continue 10ms", "break 40; regs"):
            done = self.ends(UNUSABLE, "debug", SLAVE, "-x", f"{commands}; record {self.folder / 'empty.yaml'}")
            self.assertIn("so it would test nothing; 'expect VW100 = 5' or 'display VW100' first says what", done.stderr)
            self.assertFalse((self.folder / "empty.yaml").exists())

    def test_a_red_test_opens_in_the_debugger_at_its_failed_step(self):
        program = self.program("LD SM0.0\nMOVW 7, VW0\nMEND\n")
        scenarios = self.program(f"program: {program}\nscenarios:\n- {{name: fine, steps: [wait: 1ms, memory: {{VW0: 7}}]}}\n"
                                 "- name: it's red\n  steps:\n  - wait: 50ms\n  - set: {VW4: 9}\n  - wait: 10ms\n  - memory: {VW0: 5}\n  - wait: 1s\n", "red.yaml")
        failed = self.ends(FAILED, "test", scenarios).stdout
        self.assertRegex(failed, r"VW0 is 7, expected 5; last written at [0-9.]+ ms by MOVW 7, VW0 in line 2\n")
        (command,) = re.findall(r"debug     s7200 (debug .*)", failed)
        done = self.ends(FINE, *shlex.split(command), "-x", "why; who VW0; print VW4; past")
        self.assertIn("'it's red' fails in ", done.stdout)
        self.assertIn("VW0 is 7, expected 5", done.stdout)
        self.assertRegex(done.stdout, r"7\d\.\d+ ms  scan ")
        self.assertRegex(done.stdout, r"VW4 +16#0009 +9\n")
        passes = self.ends(FINE, "debug", scenarios, "--only", "fine", "-x", "print VW0").stdout
        self.assertIn("'fine' passes; this is its end", passes)
        self.assertIn("--cpu is about a program", self.ends(UNUSABLE, "debug", scenarios, "--cpu", "214", "-x", "regs").stderr)
        self.assertIn("--only is about a file of scenarios", self.ends(UNUSABLE, "debug", program, "--only", "x", "-x", "regs").stderr)

    PLACE_OF_REPORT = '<script id="report" type="text/plain">'

    def command_with_page(self, page):
        """A copy of the command with that page beside it, as an installed one has it."""
        (self.folder / "bin").mkdir()
        (self.folder / "share/s7200").mkdir(parents=True)
        shutil.copy(S7200, self.folder / "bin/s7200")
        if page is not None:
            (self.folder / "share/s7200/page.html").write_text(page, encoding="utf-8")
        return self.folder / "bin/s7200"

    def report_of(self, path):
        """What a report carries."""
        text = path.read_text(encoding="utf-8")
        packed = text.split(self.PLACE_OF_REPORT)[1].split("</script>")[0]
        return json.loads(zlib.decompress(base64.b64decode(packed)))

    def test_a_report_has_the_program_and_what_came_from_outside(self):
        beginning = "<!DOCTYPE html>\n<!-- s7200: the page with its engine -->\n"
        command = self.command_with_page(f"{beginning}<body>{self.PLACE_OF_REPORT}</script></body>\n")
        out = self.folder / "report.html"

        def run(*words):
            done = subprocess.run([command, *words, "--report", out], capture_output=True, text=True, check=False, timeout=120)
            self.assertLess(done.returncode, UNUSABLE, done.stderr)
            return self.report_of(out)

        report = run("run", SLAVE, "--for", "50ms", "--set", "VW20=5", "--clock", "2026-11-21 10:00:00")
        (only,) = report["runs"]
        self.assertEqual((report["verb"], only["options"]["set"], only["options"]["clock"]), ("run", ["VW20=5"], "2026-11-21 10:00:00"))
        self.assertEqual(report["programs"][0][0]["text"], pathlib.Path(SLAVE).read_text(encoding="utf-8"))
        self.assertEqual((only["recordings"][0]["count"], only["recordings"][0]["end"][2] // 1_000_000), (0, 50))
        report = run("send", SLAVE, "--crc", "0103000a0002", "0103000a0002", "--set", "VW20=5")
        recording = report["runs"][0]["recordings"][0]
        self.assertEqual((recording["count"], [action["send"] for action in recording["actions"]]), (2, ["01 03 00 0a 00 02 e4 09"]))
        report = run("master", SLAVE, "read", "40001", "--every", "1s", "--count", "3", "--fault", "parity:exchange=2")
        self.assertEqual((report["runs"][0]["recordings"][0]["count"], len(report["runs"][0]["options"]["fault"])), (3, 1))
        report = run("debug", SLAVE, "-x", "continue 20ms; set VW20=7; continue 20ms")
        self.assertEqual(report["runs"][0]["recordings"][0]["actions"], [{"set": [["VW20", 7]]}])
        scenarios = self.program(f"program: {SLAVE}\nscenarios:\n- {{name: fine, steps: [wait: 1ms]}}\n"
                                 "- {name: red, steps: [wait: 1ms, memory: {VW20: 5}]}\n", "both.yaml")
        report = run("test", scenarios)
        self.assertEqual([one["outcome"] for one in report["runs"]], ["passed", "failed"])
        self.assertEqual(len(report["programs"]), 1, "the program of both is there once")
        self.assertEqual((report["runs"][1]["findings"][0]["recording"], report["runs"][1]["findings"][0]["line"]), (0, 4))
        with_band = self.program(f"program: {SLAVE}\nrobust: 100%\nsteps:\n  - {{read: holding 0, expect: [0], latency: ..16ms}}\n", "share.yaml")
        (of_band,) = run("test", with_band)["runs"]
        self.assertEqual(len(of_band["recordings"]), 1, "the run with the table that failed")
        self.assertIn("times", of_band["options"], "which is not that of the CPU")
        self.assertRegex(of_band["findings"][1]["text"], r"latency.*; with ")
        self.assertEqual(of_band["findings"][1]["recording"], 0)
        fast = self.program(FAST_SLAVE, "fast.stl")
        for verb in (["send", SLAVE, "--crc", "0103000a0002"], ["master", SLAVE, "read", "40011"], ["send", fast, "--crc", LONG_REQUEST]):
            (of_band,) = run(*verb, "--times-band", "20")["runs"]
            self.assertEqual([list(one)[0] for one in of_band["recordings"][0]["actions"]], ["send"])
            self.assertEqual("times" in of_band["options"], fast in verb, "the first table that failed, else the one in use")
        plant = SOURCE / "tests/recordings/plant.log"
        report = run("decode", plant)
        printed = json.loads(subprocess.run([command, "decode", plant, "--json"], capture_output=True, check=False, timeout=120).stdout)
        self.assertEqual((report["runs"], report["conversation"]), ([], printed))
        out.write_text("mine", encoding="utf-8")
        done = subprocess.run([command, "run", SLAVE, "--report", out], capture_output=True, text=True, check=False, timeout=120)
        self.assertEqual((done.returncode, out.read_text(encoding="utf-8")), (UNUSABLE, "mine"))

    def test_a_report_without_the_page_says_what_makes_it(self):
        command = self.command_with_page(None)
        out = self.folder / "report.html"

        def refused(*words):
            done = subprocess.run([command, *words, "--report", out], capture_output=True, text=True, check=False, timeout=120)
            self.assertEqual((done.returncode, out.exists()), (UNUSABLE, False))
            return done.stderr

        self.assertIn("share/s7200/page.html", refused("run", SLAVE))
        self.assertIn("the package of s7200 has it", refused("run", SLAVE))
        (self.folder / "CMakeCache.txt").write_text("", encoding="utf-8")
        self.assertIn(f"make it with: cmake --build {self.folder} --target page_file", refused("run", SLAVE))
        self.assertIn("share/s7200/page.html", refused("run", SOURCE / "stl_programs/systems/gateway.yaml"))
        for verb in (["send", SLAVE, "01"], ["master", SLAVE, "read", "40001"]):
            self.assertIn("share/s7200/page.html", refused(*verb, "--times-band", "2"))

    def test_signals_over_time_are_written_as_waves_and_tables(self):
        program = self.program("LD SM0.0\nINCW VW10\nLDW>= VW10, 3\n= Q0.0\nMEND\n")
        waves, table, events = self.folder / "a.vcd", self.folder / "a.csv", self.folder / "a.json"
        run = ["run", program, "--scans", "5"]
        self.ends(FINE, *run, "--trace", waves, "--signals", "Q0.0,VW10")
        self.assertRegex(waves.read_text(encoding="utf-8"), r"(?s)\$var wire 1 ! Q0\.0 \$end\n\$var wire 16 \" VW10 \$end\n.*\n1!\n")
        self.ends(FINE, *run, "--trace", table, "--signals", "VW10", "--signals", "Q0.0")
        first, *rows = table.read_text(encoding="utf-8").splitlines()
        self.assertEqual(first, "time_ms,VW10,Q0.0")
        self.assertEqual([row.split(",")[1:] for row in rows], [["0", "0"], ["1", "0"], ["2", "0"], ["3", "0"], ["3", "1"], ["4", "1"], ["5", "1"]])
        self.ends(FINE, *run, "--trace", events, "--signals", "VW10")
        counters = [event["args"]["value"] for event in json.loads(events.read_text(encoding="utf-8")) if event["ph"] == "C"]
        self.assertEqual(counters, [0, 1, 2, 3, 4, 5])
        for words, why in ((["--trace", waves], "a trace as .vcd shows signals: name some"),
                           (["--trace", self.folder / "a.txt", "--signals", "VW10"], "--signals are shown by a trace as .vcd, .csv or .json"),
                           (["--trace", waves, "--signals", "VB0:4"], "VB0:4 is several values; name each"),
                           (["--signals", "VW10"], "--signals requires --trace")):
            self.assertIn(why, self.ends(UNUSABLE, *run, *words).stderr)
        system = SOURCE / "stl_programs/systems/gateway.yaml"
        self.assertIn("a trace of a whole system is text or .jsonl", self.ends(UNUSABLE, "run", system, "--for", "1s", "--trace", events).stderr)

    def test_records_end_at_a_limit_that_is_said_before(self):
        out, run = self.folder / "trace.txt", ["run", SLAVE, "--for", "1h", "--trace-instructions", "--trace"]
        done = s7200(*run, out, "--record-limit", "4MB", "--json")
        self.assertEqual(done.returncode, UNUSABLE)
        self.assertRegex(done.stderr, r"note: \S*trace\.txt would have about [\d.]+ GB at the end, and the run ends when it has 4 MB; --record-limit")
        self.assertRegex(done.stderr, r"error: \S*trace\.txt has reached 4 MB and ends there; --record-limit lets records grow further")
        self.assertEqual(json.loads(done.stdout)["stop_reason"], "record limit")
        self.assertLess(json.loads(done.stdout)["time_ns"], 60e9)
        text = out.read_bytes()
        self.assertTrue(3.9e6 < len(text) <= 4e6 and text.endswith(b"\n"), len(text))
        short = ["run", SLAVE, "--for", "100ms", "--trace-instructions", "--trace", out]
        self.assertNotIn("--record-limit", self.ends(FINE, *short).stderr)
        self.ends(FINE, *short, "--record-limit", "none")
        self.ends(UNUSABLE, *short, "--record-limit", "10KB")
        self.assertIn("'5' is not a size: write 500MB, 20GB or none", self.ends(UNUSABLE, *short, "--record-limit", "5").stderr)
        system = SOURCE / "stl_programs/systems/gateway.yaml"
        self.assertIn("has reached 10 KB", self.ends(UNUSABLE, "run", system, "--for", "5s", "--trace", self.folder / "all.txt", "--record-limit", "10KB").stderr)

    # What the description of the Trace Event Format wants of each kind of event besides name, ph, pid and tid.
    OF_EVENT = {"M": {"args"}, "i": {"ts", "s"}, "C": {"ts", "args"}, "X": {"ts", "dur"}, "s": {"ts", "id", "cat"}, "f": {"ts", "id", "cat", "bp"}}

    def test_a_trace_for_chrome_keeps_the_rules_of_its_format(self):
        out = self.folder / "a.json"
        for words in (["send", SLAVE, "--crc", "0103000a0002", "0106000a1234"], ["run", SLAVE, "--for", "50ms"]):
            self.ends(FINE, *words, "--trace", out, "--signals", "VW20,INT,Q0.0")
            events, flows, lanes = json.loads(out.read_text(encoding="utf-8")), {}, {}
            for event in events:
                self.assertLessEqual(self.OF_EVENT[event["ph"]] | {"name", "ph", "pid", "tid"}, set(event), event)
                self.assertGreaterEqual(event.get("ts", 0), 0)
                if event["ph"] == "M":
                    self.assertIn(event["name"], ("process_name", "thread_name", "process_sort_index", "thread_sort_index"))
                elif event["ph"] == "i":
                    self.assertIn(event["s"], ("g", "p", "t"))
                elif event["ph"] == "C":
                    self.assertTrue(all(isinstance(value, (int, float)) for value in event["args"].values()), event)
                elif event["ph"] == "X":
                    lanes.setdefault((event["pid"], event["tid"]), []).append((event["ts"], event["ts"] + event["dur"]))
                else:
                    flows.setdefault((event["cat"], event["name"], event["id"]), []).append((event["ts"], event["ph"]))
            for flow in flows.values():
                self.assertEqual([ph for _, ph in flow], ["s", "f"])
                self.assertLessEqual(flow[0][0], flow[1][0])
            for slices in lanes.values():  # of a thread they nest or follow each other
                for (_, end), (begin, _) in zip(sorted(slices), sorted(slices)[1:]):
                    self.assertLessEqual(end, begin + 1e-6)

    def test_a_mistake_in_a_scenario_is_written_for_continuous_integration(self):
        out = self.folder / "results.xml"
        typo = self.program(f"program: {SLAVE}\nsteps:\n  - {{reed: holding 0}}\n", "typo.yaml")
        self.ends(UNUSABLE, "test", typo, "--junit", out)
        suites = xml.etree.ElementTree.parse(out).getroot()
        self.assertEqual((suites.get("errors"), suites.get("failures")), ("1", "0"))
        (case,) = suites.iter("testcase")
        self.assertEqual((case.get("file"), case.get("line")), (str(typo), "3"))
        self.assertEqual(case.find("error").get("message"), "there is no step 'reed'")

    def test_send_and_master_say_why_each_request_got_no_answer(self):
        bad = ["01 03 00 0a 00 01 00 00"]
        done = self.ends(FAILED, "send", SLAVE, *bad)
        self.assertRegex(done.stdout, r"why 01 03 00 0a 00 01 00 00, sent at [0-9.]+ ms, got no answer:\n  ")
        self.assertIn("JMP 255 in line 141 (LDW= AC0, 0: ", done.stdout)
        self.assertNotIn("what led here", done.stdout)
        self.assertIn("JMP 255 in line 141", self.json(FAILED, "send", SLAVE, *bad, "--json")["why"][0])
        self.assertNotIn("why ", self.ends(FINE, "send", SLAVE, "--crc", "0103000a0001").stdout)
        done = self.ends(FAILED, "master", SLAVE, "read", "40011", "--station", "9", "--timeout", "200ms")
        self.assertRegex(done.stdout, r"why 09 03 00 0a 00 01 a5 40, sent at [0-9.]+ ms, got no answer:\n")
        self.assertIn("the request was for station 9; the program compared its first character with 1: LDB= SMB2", done.stdout)
        self.assertIn("why", self.json(FAILED, "master", SLAVE, "read", "40011", "--station", "9", "--timeout", "200ms", "--json"))

    def test_requests_that_got_no_answer_for_the_same_reason_are_counted(self):
        frames = ["01 03 00 0a 00 01 00 00", "02 03 00 0a 00 01 a4 3b", "01 06 00 0a 00 01 00 00 00", "00 06 00 0a 00 01 69 d9"]
        done = self.ends(FAILED, "send", SLAVE, *frames, "--timeout", "200ms")
        self.assertEqual(done.stdout.count("why "), 2, done.stdout)  # a broadcast has no answer
        self.assertRegex(done.stdout, r"why 2 requests got no answer, the first 01 03 00 0a 00 01 00 00, sent at [0-9.]+ ms:\n  ")
        self.assertRegex(done.stdout, r"why 02 03 00 0a 00 01 a4 3b, sent at [0-9.]+ ms, got no answer:\n  ")
        unanswered = self.json(FAILED, "send", SLAVE, *frames, "--timeout", "200ms", "--json")["unanswered"]
        self.assertEqual([one["requests"] for one in unanswered], [2, 1])
        self.assertEqual([one["first"] for one in unanswered], ["0103000a00010000", "0203000a0001a43b"])
        several = self.program("LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\nMOVB 2, VB200\nMEND\nINT 0\nLDB= SMB2, 16#42\nLDN I0.0\nALD\nXMT VB200, 0\n"
                               "LDB= SMB2, 16#43\nA M0.0\nXMT VB200, 0\nRETI\n", "several.stl")
        unanswered = self.json(FAILED, "send", several, "44", "42", "43", "45", "--set", "I0.0=1", "--timeout", "50ms", "--json")["unanswered"]
        self.assertEqual([(one["first"], one["requests"]) for one in unanswered], [("44", 2), ("42", 1), ("43", 1)])
        many = self.ends(FAILED, "send", SLAVE, *["02 03 00 0a 00 01 a4 3b"] * 52, "--timeout", "10ms").stdout
        self.assertIn("why 50 requests got no answer", many)
        self.assertIn("2 requests more got no answer, for which no cause was looked for\n", many)

    def test_in_a_system_the_station_concerned_says_why_it_did_not_answer(self):
        system = self.program(f"plcs: {{slave: {{program: {SLAVE}, station: 1, copies: 3}}}}\n"
                              "lines: {bus: {stations: [slave]}}\nevents: [{at: 10ms, power_off: slave3}]\n", "bus.yaml")
        done = self.ends(FAILED, "send", system, "02 03 00 0a 00 01 00 00", "03 03 00 0a 00 01 a5 ea", "09 03 00 0a 00 01 a5 40", "--timeout", "200ms")
        self.assertRegex(done.stdout, r"why 02 03 00 0a 00 01 00 00, sent at [0-9.]+ ms, got no answer:\n  slave2: [0-9.]+ ms  .*JMP 255 in line 141")
        self.assertRegex(done.stdout, r"  slave3: [0-9.]+ ms  slave3 has been without power since 10\.[0-9]+ ms: 'slave3: power off', in the system file\n")
        self.assertIn("the request was for station 9; slave1 is station 1; no S7-200 on this line is station 9\n", done.stdout)
        done = self.ends(FAILED, "master", system, "read", "40011", "--station", "3", "--timeout", "200ms")
        self.assertIn("slave3 has been without power since", done.stdout)

    def test_without_an_s7_200_it_is_said_that_causes_cannot_be_told(self):
        done = self.ends(FAILED, "send", SOURCE / "tests/programs/systems/other_plcs.yaml", "--at", "plant", "01 03 00 00", "--timeout", "100ms")
        self.assertIn("why an answer is missing cannot be told: ", done.stderr)

    def test_a_failed_step_of_a_system_has_its_cause_and_opens_in_the_debugger(self):
        system = self.program(f"plcs: {{slave: {{program: {SLAVE}, station: 1, copies: 2}}}}\nlines: {{bus: {{stations: [slave]}}}}\n", "bus.yaml")
        scenarios = self.program(f"system: {system}\nstation: 2\ntimeout: 200ms\nscenarios:\n"
                                 "- name: dark\n  steps:\n  - power_off: slave2\n  - {read: holding 10, expect: [0]}\n"
                                 "- name: memory\n  steps:\n  - {write: holding 10, values: [7]}\n  - memory: {VW20: 9}\n    on: slave2\n"
                                 "- name: late\n  steps:\n  - {read: holding 10, latency: ..1ms}\n", "red.yaml")
        failed = self.ends(FAILED, "test", scenarios).stdout
        said = " ".join(failed.split())  # a report is as wide as the terminal
        self.assertRegex(said, r"slave2: [0-9.]+ ms slave2 has been without power since [0-9.]+ ms: 'slave2: power off', from outside ")
        self.assertRegex(said, r"VW20 of slave2 is 7, expected 9; last written at [0-9.]+ ms by ")
        self.assertRegex(said, r"slave2: [0-9.]+ ms [0-9.]+ ms: until .*came to XMT")
        commands = [shlex.split(command) for command in re.findall(r"debug     s7200 (debug .*)", failed)]
        self.assertEqual(len(commands), 3)
        opened = self.ends(FINE, *commands[1], "-x", "why; station slave1; regs").stdout
        self.assertIn("'memory' fails in ", opened)
        self.assertRegex(opened, r"VW20 is .*; last written at [0-9.]+ ms by ")
        self.assertIn("slave2 has been without power since", self.ends(FINE, *commands[0], "-x", "station slave2; why").stdout)
        refused = self.ends(UNUSABLE, *commands[0], "-x", f"save {self.folder / 'x.session'}").stderr
        self.assertIn("cannot save: a step of the scenario did 'slave2: power off'", refused)
        out = self.folder / "red.xml"
        data = self.json(FAILED, "test", scenarios, "--json", "--junit", out)
        whys = ["\n".join(scenario["findings"][0]["why"]) for scenario in data["scenarios"]]
        text = " ".join(html.unescape(out.read_text(encoding="utf-8")).split())
        for why in whys:
            self.assertTrue(why)
            self.assertIn(" ".join(why.splitlines()[0].split()), text)

    def test_one_dash_or_two_an_option_that_is_none_is_refused_alike(self):
        self.assertIn("there is no option -jsno; did you mean --json?", self.ends(UNUSABLE, "send", SLAVE, "01", "-jsno").stderr)
        self.assertIn("there is no option -q\n", self.ends(UNUSABLE, "check", SLAVE, "-q").stderr)

    def test_what_was_looked_at_at_the_instant_of_an_exchange_is_recorded_too(self):
        recorded = self.folder / "instant.yaml"
        done = self.ends(FINE, "debug", SLAVE, "-x", "continue 100ms; send 01 06 00 0a 12 34 crc; print VW20; continue; print VW20; "
                         f"send 01 03 00 0a 00 01 crc; continue; expect VW20 = 16#1234; continue 20ms; record {recorded}")
        self.assertNotIn("left out", done.stdout + done.stderr)
        text = recorded.read_text(encoding="utf-8")
        self.assertEqual(len(re.findall(r"memory:.*VW20", text)), 3, text)
        self.assertLess(text.index("memory:"), text.index("- send:"))
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)
        other = self.program(text.replace("    steps:", "    times: cpu214_from_22x\n    steps:"), "other.yaml")
        self.assertIn("1 passed", self.ends(FINE, "test", other).stdout)  # with other execution times, and so latencies

    def test_an_option_that_is_nearly_one_is_offered(self):
        self.assertIn("there is no option --cup; did you mean --cpu?", self.ends(UNUSABLE, "check", SLAVE, "--cup", "224").stderr)
        self.assertIn("there is no option --jsno; did you mean --json?", self.ends(UNUSABLE, "send", SLAVE, "01", "--jsno").stderr)

    def test_files_of_a_project_are_words_where_nothing_else_stands_behind_the_program(self):
        for verb in ("check", "run", "debug", "view"):
            self.assertIn("there is no option --with here; other files of the project are named behind PROGRAM",
                          self.ends(UNUSABLE, verb, SLAVE, "--with", "symbols.txt").stderr)

    def test_quotes_that_the_console_of_windows_hands_on(self):
        self.assertIn("\'VW0 begins with a single quote", self.ends(UNUSABLE, "run", SLAVE, "\'VW0", ">", "3\'").stderr)
        self.assertIn('C:\\plant" has a double quote in it', self.ends(UNUSABLE, "run", SLAVE, 'C:\\plant"').stderr)
        self.assertNotIn("quote", self.ends(UNUSABLE, "run", SLAVE, "--set", 'VB0="a"b').stderr)

    def test_what_is_done_at_the_instant_of_a_request_is_recorded_in_front_of_it(self):
        recorded = self.folder / "at_once.yaml"
        self.ends(FINE, "debug", SLAVE, "-x", "continue 100ms; send 01 03 00 0a 00 01 crc; set VW3300=7; fault parity:character=2,exchange=2; continue; "
                  f"continue 10ms; record {recorded}")
        text = recorded.read_text(encoding="utf-8")
        self.assertLess(text.index("VW3300=7" if "VW3300=7" in text else "VW3300"), text.index("- send:"), text)
        self.assertLess(text.index("- fault:"), text.index("- send:"), text)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_of_two_requests_at_one_instant_one_is_recorded_and_the_message_says_what_to_do(self):
        system = self.program(f"plcs: {{a: {{program: {SLAVE}, station: 1}}, b: {{program: {SLAVE}, station: 1}}}}\n"
                              "lines: {one: {stations: [a]}, two: {stations: [b]}}\n", "lines.yaml")
        ask, record = "send 01 03 00 0a 00 01 crc; ", f"continue 1ms; record {self.folder / 'two.yaml'} !"
        done = self.ends(FINE, "debug", "--at", "a", system, "-x", f"continue 100ms; {ask} station b; {ask} continue; continue 100ms; {record}")
        self.assertRegex(done.stdout, r"left out: the request of 100\.\d+ ms was sent while another one or its answer was under way, .*: "
                         r"'continue' to the end of that answer before the next 'send'")
        self.ends(FINE, "debug", "--at", "a", system, "-x", f"continue 100ms; {ask} continue; continue 1ms; station b; {ask} continue; {record}")

    def test_what_is_done_directly_at_a_time_out_of_a_system_is_recorded_as_a_scenario(self):
        system = self.program(f"plcs: {{s: {{program: {SLAVE}, station: 1, copies: 2}}}}\nlines: {{l: {{stations: [s]}}}}\n", "pair.yaml")
        recorded = self.folder / "directly.yaml"
        self.ends(FINE, "debug", system, "-x", "continue 1s; send 09 03 00 0a 00 01 crc; continue; send 02 03 00 0a 00 01 crc; continue; "
                  f"send 09 03 00 0a 00 01 crc; continue; set VW20=4; continue 1ms; record {recorded}")
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_fault_of_one_station_is_recorded_as_a_scenario(self):
        system = self.program(f"plcs: {{s: {{program: {SLAVE}, station: 1, copies: 2}}}}\nlines: {{l: {{stations: [s]}}}}\n", "pair.yaml")
        recorded = self.folder / "of_station.yaml"
        self.ends(FINE, "debug", system, "-x", "continue 100ms; fault parity:character=3 station=s2; send 02 03 00 0a 00 01 crc; continue; "
                  f"continue 10ms; record {recorded}")
        self.assertIn("station: s2", recorded.read_text(encoding="utf-8"))
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_a_recorded_session_is_no_json(self):
        done = self.ends(UNUSABLE, "debug", SLAVE, "-x", f"continue 10ms; record {self.folder}/x.json")
        self.assertIn("record writes a scenario in YAML: name it .yaml; 'save' writes a session in JSON", done.stderr)
        self.assertFalse((self.folder / "x.json").exists())

    def test_power_of_one_plc_of_a_system_is_recorded_as_a_scenario(self):
        recorded = self.folder / "power.yaml"
        system = self.program(f"plcs: {{s: {{program: {SLAVE}, station: 1, copies: 2}}}}\nlines: {{l: {{stations: [s]}}}}\n", "pair.yaml")
        self.ends(FINE, "debug", system, "-x", "continue 100ms; station s2; power off; send 02 03 00 0a 00 01 crc; continue; power on; "
                  f"continue 100ms; send 02 03 00 0a 00 01 crc; continue; continue 10ms; record {recorded}")
        text = recorded.read_text(encoding="utf-8")
        self.assertIn("power_off: s2", text)
        self.assertIn("power_on: s2", text)
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)

    def test_ctrl_c_ends_the_commands_of_a_debugger_and_says_how_many_are_not_done(self):
        commands = self.program("set VW20=1\nwatch VW4000; continue 1000h; set VW20=2\n\nset VW20=3  # and more\n", "commands")
        process = subprocess.Popen([S7200, "debug", SLAVE, "--commands", commands, "-x", "set VW20=4; set VW20=5"],
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        out, error = process.communicate(timeout=120)
        self.assertEqual(process.returncode, FAILED, out + error)
        self.assertIn("interrupted by Ctrl-C", out)
        self.assertEqual(re.findall(r"not done any more: (\d) commands", out), ["2", "2"])
        self.assertNotIn("set VW20=2", out)

    def test_a_script_of_the_debugger_with_expectations_is_a_test(self):
        good = self.program("continue 100ms\nsend 01 03 00 0a 00 01 crc\ncontinue\nexpect VW3300 = 7\n", "good")
        self.ends(FINE, "debug", SLAVE, "--commands", good)
        bad = self.program("continue 100ms\nexpect VW3290 = 66\n", "bad")
        self.assertIn("bad:2: expected VW3290 = 66, which does not hold here: VW3290 is ", self.ends(FAILED, "debug", SLAVE, "--commands", bad).stderr)

    def test_captures_overwrite_only_captures_of_their_kind(self):
        path = self.program(Json.ECHO)
        for name in ("line.vcd", "line.pcap"):
            out = self.folder / name
            self.ends(FINE, "send", path, "ab", "--capture", out)
            first = out.read_bytes()
            self.ends(FINE, "run", path, "--scans", "3", "--capture", out)
            self.assertLess(len(out.read_bytes()), len(first))
            self.ends(FINE, "send", path, "ab", "--capture", out)
            self.assertEqual(out.read_bytes(), first)
        vcd, pcap = (self.folder / "line.vcd").read_bytes(), (self.folder / "line.pcap").read_bytes()
        for mine in (b"mine", vcd, pcap.replace(b"\x20\x1c", b"\xff\xff", 1)):
            other = self.folder / "mine.pcap"
            other.write_bytes(mine)
            self.assertIn("left alone", self.ends(UNUSABLE, "run", path, "--capture", other).stderr)
            self.assertEqual(other.read_bytes(), mine)

    def test_captures_that_cannot_be(self):
        path, vcd = self.program(Json.ECHO), self.folder / "line.vcd"
        for name in ("line.txt", "line", "line.VCD2", "-", "line.pcapng"):
            stderr = self.ends(UNUSABLE, "run", path, "--capture", vcd, "--capture", self.folder / name).stderr
            self.assertIn("neither in .vcd", stderr)
            self.assertFalse(vcd.exists(), "nothing is written when one of them cannot be")
        twice = self.folder / "sub" / ".." / "line.vcd"
        (self.folder / "sub").mkdir()
        self.assertIn("twice", self.ends(UNUSABLE, "run", path, "--capture", vcd, "--capture", twice).stderr)
        self.assertIn("cannot write", self.ends(UNUSABLE, "run", path, "--capture", self.folder / "no/line.vcd").stderr)
        self.assertIn("twice", self.ends(UNUSABLE, "run", path, "--trace", vcd, "--signals", "M0.0", "--capture", vcd).stderr)

    def test_captures_do_not_depend_on_slices(self):
        path, captures = self.program(Json.ECHO), []
        for options in ([], ["--realtime"]):
            names = [self.folder / f"line{len(captures)}.{kind}" for kind in ("vcd", "pcap")]
            self.ends(FINE, "run", path, "--for", "60ms", "--capture", names[0], "--capture", names[1], *options)
            captures.append([name.read_bytes() for name in names])
        self.assertEqual(captures[0], captures[1])
        self.assertTrue(captures[0][0].endswith(b"#60000000\n"), captures[0][0])

    def test_what_is_observed_does_not_change(self):
        path = self.program(Json.ECHO)
        plain = self.ends(FINE, "run", path, "--for", "100ms", "--json").stdout
        sent = self.ends(FINE, "send", path, "ab", "cd", "--json").stdout
        for watch in (["--trace", self.folder / "t"], ["--trace", self.folder / "t", "--trace-instructions"],
                      ["--capture", self.folder / "t.vcd", "--capture", self.folder / "t.pcap"]):
            self.assertEqual(self.ends(FINE, "run", path, "--for", "100ms", "--json", *watch).stdout, plain)
            self.assertEqual(self.ends(FINE, "send", path, "ab", "cd", "--json", *watch).stdout, sent)

    def test_unwritable_output(self):
        document, path = self.program(self.DOCUMENT, "page.txt"), self.program(Json.ECHO)
        nowhere = self.folder / "no/such/folder/file"
        self.assertIn("cannot write", self.ends(UNUSABLE, "import", document, "-o", nowhere).stderr)
        self.assertIn("cannot write", self.ends(UNUSABLE, "run", path, "--trace", nowhere).stderr)
        if os.path.exists("/dev/full"):
            self.assertIn("cannot write", self.ends(UNUSABLE, "import", document, "-o", "/dev/full", "--force").stderr)
            self.ends(UNUSABLE, "run", path, "--trace", "/dev/full")
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = self.ends(UNUSABLE, "instructions", capture_output=False, stdout=full, stderr=subprocess.PIPE)
                self.assertIn("cannot write", done.stderr)

    def test_closed_output(self):
        # `s7200 … | head` ends at once and quietly, also when standard output was closed from the beginning.
        def shell(command):
            return subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=60, check=False)
        path = shlex.quote(str(self.program(Json.ECHO)))
        for arguments in ("instructions", "times --csv", f"run {path} --trace - --for 1s"):
            done = shell(f"{shlex.quote(S7200)} {arguments} | head -n 1")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            done = shell(f"{shlex.quote(S7200)} {arguments} >&-")
            self.assertEqual(done.returncode, UNUSABLE, arguments)
            self.assertIn("cannot write", done.stderr)

    def test_times_can_be_corrected(self):
        csv = self.folder / "times.csv"
        csv.write_text(self.ends(FINE, "times", "--csv").stdout, encoding="utf-8")
        path = self.program("LD SM0.0\nMOVB 1, VB0\nMEND\n")
        scan = ["run", path, "--scans", "1", "--json"]
        before = self.json(FINE, *scan)["time_ns"]
        self.assertEqual(self.json(FINE, *scan, "--times", csv)["time_ns"], before)
        lines = csv.read_text(encoding="utf-8").split("\n")
        corrected = [re.sub(r"^MOVB,([^,]*),[^,]*", r"MOVB,\1,1030", line) for line in lines]
        csv.write_text("\n".join(corrected), encoding="utf-8")
        self.assertEqual(self.json(FINE, *scan, "--times", csv)["time_ns"], before + 1_000_000)
        csv.write_text("mnemonic,form\nMOVB,,30\n", encoding="utf-8")
        self.assertIn(f"{csv}:", self.ends(UNUSABLE, "run", path, "--times", csv).stderr)

    def test_the_clock_goes_on_between_runs_while_power_is_off(self):
        clock = self.program("LD SM0.0\nTODR VB100\nMEND\n")
        memory = self.folder / "memory.json"

        def run(*options, code=FINE):
            done = self.ends(code, "run", clock, "--scans", 1, "--memory", memory, "--dump", "VB100:8", *options)
            return re.search(r"(?m)^VB100 .*", done.stdout).group(0) if code == FINE else done.stderr

        self.assertIn("26 11 21 10 00 00 00 07", run("--clock", "2026-11-21 10:00:00"))
        self.assertIn("26 11 21 10 00 00 00 07", run())
        self.assertIn("26 11 22 12 00 00 00 01", run("--power-off", "26h"))
        self.assertIn("90 01 01 00 00 00 00 01", run("--ram-lost"))
        self.assertIn("--ram-lost excludes --power-off", run("--power-off", "1h", "--ram-lost", code=UNUSABLE))
        self.ends(UNUSABLE, "run", clock, "--scans", 1, "--power-off", "1h")

    def test_a_word_over_a_byte_of_special_memory_runs_with_a_warning(self):
        program = self.program("LD SM0.1\nMOVB 16#09, SMB30\nMOVB 16#A0, SMB87\nMOVB 13, SMB89\nMOVW 20, SMW94\nLDB<> SMB86, 0\nRCV VB100, 0\nMEND\n")
        done = self.ends(FINE, "check", program, "--cpu", "224")
        self.assertIn(":5:10: warning: SMB94 is a byte: this writes 0 into it [unused-sm]\n", done.stderr)
        self.assertIn("hint: write MOVB 20, SMB94\n", done.stderr)
        self.assertNotIn("warning:", self.ends(FINE, "check", program, "--cpu", "224", "--no-warn", "unused-sm").stderr)
        self.assertRegex(self.ends(FINE, "run", program, "--cpu", "224", "--scans", "1", "--dump", "SMB94:2").stdout, r"SMB94 +00 14")

    def test_what_survives_power_off_is_set_as_in_the_system_block(self):
        counts = self.program("LD SM0.1\nINCB VB0\nINCB MB0\nINCB MB20\nLD SM0.0\nMEND\n")

        def after_two_runs(*options):
            memory = self.folder / f"memory{len(options)}{options[-1:]}.json"
            for _ in range(2):
                done = self.ends(FINE, "run", counts, "--cpu", "224", "--scans", "1", "--memory", memory, "--json", "--dump", "VB0", "--dump", "MB0", "--dump", "MB20", *options)
            return [each["values"][0] for each in json.loads(done.stdout)["dump"].values()]

        self.assertEqual(after_two_runs(), [2, 1, 2], "as a CPU 224 is delivered")
        self.assertEqual(after_two_runs("--retain", "MB0:14,C0:5"), [1, 2, 1])
        self.assertEqual(after_two_runs("--retain", "none"), [1, 1, 1])
        self.assertIn("--retain: 'T33' cannot be retentive", self.ends(UNUSABLE, "run", counts, "--scans", "1", "--retain", "T33").stderr)
        scenario = self.program(f"program: {counts}\ncpu: 224\nretain: \"MB0:14\"\nsteps:\n  - power_cycle: memory kept\n  - memory: {{VB0: 1, MB0: 2, MB20: 1}}\n", "retain.yaml")
        self.ends(FINE, "test", scenario)
        transcript = self.folder / "transcript.yaml"
        self.ends(FINE, "test", scenario, "--record", transcript)
        self.assertIn('retain: "MB0:14"', transcript.read_text(encoding="utf-8"))
        system = self.program(f"plcs: {{a: {{program: {counts}, cpu: 224, retain: \"QB0\"}}}}\nlines: {{l: {{stations: [a]}}}}\n", "system.yaml")
        self.assertIn("'QB0' cannot be retentive", self.ends(UNUSABLE, "run", system, "--for", "1ms").stderr)
        self.assertIn("--retain is about one PLC", self.ends(UNUSABLE, "run", system, "--retain", "VB0").stderr)

    def test_standard_output_is_for_one_thing(self):
        path = self.program(Json.ECHO)
        for arguments in (["--trace", "-", "--json"], ["--output", "-", "--json"], ["--trace", "-", "--output", "-"]):
            done = self.ends(UNUSABLE, "run", path, "--for", "1ms", *arguments)
            self.assertEqual(done.stdout, "")
            self.assertIn("only one of", done.stderr)

    def test_frames_file(self):
        frames = self.folder / "frames.txt"
        frames.write_text("# two\n ab  # first\r\n\ncd\n", encoding="utf-8")
        exchanges = self.json(FINE, "send", self.program(Json.ECHO), "--frames", frames, "--json")["exchanges"]
        self.assertEqual([e["response"] for e in exchanges], ["ab", "cd"])
        frames.write_text("'ab # c'  # text\n\"it's\"\n\\x61\n", encoding="utf-8")
        self.assertIn(f"{frames}:3: column 1", self.ends(UNUSABLE, "send", self.program(Json.ECHO), "--frames", frames).stderr)
        frames.write_text("'a'  # text\n \"'\"\n'#'\r\n", encoding="utf-8")
        exchanges = self.json(FINE, "send", self.program(Json.ECHO), "--frames", frames, "--json")["exchanges"]
        self.assertEqual([e["response_text"] for e in exchanges], ["a", "'", "#"])
        frames.write_text("ab\nxx\n", encoding="utf-8")
        done = self.ends(UNUSABLE, "send", self.program(Json.ECHO), "--frames", frames)
        self.assertIn(f"{frames}:2: column 1", done.stderr)


def unwrapped(text):
    """A report whose long lines go on in the next ones, below their second column."""
    return re.sub(r"\n {12,}", " ", text)


class Times(Case):
    def test_tables_with_a_name_are_listed_for_the_cpu(self):
        listed = lambda cpu: [table["name"] for table in self.json(FINE, "times", "--cpu", cpu, "--json")["tables"]]
        self.assertEqual(listed("214"), ["cpu214", "cpu214_from_22x"])
        self.assertEqual(listed("216"), ["cpu215", "cpu214_from_22x"])
        self.assertEqual((listed("224r1"), listed("224")), (["cpu22x_release1"], ["cpu22x"]))
        self.assertIn("cpu214_from_22x", self.ends(FINE, "times").stdout)
        self.assertRegex(s7200("run", "--help-all").stdout, r"--times TABLE +table of execution times: a name \(s7200 help times\) or a CSV file\n")

    def test_tables_stand_side_by_side(self):
        mine = self.program("mnemonic,form,base_us,per_unit_us,unit,marker\nMOVB,,37,,,measured\n", "mine.csv")
        lines = self.json(FINE, "times", "cpu214", "cpu214_from_22x", mine, "--json")["side_by_side"]
        (line,) = [line for line in lines if "MOVB" in line["mnemonics"]]
        self.assertEqual([(f["table"], f["base_us"], f["marker"]) for f in line["figures"]],
                         [("cpu214", 30, "estimate"), ("cpu214_from_22x", 55.274, "remembered"), (str(mine), 37, "measured")])
        ld = {line["areas"]: [f["base_us"] for f in line["figures"][:2]] for line in lines if "LD" in line["mnemonics"]}
        self.assertEqual(ld, {"I": [0.8, 0.705], "Q": [0.8, 2.097], "M": [2, 2.097], "SM S T C V": [3.2, 2.097]})
        text = self.ends(FINE, "times", "cpu214", "cpu214_from_22x").stdout
        self.assertRegex(text, r"(?m)^MOVB +30 +55.274 +1.84$")

    def test_verbs_that_run_nothing_have_no_options_of_running(self):
        for verb, options in (("times", ["--no-skip", "--ppi-baud", "--ppi-station", "--repair"]), ("check", ["--no-skip", "--ppi-baud", "--ppi-station"])):
            shown = s7200(verb, "--help-all").stdout
            for option in options:
                self.assertNotIn(option, shown)
                self.ends(UNUSABLE, verb, SLAVE, option, "9600")

    def test_a_table_is_chosen_by_its_name_wherever_times_are(self):
        path = self.program("LD SM0.0\nMOVB 1, VB0\nMEND\n")
        scan = lambda *times: self.json(FINE, "run", path, "--scans", "1", "--json", *times)["time_ns"]
        self.assertEqual(scan("--times", "cpu214"), scan())
        self.assertEqual(scan("--times", "cpu214_from_22x") - scan(), (55_274 - 30_000) + (2_097 - 3_200) + (0))
        scenario = self.program(f"program: {SLAVE}\ntimes: cpu214_from_22x\nsteps:\n  - {{read: holding 0, expect: [0]}}\n", "s.yaml")
        (other,) = self.json(FINE, "test", scenario, "--json")["scenarios"]
        scenario.write_text(scenario.read_text(encoding="utf-8").replace("times: cpu214_from_22x\n", ""), encoding="utf-8")
        (usual,) = self.json(FINE, "test", scenario, "--json")["scenarios"]
        self.assertGreater(other["exchanges"][0]["latency_us"], usual["exchanges"][0]["latency_us"])
        self.assertIn("tables for CPU 224: cpu22x", self.ends(UNUSABLE, "run", path, "--cpu", "224", "--times", "cpu214").stderr)

    def test_statements_known_from_real_cpus_hold_or_not(self):
        done = self.ends(FINE, "times", "--check", "cpu214")
        done.stdout = unwrapped(done.stdout)
        self.assertIn("holds        saving a value to EEPROM takes 15 to 20 ms: 17500 us", done.stdout)
        self.assertIn("not checked  the first scan takes about 690 ms", done.stdout)
        fitted = lambda *of: [each["fitted"] for each in self.json(FINE, "times", "--check", *of, "--json")["statements"]]
        for table in ("cpu214", "cpu214_from_22x"):
            self.assertEqual(fitted(table), [True, True, False, False, True], table)
        self.assertRegex(done.stdout, r"the first scan takes .*\(Application Tip 41, SBR 62 and text; the table was fitted to it\)")
        self.assertEqual(fitted("cpu22x_release1", "--cpu", "224r1"), [True] * 4, "its figures are the page's")
        wrong = self.program("mnemonic,form,base_us,per_unit_us,unit,marker\n(EEPROM save),,9000,,,measured\n", "mine.csv")
        self.assertIn("FAILS        saving a value to EEPROM", self.ends(FAILED, "times", "--check", wrong).stdout)

        def changed(cpu, line, other):
            copy = self.ends(FINE, "times", "--cpu", cpu, "--csv").stdout
            self.assertIn(line, copy)
            return fitted(self.program(copy.replace(line, other), "mine.csv"), "--cpu", cpu)

        self.assertEqual(changed("214", "\nNEXT,", "\nNEXT,"), [True, True, False, False, True], "a copy is as good as the table")
        self.assertEqual(changed("214", "\nNEXT,each repetition,150,", "\nNEXT,each repetition,149,"), [False] * 4 + [True])
        self.assertEqual(changed("224r1", "\nRCV,,80,,,manual,", "\nRCV,,80,,,measured,"), [False, True, True, True])
        self.assertIn("is not Application Tip 41", self.ends(UNUSABLE, "times", "--check", "cpu214", "--tip41", SLAVE).stderr)
        for cpu in ("224", "224r1"):
            self.assertIn(" 0 fail", self.ends(FINE, "times", "--cpu", cpu, "--check", {"224": "cpu22x", "224r1": "cpu22x_release1"}[cpu]).stdout)

    def test_the_slave_and_the_page_about_it_say_the_same_of_38400_baud(self):
        said = [re.search(r"(\d+) of (?:the )?202 tables", line) for page in (pathlib.Path(SLAVE), pathlib.Path(SLAVE).parent / "README.md")
                for line in page.read_text(encoding="utf-8").splitlines() if re.search("38400|lose characters", line)]
        self.assertEqual(len({match.group(1) for match in said if match}), 1)
        self.assertEqual(sum(match is not None for match in said), 2)

    def test_a_random_table_says_that_it_is_one(self):
        said = "random table 12 of seed 1 around cpu214_from_22x: each figure drawn; form, marker and source are those of cpu214_from_22x"
        self.assertTrue(self.ends(FINE, "times", "--band-table", "12", "--csv").stdout.startswith(f"# CPU 214\n# {said}\nmnemonic,"))
        self.assertIn(said, self.ends(FINE, "times", "--band-table", "12").stdout.replace("\n", " "))
        self.assertEqual(self.json(FINE, "times", "--band-table", "12", "--json")["about"], said)
        self.assertNotIn("about", self.json(FINE, "times", "--json"))

    @unittest.skipUnless(TIP.exists(), "the document is not part of this project")
    def test_the_tip_holds_with_both_tables_and_not_with_a_faster_cpu(self):
        for table in ("cpu214", "cpu214_from_22x"):
            done = self.ends(FINE, "times", "--check", table, "--tip41", TIP)
            done.stdout = unwrapped(done.stdout)
            self.assertIn("5 hold, 0 fail\n", done.stdout)
            self.assertIn("holds        the loop for its CRC table needs its WDR, and no more: with it the watchdog does nothing, without it it stops",
                          done.stdout)
        rows = self.json(FINE, "times", "--json")["times"]
        fast = self.program("mnemonic,form,base_us,per_unit_us,unit,marker\n" + "".join(
            f"{' '.join(row['mnemonics'])},{row['form']},{row['base_us'] / 3},{row['per_unit_us'] / 3},,measured\n" for row in rows
            if "EEPROM" not in row["mnemonics"][0]), "fast.csv")
        done = self.ends(FAILED, "times", "--check", fast, "--tip41", TIP)
        done.stdout = unwrapped(done.stdout)
        self.assertIn("FAILS        the first scan takes about 690 ms, elsewhere about 700 (655 to 735 ms)", done.stdout)
        self.assertNotRegex(done.stdout, "first scan takes .*the table was fitted to it")
        other = unwrapped(self.ends(FINE, "times", "--cpu", "215", "--check", "cpu215", "--tip41", TIP).stdout)
        self.assertEqual(len(re.findall(r": the tip is a program for the CPU 214 +\(", other)), 4)
        self.assertIn("1 hold, 0 fail, 4 not checked", other)
        self.assertIn("FAILS        it does not work correctly at 38400 baud", done.stdout)
        self.assertIn("FAILS        the loop for its CRC table needs its WDR, and no more", done.stdout)

    def test_a_band_gives_ranges_and_says_with_how_many_tables(self):
        arguments = ["send", SLAVE, "--crc", "0103000a0002", "--times-band", "20"]
        done = self.ends(FINE, *arguments)
        self.assertRegex(done.stdout, r"^execution times: cpu214, cpu214_from_22x, and 20 random tables around them \(seed 1\)\n")
        self.assertRegex(done.stdout, r"(?m)^  after 1\d\.\d … \d\d\.\d ms   answered: 22 of 22 tables$")
        ends = re.search(r"(?m)^  shortest with (.*), longest with (.*)$", done.stdout).groups()
        (band,) = self.json(FINE, *arguments, "--json")["band"]["exchanges"]
        exchange = self.json(FINE, *arguments[:4], "--json")["exchanges"][0]
        self.assertTrue(band["latency_us"]["least"] < exchange["latency_us"] < band["latency_us"]["most"])
        self.assertEqual(band["request"], exchange["request"])
        self.assertEqual((band["shortest_with"], band["longest_with"]), ends)
        for end, key in zip(ends, ("least", "most")):
            number = re.fullmatch(r"random table (\d+) of seed 1|(cpu\w+)", end)
            csv = self.program(self.ends(FINE, "times", "--csv", *(("--band-table", number[1]) if number[1] else ("--times", number[2]))).stdout, "end.csv")
            again = self.json(FINE, *arguments[:4], "--times", csv, "--json")["exchanges"][0]["latency_us"]
            self.assertEqual(again, band["latency_us"][key], "the table that gave an end of the range can be had")
        self.assertEqual(self.ends(FINE, *arguments, "--jobs", "1").stdout, done.stdout, "the same with one job")
        self.assertNotEqual(self.ends(FINE, *arguments, "--band-seed", "2").stdout, done.stdout)
        self.assertIn("--trace is about one run", self.ends(UNUSABLE, *arguments, "--trace", "-").stderr)

    def test_a_table_from_a_pipe_is_read_once(self):
        csv = self.ends(FINE, "times", "--csv").stdout
        piped = lambda *arguments: self.ends(FINE, *arguments, "--times", "/dev/stdin", stdin=None, input=csv).stdout
        by_name = self.ends(FINE, "times", "--times", "cpu214", "--band-table", "1").stdout
        self.assertEqual(piped("times", "--band-table", "1"), by_name.replace("cpu214", "/dev/stdin", 2))
        for verb in (["send", SLAVE, "--crc", "0103000a0002"], ["master", SLAVE, "read", "40011"]):
            self.assertIn("of 4 tables", piped(*verb, "--times-band", "3"))

    def test_a_band_around_a_table_that_cannot_be_read_is_refused(self):
        for verb in (["times", "--band-table", "1"], ["send", SLAVE, "01", "--times-band", "3"]):
            self.assertIn("cannot read missing.csv", self.ends(UNUSABLE, *verb, "--times", "missing.csv").stderr)

    def test_a_figure_at_the_limit_is_not_drawn_beyond_it(self):
        header = "mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent\n"
        path = self.program("LD SM0.1\nMOVB 9, SMB30\nLD SM0.0\nMOVB 1, VB0\nMEND\n")
        scenario = self.program(f"program: {path}\ntimes: slow.csv\nsteps:\n  - {{send: 01, expect: silence}}\n", "slow.yaml")
        for figure, percent in (("100000", 1000), ("100000", 500), ("99999", 1000)):
            slow = self.program(f"{header}MOVB,,{figure},,,measured,me,{percent}\nLD A O =,SM,{figure},,,measured,me,{percent}\n", "slow.csv")
            self.assertIn("of 4 tables", self.ends(FAILED, "send", path, "01", "--times", slow, "--times-band", "3").stdout)
            self.assertIn("of 4 tables", self.ends(FAILED, "master", path, "read", "40001", "--times", slow, "--times-band", "3").stdout)
            self.assertIn("of 4 tables", self.ends(FAILED, "test", scenario, "--times-band", "3").stdout)
        slow = self.program(header + "MOVB,,1000000,,,measured,me,1000\n", "slow.csv")
        self.assertIn("slow.csv:2: '1000000' is not a time in microseconds (0.001 to 100000)",
                      self.ends(UNUSABLE, "send", path, "01", "--times", slow, "--times-band", "1").stderr)

    def test_only_figures_in_use_are_listed_and_a_copy_of_a_copy_is_the_same(self):
        one = self.program("mnemonic,form,base_us,per_unit_us,unit,marker\nMOVB,,37,,,measured\n", "one.csv")
        rows = self.json(FINE, "times", "--times", one, "--json")["times"]
        self.assertEqual([row["base_us"] for row in rows if "MOVB" in row["mnemonics"]], [37])
        self.assertEqual(len(re.findall(r"(?m)^MOVB ", self.ends(FINE, "times", "--times", one).stdout)), 1)
        self.assertNotIn("30 us", self.ends(FINE, "instructions", "MOVB", "--times", one).stdout)
        copy = self.ends(FINE, "times", "--times", one, "--csv").stdout
        self.assertEqual(self.ends(FINE, "times", "--times", self.program(copy, "copy.csv"), "--csv").stdout, copy)

    def test_a_table_says_of_which_cpu_it_is_and_is_not_taken_for_another(self):
        listed = self.ends(FINE, "times", "--cpu", "224")
        self.assertIn("s7200 times --cpu 224 --csv > my_times.csv", listed.stdout)
        copy = self.program(self.ends(FINE, "times", "--cpu", "224", "--csv").stdout, "of_224.csv")
        self.ends(FINE, "times", "--cpu", "226", "--times", copy)
        refused = self.ends(UNUSABLE, "run", SLAVE, "--times", copy, "--scans", "1").stderr
        self.assertIn("of_224.csv:1: these are times of CPU 224, not of CPU 214; give --cpu 224, or delete this line and mend what does not fit", refused)
        without = self.program("".join(copy.read_text(encoding="utf-8").splitlines(True)[1:]), "plain.csv")
        self.ends(FINE, "times", "--cpu", "224", "--times", without)
        for arguments in (["times", ""], ["times", "--check", ""]):
            self.assertIn("a table has a name, or is a file", self.ends(UNUSABLE, *arguments).stderr)

    def test_a_band_of_a_file_is_within_its_uncertainty(self):
        sure = self.program("mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent\n" + "".join(
            f"{' '.join(row['mnemonics'])},{row['form']},{row['base_us']},{row['per_unit_us'] or ''},,measured,,0\n"
            for row in self.json(FINE, "times", "--json")["times"]), "sure.csv")
        (band,) = self.json(FINE, "send", SLAVE, "--crc", "0103000a0002", "--times-band", "5", "--times", sure, "--json")["band"]["exchanges"]
        self.assertEqual((band["tables"], band["latency_us"]["least"]), (6, band["latency_us"]["most"]))

    def test_a_master_says_how_sure_its_answers_are(self):
        done = self.ends(FINE, "master", SLAVE, "write", "40011=1", "read", "40011:2", "--times-band", "10")
        self.assertEqual(len(re.findall(r"(?m)^  after .* … .* ms   right: 12 of 12 tables$", done.stdout)), 2)
        self.assertIn("give no --every", self.ends(UNUSABLE, "master", SLAVE, "read", "40001", "--every", "1s", "--count", "2",
                                                   "--times-band", "2").stderr)

    def test_characters_that_are_lost_with_some_tables_are_counted(self):
        done = self.ends(FAILED, "send", self.program(FAST_SLAVE, "fast.stl"), "--crc", LONG_REQUEST, "--times-band", "50")
        self.assertRegex(done.stdout, r"answered: \d+ of 52 tables; no answer: \d+ of 52; characters or events lost: \d+ of 52")

    def interrupted(self, *arguments):
        """What the command printed that Ctrl-C came to when it showed that it is under way."""
        terminal, error = os.openpty()
        process = subprocess.Popen([S7200, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=error, text=True)
        self.addCleanup(os.close, terminal)
        os.close(error)
        shown = b""
        while b"of 1 scenarios" not in shown:
            shown += os.read(terminal, 1000)
        process.send_signal(signal.SIGINT)
        out = process.communicate(timeout=120)[0]
        self.assertEqual(process.returncode, FAILED, out)
        return out

    def test_a_band_that_is_interrupted_says_how_many_tables_were_asked_for(self):
        text = f"program: {SLAVE}\nsteps:\n  - {{read: holding 0, expect: [0]}}\n"
        scenario, robust = self.program(text, "all.yaml"), self.program("robust: 1%\n" + text, "robust.yaml")
        self.assertRegex(self.interrupted("test", scenario, "--times-band", "100000"), r"pass .* \((\d+) of \1 tables, and 100002 were asked for, answers")
        (one,) = json.loads(self.interrupted("test", robust, "--times-band", "100000", "--json"))["scenarios"]
        self.assertEqual((one["outcome"], one["reason"], one["findings"]), ("skipped", "interrupted", []), "not all tables are no share of them")
        self.assertEqual(one["band"]["asked"], 100002)
        self.assertLess(one["band"]["tables"], 100002)

    def test_what_was_recorded_before_an_interruption_is_written(self):
        recorded = self.folder / "recorded.yaml"
        self.interrupted("test", "--random", "100000", "--target", SLAVE, "--record", recorded)
        whole = recorded.read_text(encoding="utf-8")
        self.assertIn("1 passed", self.ends(FINE, "test", recorded).stdout)
        self.program("LD SM0.0\nINCW VW0\nMEND\n", "counts.stl")
        long = self.program("program: counts.stl\nsteps:\n  - repeat: 4096\n    steps:\n      - wait: 1h\n", "long.yaml")
        self.interrupted("test", long, "--record", recorded, "--force")
        self.assertEqual(recorded.read_text(encoding="utf-8"), whole, "no scenario went to its end, and the old file stays")

    def test_a_scenario_passes_with_a_share_of_the_tables(self):
        text = f"program: {SLAVE}\nrobust: 100%\nsteps:\n  - {{read: holding 0, expect: [0], latency: ..16ms}}\n"
        scenario = self.program(text, "share.yaml")
        done = self.ends(FAILED, "test", scenario, "--times-band", "20")
        self.assertRegex(done.stdout, r"FAIL .* \(\d+ of 22 tables, answers after \d+\.\d … \d+\.\d ms\)")
        self.assertIn("expected  to pass with 100% of the tables of execution times", done.stdout)
        self.assertRegex(done.stdout, r"share\.yaml:2:\d+: robust: 100%")
        self.assertRegex(done.stdout, r"found +\d+ of 22: \d+\.\d%, not with (random table \d+ of seed 1|cpu214_from_22x)\n")
        late = self.program(text.replace("100%", "40%").replace("..16ms", "16ms.."), "late.yaml")
        done = self.ends(FAILED, "test", late, "--times-band", "20")
        self.assertIn("expected  to pass with 40% of the tables of execution times, and with the one in use", done.stdout)
        self.assertRegex(done.stdout, r"found +\d+ of 22: \d+\.\d%, not with cpu214\n")
        known = text.replace("steps:", "expected_failure: too slow\nsteps:")
        gap = self.ends(FINE, "test", self.program(known, "gap.yaml"), "--times-band", "20").stdout
        self.assertRegex(gap, r"gap .* \(expected failure: too slow\)   \(\d+ of 22 tables", "that it is not robust enough is the known gap")
        robust = self.program(known.replace("100%", "10%"), "no_gap.yaml")
        self.assertIn("remove the mark", self.ends(FAILED, "test", robust, "--times-band", "20").stdout)
        scenario.write_text(text.replace("100%", "10%"), encoding="utf-8")
        self.ends(FINE, "test", scenario)
        (of_one,) = self.json(FINE, "test", scenario, "--json")["scenarios"]
        self.assertEqual(of_one["band"]["tables"], 202, "a scenario that asks for a share is run with the usual number of tables")
        self.ends(FAILED, "test", self.program(text, "again.yaml"), "--times-band", "20", "--junit", self.folder / "band.xml")
        properties = {one.get("name"): one.get("value") for one in xml.etree.ElementTree.parse(self.folder / "band.xml").iter("property")}
        self.assertEqual(properties["tables"], "22")
        self.assertIn(int(properties["tables_passed"]), range(22))
        self.assertRegex(properties["tables_failed_with"], r"random table \d+ of seed 1|cpu214_from_22x")
        self.ends(FINE, "test", scenario, "--record", self.folder / "t.yaml")
        self.assertIn("# without its 'robust: 10%': the times below are those of one table\n", (self.folder / "t.yaml").read_text(encoding="utf-8"))
        self.ends(FINE, "test", self.folder / "t.yaml")
        for share in ("0%", "101%", "95"):
            self.assertIn(f"'{share}' is not a share of the tables of execution times, above 0% and up to 100%", self.ends(UNUSABLE, "test", self.program(text.replace("100%", share), "x.yaml")).stderr)
        empty = self.ends(UNUSABLE, "test", self.program(text.replace(" 100%", ""), "x.yaml")).stderr
        self.assertIn("x.yaml:2:1: error: ", empty, "what is not written stands where its key does")
        self.assertNotEqual(*(self.json(FINE, "test", scenario, "--band-seed", seed, "--json")["scenarios"][0]["band"] for seed in "12"))
        self.assertIn("are about one", self.ends(UNUSABLE, "test", scenario, "--times-band", "2", "--record", self.folder / "t.yaml").stderr)

    def test_a_scenario_with_a_band_reads_its_table_once(self):
        csv_text = self.ends(FINE, "times", "--csv").stdout
        table = self.folder / "times.csv"
        os.mkfifo(table)
        scenario = self.program(f"program: {SLAVE}\ntimes: {table}\nsteps:\n  - {{read: holding 0, expect: [0]}}\n", "once.yaml")
        writer = threading.Thread(target=table.write_text, args=(csv_text,), daemon=True)
        writer.start()
        self.assertIn("(4 of 4 tables", self.ends(FINE, "test", scenario, "--times-band", "3").stdout)
        writer.join()

    def test_a_measured_cpu_gives_its_table_back_within_the_stated_uncertainty(self):
        """A simulated CPU with random times is measured through its line. The command knows nothing of them but the answers."""
        random.seed(13)
        within = lambda figure, percent: round(figure * (1 + percent / 100) ** random.uniform(-1, 1), 3)
        rows = self.json(FINE, "times", "--json")["times"]
        truth = {}
        text = "mnemonic,form,base_us,per_unit_us,unit,marker\n"
        for row in rows:
            base = within(row["base_us"], row["uncertainty_percent"]) if row["base_us"] else 0
            unit = within(row["per_unit_us"], row["uncertainty_percent"]) if row["per_unit_us"] else 0
            text += f"{' '.join(row['mnemonics'])},{row['form']},{base},{unit or ''},{row['unit']},measured\n"
            for mnemonic in row["mnemonics"]:
                truth[mnemonic, row["form"]] = base, unit
        truth["(operand area adds)", "AC"] = 0, 0
        hidden = self.program(text, "hidden.csv")
        out = self.folder / "measured.csv"
        done = self.ends(FINE, "calibrate", MEASURE, "--times", hidden, "--each", "10s", "-o", out, "--firmware", "1.10")
        found = 0
        lines = list(csv.DictReader(line for line in out.open(encoding="utf-8") if not line.startswith("#")))
        parts = [line for line in lines if line["source"].startswith("part of ")]
        sums = [line for line in lines if line["mnemonic"] == "(sum)"]
        estimated = [line for line in lines if line["marker"] != "measured" and line not in parts]
        for line in (line for line in lines if line not in estimated and line not in sums):
            form, = [form for mnemonic, form in truth if mnemonic == line["mnemonic"] and
                     (not line["form"] or form.split() == [] or set(line["form"].split()) <= set(form.split()) or
                      not set(form.split()) & {"I", "Q", "M", "SM", "V"})][:1]
            self.assertEqual(line["uncertainty_percent"], "0")
            for key, true in zip(("base", "per_unit"), truth[line["mnemonic"], form]):
                if line[f"{key}_us"]:
                    found += 1
                    self.assertLessEqual(abs(float(line[f"{key}_us"]) - true), float(line[f"{key}_within_us"]) + 0.001, (line, true))
            if line in parts:
                self.assertEqual(line["marker"], "calibrated")
                continue
            self.assertLess(float(line["base_within_us"]), 0.15 * float(line["base_us"]) + 0.1, line)
            self.assertRegex(line["source"], r"^simulated CPU 214 \(SMB6 = 16#20, firmware 1\.10\), measured \d{4}-\d\d-\d\d(, loops agree within [1-9]\d* ns)?$")
        self.assertGreater(found, 140)
        self.assertIn("LSCR + SCRE", " ".join(line["form"] for line in sums))
        known_sum = {mnemonic: base for (mnemonic, _), (base, _) in truth.items()}
        for line in sums:
            self.assertLessEqual(abs(float(line["base_us"]) - sum(known_sum[part] for part in line["form"].split(" + "))),
                                 float(line["base_within_us"]) + 0.001, line)
        self.assertEqual({line["mnemonic"] for line in parts},
                         {"CALL", "RET", "CRET", "LSCR", "SCRE", "LPS", "LPP", "(interrupt entry)", "RETI", "CRETI", "(scan overhead)", "MEND"})
        self.assertRegex(done.stderr, r"(?m)^RET \+ CALL \+ SBR = \d+\.\d\d us ± \d\.\d\d, and as far as is known RET \d+\.\d\d ± \d+\.\d\d, CALL ")
        reasons = dict(line.strip().split(": ", 1) for line in done.stderr.split("not measured separately; estimated as ", 1)[1].splitlines()[1:])
        self.assertEqual({why: names.split() for why, names in reasons.items() if not names.startswith("(")},
                         {"it uses the line": ["XMT", "NETR", "NETW"], "it sets up hardware that may be wired": ["HDEF", "HSC", "PLS"],
                          "it sets the clock": ["TODW"], "it ends the measurement": ["STOP"],
                          "it takes the place of MEND, and what else a scan takes is a thousand times as long": ["END"],
                          "it is never without CALL, or without an interrupt": ["SBR", "INT"]}, "what cannot be measured is listed with the reason")
        listed = set(" ".join(reasons.values()).split())
        measured = {line["mnemonic"] for line in lines if line not in estimated}
        self.assertEqual(out.read_text(encoding="utf-8").splitlines()[0], "# CPU 214")
        self.assertTrue(all(line["source"].startswith("not measured") for line in estimated))
        self.assertLess({"(EEPROM save)", "XMT", "TODW"},
                        {name for line in estimated for name in line["mnemonic"].split(" ") + [line["mnemonic"]]})
        known = {mnemonic for row in rows for mnemonic in row["mnemonics"]}
        self.assertEqual(measured & listed, set())
        self.ends(FINE, "times", "--check", out)
        self.assertIn("exists", self.ends(UNUSABLE, "calibrate", MEASURE, "-o", out).stderr)
        self.assertLess({"LD", "MOVB", "NEXT", "WDR", "SLW", "ATCH", "TON", "FND<>", "ATT", "LIFO", "DISI", "=I", "RI", "SI", "SCRT"}, measured)

    @unittest.skipUnless(TIP.exists(), "the document is not part of this project")
    def test_a_cpu_with_other_times_is_within_the_band_of_its_measured_table(self):
        truth, out = ["--times", "cpu214_from_22x"], self.folder / "measured.csv"
        self.ends(FINE, "calibrate", MEASURE, *truth, "--each", "1s", "-o", out)
        self.assertIn("5 hold, 0 fail\n", self.ends(FINE, "times", "--check", out, "--tip41", TIP).stdout)
        for program, request in ((TIP, "01030000000a"), (SLAVE, "0103000a0002")):
            arguments = ["send", program, "--crc", request, "--json"]
            true = self.json(FINE, *arguments, *truth)["exchanges"][0]["latency_us"]
            (band,) = self.json(FINE, *arguments, "--times", out, "--times-band", "100")["band"]["exchanges"]
            self.assertTrue(band["latency_us"]["least"] < true < band["latency_us"]["most"], (program, true, band))
        resets = self.program("LD SM0.0\nR T0, 16\nLD Q0.0\nJMP 1\nLBL 1\nLD Q0.0\nJMP 2\nLBL 2\nMEND\n")
        time = lambda table: self.json(FINE, "run", resets, "--scans", "1", "--times", table, "--json")["time_ns"]
        overhead = lambda table: next(row["base_us"] * 1000 for row in self.json(FINE, "times", "--times", table, "--json")["times"]
                                      if row["mnemonics"] == ["(scan overhead)"])
        self.assertAlmostEqual((time(out) - overhead(out)) / (time(truth[1]) - overhead(truth[1])), 1, delta=0.02,
                               msg="reset of timers, contacts of outputs and jumps are measured as what they are")

    def test_what_calibrate_cannot_use_is_refused_before_it_measures(self):
        for option in (["--times", "cpu214"], ["--no-skip"], ["--ppi-baud", "9600"]):
            self.assertIn(f"{option[0]} needs a PROGRAM to run in simulation", self.ends(UNUSABLE, "calibrate", "tcp://127.0.0.1:1", *option).stderr)
        self.assertNotIn("needs a PROGRAM", self.ends(UNUSABLE, "calibrate", "tcp://127.0.0.1:1", "--cpu", "224", "--each", "1s").stderr)
        self.assertRegex(s7200("calibrate", "--help-all").stdout, "--cpu TYPE.* CPU that is measured")
        self.assertIn("does not go into a table", self.ends(UNUSABLE, "calibrate", MEASURE, "--firmware", "1\n2").stderr)
        quoted = self.folder / "quoted.csv"
        self.ends(FINE, "calibrate", MEASURE, "--each", "1s", "--firmware", 'the "2"', "-o", quoted)
        self.assertIn('firmware the "2")', self.json(FINE, "times", "--times", quoted, "--json")["times"][0]["source"])
        gone = self.ends(UNUSABLE, "calibrate", "tcp://127.0.0.1:1").stderr
        self.assertNotIn("Micro/WIN", gone, "it is not the program that is missing")
        self.assertNotIn("--baud", self.ends(FINE, "calibrate", "--help-all").stdout)

    def measured_cpu(self, cpu):
        """Its pty."""
        link = self.folder / "plc"
        plc = subprocess.Popen([S7200, "run", MEASURE, "--cpu", cpu, "--pty", str(link), "--speed", "40", "--for", "3000s"],
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(plc.wait)
        self.addCleanup(plc.kill)
        deadline = time.monotonic() + 60
        while not link.exists():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)
        return link

    def test_a_cpu_that_smb6_tells_to_be_another_is_refused_before_its_loops_are_measured(self):
        done = self.ends(UNUSABLE, "calibrate", self.measured_cpu("226"), "-o", self.folder / "x.csv")
        self.assertIn("SMB6 = 16#90 belongs to CPU 216, 226r1, 226XM, 226, not to CPU 214: run again with --cpu", done.stderr)
        self.assertFalse((self.folder / "x.csv").exists())

    def test_what_was_measured_before_an_interruption_is_written(self):
        terminal, out = os.openpty()
        table = self.folder / "half.csv"
        process = subprocess.Popen([S7200, "calibrate", MEASURE, "--each", "20s", "-o", str(table)], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=out)
        self.addCleanup(process.kill)
        os.close(out)
        shown = b""
        while b"3 of " not in shown:
            shown += os.read(terminal, 1000)
        process.send_signal(signal.SIGINT)
        with contextlib.suppress(OSError):  # the terminal's other end is gone
            while more := os.read(terminal, 1000):
                shown += more
        self.assertEqual(process.wait(60), FAILED, shown)
        self.assertRegex(shown.decode(), r"interrupted after \d+ of \d+ loops: the rest of the table is not measured")
        self.assertIn(",measured,", table.read_text(encoding="utf-8"))
        self.assertRegex(table.read_text(encoding="utf-8"), r"^# CPU 214\n# interrupted after \d+ of \d+ loops: the rest of the table is not measured\nmnemonic,")
        self.ends(FINE, "times", "--check", table)

    def test_what_was_measured_before_the_cpu_went_is_written(self):
        slow = self.program("mnemonic,form,base_us,per_unit_us,unit,marker\nSQRT,,100000,,,measured\n", "slow.csv")
        table = self.folder / "half.csv"
        done = self.ends(UNUSABLE, "calibrate", MEASURE, "--times", slow, "--each", "1s", "-o", table)
        self.assertRegex(done.stderr, r"broken off after \d+ of \d+ loops: the rest of the table is not measured")
        self.assertIn(",measured,", table.read_text(encoding="utf-8"))
        self.ends(FINE, "times", "--check", table)

    def test_a_character_that_was_damaged_unnoticed_on_the_way_changes_no_figure(self):
        """As a serial server delivers it, without its parity: once in an answer, once in a command."""
        running = subprocess.Popen([S7200, "run", MEASURE, "--speed", "40", "--for", "3000s", "--tcp", "0"], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(running.stdout.close)
        self.addCleanup(running.wait)
        self.addCleanup(running.kill)
        port = next(int(found[1]) for line in running.stdout if (found := re.search(r"127\.0\.0\.1:(\d+)", line)))
        damage = {"answer": 40, "command": 61}  # the how manieth of its pieces
        server = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(server.close)

        def copy(way, source, target):
            number = 0
            with contextlib.suppress(OSError):
                while piece := bytearray(source.recv(100)):
                    number += 1
                    if number == damage[way]:
                        piece[-1] ^= 0x20
                    target.sendall(piece)
                target.shutdown(socket.SHUT_WR)

        def between():
            client = server.accept()[0]
            behind = socket.create_connection(("127.0.0.1", port))
            threading.Thread(target=copy, args=("answer", behind, client), daemon=True).start()
            copy("command", client, behind)

        threading.Thread(target=between, daemon=True).start()
        clean, damaged = self.folder / "clean.csv", self.folder / "damaged.csv"
        self.ends(FINE, "calibrate", MEASURE, "--each", "1s", "-o", clean)
        self.ends(FINE, "calibrate", f"tcp://127.0.0.1:{server.getsockname()[1]}", "--cpu", "214", "--each", "1s", "-o", damaged)
        figures = lambda table: {(row["mnemonics"][0], row["form"]): row["base_us"] for row in self.json(FINE, "times", "--times", table, "--json")["times"]}
        true, found = figures(clean), figures(damaged)
        for form, figure in true.items():
            self.assertAlmostEqual(found[form], figure, delta=max(1.0, 0.02 * figure), msg=form)

    def test_a_cpu_that_smb6_does_not_tell_is_named_in_a_note(self):
        link = self.measured_cpu("224")
        done = self.ends(FINE, "calibrate", link, "--each", "1s", "-o", self.folder / "x.csv")
        self.assertIn("SMB6 = 16#20 belongs to CPU 214, 224r1, 224, 224XP; the times of CPU 214 were used", done.stderr)

    def test_a_cpu_that_stops_while_it_is_measured_says_why(self):
        slow = self.program("mnemonic,form,base_us,per_unit_us,unit,marker\nSQRT,,100000,,,measured\n", "slow.csv")
        done = self.ends(UNUSABLE, "calibrate", MEASURE, "--times", slow, "--each", "1s")
        self.assertRegex(done.stderr, r"the CPU is in STOP; .*watchdog")
        self.assertNotIn("Micro/WIN", done.stderr)

    def test_a_table_is_of_what_the_cpu_has(self):
        head = "mnemonic,form,base_us,per_unit_us,unit,marker\n"
        for line, said in (("BMB,,5,3,lamps,measured", "BMB takes longer for each byte, not for each 'lamps'; write that into column 5"),
                           ("LD,AC,1,,,measured", "the first operand of LD is never in AC; delete the line")):
            self.assertIn(f"slip.csv:2: {said}", self.ends(UNUSABLE, "times", "--times", self.program(f"{head}{line}\n", "slip.csv")).stderr)

    def test_bench_takes_what_answers_a_request_for_10_registers_and_nothing_else(self):
        programs = SOURCE / "stl_programs"
        for program, cpu in ((programs / "text_commands.stl", "224"), (programs / "scale.stl", "214"), (programs / "polling_master.stl", "224")):
            done = self.ends(UNUSABLE, "bench", "--each", "1ms", "--cpu", cpu, program)
            self.assertIn("did not answer a request for 10 registers", done.stderr, program)

    def test_a_share_of_tables_that_nothing_has_judged_is_noted(self):
        text = f"program: {SLAVE}\nrobust: 95%\nsteps:\n  - read: holding 10\n    count: 2\n    expect: [0, 0]\n"
        done = s7200("test", self.program(text, "robust.yaml"), "--target", "westinghouse:pc1200")
        self.assertIn("'robust' is not judged: westinghouse:pc1200 is not a program", done.stderr)

    def test_a_table_with_which_the_exchange_went_otherwise_is_named(self):
        done = s7200("send", SLAVE, "--crc", "0103000a0002", "--timeout", "17ms", "--times-band", "20")
        self.assertRegex(done.stdout, r"(?m)^  (answered|no answer) with (cpu214|cpu214_from_22x|random table \d+ of seed 1)$")

    def test_a_band_says_with_how_many_tables_the_cpu_stopped_and_why(self):
        loop = self.program("LD SM0.1\nMOVB 16#49, SMB30\nLD I0.0\nFOR VW0, 1, 1850\nNEXT\nMEND\n", "loop.stl")
        watchdog = r"CPU in STOP, scan watchdog \(fatal error 0003\)"
        for verb in (["send", loop, "01"], ["master", loop, "read", "40001"]):
            done = self.ends(FAILED, *verb, "--set", "I0.0=1", "--times-band", "20")
            self.assertRegex(done.stdout, rf"(?m)^  (no answer|silent): \d+ of 22 tables; not sent: (\d+) of 22; {watchdog}: \2 of 22$")
            self.assertRegex(done.stdout, rf"(?m)^  {watchdog} with random table \d+ of seed 1$")
            (exchange,) = self.json(FAILED, *verb, "--set", "I0.0=1", "--times-band", "20", "--json")["band"]["exchanges"]
            (stop,) = exchange["stops"]
            self.assertRegex(stop["why"], watchdog)
            self.assertRegex(stop["first_with"], r"random table \d+ of seed 1")

    @unittest.skipUnless(TIP.exists(), "Application Tip 41 is not part of this project")
    def test_tables_that_agree_with_what_is_known_are_counted_apart(self):
        arguments = ["send", SLAVE, "--crc", "0103000a0002", "--times-band", "10", "--tip41", TIP]
        done = self.ends(FINE, *arguments)
        agreeing, = re.findall(r"(?m)^  after .* 12 of 12 tables\n  with those that agree with what is known: after .* ms   answered: (\d+) of \1 tables$", done.stdout)
        (exchange,) = self.json(FINE, *arguments, "--json")["band"]["exchanges"]
        self.assertEqual([exchange["agreeing"], exchange["verdicts"][0]["agreeing"]], [int(agreeing)] * 2)
        latency = exchange["latency_us"]
        self.assertTrue(latency["least"] <= latency["least_agreeing"] < latency["most_agreeing"] <= latency["most"])
        checked = [s7200("times", "--check", name, "--tip41", TIP).returncode for name in ("cpu214", "cpu214_from_22x")]
        for number in range(1, 11):
            csv = self.program(self.ends(FINE, "times", "--csv", "--band-table", str(number)).stdout, f"{number}.csv")
            checked.append(s7200("times", "--check", csv, "--tip41", TIP).returncode)
        self.assertEqual(checked.count(FINE), int(agreeing), "what `times --check` finds of each")
        self.assertIn("is not Application Tip 41", self.ends(UNUSABLE, *arguments[:-1], SLAVE).stderr)

    def test_what_is_not_the_measuring_program_is_said_with_how_to_download_it(self):
        done = self.ends(UNUSABLE, "calibrate", SLAVE)
        self.assertRegex(done.stderr, r"no answer yet; measure_times\.stl must be in the CPU(.|\n)*no answer from measure_times\.stl")
        self.assertEqual(done.stderr.count("--to microwin"), 1)
        self.assertNotIn("\N{REPLACEMENT CHARACTER}", done.stderr)
        self.assertIn("does not speak Modbus", self.ends(UNUSABLE, "calibrate", "modbus-tcp://localhost:1").stderr)
        self.ends(FINE, "check", MEASURE, "--cpu", "224")

    def test_rules_of_conformance_say_with_how_many_tables(self):
        slave = self.program(f"program: {SLAVE}\nfunctions: [3]\nholding_registers: {{count: 1000}}\n", "slave.yaml")
        done = s7200("test", "--conformance", slave, "--only", "SL-crc", "--times-band", "3")
        self.assertRegex(done.stdout, r"(?m)^        5 of 5 tables, answers after")


class Readme(Case):
    """Every line `$ …` in a block ```sh of a README and of the pages in docs/ is run, in a folder that has what the tree has. What is shown below a
    command is what it prints; a line that is `…` stands for anything. A command with `&` runs until the end of its block."""

    TOOLS = ("sigrok-cli", "tshark", "mbpoll", "pytest-3")  # of others; skipped where they are not installed
    # What is in commands that find something wrong, or get no answer: their exit code is 1, and that of all others 0.
    NOT_RIGHT = ("import --compare", "wrong_answer.yaml", "send stl_programs/modbus_slave.stl 0103000a00010000", "--baud 19200", "pointers.stl",
                 "broken.awl", "--fault flip:", "freeport_pc_protocol_zh.txt --cpu 224", "4006381333931",
                 "--only 'wrong quantity'", "tests/exports/pump_new.awl", "timer_new.stl --write", "s7200 fuzz tests", "s7200 test found", "--conformance tests/conformance/tip41.yaml")

    PAGES = sorted((SOURCE / "docs").glob("*.md"))

    def test_the_readme_is_short_and_links_every_page(self):
        readme = (SOURCE / "README.md").read_text(encoding="utf-8")
        self.assertLessEqual(readme.count("\n"), 200)
        self.assertLessEqual(len(readme.encode()), 9 * 1024)
        index = (SOURCE / "docs/README.md").read_text(encoding="utf-8")
        for page in self.PAGES:
            self.assertIn(f"docs/{page.name}", readme)
            if page.name != "README.md":
                self.assertIn(f"[{page.name}]({page.name})", index)

    def test_links_lead_to_what_is_there(self):
        for page in [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", SOURCE / "CHANGELOG.md", *self.PAGES]:
            for link in re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8")):
                self.assertTrue((page.parent / link).exists(), f"{page.name}: {link}")

    def test_paths_in_the_readmes_of_folders_are_there(self):
        """With a slash from its folder on, or from one above; a file of code without one is somewhere in the tree."""
        tree = [path for folder in SOURCE.iterdir() if folder.name not in ("build", ".git") for path in (folder, *folder.rglob("*"))]
        names = {path.name for path in tree}
        outside = ("build/", "../shared/")
        count = 0
        for readme in (path for path in tree if path.name == "README.md"):
            bases = [base for base in readme.parents if base == SOURCE or SOURCE in base.parents]
            text = re.sub(r"(?ms)^```.*?^```", "", readme.read_text(encoding="utf-8"))
            for name in re.findall(r"`([\w.*-]*/[\w./*-]+|[\w*-]+\.(?:[ch]pp|py|mjs|csv|\*))`", text):
                if name.startswith("/") or any(part in name for part in outside) or "NAME" in name:
                    continue
                count += 1
                with self.subTest(f"{readme.relative_to(SOURCE)}: {name}"):
                    if "/" in name:
                        self.assertTrue(any(glob.glob(str(base / name)) or glob.glob(f"{base / name}.*") for base in bases))
                    else:
                        self.assertTrue(fnmatch.filter(names, name))
        self.assertGreater(count, 300)

    def test_the_picture_is_what_a_run_gives(self):
        done = subprocess.run([sys.executable, SOURCE / "docs/timeline.py", S7200], capture_output=True, text=True, check=False, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_why_names_for_each_frame_of_the_page_what_its_table_says(self):
        readme = (SOURCE / "docs/debugger.md").read_text(encoding="utf-8")
        rows = re.findall(r"^\| `([^`]+)` \(.*?\) \| `([^`]+)` in (\w+ \d+).*? \| `([^`]+)` is (\d)", readme, re.M)
        self.assertEqual(len(rows), 8)
        if not TIP.exists():
            print(f"skipped, there is no {TIP}: the same in the tip")
        programs = [(SLAVE, rows[:4])] + ([(TIP, rows[4:])] if TIP.exists() else [])
        for program, causes in programs:
            for frame, instruction, routine, contact, value in causes:
                with self.subTest(program=program, frame=frame):
                    out = self.ends(FINE, "debug", program, "-x",
                                    f"continue 2s; break unanswered; send {frame}; continue; why; rwhy; history 9").stdout
                    place, history = out.split("(s7200) rwhy\n")[1].split("(s7200) history 9\n")
                    self.assertIn(f"  {routine} ", place)
                    self.assertRegex(place, r" > +\d+  " + r" +".join(map(re.escape, instruction.split())))
                    self.assertRegex(history, r" +".join(map(re.escape, contact.split())) + f" +S0={value}")

    def test_commands(self):
        missing = [name for name in self.TOOLS if not shutil.which(name)]
        count = 0
        for readme in sorted({*SOURCE.rglob("README.md"), *self.PAGES}):
            if "build" in readme.relative_to(SOURCE).parts:
                continue
            for block in self.blocks(readme):
                background = []
                for command, shown in block:
                    if not TIP.exists() and any(word in command for word in ("tip41", "seeds", "freeport_pc")):
                        print(f"skipped, there is no {TIP}: {command}")
                        continue
                    if command.split()[0] in missing:
                        print(f"skipped, {command.split()[0]} is not installed: {command}")
                        continue
                    with self.subTest(f"{readme.relative_to(SOURCE)}: {command}"):
                        if command.endswith(" &"):
                            background.append(self.start(command.removesuffix(" &"), shown))
                        else:
                            self.run_to_end(command, shown)
                        count += 1
                for process in background:
                    process.send_signal(signal.SIGINT)
                    self.assertLess(process.wait(timeout=120), UNUSABLE)
        self.assertGreater(count, 3)

    def test_each_row_of_the_tables_of_source_documents_names_a_command_that_works(self):
        for page, title, least in (("programs.md", "**Programs of the source documents**", 3),
                                   ("westinghouse.md", "**Protocols of the source documents.**", 10)):
            table = (SOURCE / "docs" / page).read_text(encoding="utf-8").split(title, 1)[1].split("\n|---", 1)[1].split("\n\n", 1)[0]
            commands = re.findall(r"\| `(s7200 [^`]+)`", table)
            self.assertGreaterEqual(len(commands), least, title)
            for command in commands:
                if "../shared/seeds" in command and not TIP.exists():
                    print(f"skipped, there is no {TIP}: {command}")
                    continue
                with self.subTest(command):
                    if command.endswith(" menu"):
                        self.quit_menu(command)
                    else:
                        self.run_to_end(command, "")

    def quit_menu(self, command):
        """On a terminal: it shows itself, and Q ends it."""
        here, there = pty.openpty()
        termios.tcsetwinsize(there, (24, 80))
        with subprocess.Popen(["bash", "-c", command], stdin=there, stdout=there, stderr=there, **self.surroundings()) as process:
            os.close(there)
            shown, asked = b"", False
            with contextlib.suppress(OSError):  # the terminal is gone with the process
                while piece := os.read(here, 4096):
                    shown += piece
                    if b"loopback" in shown and not asked:  # it has the terminal to itself by now
                        asked = os.write(here, b"q\r") > 0
            self.assertEqual(process.wait(timeout=60), FINE, shown)
        os.close(here)
        self.assertIn(b"loopback", shown)

    def run_to_end(self, command, shown):
        done = subprocess.run(["bash", "-c", command], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
                              check=False, **self.surroundings())
        finds = any(part in command for part in self.NOT_RIGHT) and "--repair" not in command
        expected = FAILED if finds else FINE
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        self.assertRegex(done.stderr + done.stdout, self.pattern(shown))

    def start(self, command, shown):
        """A bridge says on standard error when it serves; a moment later the program has had its first scan."""
        process = subprocess.Popen(["bash", "-c", f"exec {command}"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True, **self.surroundings())
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        self.assertRegex(process.stderr.readline(), self.pattern(shown))
        time.sleep(1)
        return process

    def surroundings(self):
        return {"cwd": self.tree(),
                "env": {**os.environ, "PATH": f"{pathlib.Path(S7200).parent}:{os.environ['PATH']}", "NO_COLOR": "1"}}

    @staticmethod
    def pattern(shown):
        lines = shown.split("\n")[:-1]
        return r"\A" + "".join("(?s:.*?)" if line == "…" else re.escape(line) + r"\n" for line in lines)

    def tree(self):
        """The folder to run in: what the commands name is there, and what they write does no harm."""
        tree = self.folder / "s7200"
        if not tree.exists():
            tree.mkdir()
            for name in ("stl_programs", "tests", "tools"):
                (tree / name).symlink_to(SOURCE / name)
            (self.folder / "shared").symlink_to(TIP.parent.parent)
        return tree

    @staticmethod
    def blocks(readme):
        """[[[command, what is shown below it]]], without those that build."""
        found, inside = [], False
        for line in readme.read_text(encoding="utf-8").split("\n"):
            if line.startswith("```"):
                inside = line == "```sh"
                found.append([])
            elif inside and line.startswith("$ "):
                found[-1].append([line[2:], ""])
            elif inside:
                found[-1][-1][1] += line + "\n"
        return [[entry for entry in block if not entry[0].startswith(("./tools/", "cmake", "ctest"))] for block in found]


if __name__ == "__main__":
    group = {"verbs": Verbs, "options": Options, "json": Json, "json_page": JsonPage, "inspect": Inspect, "coverage": Coverage, "compare": Compare, "fuzz": Fuzz, "files": Files, "readme": Readme, "scenarios": Scenarios,
             "input": StandardInput, "times": Times, "systems": Systems}[GROUP]
    result = unittest.TextTestRunner(stream=sys.stdout).run(unittest.defaultTestLoader.loadTestsFromTestCase(group))
    sys.exit(0 if result.wasSuccessful() else 1)
