#!/usr/bin/env python3
"""The command in bad surroundings: run.py S7200 SOURCE_DIR streams|signals|files|text SLOW_LOOK_UP

streams   standard input, output and error closed, full, or abandoned by their reader, for every verb and every output
signals   Ctrl-C, SIGTERM and SIGHUP in every wait
files     what may be written over, links, files named twice, full disks
text      hostile names and contents, and files that are not programs

Nothing here depends on how fast the computer is: what has to come is waited for, for long. SLOW_LOOK_UP is a library for
LD_PRELOAD that makes looking up a host name endless.
"""
import contextlib
import fcntl
import itertools
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest

S7200, SOURCE, GROUP, SLOW_LOOK_UP = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3], sys.argv[4]
SLAVE = str(SOURCE / "stl_programs/modbus_slave.stl")
VERBS = [name.replace("_", "-")
         for name in re.findall(r"^void add_(\w+)\(CLI::App", (SOURCE / "tools/command/verbs/commands.hpp").read_text(encoding="utf-8"), re.M)
         if name != "view"]  # it serves until it is interrupted: servers.py
FINE, FAILED, UNUSABLE, FATAL = range(4)
LONG = 120  # seconds, for what has to come
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

IDLE = "LD SM0.0\nMEND\n"
ECHO = ("LD SM0.1\nMOVB 16#09, SMB30\nMOVB 1, VB0\nATCH 0, 8\nENI\nMEND\n"
        "INT 0\nLD SM0.0\nMOVB SMB2, VB1\nXMT VB0, 0\nLDN Q0.0\n= Q0.0\nRETI\n")
BLINKING = "LD SM0.0\nATCH 0, 10\nMOVB 5, SMB34\nENI\nLD SM0.5\n= Q0.0\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n"
SCENARIO = "program: {program}\nname: {name}\nsteps:\n  - {{send: ab, expect: ab}}\n"
SESSION = ["read", "40001:2", "write", "40005=7"]


def s7200(*arguments, **options):
    options = {"stdin": subprocess.DEVNULL, "capture_output": True, "timeout": LONG, **options}
    return subprocess.run([S7200, *map(str, arguments)], check=False, **options)


def file_outputs(verb):
    """Every option of a verb that writes a file, as its help tells."""
    text = s7200(verb, "--help-all").stdout.decode()
    return set(re.findall(r"(?m)^  (-[-\w]+)(?:,--\w+)? FILE\S*\s+.*(?:\n {30}.*)?\b(?:write|written)\b",
                          text))


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.idle, self.echo = self.file("idle.stl", IDLE), self.file("echo.stl", ECHO)
        self.blinking = self.file("blinking.stl", BLINKING)
        self.good = self.file("good.yaml", SCENARIO.format(program=self.echo, name="good"))
        self.log = self.folder / "plant.log"  # without the request at its end, which a note would name
        self.log.write_text("".join((SOURCE / "tests/recordings/plant.log").open(encoding="utf-8").readlines()[:-1]), encoding="utf-8")
        self.page = self.file("page.txt", "A page of prose, which tells at some length what the lamp over the door of the plant does.\n\nNETWORK 1\n"
                                          "LD SM0.0 // always\nMOVB 1, VB0\nMEND\n")

    def file(self, name, content):
        path = self.folder / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content, encoding="utf-8")
        return path

    def ends(self, code, *arguments, **options):
        done = s7200(*arguments, **options)
        self.assertEqual(done.returncode, code, (arguments, done.stdout, done.stderr))
        return done

    def start(self, *arguments, **options):
        options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
        process = subprocess.Popen([S7200, *map(str, arguments)], **options)
        self.addCleanup(self.kill, process)
        return process

    @staticmethod
    def kill(process):
        if process.poll() is None:
            process.kill()
        process.communicate()

    def eventually(self, condition, what):
        until = time.monotonic() + LONG
        while not (value := condition()):
            self.assertLess(time.monotonic(), until, what)
            time.sleep(0.02)
        return value

    def outputs(self, verb):
        """{name of the file: the option with it}, for every file that a verb may write; the names lie in `folder`/out."""
        records = {"run.trace": "--trace", "outputs.csv": "--output", "line.vcd": "--capture", "line.pcap": "--capture",
                   "memory.json": "--memory"}
        return {"run": records, "send": records, "master": records, "debug": records, "dap": records, "import": {"listing.stl": "-o"},
                "convert": {"converted.stl": "-o"}, "inspect": {"ladder.svg": "--svg"}, "calibrate": {"times.csv": "-o"}, "import-capture": {"plant.yaml": "-o"},
                "test": {"junit.xml": "--junit", "summary.md": "--markdown", "transcript.yaml": "--record"}}.get(verb, {})

    # Files about a result, which tests/command_line has, and this file does not: they are written once, at the end.
    RESULTS = {"compare": {"--write"}, "run": {"--coverage-html", "--coverage-lcov", "--profile-folded"},
               "test": {"--coverage-html", "--coverage-lcov", "--profile-folded"}}

    def command(self, verb, out=None):
        """A command of each verb that does something; with all its files, if `out` is a folder for them."""
        files = [] if out is None else [word for name, option in self.outputs(verb).items() for word in (option, out / name)]
        return {"check": ["check", self.echo], "inspect": ["inspect", self.echo, "ladder"], "why": ["why", self.echo, "Q0.0"], "compare": ["compare", self.echo, self.echo], "fuzz": ["fuzz", self.echo, "--runs", "200"], "import": ["import", self.page],
                "convert": ["convert", self.echo, "--to", "iec"], "run": ["run", self.blinking, "--for", "2s"],
                "send": ["send", self.echo, "ab", "cd"], "test": ["test", self.good], "decode": ["decode", self.log], "import-capture": ["import-capture", self.log], "master": ["master", SLAVE, *SESSION],
                "debug": ["debug", self.echo, "-x", "step 3; regs"], "dap": ["dap", self.echo], "instructions": ["instructions"], "times": ["times"],
                "bench": ["bench", "--each", "1ms"],
                "calibrate": ["calibrate", SOURCE / "stl_programs/measure_times.stl", "--each", "1s", "--json"]}[verb] + files

    def written(self, verb, out):
        return {name: (out / name).read_bytes() for name in self.outputs(verb)}


# --- streams ---

@contextlib.contextmanager
def broken(how):
    """A descriptor for Popen: one that takes nothing, or whose reader has gone."""
    if how == "full":
        with open("/dev/full", "wb") as full:
            yield full
    else:
        reader, writer = os.pipe()
        os.close(reader)
        yield writer
        os.close(writer)


def run_with(streams, arguments, **options):
    """`streams`: {0, 1 or 2: "closed", "full" or "gone"}."""
    redirections = " ".join({0: "<&-", 1: ">&-", 2: "2>&-"}[fd] for fd, how in streams.items() if how == "closed")
    command = ["bash", "-c", f'exec "$0" "$@" {redirections}', S7200, *map(str, arguments)]
    with contextlib.ExitStack() as stack:
        given = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        for fd, how in streams.items():
            if how != "closed":
                given[("stdin", "stdout", "stderr")[fd]] = stack.enter_context(broken(how))
        return subprocess.run(command, check=False, timeout=LONG, **given, **options)


HOW = ("closed", "full", "gone") if os.path.exists("/dev/full") else ("closed", "gone")


class Streams(Case):
    def setUp(self):
        super().setUp()
        for name in ("before", "out"):
            (self.folder / name).mkdir()

    def fresh(self):
        shutil.rmtree(self.folder / "out")
        (self.folder / "out").mkdir()
        return self.folder / "out"

    def expected(self, verb):
        """How the command ends in good surroundings: exit code, what it prints, what it writes."""
        done = s7200(*self.command(verb, self.fresh()))
        return done.returncode, done.stdout, self.files(verb)

    def files(self, verb):
        written = self.written(verb, self.folder / "out")
        if "junit.xml" in written:  # with the time that each scenario took
            written["junit.xml"] = re.sub(rb' time="[\d.]*"', b"", written["junit.xml"])
        return written

    def test_every_verb_and_every_file_that_it_writes_is_here(self):
        for verb in VERBS:
            with self.subTest(verb):
                self.assertEqual(self.ends(FINE, *self.command(verb)).stderr, b"")
                self.assertEqual(file_outputs(verb) - {"--pty"}, set(self.outputs(verb).values()) | self.RESULTS.get(verb, set()))

    def test_a_standard_error_that_cannot_be_written_changes_nothing(self):
        for verb in VERBS:
            code, printed, written = self.expected(verb)
            for how in HOW:
                with self.subTest(verb=verb, how=how):
                    done = run_with({2: how}, self.command(verb, self.fresh()))
                    self.assertEqual(done.returncode, code)
                    if verb != "bench" and (verb != "import"):
                        self.assertEqual(done.stdout, printed)
                    self.assertEqual(self.files(verb), written)

    def test_messages_that_cannot_be_written_change_no_exit_code(self):
        wrong = self.file("wrong.stl", "LD SM0.0\nFROB\nMEND\n")
        yaml = self.file("wrong.yaml", "steps: [{frob: 1}]\n")
        for arguments in (["check", wrong], ["run", wrong], ["run", "missing.stl"], ["frobnicate"], ["run", self.idle, "--frob"],
                          ["send", self.idle, "01", "--timeout", "1ms"], ["test", yaml], ["master", "tcp://127.0.0.1:1", "slave-id"],
                          ["debug", self.idle, "-x", "frob"], ["import", "missing.txt"], ["instructions", "FROB"],
                          ["run", self.idle, "--trace", self.idle], ["run", self.idle, "--fault", "frob"],
                          ["run", self.idle, "--times", self.idle]):
            code = s7200(*arguments).returncode
            self.assertGreater(code, FINE)
            for how in HOW:
                with self.subTest(arguments=arguments, how=how):
                    self.assertEqual(run_with({2: how}, arguments).returncode, code)

    def test_a_standard_output_that_cannot_be_written_is_an_error_and_no_file_is_lost(self):
        for verb in VERBS:
            _, printed, written = self.expected(verb)
            for how in HOW:
                with self.subTest(verb=verb, how=how):
                    done = run_with({1: how}, self.command(verb, self.fresh()))
                    error = done.stderr.decode()
                    if not printed:  # everything went to its file
                        self.assertEqual(done.returncode, FINE)
                    elif how == "gone":
                        self.assertEqual((done.returncode, error), (-signal.SIGPIPE, ""))
                    else:
                        self.assertEqual(done.returncode, UNUSABLE, error)
                        self.assertRegex(error, r"\As7200: error: cannot write to standard output: .+\n\Z")
                    self.assertEqual(self.files(verb), written)

    def test_help_and_version_are_results_too(self):
        for arguments in (["--help"], ["--version"], *([verb, "--help"] for verb in VERBS)):
            for how in HOW:
                with self.subTest(arguments=arguments, how=how):
                    self.assertEqual(run_with({1: how}, arguments).returncode, -signal.SIGPIPE if how == "gone" else UNUSABLE)

    def test_json_that_cannot_be_written_loses_no_file(self):
        for verb in ("run", "send", "master", "test"):
            _, _, written = self.expected(verb)
            for how in HOW:
                with self.subTest(verb=verb, how=how):
                    done = run_with({1: how}, [*self.command(verb, self.fresh()), "--json"])
                    self.assertEqual(done.returncode, -signal.SIGPIPE if how == "gone" else UNUSABLE)
                    self.assertEqual(self.files(verb), written)

    def test_a_standard_input_that_is_closed_is_only_missed_where_it_is_read(self):
        for verb in VERBS:
            code, printed, written = self.expected(verb)
            with self.subTest(verb):
                done = run_with({0: "closed"}, self.command(verb, self.fresh()))
                if verb == "dap":  # that is where it hears from its client
                    self.assertIn(b"standard input cannot be read", done.stderr)
                    code = UNUSABLE
                self.assertEqual((done.returncode, self.files(verb)), (code, written), done.stderr)
                if verb != "bench":
                    self.assertEqual(done.stdout, printed)
        done = run_with({0: "closed"}, ["debug", self.idle])
        self.assertEqual(done.returncode, UNUSABLE)
        self.assertIn(b"cannot read standard input", done.stderr)
        self.assertEqual(run_with({0: "closed"}, ["check", "/dev/stdin"]).returncode, UNUSABLE)

    def test_no_file_gets_the_number_of_a_closed_descriptor(self):
        for verb in VERBS:
            _, _, written = self.expected(verb)
            for closed in itertools.chain.from_iterable(itertools.combinations(range(3), n) for n in (1, 2, 3)):
                with self.subTest(verb=verb, closed=closed):
                    run_with({fd: "closed" for fd in closed}, self.command(verb, self.fresh()))
                    self.assertEqual(self.files(verb), written)

    def test_a_bridge_says_nothing_into_its_files(self):
        trace, memory = self.folder / "out/run.trace", self.folder / "out/memory.json"
        for bridge, where in (("--tcp", "0"), ("--modbus-tcp", "0"), ("--pty", self.folder / "plc")):
            with self.subTest(bridge):
                self.fresh()
                run_with({0: "closed", 1: "closed", 2: "closed"},
                         ["run", self.idle, bridge, where, "--for", "50ms", "--trace", trace, "--memory", memory])
                self.assertRegex(trace.read_text(encoding="utf-8"), r"\A# time in ms   what\n +0\.000000  RUN\n +0\.\d+  main program: no network has power flow\n\Z")
                self.assertEqual(json.loads(memory.read_bytes())["format"], "s7200 memory 1")
                self.assertFalse(os.path.lexists(self.folder / "plc"))

    def test_a_bridge_whose_messages_no_one_reads_any_more_goes_on(self):
        memory, trace = self.folder / "memory.json", self.folder / "run.trace"
        process = self.start("run", SLAVE, "--modbus-tcp", "0", "--json", "--memory", memory, "--trace", trace)
        port = int(re.search(rb":(\d+)", process.stderr.readline()).group(1))
        process.stderr.close()
        for _ in range(3):  # each is worth a note
            with socket.create_connection(("127.0.0.1", port), LONG) as client:
                client.sendall(b"GET / HTTP/1.1\r\n\r\n" * 20)
                while client.recv(1000):
                    pass
        process.send_signal(signal.SIGINT)
        out = process.stdout.read()
        self.assertEqual(process.wait(LONG), FINE)
        self.assertEqual(json.loads(out)["stop_reason"], "interrupted")
        self.assertEqual(json.loads(memory.read_bytes())["format"], "s7200 memory 1")
        self.assertTrue(trace.read_bytes().endswith(b"\n"))

    def test_a_run_whose_results_no_one_reads_any_more_ends_with_its_files(self):
        memory, trace = self.folder / "memory.json", self.folder / "run.trace"
        for output, other, path in (("--trace", "--output", trace), ("--output", "--trace", trace)):
            with self.subTest(output):
                process = self.start("run", self.blinking, "--for", "9999h", "--record-limit", "none",
                                     output, "-", other, path, "--memory", memory)
                process.stdout.readline()
                process.stdout.close()
                self.assertEqual(process.wait(LONG), -signal.SIGPIPE)
                self.assertEqual(process.stderr.read(), b"")
                self.assertEqual(json.loads(memory.read_bytes())["format"], "s7200 memory 1")
                self.assertTrue(path.read_bytes().endswith(b"\n"))
                path.unlink()

    def test_polling_for_no_one_ends(self):
        for verbose in ([], ["--verbose"]):
            process = self.start("master", SLAVE, "read", "40001", "--every", "1ms", "--count", "1000000000", *verbose)
            process.stdout.readline()
            process.stdout.close()
            self.assertEqual(process.wait(LONG), -signal.SIGPIPE)
            self.assertEqual(process.stderr.read(), b"")

    def test_pipelines_end_quietly(self):
        for arguments in (["instructions"], ["times", "--csv"], ["run", self.blinking, "--trace", "-", "--for", "9999h"],
                          ["send", self.echo, "ab", "--json"], ["debug", self.blinking, "-x", "trace on; continue 9999h"]):
            with self.subTest(arguments):
                done = subprocess.run(["bash", "-c", '"$0" "$@" | head -n 1', S7200, *map(str, arguments)], stdin=subprocess.DEVNULL,
                                      capture_output=True, timeout=LONG, check=False)
                self.assertEqual((done.returncode, done.stderr), (0, b""))
                self.assertEqual(done.stdout.count(b"\n"), 1)


# --- signals ---

def catches(process, number):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
    caught = int(re.search(r"(?m)^SigCgt:\s*(\w+)$", status).group(1), 16) >> (number - 1) & 1
    return caught or process.poll() is not None


def processor_time(process):
    """In seconds, in user mode."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return int(fields[11]) / os.sysconf("SC_CLK_TCK")


def blocked(process, pipe):
    """Whether a process sleeps because `pipe`, which it writes, is full."""
    waiting = struct.unpack("i", fcntl.ioctl(pipe, termios.FIONREAD, b"\0" * 4))[0]
    state = pathlib.Path(f"/proc/{process.pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    return state == "S" and waiting > fcntl.fcntl(pipe, fcntl.F_GETPIPE_SZ) - 2 * resource.getpagesize()


class Signals(Case):
    def ended(self, process, number):
        """The exit code after a signal, which comes as soon as it is only noted, or at once if it is not."""
        process.send_signal(number)
        process.out, process.error = process.communicate(timeout=LONG)
        return process.returncode

    def noted(self, process, number):
        self.eventually(lambda: catches(process, number), "the signal is not caught")
        return self.ended(process, number)

    def test_every_wait_of_the_simulation(self):
        yaml = self.file("wait.yaml", f"program: {self.echo}\nsteps: [{{repeat: 4000, steps: [{{wait: 24h}}]}}]\n")
        answer = self.file("answer.yaml", f"program: {self.idle}\nafter: 1ms\n"
                                            "steps: [{repeat: 4000, steps: [{send: ab, timeout: 24h}]}]\n")
        system = self.file("system.yaml", f"plcs: {{a: {{program: {self.idle}}}}}\nlines: {{l: {{stations: [a]}}}}\n")
        for arguments, code in ((["send", self.idle, "01", "--timeout", "9999h"], FAILED),
                                (["send", self.idle, "01", "--after", "9999h"], FAILED),
                                (["send", self.echo, "01", "02", "--pause", "9999h", "--no-skip"], FAILED),
                                (["run", self.idle, "--for", "9999h"], FAILED), (["run", self.idle, "--scans", str(2**62)], FAILED),
                                (["run", self.idle, "--for", "9999h", "--trace-instructions", "--trace", "/dev/null"], FAILED),
                                (["run", self.idle, "--for", "9999h", "--realtime"], FAILED),
                                (["run", self.idle, "--for", "9999h", "--speed", "0.001"], FAILED), (["run", system, "--for", "9999h"], FAILED),
                                (["run", self.idle, "--tcp", "0", "--for", "9999h"], FAILED),
                                (["master", SLAVE, "read", "40001", "--every", "9999h", "--count", "3", "--no-skip"], FAILED),
                                (["master", SLAVE, "read", "40001", "wait", "9999h", "--no-skip"], FAILED),
                                (["master", self.idle, "slave-id", "--timeout", "9999h"], FAILED),
                                (["master", SLAVE, "read", "40001", "--after", "9999h", "--no-skip"], FAILED),
                                (["test", yaml], FAILED), (["test", yaml, "--jobs", "2"], FAILED), (["test", answer], FAILED),
                                (["test", yaml, "--against", self.echo], FAILED),
                                (["debug", self.idle, "-x", "watch VW0; continue 9999h"], FAILED)):  # a watch looks at every scan
            for number in SIGNALS:
                with self.subTest(arguments=arguments, number=number):
                    process = self.start(*arguments)
                    self.assertEqual(self.noted(process, number), code, process.error)

    def test_a_bridge_that_serves_is_ended_by_it(self):
        for number in SIGNALS:
            with self.subTest(number=number):
                process = self.start("run", self.idle, "--tcp", "0")
                self.assertIn(b"listening", process.stderr.readline())
                self.assertEqual(self.ended(process, number), FINE, process.error)

    def test_a_server_for_editors_completes_the_files_of_its_plc(self):
        def message(number, command, **arguments):
            content = json.dumps({"seq": number, "type": "request", "command": command, "arguments": arguments}).encode()
            return b"Content-Length: %d\r\n\r\n%s" % (len(content), content)
        trace = self.folder / "run.trace"
        running = message(1, "initialize") + message(2, "attach", stopOnEntry=False) + message(3, "configurationDone")
        for listening, said in ((False, b""), (False, running), (True, b"")):
            for number in SIGNALS:
                with self.subTest(listening=listening, said=said, number=number):
                    trace.unlink(missing_ok=True)
                    process = self.start("dap", *(["--listen", "0"] if listening else []), self.blinking, "--trace", trace,
                                         stdin=subprocess.PIPE)
                    if listening:
                        self.assertIn(b"listening", process.stderr.readline())
                    process.stdin.write(said)
                    process.stdin.flush()
                    heard = b""
                    while said and b'"process"' not in heard:
                        heard += process.stdout.read1()
                    self.eventually(trace.exists, "the program is not loaded")
                    self.assertEqual(self.noted(process, number), FINE if listening else FAILED, process.error)
                    self.assertTrue(trace.read_bytes().endswith(b"\n"))

    def test_a_bridge_removes_its_link_and_completes_its_files(self):
        link, memory, trace = self.folder / "plc", self.folder / "memory.json", self.folder / "run.trace"
        for number in SIGNALS:
            with self.subTest(number):
                process = self.start("run", self.blinking, "--pty", link, "--memory", memory, "--trace", trace, "--capture",
                                     self.folder / "line.vcd", "--json")
                self.assertIn(b"serving", process.stderr.readline())
                self.assertEqual(self.ended(process, number), FINE)
                self.assertEqual(json.loads(process.out)["stop_reason"], "interrupted")
                self.assertFalse(os.path.lexists(link))
                self.assertEqual(json.loads(memory.read_bytes())["format"], "s7200 memory 1")
                self.assertTrue(trace.read_bytes().endswith(b"\n"))
                self.assertTrue((self.folder / "line.vcd").read_bytes().endswith(b"\n"))

    def test_results_up_to_there_are_written(self):
        yaml = self.file("two.yaml", f"program: {self.echo}\nscenarios:\n  - {{name: quick, steps: [{{send: ab}}]}}\n"
                                     "  - {name: endless, steps: [{repeat: 4000, steps: [{wait: 24h}]}]}\n")
        for number in SIGNALS:
            with self.subTest(number):
                junit, transcript = self.folder / "junit.xml", self.folder / "transcript.yaml"
                process = self.start("test", yaml, "--junit", junit, "--record", transcript, "--force")
                while b"quick" not in (line := process.stdout.readline()):
                    self.assertTrue(line, "it has ended")
                self.assertEqual(self.ended(process, number), FAILED)
                self.assertIn(b"note: interrupted", process.error)
                self.assertIn(b'name="quick"', junit.read_bytes())
                self.assertIn(b'name: "quick"', transcript.read_bytes())

    def test_reading_a_pipe_that_no_one_writes(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        named = self.file("named.yaml", f"program: {pipe}\nsteps: [{{wait: 1ms}}]\n")
        inputs = self.file("inputs.yaml", f"program: {self.echo}\ninput: {pipe}\nsteps: [{{wait: 1ms}}]\n")
        for arguments in (["check", pipe], ["import", pipe], ["run", pipe], ["send", pipe, "01"], ["test", pipe], ["test", named],
                          ["test", inputs], ["test", self.good, "--target", pipe], ["test", self.good, "--with", pipe],
                          ["test", "--conformance", pipe], ["master", pipe, "slave-id"], ["debug", pipe], ["bench", pipe],
                          ["debug", self.idle, "--commands", pipe], ["run", self.idle, "--input", pipe],
                          ["run", self.idle, "--times", pipe], ["send", self.idle, "--frames", pipe], ["times", "--times", pipe],
                          ["instructions", "--times", pipe], ["master", SLAVE, "slave-id", "--input", pipe]):
            for number in SIGNALS:
                with self.subTest(arguments=arguments, number=number):
                    process = self.start(*arguments)
                    self.assertEqual((self.noted(process, number), process.error), (FAILED, b"s7200: note: interrupted\n"))
                    self.assertEqual(process.out, b"")

    def test_reading_a_long_recording(self):
        frame, modbus = "01 03 00 00 00 01 84 0a", "b'\\x01\\x03\\x00\\x00\\x00\\x01\\x84\\n'"
        rows = {"log.txt": f"10:00:00.000 TX {frame}\n", "log.csv": f"1.5,{frame}\n", "python.log": f"10:00:00.000 {modbus}\n",
                "lines.json": '{"time": 1.5, "direction": "tx", "data": "%s"}\n' % frame, "pairs.log": f'time=1.5 dir=tx data="{frame}"\n'}
        for name, row in rows.items():
            head = "Time [s],Data\n" if name == "log.csv" else ""
            path = self.file(name, head + row * (40_000_000 // len(row)))
            for verb, number in (("decode", signal.SIGINT), ("import-capture", signal.SIGTERM)):
                with self.subTest(name=name, verb=verb):
                    process = self.start(verb, path, "--json")
                    self.eventually(lambda process=process: catches(process, signal.SIGALRM), "signals are not only noted")
                    begun = time.monotonic()
                    self.assertEqual(self.ended(process, number), FAILED)
                    self.assertLess(time.monotonic() - begun, 5)  # the whole file takes longer
                    self.assertIn(b"s7200: note: interrupted", process.error)
                    self.assertEqual(json.loads(process.out)["s7200"]["verb"], verb)
            pathlib.Path(path).unlink()

    def test_long_analyses(self):
        """Many ways lead through a program whose subroutines look at forty words and write them."""
        text, drawn = "LD SM0.0\n", itertools.cycle(number * 7 % 40 for number in range(40))
        for call in range(40):
            text += f"LDW= VW{2 * next(drawn)}, {call % 8}\nCALL {1 + call % 24}\n"
        text += "MEND\n"
        for routine in range(1, 25):
            text += f"SBR {routine}\n"
            for way in range(14):
                text += f"LD I{way % 2}.{way % 8}\nMOVW {(way * routine) % 8}, VW{2 * next(drawn)}\n"
                if routine < 24 and way in (5, 10):
                    text += f"LDW= VW{2 * next(drawn)}, {routine % 8}\nCALL {routine + 1}\n"
            text += "RET\n"
        program = self.file("ways.stl", text)
        for number in SIGNALS:
            with self.subTest(number):
                process = self.start("inspect", program, "bounds", "--cpu", "224")
                self.eventually(lambda process=process: processor_time(process) > 0.3, "it does not work")
                self.assertEqual(self.ended(process, number), FAILED)
                self.assertEqual(process.out, b"interrupted before the bounds were known\n")
                self.assertTrue(process.error.endswith(b"s7200: note: interrupted\n"), process.error)
        process = self.start("inspect", program, "document", "--cpu", "224", "--json")
        self.eventually(lambda: processor_time(process) > 0.3, "it does not work")
        self.assertEqual(self.ended(process, signal.SIGTERM), FAILED)
        self.assertIn("interrupted before the bounds were known", json.loads(process.out)["files"][0]["document"])

    def test_writing_a_pipe_that_no_one_reads(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        memory = self.folder / "memory.json"
        for number in SIGNALS:
            with self.subTest(number):
                process = self.start("run", self.idle, "--trace", pipe, "--output", self.folder / "outputs.csv")
                self.assertEqual((self.noted(process, number), process.error), (FAILED, b"s7200: note: interrupted\n"))
                self.assertFalse((self.folder / "outputs.csv").exists())
                process = self.start("run", self.blinking, "--trace", pipe, "--for", "9999h", "--memory", memory)
                with open(pipe, "rb") as reader:
                    self.eventually(lambda reader=reader, process=process: blocked(process, reader), "the pipe is not full")
                    self.assertEqual(self.ended(process, number), UNUSABLE)
                self.assertIn(b"cannot write all of", process.error)
                self.assertTrue(memory.exists())
                memory.unlink()

    def test_a_standard_output_that_no_one_reads(self):
        for number in SIGNALS:
            with self.subTest(number):
                process = self.start("run", self.blinking, "--trace", "-", "--for", "9999h")
                self.eventually(lambda process=process: blocked(process, process.stdout), "the pipe is not full")
                process.send_signal(number)
                self.assertEqual(process.wait(LONG), UNUSABLE)
                self.assertIn(b"cannot write to standard output", process.stderr.read())

    def test_a_second_ctrl_c_kills_at_once(self):
        process = self.start("run", self.blinking, "--trace", "-", "--for", "9999h")
        self.eventually(lambda: blocked(process, process.stdout), "the pipe is not full")
        while process.poll() is None:  # the first is noted, and the reader has some time left
            process.send_signal(signal.SIGINT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(0.05)
        self.assertEqual(process.returncode, -signal.SIGINT)

    def test_neither_sigterm_nor_sighup_kill_when_they_come_twice(self):
        memory = self.folder / "memory.json"
        process = self.start("run", self.idle, "--for", "9999h", "--memory", memory)
        self.eventually(lambda: catches(process, signal.SIGALRM), "signals do not wait for what is to be completed")
        with contextlib.suppress(ProcessLookupError):
            for number in (signal.SIGTERM, signal.SIGHUP) * 5:
                process.send_signal(number)
        self.assertEqual(process.wait(LONG), FAILED)
        self.assertTrue(memory.exists())

    def test_nohup_is_respected(self):
        link = self.folder / "plc"
        process = subprocess.Popen(["nohup", S7200, "run", SLAVE, "--pty", link], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        self.addCleanup(self.kill, process)
        self.eventually(lambda: os.path.lexists(link), "it does not serve")
        for _ in range(10):
            process.send_signal(signal.SIGHUP)
            time.sleep(0.05)
        self.assertTrue(os.path.lexists(link))
        self.assertIsNone(process.poll())
        self.assertEqual(self.ended(process, signal.SIGTERM), FINE)

    def test_looking_up_a_host_name(self):
        options = os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0"
        environment = {**os.environ, "LD_PRELOAD": SLOW_LOOK_UP, "ASAN_OPTIONS": options}
        yaml = self.file("live.yaml", "steps: [{read: holding 0}]\n")
        for arguments in (["master", "tcp://host.example:502", "slave-id"], ["master", "modbus-tcp://host.example", "slave-id"],
                          ["test", yaml, "--target", "modbus-tcp://host.example"]):
            for number in SIGNALS:
                with self.subTest(arguments=arguments, number=number):
                    process = self.start(*arguments, env=environment)
                    self.assertEqual(process.stderr.readline(), b"looking up\n")
                    self.assertEqual(self.noted(process, number), UNUSABLE)
                    self.assertIn(b"was not reached before the interruption", process.error)

    def test_connecting_and_waiting_for_an_answer(self):
        yaml = self.file("live.yaml", "timeout: 24h\nsteps: [{read: holding 0}]\n")
        with socket.create_server(("127.0.0.1", 0), backlog=0) as server:
            port = server.getsockname()[1]
            waiting = [socket.create_connection(("127.0.0.1", port), LONG)]  # as many as the system takes for us
            for _ in range(10):
                more = socket.socket()
                more.settimeout(0.2)
                with contextlib.suppress(TimeoutError):
                    more.connect(("127.0.0.1", port))
                waiting.append(more)
            for target, number in itertools.product((f"tcp://127.0.0.1:{port}", f"modbus-tcp://127.0.0.1:{port}"), SIGNALS):
                for arguments in (["master", target, "slave-id", "--retries", "1000000"], ["test", yaml, "--target", target]):
                    with self.subTest(connecting=arguments, number=number):
                        self.assertIn(self.noted(self.start(*arguments), number), (UNUSABLE, FAILED))  # FAILED if it was let in
            for each in waiting:
                each.close()
        with socket.create_server(("127.0.0.1", 0)) as server:
            target = f"tcp://127.0.0.1:{server.getsockname()[1]}"
            for arguments in (["master", target, "slave-id", "--timeout", "9999h"], ["test", yaml, "--target", target]):
                for number in SIGNALS:
                    with self.subTest(waiting=arguments, number=number):
                        process = self.start(*arguments)
                        client, _ = server.accept()
                        with client:
                            client.recv(1)
                            self.assertEqual(self.noted(process, number), FAILED)
                            self.assertIn(b"interrupted", process.error)

    def test_a_debugger_that_waits_for_commands(self):
        for number in SIGNALS:
            with self.subTest(number):
                process = self.start("debug", self.idle, stdin=subprocess.PIPE)
                process.stdin.write(b"step\n")
                process.stdin.flush()
                self.assertEqual(self.noted(process, number), FAILED)

    def test_ctrl_c_at_the_prompt_gives_a_new_one_and_sigterm_ends(self):
        try:
            near, far = os.openpty()
        except OSError as error:
            self.skipTest(f"no terminal can be opened here: {error}")
        process = self.start("debug", self.idle, stdin=far)
        os.close(far)
        self.addCleanup(os.close, near)
        for count in (1, 2, 3):
            heard = b""
            while b"(s7200) " not in heard:
                heard += os.read(process.stdout.fileno(), 1000)
            if count < 3:
                process.send_signal(signal.SIGINT)
        os.write(near, b"watch VW0; continue 9999h\n")
        time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        heard = b""
        while b"(s7200) " not in heard:
            heard += os.read(process.stdout.fileno(), 1000)
        self.assertEqual(self.ended(process, signal.SIGTERM), FAILED)

    def test_what_measures_and_what_waits_for_a_program(self):
        for arguments, number in itertools.product((["bench", "--each", "1h"], ["check", "-"]), SIGNALS):
            with self.subTest(arguments=arguments, number=number):
                process = self.start(*arguments, stdin=subprocess.PIPE)
                self.assertEqual(self.noted(process, number), FAILED)
                self.assertIn(b"interrupted", process.error)


# --- files ---

class Files(Case):
    def tree(self):
        """All there is, so that it can be seen that nothing has changed."""
        return {path.relative_to(self.folder): (os.readlink(path) if path.is_symlink() else
                                                path.read_bytes() if path.is_file() else path.stat().st_mode)
                for path in sorted(self.folder.rglob("*"))}

    def options(self):
        """(verb, command without the file, option, name of a file)"""
        for verb in VERBS:
            for name, option in self.outputs(verb).items():
                yield verb, self.command(verb), option, name

    def refused(self, *arguments):
        before = self.tree()
        done = self.ends(UNUSABLE, *arguments)
        self.assertEqual(done.stdout, b"")
        self.assertEqual(self.tree(), before)
        return done.stderr.decode()

    def test_only_what_the_option_wrote_is_replaced(self):
        for verb, command, option, name in self.options():
            foreign = {"text": b"mine\n", "xml": b'<?xml version="1.0" encoding="UTF-8"?>\n<project/>\n', "json": b"{}\n"}
            path = self.folder / name
            self.ends(FINE, *command, option, path)
            force = ["--force"] if option in ("--record", "-o") else []
            self.ends(FINE, *command, option, path, *force)
            written = path.read_bytes()
            for other in ("run.trace", "outputs.csv", "line.vcd", "line.pcap", "memory.json"):
                if other != name:
                    self.ends(FINE, *self.command("run"), self.outputs("run")[other], self.folder / f"other.{other}")
                    foreign[other] = (self.folder / f"other.{other}").read_bytes()
            for kind, content in foreign.items():
                with self.subTest(verb=verb, option=option, kind=kind):
                    path.write_bytes(content)
                    self.assertRegex(self.refused(*command, option, path), "it is left alone|--force overwrites it")
            with self.subTest(verb=verb, option=option, kind="empty"):  # holds nothing of anybody's
                path.write_bytes(b"")
                self.ends(FINE, *command, option, path)
            path.write_bytes(written[:5])
            self.assertRegex(self.refused(*command, option, path), "it is left alone|--force overwrites it")
            path.unlink()

    def test_what_another_command_is_still_writing_is_left_alone(self):
        link, path = self.folder / "plc", self.folder / "line.pcap"
        first = self.start("run", SLAVE, "--pty", link, "--capture", path)
        self.eventually(lambda: os.path.lexists(link), "it does not serve")
        number = path.stat().st_ino
        again = ["run", SLAVE, "--for", "10ms", "--capture", path]
        self.assertIn(b"another program has it open for writing", self.ends(UNUSABLE, *again).stderr)
        first.send_signal(signal.SIGTERM)
        first.communicate(timeout=LONG)
        self.assertEqual(path.stat().st_ino, number)
        self.ends(FINE, *again)

    def test_links_are_not_followed(self):
        (self.folder / "sub").mkdir()
        for verb, command, option, name in self.options():
            path, target = self.folder / name, self.folder / "sub" / name
            self.ends(FINE, *command, option, target)
            for leads_to in (target, self.folder / "sub/nowhere", self.folder / "sub", "nowhere", self.echo):
                for force in ([], ["--force"]) if option in ("--record", "-o") else ([],):
                    with self.subTest(verb=verb, option=option, leads_to=leads_to, force=force):
                        path.symlink_to(leads_to)
                        self.assertRegex(self.refused(*command, option, path, *force), "is a link; it is left alone|the command reads this file")
                        path.unlink()
            target.unlink()
            (self.folder / "folder").symlink_to("sub")  # the way to a file may have links
            self.ends(FINE, *command, option, self.folder / "folder" / name)
            self.assertTrue(target.exists())
            target.unlink()
            (self.folder / "folder").unlink()

    def test_another_name_of_what_is_replaced_keeps_its_content(self):
        for verb, command, option, name in self.options():
            with self.subTest(verb=verb, option=option):
                path, kept = self.folder / f"{verb}.{name}", self.folder / f"kept.{verb}.{name}"
                self.ends(FINE, *command, option, path)
                os.link(path, kept)
                before = kept.read_bytes()
                longer = {"run": ["--dump", "VB0"], "send": ["ef"], "master": ["read", "40009"]}.get(verb, [])
                if verb in ("import", "import-capture", "convert", "calibrate", "test"):
                    longer = [] if option == "--junit" else ["--force"]
                self.ends(FINE, *command, *longer, option, path)
                self.assertEqual(kept.read_bytes(), before)
                self.assertNotEqual(path.stat().st_ino, kept.stat().st_ino)

    def test_two_outputs_never_share_a_file(self):
        (self.folder / "sub").mkdir()
        (self.folder / "same").symlink_to(".")
        for verb in ("run", "send", "master", "test"):
            pairs = itertools.combinations(self.outputs(verb).items(), 2)
            for (name, one), (_, other) in pairs:
                if one == other == "--capture":  # another kind has another name; the same one twice
                    pass
                elif "--capture" in (one, other):
                    name = "line.vcd"
                for again in (name, f"./{name}", f"sub/../{name}", f"same/{name}"):
                    with self.subTest(verb=verb, one=one, other=other, again=again):
                        named = ["--signals", "Q0.0"] if "--trace" in (one, other) and name == "line.vcd" else []
                        error = self.refused(*self.command(verb), *named, one, self.folder / name, other, self.folder / again)
                        self.assertIn("this file is named twice", error)
        hard = self.folder / "hard.vcd"
        self.ends(FINE, *self.command("run"), "--capture", self.folder / "line.vcd")
        os.link(self.folder / "line.vcd", hard)
        self.assertIn("named twice", self.refused(*self.command("run"), "--capture", self.folder / "line.vcd", "--capture", hard))

    def test_no_output_is_an_input(self):
        inputs = self.file("inputs.csv", "1ms,I0.0,1\n")
        hard = self.folder / "hard.stl"
        os.link(self.echo, hard)
        for verb, option in itertools.product(("run", "send"), ("--trace", "--output", "--memory")):
            command = [verb, self.echo, "--input", inputs, *(["ab"] if verb == "send" else ["--for", "1ms"])]
            for read in (self.echo, hard, inputs):
                with self.subTest(verb=verb, option=option, read=read):
                    named = ["--signals", "Q0.0"] if option == "--trace" and read == inputs else []
                    self.assertIn("the command reads this file", self.refused(*command, *named, option, read))
        # A transcript is a scenario; with --force it may take the place of the one that was replayed.
        self.ends(FINE, "test", self.good, "--record", self.folder / "t.yaml")
        self.refused("test", self.folder / "t.yaml", "--record", self.folder / "t.yaml")
        self.refused("test", self.good, "--record", self.good, "--force")
        self.refused("test", self.good, "--junit", self.good)
        self.refused("import", self.page, "-o", self.page)

    def test_no_output_is_a_file_that_the_shell_has_opened(self):
        out = self.folder / "run.trace"
        self.ends(FINE, *self.command("run"), "--trace", out)
        for redirected in ("stdout", "stderr"):
            with self.subTest(redirected), open(out, "ab") as file:
                options = {"capture_output": False, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, redirected: file}
                self.assertEqual(s7200(*self.command("run"), "--trace", out, **options).returncode, UNUSABLE)

    def test_the_name_of_a_pty_is_an_output(self):
        plc = self.folder / "plc"
        for option in ("--trace", "--output", "--memory"):
            self.assertIn("named twice", self.refused("run", self.idle, "--pty", plc, option, plc, "--for", "1ms"))

    def test_folders_and_places_that_are_not_there(self):
        (self.folder / "folder.vcd").mkdir()
        for verb, command, option, name in self.options():
            with self.subTest(verb=verb, option=option):
                folder = self.folder / ("folder.vcd" if option == "--capture" else "folder.vcd/..")
                for force in ([], ["--force"]) if option in ("--record", "-o") else ([],):
                    self.assertIn("it is a folder", self.refused(*command, option, folder, *force))
                self.assertIn("cannot write", self.refused(*command, option, self.folder / "no/such" / name))

    def test_a_folder_that_may_not_be_written(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        locked = self.folder / "locked"
        locked.mkdir()
        locked.chmod(0o500)
        self.addCleanup(locked.chmod, 0o700)
        for _, command, option, name in self.options():
            self.assertIn("Permission denied", self.refused(*command, option, locked / name))

    def test_records_go_to_pipes_as_they_are(self):
        done = subprocess.run(["bash", "-c", '"$0" run "$1" --for 2s --trace >(cat > "$2") --output >(cat > "$3"); wait $!', S7200,
                               self.blinking, self.folder / "t", self.folder / "o"], stdin=subprocess.DEVNULL, capture_output=True,
                              timeout=LONG, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        self.ends(FINE, *self.command("run"), "--trace", self.folder / "t2", "--output", self.folder / "o2")
        for piped, written in (("t", "t2"), ("o", "o2")):
            self.eventually(lambda piped=piped, written=written: (self.folder / piped).read_bytes() == (self.folder / written).read_bytes(),
                            "it is not the same")

    def limited(self, *arguments, size=100):
        """On a disk that is full after `size` bytes."""
        return s7200(*arguments, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))

    def test_a_result_on_a_full_disk_is_absent_or_as_it_was(self):
        for option, name, verb in (("-o", "listing.stl", "import"), ("--junit", "junit.xml", "test"), ("--markdown", "summary.md", "test"),
                                   ("--record", "transcript.yaml", "test"), ("--memory", "memory.json", "run")):
            with self.subTest(option):
                path = self.folder / name
                size = 20 if option == "-o" else 100
                before = self.tree()
                done = self.limited(*self.command(verb), option, path, size=size)
                self.assertEqual(done.returncode, UNUSABLE)
                self.assertIn(b"cannot write", done.stderr)
                self.assertEqual(self.tree(), before)
                force = ["--force"] if option in ("-o", "--record") else []
                self.ends(FINE, *self.command(verb), option, path, *force)
                before = self.tree()
                self.assertEqual(self.limited(*self.command(verb), option, path, *force, size=size).returncode, UNUSABLE)
                self.assertEqual(self.tree(), before)

    def test_one_file_that_cannot_be_written_loses_no_other(self):
        junit, transcript = self.folder / "junit.xml", self.folder / "transcript.yaml"
        self.ends(FINE, "test", self.good, "--junit", junit, "--record", transcript)
        size = min(junit.stat().st_size, transcript.stat().st_size) + 1
        small, large = sorted((junit, transcript), key=lambda path: path.stat().st_size)
        for path in (junit, transcript):
            path.unlink()
        self.assertEqual(self.limited("test", self.good, "--junit", junit, "--record", transcript, size=size).returncode, UNUSABLE)
        self.assertTrue(small.exists())
        self.assertFalse(large.exists())
        trace, memory = self.folder / "run.trace", self.folder / "memory.json"
        done = self.limited("run", self.blinking, "--for", "60s", "--trace", trace, "--memory", memory, "--json", size=4096)
        self.assertEqual(done.returncode, UNUSABLE)
        self.assertIn(b"cannot write all of", done.stderr)
        self.assertEqual(json.loads(done.stdout)["time_ns"] // 10**9, 60, "the results are printed all the same")
        self.assertTrue(memory.exists())

    def test_a_record_on_a_full_disk_is_whole_up_to_there(self):
        for name, option in self.outputs("run").items():
            if option == "--memory":
                continue
            with self.subTest(name):
                whole, cut = self.folder / f"whole.{name}", self.folder / f"cut.{name}"
                command = ["send", self.echo, *["ab"] * 500, option]
                self.ends(FINE, *command, whole)
                done = self.limited(*command, cut, size=2000)
                self.assertEqual(done.returncode, UNUSABLE)
                self.assertIn(b"cannot write all of", done.stderr)
                self.assertTrue(whole.read_bytes().startswith(cut.read_bytes()))
                self.assertEqual(cut.stat().st_size, 2000)
                self.ends(FINE, *command, cut)  # it has its mark
                self.assertEqual(cut.read_bytes(), whole.read_bytes())

    def test_a_record_at_its_limit_is_whole_up_to_there(self):
        for name, option in self.outputs("run").items():
            if option == "--memory":
                continue
            for streams in ({}, {2: "closed"}, {2: "full"}):
                with self.subTest(name=name, streams=streams):
                    whole, cut = self.folder / f"whole.{name}", self.folder / f"cut.{name}"
                    command = ["send", self.echo, *["ab"] * 5000, option]
                    self.ends(FINE, *command, whole)
                    self.assertEqual(run_with(streams, [*command, cut, "--record-limit", "10KB"]).returncode, UNUSABLE)
                    self.assertTrue(whole.read_bytes().startswith(cut.read_bytes()))
                    self.assertTrue(9000 < cut.stat().st_size <= 10000, cut.stat().st_size)
                    self.ends(FINE, *command, cut)  # it has its mark
                    self.assertEqual(cut.read_bytes(), whole.read_bytes())

    def test_a_record_whose_first_line_cannot_be_written_is_absent(self):
        for name, option in self.outputs("run").items():
            if option != "--memory":
                with self.subTest(name):
                    before = self.tree()
                    self.assertEqual(self.limited(*self.command("run"), option, self.folder / name, size=5).returncode, UNUSABLE)
                    self.assertEqual(self.tree(), before)

    def test_what_has_come_during_a_run_is_left_alone(self):
        memory, link = self.folder / "memory.json", self.folder / "plc"
        for foreign in ("mine\n", None):
            process = self.start("run", self.idle, "--pty", link, "--memory", memory)
            self.assertIn(b"serving", process.stderr.readline())
            if foreign:
                memory.write_text(foreign, encoding="utf-8")
            else:
                memory.symlink_to(self.folder / "nowhere")
            process.send_signal(signal.SIGINT)
            _, error = process.communicate(timeout=LONG)
            self.assertEqual(process.returncode, UNUSABLE)
            self.assertIn(b"cannot write", error)
            self.assertEqual(foreign and memory.read_text(encoding="utf-8"), foreign)
            self.assertFalse((self.folder / "nowhere").exists())
            memory.unlink()

    def test_a_record_can_be_read_while_it_grows(self):
        trace = self.folder / "run.trace"
        process = self.start("run", self.blinking, "--pty", self.folder / "plc", "--trace", trace)
        self.assertIn(b"serving", process.stderr.readline())
        self.assertTrue(trace.read_bytes().startswith(b"# time in ms"))
        self.assertEqual([path.name for path in self.folder.glob("*.new")], [])


# --- text ---

COMMANDS = "\x1b[2J\x1b]0;title\x07\x9b31m\u202e\x7f\x08"  # to a terminal
HOSTILE = "evil" + COMMANDS


def controls(data):
    """What a terminal would take for a command in what was printed."""
    text = data.decode("utf-8", "surrogateescape")
    return re.findall("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\udc80-\udcff]", text)


class Text(Case):
    def harmless(self, *arguments, codes=(FINE, FAILED, UNUSABLE, FATAL), **options):
        done = s7200(*arguments, **options)
        self.assertIn(done.returncode, codes, done.stderr)
        self.assertEqual(controls(done.stdout) + controls(done.stderr), [], (arguments, done.stdout, done.stderr))
        return done

    def names(self):
        for name in (HOSTILE, b"evil\xff\x9b31m\xc3(", "two\nlines", "zero\u200bwidth"):
            yield os.fsencode(name)

    def test_names_of_files(self):
        for name in self.names():
            program = os.path.join(os.fsencode(self.folder), name + b".stl")
            path = os.fsdecode(program)
            with open(program, "w", encoding="utf-8") as file:
                file.write("LD SM0.0\nMOVD 0, *VD100\nATCH 0, 10\nMEND\nINT 0\nRETI\n")
            yaml = os.fsdecode(os.path.join(os.fsencode(self.folder), name + b".yaml"))
            with open(yaml, "wb") as file:
                file.write(b"program: " + json.dumps(str(self.echo)).encode() + b"\nsteps: [{send: ab, expect: cd, note: x}]\n")
            missing = os.fsdecode(os.path.join(os.fsencode(self.folder), name + b".no"))
            for arguments in (["check", path], ["run", path, "--for", "10ms", "--set", "VD100=16#7F000000"], ["send", path, "01"],
                              ["test", yaml], ["test", yaml, "--list"], ["test", yaml, "--against", self.echo],
                              ["test", self.good, "--target", path], ["test", self.good, "--against", path],
                              ["test", "--random", "2", "--target", path], ["master", path, "slave-id", "--timeout", "1ms"],
                              ["master", path, "slave-id", "--timeout", "1ms", "--every", "1s", "--count", "1"], ["bench", path, "--each", "1ms"],
                              ["debug", path, "-x", "step 3; errors; list"], ["import", path, "-o", missing + ".stl"],
                              ["test", yaml, "--conformance", missing], ["master", "tcp://" + name.hex() + missing, "slave-id"],
                              *([verb, missing, *rest] for verb, rest in (("check", []), ("run", []), ("send", ["01"]), ("test", []),
                                                                          ("master", ["slave-id"]), ("debug", []), ("import", []), ("bench", []))),
                              *(["run", self.idle, option, missing] for option in ("--input", "--times", "--fault", "--set", "--dump",
                                                                                   "--capture", "--clock", "--cpu", "--frob")),
                              ["run", self.idle, "--trace", path], ["run", self.idle, "--memory", path], ["instructions", missing],
                              ["send", self.idle, missing], ["send", self.idle, "--frames", path], [missing], ["--" + missing],
                              ["debug", self.idle, "-x", missing], ["debug", self.idle, "--commands", path],
                              ["master", SLAVE, missing], ["master", SLAVE, "raw", missing]):
                with self.subTest(name=name, arguments=arguments):
                    self.harmless(*arguments)
            link = os.path.join(os.fsencode(self.folder), name + b".plc")
            done = self.harmless("run", self.idle, "--pty", os.fsdecode(link), "--for", "10ms", codes=(FINE,))
            self.assertIn(b"serving", done.stderr)

    def test_programs(self):
        plain = "// a text without anything special in it, so that this is not a binary file\n" * 20
        wrong = f"LD SM0.0 // {COMMANDS}\nFROB{COMMANDS} VB0\nMOVB {COMMANDS}, VB0\nMOVB 1, Na\u009bme\nCALL \"{COMMANDS}\"\nMEND\n{plain}"
        right = (f"// {COMMANDS}\nNETWORK 1 // {COMMANDS}\nLD SM0.0 // {COMMANDS}\nMOVD 0, *VD100 // {COMMANDS}\n"
                 f"STOP // {COMMANDS}\nMEND\n{plain}")
        for text, code in ((wrong, FAILED), (right, FINE)):
            path = self.file("program.stl", text)
            self.harmless("check", path, codes=(code,))
            for arguments in (["run", path, "--for", "10ms", "--trace", "-"], ["send", path, "01", "--timeout", "1ms", "--timeline"],
                              ["debug", path, "-x", "list; step 5; regs; break 3; watch VB0; errors"],
                              ["run", path, "--for", "10ms", "--trace", "-", "--trace-instructions"]):
                with self.subTest(text=text, arguments=arguments):
                    self.harmless(*arguments)

    def test_a_listing_is_harmless_on_a_terminal_and_faithful_elsewhere(self):
        path = self.file("program.stl", f"LD SM0.0 // {COMMANDS}\nMEND\n" + "// and nothing special\n" * 20)
        self.assertIn(COMMANDS.encode(), s7200("import", path).stdout)
        try:
            near, far = os.openpty()
        except OSError as error:
            self.skipTest(f"no terminal can be opened here: {error}")
        process = self.start("import", path, stdout=far)
        os.close(far)
        shown = b""
        with contextlib.suppress(OSError):  # EIO: no program has the other side open any more
            while part := os.read(near, 1000):
                shown += part
        os.close(near)
        process.wait(LONG)
        self.assertIn(b"LD      SM0.0", shown)
        self.assertEqual(controls(shown.replace(b"\r\n", b"\n")), [])

    def test_scenarios(self):
        written = json.dumps(HOSTILE)  # "\u001b…", which YAML makes characters of again
        for text in (f"program: {self.echo}\nname: {written}\nsteps: [{{send: ab, expect: cd, note: {written}}}]\n",
                     f"program: {self.echo}\nname: {written}\nskip_without: {written}\nsteps: [{{send: ab}}]\n",
                     f"program: {written}\nname: {written}\nsteps: [{{send: ab}}]\n", f"{written}: 1\n", f"steps: [{{{written}: 1}}]\n",
                     f"steps: {written}\n", f"program: {self.echo}\nsteps: [{{send: {written}}}]\n",
                     f"program: {self.echo}\nsteps: [{{wait: {written}}}, {{fault: {written}}}, {{memory: {{{written}: 1}}}}]\n",
                     f"program: {self.echo}\ninput: {written}\ntimes: {written}\ncpu: {written}\nclock: {written}\nsteps: [{{send: ab}}]\n",
                     f"program: {self.echo}\nsteps: [{{for: {{x: [1, {written}]}}, steps: [{{send: ab, expect: cd}}]}}]\n",
                     f"program: {self.echo}\nparameters: {{x: {written}}}\nsteps: [{{send: '${{x}}'}}]\n",
                     f"program: {self.echo}\nrule: {written}\nsource: {written}\nsteps: [{{send: ab, expect: cd}}]\n",
                     f"program: {self.echo}\nsteps: [{{send: ab, expect: cd}}] # {COMMANDS}\n", COMMANDS):
            path = self.file("scenario.yaml", text)
            for arguments in ([path], [path, "--list"], [path, "--against", self.echo], [path, "--with", path],
                              ["--conformance", path], [path, "--fail-fast", "--jobs", "2"]):
                with self.subTest(text=text, arguments=arguments):
                    self.harmless("test", *arguments)
            self.harmless("test", path, "--junit", self.folder / "junit.xml")
            if (self.folder / "junit.xml").exists():
                self.assertEqual(controls((self.folder / "junit.xml").read_bytes()), [])

    def test_other_files(self):
        table = s7200("times", "--csv").stdout.decode().split("\n")
        table[1] = re.sub(r"[^,]*$", f'"{COMMANDS}"', table[1])
        row = f"MOVB,{COMMANDS},30,,{COMMANDS},manual,{COMMANDS}"
        times = self.file("times.csv", "\n".join([table[0], row, *table[1:]]))
        for arguments in (["times", "--times", times], ["instructions", "MOVB", "--times", times], ["instructions", "--times", times],
                          ["run", self.idle, "--times", times, "--for", "1ms"],
                          *(["run", self.idle, option, self.file("x", text)] for option in ("--times", "--input", "--memory") for text in
                            (COMMANDS, f"{table[0]}\n{COMMANDS},x,{COMMANDS}\n", f"1ms,{COMMANDS},1\n{COMMANDS},I0.0,1\n1ms,I0.0,{COMMANDS}\n",
                             '{"format": "s7200 memory 1", "cpu": ' + json.dumps(COMMANDS) + "}")),
                          ["send", self.idle, "--frames", self.file("frames", f"ab\n{COMMANDS}\n")],
                          ["debug", self.echo, "--commands", self.file("commands", f"print {COMMANDS}\n")],
                          ["debug", self.echo, "--commands", self.file("commands2", f"step 1 {COMMANDS}\n")],
                          ["debug", self.echo, "--commands", self.file("commands3", f"{COMMANDS}\n")]):
            with self.subTest(arguments):
                self.harmless(*arguments)
        for line in ("step", "back", COMMANDS):
            self.harmless("debug", self.echo, stdin=None, input=f"{line} {COMMANDS}\n".encode())

    SECRETS = {"passwd": b"root:x:0:0:root:/root:/bin/bash\ndaemon:x:1:1:daemon:/usr/sbin:/usr/sbin/nologin\n" * 20,
               "shadow": b"root:$6$abcdefgh$ijklmnop:19000:0:99999:7:::\n",
               "key": b"-----BEGIN PRIVATE KEY-----\nMC4CAQAwBQYDK2VwBCIEIKHhZ0\nabcd+efg/hijk==\n-----END PRIVATE KEY-----\n",
               "token": b"ghp_0123456789abcdefghij\n", "env": b"PASSWORD=hunter2hunter2\nTOKEN=abcdef012345\n",
               "json": b'{\n  "password": "hunter2hunter2"\n}\n', "ini": b"[server]\npassword = hunter2hunter2\n" * 10,
               "noise": bytes((i * 7919 + i * i) % 224 + 32 for i in range(3000)), "elf": b"\x7fELF\x02\x01\x01" + bytes(100),
               "page": b"<!DOCTYPE html>\n<html><body>hunter2hunter2</body></html>\n"}

    def test_files_that_are_no_programs_are_refused_in_one_short_message(self):
        for name, content in self.SECRETS.items():
            path = self.file(name, content)
            yaml = self.file("named.yaml", f"program: {path}\nname: x\nsteps: [{{wait: 1ms}}]\n")
            for arguments in (["check", path], ["run", path], ["send", path, "01"], ["test", yaml], ["test", self.good, "--target", path],
                              ["master", path, "slave-id"], ["debug", path], ["bench", path], ["run", self.idle, "--memory", path],
                              ["send", self.idle, "--frames", path], ["run", self.idle, "--times", path], ["run", self.idle, "--input", path]):
                with self.subTest(name=name, arguments=arguments):
                    done = self.harmless(*arguments, codes=(UNUSABLE,))
                    self.assertLess(done.stderr.count(b"\n"), 12)
                    if "--frames" not in arguments and name != "elf":
                        for line in content.split(b"\n"):
                            self.assertFalse(len(line) > 12 and line in done.stderr, done.stderr)

    def test_a_program_with_nothing_but_mistakes_has_them_shown(self):
        for text in ("FROB\n", "U E0.0\n= A0.0\n", "Netzwerk 1\nUN E0.0\n", "LD\n", "MOVB 16#, VB0\n", "ld vb0\n"):
            path = self.file("wrong.stl", text)
            self.assertIn(b": error: ", self.ends(FAILED, "check", path).stderr)


if __name__ == "__main__":
    group = {"streams": Streams, "signals": Signals, "files": Files, "text": Text}[GROUP]
    result = unittest.TextTestRunner(stream=sys.stdout).run(unittest.defaultTestLoader.loadTestsFromTestCase(group))
    sys.exit(0 if result.wasSuccessful() else 1)
