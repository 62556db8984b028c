#!/usr/bin/env python3
"""`s7200 run` with its bridges, as programs outside meet them: run.py S7200 SOURCE_DIR pty|tcp|rfc2217|modbus_tcp|device|ppi|other_plcs|run|scenarios

Nothing here depends on how fast the computer is: what has to come is waited for, for long; what must not come is waited for
in multiples of the time it would need.
"""
import contextlib
import errno
import fcntl
import json
import os
import pathlib
import re
import select
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import termios
import threading
import time
import unittest

try:
    import serial
except ImportError:
    serial = None  # pyserial

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from modbus_crc import framed  # noqa: E402

S7200, SOURCE, GROUP = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
SLAVE = str(SOURCE / "stl_programs/modbus_slave.stl")
FINE, FAILED, UNUSABLE, FATAL = range(4)
LONG = 60      # seconds, for what has to come
SILENCE = 0.4  # seconds; at SPEED ten times the slave's latency
SPEED = 5

READ = bytes.fromhex("0103000a0002e409")             # registers 10 and 11
PRESET = ["--set", "VW20=16#1234", "--set", "VW22=16#5678"]
ANSWER = framed(bytes.fromhex("01030412345678"))


class Running:
    """`s7200 run` in the background, ready to serve."""

    READY = re.compile(r"^(?:listening on (.*):(\d+)|serving .*|connected to .*)$", re.M)

    def __init__(self, folder, *arguments):
        self.errors = folder / "stderr"
        with open(self.errors, "w", encoding="utf-8") as stderr:
            self.process = subprocess.Popen([S7200, "run", "--json", *map(str, arguments)], stdin=subprocess.DEVNULL,
                                            stdout=subprocess.PIPE, stderr=stderr, text=True)
        until = time.monotonic() + LONG
        while not (ready := self.READY.search(self.said())):
            if self.process.poll() is not None or time.monotonic() > until:
                raise AssertionError(f"did not start: {self.said()}")
            time.sleep(0.01)
        self.host, self.port = ready.group(1), ready.group(2) and int(ready.group(2))

    def said(self):
        return self.errors.read_text(encoding="utf-8")

    def wait_for(self, text):
        until = time.monotonic() + LONG
        while text not in self.said():
            if time.monotonic() > until:
                raise AssertionError(f"{text!r} was not said: {self.said()}")
            time.sleep(0.02)

    def descriptors(self):
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))

    def end(self, code=FINE, by=signal.SIGINT):
        if by is not None:
            self.process.send_signal(by)
        out, _ = self.process.communicate(timeout=LONG)
        if self.process.returncode != code:
            raise AssertionError(f"exit code {self.process.returncode}: {out}{self.said()}")
        return json.loads(out) if out else None

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def start(self, *arguments, program=SLAVE):
        running = Running(self.folder, program, *arguments)
        self.addCleanup(running.kill)
        return running

    def program(self, text):
        path = self.folder / "program.stl"
        path.write_text(text, encoding="utf-8")
        return path

    RATES = {300: ("5D", 166), 600: ("59", 84), 1200: ("55", 43), 2400: ("51", 22), 4800: ("4D", 12), 9600: ("49", 6),
             19200: ("45", 5), 38400: ("41", 5)}  # SMB30 with even parity, SMB34

    def slave_at(self, baud):
        port_control, quiet = self.RATES[baud]
        text = pathlib.Path(SLAVE).read_text(encoding="utf-8")
        return self.program(text.replace("MOVB    16#49, SMB30", f"MOVB 16#{port_control}, SMB30")
                            .replace("MOVB    6, SMB34", f"MOVB {quiet}, SMB34"))

    def refused(self, *arguments, program=SLAVE):
        done = subprocess.run([S7200, "run", program, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=LONG, check=False)
        self.assertEqual((done.returncode, done.stdout), (UNUSABLE, ""), done.stderr)
        return done.stderr

    def eventually(self, condition):
        until = time.monotonic() + LONG
        while not condition():
            self.assertLess(time.monotonic(), until, "it never came")
            time.sleep(0.02)


# --- serial ports ---

INPCK, IGNPAR = termios.INPCK, termios.IGNPAR


class SerialPort:
    """As a program opens it that wants 9600 8E1, unless it says otherwise."""

    def __init__(self, path, baud=termios.B9600, cflag=termios.PARENB, iflag=0):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
        self.set(baud, cflag, iflag)

    def set(self, baud=termios.B9600, cflag=termios.PARENB, iflag=0):
        settings = termios.tcgetattr(self.fd)
        settings[0], settings[1], settings[3] = iflag, 0, 0
        settings[2] = termios.CS8 | termios.CREAD | termios.CLOCAL | cflag
        settings[4] = settings[5] = baud
        termios.tcsetattr(self.fd, termios.TCSANOW, settings)

    def write(self, data):
        while data:
            data = data[os.write(self.fd, data):]

    def read(self, count, timeout=LONG):
        data, until = b"", time.monotonic() + timeout
        while len(data) < count and select.select([self.fd], [], [], max(0, until - time.monotonic()))[0]:
            data += os.read(self.fd, count - len(data))
        return data

    def waiting(self):
        return struct.unpack("i", fcntl.ioctl(self.fd, termios.FIONREAD, b"\0" * 4))[0]

    def ask(self, request=READ, length=len(ANSWER), timeout=LONG):
        """Asked again if nothing comes: before its first scan has ended the program hears nothing. What is asked again may
        be answered twice on a busy machine: the second answer is read, too."""
        until, patience = time.monotonic() + timeout, SILENCE * 2
        while True:
            self.write(request)
            answer = self.read(1, patience)
            if answer or time.monotonic() > until:
                break
            patience *= 2
        answer += self.read(length - len(answer), timeout) if answer else b""
        time.sleep(SILENCE / 8)  # the quiet time of a master
        while patience > SILENCE * 2 and self.read(length, patience):
            pass
        return answer

    def close(self):
        os.close(self.fd)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class PtyTests(Case):
    def setUp(self):
        super().setUp()
        self.link = self.folder / "plc"

    def serve(self, *arguments, **options):
        return self.start("--pty", self.link, "--speed", SPEED, *PRESET, *arguments, **options)

    def open(self, **options):
        port = SerialPort(self.link, **options)
        self.addCleanup(lambda: self.close_quietly(port))
        return port

    def await_another_than(self, port):
        """Until the link leads to another port, for the next program."""
        until, path = time.monotonic() + LONG, os.ttyname(port.fd)
        while os.path.realpath(self.link) == path:
            self.assertLess(time.monotonic(), until)

    @staticmethod
    def close_quietly(port):
        try:
            port.close()
        except OSError as error:
            if error.errno != errno.EBADF:
                raise

    def test_asks_and_is_answered(self):
        running = self.serve()
        with SerialPort(self.link) as port:
            self.assertEqual(port.ask(), ANSWER)
        bridge = running.end()["bridge"]
        self.assertEqual(list(bridge), ["kind", "link", "opened", "bytes_in", "bytes_out", "unheard", "overrun", "with_errors",
                                        "bytes_dropped"])
        self.assertEqual((bridge["kind"], bridge["link"], bridge["opened"]), ("pty", str(self.link), 1))
        self.assertEqual((bridge["bytes_out"], bridge["unheard"], bridge["overrun"]), (len(ANSWER), 0, 0))
        self.assertEqual(bridge["bytes_in"] % len(READ), 0)
        self.assertFalse(os.path.lexists(self.link))

    def test_clients_come_and_go_and_nothing_is_lost_or_doubled(self):
        running = self.serve()
        with SerialPort(self.link) as port:
            port.ask()
        before = running.descriptors()
        for client in range(20):
            with SerialPort(self.link) as port:
                for register in range(3):
                    request = struct.pack(">BBHH", 1, 6, register, client * 256 + register)
                    request = framed(request)
                    self.assertEqual(port.ask(request, 8), request)
                self.assertEqual(port.read(1, 0), b"")
        self.assertEqual(running.descriptors(), before)
        self.assertEqual(running.end()["bridge"]["opened"], 21)

    def test_what_no_program_hears_is_lost(self):
        running = self.start("--pty", self.link, "--speed", 0.1, *PRESET)
        with SerialPort(self.link) as port:
            port.ask()
            port.write(READ)  # and away, long before the answer
        time.sleep(SILENCE * 4)
        with SerialPort(self.link) as port:
            self.assertEqual(port.read(1, SILENCE), b"")
            self.assertEqual(port.ask(), ANSWER)
        self.assertEqual(running.end()["bridge"]["unheard"], len(ANSWER))

    def test_what_a_client_did_not_read_is_not_for_the_next_one(self):
        self.serve()
        with SerialPort(self.link) as port:
            port.ask()
            port.write(READ)
            self.eventually(lambda: port.waiting() == len(ANSWER))
        time.sleep(SILENCE / 4)
        with SerialPort(self.link) as port:
            self.assertEqual(port.read(1, SILENCE), b"")
            self.assertEqual(port.ask(), ANSWER)

    def test_two_programs_that_have_it_open_share_it(self):
        self.serve()
        with SerialPort(self.link) as port:
            other = os.open(self.link, os.O_RDWR | os.O_NOCTTY)
            self.assertEqual(port.ask(), ANSWER)
            os.close(other)
        with SerialPort(self.link) as port:
            self.assertEqual(port.ask(), ANSWER)

    HALT = framed(bytes.fromhex("0106000f0001"))  # writes VW30, which the debugger watches

    def test_a_debugged_program_answers_while_it_runs_and_not_while_it_stands_still(self):
        with subprocess.Popen([S7200, "debug", SLAVE, "--pty", self.link, *PRESET, "-i", "-x", "watch VW30", "-x", "continue"],
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.addCleanup(process.kill)
            self.assertIn("serving", process.stderr.readline())
            with SerialPort(self.link) as port:
                self.assertEqual(port.ask(), ANSWER)
                port.write(self.HALT)
                process.stdin.write("continue 200ms\nprint VW20\n")
                process.stdin.flush()
                self.assertEqual(port.read(len(self.HALT)), self.HALT)
                self.eventually(lambda: "16#1234" in process.stdout.readline())  # it stands still
                port.write(READ)
                self.assertEqual(port.read(len(ANSWER), 0.5), b"")
                process.stdin.write("continue 2s\n")
                process.stdin.flush()
                self.assertEqual(port.read(len(ANSWER)), ANSWER)
            process.stdin.close()
            self.assertEqual(process.wait(LONG), FINE)
        self.assertFalse(self.link.is_symlink())

    def test_what_a_master_on_a_bridge_has_asked_is_recorded_as_requests_and_replays_to_the_same_answers(self):
        recorded = pathlib.Path(self.link).with_suffix(".yaml")
        with subprocess.Popen([S7200, "debug", SLAVE, "--pty", self.link, *PRESET, "-i", "-x", "watch VW30", "-x", "continue"],
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.addCleanup(process.kill)
            self.assertIn("serving", process.stderr.readline())
            with SerialPort(self.link) as port:
                for _ in range(3):
                    self.assertEqual(port.ask(), ANSWER)
                port.write(self.HALT)
                process.stdin.write("continue 200ms\n")
                process.stdin.flush()
                self.assertEqual(port.read(len(self.HALT)), self.HALT)
                process.stdin.write("print VW20\n")
                process.stdin.flush()
                self.eventually(lambda: "16#1234" in process.stdout.readline())  # it stands still
                port.write(READ[:5])  # and no more of it
            said, _ = process.communicate(f"continue 2s\ndisplay VW20\nrecord {recorded}\n", LONG)
            self.assertIn("recorded up to", said)
            self.assertNotIn("left out", said)
            self.assertEqual(process.returncode, FINE)
        text = recorded.read_text(encoding="utf-8")
        self.assertEqual(text.count(f"expect: {ANSWER.hex(' ')}"), 3, text)
        self.assertIn(f"- send: {READ[:5].hex(' ')}\n", text)
        replayed = subprocess.run([S7200, "test", recorded], capture_output=True, text=True, check=False)
        self.assertIn("1 passed", replayed.stdout, replayed.stdout + replayed.stderr)

    def test_a_program_that_comes_back_is_never_refused_its_parity(self):
        running = self.serve()
        talking = self.open()
        self.assertEqual(talking.ask(), ANSWER)
        for number in range(2000):
            with SerialPort(self.link) as port:
                self.await_another_than(port)
            if number % 500 == 0:
                self.assertEqual(talking.ask(), ANSWER)
        self.assertGreaterEqual(running.end()["bridge"]["opened"], 2001)

    def test_what_a_program_has_written_and_left_is_dropped_in_time(self):
        running = self.serve()
        with SerialPort(self.link, baud=termios.B300) as port:
            os.set_blocking(port.fd, False)
            with self.assertRaises(BlockingIOError):
                while True:  # several KB; 10 s at 300 baud are 272 bytes
                    os.write(port.fd, b"\x55" * 256)
            self.await_another_than(port)
        with SerialPort(self.link) as port:
            self.assertEqual(port.ask(), ANSWER)
        self.assertGreater(running.end()["bridge"]["bytes_dropped"], 1000)

    def test_another_rate_or_parity_is_not_understood(self):
        self.serve()
        port = self.open()
        self.assertEqual(port.ask(), ANSWER)
        for wrong in ({"baud": termios.B19200}, {"baud": termios.B4800}, {"baud": termios.B1200},
                      {"cflag": termios.PARENB | termios.PARODD}, {"baud": termios.B0}):
            with self.subTest(wrong):
                port.set(**wrong)
                port.write(READ)
                heard = port.read(len(ANSWER), SILENCE * 2)
                self.assertNotEqual(heard, ANSWER)
                self.assertEqual(heard, b"")
                port.set()
                self.assertEqual(port.ask(), ANSWER)

    def test_characters_at_another_rate_are_counted_and_said_at_the_end(self):
        running = self.serve()
        port = self.open()
        self.assertEqual(port.ask(), ANSWER)
        port.set(baud=termios.B4800)
        port.write(READ)
        self.assertEqual(port.read(1, SILENCE * 2), b"")
        running.end()
        self.assertRegex(running.said(), r"port 0 received \d+ characters with framing errors: whoever sent them is not set "
                                         r"to 9600 baud 8E1 like the port")

    def test_a_master_that_speaks_while_the_plc_sends_is_said_at_the_end_and_no_rate(self):
        running = self.serve()
        port = self.open()
        self.assertEqual(port.ask(), ANSWER)
        for _ in range(3):
            port.write(READ)
            port.read(2)
            port.write(READ)
            port.read(100, SILENCE * 2)
        running.end()
        self.assertRegex(running.said(), r"a collision at .*: a master spoke while port 0 of the PLC was sending")
        self.assertNotIn("is not set to", running.said())

    def test_what_a_client_may_set_without_harm(self):
        self.serve()
        port = self.open()
        for right in ({"cflag": termios.PARENB | termios.CSTOPB}, {"iflag": INPCK}, {"cflag": 0}):
            with self.subTest(right):
                port.set(**right)
                self.assertEqual(port.ask(), ANSWER)

    def test_options_hold_whatever_the_client_sets(self):
        self.serve("--parity", "none")
        port = self.open()
        port.write(READ)
        self.assertEqual(port.read(1, SILENCE * 2), b"")

    def test_the_rate_of_the_option_holds(self):
        self.serve("--baud", "9600")
        port = self.open(baud=termios.B19200)
        self.assertEqual(port.ask(), ANSWER)

    # An A every 50 ms, 9600 8E1.
    BEACON = ("LD SM0.1\nMOVB 16#49, SMB30\nMOVB 1, VB0\nMOVB 16#41, VB1\nMOVB 50, SMB34\nATCH 0, 10\nENI\nMEND\n"
              "INT 0\nLD SM0.0\nXMT VB0, 0\nRETI\n")

    def test_characters_with_errors_are_as_the_drivers_of_linux_hand_them_over(self):
        running = self.start("--pty", self.link, "--speed", SPEED, program=self.program(self.BEACON))
        odd = termios.PARENB | termios.PARODD
        for settings, heard in (({}, b"AAAAA"), ({"cflag": odd}, b"AAAAA"), ({"cflag": odd, "iflag": INPCK}, b"\0" * 5)):
            with self.subTest(settings):
                with SerialPort(self.link, **settings) as port:
                    time.sleep(SILENCE / 4)
                    termios.tcflush(port.fd, termios.TCIFLUSH)
                    self.assertEqual(port.read(5), heard)
        with SerialPort(self.link, cflag=odd, iflag=INPCK | IGNPAR) as port:
            time.sleep(SILENCE / 4)
            termios.tcflush(port.fd, termios.TCIFLUSH)
            self.assertEqual(port.read(1, SILENCE), b"")
        self.assertGreater(running.end()["bridge"]["with_errors"], 10)

    def test_a_client_that_does_not_read_loses_what_does_not_fit_and_stops_nothing(self):
        running = self.start("--pty", self.link, "--speed", 1000, program=self.program(self.BEACON))
        with SerialPort(self.link):
            time.sleep(1)
        with SerialPort(self.link) as port:
            self.assertEqual(port.read(3), b"AAA")
        running.end()

    def test_a_client_that_writes_faster_than_the_line_has_to_wait(self):
        running = self.serve()
        port = self.open()
        os.set_blocking(port.fd, False)
        written, until = 0, time.monotonic() + 2
        while time.monotonic() < until:
            try:
                written += os.write(port.fd, b"\x55" * 4096)
            except BlockingIOError:
                time.sleep(0.01)
        self.assertLess(written, 400_000)
        port.close()
        self.assertLessEqual(running.end()["bridge"]["bytes_in"], written)

    def test_only_links_that_a_run_has_made_are_replaced(self):
        for foreign in (self.folder / "nowhere", "/dev/pts/9999999", "/dev/pts/../pts/9999999", "/tmp/./nowhere"):
            self.link.symlink_to(foreign)
            self.assertIn("is left alone", self.refused("--pty", self.link))
            self.assertEqual(os.readlink(self.link), str(foreign))
            self.link.unlink()
        self.link.symlink_to("/dev/pts/./9999999")  # as a killed run leaves it
        running = self.serve()
        self.assertTrue(os.readlink(self.link).startswith("/dev/pts/"))
        self.assertIn("is left alone", self.refused("--pty", self.link))  # another run has it
        running.end()
        for text in ("mine", ""):
            self.link.write_text(text, encoding="utf-8")
            self.assertIn("is not a link; it is left alone", self.refused("--pty", self.link))
            self.assertEqual(self.link.read_text(encoding="utf-8"), text)
        self.assertIn("cannot make the link", self.refused("--pty", self.folder / "no/such/folder"))
        self.assertIn("left alone", self.refused("--pty", self.folder))

    def test_the_link_of_a_run_that_was_killed_is_replaced(self):
        def replaced():
            self.link.unlink(missing_ok=True)
            self.serve().end(-signal.SIGKILL, by=signal.SIGKILL)
            self.assertTrue(os.path.islink(self.link))
            try:
                self.serve()
            except AssertionError as refused:
                if "is left alone" not in str(refused):
                    raise
                return False  # another program of this machine had the number of the pty by then
            return True

        self.eventually(replaced)
        with SerialPort(self.link) as port:
            self.assertEqual(port.ask(), ANSWER)

    def test_a_link_that_is_someone_elses_by_now_stays(self):
        running = self.serve()
        self.link.unlink()
        self.link.symlink_to("/dev/null")
        running.end()
        self.assertEqual(os.readlink(self.link), "/dev/null")


# --- sockets ---


class Client:
    def __init__(self, running, receive_buffer=None):
        self.socket = socket.socket(socket.AF_INET6 if "[" in running.host else socket.AF_INET)
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(LONG)
        self.socket.connect((running.host.strip("[]"), running.port))

    def send(self, data):
        self.socket.sendall(data)

    def receive(self, count, timeout=LONG):
        """Less when the connection ends or nothing comes."""
        self.socket.settimeout(timeout)
        data = b""
        try:
            while len(data) < count and (part := self.socket.recv(count - len(data))):
                data += part
        except TimeoutError:
            pass
        return data

    def is_closed(self):
        """Waits until the other side has closed."""
        self.socket.settimeout(LONG)
        try:
            while self.socket.recv(4096):
                pass
        except ConnectionError:
            pass
        return True

    def vanish(self):
        """Reset instead of a farewell."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.socket.close()

    def close(self):
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def message(transaction, unit, pdu):
    return struct.pack(">HHHB", transaction, 0, len(pdu) + 1, unit) + pdu


READ_PDU, ANSWER_PDU = READ[1:-2], ANSWER[1:-2]


class ModbusClient(Client):
    def ask(self, transaction, unit=1, pdu=READ_PDU):
        self.send(message(transaction, unit, pdu))
        return self.answer()

    def answer(self):
        """(transaction, unit, PDU)"""
        header = self.receive(7)
        if len(header) < 7:
            return None
        transaction, protocol, length, unit = struct.unpack(">HHHB", header)
        assert protocol == 0
        return transaction, unit, self.receive(length - 1)


class TcpCase(Case):
    def serve(self, kind, *arguments, **options):
        running = self.start(kind, "0", "--speed", SPEED, *PRESET, *arguments, **options)
        self.assertEqual(running.host, "127.0.0.1")
        return running

    def client(self, running, **options):
        client = self.CLIENT(running, **options)
        self.addCleanup(client.close)
        return client

    def until_answered(self, client, request=READ, answer=ANSWER):
        until = time.monotonic() + LONG
        while True:
            client.send(request)
            heard = client.receive(len(answer), SILENCE * 2)
            if heard or time.monotonic() > until:
                time.sleep(SILENCE / 8)
                return heard


class TcpTests(TcpCase):
    CLIENT = Client

    def test_raw_bytes(self):
        running = self.serve("--tcp")
        client = self.client(running)
        self.assertEqual(self.until_answered(client), ANSWER)
        client.close()
        bridge = running.end()["bridge"]
        self.assertEqual(list(bridge), ["kind", "clients", "sent_away", "bytes_in", "bytes_out", "bytes_dropped"])
        self.assertEqual((bridge["kind"], bridge["clients"], bridge["bytes_out"]), ("tcp", 1, len(ANSWER)))

    def test_all_clients_hear_what_the_line_says(self):
        running = self.serve("--tcp")
        asker, listener = self.client(running), self.client(running)
        self.assertEqual(self.until_answered(asker), ANSWER)
        self.assertEqual(listener.receive(len(ANSWER)), ANSWER)

    def test_a_client_that_has_said_its_last_word_hears_the_answer(self):
        for kind in ("--tcp", "--rtu-over-tcp"):
            with self.subTest(kind):
                running = self.serve(kind)
                first = self.client(running)
                self.assertEqual(self.until_answered(first), ANSWER)
                first.close()
                client = self.client(running)
                client.send(READ)
                client.socket.shutdown(socket.SHUT_WR)
                self.assertEqual(client.receive(1000), ANSWER)  # and then the end
                running.end()

    def test_an_rtu_answer_comes_in_one_piece_to_who_asked(self):
        running = self.serve("--rtu-over-tcp")
        asker, listener = self.client(running), self.client(running)
        self.until_answered(asker)
        for _ in range(5):
            asker.send(READ)
            self.assertEqual(asker.socket.recv(1000), ANSWER)
        self.assertEqual(listener.receive(1, SILENCE), b"")
        bridge = running.end()["bridge"]
        self.assertGreaterEqual(bridge["frames"], 6)
        self.assertEqual(bridge["answered"], 6)

    def test_an_rtu_frame_may_come_in_pieces(self):
        running = self.serve("--rtu-over-tcp")
        client = self.client(running)
        self.until_answered(client)
        for pause in (0, 0.05):
            for byte in READ:
                client.send(bytes([byte]))
                time.sleep(pause)
            self.assertEqual(client.receive(len(ANSWER)), ANSWER)

    def test_slow_rtu_clients_take_the_line_for_whole_frames_only(self):
        running = self.serve("--rtu-over-tcp")
        fast = self.client(running)
        self.until_answered(fast)
        slow = [self.client(running) for _ in range(5)]
        for byte in READ:
            for client in slow:
                client.send(bytes([byte]))
            fast.send(READ)
            self.assertEqual(fast.receive(len(ANSWER)), ANSWER)
            time.sleep(0.05)
        for client in slow:
            self.assertEqual(client.receive(len(ANSWER)), ANSWER)
        bridge = running.end()["bridge"]
        self.assertEqual(bridge["incomplete"], 0)
        self.assertEqual(bridge["bytes_in"], bridge["frames"] * len(READ))

    def test_a_part_of_an_rtu_frame_is_given_up_for_a_whole_one_or_in_time(self):
        running = self.serve("--rtu-over-tcp")
        client = self.client(running)
        self.until_answered(client)
        client.send(READ[:5])
        time.sleep(0.2)
        client.send(READ)
        self.assertEqual(client.receive(len(ANSWER)), ANSWER)
        before = running.end()["bridge"]
        self.assertEqual((before["incomplete"], before["frames"] - before["answered"] - before["given_up"]), (1, 0))

        running = self.serve("--rtu-over-tcp")
        client = self.client(running)
        self.until_answered(client)
        client.send(READ[:5])
        time.sleep(1.5)
        for byte in READ:
            client.send(bytes([byte]))
            time.sleep(0.05)
        self.assertEqual(client.receive(len(ANSWER)), ANSWER)
        self.assertEqual(running.end()["bridge"]["incomplete"], 1)

    def test_rtu_clients_take_turns(self):
        running = self.serve("--rtu-over-tcp", "--timeout", "10s")
        clients = [self.client(running) for _ in range(5)]
        self.until_answered(clients[0])
        for round_ in range(3):
            for number, client in enumerate(clients):
                request = struct.pack(">BBHH", 1, 6, number, round_)
                client.send(framed(request))
            for number, client in enumerate(clients):
                request = struct.pack(">BBHH", 1, 6, number, round_)
                self.assertEqual(client.receive(8), framed(request))

    def test_a_client_that_asks_again_has_stopped_waiting(self):
        running = self.serve("--rtu-over-tcp", "--timeout", "1h")
        client = self.client(running)
        self.until_answered(client)
        unserved = b"\x09" + READ[1:-2]
        client.send(framed(unserved))
        time.sleep(SILENCE)
        client.send(READ)
        self.assertEqual(client.receive(len(ANSWER)), ANSWER)

    def test_broken_frames_are_passed_on_and_not_answered(self):
        running = self.serve("--rtu-over-tcp")
        client = self.client(running)
        self.until_answered(client)
        for wrong in (b"\x01", READ[:-1] + b"\x00", bytes(300)):
            client.send(wrong)
            self.assertEqual(client.receive(1, SILENCE), b"", wrong)
        self.assertEqual(self.until_answered(client), ANSWER)

    def test_an_answer_to_a_frame_given_up_is_not_taken_for_the_next_ones(self):
        running = self.start("--rtu-over-tcp", 0, "--speed", 0.5, "--timeout", "20s", *PRESET)
        client = self.client(running)
        self.until_answered(client)
        long = framed(struct.pack(">BBHHB", 1, 16, 100, 100, 200) + bytes(200))  # half a second on the line
        for pause in (0, 0.05):
            client.send(long)
            time.sleep(pause)
            client.send(READ)
            self.assertEqual(client.receive(len(ANSWER)), ANSWER)
            self.assertEqual(client.receive(1, SILENCE), b"")
        client.send(READ + long + READ)
        self.assertEqual(client.receive(len(ANSWER)), ANSWER)
        self.assertEqual(client.receive(1, SILENCE), b"")
        self.assertGreaterEqual(running.end()["bridge"]["given_up"], 4)

    def test_broadcasts_that_come_at_once_are_all_sent(self):
        running = self.serve("--rtu-over-tcp", "--dump", "VW0", "--dump", "VW2", "--dump", "VW38")
        client = self.client(running)
        self.until_answered(client)
        writes = [framed(struct.pack(">BBHH", 0, 6, register, 100 + register)) for register in range(20)]
        client.send(b"".join(writes) + READ[:3])  # and the next one in two pieces, however long that takes
        time.sleep(0.001)
        client.send(READ[3:])
        self.assertEqual(client.receive(len(ANSWER)), framed(struct.pack(">BBBHH", 1, 3, 4, 110, 111)))
        bridge = running.end()
        self.assertEqual({place: shown["values"] for place, shown in bridge["dump"].items()},
                         {"VW0": [100], "VW2": [101], "VW38": [119]})

    def left_by_floods(self, kind, flood, leave, ask):
        """What is dropped of a client that sends all that its system takes, and leaves."""
        running = self.serve(kind)
        other = self.client(running)
        ask(other)
        flooder = self.client(running)
        flooder.socket.setblocking(False)
        sent, until = 0, time.monotonic() + 1
        while time.monotonic() < until:
            try:
                sent += flooder.socket.send(flood)
            except BlockingIOError:
                time.sleep(0.01)
        getattr(flooder, leave)()
        ask(other)  # all of it would be on the line for a quarter of an hour
        running.wait_for("sent before it left are dropped")
        bridge = running.end()["bridge"]
        self.assertLess(bridge["bytes_in"], 50_000)
        return sent, bridge["bytes_dropped"]

    def test_what_a_client_has_sent_and_left_is_dropped(self):
        broadcast = framed(struct.pack(">BBHH", 0, 6, 100, 1)) * 500
        ask = lambda client: self.assertEqual(self.until_answered(client), ANSWER)
        for kind, flood in (("--tcp", b"\x55" * 4096), ("--rtu-over-tcp", broadcast)):
            with self.subTest(kind):
                sent, dropped = self.left_by_floods(kind, flood, "close", ask)
                self.assertGreater(sent, 100_000)
                self.assertGreater(dropped, sent - 50_000)
                self.assertGreater(self.left_by_floods(kind, flood, "vanish", ask)[1], 0)

    def test_what_a_client_has_sent_goes_out_if_it_waits_for_that(self):
        running = self.serve("--tcp")
        client = self.client(running)
        self.assertEqual(self.until_answered(client), ANSWER)
        before = time.monotonic()
        client.send(b"\x55" * 20_000)  # 4 s
        client.socket.shutdown(socket.SHUT_WR)
        self.assertTrue(client.is_closed())
        self.assertGreater(time.monotonic() - before, 3)
        bridge = running.end()["bridge"]
        self.assertEqual(bridge["bytes_in"] % len(READ), 20_000 % len(READ))
        self.assertEqual(bridge["bytes_dropped"], 0)

    def test_what_the_line_has_no_time_for_within_ten_seconds_of_the_last_word_is_dropped(self):
        running = self.start("--tcp", 0)
        client = self.client(running)
        client.send(b"\x55" * 20_000)  # 21 s
        client.socket.shutdown(socket.SHUT_WR)
        self.assertTrue(client.is_closed())
        running.wait_for("sent before it left are dropped")
        bridge = running.end()["bridge"]
        self.assertGreater(bridge["bytes_in"], 5000)
        self.assertGreaterEqual(bridge["bytes_in"] + bridge["bytes_dropped"], 20_000)

    def test_a_last_word_is_answered_however_long_it_takes_on_the_line(self):
        running = self.start("--tcp", 0, "--speed", 0.8, program=self.slave_at(300))
        client = self.client(running)
        time.sleep(1)  # its first scan
        client.send(framed(struct.pack(">BBHHB", 1, 16, 0, 123, 246) + bytes(246)))  # 12 s
        client.socket.shutdown(socket.SHUT_WR)
        self.assertEqual(client.receive(1000), framed(struct.pack(">BBHH", 1, 16, 0, 123)))

    def test_clients_that_flood_and_do_not_read_stop_no_one(self):
        for kind in ("--tcp", "--rtu-over-tcp"):
            with self.subTest(kind):
                running = self.serve(kind)
                client = self.client(running)
                self.assertEqual(self.until_answered(client), ANSWER)
                flooder = self.client(running)
                flooder.socket.setblocking(False)
                until = time.monotonic() + 1
                while time.monotonic() < until:
                    try:
                        flooder.socket.send(READ * 500)
                    except BlockingIOError:
                        time.sleep(0.01)
                    except ConnectionError:
                        break
                if kind == "--rtu-over-tcp":
                    client.send(READ)
                    self.assertEqual(client.receive(len(ANSWER)), ANSWER)
                flooder.vanish()
                time.sleep(SILENCE)
                client.close()
                running.end()


class Rfc2217Tests(TcpCase):
    CLIENT = Client

    @staticmethod
    def until_heard(port, request=READ, length=len(ANSWER)):
        until = time.monotonic() + LONG
        while time.monotonic() < until:
            port.write(request)
            if heard := port.read(length):
                return heard
        return b""

    def open(self, running, **settings):
        if serial is None:
            self.skipTest("python3-serial is not installed")
        port = serial.serial_for_url(f"rfc2217://127.0.0.1:{running.port}", **{"baudrate": 9600, "parity": "E", "timeout": 2 * SILENCE, **settings})
        self.addCleanup(port.close)
        return port

    def test_pyserial_asks_in_the_format_that_it_sets(self):
        running = self.serve("--rfc2217")
        port = self.open(running)
        self.assertEqual(self.until_heard(port), ANSWER)
        for wrong, right in (({"baudrate": 19200}, {"baudrate": 9600}), ({"parity": "N"}, {"parity": "E"}), ({"bytesize": 7}, {"bytesize": 8})):
            with self.subTest(wrong):
                port.apply_settings(wrong)
                port.write(READ)
                self.assertNotEqual(port.read(len(ANSWER)), ANSWER)
                port.apply_settings(right)
                port.reset_input_buffer()
                self.assertEqual(self.until_heard(port), ANSWER)
        port.dtr, port.rts = True, False
        bridge = running.end()["bridge"]
        self.assertEqual((bridge["kind"], bridge["clients"]), ("rfc2217", 1))

    def test_a_break_of_pyserial_is_one_on_the_line(self):
        capture = self.folder / "line.vcd"
        running = self.serve("--rfc2217", "--capture", capture)
        port = self.open(running)
        self.until_heard(port)
        begun = time.monotonic()
        port.send_break(0.05)
        held = time.monotonic() - begun
        self.assertEqual(self.until_heard(port), ANSWER)
        self.assertEqual(running.end()["bridge"]["breaks"], 1)
        levels = re.findall(r"#(\d+)\n((?:[01][rtl]\n)+)", capture.read_text(encoding="utf-8"))
        falls = [int(at) for at, edges in levels if "0r" in edges]
        rises = [int(at) for at, edges in levels if "1r" in edges]
        longest = max(next((rise - fall for rise in rises if rise > fall), 0) for fall in falls)
        self.assertGreater(longest, 45_000_000, "as long as the client held it")
        self.assertLess(longest, (held + SILENCE) * 1_000_000_000)

    def test_a_break_ends_with_the_client_that_held_it(self):
        running = self.serve("--rfc2217")
        other = self.open(running)
        self.until_heard(other)
        port = self.open(running)
        port.break_condition = True
        time.sleep(0.1)
        other.write(READ)
        self.assertEqual(other.read(1), b"", "the line is at space")
        port.close()
        self.assertEqual(self.until_heard(other), ANSWER)
        self.assertEqual(running.end()["bridge"]["breaks"], 1)

    def test_each_client_has_settings_of_its_own(self):
        running = self.serve("--rfc2217")
        wrong, right = self.open(running, parity="N"), self.open(running)
        self.assertEqual(self.until_heard(right), ANSWER)
        self.assertNotEqual(wrong.read(1), b"")  # all hear what the line says
        wrong.write(READ)
        self.assertNotEqual(wrong.read(2 * len(ANSWER)), ANSWER)
        self.assertEqual(self.until_heard(right), ANSWER)

    def test_a_client_that_negotiates_nothing_has_the_format_of_the_program(self):
        running = self.serve("--rfc2217")
        self.assertEqual(self.until_answered(self.client(running)), ANSWER)

    def test_ser2net_joins_as_a_client(self):
        ser2net = shutil.which("ser2net") or shutil.which("ser2net", path="/usr/sbin")
        if ser2net is None:
            self.skipTest("ser2net is not installed")
        running = self.serve("--rfc2217")
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        settings = self.folder / "ser2net.yaml"
        settings.write_text(f"connection: &plc\n  accepter: tcp,127.0.0.1,{port}\n"
                            f"  connector: telnet(rfc2217=true),tcp,127.0.0.1,{running.port}\n", encoding="utf-8")
        process = subprocess.Popen([ser2net, "-n", "-d", "-c", settings], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        until = time.monotonic() + LONG
        while True:
            try:
                client = socket.create_connection(("127.0.0.1", port), timeout=2 * SILENCE)
                break
            except OSError:
                self.assertLess(time.monotonic(), until)
                time.sleep(0.05)
        self.addCleanup(client.close)
        heard = b""
        while ANSWER not in heard:
            self.assertLess(time.monotonic(), until)
            client.sendall(READ)
            try:
                heard += client.recv(1000)
            except TimeoutError:
                pass

    def test_an_endless_command_ends_the_connection(self):
        running = self.serve("--rfc2217")
        client = self.client(running)
        client.send(b"\xff\xfa" + b"," * 10_000)
        with contextlib.suppress(ConnectionResetError):  # by what it sent and nobody read
            self.assertEqual(client.receive(1000), b"")
        running.wait_for("this is not RFC 2217")


class ModbusTcpTests(TcpCase):
    CLIENT = ModbusClient

    def serve_gateway(self, *arguments):
        return self.serve("--modbus-tcp", *arguments)

    def test_answers_carry_transaction_and_unit(self):
        running = self.serve_gateway()
        client = self.client(running)
        for transaction in (0, 1, 0xABCD, 0xFFFF):
            self.assertEqual(client.ask(transaction), (transaction, 1, ANSWER_PDU))
        self.assertEqual(client.ask(5, 1, bytes.fromhex("0300000100")), (5, 1, b"\x83\x03"))
        client.close()
        bridge = running.end()["bridge"]
        self.assertEqual(list(bridge), ["kind", "clients", "sent_away", "bytes_in", "bytes_out", "bytes_dropped", "requests",
                                        "answered", "broadcast", "silent", "damaged", "no_station"])
        self.assertEqual((bridge["requests"], bridge["answered"]), (5, 5))

    def test_a_debugged_program_that_loses_its_master_goes_on_and_its_time_outs_are_its_own_affair(self):
        with subprocess.Popen([S7200, "debug", SLAVE, "--modbus-tcp", "0", *PRESET, "-i", "-x", "continue 100ms"],
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.addCleanup(process.kill)
            port = int(re.search(r":(\d+)", process.stderr.readline()).group(1))
            self.assertIn("their time-outs are their own affair", process.stderr.readline())

            def command(line, said):
                process.stdin.write(line + "\n")
                process.stdin.flush()
                while said not in (got := process.stdout.readline()):
                    self.assertTrue(got, f"{said} did not come")
            for _ in range(2):
                with socket.create_connection(("127.0.0.1", port)) as master:
                    master.sendall(message(1, 1, READ_PDU))  # and away, before the answer
                command("continue 200ms", "simulated time passed")
                command("print VW20", "16#1234")
            with socket.create_connection(("127.0.0.1", port)) as master:
                master.sendall(message(2, 1, READ_PDU))
                command("continue 300ms", "simulated time passed")
                self.assertIn(ANSWER_PDU, master.recv(100))
            process.stdin.close()
            self.assertEqual(process.wait(LONG), FINE)

    def test_exceptions_of_the_gateway(self):
        running = self.serve_gateway("--timeout", "100ms")
        client = self.client(running)
        self.assertEqual(client.ask(1, 9), (1, 9, b"\x83\x0b"))
        self.assertEqual(client.ask(2, 255), (2, 255, b"\x83\x0a"))
        self.assertEqual(client.ask(3), (3, 1, ANSWER_PDU))
        bridge = running.end()["bridge"]
        self.assertEqual((bridge["silent"], bridge["no_station"], bridge["answered"]), (1, 1, 1))

    def test_broadcasts_are_written_and_not_answered(self):
        running = self.serve_gateway()
        client = self.client(running)
        client.send(message(1, 0, bytes.fromhex("06000a4321")))
        self.assertEqual(client.ask(2), (2, 1, bytes.fromhex("030443215678")))
        self.assertEqual(running.end()["bridge"]["broadcast"], 1)

    def test_pieces_of_any_size(self):
        client = self.client(self.serve_gateway())
        client.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for byte in message(7, 1, READ_PDU):
            client.send(bytes([byte]))
            time.sleep(0.01)
        self.assertEqual(client.answer(), (7, 1, ANSWER_PDU))
        client.send(b"".join(message(number, 1, READ_PDU) for number in range(40)))
        self.assertEqual([client.answer() for _ in range(40)], [(number, 1, ANSWER_PDU) for number in range(40)])

    def test_a_client_that_has_said_its_last_word_gets_its_answers(self):
        client = self.client(self.serve_gateway())
        client.send(b"".join(message(number, 1, READ_PDU) for number in range(3)))
        client.socket.shutdown(socket.SHUT_WR)
        self.assertEqual([client.answer() for _ in range(4)], [(number, 1, ANSWER_PDU) for number in range(3)] + [None])

    def test_what_a_client_has_sent_and_left_is_dropped(self):
        running = self.serve_gateway()
        flooder = self.client(running)
        flooder.socket.setblocking(False)
        sent, until = 0, time.monotonic() + 1
        while time.monotonic() < until:
            try:
                sent += flooder.socket.send(message(1, 0, b"\x06\x00\x64\x00\x01") * 500)  # never answered
            except BlockingIOError:
                time.sleep(0.01)
        flooder.close()
        running.wait_for("sent before it left are dropped")
        bridge = running.end()["bridge"]
        self.assertGreater(bridge["bytes_dropped"], sent - 50_000)

    def test_what_is_no_modbus_tcp_ends_that_connection_only(self):
        running = self.serve_gateway()
        other = self.client(running)
        before = running.descriptors()
        for number, (wrong, why) in enumerate(((b"\0\1\0\1\0\6\1\3\0\0\0\1", "protocol 1"), (b"\0\1\0\0\0\0", "length 0"),
                                               (b"\0\1\0\0\0\1\1", "length 1"), (b"\0\1\0\0\1\0\1", "length 256"),
                                               (b"GET / HTTP/1.1\r\n\r\n", "protocol"))):
            client = self.client(running)
            client.send(wrong)
            self.assertTrue(client.is_closed())
            running.wait_for(why)
            self.assertEqual(other.ask(number), (number, 1, ANSWER_PDU))
        self.eventually(lambda: running.descriptors() <= before + 1)

    def test_what_is_no_modbus_tcp_behind_many_requests_ends_the_connection_when_they_are_answered(self):
        running = self.serve_gateway("--timeout", "20s")
        client = self.client(running)
        client.send(b"".join(message(number, 1, READ_PDU) for number in range(20)) + b"GET / HTTP/1.1\r\n\r\n")
        self.assertEqual([client.answer() for _ in range(20)], [(number, 1, ANSWER_PDU) for number in range(20)])
        self.assertTrue(client.is_closed())
        running.wait_for("this is not Modbus TCP: protocol")

    def test_fifty_clients_each_get_their_own(self):
        running = self.serve_gateway("--timeout", "20s")
        clients = [self.client(running) for _ in range(50)]
        for number, client in enumerate(clients):
            client.send(message(1000 + number, 1, struct.pack(">BHH", 6, number, number)))
        for number, client in enumerate(clients):
            self.assertEqual(client.answer(), (1000 + number, 1, struct.pack(">BHH", 6, number, number)))

    def test_clients_that_vanish_in_mid_request_leave_nothing_behind(self):
        running = self.serve_gateway()
        other = self.client(running)
        other.ask(0)
        before = running.descriptors()
        for number in range(30):
            client = self.client(running)
            client.send(message(number, 1, READ_PDU)[:7 if number % 3 == 0 else 12] * (1 + number % 2))
            client.vanish() if number % 2 else client.close()
        self.assertEqual(other.ask(77), (77, 1, ANSWER_PDU))
        self.eventually(lambda: running.descriptors() == before)

    def test_slow_and_half_open_clients_block_no_one(self):
        running = self.serve_gateway()
        half = [self.client(running) for _ in range(10)]
        for client in half:
            client.send(b"\0\1\0")
        other = self.client(running)
        for number in range(5):
            self.assertEqual(other.ask(number), (number, 1, ANSWER_PDU))

    def test_half_a_message_is_waited_for_ten_seconds(self):
        running = self.serve_gateway()
        client, patient = self.client(running), self.client(running)
        client.send(b"\0\1\0\0\0\6")
        self.assertTrue(client.is_closed())
        running.wait_for("it began a message and did not go on for 10 s")
        self.assertEqual(patient.ask(1), (1, 1, ANSWER_PDU))  # silence without half a message is not an offence

    def test_who_is_not_listened_to_has_not_stopped_in_mid_message(self):
        running = self.serve_gateway("--timeout", "1s")
        client = self.client(running)
        one = message(5, 9, READ_PDU)  # no client's; 70 of them take 14 s
        count = 1024 // len(one) + 1   # what is read at once ends in the last of them
        client.send(one * count)
        self.assertEqual([client.answer() for _ in range(count)], [(5, 9, b"\x83\x0b")] * count)

    def test_floods_block_no_one_and_fill_no_memory(self):
        running = self.serve_gateway()
        other, flooder = self.client(running), self.client(running, receive_buffer=4096)
        other.ask(0)

        def memory():
            text = pathlib.Path(f"/proc/{running.process.pid}/status").read_text(encoding="utf-8")
            return int(re.search(r"VmRSS:\s+(\d+) kB", text).group(1))

        before = memory()
        for unit in (1, 255):  # requests that wait for the line, and those that are answered at once
            flooder.socket.setblocking(False)
            until = time.monotonic() + 1.5
            number = 0
            while time.monotonic() < until:
                try:
                    flooder.socket.send(message(5, unit, READ_PDU) * 1000)
                except BlockingIOError:
                    number += 1
                    self.assertEqual(other.ask(number), (number, 1, ANSWER_PDU))
                except ConnectionError:
                    break
            flooder.vanish()
            flooder = self.client(running, receive_buffer=4096)
        self.assertEqual(other.ask(99), (99, 1, ANSWER_PDU))
        self.assertLess(memory() - before, 20_000)

    def test_for_one_client_too_many_the_one_silent_longest_has_to_go(self):
        running = self.serve_gateway()
        clients = []
        for number in range(64):
            clients.append(self.client(running))
            clients[-1].send(message(number, 255, READ_PDU))
            self.assertEqual(clients[-1].answer()[0], number)
        clients[0].ask(1, 255)
        newcomer = self.client(running)
        self.assertEqual(newcomer.ask(5), (5, 1, ANSWER_PDU))
        self.assertTrue(clients[1].is_closed())
        self.assertEqual(clients[0].ask(6), (6, 1, ANSWER_PDU))
        running.wait_for("it was silent longest")
        self.assertEqual(running.end()["bridge"]["sent_away"], 1)


# --- real devices, and how a run begins and ends ---


class DeviceTests(Case):
    def setUp(self):
        super().setUp()
        near, far = os.openpty()
        self.near, self.path = near, os.ttyname(far)
        self.port = SerialPort(self.path)
        os.close(self.port.fd)
        self.port.fd = near  # what the device sends is read here
        os.close(far)

    def tearDown(self):
        if self.near is not None:
            os.close(self.near)

    def test_asks_and_is_answered(self):
        running = self.start("--device", self.path, "--speed", SPEED, *PRESET)
        self.assertEqual(self.port.ask(), ANSWER)
        bridge = running.end()["bridge"]
        self.assertEqual(list(bridge), ["kind", "device", "bytes_in", "bytes_out", "overrun", "with_errors"])
        self.assertEqual(bridge["bytes_out"], len(ANSWER))

    def test_the_device_is_set_as_the_program_sets_its_port(self):
        # 19200 8O1 in the first scan, 2400 8N1 after a second.
        program = self.program("LD SM0.1\nMOVB 16#C5, SMB30\nLDN SM0.1\nTON T37, +10\nLD T37\nMOVB 16#11, SMB30\nMEND\n")
        running = self.start("--device", self.path, program=program)
        for baud, odd in ((termios.B19200, termios.PARODD), (termios.B2400, 0)):
            self.eventually(lambda: termios.tcgetattr(self.near)[5] == baud)
            self.assertEqual(termios.tcgetattr(self.near)[2] & termios.PARODD, odd)
        running.end()

    def test_what_the_device_cannot_do_ends_the_run(self):
        program = self.program("LD SM0.1\nMOVB 16#69, SMB30\nMEND\n")  # 7 bits, which a pty has not
        running = self.start("--device", self.path, program=program)
        running.end(UNUSABLE, by=None)
        self.assertIn("the program has set its port to 9600 baud 7E1: the device does not do 7 data bits", running.said())

    def test_a_device_that_is_unplugged_ends_the_run(self):
        running = self.start("--device", self.path)
        os.close(self.near)
        self.near = None
        self.assertEqual(running.end(UNUSABLE, by=None)["stop_reason"], "bridge")
        self.assertIn(f"{self.path}: the device is gone", running.said())

    def test_a_device_that_says_more_than_the_line_takes_is_heard_again_later(self):
        running = self.start("--device", self.path, "--speed", 50, *PRESET)
        self.assertEqual(self.port.ask(), ANSWER)
        os.set_blocking(self.near, False)
        left = 30_000

        def all_written():
            nonlocal left
            try:
                while left:
                    left -= os.write(self.near, b"\x55" * min(left, 1000))
            except BlockingIOError:
                pass
            return left == 0
        self.eventually(all_written)
        while self.port.read(1000, SILENCE):
            pass
        self.assertEqual(self.port.ask(), ANSWER)
        self.assertGreaterEqual(running.end()["bridge"]["bytes_in"], 30_000)

    def test_what_a_device_does_not_take_fills_no_memory(self):
        # 38400 8E1, without a pause. A busy machine holds a run up for some milliseconds, which shall be few characters.
        program = self.program("LD SM0.1\nMOVB 16#41, SMB30\nMOVB 255, VB0\nATCH 0, 9\nENI\nXMT VB0, 0\nMEND\n"
                               "INT 0\nLD SM0.0\nXMT VB0, 0\nRETI\n")
        running = self.start("--device", self.path, "--speed", 50, "--for", "50s", program=program)
        bridge = running.end(by=None)["bridge"]
        said = 50 * 38400 // 11
        waiting = 65_536
        self.assertGreater(bridge["overrun"], 0)
        self.assertAlmostEqual(bridge["bytes_out"] + waiting + bridge["overrun"], said, delta=said // 20)

    def test_what_is_no_device_is_refused(self):
        self.assertIn("it is not a serial device", self.refused("--device", "/dev/null"))
        self.assertIn("No such file", self.refused("--device", "/dev/no_such_device"))
        self.start("--device", self.path)
        self.assertIn("another program", self.refused("--device", self.path))


# --- PPI ---

class PpiMaster:
    """Written from the rules, as a programming device on a line of its own."""

    def __init__(self, write, read, station=2):
        self.write, self.read, self.station = write, read, station

    @staticmethod
    def sd1(*body):
        return bytes([0x10, *body, sum(body) % 256, 0x16])

    @staticmethod
    def sd2(*body):
        return bytes([0x68, len(body), len(body), 0x68, *body, sum(body) % 256, 0x16])

    def frame(self):
        begin = self.read(1)
        if begin == b"\x10":
            return begin + self.read(5)
        if begin == b"\x68":
            head = self.read(3)
            return begin + head + self.read(head[0] + 2)
        return begin

    def fetch(self, kind, parameters, data):
        """The PDU of the answer."""
        lengths = len(parameters).to_bytes(2, "big") + len(data).to_bytes(2, "big")
        self.write(self.sd2(self.station, 0, 0x6C, 0x32, kind, 0, 0, 0, 1, *lengths, *parameters, *data))
        assert self.frame() == b"\xe5"
        function = 0x5C
        while True:
            self.write(self.sd1(self.station, 0, function))
            frame = self.frame()
            if frame != b"\xe5":
                break
            function ^= 0x20
        pdu = frame[7:-2]
        assert frame == self.sd2(0, self.station, 0x08, *pdu), frame.hex()
        return pdu

    def ask_user_data(self, group, service, values=None, long_head=False):
        """What follows the head of the data of the answer."""
        head = bytes([0, 1, 0x12, 8, 0x12]) if long_head else bytes([0, 1, 0x12, 4, 0x11])
        data = b"\x0a\0\0\0" if values is None else b"\xff\x09" + len(values).to_bytes(2, "big") + values
        pdu = self.fetch(7, head + bytes([0x40 | group, service, 0]) + bytes(4 if long_head else 0), data)
        assert pdu[1] == 7 and pdu[15] == 0x80 | group and pdu[20:24] == b"\0\0\xff\x09", pdu.hex()
        return pdu[26:]

    def upload(self, name):
        """A block, part by part, as the public clients fetch it."""
        started, _ = self.ask(bytes([0x1D]) + bytes(7) + b"\x09_" + name)
        upload, length = started[4:8], int(started[9:])
        block, more = b"", True
        while more:
            parameters, data = self.ask(bytes([0x1E, 0, 0, 0]) + upload)
            more = parameters[1] == 1
            block += data[4:4 + int.from_bytes(data[:2], "big")]
        self.ask(bytes([0x1F, 0, 0, 0]) + upload)
        assert len(block) == length, (len(block), length)
        return block

    def ask(self, parameters, data=b""):
        """Parameters and data of the answer."""
        pdu = self.fetch(1, parameters, data)
        assert pdu[1] == 3 and pdu[10:12] == b"\0\0", pdu.hex()
        split = 12 + int.from_bytes(pdu[6:8], "big")
        return pdu[12:split], pdu[split:]

    @staticmethod
    def v_bytes(first, count):
        return bytes([0x12, 0x0A, 0x10, 2, *count.to_bytes(2, "big"), 0, 1, 0x84, *(first * 8).to_bytes(3, "big")])

    def read_v(self, first, count):
        _, data = self.ask(bytes([4, 1]) + self.v_bytes(first, count))
        assert data[:4] == bytes([0xFF, 4]) + (count * 8).to_bytes(2, "big"), data.hex()
        return data[4:]

    def write_v(self, first, values):
        _, data = self.ask(bytes([5, 1]) + self.v_bytes(first, len(values)),
                           bytes([0, 4]) + (len(values) * 8).to_bytes(2, "big") + values)
        assert data == b"\xff", data.hex()

    def mode(self, function):
        extra = bytes([0, 0, 0, 0, 0, 0, 0xFD, 0, 0]) if function == 0x28 else bytes(5)
        self.ask(bytes([function]) + extra + b"\x09P_PROGRAM")


class OtherPlcTests(Case):
    """Simulated PLCs of other makes, as our master outside meets them; and a line that is listened to."""

    TALK = {"modbus": ("pc1200", ["write", "40003=7", "read", "40001:3", "general-read", "0:0:4"], [[0x1234, 0x5678, 7]]),
            "pc1000-lan": ("pc1200", ["unit", "5", "write", "16#4000=16#1234", "read", "16#4000"], [[0x1234]]),
            "westnet": ("pc1200", ["address", "17", "open", "write", "0=5", "read", "0", "close"], [[5]]),
            "pc500-loader": ("pc503", ["write", "QB0=16#7F", "read", "QB0:2"], [[0x7F, 0x34]]),
            "hppc": ("hppc", ["write-register", "1=16#1234,5", "read-register", "1:2"], [[0x1234, 5]])}
    SETTINGS = {"modbus": ["--plc", "HR1=1234,5678"], "pc1000-lan": ["--plc", "sync=ignored"]}

    def serve(self, protocol, *arguments):
        return self.start(*arguments, "--protocol", protocol, *self.SETTINGS.get(protocol, []),
                          program="westinghouse:" + self.TALK[protocol][0])

    def test_a_modbus_bridge_to_plcs_that_do_not_speak_it_is_served_with_a_note(self):
        silent = self.program("LD SM0.0\nINCW VW0\nMEND\n")
        for kind in ("modbus-tcp", "rtu-over-tcp"):
            for running, why in ((lambda kind=kind: self.serve("hppc", f"--{kind}", 0), "no PLC on this line speaks it"),
                                 (lambda kind=kind: self.start(f"--{kind}", 0, program=silent),
                                  "the program has not switched port 0 to Freeport mode (SMB30 = 16#00)")):
                served = running()
                served.wait_for(f"note: {kind} carries nothing but Modbus, and {why}\n")
                served.end()
        system = self.folder / "system.yaml"
        system.write_text(f"plcs: {{a: {{program: {silent}}}}}\nbridges: {{pc: {{modbus-tcp: 0}}}}\nlines: {{l: {{stations: [a, pc]}}}}\n",
                          encoding="utf-8")
        self.start(program=system).wait_for("carries nothing but Modbus, and on a the program has not switched port 0 to Freeport mode")
        for start in (lambda: self.start("--modbus-tcp", 0), lambda: self.serve("modbus", "--rtu-over-tcp", 0),
                      lambda: self.start("--tcp", 0, program=silent)):
            running = start()
            time.sleep(0.3)
            running.end()
            self.assertNotIn("carries nothing but Modbus", running.said())

    def test_a_simulated_plc_that_was_served_is_counted_as_one(self):
        done = subprocess.run([S7200, "run", "westinghouse:pc1200", "--tcp", "0", "--for", "50ms"], capture_output=True, text=True,
                              timeout=LONG, check=False)
        self.assertRegex(done.stdout, r"\Aended by time after [0-9.]+ ms: 1 PLC, 1 line\n")

    def talk(self, protocol, target, *options):
        """What was read. Asked until all is right: a busy computer may be late for a protocol with short time-outs."""
        until = time.monotonic() + LONG
        while True:
            done = subprocess.run([S7200, "master", str(target), "--protocol", protocol, *options, "--json", *self.TALK[protocol][1]],
                                  capture_output=True, text=True, timeout=LONG, check=False)
            if done.returncode == FINE:
                return [e["values"] for e in json.loads(done.stdout)["exchanges"] if e["values"]]
            if time.monotonic() > until:
                raise AssertionError(done.stdout + done.stderr)

    def test_every_protocol_is_spoken_over_a_pty(self):
        for protocol, (_, _, values) in self.TALK.items():
            with self.subTest(protocol):
                link = self.folder / protocol
                running = self.serve(protocol, "--pty", link)
                options = [] if protocol == "pc500-loader" else ["--parity", "none"]
                self.assertEqual(self.talk(protocol, link, *options), values)
                result = running.end()
                self.assertEqual((result["stop_reason"], result["plcs"]), ("interrupted", []))
                self.assertRegex(result["bridges"][0]["summary"], "opened [0-9]+ times?, [0-9]+ bytes from it")

    def test_every_protocol_is_spoken_over_tcp(self):
        for protocol, (_, _, values) in self.TALK.items():
            with self.subTest(protocol):
                running = self.serve(protocol, "--tcp", "0")
                self.assertEqual(self.talk(protocol, f"tcp://127.0.0.1:{running.port}"), values)
                running.end()

    def test_its_modbus_is_served_over_modbus_tcp(self):
        running = self.serve("modbus", "--modbus-tcp", "0")
        self.assertEqual(self.talk("modbus", f"modbus-tcp://127.0.0.1:{running.port}"), self.TALK["modbus"][2])
        running.end()

    def test_what_is_served_is_captured_and_decoded(self):
        capture = self.folder / "line.pcap"
        running = self.serve("westnet", "--tcp", "0", "--capture", capture)
        self.talk("westnet", f"tcp://127.0.0.1:{running.port}")
        running.end()
        done = subprocess.run([S7200, "decode", capture, "--protocol", "westnet", "--json"], capture_output=True, text=True, check=True)
        texts = [frame["text"] for frame in json.loads(done.stdout)["frames"]]
        self.assertEqual(texts[-10:], ["address 00.11.00", "PLC 00.11.00 addressed", "open session", "session open",
                                       "write 2 bytes from word 16#0000 on: 05 00", "done", "read 2 bytes from word 16#0000 on",
                                       "05 00", "close session", "session closed"])

    def test_a_fault_of_its_line_is_met(self):
        running = self.serve("modbus", "--tcp", "0", "--fault", "flip:character=2,bit=0,exchange=1")
        with socket.create_connection(("127.0.0.1", running.port)) as client:
            client.settimeout(SILENCE)
            client.sendall(bytes.fromhex("010300000001840a"))
            with self.assertRaises(TimeoutError):
                client.recv(100)
            client.settimeout(LONG)
            client.sendall(bytes.fromhex("010300000001840a"))
            answer = b""
            while len(answer) < len(self.REPLY):
                answer += client.recv(100)
            self.assertEqual(answer, self.REPLY)
        running.end()

    # --- listening ---

    def listen(self, *arguments):
        """The computer's side of a serial line, and who listens there."""
        near, far = os.openpty()
        attributes = termios.tcgetattr(far)
        attributes[0] = attributes[1] = attributes[3] = 0
        termios.tcsetattr(far, termios.TCSANOW, attributes)
        path = os.ttyname(far)
        process = subprocess.Popen([S7200, *map(str, arguments), path], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: (process.kill(), process.communicate(), os.close(near)))
        self.assertRegex(process.stderr.readline(), f"^listening to {path} 9600 8[EN]1$")
        os.close(far)
        return near, process

    REQUEST = bytes.fromhex("010300000001840a")
    REPLY = framed(bytes.fromhex("0103021234"))

    def test_a_line_is_decoded_as_it_is_heard_until_ctrl_c(self):
        near, process = self.listen("decode")
        self.assertIn("silence", process.stdout.readline())
        os.write(near, self.REQUEST)
        self.assertIn("request  01 03 00 00 00 01 84 0a", process.stdout.readline())
        self.assertIn("station 1, read holding registers 40001, 1 of them", process.stdout.readline())
        os.write(near, self.REPLY)
        self.assertIn("answer   01 03 02 12 34 b5 33", process.stdout.readline(), "at once: it is complete")
        self.assertIn("1 register: 16#1234", process.stdout.readline())
        os.write(near, self.REQUEST[:5])
        self.assertIn("?        01 03 00 00 00", process.stdout.readline(), "after a silence")
        self.assertIn("not a whole frame", process.stdout.readline())
        process.send_signal(signal.SIGINT)
        out, error = process.communicate(timeout=LONG)
        self.assertRegex(out, "^requests: 1, answered: 1 after .* to .*; wrong frames: 1, frames of no request: 0\n$")
        self.assertEqual((process.returncode, error), (FINE, ""))

    def test_a_master_waits_no_longer_for_its_answer_because_others_talk(self):
        near, far = os.openpty()
        attributes = termios.tcgetattr(far)
        attributes[0] = attributes[1] = attributes[3] = 0
        termios.tcsetattr(far, termios.TCSANOW, attributes)
        process = subprocess.Popen([S7200, "master", os.ttyname(far), "--station", "9", "--timeout", "300ms", "read", "40011"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: (process.kill(), process.communicate(), os.close(near), os.close(far)))
        os.read(near, 1)  # the request is on its way
        until = time.monotonic() + LONG
        while process.poll() is None:
            self.assertLess(time.monotonic(), until, "it waits for a silence that does not come")
            os.write(near, b"\x01\x03")
            time.sleep(0.02)
        self.assertEqual(process.returncode, FAILED, process.communicate())

    def test_a_line_is_decoded_for_a_time_as_json(self):
        near, process = self.listen("decode", "--json", "--for", "1s", "--protocol", "pc1000-lan")
        os.write(near, bytes.fromhex("0a050000000f" "0a0501000010"))
        out, _ = process.communicate(timeout=LONG)
        result = json.loads(out)
        self.assertEqual(result["form"], "live")
        self.assertEqual([frame["text"] for frame in result["frames"]], ["address unit 16#05", "keyswitch in stop, fault register 16#0000"])
        self.assertEqual((result["summary"]["requests"], result["summary"]["answered"]), (1, 1))

    def test_what_is_heard_becomes_a_scenario(self):
        near, process = self.listen("import-capture", "--for", "1s")
        os.write(near, self.REQUEST)
        time.sleep(0.1)
        os.write(near, self.REPLY)
        out, _ = process.communicate(timeout=LONG)
        self.assertIn("- send: 01 03 00 00 00 01 84 0a\n        expect: 01 03 02 12 34 b5 33\n        latency: ", out)

    def test_ctrl_c_ends_what_is_heard_and_the_scenario_is_written(self):
        scenario = self.folder / "heard.yaml"
        near, process = self.listen("import-capture", "-o", scenario)
        os.write(near, self.REQUEST + self.REPLY)
        time.sleep(SILENCE)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(LONG), FINE)
        self.assertIn("expect: 01 03 02 12 34 b5 33", scenario.read_text(encoding="utf-8"))

    def test_listening_for_a_time_that_is_interrupted_is_a_failure(self):
        for verb in ("decode", "import-capture"):
            with self.subTest(verb):
                near, process = self.listen(verb, "--for", "1h")
                os.write(near, self.REQUEST)
                time.sleep(0.05)  # no answer comes before its request is over
                os.write(near, self.REPLY)
                time.sleep(SILENCE)
                process.send_signal(signal.SIGINT)
                out, error = process.communicate(timeout=LONG)
                self.assertIn("01 03 02 12 34 b5 33", out, "what was heard is completed")
                self.assertEqual((process.returncode, error), (FAILED, "s7200: note: interrupted\n"))

    def test_listening_for_no_one_ends(self):
        near, process = self.listen("decode")
        process.stdout.readline()
        process.stdout.close()
        os.write(near, self.REQUEST)
        self.assertEqual(process.wait(LONG), -signal.SIGPIPE)
        self.assertEqual(process.stderr.read(), "")
        process.stdout = None

    def test_a_device_that_goes_away_ends_listening_with_what_was_heard(self):
        near, process = self.listen("decode")
        process.stdout.readline()
        os.write(near, self.REQUEST)
        process.stdout.readline()
        nothing = os.open("/dev/null", os.O_RDONLY)
        os.dup2(nothing, near)
        os.close(nothing)
        out, error = process.communicate(timeout=LONG)
        self.assertEqual(process.returncode, UNUSABLE)
        self.assertIn("is gone", error)
        self.assertIn("requests: 1, answered: 0", out)

    def test_what_makes_no_sense_for_a_line_or_a_recording_is_refused(self):
        for arguments, why in ((["decode", "/dev/ttyNOT_HERE"], "cannot open /dev/ttyNOT_HERE"),
                               (["decode", "westinghouse:pc1200"], "nothing is said there unless it is asked"),
                               (["decode", "modbus-tcp://localhost"], "nothing is said there unless it is asked"),
                               (["decode", "/dev/ttyNOT_HERE", "--stamps", "end"], "--stamps needs a recording"),
                               (["decode", "/dev/ttyNOT_HERE", "--tcp-port", "503"], "--tcp-port needs a recording"),
                               (["import-capture", str(SOURCE / "tests/recordings/plant.log"), "--for", "1s"], "--for needs a line to listen to")):
            with self.subTest(arguments):
                done = subprocess.run([S7200, *arguments], capture_output=True, text=True, timeout=LONG, check=False)
                self.assertEqual((done.returncode, done.stdout), (UNUSABLE, ""), done.stderr)
                self.assertIn(why, done.stderr)


class PpiTests(Case):
    COUNTING = "LD SM0.0\nINCW VW0\nLD SM0.1\nINCW VW2\nMEND\n"

    def exercise(self, master):
        master.write_v(100, bytes(range(200)))
        self.assertEqual(master.read_v(100, 200), bytes(range(200)))
        first = master.read_v(0, 2)
        self.assertNotEqual(master.read_v(0, 2), first, "the program runs")
        master.mode(0x29)
        first = master.read_v(0, 2)
        self.assertEqual(master.read_v(0, 2), first, "it stands")
        master.mode(0x28)
        self.assertEqual(master.read_v(2, 2), b"\0\2", "its second first scan")

    def test_a_client_reads_and_writes_v_memory_over_a_pty(self):
        self.start("--speed", SPEED, "--pty", self.folder / "plc", program=self.program(self.COUNTING))
        with SerialPort(self.folder / "plc") as port:
            self.exercise(PpiMaster(port.write, port.read))

    def test_a_client_lists_the_blocks_uploads_the_data_and_forces_an_output(self):
        """In the order in which the tests of libnodave do it."""
        running = self.start("--speed", SPEED, "--pty", self.folder / "plc", program=self.program(self.COUNTING))
        with SerialPort(self.folder / "plc") as port:
            master = PpiMaster(port.write, port.read)
            counts = master.ask_user_data(3, 1)
            self.assertEqual([(counts[i:i + 2], counts[i + 3]) for i in range(0, len(counts), 4) if counts[i + 3]], [(b"08", 1), (b"0A", 1), (b"0B", 1)])
            self.assertEqual(master.ask_user_data(3, 2, b"0A")[:2], b"\0\1")
            information = master.ask_user_data(3, 3, b"0A00001A")
            length = int.from_bytes(information[40:42], "big")
            master.write_v(1000, b"upload")
            block = master.upload(b"0A00001A")
            self.assertEqual((block[:2], block[36 + 1000:36 + 1006], len(block)), (b"pp", b"upload", 36 + length + 36))
            force = bytes([0, 1, 0x10, 1, 0, 1, 0, 0, 0x82, 0, 0, 0, 1, 0])
            self.assertEqual(master.ask_user_data(8, 0x0B, force, long_head=True), b"\0\1\xff")
            self.eventually(lambda: master.ask(bytes([4, 1, 0x12, 0x0A, 0x10, 1, 0, 1, 0, 0, 0x82, 0, 0, 0]))[1][4:] == b"\1")
            self.assertEqual(master.ask_user_data(8, 0x0B, b"\1" + force[1:-2], long_head=True), b"\1\1\xff")
        running.end()

    ECHOES_IN_RUN = ("LD SM0.1\nMOVB 16#48, SMB30\nATCH 0, 8\nENI\nLD SM0.7\n= SM30.0\nMEND\n"
                     "INT 0\nLD SM0.0\nMOVB 1, VB100\nMOVB SMB2, VB101\nXMT VB100, 0\nRETI\n")

    def test_the_mode_switch_turns_freeport_into_ppi_and_back(self):
        status, its_answer = bytes.fromhex("100200494b16"), bytes.fromhex("100002000216")
        switch = self.folder / "switch.csv"
        switch.write_text("".join(f"{2 * i}s,SM0.7,{i % 2}\n" for i in range(60)), encoding="utf-8")
        self.start("--pty", self.folder / "plc", "--input", switch, program=self.program(self.ECHOES_IN_RUN))
        with SerialPort(self.folder / "plc") as port:
            def until(request, answer):
                def answered():
                    port.write(request)
                    return port.read(len(answer), SILENCE * 2) == answer
                self.eventually(answered)
            until(b"A", b"A")
            until(status, its_answer)
            self.assertEqual(PpiMaster(port.write, port.read).read_v(100, 1), b"\1", "length of the last echo; it may be of the status request")
            until(b"B", b"B")

    def test_a_cpu_that_a_master_has_stopped_answers_and_is_not_said_to_be_silent(self):
        running = self.start("--pty", self.folder / "plc", program=self.program(self.COUNTING))
        with SerialPort(self.folder / "plc") as port:
            master = PpiMaster(port.write, port.read)
            master.mode(0x29)
            master.read_v(0, 2)
        result = running.end()
        self.assertEqual((result["stop_reason"], result["mode"]), ("interrupted", "STOP"))
        self.assertNotIn("answers", running.said())

    STOPS = "LD SM0.0\nTON T32, +300\nLD T32\nSTOP\nMEND\n"

    def test_a_program_that_stops_ends_the_run_of_a_modbus_gateway_with_a_note(self):
        running = self.start("--modbus-tcp", 0, program=self.program(self.STOPS))
        self.assertEqual(running.end(by=None)["stop_reason"], "stop")
        self.assertIn("the CPU went to STOP, which ends the run", running.said())

    def test_a_program_that_stops_speaks_ppi_on_and_can_be_started_again(self):
        running = self.start("--tcp", "127.0.0.1:0", program=self.program(
            "LD SM0.1\nMOVW 0, VW10\nLD SM0.0\nINCW VW10\nLDW= VW10, 2000\nSTOP\nMEND\n"))
        status, accepted = bytes.fromhex("100200494b16"), b"\xe5"
        deadline = time.monotonic() + LONG
        while "the CPU went to STOP: its ports speak PPI" not in running.said():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)
        with socket.create_connection((running.host, running.port), timeout=LONG) as connection:
            connection.sendall(status)
            self.assertEqual(b"".join(connection.recv(1) for _ in range(6)), bytes.fromhex("100002000216"))
            body = bytes.fromhex("02006c 3201 0000 0001 0014 0000 28 00 00 00 00 00 00 fd 00 00 09") + b"P_PROGRAM"
            connection.sendall(bytes([0x68, len(body), len(body), 0x68]) + body + bytes([sum(body) & 0xFF, 0x16]))
            self.assertEqual(connection.recv(1), accepted)
            answer = accepted
            while answer == accepted:  # RUN takes effect when its answer has been fetched
                connection.sendall(bytes.fromhex("1002005c5e16"))
                answer = connection.recv(1)
            self.assertEqual(answer, b"\x68")
        deadline = time.monotonic() + LONG
        while running.said().count("the CPU went to STOP") < 2:
            self.assertLess(time.monotonic(), deadline, "it has run, and stopped itself once more")
            time.sleep(0.05)
        self.assertGreater(running.end()["scans"], 2)

    def test_a_client_reads_and_writes_v_memory_over_tcp(self):
        running = self.start("--speed", SPEED, "--tcp", "127.0.0.1:0", program=self.program(self.COUNTING))
        with socket.create_connection((running.host, running.port), timeout=LONG) as connection:
            def read(count):
                data = b""
                while len(data) < count:
                    data += connection.recv(count - len(data))
                return data
            self.exercise(PpiMaster(connection.sendall, read))


class RunTests(Case):
    def test_addresses(self):
        running = self.start("--modbus-tcp", "127.0.0.1:0")
        self.assertEqual(running.host, "127.0.0.1")
        self.assertIn("Address already in use", self.refused("--tcp", running.port))
        for wrong in ("x", "65536", "-1", "", "1.2.3:5", "name:5", "::1:5", "[::1", "[1.2.3.4]:5", "1.2.3.4:", "203.0.113.1:5"):
            with self.subTest(wrong):
                self.refused("--tcp", wrong)

    def test_ipv6(self):
        if not socket.has_ipv6 or not os.path.exists("/proc/net/if_inet6"):
            self.skipTest("no IPv6 here")
        running = self.start("--modbus-tcp", "[::1]:0", "--speed", SPEED, *PRESET)
        self.assertEqual(running.host, "[::1]")
        with ModbusClient(running) as client:
            self.assertEqual(client.ask(1), (1, 1, ANSWER_PDU))

    def test_one_bridge_at_a_time(self):
        self.assertIn("one bridge at a time", self.refused("--tcp", "0", "--modbus-tcp", "0"))
        self.assertIn("one bridge at a time", self.refused("--tcp", "0", "--pty", self.folder / "plc"))
        self.assertFalse((self.folder / "plc").exists())

    def test_ends_with_a_summary(self):
        for by in (signal.SIGINT, signal.SIGTERM):
            memory = self.folder / "memory.json"
            running = self.start("--pty", self.folder / "plc", *PRESET, "--dump", "VW20", "--memory", memory)
            time.sleep(0.3)
            result = running.end(by=by)
            self.assertEqual(list(result), ["s7200", "stop_reason", "time_ns", "scans", "shortest_scan_ns", "longest_scan_ns", "instructions", "mode", "errors",
                                            "errors_not_listed", "faults", "dump", "realtime", "bridge"])
            self.assertEqual((result["stop_reason"], result["dump"]["VW20"]["hex"]), ("interrupted", "1234"))
            self.assertEqual(list(result["realtime"]), ["speed", "drift_ns", "worst_lag_ns"])
            self.assertTrue(memory.exists())
            self.assertFalse(os.path.lexists(self.folder / "plc"))

    def test_ends_when_its_time_is_over_or_the_cpu_stops(self):
        link = self.folder / "plc"
        result = self.start("--pty", link, "--for", "300ms").end(by=None)
        self.assertEqual(result["stop_reason"], "time")
        self.assertGreaterEqual(result["time_ns"], 300_000_000)
        self.assertEqual(self.start("--pty", link, "--scans", "50").end(by=None)["scans"], 50)
        stop = self.program("LD SM0.0\nTON T37, +2\nLD T37\nSTOP\nMEND\n")
        self.assertEqual(self.start("--modbus-tcp", 0, program=stop).end(by=None)["stop_reason"], "stop")
        result = self.start("--pty", link, "--for", "500ms", program=stop).end(by=None)
        self.assertEqual((result["stop_reason"], result["mode"]), ("time", "STOP"), "a PPI master may start it again")
        fatal = self.program("LD SM0.0\nLBL 1\nJMP 1\nMEND\n")
        self.assertEqual(self.start("--pty", link, program=fatal).end(FATAL, by=None)["stop_reason"], "fatal")
        self.assertFalse(os.path.lexists(link))

    def test_follows_the_clock(self):
        def timed(*arguments):
            begin = time.monotonic()
            done = subprocess.run([S7200, "run", SLAVE, "--json", *arguments], stdin=subprocess.DEVNULL, capture_output=True,
                                  text=True, timeout=LONG, check=True)
            return time.monotonic() - begin, json.loads(done.stdout)
        took, result = timed("--realtime", "--for", "500ms")
        self.assertGreaterEqual(took, 0.5)
        self.assertEqual((result["stop_reason"], result["realtime"]["speed"]), ("time", 1))
        took, result = timed("--speed", "0.5", "--for", "300ms")
        self.assertGreaterEqual(took, 0.6)
        self.assertNotIn("realtime", timed("--for", "500ms")[1])

    def test_what_is_recorded_can_be_followed_while_it_runs(self):
        blinks = self.program("LD SM0.5\n= Q0.0\nLD SM0.1\nATCH 0, 8\nENI\nMEND\nINT 0\nRETI\n")
        system = self.folder / "one.yaml"
        system.write_text(f"plcs:\n  one: {{program: {blinks}}}\nlines:\n  bus: {{stations: [one]}}\n", encoding="utf-8")
        for what, arguments in ((blinks, ["--output", self.folder / "outputs"]), (blinks, ["--trace", self.folder / "trace"]),
                                (blinks, ["--trace", "-"]), (system, ["--trace", self.folder / "of_system"])):
            with self.subTest(arguments):
                aside = self.folder / "stdout"
                with open(aside, "w", encoding="utf-8") as out:
                    run = subprocess.Popen([S7200, "run", str(what), "--speed", "20", "--for", "10000h", *map(str, arguments)],
                                           stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.DEVNULL)
                self.addCleanup(run.wait)
                self.addCleanup(run.kill)
                followed = aside if arguments[1] == "-" else arguments[1]
                until = time.monotonic() + LONG
                while not followed.exists() or len(followed.read_text(encoding="utf-8").splitlines()) < 5:
                    self.assertIsNone(run.poll())
                    self.assertLess(time.monotonic(), until, "nothing comes before 64 KB")
                    time.sleep(0.05)
                self.assertTrue(followed.read_text(encoding="utf-8").endswith("\n"), "whole lines")
                run.kill()

    def test_the_first_request_and_one_after_a_broadcast_are_answered_at_every_rate(self):
        for baud in self.RATES:
            with self.subTest(baud):
                running = self.start("--modbus-tcp", 0, "--speed", SPEED, "--timeout", "2s", *PRESET, program=self.slave_at(baud))
                with ModbusClient(running) as client:
                    self.assertEqual(client.ask(1), (1, 1, ANSWER_PDU))
                    client.send(message(2, 0, b"\x06\x00\x64\x00\x01"))
                    self.assertEqual(client.ask(3), (3, 1, ANSWER_PDU))
                running.end()

    def test_a_master_waits_for_the_end_of_a_broadcast_at_every_rate(self):
        for baud in (300, 9600):
            with self.subTest(baud):
                link = self.folder / f"plc_{baud}"
                running = self.start("--pty", link, program=self.slave_at(baud))
                time.sleep(1)  # its first scan
                done = subprocess.run([S7200, "master", link, "--baud", str(baud), "station", "0", "write", "40001=5", "station", "1",
                                       "read", "40001", "--json", "--timeout", "10s"], stdin=subprocess.DEVNULL,
                                      capture_output=True, text=True, timeout=LONG, check=False)
                self.assertEqual(done.returncode, FINE, done.stdout + done.stderr)
                self.assertEqual(json.loads(done.stdout)["exchanges"][1]["values"], [5])
                running.end()

    def test_waits_without_work(self):
        process = subprocess.Popen([S7200, "run", SLAVE, "--speed", "0.05", "--for", "150ms"], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL)
        _, status, used = os.wait4(process.pid, 0)  # after 3 s
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, FINE)
        self.assertLess(used.ru_utime + used.ru_stime, 1.5)


class ScenarioTests(Case):
    """`s7200 test` on slaves that are not programs of its own."""

    def s7200_test(self, code, *arguments):
        done = subprocess.run([S7200, "test", *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=4 * LONG, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def scenarios(self, text):
        path = self.folder / "scenarios.yaml"
        path.write_text(text, encoding="utf-8")
        return path

    def test_random_traffic_is_answered_right_on_every_way(self):
        link = self.folder / "plc"
        for bridge, where, target in (("--pty", link, str(link)), ("--rtu-over-tcp", 0, "tcp://127.0.0.1:{}"),
                                      ("--modbus-tcp", 0, "modbus-tcp://127.0.0.1:{}")):
            with self.subTest(bridge):
                running = self.start(bridge, where, "--speed", SPEED)
                done = self.s7200_test(FINE, "--random", 40, "--target", target.format(running.port))
                self.assertIn("1 scenario: 1 passed", done.stdout)
                self.assertEqual(running.end()["errors"], [])

    def test_rules_are_judged_as_far_as_they_can_be(self):
        description = self.folder / "slave.yaml"
        description.write_text("functions: [3, 6]\nholding_registers: {count: 1000}\nanswers_within: 20s\n", encoding="utf-8")
        link = self.folder / "plc"
        self.start("--pty", link)
        subprocess.run([S7200, "master", link, "read", "40001", "--timeout", "500ms", "--retries", "100"],  # its first scan is long
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, timeout=LONG, check=True)

        def outcomes(only):
            rules = json.loads(self.s7200_test(FINE, "--conformance", description, "--target", link, "--only", only, "--json").stdout)
            return {rule["rule"]["id"]: rule["outcome"] for rule in rules["scenarios"]}
        for kept in ("AP-03-read", "AP-03-quantity", "AP-03-address", "AP-06-write", "SL-after-answer"):
            self.assertEqual(outcomes(kept), {kept: "passed"})
        for unjudged in ("SL-turnaround", "SL-stream"):
            self.assertEqual(outcomes(unjudged), {unjudged: "skipped"})

    def test_a_live_slave_is_compared_with_a_program_as_far_as_both_can(self):
        link = self.folder / "plc"
        self.start("--pty", link, "--speed", SPEED)
        subprocess.run([S7200, "master", link, "read", "40001", "--timeout", "500ms", "--retries", "100"],
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, timeout=LONG, check=True)
        path = self.scenarios("timeout: 20s\nscenarios:\n"
                              "  - {name: plain, steps: [{read: holding 0}, {read: holding 0, count: 126}]}\n"
                              "  - {name: setting, set: {VW0: 1}, steps: [{read: holding 0}]}\n")
        for arguments in (["--target", link, "--against", SLAVE], ["--target", SLAVE, "--against", link]):
            done = self.s7200_test(FINE, path, *arguments, "--tolerance", "10s")
            self.assertRegex(done.stdout, r"same +plain +2 exchanges\n +skip +setting +\(needs a program in simulation")

    def test_a_slave_that_is_lost_fails_its_scenario_and_the_others_are_run_if_it_comes_back(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            def serve():
                for answers in (1, 2):  # connections, and how much each is answered
                    client, _ = server.accept()
                    with client:
                        for _ in range(answers):
                            client.recv(len(READ))
                            client.sendall(ANSWER)
                        if answers == 2:
                            server.close()
                        client.recv(len(READ))
            server_thread = threading.Thread(target=serve)
            server_thread.start()
            target = f"tcp://127.0.0.1:{server.getsockname()[1]}"
            ask = "{read: holding 10, count: 2, expect: [16#1234, 16#5678]}"
            path = self.scenarios(f"timeout: {LONG}s\nscenarios:\n"
                                  f"  - {{name: breaks, steps: [{ask}, {ask}, {ask}]}}\n"
                                  f"  - {{name: is there again, steps: [{ask}, {ask}]}}\n"
                                  f"  - {{name: breaks again, steps: [{ask}]}}\n"
                                  f"  - {{name: is gone, steps: [{ask}]}}\n  - {{name: comes never, steps: [{ask}]}}\n")
            done = self.s7200_test(UNUSABLE, path, "--target", target)
            server_thread.join()
        self.assertRegex(done.stdout, r"(?s)FAIL .* breaks\n.*pass .* is there again\n.*FAIL .* breaks again\n.*3 scenarios: 1 passed, 2 failed")
        self.assertIn("has closed the connection", done.stdout)
        self.assertNotIn("is gone", done.stdout)
        self.assertIn("note: 2 scenarios were not run", done.stderr)
        self.assertIn("cannot reach", done.stderr)

    def test_ctrl_c_ends_all_jobs_with_what_was_seen(self):
        endless = "{repeat: 1000, steps: [{wait: 1000000ms}]}"
        path = self.scenarios(f"program: {SLAVE}\nscenarios:\n  - {{name: quick, steps: [{{wait: 1ms}}]}}\n" +
                              "".join(f"  - {{name: endless {i}, steps: [{endless}]}}\n" for i in range(4)))
        process = subprocess.Popen([S7200, "test", path, "--jobs", "3"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        heard = ""
        while "quick" not in heard:
            line = process.stdout.readline()
            self.assertTrue(line, "it ended")
            heard += line
        process.send_signal(signal.SIGINT)
        out, error = process.communicate(timeout=LONG)
        self.assertEqual(process.returncode, FAILED)
        self.assertRegex(out, r"(?m)^[12] scenarios?: 1 passed")
        self.assertRegex(error, "[34] scenarios were not run")
        self.assertIn("note: interrupted", error)


if __name__ == "__main__":
    group = {"pty": PtyTests, "tcp": TcpTests, "rfc2217": Rfc2217Tests, "modbus_tcp": ModbusTcpTests, "device": DeviceTests, "ppi": PpiTests, "other_plcs": OtherPlcTests,
             "run": RunTests, "scenarios": ScenarioTests}[GROUP]
    result = unittest.TextTestRunner(stream=sys.stdout).run(unittest.defaultTestLoader.loadTestsFromTestCase(group))
    sys.exit(0 if result.wasSuccessful() else 1)
