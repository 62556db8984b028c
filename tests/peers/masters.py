"""Masters of others, all asked the same way."""
import dataclasses
import pathlib
import re
import shutil
import subprocess


@dataclasses.dataclass(frozen=True)
class Request:
    function: int
    first: int
    count: int = 0  # of a read
    values: tuple = ()  # of a write

    @property
    def writes(self):
        return self.function in (5, 6, 15, 16)

    @property
    def of_bits(self):
        return self.function in (1, 2, 5, 15)


@dataclasses.dataclass(frozen=True)
class Refused:
    """An exception response."""
    code: int


SILENT = "silent"  # no answer within the time-out


class Unfit(Exception):
    """Why this master cannot be used here, or cannot ask this."""


class Mbpoll:
    """One process a request."""
    can_broadcast = False  # "slave address out of range (0)"

    def __init__(self, _client):
        if not shutil.which("mbpoll"):
            raise Unfit("mbpoll is not installed")

    def open(self, link, baud, timeout):
        self.port = ["-b", str(baud), "-o", str(timeout), str(link)]

    def close(self):
        pass

    def can_ask(self, request):
        """It reads 125 values at most, and writes one value with functions 5 and 6."""
        if request.writes:
            return (len(request.values) == 1) == (request.function in (5, 6))
        return 1 <= request.count <= 125

    TABLE = {1: "0", 5: "0", 15: "0", 2: "1", 4: "3", 3: "4", 6: "4", 16: "4"}
    REFUSALS = {"Illegal function": 1, "Illegal data address": 2, "Illegal data value": 3}

    def ask(self, station, request):
        command = ["mbpoll", "-m", "rtu", "-0", "-1", "-P", "even", "-a", str(station), "-t", self.TABLE[request.function],
                   "-r", str(request.first), *(["-c", str(request.count)] if not request.writes else []), *self.port,
                   *map(str, request.values)]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=60)
        if done.returncode == 0:
            if request.writes:
                assert f"Written {len(request.values)} references." in done.stdout, done.stdout
                return ()
            rows = re.findall(r"^\[(\d+)\]: \t(\d+)", done.stdout, re.M)
            assert [int(reference) for reference, _ in rows] == list(range(request.first, request.first + request.count))
            return tuple(int(value) for _, value in rows)
        why = done.stderr.strip().rsplit(": ", 1)[-1]
        if why in self.REFUSALS:
            return Refused(self.REFUSALS[why])
        assert why == "Connection timed out", f"{' '.join(command)}\n{done.stdout}{done.stderr}"
        return SILENT


class Libmodbus:
    """Our own client, libmodbus_master.cpp."""
    can_broadcast = True

    def __init__(self, client):
        if not pathlib.Path(client).is_file():
            raise Unfit("libmodbus was not there when this was built")
        self.client = client
        self.process = None

    def open(self, link, baud, timeout):
        self.process = subprocess.Popen([self.client], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.obey(f"open {link} {baud}")
        self.obey(f"timeout {round(timeout * 1000)}")

    def close(self):
        self.process.stdin.close()
        self.process.wait(60)
        self.process.stdout.close()

    def can_ask(self, _request):
        return True

    MOST = {1: 2000, 2: 2000, 3: 125, 4: 125, 15: 1968, 16: 123}  # it builds no larger request

    def ask(self, station, request):
        self.obey(f"station {station}")
        if max(request.count, len(request.values)) > self.MOST.get(request.function, 1):
            return self.obey(f"raw {pdu(request).hex()}")
        return self.obey(f"ask {request.function} {request.first} "
                         + (" ".join(map(str, request.values)) if request.writes else str(request.count)))

    def obey(self, command):
        self.process.stdin.write(command + "\n")
        self.process.stdin.flush()
        what, *rest = self.process.stdout.readline().split()
        if what == "values":
            return tuple(map(int, rest))
        if what == "refused":
            return Refused(int(rest[0]))
        assert what == "silent", f"{command}: {what} {' '.join(rest)}"
        return SILENT


class Pymodbus:
    """The synchronous serial client of pymodbus 3.0."""
    can_broadcast = True

    def __init__(self, _client):
        try:
            import pymodbus.client
            import pymodbus.exceptions
            import pymodbus.pdu
        except ImportError as error:
            raise Unfit(f"pymodbus cannot be imported: {error}") from None
        self.pymodbus = pymodbus
        self.client = None

    def open(self, link, baud, timeout):
        # strict sets the port a second time, with nothing new but the parity, which a pty never takes: EINVAL.
        self.client = self.pymodbus.client.ModbusSerialClient(
            str(link), baudrate=baud, parity="E", timeout=timeout, retries=0, broadcast_enable=True, strict=False)
        assert self.client.connect()

    def close(self):
        self.client.close()

    def can_ask(self, _request):
        return True

    def ask(self, station, request):
        client, first, count, values = self.client, request.first, request.count, list(request.values)
        answer = {
            1: lambda: client.read_coils(first, count, station),
            2: lambda: client.read_discrete_inputs(first, count, station),
            3: lambda: client.read_holding_registers(first, count, station),
            4: lambda: client.read_input_registers(first, count, station),
            5: lambda: client.write_coil(first, values[0], station),
            6: lambda: client.write_register(first, values[0], station),
            15: lambda: client.write_coils(first, values, station),
            16: lambda: client.write_registers(first, values, station),
        }[request.function]()
        if isinstance(answer, (bytes, self.pymodbus.exceptions.ModbusIOException)):
            return SILENT
        if isinstance(answer, self.pymodbus.pdu.ExceptionResponse):
            return Refused(answer.exception_code)
        assert answer.function_code == request.function, answer
        if request.writes:
            return ()
        return tuple(map(int, answer.bits[:count])) if request.of_bits else tuple(answer.registers)


def pdu(request):
    """Function and data as they go over the line."""
    head = bytes([request.function]) + request.first.to_bytes(2, "big")
    if request.function == 5:
        return head + (b"\xff\x00" if request.values[0] else b"\x00\x00")
    if request.function == 6:
        return head + request.values[0].to_bytes(2, "big")
    if not request.writes:
        return head + request.count.to_bytes(2, "big")
    if request.function == 15:
        bits = sum(value << i for i, value in enumerate(request.values))
        data = bits.to_bytes((len(request.values) + 7) // 8, "little")
    else:
        data = b"".join(value.to_bytes(2, "big") for value in request.values)
    return head + len(request.values).to_bytes(2, "big") + bytes([len(data) & 0xFF]) + data


MASTERS = {"mbpoll": Mbpoll, "libmodbus": Libmodbus, "pymodbus": Pymodbus}
