"""Slaves to be asked by `s7200 master`: on a pty, on a TCP port. What they answer is up to a function."""
import errno
import functools
import operator
import os
import pathlib
import socket
import struct
import sys
import threading
import time
import tty

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from modbus_crc import crc, framed  # noqa: E402


class Model:
    """A slave that does everything right. Called with station and PDU, returns the PDU of its answer."""

    def __init__(self):
        self.coils, self.registers = [0] * 65536, [0] * 65536
        self.files, self.memory = {}, {}

    def __call__(self, station, pdu):
        function, data = pdu[0], pdu[1:]
        answer = self.answer(function, data)
        return None if station == 0 else bytes([function]) + answer

    def answer(self, function, data):
        if function in (1, 2):
            first, count = struct.unpack(">HH", data)
            bits = self.coils[first:first + count] if function == 1 else [(first + i) % 3 == 0 for i in range(count)]
            packed = bytearray((count + 7) // 8)
            for place, bit in enumerate(bits):
                packed[place // 8] |= bool(bit) << place % 8
            return bytes([len(packed)]) + packed
        if function in (3, 4):
            first, count = struct.unpack(">HH", data)
            values = self.registers[first:first + count] if function == 3 else range(first + 1000, first + 1000 + count)
            return struct.pack(f">B{count}H", 2 * count, *values)
        if function == 5:
            self.coils[struct.unpack(">H", data[:2])[0]] = data[2] == 0xFF
            return data
        if function == 6:
            address, value = struct.unpack(">HH", data)
            self.registers[address] = value
            return data
        if function == 7:
            return b"\x6d"
        if function == 8:
            return data if data[:2] != b"\0\x0b" else b"\0\x0b\0\x2a"
        if function == 15:
            first, count = struct.unpack(">HH", data[:4])
            for place in range(count):
                self.coils[first + place] = data[5 + place // 8] >> place % 8 & 1
            return data[:4]
        if function == 16:
            first, count = struct.unpack(">HH", data[:4])
            self.registers[first:first + count] = struct.unpack(f">{count}H", data[5:])
            return data[:4]
        if function == 17:
            return b"\x04\x15\xff\x01\x02"
        if function == 20:
            answer, rest = b"", data[1:]
            while rest:
                kind, file, record, count = struct.unpack(">BHHH", rest[:7])
                size = count if kind == 0x33 else 2 * count
                answer += bytes([1 + size, kind]) + self.files.get((kind, file, record), b"\0" * size)
                rest = rest[7:]
            return bytes([len(answer)]) + answer
        if function == 21:
            kind, file, record, count = struct.unpack(">BHHH", data[1:8])
            self.files[kind, file, record] = data[8:]
            return data
        return b""


def rtu(model):
    """The answer of a model to an RTU frame: [(pause before it, bytes)]."""
    def answer(frame):
        pdu = model(frame[0], frame[1:-2])
        return [] if pdu is None else [(0, framed(frame[:1] + pdu))]
    return answer


def modbus_tcp(model):
    def answer(message):
        pdu = model(message[6], message[7:])
        return [(0, message[:4] + struct.pack(">HB", len(pdu) + 1, message[6]) + pdu)]
    return answer


class PcModel:
    """A station of the PC protocol, with 33-byte commands, whose V memory is `memory`. Called with a command, returns its answer."""

    def __init__(self, end=0x26):
        self.memory, self.end = bytearray(65536), end

    def __call__(self, command):
        kind, address, digits = command[1], int(command[8:12], 16), int(command[12:14], 16)
        if xor(command[1:30]) != int(command[30:32], 16):
            return self.answer(3)
        if kind == 5:
            return self.answer(1, self.memory[address:address + 8].hex().upper().encode())
        if kind != 6 or digits > 16:
            return self.answer(4)
        self.memory[address:address + digits // 2] = bytes.fromhex(command[14:14 + digits].decode())
        return self.answer(2)

    def answer(self, status, data=bytes(16)):
        code = b"%02X" % xor(data) if status == 1 else bytes(2)
        return [(0, b"g" + bytes([status]) + data + code + bytes([self.end]))]


def xor(characters):
    return functools.reduce(operator.xor, characters, 0)


def is_rtu_frame(pending):
    return len(pending) > 3 and crc(pending[:-2]) == pending[-2:]


def is_pc_command(pending):
    return len(pending) == 33 or pending.endswith(b"G")


class Peer:
    """Reads requests and writes what `answer(request)` says, in a thread of its own. `requests` are those that came.

    An answer may be an exception: the peer then goes away, after what was written."""

    def __init__(self, answer):
        self.answer, self.requests, self.closing = answer, [], False
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()

    def talk(self, read, write, complete):
        pending = b""
        while not self.closing:
            data = read()
            if not data:
                return
            pending += data
            if not complete(pending):
                continue
            request, pending = pending, b""
            self.requests.append(request)
            for pause, piece in self.answer(request):
                time.sleep(pause)
                if piece is None:
                    return
                write(piece)


class PtyPeer(Peer):
    def __init__(self, answer, complete=is_rtu_frame):
        self.complete = complete
        self.primary, self.secondary = os.openpty()
        tty.setraw(self.secondary)
        self.path = os.ttyname(self.secondary)
        super().__init__(answer)

    def serve(self):
        def read():
            while True:
                try:
                    return os.read(self.primary, 4096)
                except OSError as error:
                    if error.errno != errno.EIO:
                        return b""
                    time.sleep(0.01)  # no program has it open
        try:
            self.talk(read, lambda piece: os.write(self.primary, piece), self.complete)
        except OSError:
            pass
        self.vanish()

    def vanish(self):
        for name in ("primary", "secondary"):
            if getattr(self, name) is not None:
                os.close(getattr(self, name))
                setattr(self, name, None)

    def close(self):
        self.closing = True


class TcpPeer(Peer):
    def __init__(self, answer, scheme, complete=is_rtu_frame):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.path = f"{scheme}://127.0.0.1:{self.listener.getsockname()[1]}"
        self.complete = {"tcp": complete,
                         "modbus-tcp": lambda p: len(p) > 6 and len(p) == 6 + struct.unpack(">H", p[4:6])[0]}[scheme]
        self.connections = 0
        super().__init__(answer)

    def serve(self):
        while not self.closing:
            try:
                connection, _ = self.listener.accept()
            except OSError:
                return
            self.connections += 1
            with connection:
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                try:
                    self.talk(lambda: connection.recv(4096), connection.sendall, self.complete)
                except OSError:
                    pass

    def close(self):
        self.closing = True
        self.listener.close()
