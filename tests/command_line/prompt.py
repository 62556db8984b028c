#!/usr/bin/env python3
"""The prompt of `s7200 debug`, and the menu of `s7200 master`, on a terminal, a pty of this process: prompt.py S7200 SOURCE"""
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
ENDLESS = "watch VW4000; continue 1000h"  # a watch looks at every scan


class Terminal:
    """A session on a terminal of its own."""

    def __init__(self, state, *arguments, verb="debug", size=(100, 40), term="xterm"):
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            environment = {**os.environ, "XDG_STATE_HOME": str(state), "TERM": term, "LC_ALL": "C.UTF-8"}
            environment.pop("NO_COLOR", None)
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", size[1], size[0], 0, 0))
            os.execvpe(S7200, [S7200, verb, *arguments], environment)
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
        terminal.type(ENDLESS + "\n")
        terminal.until("\n")
        time.sleep(0.5)
        terminal.signal(signal.SIGINT)
        terminal.until("interrupted by Ctrl-C", PROMPT)
        self.quit(terminal)

    def test_after_ctrl_c_the_rest_of_the_line_is_not_done(self):
        terminal = self.session()
        terminal.type(ENDLESS + "; set VW20=7; print VW20\n")
        terminal.until("\n")
        time.sleep(0.5)
        terminal.signal(signal.SIGINT)
        terminal.until("interrupted by Ctrl-C", "not done any more: 2 commands", PROMPT)
        self.assertIn("VW20     16#0000", terminal.command("print VW20"))
        self.quit(terminal)

    def test_ctrl_c_leads_from_given_commands_to_the_prompt(self):
        terminal = self.session(SLAVE, "-i", "-x", ENDLESS, "-x", "set VW20=7", "-x", "print VW20")
        terminal.until("watch 1")
        time.sleep(0.5)
        terminal.signal(signal.SIGINT)
        terminal.until("interrupted by Ctrl-C", "not done any more: 2 commands", PROMPT)
        self.assertIn("VW20     16#0000", terminal.command("print VW20"))
        self.quit(terminal)

    def test_a_long_command_shows_how_far_it_has_come_until_ctrl_c(self):
        terminal = self.session()
        terminal.type(ENDLESS + "\n")
        terminal.until(" ms; Ctrl-C ends it", " ms; Ctrl-C ends it")
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
        terminal.until("VW112")
        terminal.resize(60, 12)
        shown = terminal.until(PROMPT, "VW112")
        self.assertIn("\r\x1b[J" + PROMPT, shown, "the line is written anew, not once more beside itself")
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
        terminal.until("layout needs a terminal of 80×24, and this one has 40×10; it comes back when there is room")
        terminal.resize(100, 40)
        terminal.until("\x1b[16;40r", "VW100    16#0000", PROMPT)
        for command, region in (("layout off", "\x1b[1;40r"), ("layout on", "\x1b[16;40r")):
            terminal.type(command + "\n")
            terminal.until(region, PROMPT)
        self.quit(terminal)
        self.assertIn("\x1b[1;40r", terminal.text)

    def test_the_layout_shows_comments_as_far_as_the_terminal_is_wide(self):
        program = self.folder / "long_comment.stl"
        program.write_text("LD      SM0.0   // " + "x" * 120 + "!\nMEND\n")
        terminal = self.session(str(program), size=(200, 40))
        self.assertIn("x" * 120 + "!", terminal.command("layout on; scan 2"))
        self.quit(terminal)

    def test_the_layout_shows_memory_once_and_says_how_much_has_no_room(self):
        terminal = self.session()
        terminal.command("display VB0:160")
        terminal.command("layout on")
        shown = terminal.command("scan 2")
        self.assertEqual(len(re.findall(r"^VB0 ", re.sub(r"\x1b\[[0-9;]*[A-Za-z]", "\n", shown), re.M)), 1, shown)
        self.assertRegex(shown, r"… \d+ more lines; 'display' prints all")
        self.quit(terminal)

    def test_what_is_typed_while_a_run_follows_the_clock_is_carried_out_and_the_run_goes_on(self):
        for pace in (("--realtime",), ("--speed", "20")):
            terminal = self.session(SLAVE, *pace)
            terminal.type("continue 1000h\n")
            terminal.until("Ctrl-C ends it")  # it runs: the terminal hands over whole lines from here on
            terminal.type("set VW20=77\n")
            terminal.until("\n")
            terminal.type("print VW20\n")
            self.assertNotIn(PROMPT, terminal.until("16#004D"), "while it runs")
            terminal.type("force I0.3=1\nforce\n")
            self.assertNotIn(PROMPT, terminal.until("I0.3=1", "I0.3  "), "while it runs")
            terminal.type("contineu\n")
            self.assertNotIn(PROMPT, terminal.until("did you mean continue?"), "while it runs")
            terminal.signal(signal.SIGINT)
            terminal.until("interrupted by Ctrl-C", PROMPT)
            self.assertIn("77", terminal.command("print VW20"))
            self.quit(terminal)

    def test_a_command_that_moves_the_program_ends_the_run_it_is_typed_into(self):
        terminal = self.session(SLAVE, "--realtime")
        terminal.type("continue 1000h\n")
        terminal.until("Ctrl-C ends it")
        terminal.type("step\n")
        terminal.until("S0=", PROMPT)
        terminal.type("continue 1000h\n")
        terminal.until("Ctrl-C ends it")
        terminal.type("quit\n")
        self.assertEqual(terminal.end(), 0)

    def test_the_layout_lives_while_the_program_runs_until_ctrl_c(self):
        terminal = self.session()
        terminal.command("display VW3300; layout on")
        terminal.type(ENDLESS + "\n")
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

    def test_the_layout_lives_at_the_pace_of_the_clock_where_scans_are_passed_over(self):
        for pace in (("--realtime",), ("--speed", "20")):
            terminal = self.session(SLAVE, *pace, size=(80, 24))
            terminal.command("layout on")
            terminal.type("continue 1000h\n")
            terminal.until("\n")
            shown = terminal.until(*["\x1b[1;1H", "scan "] * 5, "\x1b[2;1H")
            self.assertNotIn(PROMPT, shown, "while it runs")
            self.assertGreater(len(set(re.findall(r"scan (\d+)", shown))), 3, "it is another scan each time")
            terminal.signal(signal.SIGINT)
            terminal.until("interrupted by Ctrl-C", PROMPT)
            self.quit(terminal)

    def test_the_layout_after_ctrl_c_shows_what_was_executed(self):
        terminal = self.session()
        terminal.command("layout on")
        terminal.type(ENDLESS + "\n")
        terminal.until("\x1b[1;1H", "scan ", "\x1b[1;1H", "scan ")
        terminal.signal(signal.SIGINT)
        terminal.until("interrupted by Ctrl-C")
        shown = terminal.until("\x1b[1;1H", PROMPT)
        self.assertNotIn("interrupted while", shown)
        self.assertRegex(shown, r">.{0,8}line \d+ .*S0=[01]")
        self.quit(terminal)

    def test_a_run_says_which_signal_has_interrupted_it(self):
        terminal = self.session()
        terminal.type(ENDLESS + "\n")
        time.sleep(0.2)
        terminal.signal(signal.SIGTERM)
        self.assertEqual(terminal.end(), 1)
        self.assertIn("interrupted by SIGTERM", terminal.text)

    def test_a_signal_gives_the_terminal_back_too(self):
        for number, code in ((signal.SIGTERM, 1), (signal.SIGQUIT, -signal.SIGQUIT)):
            terminal = self.session()
            terminal.command("layout on")
            terminal.signal(number)
            self.assertEqual(terminal.end(), code)
            self.assertIn("\x1b[1;40r", terminal.text)

    def test_what_is_forced_or_wrong_is_red_and_stops_are_bold_unless_no_colour_is_wanted(self):
        terminal = self.session()
        self.assertIn("\x1b[31m  forced: Q0.0=1", terminal.command("force Q0.0=1; print Q0.0"))
        self.assertIn("\x1b[31munknown command 'frob'; did you mean fork?\x1b[0m", terminal.command("frob"))
        self.assertIn("\x1b[1mbreakpoint 1, hit for the first time\x1b[0m", terminal.command("break 82; continue"))
        self.assertIn(" \x1b[1m>\x1b[0m    82  ", terminal.command("step; rs"))
        self.quit(terminal)
        os.environ["NO_COLOR"] = "1"
        try:
            plain = subprocess.run([S7200, "debug", SLAVE, "-x", "break 82; force Q0.0=1; continue; print Q0.0"], capture_output=True, text=True)
        finally:
            del os.environ["NO_COLOR"]
        self.assertIn("  forced: Q0.0=1", plain.stdout)
        self.assertNotIn("\x1b", plain.stdout)


class Menu(unittest.TestCase):
    """s7200 master TARGET menu"""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def menu(self, *arguments, **more):
        terminal = Terminal(self.folder / "state", *(arguments or [SLAVE]), "menu", verb="master", **{"size": (80, 24), **more})
        terminal.until(">> ")
        return terminal

    def answer(self, terminal, line):
        """What it prints, up to the next prompt."""
        terminal.type(line + "\n")
        terminal.until("\n")
        return terminal.until(">> ")

    def quit(self, terminal, keys="q\n"):
        terminal.type(keys)
        self.assertEqual(terminal.end(), 0, terminal.text)
        self.assertIn("[1;24r", terminal.text.replace("\x1b", ""), "the terminal is as it was")

    def test_every_key_of_the_test_program_sends_its_function(self):
        functions = {"1 0 8": 1, "2 0 8": 2, "3 10 2": 3, "4 0 2": 4, "5 2 on": 5, "6 10 1234": 6, "7": 7, "8": 8, "f 0 1 0 1": 15,
                     "p 10 1 2": 16, "r": 17}
        terminal = Terminal(self.folder / "state", SLAVE, "menu", verb="master", size=(80, 24))
        self.assertIn("Enter follows each key", terminal.until(">> "))
        for keys, function in functions.items():
            with self.subTest(keys=keys):
                self.assertIn(f"station 1, function {function}", self.answer(terminal, keys))
        self.assertIn("16#0001      1", self.answer(terminal, "3 40011 1"), "what P has written")
        self.quit(terminal)
        gateway = self.menu("westinghouse:pc1200")
        self.assertIn("references of kind 16#33: 00 00", self.answer(gateway, "z 0 0 2"))
        self.assertIn("function 21", self.answer(gateway, "a 0 0 1 2"))
        self.quit(gateway)

    def test_a_key_asks_for_what_it_was_not_given(self):
        terminal = self.menu()
        for key, question in (("1", "first coil [0]: "), ("3", "first register [0]: "), ("6", "register [0]: ")):
            terminal.type(key + "\n")
            terminal.until(question)
            terminal.type("abc\n")
            self.assertIn("'abc'", terminal.until(question), "refused, and asked again")
            terminal.type("\x03")
            terminal.until(">> ")
        self.assertIn("station 1, function 8", self.answer(terminal, "8 16#1234"))
        self.assertIn("the keys are above", self.answer(terminal, "m"))
        terminal.type("3\n")
        terminal.until("first register [0]: ")
        terminal.type("10\n")
        terminal.until("how many [1]: ")
        terminal.type("\n")
        self.assertIn("holding register 10", terminal.until(">> "))
        self.assertIn("an answer is needed", self.answer(terminal, "6 1\n"))
        self.assertIn("holding registers 10…11", self.answer(terminal, "read 40011:2"), "actions do as well")
        for wrong, said in (("x", "'x' is not a key; M shows the menu"), ("3 frob 1", "frob"), ("7 5", "read exception status asks for nothing"), ("t 5", "asks for nothing"), ("8 x", "'x'"), ("5 3 maybe", "maybe"),
                            ("l x", "'x'"),
                            ("3 00003 1", "00003 is a coil, and this key is for holding"), ("3 40000 1", "there is no holding register 40000"),
                            ("3 40001:2", "'40001:2': write 40001 alone; what follows ':' is asked for by itself"),
                            ("frob", "'frob' is not an action"), ("s 300", "not a slave from 0 to 255")):
            self.assertIn(said, self.answer(terminal, wrong))
        self.quit(terminal)

    def test_slave_and_port_are_changed_and_seen(self):
        terminal = self.menu()
        terminal.type("s\n")
        terminal.until("slave [1]: ")
        terminal.type("300\n")
        terminal.until("'300' is not a slave from 0 to 255", "slave [1]: ")
        terminal.type("\n")
        terminal.until(">> ")
        self.assertIn("125", self.answer(terminal, "3 0 999"))
        self.assertNotIn("--beyond-limits", terminal.text, "an option can no longer be given")
        self.assertIn("slave 2", self.answer(terminal, "s 2"))
        self.assertIn("no answer", self.answer(terminal, "7"))
        self.answer(terminal, "s 1")
        self.assertIn("4800 baud", self.answer(terminal, "c 4800 8 even 1"))
        self.assertIn("no answer", self.answer(terminal, "8"))
        self.answer(terminal, "c 9600 8 even 1")
        self.assertIn("function 8", self.answer(terminal, "8"))
        self.answer(terminal, "s 2")
        self.assertIn("no answer", self.answer(terminal, "8"))
        self.answer(terminal, "s 1")
        terminal.type("t\n")
        terminal.until("until Ctrl-C", "1;1H", "requests", "1;1H")
        terminal.signal(signal.SIGINT)
        self.assertNotIn("no answer", terminal.until("requests", "latency", ">> "), "T goes to the slave that is set now")
        self.assertIn("is not none, even or odd", self.answer(terminal, "c 9600 8 mark 1"))
        self.quit(terminal)

    def test_the_continuous_test_counts_until_ctrl_c(self):
        terminal = self.menu()
        terminal.type("l\n")
        terminal.until("until Ctrl-C", "1;1H", "requests", "1;1H")
        terminal.signal(signal.SIGINT)
        shown = terminal.until("requests", "latency", ">> ")
        self.assertIn("0 wrong", shown)
        terminal.type("t\n")
        terminal.until("until Ctrl-C")
        terminal.type("\x03")
        terminal.until(">> ")
        self.answer(terminal, "n")
        self.assertIn("function 7", self.answer(terminal, "7"))
        self.quit(terminal, "\x04")

    def test_after_twenty_failures_further_ones_are_only_counted(self):
        terminal = self.menu(SLAVE, "--timeout", "20ms")
        self.answer(terminal, "s 2")
        terminal.type("l\n")
        shown = terminal.until("further failures are only counted", "1;1H")
        terminal.signal(signal.SIGINT)
        self.assertEqual(shown.count("no answer"), 20)
        terminal.until(">> ")
        self.quit(terminal)

    def test_ctrl_c_at_the_prompt_gives_a_new_one_and_a_polite_kill_ends_it(self):
        terminal = self.menu()
        terminal.type("3 1\x03")
        terminal.until(">> ")
        terminal.type("3\n")
        terminal.until("first register [0]: ")
        terminal.type("\x03")
        terminal.until(">> ")
        terminal.signal(signal.SIGTERM)
        self.assertEqual(terminal.end(), 1)
        self.assertIn("\x1b[1;24r", terminal.text, "the terminal is as it was")

    def test_a_small_terminal_has_no_keys_in_view_and_they_come_and_go_with_its_size(self):
        terminal = self.menu(size=(40, 10))
        self.assertIn("read holding registers", self.answer(terminal, "m"))
        self.assertIn("function 3", self.answer(terminal, "3 0 1"))
        terminal.resize(80, 24)
        terminal.until("\x1b[17;24r", "3  read holding registers", "T  test")
        terminal.resize(30, 8)
        terminal.until("menu needs a terminal of 40×10, and this one has 30×8")
        self.answer(terminal, "3 0 1")
        terminal.resize(80, 24)
        terminal.until("\x1b[17;24r", "read holding registers")
        self.quit(terminal)

    def test_a_terminal_that_is_too_small_and_none_at_all_are_errors(self):
        terminal = Terminal(self.folder / "state", SLAVE, "menu", verb="master", size=(39, 10))
        self.assertEqual(terminal.end(), 2)
        self.assertIn("menu needs a terminal of 40×10, and this one has 39×10", terminal.text)
        for arguments, said in ((["menu"], "menu needs a terminal for input and output"),
                                (["menu", "slave-id"], "menu stands alone"), (["menu", "--json"], "menu shows everything itself"),
                                (["menu", "--protocol", "ppi"], "menu needs --protocol modbus")):
            done = subprocess.run([S7200, "master", SLAVE, *arguments], capture_output=True, text=True, stdin=subprocess.DEVNULL)
            self.assertEqual(done.returncode, 2)
            self.assertIn(said, done.stderr)

    def test_a_slave_that_goes_is_tried_again(self):
        with subprocess.Popen([S7200, "run", SLAVE, "--modbus-tcp", "0"], stderr=subprocess.PIPE, text=True) as server:
            port = re.search(r":(\d+)", server.stderr.readline()).group(1)
            terminal = self.menu(f"modbus-tcp://127.0.0.1:{port}")
            self.assertIn("function 3", self.answer(terminal, "3 0 1"))
            self.assertIn("the port belongs to the other end", self.answer(terminal, "c"))
            server.send_signal(signal.SIGINT)
            server.wait()
            server.stderr.close()
        self.answer(terminal, "3 0 1")
        self.assertIn("refused", self.answer(terminal, "3 0 1"))
        self.quit(terminal)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[3:]])
