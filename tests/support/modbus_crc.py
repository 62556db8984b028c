"""The CRC of Modbus RTU, as the tests that are outside programs compute it."""
import struct


def crc(data):
    """The two bytes as they go over the line (MODBUS over Serial Line, 6.2.2)."""
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
    return struct.pack("<H", value)


def framed(data):
    return data + crc(data)
