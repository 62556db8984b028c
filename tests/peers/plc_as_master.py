#!/usr/bin/env python3
"""A PLC of ours is the master, slaves of others answer it, over a pty: plc_as_master.py S7200 PROGRAM CPU SLAVE...

SLAVE: the command of a slave, which gets the link as its last argument. Exit code 77: skipped, it is not there."""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

S7200, PROGRAM, CPU, *SLAVE = sys.argv[1:]
PATIENCE = 60.0  # a machine may be busy with other things
SKIPPED = 77
WRITTEN = 0x1234
REQUESTS = 3  # until the PLC asks a third time, it has got an answer, though the first one may have met a slave that starts
DONE = "01"


class PlcAsMaster(unittest.TestCase):
    """The example in the program: with I0.1 it reads ten registers every second, with I0.0 it writes VW200 to the 20th."""

    def run_with(self, *settings):
        """The error that the last job ended with (if none is being done), VB100 on, and the slave's registers."""
        with tempfile.TemporaryDirectory() as folder:
            link = pathlib.Path(folder) / "line"
            plc = subprocess.Popen(
                [S7200, "run", PROGRAM, "--cpu", CPU, "--pty", link, "--json", *settings,
                 "--dump", "VB100:20", "--dump", "VB3013", "--dump", "M31.2"],
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.addCleanup(plc.kill)
            deadline = time.monotonic() + PATIENCE
            while not link.exists():
                self.assertLess(time.monotonic(), deadline, "the PLC does not serve its pty")
                time.sleep(0.01)
            slave = subprocess.Popen([*SLAVE, link], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            self.addCleanup(slave.kill)
            give_up = threading.Timer(PATIENCE, slave.kill)
            give_up.start()
            for _ in range(REQUESTS):
                self.assertEqual(slave.stdout.readline(), "asked\n", "the PLC does not ask")
            give_up.cancel()
            plc.send_signal(signal.SIGINT)
            out, err = plc.communicate(timeout=PATIENCE)
            self.assertEqual(plc.returncode, 0, err)
            registers, _ = slave.communicate(timeout=PATIENCE)
            dump = {place: shown["hex"] for place, shown in json.loads(out)["dump"].items()}
            error = dump["VB3013"] if dump["M31.2"] == DONE else None
            held = registers.splitlines()[-1].split()
            return error, bytes.fromhex(dump["VB100:20"]), [int(value) for value in held]

    def test_reads_registers(self):
        error, read, held = self.run_with("--set", "I0.1=1")
        self.assertIn(error, (None, "00"))
        self.assertEqual(read, b"".join(value.to_bytes(2, "big") for value in held[:10]))

    def test_writes_a_register(self):
        error, _, held = self.run_with("--set", "I0.0=1", "--set", f"VW200={WRITTEN}")
        self.assertIn(error, (None, "00"))
        self.assertEqual(held[19], WRITTEN)
        self.assertEqual(held[:19] + held[20:], [1000 + n for n in range(40) if n != 19])


if __name__ == "__main__":
    if SLAVE[0] == "none":
        print("skipped, it is not installed")
        sys.exit(SKIPPED)
    if SLAVE[-1].endswith(".py") and subprocess.run([SLAVE[0], "-c", "import pymodbus.server"], check=False,
                                                    capture_output=True).returncode:
        print("skipped, pymodbus cannot be imported")
        sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1])
