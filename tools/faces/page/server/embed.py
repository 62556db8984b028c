#!/usr/bin/env python3
"""embed.py OUTPUT.cpp NAME=FILE...: the files of the page as C++, for page_files()."""
import pathlib
import sys

TYPES = {"html": "text/html; charset=utf-8", "css": "text/css; charset=utf-8", "js": "text/javascript; charset=utf-8",
         "wasm": "application/wasm", "svg": "image/svg+xml"}
LINE = 32  # bytes


def numbers_of(data):
    """A literal of characters may be too long for a compiler: the standard asks for 65 536."""
    return ",\n    ".join(",".join(map(str, data[at:at + LINE])) for at in range(0, len(data), LINE))


def main():
    output = pathlib.Path(sys.argv[1])
    files = [argument.split("=", 1) for argument in sys.argv[2:]]
    arrays, rows = [], []
    for number, (name, path) in enumerate(files):
        data = pathlib.Path(path).read_bytes()
        arrays.append(f"const unsigned char kFile{number}[{len(data)} + 1] = {{\n    {numbers_of(data)}}};\n")
        served = "" if name == "index.html" else name
        rows.append(f'      {{"{served}", "{TYPES[name.rsplit(".", 1)[-1]]}", {{reinterpret_cast<const char*>(kFile{number}), {len(data)}}}}}')
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text("// Made by embed.py.\n#include \"tools/faces/page/server/assets.hpp\"\n\nnamespace s7200::tools::page {\nnamespace {\n\n"
                      + "\n".join(arrays)
                      + "\n}  // namespace\n\nconst std::vector<WebFile>& page_files() {\n  static const std::vector<WebFile> kFiles{\n"
                      + ",\n".join(rows) + "};\n  return kFiles;\n}\n\n}  // namespace s7200::tools::page\n", encoding="utf-8")


if __name__ == "__main__":
    main()
