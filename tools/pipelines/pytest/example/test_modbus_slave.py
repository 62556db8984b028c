"""A SCADA driver of pymodbus against our Modbus slave."""
import pathlib

import pymodbus.client
import pytest

PROGRAM = pathlib.Path(__file__).resolve().parents[4] / "stl_programs/modbus_slave.stl"
STATION = 1


@pytest.fixture
def plc(s7200_plc):
    return s7200_plc(PROGRAM, "--set", "VW20=16#1234", "--dump", "VW22")


@pytest.fixture
def master(plc):
    # strict sets the port a second time, which Linux refuses on a pty.
    client = pymodbus.client.ModbusSerialClient(plc.port, baudrate=9600, parity="E", timeout=5, retry_on_empty=True, strict=False)
    assert client.connect()
    yield client
    client.close()


def test_a_register_is_read(master):
    assert master.read_holding_registers(10, 1, STATION).registers == [0x1234]


def test_a_register_that_is_written_is_in_the_memory_of_the_plc(plc, master):
    assert not master.write_register(11, 500, STATION).isError()
    assert master.read_holding_registers(10, 2, STATION).registers == [0x1234, 500]
    assert "500" in plc.stop()


def test_a_register_that_does_not_exist_is_refused(master):
    answer = master.read_holding_registers(60000, 1, STATION)
    assert answer.isError() and answer.exception_code == 2
