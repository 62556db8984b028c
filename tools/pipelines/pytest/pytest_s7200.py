"""pytest plug-in: PLCs on ptys, simulated by s7200, for tests of what talks to them."""
import contextlib
import json
import pathlib
import queue
import re
import shutil
import subprocess
import tempfile
import threading
import time

import pytest

PATIENCE = 30  # seconds until a PLC must serve, answer or have ended; far more than it takes


class Refused(Exception):
    """s7200 does not do what was asked for; the message says why."""


class _Session:
    """`s7200 dap` on a pipe: requests, their answers, and what it says unasked."""

    def __init__(self, command):
        self.printed = []  # texts for the user
        self._errors = tempfile.TemporaryFile("w+", encoding="utf-8")  # a pipe that nobody reads would stall s7200 when it is full
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors)
        self._answers, self._stops = queue.Queue(), queue.Queue()
        self._asked = 0
        threading.Thread(target=self._listen, daemon=True).start()

    def ask(self, command, **arguments):
        """The body of the answer."""
        self._asked += 1
        request = json.dumps({"seq": self._asked, "type": "request", "command": command, "arguments": arguments}).encode()
        try:
            self._process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(request), request))
            self._process.stdin.flush()
            answer = self._answers.get(timeout=PATIENCE)
        except (OSError, ValueError, queue.Empty):
            answer = None
        if answer is None:
            raise Refused(f"s7200 has ended or does not answer:\n{self.end()}")
        if not answer["success"]:
            raise Refused(answer.get("message") or f"{command} was refused")
        return answer.get("body", {})

    def wait_for_stop(self):
        self._stops.get(timeout=PATIENCE)

    def end(self):
        """What s7200 has said, to the end."""
        if not self._errors.closed:
            with contextlib.suppress(OSError):
                self._process.stdin.close()
            try:
                self._process.wait(timeout=PATIENCE)
            finally:
                self._process.kill()
                self._process.wait()
            with self._errors as errors:
                errors.seek(0)
                self.printed.append(errors.read())
        return "".join(self.printed)

    def _listen(self):
        with contextlib.suppress(OSError, ValueError):
            while message := self._read():
                if message["type"] == "response":
                    self._answers.put(message)
                elif message["event"] == "stopped":
                    self._stops.put(message)
                elif message["event"] == "output":
                    self.printed.append(message["body"]["output"])
        self._answers.put(None)  # for who still waits

    def _read(self):
        length = 0
        for line in iter(self._process.stdout.readline, b"\r\n"):
            if not line:
                return None
            name, _, value = line.partition(b":")
            if name == b"Content-Length":
                length = int(value)
        return json.loads(self._process.stdout.read(length))


class Value(int):
    """A number from the memory of a PLC that knows where it is from, for the message of an assertion."""

    def __new__(cls, number, plc, address):
        value = super().__new__(cls, number)
        value.plc, value.address = plc, address
        return value

    def explanation(self):
        return f"{self.address} is {int(self)}: {self.plc.why(self.address)}"


class _Memory:
    """`memory["VW20"]`, with addresses and symbols as `s7200 debug` takes them."""

    def __init__(self, plc):
        self._plc = plc

    def __getitem__(self, address):
        return self._plc._value(address)

    def __setitem__(self, address, value):
        self._plc._ask("evaluate", expression=f"set {address}={_text(value)}", context="repl")


class Plc:
    """A program that runs until the test is over. `port` is the serial port to open, `memory` all of its memory, `inputs` its
    input points: `plc.inputs["I0.3"] = 1` switches one."""

    def __init__(self, command, port):
        self.port = str(port)
        self.memory = self.inputs = _Memory(self)
        self._session = _Session(command)
        self._standing = False
        try:
            self._ask("initialize", adapterID="s7200", clientID="pytest")
            self._ask("attach")
            self._ask("configurationDone")
            self._session.wait_for_stop()
            self._ask("continue", threadId=1)
        except (Refused, queue.Empty) as problem:
            self._session.end()
            pytest.fail(f"s7200 does not serve {port}: {problem}", pytrace=False)

    def force(self, address, value):
        """Holds a value across scans until unforce()."""
        self._ask("force", values=f"{address}={_text(value)}")

    def unforce(self, address="all"):
        self._ask("unforce", places=address)

    def why(self, address=None):
        """Which instruction wrote an address last, from which value; without an address, what decided on what the program did
        last, and which frames it left unanswered."""
        with self._still():
            if address is None:
                return self._ask("evaluate", expression="why", context="repl")["result"]
            return self._ask("lastWrite", expression=address)["text"]

    @contextlib.contextmanager
    def at(self, moment):
        """The PLC as it was at a moment since power-up, `2.1s`: `with plc.at("2.1s"): plc.memory["Q0.1"]`. It stands still
        meanwhile, and goes on from where it was."""
        with self._still():
            self._go_to(moment)
            try:
                yield self
            finally:
                self._go_to("end")

    def stop(self):
        """Ends the run, and returns what s7200 printed: run-time errors, and the memory of --dump."""
        with contextlib.suppress(Refused):
            self._ask("disconnect")
        return self._session.end()

    def _ask(self, command, **arguments):
        return self._session.ask(command, **arguments)

    def _value(self, address):
        answer = self._ask("evaluate", expression=address)
        number = re.search(r"\(([^()]*)\)$", answer["result"])
        text = number.group(1) if number else answer["result"]
        try:
            return Value(int(text), self, address)
        except ValueError:
            return float(text) if answer.get("type") == "REAL" else text

    def _go_to(self, moment):
        self._ask("goToMoment", time=moment)
        self._session.wait_for_stop()

    @contextlib.contextmanager
    def _still(self):
        if self._standing:
            yield
            return
        self._ask("pause", threadId=1)
        self._session.wait_for_stop()
        self._standing = True
        try:
            yield
        finally:
            self._standing = False
            self._ask("continue", threadId=1)


def _text(value):
    return str(int(value)) if isinstance(value, (bool, Value)) else str(value)


def pytest_assertrepr_compare(op, left, right):
    """What an assertion about a value of the memory prints when it fails."""
    values = [value for value in (left, right) if isinstance(value, Value)]
    if not values:
        return None
    lines = [f"{left} {op} {right}"]
    for value in values:
        with contextlib.suppress(Refused):
            lines += value.explanation().splitlines()
    return lines


@pytest.fixture
def s7200_plc(tmp_path):
    """Makes PLCs: `s7200_plc("slave.stl", "--set", "VW20=5")` with any options of `s7200 debug`. They run `speed` times as fast
    as the clock, and so do their baud rates and time-outs: what takes the plant a minute takes the test three seconds. A test
    gets a PLC `ready` seconds of its own time after power-up, when its program has set up the port."""
    if shutil.which("s7200") is None:
        pytest.fail("s7200 is not on PATH", pytrace=False)
    plcs = []
    ends = contextlib.ExitStack()  # of all of them, even if one cannot be stopped

    def make(program, *options, speed=20, ready=1.0):
        port = pathlib.Path(tmp_path) / f"plc{len(plcs)}"
        words = ["s7200", "dap", program, *options, "--speed", speed, "--pty", port]
        plcs.append(Plc([str(word) for word in words], port))
        ends.callback(plcs[-1].stop)
        time.sleep(0.1 + ready / speed)
        return plcs[-1]

    with ends:
        yield make
