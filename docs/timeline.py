#!/usr/bin/env python3
"""The picture of README.md, from a real run: timeline.py S7200 [--write]

Without --write, says whether docs/timeline.svg is what this run gives."""
import json
import pathlib
import subprocess
import sys
from xml.sax.saxutils import escape

DOCS = pathlib.Path(__file__).resolve().parent
PICTURE = DOCS / "timeline.svg"
COMMAND = ["send", "stl_programs/modbus_slave.stl", "--crc", "0103000a0002", "--timeline"]
CHARACTER = 11 / 9600 * 1e6  # us: a start bit, 8 data bits, even parity, a stop bit
WIDTH, LEFT, TOP, LANE = 880, 112, 64, 46
LANES = ("master", "PLC sends", "interrupts", "program")
FONT = "font-family='DejaVu Sans Mono, Menlo, Consolas, monospace'"


def exchange_of(s7200):
    done = subprocess.run([s7200, *COMMAND, "--json"], cwd=DOCS.parent, capture_output=True, check=True, text=True)
    return json.loads(done.stdout)["exchanges"][0]


class Picture:
    def __init__(self, end):
        self.scale = (WIDTH - LEFT - 24) / end
        self.parts = []

    def x(self, us):
        return LEFT + us * self.scale

    @staticmethod
    def y(lane):
        return TOP + LANES.index(lane) * LANE

    def text(self, x, y, text, size=11, colour="#333", anchor="start"):
        self.parts.append(f"<text x='{x:.1f}' y='{y:.1f}' font-size='{size}' fill='{colour}' text-anchor='{anchor}'>{escape(text)}</text>")

    def box(self, lane, begin, end, colour, text=""):
        """From `begin` to `end` in microseconds, at least as wide as can be seen."""
        x, width = self.x(begin), max((end - begin) * self.scale, 2)
        self.parts.append(f"<rect x='{x:.1f}' y='{self.y(lane)}' width='{width:.1f}' height='22' fill='{colour}' stroke='#fff' stroke-width='0.8'/>")
        if text:
            self.text(x + width / 2, self.y(lane) + 15, text, 10, "#fff", "middle")

    def span(self, begin, end, y, text):
        x1, x2 = self.x(begin), self.x(end)
        self.parts.append(f"<path d='M{x1:.1f},{y - 4}v8M{x1:.1f},{y}H{x2:.1f}M{x2:.1f},{y - 4}v8' stroke='#888' fill='none'/>")
        self.text((x1 + x2) / 2, y - 5, text, 11, "#555", "middle")

    def characters(self, lane, first_end, hexadecimal, colour):
        """Characters in a row, the first of which ends at `first_end`; returns when the last one does."""
        for number in range(len(hexadecimal) // 2):
            end = first_end + number * CHARACTER
            self.box(lane, end - CHARACTER, end, colour, hexadecimal[2 * number:2 * number + 2])
        return end

    def svg(self):
        height = TOP + len(LANES) * LANE + 26
        lanes = [f"<path d='M{LEFT},{self.y(lane) + 22.5}H{WIDTH - 24}' stroke='#ddd'/>"
                 f"<text x='14' y='{self.y(lane) + 15}' font-size='12' fill='#333'>{lane}</text>" for lane in LANES]
        return "\n".join([f"<svg xmlns='http://www.w3.org/2000/svg' width='{WIDTH}' height='{height}' viewBox='0 0 {WIDTH} {height}' {FONT}>",
                          f"<rect width='{WIDTH}' height='{height}' rx='8' fill='#fbfbf8' stroke='#ddd'/>",
                          f"<text x='14' y='24' font-size='13' font-weight='bold' fill='#222'>$ s7200 {' '.join(COMMAND)}</text>",
                          *lanes, *self.parts, "</svg>", ""])


def drawn(exchange):
    rows = exchange["timeline"]
    picture = Picture(max(row["at_us"] for row in rows) + 2 * CHARACTER)
    received = [row for row in rows if row["kind"] == "received"]
    for row in received:
        end_of_request = picture.characters("master", row["at_us"], row["characters"], "#4a78a8")
        for number in range(row["served"]):
            begin = row["at_us"] + number * CHARACTER
            picture.box("interrupts", begin, begin + row["longest_us"], "#b5651d")
        picture.text(picture.x(row["at_us"]) - 6, picture.y("interrupts") - 5, f"INT {row['routine']}", 10, "#b5651d", "end" if row is received[0] else "start")
    for row in rows:
        if row["kind"] == "sent":
            picture.characters("PLC sends", row["at_us"], row["characters"], "#3c8d5a")
            picture.span(end_of_request, row["at_us"] - CHARACTER, picture.y("PLC sends") + 14, f"{exchange['latency_us'] / 1000:.3f} ms")
        elif row["kind"] == "event":
            picture.box("interrupts", row["at_us"], row["at_us"] + row["longest_us"], "#b5651d")
            picture.text(picture.x(row["at_us"]), picture.y("interrupts") - 5, f"INT {row['routine']}", 10, "#b5651d", "middle")
        elif row["kind"] == "transmit":
            picture.box("program", row["at_us"], row["at_us"] + 1, "#7a4a9a")
            picture.text(picture.x(row["at_us"]) - 6, picture.y("program") + 15, f"{row['text']}, {row['why'].split(':')[0]}", 11, "#7a4a9a", "end")
    for ms in range(0, int(rows[-1]["at_us"] / 1000) + 2, 5):
        picture.text(picture.x(ms * 1000), TOP + len(LANES) * LANE + 10, f"{ms} ms", 10, "#888", "middle")
    return picture.svg()


def main():
    new = drawn(exchange_of(sys.argv[1]))
    if "--write" in sys.argv[2:]:
        PICTURE.write_text(new, encoding="utf-8")
    elif PICTURE.read_text(encoding="utf-8") != new:
        sys.exit(f"{PICTURE.name} is not what this run gives; docs/timeline.py S7200 --write makes it again")


main()
