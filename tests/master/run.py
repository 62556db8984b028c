#!/usr/bin/env python3
"""`s7200 master` against slaves that do right, wrong and nothing: run.py S7200"""
import fcntl
import json
import os
import pathlib
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest

from peers import Model, PcModel, PtyPeer, TcpPeer, framed, is_pc_command, modbus_tcp, rtu

S7200 = sys.argv[1]
FINE, FAILED, UNUSABLE, FATAL = range(4)
READ = framed(b"\x01\x03\x00\x00\x00\x01")       # read 40001
RIGHT = framed(b"\x01\x03\x02\x12\x34")
QUICK = ["--timeout", "300ms"]  # for silence; a loaded machine must not be late by more where an answer is expected
PATIENT = ["--timeout", "20s"]


class Case(unittest.TestCase):
    def peer(self, kind, *arguments):
        peer = kind(*arguments)
        self.addCleanup(peer.close)
        return peer

    def pty(self, *answers):
        """A pty on which the first request gets the first answer and so on, the last for all further ones."""
        left = list(answers)
        return self.peer(PtyPeer, lambda _: left.pop(0) if len(left) > 1 else left[0])

    def tcp(self, scheme, *answers):
        left = list(answers)
        return self.peer(TcpPeer, lambda request: (left.pop(0) if len(left) > 1 else left[0])(request), scheme)

    def master(self, code, *arguments):
        done = subprocess.run([S7200, "master", *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=120, check=False)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        return done

    def json(self, code, *arguments):
        return json.loads(self.master(code, *arguments, "--json").stdout)

    def only(self, code, *arguments):
        (exchange,) = self.json(code, *arguments)["exchanges"]
        return exchange

    def begin(self, *arguments, **options):
        process = subprocess.Popen([S7200, "master", *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, **options)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.kill)
        return process


def until(condition, what):
    end = time.monotonic() + 60
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"{what} did not happen")
        time.sleep(0.01)


class EveryFunction(Case):
    ACTIONS = ["write", "00003=on", "00009=1,0,1,1", "40011=1234,-5", "40020=16#ABCD", "read", "00001:12", "10001:4", "30001:2",
               "40011:2", "465536", "exception-status", "loopback", "loopback", "7,8", "diagnostics", "11", "slave-id",
               "write-file", "4:7=1,2", "read-file", "4:7:2", "general-write", "1:16#203=10,20,30", "general-read",
               "1:16#203:3", "function", "65", "0102"]
    VALUES = [None, None, None, None, [0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 1, 1], [1, 0, 0, 1], [1000, 1001], [1234, 65531], [0],
              None, [0x3412], [7, 8], [42], None, None, [1, 2], None, None, None]

    def check(self, peer):
        result = self.json(FINE, peer.path, *self.ACTIONS, *PATIENT)
        self.assertIsNone(result["error"])
        exchanges = result["exchanges"]
        self.assertEqual([e["values"] for e in exchanges], self.VALUES)
        self.assertEqual([e["function"] for e in exchanges],
                         [5, 15, 16, 6, 1, 2, 4, 3, 3, 7, 8, 8, 8, 17, 21, 20, 21, 20, 65])
        self.assertEqual([e["bytes"] for e in exchanges if e["bytes"]], ["6d", "15ff0102", "0a141e"])
        self.assertEqual(result["statistics"]["right"], len(exchanges))
        self.assertEqual({e["verdict"] for e in exchanges}, {"right"})
        self.assertTrue(all(e["latency_us"] >= 0 for e in exchanges))

    def test_over_a_pty(self):
        self.check(self.peer(PtyPeer, rtu(Model())))

    def test_over_tcp(self):
        peer = self.peer(TcpPeer, rtu(Model()), "tcp")
        self.check(peer)
        self.assertEqual(peer.connections, 1)

    def test_over_modbus_tcp(self):
        peer = self.peer(TcpPeer, modbus_tcp(Model()), "modbus-tcp")
        self.check(peer)
        transactions = [struct.unpack(">H", r[:2])[0] for r in peer.requests]
        self.assertEqual(len(set(transactions)), len(transactions))

    def test_overrides_write_single_ones_with_15_and_16(self):
        model = Model()
        peer = self.peer(PtyPeer, rtu(model))
        self.master(FINE, peer.path, "write", "00002=on", "40001=5", "--always-15", *PATIENT)
        self.master(FINE, peer.path, "write", "00001=on", "40002=6", "--always-16", *PATIENT)
        self.assertEqual([r[1] for r in peer.requests], [15, 6, 5, 16])
        self.assertEqual((model.coils[:2], model.registers[:2]), ([1, 1], [5, 6]))

    def test_stations_are_asked_in_turn(self):
        peer = self.peer(PtyPeer, rtu(Model()))
        self.master(FINE, peer.path, "slave-id", "station", "7", "slave-id", "station", "0", "write", "40001=1", "--station", "247",
                    *PATIENT)
        self.assertEqual([r[0] for r in peer.requests], [247, 7, 0])

    def test_loopback_sends_another_word_each_time(self):
        peer = self.peer(PtyPeer, rtu(Model()))
        statistics = self.json(FINE, peer.path, "loopback", "--continuous", "--count", "20", *PATIENT)["statistics"]
        self.assertEqual((statistics["requests"], statistics["right"]), (20, 20))
        self.assertEqual(len({r[4:6] for r in peer.requests}), 20)
        latency = statistics["latency_us"]
        self.assertTrue(latency["least"] <= latency["mean"] <= latency["p99"] <= latency["most"])


class WrongAnswers(Case):
    def test_each_is_named_and_ends_in_1(self):
        for answer, fault in (
                (b"\x01\x03\x02\x12\x34\x00\x00", "wrong CRC"),
                (b"\xde\xad\xbe\xef\x00\xff\xff", "wrong CRC"),
                (b"\x01", "too short for an answer: 01"),
                (RIGHT[:5], "wrong CRC"),
                (framed(b"\x02\x03\x02\x12\x34"), "answer of station 2, not 1"),
                (framed(b"\x01\x04\x02\x12\x34"), "answer to function 4, not 3"),
                (framed(b"\x01\x03\x04\x12\x34"), "wrong byte count: 4, expected 2"),
                (framed(b"\x01\x03\x02\x12\x34\x56"), "wrong length: 3 data bytes, expected 2"),
                (RIGHT + b"\x01", "wrong CRC"),
                (framed(b"\x01\x83"), "wrong length: 0 data bytes, expected 1"),
                (bytes(2000), "an answer without end, cut off")):
            with self.subTest(fault):
                exchange = self.only(FAILED, self.pty([(0, answer)]).path, "read", "40001", *PATIENT)
                self.assertEqual((exchange["verdict"], exchange["fault"]), ("wrong", fault))
        exchange = self.only(FAILED, self.pty([(0, framed(b"\x01\x06\x00\x00\x00\x06"))]).path, "write", "40001=5", *PATIENT)
        self.assertEqual(exchange["fault"], "does not repeat the request: 00 00 00 06")

    def test_an_exception_is_no_wrong_answer_but_ends_in_1_too(self):
        exchange = self.only(FAILED, self.pty([(0, framed(b"\x01\x83\x02"))]).path, "read", "40001", *PATIENT)
        self.assertEqual((exchange["verdict"], exchange["fault"]), ("exception", None))
        self.assertEqual(exchange["exception"], {"code": 2, "name": "illegal data address"})

    def test_silence(self):
        peer = self.pty([])
        exchange = self.only(FAILED, peer.path, "read", "40001", *QUICK)
        self.assertEqual((exchange["verdict"], exchange["response"], exchange["latency_us"]), ("silent", None, None))
        self.assertEqual(peer.requests, [READ])

    def test_an_answer_in_pieces_is_one_answer(self):
        for peer in (self.pty([(0, RIGHT[:3]), (0.08, RIGHT[3:])]),
                     self.tcp("tcp", lambda _: [(0, RIGHT[:1]), (0.05, RIGHT[1:4]), (0.05, RIGHT[4:])])):
            self.assertEqual(self.only(FINE, peer.path, "read", "40001", *PATIENT)["values"], [0x1234])

    def test_silence_asked_for_ends_an_answer(self):
        peer = self.pty([(0, RIGHT[:3]), (1, RIGHT[3:])])
        self.assertEqual(self.only(FAILED, peer.path, "read", "40001", "--silence", "5ms", *PATIENT)["response"], "010302")

    def test_a_late_answer_is_not_taken_for_the_next(self):
        peer = self.pty([(1, framed(b"\x01\x03\x02\x66\x66"))], [(0, RIGHT)])
        late, right = self.json(FAILED, peer.path, "read", "40001", "wait", "3s", "read", "40001", "--timeout", "500ms")["exchanges"]
        self.assertEqual(late["verdict"], "silent")
        self.assertEqual((right["verdict"], right["values"]), ("right", [0x1234]))
        self.assertEqual(right["remark"], "ignored what came before the request: 01 03 02 66 66 13 ce")

    def test_retries_are_counted(self):
        peer = self.pty([], [(0, RIGHT[:4])], [(0, RIGHT)])
        result = self.json(FINE, peer.path, "read", "40001", "--retries", "2", "--timeout", "2s")
        self.assertEqual(result["exchanges"][0]["attempts"], 3)
        self.assertEqual((result["statistics"]["requests"], result["statistics"]["repeated"]), (1, 2))
        self.assertEqual(len(peer.requests), 3)

    def test_a_broadcast_is_not_answered(self):
        silent = self.only(FINE, self.pty([]).path, "write", "40001=5", "--station", "0", *PATIENT)
        self.assertEqual((silent["verdict"], silent["station"], silent["response"]), ("right", 0, None))
        answered = self.pty([(0, framed(b"\x00\x06\x00\x00\x00\x05"))])
        exchange = self.only(FAILED, answered.path, "write", "40001=5", "--station", "0")
        self.assertEqual(exchange["fault"], "an answer to what is never answered")

    def test_a_raw_frame_is_sent_as_it_is(self):
        peer = self.pty([(0, RIGHT)])
        self.assertEqual(self.only(FINE, peer.path, "raw", READ.hex(), *PATIENT)["values"], [0x1234])
        self.only(FINE, peer.path, "raw", "01 03 00 00 00 01", "--crc", *PATIENT)
        self.assertEqual(peer.requests, [READ, READ])
        self.assertIn("only be sent to a program", self.master(UNUSABLE, peer.path, "raw", "01p").stderr)


class ModbusTcp(Case):
    @staticmethod
    def message(request, pdu, transaction=None, protocol=0, length=None):
        number = struct.unpack(">H", request[:2])[0] if transaction is None else transaction
        return struct.pack(">HHHB", number, protocol, len(pdu) + 1 if length is None else length, request[6]) + pdu

    def test_answers_to_other_transactions_are_ignored(self):
        good = b"\x03\x02\x12\x34"
        peer = self.tcp("modbus-tcp", lambda r: [(0, self.message(r, b"\x03\x02\x66\x66", 999)), (0, self.message(r, good))])
        exchange = self.only(FINE, peer.path, "read", "40001", *PATIENT)
        self.assertEqual(exchange["values"], [0x1234])
        self.assertEqual(exchange["remark"], "ignored 1 answer to other transactions than 1")
        peer = self.tcp("modbus-tcp", lambda r: [(0, self.message(r, good, 999))])
        exchange = self.only(FAILED, peer.path, "read", "40001", *QUICK)
        self.assertEqual((exchange["verdict"], exchange["remark"]), ("silent", "ignored 1 answer to other transactions than 1"))

    def test_the_latency_is_that_of_the_right_answer(self):
        good = b"\x03\x02\x12\x34"
        peer = self.tcp("modbus-tcp", lambda r: [(0, self.message(r, b"\x03\x02\x66\x66", 999) + self.message(r, good))])
        exchange = self.only(FINE, peer.path, "wait", "10ms", "read", "40001", *PATIENT)
        self.assertEqual(exchange["values"], [0x1234])
        self.assertGreaterEqual(exchange["latency_us"], 0)

    def test_answers_to_other_transactions_without_end_do_not_hold_it(self):
        endless = b"".join(self.message(b"\0\1\0\0\0\6\1", b"\x03\x02\0\0", 999) for _ in range(500))
        peer = self.tcp("modbus-tcp", lambda r: ((0, endless) for _ in range(20_000)))
        exchange = self.only(FAILED, peer.path, "read", "40001", *QUICK)
        self.assertEqual(exchange["verdict"], "silent")

    def test_a_message_may_come_in_pieces(self):
        def bytewise(request):
            return [(0.01, bytes([byte])) for byte in self.message(request, b"\x03\x02\x12\x34")]
        self.assertEqual(self.only(FINE, self.tcp("modbus-tcp", bytewise).path, "read", "40001", *PATIENT)["values"], [0x1234])

    def test_what_is_no_modbus_tcp_is_said(self):
        for wrong, remark in ((lambda r: self.message(r, b"\x03", protocol=5), "no Modbus TCP: 00 01 00 05 00 02 01 03"),
                              (lambda r: self.message(r, b"\x03", length=0), "no Modbus TCP: 00 01 00 00 00 00 01 03"),
                              (lambda r: self.message(r, b"\x03", length=60000), "no Modbus TCP: 00 01 00 00 ea 60 01 03"),
                              (lambda r: self.message(r, b"\x03", length=9), "only a part of an answer came: 00 01 00 00 00 09 01 03")):
            with self.subTest(remark):
                right = lambda r: [(0, self.message(r, b"\x03\x02\x12\x34"))]
                peer = self.tcp("modbus-tcp", lambda r: [(0, wrong(r))], right)
                first, second = self.json(FAILED, peer.path, "read", "40001", "40001", *QUICK)["exchanges"]
                self.assertEqual((first["verdict"], first["remark"]), ("silent", remark))
                self.assertEqual((second["verdict"], peer.connections), ("right", 2))

    def test_another_unit_is_a_wrong_answer(self):
        def other(request):
            return [(0, self.message(request[:6] + b"\x09", b"\x03\x02\x12\x34"))]
        exchange = self.only(FAILED, self.tcp("modbus-tcp", other).path, "read", "40001", *PATIENT)
        self.assertEqual(exchange["fault"], "answer of station 9, not 1")

    def test_unit_255_is_the_server_itself(self):
        peer = self.peer(TcpPeer, modbus_tcp(Model()), "modbus-tcp")
        self.assertEqual(self.only(FINE, peer.path, "slave-id", "--station", "255", *PATIENT)["station"], 255)
        self.assertIn("not from 0 to 247", self.master(UNUSABLE, "/dev/ttyX", "slave-id", "--station", "255").stderr)

    def test_a_frame_without_crc_is_refused(self):
        peer = self.peer(TcpPeer, modbus_tcp(Model()), "modbus-tcp")
        self.assertIn("carries no CRC", self.master(UNUSABLE, peer.path, "raw", "0103000000010000").stderr)
        self.assertEqual(peer.requests, [])


class Unreachable(Case):
    def unreachable(self, *arguments):
        return self.master(UNUSABLE, *arguments, *QUICK).stderr

    def test_what_is_not_there(self):
        with socket.create_server(("127.0.0.1", 0)) as closed:
            port = closed.getsockname()[1]
        for scheme in ("tcp", "modbus-tcp"):
            self.assertIn(f"cannot reach 127.0.0.1:{port}: Connection refused",
                          self.unreachable(f"{scheme}://127.0.0.1:{port}", "slave-id"))
        self.assertIn("cannot reach 127.0.0.1:frob", self.unreachable("tcp://127.0.0.1:frob", "slave-id"))
        self.assertIn("cannot open /dev/ttyNOT_HERE: No such file", self.unreachable("/dev/ttyNOT_HERE", "slave-id"))
        self.assertIn("it is not a serial device", self.unreachable("/dev/null", "slave-id"))
        self.assertIn("cannot read not_here.stl", self.unreachable("not_here.stl", "slave-id"))

    def test_a_device_that_vanishes(self):
        peer = self.pty([(0, framed(b"\x01\x03\x02\x12\x34"))], [(0, None)])
        result = self.json(UNUSABLE, peer.path, "read", "40001", "--every", "50ms", "--timeout", "20s")
        self.assertIn(f"{peer.path} is gone", result["error"])
        self.assertEqual([e["verdict"] for e in result["exchanges"]], ["right"])
        self.assertEqual(result["statistics"]["requests"], 1)

    def test_a_server_that_closes(self):
        for scheme in ("tcp", "modbus-tcp"):
            peer = self.tcp(scheme, lambda _: [(0, None)])
            self.assertIn("has closed the connection", self.unreachable(peer.path, "read", "40001"))

    def test_a_server_that_closes_within_an_answer(self):
        peer = self.tcp("tcp", lambda _: [(0, RIGHT[:4]), (0, None)])
        exchange = self.only(FAILED, peer.path, "read", "40001", *PATIENT)
        self.assertEqual(exchange["fault"], "wrong CRC")
        self.assertIn("has closed the connection", exchange["remark"])

    def test_retries_connect_again(self):
        model = rtu(Model())
        peer = self.tcp("tcp", lambda _: [(0, None)], model)
        self.assertEqual(self.only(FINE, peer.path, "slave-id", "--retries", "1", "--timeout", "2s")["attempts"], 2)
        self.assertEqual(peer.connections, 2)

    def test_a_connection_closed_while_idle_is_made_again(self):
        model = rtu(Model())
        peer = self.tcp("tcp", lambda request: model(request) + [(0, None)])
        result = self.json(FINE, peer.path, "slave-id", "wait", "500ms", "slave-id", *PATIENT)
        self.assertEqual((result["statistics"]["right"], peer.connections), (2, 2))


class FreeportPc(Case):
    ACTIONS = ["--protocol", "freeport-pc", "write", "VB1000=1,16#23,-1", "VB1003=2#1", "read", "VB1000:4", "VB1002"]

    def check(self, peer):
        result = self.json(FINE, peer.path, *self.ACTIONS, *PATIENT)
        self.assertEqual([e["verdict"] for e in result["exchanges"]], ["right"] * 4)
        first, _, read, one = result["exchanges"]
        self.assertEqual([first[k] for k in ("station", "function", "area", "first", "notation", "count", "values", "bytes")],
                         [2, 6, "V", 1000, "VB1000", 3, None, None])
        self.assertEqual((read["function"], read["values"], read["decoded"], read["bytes"]),
                         (5, [1, 0x23, 0xFF, 1], [1, 0x23, 0xFF, 1], "0123ff0100000000"))
        self.assertEqual(one["values"], [0xFF])
        self.assertTrue(all(len(request) == 33 for request in peer.requests))

    def test_over_a_pty(self):
        self.check(self.peer(PtyPeer, PcModel(), is_pc_command))

    def test_over_tcp(self):
        self.check(self.peer(TcpPeer, PcModel(), "tcp", is_pc_command))

    def test_lines_show_each_byte_with_its_address(self):
        out = self.master(FINE, self.peer(PtyPeer, PcModel(), is_pc_command).path, *self.ACTIONS, *PATIENT).stdout.split("\n")
        self.assertRegex(out[0], r"^write VB1000=1,16#23,-1   station 2, VB1000…1002   after ")
        self.assertEqual(out[1], "  VB1000…1002 written")
        self.assertRegex(out[4], r"^read VB1000:4   station 2, VB1000…1003   after ")
        self.assertEqual(out[5:9], ["  VB1000  16#01      1", "  VB1001  16#23     35", "  VB1002  16#FF    255", "  VB1003  16#01      1"])

    def test_the_end_character_is_as_agreed(self):
        peer = self.peer(PtyPeer, PcModel(end=26), is_pc_command)
        self.assertEqual(self.only(FAILED, peer.path, "--protocol", "freeport-pc", "read", "VB0", *PATIENT)["fault"],
                         "end character 16#1A, expected 16#26; --end-character 16#1A would take it")
        self.only(FINE, peer.path, "--protocol", "freeport-pc", "read", "VB0", "--end-character", "26", *PATIENT)

    def test_what_the_station_refuses_is_an_error(self):
        peer = self.peer(PtyPeer, lambda command: PcModel().answer(4), is_pc_command)
        refused = self.only(FAILED, peer.path, "--protocol", "freeport-pc", "read", "IB9000", "--station", "7", *PATIENT)
        self.assertEqual((refused["verdict"], refused["exception"]), ("exception", {"code": 4, "name": "command not legal"}))
        self.assertEqual(peer.requests[0][2:4], b"07")
        out = self.master(FAILED, peer.path, "--protocol", "freeport-pc", "raw", "67 47", *PATIENT).stdout
        self.assertRegex(out, r"^raw 67 47   after .*\n  error 16#04: command not legal\n$")

    def test_a_device_is_set_to_no_parity(self):
        peer, seen = self.peer(PtyPeer, PcModel(), is_pc_command), []
        peer.answer = lambda command: seen.append(termios.tcgetattr(peer.secondary)) or PcModel()(command)
        self.master(FINE, peer.path, "--protocol", "freeport-pc", "read", "VB0", *PATIENT)
        self.assertFalse(seen[0][2] & termios.PARENB)
        self.assertEqual(seen[0][5], termios.B9600)

    def test_what_makes_no_sense_for_a_protocol_is_refused(self):
        for arguments, why in ((["modbus-tcp://127.0.0.1", "--protocol", "freeport-pc", "read", "VB0"],
                                "modbus-tcp:// carries nothing but Modbus; --protocol freeport-pc needs a PROGRAM"),
                               (["/dev/ttyX", "--protocol", "freeport-pc", "read", "VB0", "--always-15"],
                                "--always-15 needs --protocol modbus"),
                               (["/dev/ttyX", "read", "40001", "--end-character", "26"],
                                "--end-character needs --protocol freeport-pc"),
                               (["/dev/ttyX", "--protocol", "frob", "read", "VB0"],
                                "'frob' is not a protocol; there are modbus, freeport-pc"),
                               (["/dev/ttyX", "--protocol", "freeport-pc", "read", "40001"], "'40001' is not a byte of I, Q, M or V"),
                               (["/dev/ttyX", "--protocol", "freeport-pc", "read", "VB0", "--end-character", "256"],
                                "the end character 256 is not from 0 to 255")):
            with self.subTest(arguments):
                self.assertIn(why, self.master(UNUSABLE, *arguments).stderr)


class Targets(Case):
    def test_ports_are_1_to_65535(self):
        for target in ("tcp://localhost:65536", "tcp://localhost:0", "modbus-tcp://localhost:99999", "tcp://[::1]:123456789012"):
            self.assertIn("ports are 1 to 65535", self.master(UNUSABLE, target, "slave-id").stderr)


class Port(Case):
    def test_settings_reach_the_device_and_are_put_back(self):
        peer = self.pty([(0, RIGHT)])

        def settings():
            tcgets2, size = 0x802C542A, 44  # asm-generic/ioctls.h of Linux: any rate, in the last word
            return termios.tcgetattr(peer.secondary), struct.unpack("I", fcntl.ioctl(peer.secondary, tcgets2, bytes(size))[-4:])[0]
        before, seen = settings(), []
        peer.answer = lambda _: seen.append(settings()) or [(0, RIGHT)]
        self.master(FINE, peer.path, "read", "40001", "--baud", "19200", "--stop-bits", "2", "--parity", "none", *PATIENT)
        self.assertTrue(seen[0][0][2] & termios.CSTOPB)
        self.assertEqual(seen[0][1], 19200)
        self.assertEqual(settings(), before)

    def test_options_that_do_not_fit_the_target_are_refused(self):
        for target, option, value, need in (("/dev/ttyX", "--set", "VW0=1", "a PROGRAM"), ("/dev/ttyX", "--cpu", "212", "a PROGRAM"),
                                            ("tcp://h:1", "--dump", "VW0", "a PROGRAM"), ("tcp://h:1", "--baud", "9600", "a serial line"),
                                            ("modbus-tcp://h", "--parity", "even", "a serial line"),
                                            ("modbus-tcp://h", "--gap", "1ms", "Modbus RTU"),
                                            ("modbus-tcp://h", "--silence", "1ms", "Modbus RTU")):
            with self.subTest(target=target, option=option):
                self.assertIn(f"{option} needs {need}", self.master(UNUSABLE, target, "slave-id", option, value).stderr)


def catches(process, number):
    (mask,) = re.findall(r"(?m)^SigCgt:\s*(\w+)$", pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8"))
    return int(mask, 16) >> (number - 1) & 1


class Interrupted(Case):
    def test_ctrl_c_ends_a_continuous_loopback_with_its_statistics(self):
        peer = self.peer(PtyPeer, rtu(Model()))
        process = self.begin(peer.path, "loopback", "--continuous", *PATIENT)
        until(lambda: len(peer.requests) > 5, "a loopback")
        process.send_signal(signal.SIGINT)
        out, error = process.communicate(timeout=60)
        self.assertEqual((process.returncode, error), (FINE, ""))
        self.assertRegex(out, r"(?m)^\d+ requests: (\d+) right, 0 exception, 0 silent, 0 wrong, 0 repeated$")
        self.assertRegex(out, r"(?m)^latency: least .*, mean .*, p99 .*, most ")

    def test_ctrl_c_ends_waiting_for_a_program_from_a_pipe(self):
        with tempfile.TemporaryDirectory() as folder:
            pipe = pathlib.Path(folder) / "program.stl"
            os.mkfifo(pipe)
            process = self.begin(pipe, "read", "40001")
            until(lambda: catches(process, signal.SIGINT), "a handler of Ctrl-C")
            process.send_signal(signal.SIGINT)
            _, error = process.communicate(timeout=60)
            self.assertEqual((process.returncode, error), (FAILED, "s7200: note: interrupted\n"))

    def test_ctrl_c_ends_every_wait(self):
        silent = self.pty([])
        for arguments in (["slave-id", "--timeout", "1h"], ["wait", "1h", "slave-id"], ["write", "40001=1", "wait", "1h"]):
            with self.subTest(arguments):
                process = self.begin(silent.path, *arguments, "--station", "0") if "write" in arguments else \
                    self.begin(silent.path, *arguments)
                until(lambda: catches(process, signal.SIGINT), "a handler of Ctrl-C")
                process.send_signal(signal.SIGINT)
                _, error = process.communicate(timeout=60)
                self.assertEqual(process.returncode, FAILED)
                self.assertIn("interrupted", error)

    def test_json_is_complete_after_ctrl_c(self):
        peer = self.peer(PtyPeer, rtu(Model()))
        process = self.begin(peer.path, "read", "40001:2", "--every", "20ms", "--json", *PATIENT)
        until(lambda: len(peer.requests) > 3, "polling")
        process.send_signal(signal.SIGTERM)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, FINE)
        result = json.loads(out)
        self.assertEqual(len(result["exchanges"]), result["statistics"]["requests"])


class Polling(Case):
    def counting(self):
        model = Model()

        def answer(frame):
            model.registers[1] += 1
            return rtu(model)(frame)
        return self.peer(PtyPeer, answer)

    def test_plain_lines_mark_what_has_changed(self):
        out = self.master(FINE, self.counting().path, "read", "40001", "40002", "--every", "30ms", "--count", "2", *PATIENT).stdout
        lines = out.split("\n")
        self.assertRegex(lines[0], r"^ +\d+\.\d{6} s  .*    read 40001: 16#0000$")
        self.assertRegex(lines[1], r"    read 40002: 16#0002$")
        self.assertRegex(lines[2], r"    read 40001: 16#0000$")
        self.assertRegex(lines[3], r"  \* read 40002: 16#0004$")
        self.assertRegex(lines[4], r"^4 requests: 4 right")
        self.assertNotIn("\x1b", out)

    def test_requests_keep_their_interval(self):
        exchanges = self.json(FINE, self.counting().path, "read", "40001", "--every", "200ms", "--count", "3", *PATIENT)["exchanges"]
        times = [e["at_us"] for e in exchanges]
        self.assertGreaterEqual(times[1] - times[0], 150e3)
        self.assertGreaterEqual(times[2] - times[0], 390e3)

    def test_a_terminal_gets_a_table_in_place(self):
        for environment, bold in (({"NO_COLOR": ""}, True), ({"NO_COLOR": "1"}, False)):
            primary, secondary = os.openpty()
            fcntl.ioctl(secondary, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 100, 0, 0))
            process = subprocess.Popen([S7200, "master", self.counting().path, "read", "40001:2", "--every", "100ms", "--count",
                                        "3", *PATIENT], stdin=subprocess.DEVNULL, stdout=secondary,
                                       env={**os.environ, "TERM": "xterm", **environment})
            os.close(secondary)
            written = b""
            while True:
                try:
                    piece = os.read(primary, 4096)
                except OSError:
                    break
                if not piece:
                    break
                written += piece
            os.close(primary)
            self.assertEqual(process.wait(timeout=60), FINE)
            text = written.decode()
            self.assertIn("\x1b[6A", text)  # back to the title: heading, two values, two lines of statistics
            last = text[text.rindex("\x1b[J"):]
            self.assertIn("  40001       0  16#0000      0", last)
            self.assertIn("* \x1b[1m  40002       1  16#0003      3\x1b[0m" if bold else "*   40002       1  16#0003      3", last)
            self.assertIn("3 requests: 3 right", last)
            self.assertEqual("\x1b[1m" in text, bold)

    def test_failures_are_shown_and_counted(self):
        out = self.master(FAILED, self.pty([(0, RIGHT)], [(0, framed(b"\x01\x83\x04"))], [(0, RIGHT)]).path, "read", "40001",
                          "--every", "20ms", "--count", "3", *PATIENT).stdout
        self.assertIn("* read 40001: exception 4: server device failure", out)
        self.assertIn("3 requests: 2 right, 1 exception, 0 silent, 0 wrong", out)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
