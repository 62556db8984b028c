"""What a page may say to its engine: the lines for tests/platforms/engine_lines.cpp."""
import json
import pathlib
import sys

COMMANDS = [
    "past", "listing", "listing 1 40", "scan 3", "status 76 140", "values VW0 /x VB0:8 SM0.0 nonsense", "continue 200ms",
    "send 01 03 00 0a 00 02 crc", "continue", "spans -20ms end 500 VW0 Q0.0", "spans start end 50", "why", "history 5", "timeline",
    "break INT 0; break error; continue 50ms; rstep 3; step", "at start", "at 15ms", "set VW20=7; force VW30=9 I0.0=1; continue 100ms",
    "who VW20", "why VW20", "send 01 03p 00", "continue", "regs", "stack", "port", "errors", "frobnicate", "save x.json", "load x.json", "help",
    "help spans", "restart",
]  # `past` says how much memory its checkpoints take, which differs, once there are some


def messages(source):
    number = 0

    def message(**keys):
        nonlocal number
        number += 1
        return json.dumps({"id": number, **keys})

    yield message(command="step")
    yield "no json"
    yield "[1]"
    yield message(open={"sources": []})
    yield message(open={"sources": [{"name": "wrong.stl", "text": "LD VW0\nMOVW 1\n"}]})
    yield message(open={"sources": [{"name": "x.stl", "text": "LD SM0.0\n= Q0.0\nMEND\n"}], "options": {"frob": "1"}})
    for path in ("stl_programs/modbus_slave.stl", "stl_programs/text_commands.stl", "tests/platforms/reals.awl"):
        text = (pathlib.Path(source) / path).read_text(encoding="utf-8")
        yield message(open={"sources": [{"name": path, "text": text}], "options": {"set": ["VW100=5"], "fault": "flip:exchange=2"}})
        for command in COMMANDS:
            yield message(command=command)
    yield message(command="quit")


if __name__ == "__main__":
    print("\n".join(messages(sys.argv[1])))
