#!/usr/bin/env python3
"""Writes the code pages that listings come in as tables for code_pages.cpp, from Python's codecs.

    code_page_tables.py OUTPUT
"""
import sys

SINGLE = ["Windows-1250", "Windows-1251", "Windows-1252", "Windows-1253", "Windows-1254", "CP437"]
PAIRS = {"GBK": "gbk", "Shift-JIS": "cp932"}
LEADS, TRAILS = range(0x81, 0xFF), range(0x40, 0xFF)
UNDEFINED = 0xFFFD


def character(codec, *octets):
    try:
        text = bytes(octets).decode(codec)
    except UnicodeDecodeError:
        return UNDEFINED
    # Python fills gaps with control characters and characters of private use, which Windows and iconv do not.
    gap = len(text) != 1 or 0x80 <= ord(text) <= 0x9F or 0xE000 <= ord(text) <= 0xF8FF or text == "\xa0" and codec == "cp932"
    return UNDEFINED if gap else ord(text)


def table(name, codes):
    rows = [", ".join(f"0x{code:04X}" for code in codes[at:at + 16]) for at in range(0, len(codes), 16)]
    return f"inline constexpr char16_t {name}[] = {{\n" + ",\n".join(rows) + "};\n"


def main():
    output = ["// The characters of the bytes 80 to FF, and those of the pairs from 81 40 to FE FE, lead by lead.\n#pragma once\n\n"
              "#include <cstdint>\n#include <span>\n#include <string_view>\n\nnamespace s7200::stl {\n"]
    pages = []
    for name, codec in [*((name, name.lower()) for name in SINGLE), *PAIRS.items()]:
        plain = "k" + name.replace("-", "")
        output.append(table(plain + "Single", [character(codec, octet) for octet in range(0x80, 0x100)]))
        pairs = "{}"
        if name in PAIRS:
            pairs = plain + "Pairs"
            output.append(table(pairs, [character(codec, lead, trail) for lead in LEADS for trail in TRAILS]))
        pages.append(f'    {{"{name}", {plain}Single, {pairs}}},\n')
    output.append("struct CodePage {\n  std::string_view name;\n  std::span<const char16_t> single;\n"
                  "  std::span<const char16_t> pairs;  ///< none in a code page of single bytes\n};\n"
                  f"inline constexpr CodePage kCodePages[] = {{\n{''.join(pages)}}};\n"
                  f"inline constexpr std::uint8_t kFirstLead = {LEADS.start}, kFirstTrail = {TRAILS.start}, kTrails = {len(TRAILS)};\n"
                  "}  // namespace s7200::stl\n")
    with open(sys.argv[1], "w", encoding="ascii") as file:
        file.write("\n".join(output))


main()
