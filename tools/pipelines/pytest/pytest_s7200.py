"""pytest plug-in: PLCs on ptys, simulated by s7200, for tests of what talks to them."""
import contextlib
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

import pytest

PATIENCE = 30  # seconds until a PLC must serve, or have ended; far more than it takes


class Plc:
    """A program that runs until the test is over. `port` is the serial port to open."""

    def __init__(self, command, port):
        self.port = str(port)
        self._printed = None
        self._output = tempfile.TemporaryFile("w+", encoding="utf-8")  # a pipe that nobody reads would stall the PLC when it is full
        self._process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self._output, stderr=subprocess.STDOUT)
        end = time.monotonic() + PATIENCE
        while not port.is_symlink():
            if self._process.poll() is not None or time.monotonic() > end:
                pytest.fail(f"s7200 does not serve {port}:\n{self.stop()}", pytrace=False)
            time.sleep(0.01)

    def stop(self):
        """Ends the run, and returns what s7200 printed: how it ended, run-time errors, and the memory of --dump."""
        if self._printed is None:
            self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(timeout=PATIENCE)
            finally:
                self._process.kill()
                self._process.wait()
            with self._output as output:
                output.seek(0)
                self._printed = output.read()
        return self._printed


@pytest.fixture
def s7200_plc(tmp_path):
    """Makes PLCs: `s7200_plc("slave.stl", "--set", "VW20=5")` with any options of `s7200 run`. They run `speed` times as fast
    as the clock, and so do their baud rates and time-outs: what takes the plant a minute takes the test three seconds. A test
    gets a PLC `ready` seconds of its own time after power-up, when its program has set up the port."""
    if shutil.which("s7200") is None:
        pytest.fail("s7200 is not on PATH", pytrace=False)
    plcs = []
    ends = contextlib.ExitStack()  # of all of them, even if one cannot be stopped

    def make(program, *options, speed=20, ready=1.0):
        port = pathlib.Path(tmp_path) / f"plc{len(plcs)}"
        words = ["s7200", "run", program, *options, "--speed", speed, "--pty", port]
        plcs.append(Plc([str(word) for word in words], port))
        ends.callback(plcs[-1].stop)
        time.sleep(0.1 + ready / speed)
        return plcs[-1]

    with ends:
        yield make
