#!/usr/bin/env python3
"""Runs `s7200` on programs and files that are wrong: run.py S7200 programs|runtime|files

Programs say in comments what is expected of them:

    // expect error: LINE:COLUMN message      `s7200 check` reports this; every report must be listed
    // expect warning: LINE:COLUMN message
    // expect hint: text                      the hint of the report before
    // expect also: text                      the line `also:` of the report before, if it shares its cause with others
    // with: run --for 100ms                  then run it like this instead (the program's name is added)
    // expect runtime: 0006 line N            non-fatal run-time error; every one must be listed
    // expect fatal: 0003 line N              fatal error
    // expect output: text                    anywhere in what that prints
    // expect exit: 3                         default: 1 with errors in the text, 3 with a fatal error, otherwise 0

Nothing may crash or hang, and every report must be at file:line:column with the line and a caret below it.
"""
import os
import pathlib
import re
import resource
import shlex
import signal
import subprocess
import sys
import tempfile
import threading
import zlib

HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 60  # of processor time, so that a slow machine does not count as hanging
SLAVE = HERE.parent.parent / "stl_programs/modbus_slave.stl"
REPORT = re.compile(r"(.*?):(\d+):(\d+): (error|warning): (.*)")
EXPECT = re.compile(r"//\s*(expect (?:error|warning|hint|also|runtime|fatal|output|exit)|with):\s*(.*)")
RUN_TIME = re.compile(r"(run-time|FATAL) error ([0-9A-F]{4}), .*\n\s+(?:.*:(\d+): .*|(between two scans))")


class Failure(Exception):
    pass


def run(command, stdin=subprocess.DEVNULL):
    """Exit code, standard output and error as text; a crash or a time-out is a Failure."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))
    try:
        done = subprocess.run(command, stdin=stdin, capture_output=True, timeout=10 * SECONDS, check=False,
                              preexec_fn=limit)
    except subprocess.TimeoutExpired:
        raise Failure(f"hangs: {shlex.join(command)}") from None
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise Failure(f"never ends: {shlex.join(command)}")
    error = done.stderr.decode("utf-8", "replace")
    if done.returncode not in (0, 1, 2, 3) or "Sanitizer" in error or "runtime error:" in error:
        raise Failure(f"crashed with {done.returncode}: {shlex.join(command)}\n{error[-3000:]}")
    return done.returncode, done.stdout.decode("utf-8", "replace"), error


def reports(text, path):
    """What the check reported: [(severity, line, column, message, hint, also)]. Each must have its source line and caret."""
    source = path.read_text(encoding="utf-8", errors="replace").split("\n")
    lines = text.split("\n")
    found = []
    for i, line in enumerate(lines):
        match = REPORT.fullmatch(line)
        if not match:
            continue
        name, row, column, severity, message = match.groups()
        if name != str(path):
            raise Failure(f"names {name}, not {path}")
        shown, carets = lines[i + 1], lines[i + 2]
        written = source[int(row) - 1].rstrip("\r")
        if written.isascii() and written.isprintable() and len(written) <= 120:
            if shown != written or carets.find("^") != int(column) - 1:
                raise Failure(f"the caret is not at the place:\n{line}\n{shown}\n{carets}")
        elif "^" not in carets:
            raise Failure(f"no caret below: {line}")
        below = lines[i + 3:i + 5]
        hint = below.pop(0)[6:] if below[0].startswith("hint: ") else ""
        also = below[0][6:] if below[0].startswith("also: ") else ""
        found.append((severity, int(row), int(column), message, hint, also))
    return found


def expectations(path):
    """What a program expects: (reports, run-time errors, how to run it, what that prints, exit code)"""
    expected, run_time, texts, command, code = [], [], [], None, None
    for line in path.read_text(encoding="utf-8", errors="replace").split("\n"):
        match = EXPECT.match(line)
        if not match:
            continue
        what, text = match.group(1).removeprefix("expect "), match.group(2).rstrip()
        if what in ("error", "warning"):
            place, message = text.split(" ", 1)
            expected.append((what, *map(int, place.split(":")), message, None, ""))
        elif what == "hint":
            expected[-1] = (*expected[-1][:4], text, "")
        elif what == "also":
            expected[-1] = (*expected[-1][:5], text)
        elif what in ("runtime", "fatal"):
            number, place = text.split(" ", 1)
            run_time.append(("FATAL" if what == "fatal" else "run-time", number, place.removeprefix("line ")))
        elif what == "output":
            texts.append(text)
        elif what == "exit":
            code = int(text)
        else:
            command = shlex.split(text)
    if code is None:
        fatal = any(kind == "FATAL" for kind, _, _ in run_time)
        code = 1 if any(r[0] == "error" for r in expected) else 3 if fatal else 0
    return expected, run_time, command, texts, code


def same(expected, found):
    return len(expected) == len(found) and all(e[:4] == f[:4] and e[4] in (None, f[4]) and e[5] == f[5] for e, f in zip(expected, found))


def show(rows):
    return "".join(f"    {kind}: {line}:{column} {message}\n" + (f"    hint: {hint}\n" if hint else "") +
                   (f"    also: {also}\n" if also else "") for kind, line, column, message, hint, also in rows)


def check_program(s7200, path):
    expected, run_time, command, texts, code = expectations(path)
    exit_code, _, error = run([s7200, "check", "--cpu", "214", str(path)])
    found = reports(error, path)
    if not same(expected, found):
        raise Failure(f"expected\n{show(expected)}  but the check says\n{show(found)}")
    has_errors = any(r[0] == "error" for r in found)
    if exit_code != (1 if has_errors else 0):
        raise Failure(f"check ended with {exit_code}")
    command = command or ["run", "--cpu", "214", "--for", "1ms"]
    exit_code, output, error = run([s7200, command[0], str(path), *command[1:]])
    reported = [(kind, number, line or place) for kind, number, line, place in RUN_TIME.findall(output + error)]
    if exit_code != code or reported != run_time:
        raise Failure(f"expected exit {code} and {run_time}, got exit {exit_code} and {reported}\n{output}{error}")
    for text in texts:
        if text not in output + error:
            raise Failure(f"'{text}' is not in\n{output}{error}")


def check_programs(s7200, folder):
    for path in sorted((HERE / folder).glob("*.stl")):
        yield path.name, lambda path=path: check_program(s7200, path)


# --- files that are not programs ---

def png():
    """One black pixel."""
    def chunk(kind, data):
        body = kind + data
        return len(data).to_bytes(4, "big") + body + zlib.crc32(body).to_bytes(4, "big")
    head = (1).to_bytes(4, "big") * 2 + bytes([8, 0, 0, 0, 0])
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"\0\0")) + chunk(b"IEND", b"")


# Name: content, exit code of check, part of what it says. Content None: the file does not exist.
FILES = {
    "missing.stl": (None, 2, "cannot read"),
    "empty.stl": (b"", 1, "no STL statement"),
    "blank.stl": (b"\n\n   \n\t\n", 1, "no STL statement"),
    "only_comments.stl": (b"// one\n// two\n", 1, "no STL statement"),
    "picture.png": (png(), 2, "cannot read"),
    "binary.stl": (bytes(range(256)) * 64, 2, "cannot read"),
    "zeros.stl": (bytes(4096), 2, "cannot read"),
    "nul_inside.stl": (b"LD SM0.0\0\nMEND\n", None, ""),
    "utf16.stl": ("LD SM0.0\r\nMEND\r\n".encode("utf-16"), None, ""),
    "old_mac_line_ends.stl": (b"LD SM0.0\rMEND\r", None, ""),
    "no_line_end.stl": (b"LD SM0.0\nMEND", 0, "fine, 2 instructions"),
    "latin1.stl": ("LD SM0.0 // Fünf\nMEND\n".encode("latin-1"), 0, "fine, 2 instructions"),
    "broken_utf8.stl": (b"LD SM0.0\nMOVB \xc3\x28, VB0\nMEND\n", 1, ":2:"),
    "prose.txt": (b"This is a letter.\nIt has no program in it.\n" * 20, 1, ""),
    "html.stl": (b"<!DOCTYPE html>\n<html><body>404</body></html>\n", 2, "not an STL program"),
    "100000_statements.stl": (b"LD SM0.0\n" + b"MOVB 1, VB0\n" * 100_000 + b"MEND\n", 1, "the program is too large"),
    "20000_unknown.stl": (b"FROB 1, VB0\n" * 20_000, 1, "unknown instruction 'FROB'"),
    "100000_comments.stl": (b"// nothing\n" * 100_000 + b"MEND\n", 0, "fine, 1 instruction"),
    "constants.stl": (b"LD SM0.0\n" + b"".join(b"FILL %d, VW%d, 1\n" % (i, i) for i in range(2040)) + b"MEND\n", None, ""),
    "megabyte_of_letters.stl": (b"LD SM0.0\n" + b"A" * 1_000_000, 1, ":2:1: error"),
    "megabyte_of_name.stl": (b"LD " + b"x" * 1_000_000, 1, ":1:4: error"),
    "megabyte_of_digits.stl": (b"MOVB " + b"9" * 1_000_000 + b", VB0\nMEND\n", 1, ":1:6: error"),
    "megabyte_of_operands.stl": (b"MOVB " + b"VB0, " * 200_000 + b"VB0\nMEND\n", 1, ":1:"),
    "megabyte_of_blanks.stl": (b"LD" + b" " * 1_000_000 + b"SM0.0\nMEND\n", 0, "fine, 2 instructions"),
    "megabyte_of_comment.stl": (b"LD SM0.0 //" + b"x" * 1_000_000 + b"\nMEND\n", 0, "fine, 2 instructions"),
    "megabyte_of_quotes.stl": (b"MOVB '" + b"$" * 1_000_000 + b"\nMEND\n", 1, ":1:"),
    "project.mwp": (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(2000), 2, "export each block"),
    "old_project.mwp": (b"\x02\x10" + bytes(range(256)) * 8, 2, "export each block"),
    "megabyte_of_text.stl": (b"LD SM0.0\n" + b"A" * 1_000_000 + b"I0.0\nMEND\n", 1, ":2:1000003: error"),
    "megabyte_in_page.txt": (b"A page of text with words.\n" * 20 + b"LD SM0.0\n" + b"A.B" * 300_000 + b"\n= Q0.0\nMEND\n", 1, ""),
    "cut.awl": (b"ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD SM0.0\n", 1, "MAIN has no END_ORGANIZATION_BLOCK"),
    "heads.awl": (b"SUBROUTINE_BLOCK A:SBR0\n" * 20_000, 1, "A is defined twice"),
    "ends.awl": (b"END_SUBROUTINE_BLOCK\n" * 20_000, 1, "belongs to the head of a block"),
    "declarations.awl": (b"SUBROUTINE_BLOCK A:SBR0\nVAR\n" + b"x : INT;" * 100_000 + b"\nEND_VAR\nBEGIN\nEND_SUBROUTINE_BLOCK\n", 1, "x is declared twice"),
    "brackets.stl": (b"NETWORK 1\nLD SM0.0 " + b"(* x *) " * 100_000 + b"\nMEND\n", 0, ""),
    "brackets_of_two_kinds.stl": (b"NETWORK 1\nLD SM0.0 " + b"(* \xc3\xa4 *)/* y */" * 50_000 + b"\nMEND\n", 0, ""),
    "open_brackets.stl": (b"NETWORK 1\n" + b"LD SM0.0 (* x\n" * 50_000 + b"MEND\n", 1, ""),
    "signs.stl": (b"NETWORK 1\nLD SM0.0 ; on\n" + b"A I0.0" + b" ; # ' -- x" * 80_000 + b"\nMEND\n", 0, ""),
    "megabyte_of_type.awl": (b"SUBROUTINE_BLOCK A:SBR0\nVAR\nx : " + b"I" * 1_000_000 + b";\nEND_VAR\nBEGIN\nEND_SUBROUTINE_BLOCK\n", 1, "there is no type"),
    "megabyte_of_block_name.awl": (b"SUBROUTINE_BLOCK " + b"A" * 1_000_000 + b":SBR0\nBEGIN\nEND_SUBROUTINE_BLOCK\n", 1, ""),
    "symbols_only.txt": (b"Pump\tQ0.0\nStart\tI0.0\n", 1, "no STL statement"),
    "data_only.txt": (b"VB0 1, 2, 3\n", 1, "no STL statement"),
    "megabyte_of_data.txt": (b"VB0 " + b"1 " * 500_000 + b"\n", 1, "runs past the end of V memory"),
    "megabyte_of_bad_data.txt": (b"VB0 " + b"x " * 500_000 + b"\n", 1, "is not a value"),
    "megabyte_of_cells.csv": (b"Symbol,Address\nPump" + b"," * 1_000_000 + b"\n", 1, "no STL statement"),
    "nested_loops.stl": (b"LD SM0.0\n" + b"FOR VW0, 1, 2\n" * 5000, 1, "FOR loops nested deeper than 8"),
    "calls.stl": (b"LD SM0.0\nCALL 0\nMEND\n" + b"".join(b"SBR %d\nCALL %d\nRET\n" % (i, i + 1) for i in range(63)) +
                  b"SBR 63\nCALL 0\nRET\n", 0, "calls itself"),
}


def check_file(s7200, folder, name):
    content, code, text = FILES[name]
    path = folder / name
    if content is not None:
        path.write_bytes(content)
    exit_code, output, error = run([s7200, "check", str(path)])
    if exit_code != code if code is not None else exit_code > 2:
        raise Failure(f"exit code {exit_code}, expected {code}\n{error[:2000]}")
    if text not in output + error:
        raise Failure(f"'{text}' is not in\n{(output + error)[:2000]}")
    for line in error.split("\n"):
        if len(line) > 1000:
            raise Failure(f"a line of {len(line)} characters: {line[:200]}")
    if len(content or b"") > 100_000:
        return  # the other verbs load in the same way
    for verb in (["run", str(path), "--scans", "2"], ["send", str(path), "0103", "--timeout", "10ms"],
                 ["import", str(path)], ["check", "--json", str(path)], ["bench", str(path), "--each", "1ms"]):
        run([s7200, *verb])


def check_files(s7200):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "folder.stl").mkdir()
        for name in FILES:
            yield name, lambda name=name: check_file(s7200, pathlib.Path(folder), name)
        yield "folder.stl", lambda: expect_refusal(s7200, pathlib.Path(folder) / "folder.stl", "it is a folder")
        yield "/dev/zero", lambda: expect_refusal(s7200, "/dev/zero", "it is a device, not a file")
        yield "serial port", lambda: expect_no_wait_for_a_serial_port(s7200)
        yield "endless pipe", lambda: expect_no_endless_reading(s7200)
        yield "large.stl", lambda: expect_no_program_of_that_size(s7200, pathlib.Path(folder) / "large.stl")
        yield "pipe without writer", lambda: expect_wait_for_the_writer(s7200, pathlib.Path(folder) / "pipe.stl")


def expect_refusal(s7200, path, text):
    for verb in (["check", path], ["run", path], ["import", path], ["send", path, "0103"], ["send", SLAVE, "--frames", path],
                 ["debug", SLAVE, "--commands", path], ["run", SLAVE, "--input", path], ["check", SLAVE, "--times", path]):
        exit_code, _, error = run([s7200, *map(str, verb)])
        if exit_code != 2 or text not in error:
            raise Failure(f"{verb}: exit code {exit_code}: {error}")


def expect_no_wait_for_a_serial_port(s7200):
    near, far = os.openpty()
    try:
        expect_refusal(s7200, os.ttyname(far), "it is a device, not a file")
        exit_code, _, error = run([s7200, "run", SLAVE, "--scans", "2", "--output", os.ttyname(far)])
        if exit_code != 0 or not os.read(near, 100):
            raise Failure(f"a terminal to write on: exit code {exit_code}: {error}")
    finally:
        os.close(near)
        os.close(far)


def expect_no_endless_reading(s7200):
    for line in ("y", "LD I0.0", "01 03 00 00 00 01 84 0a"):
        with subprocess.Popen(["yes", line], stdout=subprocess.PIPE) as endless:
            exit_code, _, error = run([s7200, "check", "/dev/stdin"], stdin=endless.stdout)
            endless.kill()
        if exit_code != 2 or "larger than" not in error:
            raise Failure(f"exit code {exit_code}: {error}")


def expect_no_program_of_that_size(s7200, path):
    path.write_text("LD I0.0\n" * 600_000)
    for verb, *options in (["check"], ["run"], ["import"], ["debug"], ["convert", "--to", "iec"]):
        exit_code, _, error = run([s7200, verb, *options, str(path)])
        if exit_code != 2 or "it is larger than 4 MB, more than any program" not in error:
            raise Failure(f"{verb}: exit code {exit_code}: {error}")
    path.write_text("01 03 00 00 00 01 84 0a\n" * 200_000)
    exit_code, _, error = run([s7200, "check", str(path)])
    if exit_code != 2 or "it is a recording of a line" not in error:
        raise Failure(f"exit code {exit_code}: {error}")


def expect_wait_for_the_writer(s7200, path):
    os.mkfifo(path)
    checking = subprocess.Popen([s7200, "check", str(path)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    # A command that does not open the pipe lets its writer wait for ever.
    threading.Thread(target=path.write_text, args=("LD SM0.0\nMEND\n",), daemon=True).start()
    output, _ = checking.communicate(timeout=60)
    if checking.returncode != 0:
        raise Failure(f"exit code {checking.returncode}: {output}")


def main():
    s7200, group = sys.argv[1:]
    cases = check_files(s7200) if group == "files" else check_programs(s7200, group)
    count = failed = 0
    for name, case in cases:
        count += 1
        try:
            case()
        except Failure as failure:
            failed += 1
            print(f"{group}/{name}: {failure}")
    print(f"{count} cases, {failed} failed")
    return 1 if failed or not count else 0


if __name__ == "__main__":
    sys.exit(main())
