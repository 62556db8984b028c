#!/usr/bin/env python3
"""Masters of others talk to a slave of ours, over a pty: run.py S7200 SOURCE_DIR MASTER SLAVE EXCHANGES LIBMODBUS_CLIENT

EXCHANGES: how many at random. A master mostly waits, so several PLCs, each with a master, run at once. Exit code 77: skipped, something is not there."""
import collections
import concurrent.futures
import io
import json
import pathlib
import random
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from masters import MASTERS, SILENT, Request, Unfit
from slaves import INPUT_REGISTERS, POINTS, REGISTERS, SLAVES, Model, path_of

S7200, SOURCE, MASTER, SLAVE, EXCHANGES, CLIENT = sys.argv[1:]
SPEED = 50
PATIENCE = 10.0  # a machine may be busy with other things
AT_ONCE = 8
PARTS = 8  # of the exchanges at random
SKIPPED = 77
SLAVE = SLAVES[SLAVE]


class Conversation(unittest.TestCase):
    """A PLC that is powered up for each test. Whatever the test does, the memory is what the model says in the end."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.link, self.capture = self.folder / "plc", self.folder / "line.pcap"
        self.draw = random.Random(self.id())
        self.model = Model(SLAVE, self.draw)
        self.late = 0
        dumps = [word for place in self.model.memory() for word in ("--dump", place)]
        self.plc = subprocess.Popen(
            [S7200, "run", path_of(SLAVE, SOURCE), "--cpu", SLAVE.cpu, "--pty", self.link, "--speed", str(SPEED), "--json", "--capture",
             self.capture, *self.model.settings(), *dumps],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.pull_the_plug)
        deadline = time.monotonic() + PATIENCE
        while not self.link.exists():
            self.assertLess(time.monotonic(), deadline, "the PLC does not serve its pty")
            time.sleep(0.01)
        time.sleep(1.0 / SPEED)  # the tip's first scan takes 0.69 s
        self.master = MASTERS[MASTER](CLIENT)
        self.open()

    def tearDown(self):
        self.switch_off()

    def switch_off(self):
        if self.plc.returncode is not None:
            return
        self.master.close()
        self.plc.send_signal(signal.SIGINT)
        out, err = self.plc.communicate(timeout=PATIENCE)
        self.assertEqual(self.plc.returncode, 0, err)
        self.assertEqual({place: shown["hex"] for place, shown in json.loads(out)["dump"].items()}, self.model.memory())
        self.assertLessEqual(self.late, 3 + int(EXCHANGES) // 1000, "answers that did not come in time")

    def pull_the_plug(self):
        if self.plc.poll() is None:
            self.plc.kill()
            self.plc.communicate()

    def open(self, baud=9600, timeout=PATIENCE):
        self.master.open(self.link, baud, timeout)

    def reopen(self, **settings):
        self.master.close()
        time.sleep(0.1)  # the PLC's side has to see it
        self.open(**settings)

    def ask(self, request, station=1):
        time.sleep(SLAVE.pause / SPEED)
        return self.master.ask(station, request)

    def check(self, *request, values=()):
        """Asks, and compares with the model. Where an answer is due, silence is a busy machine: then once more."""
        request = Request(*request, values=tuple(values))
        due = self.model.answer(request)
        answer = self.ask(request)
        if answer == SILENT:
            self.late += 1
            self.reopen()
            answer = self.ask(request)
        self.assertEqual(answer, due, request)

    def unanswered(self, *request, values=(), station=1, **settings):
        """No slave answers, and the line is as good as before."""
        self.reopen(timeout=0.3, **settings)
        request = Request(*request, values=tuple(values))
        if "baud" not in settings:
            self.model.answer(request, station)
        self.assertEqual(self.ask(request, station), SILENT)
        self.reopen()

    def frames(self):
        """What ran over the line, in both directions."""
        data, at, frames = self.capture.read_bytes(), 24, []
        while at < len(data):
            length, = struct.unpack_from("<I", data, at + 8)
            frames.append(data[at + 16:at + 16 + length])
            at += 16 + length
        return frames


class Peers(Conversation):
    def test_every_function(self):
        self.check(3, 0, 10)
        self.check(4, 0, 16)
        self.check(2, 0, 64)
        self.check(5, 3, values=[1])
        self.check(5, 63, values=[1])
        self.check(1, 0, 64)
        self.check(5, 3, values=[0])
        self.check(15, 8, values=[1, 0, 1, 1, 0, 0, 1, 0])
        self.check(1, 0, 64)
        self.check(6, 999, values=[0xCAFE])
        self.check(16, 0, values=[1, 0x8000, 0xFFFF])
        self.check(3, 0, 3)
        self.check(3, 999, 1)

    def test_limits_of_registers(self):
        for function, first, count in ((3, 0, 125), (3, 875, 125), (3, 876, 125), (3, 1000, 1), (3, 65535, 1), (3, 0, 126),
                                       (4, 0, 16), (4, 0, 17), (4, 15, 1), (4, 16, 1), (4, 0, 126)):
            self.check_if_possible(function, first, count)
        for first, count in ((0, 60), (0, 61), (940, 60), (941, 60), (0, 123), (877, 123), (878, 123)):  # 124: no frame is so long
            self.check_if_possible(16, first, values=[self.draw.getrandbits(16) for _ in range(count)])
        for first in (0, 999, 1000, 65535):
            self.check_if_possible(6, first, values=[self.draw.getrandbits(16)])
        self.check(3, 0, 125)
        self.check(3, 875, 125)

    def test_limits_of_bits(self):
        for function in (1, 2):
            for first, count in ((0, 64), (0, 65), (63, 1), (64, 1), (1, 64), (56, 8), (57, 7), (0, 2000), (0, 2001), (65535, 1)):
                self.check_if_possible(function, first, count)
        for first, count in ((0, 64), (0, 65), (0, 72), (1, 8), (0, 9), (56, 8), (56, 9), (64, 8), (3, 2)):
            self.check_if_possible(15, first, values=[self.draw.getrandbits(1) for _ in range(count)])
        for first in (0, 63, 64, 65535):
            self.check_if_possible(5, first, values=[1])
        self.check(1, 0, 64)

    def check_if_possible(self, *request, values=()):
        if self.master.can_ask(Request(*request, values=tuple(values))):
            self.check(*request, values=values)

    def test_another_station_is_silent(self):
        self.unanswered(3, 0, 1, station=2)
        self.check(3, 0, 1)
        self.unanswered(6, 0, values=[1], station=247)
        self.check(3, 0, 1)

    def test_a_wrong_rate_is_silent(self):
        for baud in (19200, 4800):
            self.unanswered(3, 0, 1, baud=baud)
            self.check(3, 0, 1)
            self.unanswered(6, 0, values=[1], baud=baud)
            self.check(3, 0, 1)

    def test_broadcast(self):
        if not self.master.can_broadcast:
            self.skipTest(f"{MASTER} cannot broadcast")
        for function, first, values in ((6, 5, [0xBEEF]), (16, 6, [1, 2, 3]), (5, 9, [1]), (15, 16, [1] * 8)):
            self.unanswered(function, first, values=values, station=0)
            time.sleep(0.3)
            self.check(3, 0, 20)
            self.check(1, 0, 64)

    def at_random(self):
        asked = collections.Counter()
        while sum(asked.values()) < int(EXCHANGES) // PARTS:
            request = self.any_request()
            if not self.master.can_ask(request):
                continue
            asked[request.function] += 1
            self.check(request.function, request.first, request.count, values=request.values)
        self.assertEqual(sorted(asked), [1, 2, 3, 4, 5, 6, 15, 16])
        self.switch_off()
        on_the_line = {frame[1] & 0x7F for frame in self.frames() if len(frame) >= 5}
        self.assertEqual(on_the_line, set(asked))
        print(f"{sum(asked.values())} exchanges at random, {self.late} of them late\n", end="")

    def any_request(self):
        """Of eight, one asks for what is not there."""
        draw = self.draw
        function = draw.choice((1, 2, 3, 4, 5, 6, 15, 16))
        size = {3: REGISTERS, 6: REGISTERS, 16: REGISTERS, 4: INPUT_REGISTERS}.get(function, POINTS)
        most = {1: 64, 2: 64, 3: SLAVE.most_registers, 4: 16, 15: 64, 16: SLAVE.most_written_registers}.get(function, 1)
        count = min(draw.randint(1, most), draw.randint(1, most))
        first = draw.randrange(size) if draw.random() < 0.12 else draw.randint(0, size - count)
        if function == 15 and not SLAVE.writes_any_coils and draw.random() < 0.9:
            first, count = first // 8 * 8, -(-count // 8) * 8
        if function in (5, 6, 15, 16):
            return Request(function, first, values=tuple(draw.getrandbits(1 if function in (5, 15) else 16) for _ in range(count)))
        return Request(function, first, count)


for part in range(PARTS):
    setattr(Peers, f"test_at_random_{part + 1}_of_{PARTS}", Peers.at_random)


def run_test(test):
    """Whether it went well. What it has to say is printed at its end, in one piece."""
    said = io.StringIO()
    result = unittest.TextTestRunner(stream=said, verbosity=2).run(test)
    print(said.getvalue(), end="")
    return result.wasSuccessful()


if __name__ == "__main__":
    try:
        MASTERS[MASTER](CLIENT)
        if not path_of(SLAVE, SOURCE).exists():
            raise Unfit(f"{path_of(SLAVE, SOURCE)} is not there: the document is not part of this project")
    except Unfit as why:
        print(f"skipped: {why}")
        sys.exit(SKIPPED)
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        went_well = list(pool.map(run_test, unittest.defaultTestLoader.loadTestsFromTestCase(Peers)))
    sys.exit(0 if all(went_well) else 1)
