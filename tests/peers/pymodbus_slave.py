"""A Modbus RTU slave made with pymodbus: pymodbus_slave.py LINK. As libmodbus_slave.cpp: station 1, 9600 baud, register n
holds 1000 + n. Says "asked" at each request. Serves until its standard input ends, then shows registers 0 to 39 on one
line."""
import os
import sys
import threading

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartSerialServer
from pymodbus.transaction import ModbusRtuFramer


class Registers(ModbusSequentialDataBlock):
    """validate() is what the server calls once for each request."""

    def validate(self, address, count=1):
        print("asked", flush=True)
        return super().validate(address, count)


registers = Registers(0, [1000 + n for n in range(1000)])
others = {name: ModbusSequentialDataBlock(0, [0] * 1000) for name in ("di", "co", "ir")}
context = ModbusServerContext(slaves={1: ModbusSlaveContext(hr=registers, zero_mode=True, **others)}, single=False)


def show_at_end():
    sys.stdin.read()
    print(*registers.getValues(0, 40), flush=True)
    os._exit(0)


threading.Thread(target=show_at_end, daemon=True).start()
StartSerialServer(context=context, framer=ModbusRtuFramer, port=sys.argv[1], baudrate=9600, parity="N",
                  ignore_missing_slaves=True)
