"""The slaves that are asked, and what they are to answer."""
import dataclasses
import pathlib

from masters import Refused, SILENT

POINTS, REGISTERS, INPUT_REGISTERS = 64, 1000, 16  # of all of them


@dataclasses.dataclass(frozen=True)
class Slave:
    program: str  # from the top of the tree
    illegal_quantity: int  # the exception
    most_written_registers: int
    writes_any_coils: bool  # with function 15; otherwise whole bytes
    obeys_broadcasts: bool
    pause: float  # seconds of quiet that it needs after an answer
    cpu: str = "214"
    most_registers: int = 125  # of a read
    input_register: str = "VW"  # memory that input registers are in, ...
    first_input_register: int = 2000  # ... and the byte of the first


SLAVES = {
    "modbus_slave": Slave("stl_programs/modbus_slave.stl", illegal_quantity=3, most_written_registers=123,
                          writes_any_coils=True, obeys_broadcasts=True, pause=3.5 * 11 / 9600),
    "tip41": Slave("../shared/seeds/tip41_modbus_rtu_slave.txt", illegal_quantity=2, most_written_registers=60,
                   writes_any_coils=False, obeys_broadcasts=False, pause=10e-3),
    "modbus_library": Slave("tests/peers/library_slave.awl", illegal_quantity=3, most_written_registers=120, most_registers=120,
                            writes_any_coils=True, obeys_broadcasts=True, pause=3.5 * 11 / 9600, cpu="224",
                            input_register="AIW", first_input_register=0),
}


class Model:
    """The memory of a slave as a master sees it."""

    def __init__(self, slave, draw):
        self.slave = slave
        self.coils = [0] * POINTS
        self.inputs = [draw.getrandbits(1) for _ in range(POINTS)]
        self.registers = [draw.getrandbits(16) for _ in range(REGISTERS)]
        self.input_registers = [draw.getrandbits(16) for _ in range(INPUT_REGISTERS)]

    def settings(self):
        """Options of `s7200 run` that make the PLC's memory like this one."""
        settings = [f"IB{n}={byte}" for n, byte in enumerate(self.packed(self.inputs))]
        settings += [f"VW{2 * n}={value}" for n, value in enumerate(self.registers)]
        settings += [f"{self.slave.input_register}{self.slave.first_input_register + 2 * n}={value}"
                     for n, value in enumerate(self.input_registers)]
        return [word for setting in settings for word in ("--set", setting)]

    def memory(self):
        """What `--dump` has to show in the end."""
        return {f"QB0:{POINTS // 8}": self.packed(self.coils).hex(),
                f"VW0:{REGISTERS}": b"".join(value.to_bytes(2, "big") for value in self.registers).hex()}

    @staticmethod
    def packed(points):
        return bytes(sum(points[8 * n + bit] << bit for bit in range(8)) for n in range(len(points) // 8))

    def answer(self, request, station=1):
        """What is to come back; the request is carried out."""
        if station == 0:
            if request.writes and self.slave.obeys_broadcasts:
                self.answer(request)
            return SILENT
        if station != 1:
            return SILENT
        table = {1: self.coils, 5: self.coils, 15: self.coils, 2: self.inputs, 4: self.input_registers}.get(
            request.function, self.registers)
        count = len(request.values) if request.writes else request.count
        most = {1: 2000, 2: 2000, 3: self.slave.most_registers, 4: self.slave.most_registers, 15: 1968, 16: self.slave.most_written_registers}.get(request.function, 1)
        if not 1 <= count <= most:
            return Refused(self.slave.illegal_quantity)
        if request.first + count > len(table):
            return Refused(2)
        if request.function == 15 and not self.slave.writes_any_coils and (request.first % 8 or count % 8):
            return Refused(2)
        if not request.writes:
            return tuple(table[request.first:request.first + count])
        table[request.first:request.first + count] = request.values
        return ()


def path_of(slave, source):
    return pathlib.Path(source) / slave.program
