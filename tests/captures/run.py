#!/usr/bin/env python3
"""Captures, as the decoders of others read them: run.py S7200 SOURCE_DIR sigrok|tshark|gtkwave

Exit code 77: skipped, the decoder is not installed."""
import collections
import json
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from modbus_crc import crc, framed  # noqa: E402

S7200, SOURCE, GROUP = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
SLAVE = SOURCE / "stl_programs/modbus_slave.stl"
TIP = SOURCE.parent / "shared/seeds/tip41_modbus_rtu_slave.txt"
DECODER = {"sigrok": "sigrok-cli", "tshark": "tshark", "gtkwave": "vcd2fst"}[GROUP]
SKIPPED = 77

# Sends back each character with its error bits forgotten.
ECHO = ("LD SM0.1\nMOVB {port}, SMB30\nMOVB 1, VB0\nATCH 0, 8\nENI\nMEND\n"
        "INT 0\nLD SM0.0\nMOVB SMB2, VB1\nXMT VB0, 0\nRETI\n")
Format = collections.namedtuple("Format", "port line")
FORMATS = [
    Format("16#49", {"baud": 9600, "data_bits": 8, "parity": "even"}),
    Format("16#09", {"baud": 9600, "data_bits": 8, "parity": "none"}),
    Format("16#C5", {"baud": 19200, "data_bits": 8, "parity": "odd"}),
    Format("16#6D", {"baud": 4800, "data_bits": 7, "parity": "even"}),
    Format("16#4D", {"baud": 4800, "data_bits": 8, "parity": "even"}),
    Format("16#41", {"baud": 38400, "data_bits": 8, "parity": "even"}),
]

# What a master says in an hour of plant life: answers of every kind, none, and damaged requests.
TALK = ["0103000a0002", "0106000a1234", "0103000a0001", "010f0000000a02ff03", "01010000000a", "010200000008",
        "010400000010", "0105000bff00", "01100000000306000100020003", "01030000007d", "01030000007e", "0103ffff0001",
        "0107", "0203000a0001", "0006000a4321"]
DAMAGED = ["0103000a0001a409", "0103p000a0001a408", "01"]


def with_crc(frame):
    return framed(bytes.fromhex(frame)).hex()


def run(*command, **options):
    return subprocess.run([str(c) for c in command], stdin=subprocess.DEVNULL, capture_output=True, timeout=120,
                          check=False, **options)


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.vcd, self.pcap = self.folder / "line.vcd", self.folder / "line.pcap"

    def send(self, program, *arguments):
        """The exchanges; what ran over the line is in self.vcd and self.pcap."""
        done = run(S7200, "send", program, "--json", "--capture", self.vcd, "--capture", self.pcap, *arguments)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return json.loads(done.stdout)["exchanges"]

    def echo(self, format_):
        path = self.folder / "echo.stl"
        path.write_text(ECHO.format(port=format_.port), encoding="utf-8")
        return path

    def silent(self):
        path = self.folder / "silent.stl"
        path.write_text("LD SM0.0\nMEND\n", encoding="utf-8")
        self.assertEqual(run(S7200, "run", path, "--for", "100ms", "--capture", self.vcd, "--capture", self.pcap).returncode, 0)

    def slaves(self):
        for slave in (SLAVE, TIP):
            if not slave.exists():
                print(f"without {slave.name}, which is not there")
                continue
            with self.subTest(slave.name):
                yield slave

    @staticmethod
    def said(exchanges, what):
        return "".join(e[what] or "" for e in exchanges)


class Sigrok(Case):
    def decode(self, *output, baud=9600, data_bits=8, parity="even"):
        done = run("sigrok-cli", "-I", "vcd:downsample=1000", "-i", self.vcd, *output, "-P",
                   f"uart:rx=rx:tx=tx:baudrate={baud}:data_bits={data_bits}:parity={parity},modbus:cschannel=RX:scchannel=TX")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def characters(self, wire, **format_):
        return self.decode("-B", f"uart={wire}", **format_).hex()

    def annotations(self, kind, **format_):
        return self.decode("-A", kind, **format_).decode().splitlines()

    def test_every_byte_of_a_conversation(self):
        for slave in self.slaves():
            exchanges = self.send(slave, "--timeout", "100ms", *map(with_crc, TALK), *DAMAGED)
            self.assertGreater(len(self.said(exchanges, "response")), 600)
            self.assertEqual(self.characters("rx"), self.said(exchanges, "request"))
            self.assertEqual(self.characters("tx"), self.said(exchanges, "response"))

    def test_every_byte_in_every_format(self):
        for format_ in FORMATS:
            with self.subTest(format_):
                sent = bytes(range(1 << format_.line["data_bits"]))
                frames = self.folder / "frames.txt"
                frames.write_text("\n".join(f"{byte:02x}" for byte in sent), encoding="utf-8")
                exchanges = self.send(self.echo(format_), "--frames", frames)
                self.assertEqual(self.said(exchanges, "response"), sent.hex())
                for wire in ("rx", "tx"):
                    self.assertEqual(self.characters(wire, **format_.line), sent.hex())
                self.assertFalse(self.annotations("uart=rx-warnings:tx-warnings:rx-parity-err:tx-parity-err",
                                                  **format_.line))

    def test_a_master_at_the_wrong_rate(self):
        requests = list(map(with_crc, TALK[:3]))
        for baud in (300, 4800, 19200, 9900):
            with self.subTest(baud):
                self.send(SLAVE, "--baud", baud, "--timeout", "50ms", *requests)
                self.assertEqual(self.characters("rx", baud=baud), "".join(requests))
        self.send(SLAVE, "--baud", "19200", "--timeout", "50ms", *requests)
        self.assertTrue(self.annotations("uart=rx-warnings"), "at 9600 baud this is not a clean signal")

    def test_wrong_parity_shows(self):
        self.send(SLAVE, "--timeout", "100ms", "0103p000a0001a408")
        self.assertEqual(len(self.annotations("uart=rx-parity-err")), 1)
        self.assertEqual(self.characters("rx"), "0103000a0001a408")

    def test_modbus(self):
        self.send(SLAVE, *map(with_crc, ["0106000a1234", "0103000a0001"]))
        lines = [line.split(": ", 1)[1] for line in self.annotations("modbus")]
        self.assertEqual(lines.count("CRC correct"), 4)
        self.assertEqual(lines.count("Slave ID: 1"), 4)
        self.assertEqual(lines.count("Function 3: Read Holding Registers"), 2)
        self.assertEqual(lines.count("Function 6: Write Single Register"), 2)
        self.assertIn("0x1234 / 4660", lines)

    def test_a_fault_that_strikes_an_answer_is_on_the_line(self):
        exchange, = self.send(SLAVE, "--fault", "flip:character=3,bit=5,of=answer", with_crc("0103000a0001"))
        done = run("sigrok-cli", "-I", "vcd:downsample=1000", "-i", self.vcd, "-P", "uart:rx=line:baudrate=9600:parity=even", "-B", "uart=rx")
        self.assertEqual(done.stdout.hex(), exchange["request"] + exchange["response"])

    def test_a_quiet_line(self):
        self.silent()
        self.assertEqual(self.decode("-A", "uart"), b"")

    def frames(self, recording, *arguments):
        done = run(S7200, "decode", recording, "--json", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return [frame["bytes"] for frame in json.loads(done.stdout)["frames"]]

    def test_bits_of_a_trace_of_signals_are_read_as_they_were(self):
        program = self.folder / "blinks.stl"
        program.write_text("LD SM0.0\nINCW VW10\nLDW>= VW10, 3\n= Q0.0\nLDW>= VW10, 5\nR Q0.0, 1\nMEND\n", encoding="utf-8")
        done = run(S7200, "run", program, "--scans", "8", "--trace", self.vcd, "--signals", "Q0.0,INT")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = run("sigrok-cli", "-I", "vcd:downsample=1000", "-i", self.vcd, "-O", "csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        levels = [line.split(b",")[0] for line in done.stdout.splitlines() if line[:1] in b"01"]
        changes = [level for i, level in enumerate(levels) if i == 0 or level != levels[i - 1]]
        self.assertEqual(changes[:3], [b"0", b"1", b"0"])

    def test_levels_at_a_port_in_a_trace_of_signals_are_what_was_sent(self):
        trace = self.folder / "trace.vcd"
        exchanges = self.send(SLAVE, "--trace", trace, "--signals", "Q0.0,INT,PORT0", with_crc("0103000a0002"), with_crc("0106000a1234"))
        done = run("sigrok-cli", "-I", "vcd:downsample=1000", "-i", trace, "-B", "uart=tx", "-P",
                   "uart:rx=PORT0.RXD:tx=PORT0.TXD:baudrate=9600:parity=even")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.hex(), self.said(exchanges, "response"))

    def test_levels_in_the_files_of_sigrok_are_read_as_what_was_sent(self):
        """Our receiver at the end of: our sender, our VCD, sigrok's file."""
        exchanges = self.send(SLAVE, "--timeout", "100ms", *map(with_crc, TALK[:8]))
        sent = [e[what] for e in exchanges for what in ("request", "response") if e[what]]
        self.assertEqual(self.frames(self.vcd), sent)
        for kind, name in (("srzip", "line.sr"), ("vcd", "again.vcd"), ("csv", "line.csv")):
            with self.subTest(kind):
                path = self.folder / name
                done = run("sigrok-cli", "-I", "vcd:downsample=1000", "-i", self.vcd, "-O", kind, "-o", path)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(self.frames(path), sent)

    def test_annotations_of_sigrok_are_read_as_what_was_sent(self):
        exchanges = self.send(SLAVE, "--timeout", "100ms", *map(with_crc, TALK[:8]))
        sent = [e[what] for e in exchanges for what in ("request", "response") if e[what]]
        path = self.folder / "annotations.txt"
        for kinds, options in (("uart=rx-data:tx-data", ["--protocol-decoder-samplenum"]), ("uart", ["--protocol-decoder-samplenum"]),
                               ("uart=rx-data:tx-data", [])):
            for form in ("hex", "ascii", "bin", "oct", "dec"):
                if (kinds, form) in (("uart", "ascii"), ("uart", "dec")):
                    continue  # a bit looks like a character there
                with self.subTest(f"{kinds} {form}"):
                    done = run("sigrok-cli", "-I", "vcd:downsample=1000", "-i", self.vcd, "-P",
                               f"uart:rx=rx:tx=tx:baudrate=9600:parity=even:format={form}", "-A", kinds, *options)
                    path.write_bytes(done.stdout)
                    self.assertEqual(self.frames(path), sent)


class Gtkwave(Case):
    """vcd2fst reads a Value Change Dump as the viewer does; fst2vcd says what it has understood."""

    def understood(self, vcd):
        """What changes() says of the dump that comes back."""
        fst = self.folder / "again.fst"
        done = run("vcd2fst", vcd, fst)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return self.changes(run("fst2vcd", fst).stdout.decode())

    @staticmethod
    def changes(text):
        """[(time in ns, name of a signal, value)] in an order of their own, and the width of each signal."""
        head, _, body = text.partition("$enddefinitions $end")
        declared = {code: (name, int(width)) for width, code, name in re.findall(r"\$var \w+\s+(\d+) (\S+) (\S+)", head)}
        changes, at = [], 0
        for line in body.splitlines():
            if line.startswith("#"):
                at = int(line[1:])
            elif match := re.fullmatch(r"([br]?)(\S*?) ?(\S+)", line) if line[:1] in "01xzbr" else None:
                kind, value, code = match.groups() if line[0] in "br" else ("", line[0], line[1:])
                name, width = declared[code]
                changes.append((at, name, float(value) if kind == "r" else value.rjust(width, "0")))
        return sorted(changes), dict(declared.values())

    def test_signals_of_every_width_are_understood_as_they_were_written(self):
        program = self.folder / "counts.stl"
        program.write_text("NETWORK\nLD SM0.0\nINCB VB4\nINCW VW10\nDECD VD20\n+R 0.5, VD30\nLDW>= VW10, 3\n= Q0.0\nMEND\n", encoding="utf-8")
        done = run(S7200, "run", program, "--scans", "6", "--trace", self.vcd, "--signals", "Q0.0,VB4,VW10,VD20,VD30:real,INT")
        self.assertEqual(done.returncode, 0, done.stderr)
        (changes, widths), (written, _) = self.understood(self.vcd), self.changes(self.vcd.read_text(encoding="utf-8"))
        self.assertEqual(widths, {"Q0.0": 1, "VB4": 8, "VW10": 16, "VD20": 32, "VD30:real": 64})
        self.assertEqual(changes, written)
        self.assertEqual([value for _, name, value in changes if name == "VW10"], [f"{count:016b}" for count in range(7)])
        self.assertEqual([value for _, name, value in changes if name == "VD20"][1], "1" * 32)

    def test_levels_at_a_port_are_those_of_the_line(self):
        trace = self.folder / "trace.vcd"
        self.send(SLAVE, "--trace", trace, "--signals", "INT,PORT0", with_crc("0103000a0002"))
        understood, (line, _) = self.understood(trace), self.changes(self.vcd.read_text(encoding="utf-8"))
        self.assertEqual(understood, self.changes(trace.read_text(encoding="utf-8")))
        changes, _ = understood
        names = {"PORT0.RXD": "rx", "PORT0.TXD": "tx", "PORT0.LINE": "line"}
        levels = [(at, names[name], value) for at, name, value in changes if name in names]
        self.assertEqual(sorted(levels), line)
        self.assertGreater(len(line), 100)
        self.assertGreater(sum(name == "INT123" for _, name, _ in changes), 8)

    def test_levels_of_a_line_are_understood_as_they_were_written(self):
        self.send(SLAVE, with_crc("0103000a0002"))
        self.assertEqual(self.understood(self.vcd), self.changes(self.vcd.read_text(encoding="utf-8")))
        self.assertGreater(len(self.changes(self.vcd.read_text(encoding="utf-8"))[0]), 100)


Packet = collections.namedtuple("Packet", "time_ns bytes")


class Tshark(Case):
    def packets(self):
        """The packets, read by hand from the file's definition."""
        data = self.pcap.read_bytes()
        self.assertEqual(struct.unpack_from("<IHHIIII", data), (0xA1B23C4D, 2, 4, 0, 0, 7200, 147))
        packets, at = [], 24
        while at < len(data):
            seconds, nanoseconds, kept, length = struct.unpack_from("<IIII", data, at)
            self.assertEqual(kept, length)
            packets.append(Packet(seconds * 10**9 + nanoseconds, data[at + 16:at + 16 + kept].hex()))
            at += 16 + kept
        self.assertEqual(at, len(data))
        self.assertEqual(packets, sorted(packets, key=lambda packet: packet.time_ns))
        return packets

    def fields(self, *names):
        """A row of fields for each packet, as tshark decodes it."""
        done = run("tshark", "-r", self.pcap, "-o", 'uat:user_dlts:"User 0 (DLT=147)","mbrtu","0","","0",""',
                   "-o", "mbrtu.crc_verification:TRUE", "-T", "fields", *[a for name in names for a in ("-e", name)])
        self.assertEqual(done.returncode, 0, done.stderr)
        return [tuple(line.split("\t")) for line in done.stdout.decode().splitlines()]

    def test_every_frame_of_a_conversation(self):
        for slave in self.slaves():
            exchanges = self.send(slave, "--timeout", "100ms", *map(with_crc, TALK), *DAMAGED)
            frames = [e[what] for e in exchanges for what in ("request", "response") if e[what]]
            packets = self.packets()
            self.assertEqual([p.bytes for p in packets], frames)
            lengths = self.fields("frame.len")
            self.assertEqual([int(length) for length, in lengths], [len(frame) // 2 for frame in frames])

    def test_latencies_are_those_of_send(self):
        character_ns = 11 * 10**9 / 9600
        exchanges = self.send(SLAVE, *map(with_crc, TALK[:12]))
        packets = self.packets()
        for number, exchange in enumerate(exchanges):
            request, answer = packets[2 * number:2 * number + 2]
            silence = answer.time_ns - request.time_ns - len(exchange["request"]) / 2 * character_ns
            self.assertAlmostEqual(silence / 1000, exchange["latency_us"], delta=0.01)

    def test_modbus(self):
        self.send(SLAVE, *map(with_crc, ["0106000a1234", "0103000a0002", "01030000007e"]))
        rows = self.fields("mbrtu.unit_id", "modbus.func_code", "modbus.regval_uint16", "modbus.exception_code",
                           "mbrtu.crc16.status")
        good = "1"
        self.assertEqual(rows, [("1", "6", "", "", good), ("1", "6", "", "", good), ("1", "3", "", "", good),
                                ("1", "3", "4660,0", "", good), ("1", "3", "", "", good), ("1", "3", "", "3", good)])

    def test_a_wrong_crc_shows(self):
        self.send(SLAVE, "--timeout", "100ms", DAMAGED[0])
        self.assertEqual(self.fields("mbrtu.crc16.status"), [("0",)])

    def test_a_master_at_the_wrong_rate_is_captured_as_the_port_hears_it(self):
        trace = self.folder / "trace.txt"
        for baud in (4800, 19200, 10300):
            with self.subTest(baud):
                self.send(SLAVE, "--baud", baud, "--timeout", "50ms", "--trace", trace, *map(with_crc, TALK[:4]))
                heard = re.findall(r"received ([0-9a-f]{2})", trace.read_text(encoding="utf-8"))
                self.assertGreater(len(heard), 4)
                self.assertEqual("".join(p.bytes for p in self.packets()), "".join(heard))

    def test_a_pause_inside_a_request(self):
        request = with_crc(TALK[0])
        self.send(SLAVE, "--gap", "3ms", "--timeout", "100ms", request)
        self.assertEqual(self.packets()[0].bytes, request)
        self.send(SLAVE, "--gap", "10ms", "--timeout", "100ms", request)
        self.assertEqual([p.bytes for p in self.packets()], re.findall("..", request))

    def test_a_thousand_random_frames(self):
        draw = random.Random(7200)
        frames = self.folder / "frames.txt"
        frames.write_text("\n".join(with_crc(draw.choice(TALK)) if draw.random() < 0.5 else draw.randbytes(draw.randint(1, 60)).hex()
                                    for _ in range(1000)), encoding="utf-8")
        exchanges = self.send(SLAVE, "--timeout", "200ms", "--frames", frames)
        said = [e[what] for e in exchanges for what in ("request", "response") if e[what]]
        self.assertEqual([p.bytes for p in self.packets()], said)
        rows = self.fields("frame.len", "mbrtu.crc16.status")
        self.assertEqual(len(rows), len(said))
        for frame, (_, status) in zip(said, rows):
            if frame.startswith("00"):
                self.assertEqual(status, "", "tshark 4.0 does not look into broadcasts")
            elif len(frame) < 10:
                self.assertEqual(status, "", "nor into what is shorter than an exception")
            elif bytes.fromhex(frame)[-2:] == crc(bytes.fromhex(frame)[:-2]):
                self.assertEqual(status, "1", frame)
            else:
                self.assertNotIn("1", status, frame)

    def test_link_types_as_wireshark_reads_them(self):
        """The head of an RTAC, and pcapng with each link type, written by Wireshark's tools."""
        request, answer = with_crc("0103000a0002"), with_crc("01030412345678")
        rtac = [bytes(8) + bytes([event, 0, 0, 0]) + bytes.fromhex(frame) for event, frame in ((1, request), (2, answer))]
        plain = [bytes.fromhex(frame) for frame in (request, answer)]
        for link_type, packets in ((147, plain), (153, plain), (250, rtac)):
            with self.subTest(link_type):
                dump = self.folder / "dump.txt"
                dump.write_text("".join(f"0000 {packet.hex(' ')}\n" for packet in packets), encoding="utf-8")
                written = self.folder / "written.pcapng"
                self.assertEqual(run("text2pcap", "-l", link_type, dump, written).returncode, 0)
                decoded = run(S7200, "decode", written, "--json")
                self.assertEqual(decoded.returncode, 0, decoded.stderr)
                self.assertEqual([frame["bytes"] for frame in json.loads(decoded.stdout)["frames"]], [request, answer])
                if link_type == 250:
                    done = run("tshark", "-r", written, "-T", "fields", "-e", "rtacser.eventtype")
                    self.assertEqual([int(field, 16) for field in done.stdout.split()], [1, 2])

    def test_a_quiet_line(self):
        self.silent()
        self.assertEqual(self.packets(), [])
        self.assertEqual(self.fields("frame.len"), [])


if __name__ == "__main__":
    if not shutil.which(DECODER):
        print(f"skipped: {DECODER} is not installed")
        sys.exit(SKIPPED)
    group = {"sigrok": Sigrok, "tshark": Tshark, "gtkwave": Gtkwave}[GROUP]
    result = unittest.TextTestRunner(stream=sys.stdout).run(unittest.defaultTestLoader.loadTestsFromTestCase(group))
    sys.exit(0 if result.wasSuccessful() else 1)
