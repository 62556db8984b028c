#!/usr/bin/env python3
"""The prompt of `s7200 debug` on a terminal, a pty of this process: prompt.py S7200 SOURCE"""
import fcntl
import os
import pathlib
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest

S7200, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SLAVE = str(SOURCE / "stl_programs/modbus_slave.stl")
PROMPT = "(s7200) "
UP, DOWN, LEFT, RIGHT = "\x1b[A", "\x1b[B", "\x1b[D", "\x1b[C"
PATIENCE = 20  # seconds


class Terminal:
    """A session on a terminal of its own."""

    def __init__(self, state, *arguments, size=(100, 40), term="xterm"):
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            environment = {**os.environ, "XDG_STATE_HOME": str(state), "TERM": term, "LC_ALL": "C.UTF-8"}
            environment.pop("NO_COLOR", None)
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", size[1], size[0], 0, 0))
            os.execvpe(S7200, [S7200, "debug", *arguments], environment)
        self.text = ""

    def resize(self, columns, rows):
        fcntl.ioctl(self.fd, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def read(self, seconds):
        if not select.select([self.fd], [], [], seconds)[0]:
            return False
        try:
            got = os.read(self.fd, 65536)
        except OSError:
            return False
        self.text += got.decode(errors="replace")
        return bool(got)

    def until(self, *parts):
        """What came up to the last of the parts, which come in this order; it is taken."""
        end = time.monotonic() + PATIENCE
        while True:
            at = 0
            for part in parts:
                found = self.text.find(part, at)
                if found < 0:
                    break
                at = found + len(part)
            else:
                taken, self.text = self.text[:at], self.text[at:]
                return taken
            if time.monotonic() > end or not self.read(1) and time.monotonic() > end:
                raise AssertionError(f"{part!r} did not come; this did:\n{self.text!r}")

    def type(self, keys):
        os.write(self.fd, keys.encode())

    def command(self, line):
        """What it prints, up to the next prompt."""
        self.type(line + "\n")
        self.until("\n")
        return self.until(PROMPT)

    def signal(self, number):
        os.kill(self.pid, number)

    def end(self):
        """The exit code, and all that came until then."""
        while self.read(PATIENCE):
            pass
        status = os.waitpid(self.pid, 0)[1]
        os.close(self.fd)
        return os.waitstatus_to_exitcode(status)


class Prompt(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def session(self, *arguments, **more):
        terminal = Terminal(self.folder / "state", *(arguments or [SLAVE]), **more)
        terminal.until(PROMPT)
        return terminal

    def quit(self, terminal, keys="quit\n"):
        terminal.type(keys)
        self.assertEqual(terminal.end(), 0, terminal.text)

    def test_arrow_keys_edit_the_line_and_bring_earlier_ones_back(self):
        terminal = self.session()
        terminal.type("print VB1:2" + LEFT * 2 + "0" + "\n")
        terminal.until("VB10 ")
        terminal.until(PROMPT)
        terminal.type(UP + "\n")
        terminal.until("VB10 ")
        terminal.until(PROMPT)
        self.quit(terminal)

    def test_history_is_kept_over_sessions_and_a_folder_that_cannot_be_written_is_no_error(self):
        terminal = self.session()
        terminal.command("print VW222")
        self.quit(terminal)
        terminal = self.session()
        terminal.type(UP + UP + "\n")
        terminal.until("VW222    16#0000")
        terminal.until(PROMPT)
        self.quit(terminal)
        self.assertEqual((self.folder / "state/s7200/debug_history").read_text().splitlines()[0], "print VW222")
        (self.folder / "file").write_text("")
        terminal = Terminal(self.folder / "file", SLAVE)
        terminal.until(PROMPT)
        self.quit(terminal)

    def test_the_tab_key_completes_commands_addresses_places_and_files(self):
        terminal = self.session()
        terminal.type("conti\t")
        terminal.until("nue ")
        terminal.type("10ms\n")
        terminal.until(PROMPT)
        terminal.type("break INT 12\t")
        terminal.until("122  123")
        terminal.type("3\n")
        terminal.until("breakpoint 1 in INT 123")
        terminal.until(PROMPT)
        (self.folder / "a_saved_session").mkdir()
        terminal.type(f"save {self.folder}/a_sa\t")
        terminal.until("ved_session/")
        terminal.type("x.json\n")
        terminal.until("saved: ")
        self.assertTrue((self.folder / "a_saved_session/x.json").exists())
        self.quit(terminal)

    def test_ctrl_c_ends_the_line_being_typed_and_a_run_but_not_the_session(self):
        terminal = self.session()
        terminal.type("print VW1")
        terminal.until("VW1")
        terminal.signal(signal.SIGINT)
        terminal.until(PROMPT)
        terminal.type("continue 1000h\n")
        terminal.until("\n")
        time.sleep(0.5)
        terminal.signal(signal.SIGINT)
        terminal.until("interrupted by Ctrl-C", PROMPT)
        self.quit(terminal)

    def test_the_end_of_the_input_and_a_polite_kill_end_the_session(self):
        self.quit(self.session(), "\x04")
        terminal = self.session()
        terminal.signal(signal.SIGTERM)
        self.assertEqual(terminal.end(), 1)

    def test_a_small_terminal_that_changes_its_size_is_good_enough_but_not_for_the_layout(self):
        terminal = self.session(size=(40, 10))
        self.assertIn("layout needs a terminal of 80×24, and this one has 40×10", terminal.command("layout on"))
        terminal.type("print VW100 VW102 VW104 VW106 VW108 VW110 VW112")
        terminal.resize(60, 12)
        terminal.type("\n")
        terminal.until("VW112    16#0000")
        terminal.until(PROMPT)
        self.quit(terminal)

    def test_the_layout_keeps_program_and_memory_in_view_and_gives_the_terminal_back(self):
        terminal = self.session()
        terminal.command("display VW100")
        shown = terminal.command("layout on")
        self.assertIn("\x1b[16;40r", shown, "the lower part scrolls")
        self.assertIn("VW100    16#0000", shown)
        self.assertIn("line 76 ", shown)
        self.assertIn("scan 3", terminal.command("scan 2"))
        terminal.resize(40, 10)
        terminal.until("layout needs a terminal of 80×24, and this one has 40×10")
        terminal.resize(100, 40)
        for command, region in (("layout on", "\x1b[16;40r"), ("layout off", "\x1b[1;40r"), ("layout on", "\x1b[16;40r")):
            terminal.type(command + "\n")
            terminal.until(region, PROMPT)
        self.quit(terminal)
        self.assertIn("\x1b[1;40r", terminal.text)

    def test_the_layout_lives_while_the_program_runs_until_ctrl_c(self):
        terminal = self.session()
        terminal.command("display VW3300; layout on")
        terminal.type("continue 1000h\n")
        shown = terminal.until("\x1b[1;1H", "scan ", "\x1b[1;1H", "scan ", "\x1b[1;1H", "scan ")
        self.assertNotIn(PROMPT, shown, "while it runs")
        moments = re.findall(r"([0-9.]+) ms  scan (\d+)", shown)
        self.assertGreater(len({scan for _, scan in moments}), 1, "it is another scan each time")
        self.assertIn("line 76 ", shown)
        terminal.resize(90, 30)
        terminal.until("\x1b[16;30r", "scan ")
        terminal.signal(signal.SIGINT)
        terminal.until("interrupted by Ctrl-C", PROMPT)
        self.quit(terminal)

    def test_a_signal_gives_the_terminal_back_too(self):
        for number, code in ((signal.SIGTERM, 1), (signal.SIGQUIT, -signal.SIGQUIT)):
            terminal = self.session()
            terminal.command("layout on")
            terminal.signal(number)
            self.assertEqual(terminal.end(), code)
            self.assertIn("\x1b[1;40r", terminal.text)

    def test_what_is_forced_is_red_unless_no_colour_is_wanted(self):
        terminal = self.session()
        self.assertIn("\x1b[31m  forced: Q0.0=1", terminal.command("force Q0.0=1; print Q0.0"))
        self.quit(terminal)
        os.environ["NO_COLOR"] = "1"
        try:
            plain = subprocess.run([S7200, "debug", SLAVE, "-x", "force Q0.0=1; print Q0.0"], capture_output=True, text=True)
        finally:
            del os.environ["NO_COLOR"]
        self.assertIn("  forced: Q0.0=1", plain.stdout)
        self.assertNotIn("\x1b", plain.stdout)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[3:]])
