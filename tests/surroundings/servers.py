#!/usr/bin/env python3
"""The rules of tools/host/net/server_rules.hpp, with each server that the help lists: servers.py S7200 SOURCE_DIR

Whatever takes [ADDRESS:]PORT is a server. Nothing here depends on how fast the computer is: what has to come is waited for.
"""
import contextlib
import json
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest

S7200, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SLAVE = SOURCE / "stl_programs/modbus_slave.stl"
LONG = 120  # seconds, for what has to come
PAGE = (b"POST /any HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://example.org\r\nContent-Type: text/plain\r\n"
        b"Content-Length: %d\r\n\r\n")


def servers():
    """[(its name, the words of a command line that starts it)]"""
    found = []
    for verb, words in (("dap", ["dap"]), ("run", ["run", str(SLAVE)])):
        text = subprocess.run([S7200, verb, "--help-all"], capture_output=True, check=True, text=True, timeout=LONG).stdout
        for option in re.findall(r"(?m)^ +--([-\w]+) \[ADDRESS:\]PORT", text):
            if verb == "run" or option == "listen":
                found.append((option, [*words, "--" + option]))
    return found


def framed(content):
    content = content if isinstance(content, bytes) else json.dumps(content).encode()
    return b"Content-Length: %d\r\n\r\n%s" % (len(content), content)


def request(seq, command, **arguments):
    return framed({"seq": seq, "type": "request", "command": command, "arguments": arguments})


class Server:
    def __init__(self, words, *more, place="0", folder=None):
        self.process = subprocess.Popen([S7200, *words, place, *map(str, more)], stdin=subprocess.DEVNULL, cwd=folder,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.first = self.process.stderr.readline().decode()
        while self.process.poll() is None and "listening on" not in self.first:
            self.first = self.process.stderr.readline().decode()
        self.address = re.search(r"listening on ([\d.]+):(\d+)", self.first)
        self.token = (re.search(r'"token": "(\w+)"', self.first) or [None, None])[1]

    def connect(self, *chunks):
        client = socket.create_connection((self.address[1], int(self.address[2])), timeout=LONG)
        for chunk in chunks:
            client.sendall(chunk)
        return client

    def said(self, wanted):
        """The line of its messages that has this; lines before it are skipped."""
        for line in self.process.stderr:
            if wanted in line.decode():
                return line.decode()
        return ""

    def end(self):
        self.process.terminate()
        rest = self.process.communicate(timeout=LONG)
        return rest[0].decode(), rest[1].decode()


def heard(client):
    """All that comes until the server ends the connection."""
    data = b""
    try:
        while chunk := client.recv(65536):
            data += chunk
    except ConnectionResetError:
        pass
    client.close()
    return data


def messages(data):
    found = []
    while data:
        header, data = data.split(b"\r\n\r\n", 1)
        size = int(header.split(b":")[1])
        found.append(json.loads(data[:size]))
        data = data[size:]
    return found


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def start(self, words, *more, **options):
        server = Server(words, *more, **options)
        self.addCleanup(lambda: server.process.poll() is None and (server.process.kill(), server.process.communicate()))
        self.assertTrue(server.address, server.first)
        return server


class AllServers(Case):
    def test_there_are_some(self):
        names = [name for name, _ in servers()]
        for name in ("listen", "tcp", "rtu-over-tcp", "modbus-tcp"):
            self.assertIn(name, names)

    def test_without_an_address_it_serves_this_computer_only(self):
        for name, words in servers():
            with self.subTest(name):
                server = self.start(words)
                self.assertTrue(server.address[1].startswith("127."), server.first)
                server.end()

    def test_a_web_page_is_disconnected_and_nothing_is_done_for_it(self):
        frame = bytes.fromhex("0106000a1234a4c1") + bytes.fromhex("000100000006010600 0a1234".replace(" ", ""))
        bodies = (b"", frame * 40, framed({"seq": 1, "type": "request", "command": "initialize"}), b"x" * 5000 + frame)
        for name, words in servers():
            for body in bodies:
                for head in (PAGE % len(body), b"GET / HTTP/1.1\r\nHost: x\r\n\r\n", b"OPTIONS /" + b"a" * 3000 + b" HTTP/1.1\r\n\r\n"):
                    with self.subTest(name=name, head=head[:20], body=body[:20]):
                        server = self.start(words, *([] if name == "listen" else ["--dump", "VW20"]))
                        self.assertEqual(heard(server.connect(head + body)), b"")
                        self.assertIn("HTTP, as a web page does", server.said("HTTP"))
                        out, _ = server.end()
                        if name != "listen":
                            self.assertRegex(out, r"VW20\s+(16#0000|0)|VW20.*\b0\b")

    def test_after_a_web_page_others_are_served(self):
        for name, words in servers():
            with self.subTest(name):
                server = self.start(words)
                heard(server.connect(PAGE % 0))
                good = {"listen": request(1, "initialize"), "modbus-tcp": bytes.fromhex("0001000000060103000a0001")}.get(
                    name, bytes.fromhex("0103000a0001a408"))
                until = time.monotonic() + LONG
                with server.connect() as client:
                    client.settimeout(0.5)
                    self.assertTrue(self.answers(client, good, until))
                server.end()

    @staticmethod
    def answers(client, good, until):
        """On the raw line a frame is lost that comes before the program has set its port."""
        while time.monotonic() < until:
            client.sendall(good)
            try:
                return client.recv(1)
            except TimeoutError:
                continue
        return b""


class Dap(Case):
    LISTEN = ["dap", "--listen"]

    def test_what_is_no_header_ends_the_connection_and_is_said(self):
        server = self.start(self.LISTEN)
        for stream in (b"hello", b"\x16\x03\x01\x02\x00\x01", b"{\"seq\":1}", b"content-lengt_", b"\r\nContent-Length: 2\r\n\r\n{}"):
            with self.subTest(stream):
                self.assertEqual(heard(server.connect(stream)), b"")
                self.assertIn("not the Debug Adapter Protocol", server.said("disconnected"))
        for stream in (b"Content-Length: two\r\n\r\n", b"Content-Type: x\r\n\r\n{}", framed(b"no json"), framed(b"[1]"),
                       framed(b"[" * 100000 + b"]" * 100000), b"Content-Length: 99999999999\r\n\r\n"):
            with self.subTest(stream[:40]):
                self.assertEqual(heard(server.connect(stream)), b"")
                self.assertTrue(server.said("disconnected"))
        server.end()

    def test_the_first_request_is_initialize(self):
        server = self.start(self.LISTEN)
        for first in (request(1, "launch", program=str(SLAVE), token=server.token), request(1, "evaluate", expression="VW0"),
                      framed({"seq": 1, "type": "event", "event": "x"}), framed({})):
            with self.subTest(first):
                for message in messages(heard(server.connect(first, request(2, "threads")))):
                    self.assertFalse(message["success"])
                self.assertIn("is not the request initialize", server.said("disconnected"))
        server.end()

    def test_without_the_token_nothing_is_launched_written_or_opened(self):
        server = self.start(self.LISTEN, "--allow", "trace,memory", folder=self.folder)
        launch = {"program": str(SLAVE), "trace": "owned.txt", "memory": "owned.json"}
        for token in ({}, {"token": ""}, {"token": "0" * 32}, {"token": server.token[:-1]}, {"token": server.token + "0"}, {"token": 5},
                      {"token": [server.token]}):
            with self.subTest(token):
                answers = messages(heard(server.connect(request(1, "initialize"), request(2, "launch", **launch, **token),
                                                        request(3, "configurationDone"))))
                self.assertEqual([(m["command"], m["success"]) for m in answers], [("initialize", True), ("launch", False)])
                self.assertIn("token", answers[1]["message"])
                self.assertNotIn(server.token, json.dumps(answers))
                self.assertIn("token", server.said("disconnected"))
        self.assertEqual(list(self.folder.iterdir()), [])
        server.end()

    def launched(self, server, **arguments):
        """The answer to a launch with the right token, in a session that ends."""
        data = heard(server.connect(request(1, "initialize"), request(2, "launch", token=server.token, **arguments),
                                    request(3, "disconnect")))
        return next(m for m in messages(data) if m.get("command") == "launch")

    def test_a_launch_writes_and_opens_only_what_the_command_line_allows(self):
        server = self.start(self.LISTEN, "--allow", "trace", folder=self.folder)
        text = subprocess.run([S7200, "debug", "--help-all"], capture_output=True, check=True, text=True, timeout=LONG).stdout
        writing = set(re.findall(r"(?m)^  --([-\w]+) FILE\S*\s+.*(?:\n {30}.*)?\b(?:write|written)\b", text))
        opening = set(re.findall(r"(?m)^  --([-\w]+) (?:\[ADDRESS:\]PORT|LINK|DEVICE)", text))
        self.assertGreaterEqual(writing | opening, {"trace", "output", "memory", "capture", "pty", "device", "tcp"})
        for name in sorted((writing | opening) - {"trace"}):
            with self.subTest(name):
                value = "0" if name in ("tcp", "modbus-tcp", "rtu-over-tcp") else str(self.folder / "owned.pcap")
                answer = self.launched(server, program=str(SLAVE), **{name: value})
                self.assertFalse(answer["success"])
                self.assertIn(f"--allow {name}", answer["message"])
        self.assertEqual(list(self.folder.iterdir()), [])
        self.assertTrue(self.launched(server, program=str(SLAVE), trace="run.trace")["success"])
        self.assertTrue((self.folder / "run.trace").exists())
        server.end()

    def typed(self, server, line):
        """What the console answers to a line, in a session that ends."""
        data = heard(server.connect(request(1, "initialize"), request(2, "launch", token=server.token, program=str(SLAVE), stopOnEntry=True),
                                    request(3, "configurationDone"), request(4, "evaluate", expression=line, context="repl"),
                                    request(5, "disconnect")))
        return next(m for m in messages(data) if m.get("command") == "evaluate")

    def test_commands_read_and_write_files_only_if_the_command_line_allows_it(self):
        server = self.start(self.LISTEN, folder=self.folder)
        for command in ("save owned.json", "load /etc/passwd"):
            with self.subTest(command):
                self.assertIn("--allow files", self.typed(server, command)["message"])
        self.assertEqual(list(self.folder.iterdir()), [])
        server.end()
        server = self.start(self.LISTEN, "--allow", "files", folder=self.folder)
        self.assertTrue(self.typed(server, "save kept.json")["success"])
        self.assertTrue((self.folder / "kept.json").exists())
        server.end()

    def test_a_system_file_writes_and_opens_no_more(self):
        system = self.folder / "system.yaml"
        system.write_text(f"plcs: {{a: {{program: {SLAVE}}}}}\nbridges: {{b: {{tcp: 0}}}}\nlines: {{l: {{stations: [a, b], capture: [l.pcap]}}}}\n",
                          encoding="utf-8")
        server = self.start(self.LISTEN)
        self.assertIn("--allow tcp", self.launched(server, program=str(system))["message"])
        server.end()
        server = self.start(self.LISTEN, "--allow", "tcp")
        self.assertIn("--allow capture", self.launched(server, program=str(system))["message"])
        self.assertEqual([path.name for path in self.folder.iterdir()], ["system.yaml"])
        server.end()

    def test_with_a_program_no_other_is_launched(self):
        other = self.folder / "other.stl"
        other.write_text("LD SM0.0\nMEND\n", encoding="utf-8")
        server = self.start(self.LISTEN, SLAVE)
        for program in (str(other), [str(SLAVE), str(other)], "/etc/passwd", "missing.stl"):
            with self.subTest(program):
                answer = self.launched(server, program=program)
                self.assertIn("is not what this server was started with", answer["message"])
        self.assertTrue(self.launched(server, program=f"{SLAVE.parent}/./{SLAVE.name}")["success"])
        server.end()

    def test_clients_wait_their_turn_and_a_silent_one_is_dropped(self):
        server = self.start(self.LISTEN, SLAVE)
        silent = server.connect()
        slow = server.connect(b"Content-Length: 5")
        waiting = [server.connect(request(1, "initialize"), request(2, "attach", token=server.token), request(3, "disconnect"))
                   for _ in range(3)]
        self.assertEqual(heard(silent), b"")
        self.assertEqual(heard(slow), b"")
        for client in waiting:
            self.assertTrue([m for m in messages(heard(client)) if m.get("command") == "attach" and m["success"]])
        _, error = server.end()
        self.assertEqual(error.count("a client said nothing for 10 s"), 2, error)

    def test_a_client_that_was_let_in_may_be_silent(self):
        server = self.start(self.LISTEN, SLAVE)
        with server.connect(request(1, "initialize"), request(2, "attach", token=server.token, stopOnEntry=True),
                            request(3, "configurationDone")) as client:
            time.sleep(11)
            client.sendall(request(4, "evaluate", expression="1+1") + request(5, "disconnect"))
            self.assertTrue([m for m in messages(heard(client)) if m.get("command") == "evaluate" and m["success"]])
        server.end()

    def test_the_token_may_come_from_a_file(self):
        path = self.folder / "token"
        path.write_text("correct horse battery\n", encoding="utf-8")
        server = self.start(self.LISTEN, SLAVE, "--token-file", path)
        self.assertNotIn("correct", server.first)
        server.token = "correct horse battery"
        self.assertTrue(self.launched(server, program=str(SLAVE))["success"])
        server.end()
        for text in ("", "short\n", "\n" + "x" * 40):
            path.write_text(text, encoding="utf-8")
            done = subprocess.run([S7200, *self.LISTEN, "0", "--token-file", path], capture_output=True, check=False, timeout=LONG)
            self.assertEqual(done.returncode, 2)
            self.assertIn(b"is not a token of 16 characters or more", done.stderr)

    def test_a_flood_of_messages_needs_no_more_memory_than_a_few(self):
        server = self.start(self.LISTEN, SLAVE)
        with server.connect(request(1, "initialize"), request(2, "attach", token=server.token)) as client:
            heard_first = client.recv(1)
            self.assertTrue(heard_first)
            flood = request(3, "evaluate", expression="1" + "+1" * 20000)
            client.settimeout(2)
            try:
                for _ in range(4000):  # 160 MB, and none of the answers is read
                    client.sendall(flood)
            except (TimeoutError, ConnectionError):
                pass
            status = pathlib.Path(f"/proc/{server.process.pid}/status").read_text(encoding="utf-8")
            self.assertLess(int(re.search(r"VmHWM:\s+(\d+)", status)[1]), 150_000)
        server.end()


class Page:
    """`s7200 view`, and what a browser of this computer sends it."""

    def __init__(self, *more):
        self.process = subprocess.Popen([S7200, "view", SLAVE, *map(str, more)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.windows = []
        self.address = self.process.stdout.readline().decode().strip()
        self.host, self.token = re.fullmatch(r"http://([\d.]+:\d+)/(\w+)/", self.address).groups()

    def connect(self):
        return socket.create_connection(self.host.split(":"), timeout=LONG)

    def asks(self, path, method="GET", **headers):
        """(status, headers, body)"""
        lines = {"Host": self.host} | {name.replace("_", "-"): value for name, value in headers.items()}
        client = self.connect()
        client.sendall((f"{method} {path} HTTP/1.1\r\n" + "".join(f"{name}: {value}\r\n" for name, value in lines.items()) + "\r\n").encode())
        head, _, body = heard(client).partition(b"\r\n\r\n")
        return int(head.split()[1]), head.decode().lower(), body

    def opens(self, path=None, **headers):
        """A WebSocket, or the status that refuses it."""
        client = self.connect()
        lines = {"Host": self.host, "Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
                 "Sec-WebSocket-Key": "AQIDBAUGBwgJCgsMDQ4PEA=="} | headers
        client.sendall((f"GET {path or '/' + self.token + '/socket'} HTTP/1.1\r\n"
                        + "".join(f"{name}: {value}\r\n" for name, value in lines.items()) + "\r\n").encode())
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            byte = client.recv(1)
            if not byte:
                break
            head += byte
        status = int(head.split()[1])
        if status != 101:
            client.close()
            return status
        self.windows.append(client)
        return Window(client)

    def end(self):
        for client in self.windows:
            client.close()
        return Server.end(self)

    said = Server.said


class Window:
    """A WebSocket of the page."""

    def __init__(self, client):
        self.client = client

    def send(self, text, opcode=1):
        data = text if isinstance(text, bytes) else text.encode()
        size = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + len(data).to_bytes(2, "big") if len(data) < 65536 else \
            b"\xff" + len(data).to_bytes(8, "big")
        self.client.sendall(bytes([0x80 | opcode]) + size + b"\0\0\0\0" + data)  # a mask of zeros

    def take(self, count):
        data = b""
        while len(data) < count:
            more = self.client.recv(count - len(data))
            if not more:
                raise ConnectionResetError
            data += more
        return data

    def message(self):
        while True:
            opcode, size = self.take(2)
            size = int.from_bytes(self.take(2 if size == 126 else 8), "big") if size > 125 else size
            data = self.take(size)
            if opcode & 15 == 1:
                return json.loads(data)

    def until(self, wanted):
        while True:
            message = self.message()
            if wanted(message):
                return message

    def asks(self, number, command):
        self.send(json.dumps({"id": number, "command": command}))
        return self.until(lambda message: message.get("id") == number)

    def is_closed(self):
        try:
            while self.client.recv(65536):
                pass
        except ConnectionResetError:
            pass
        self.client.close()
        return True


class View(Case):
    def page(self, *more):
        page = Page(*more)
        self.addCleanup(lambda: page.process.poll() is None and (page.process.kill(), page.process.communicate()))
        return page

    def test_the_page_comes_with_the_token_and_allows_nothing_from_elsewhere(self):
        page = self.page()
        status, head, body = page.asks(f"/{page.token}/")
        self.assertEqual(status, 200)
        self.assertIn(b"<html", body)
        self.assertIn("content-security-policy: default-src 'none'", head)
        for word in ("http:", "https:", "*", "unsafe-inline", "'unsafe-eval'"):
            self.assertNotIn(word, head.split("content-security-policy: ")[1].split("\r\n")[0])
        self.assertEqual(page.asks(f"/{page.token}/", method="HEAD")[2], b"")
        page.end()

    def test_without_the_token_there_is_nothing(self):
        page = self.page()
        for path in ("/", "/socket", "/page.js", f"/{page.token[:-1]}/", f"/{page.token}0/", f"/x/{page.token}/", "/../etc/passwd",
                     f"/{page.token}"):
            with self.subTest(path):
                status, _, body = page.asks(path)
                self.assertEqual(status, 404)
                self.assertNotIn(page.token.encode(), body)
        for path in ("/socket", f"/{'0' * 32}/socket"):
            self.assertEqual(page.opens(path), 404)
        for path in ("missing.js", "../page.js", "%2e%2e/passwd", "socket"):
            self.assertEqual(page.asks(f"/{page.token}/{path}")[0], 404)
        page.end()

    def test_another_origin_and_another_host_are_refused(self):
        page = self.page()
        good = f"http://{page.host}"
        for headers in ({"Origin": "http://example.org"}, {"Origin": "null"}, {"Origin": good + ".example.org"}, {"Origin": good.replace("http", "https")},
                        {"Host": "example.org"}, {"Host": "127.0.0.1"}, {"Host": page.host + "0"}, {"Origin": ""}):
            with self.subTest(headers):
                self.assertEqual(page.opens(**headers), 403)
                self.assertEqual(page.asks(f"/{page.token}/", **headers)[0], 403)
                self.assertIn("disconnected", page.said("disconnected"))
        self.assertEqual(page.opens(Origin=good).message()["event"], "hello")
        page.end()

    def test_what_is_no_request_ends_the_connection(self):
        page = self.page()
        for stream in (b"hello\r\n\r\n", b"\x16\x03\x01\x02\x00\x01" * 10 + b"\r\n", b"Content-Length: 2\r\n\r\n{}", b"GET / HTTP/1.1\r\nA: " + b"b" * 20000):
            with self.subTest(stream[:20]):
                client = page.connect()
                client.sendall(stream)
                self.assertEqual(heard(client), b"")
                self.assertIn("HTTP", page.said("disconnected"))
        for method in ("POST", "PUT", "OPTIONS"):
            self.assertEqual(page.asks(f"/{page.token}/", method=method, Content_Length="0")[0], 405)
        page.end()

    def test_several_windows_see_the_same_and_one_that_leaves_changes_nothing(self):
        page = self.page()
        one, other = page.opens(), page.opens()
        for window in (one, other):
            hello = window.message()
            self.assertEqual((hello["event"], hello["protocol"], hello["cpu"]), ("hello", 1, "214"))
        reply = one.asks(7, "scan 3")
        self.assertTrue(reply["moved"])
        moved = other.until(lambda message: message.get("event") == "moved" and message["by"] == "scan 3")
        one.send(json.dumps({"id": 8, "command": "continue 1s"}))
        other.until(lambda message: message.get("event") == "running" and message["command"] == "continue 1s")
        one.client.close()
        now = other.asks(1, "past")["json"]
        self.assertGreater(now["now_ns"], moved["now"]["now_ns"])
        page.end()

    def test_what_is_no_message_is_said_to_be_none(self):
        page = self.page()
        window = page.opens()
        for text in ("no json", "[1]", "{}", '{"id": 1}', '{"id": 1, "command": 5}', "[" * 1000 + "]" * 1000):
            window.send(text)
            reply = window.until(lambda message: "error" in message)
            self.assertIsNone(reply["id"])
        self.assertEqual(window.asks(3, "nonsense")["error"], "unknown command 'nonsense'; 'help' lists them")
        page.end()

    def test_messages_are_bounded(self):
        page = self.page()
        for text, opcode, why in (("x" * (1 << 20) + "x", 1, "more than 1048576 bytes"), (b"\1\2", 2, "not text")):
            window = page.opens()
            window.message()
            with contextlib.suppress(ConnectionError):
                window.send(text, opcode)
            self.assertTrue(window.is_closed())
            self.assertIn(why, page.said("disconnected"))
        page.end()

    def test_a_flood_and_a_client_that_does_not_read_have_to_go_and_slow_nothing(self):
        page = self.page()
        flood, other = page.opens(), page.opens()
        flood.client.settimeout(5)
        try:
            for number in range(200_000):
                flood.send(json.dumps({"id": number, "command": "help"}))
        except (TimeoutError, ConnectionError):
            pass
        self.assertIn("waiting", page.said("disconnected"))
        self.assertEqual(other.asks(1, "expect VB0 = VB0").get("error"), None)
        status = pathlib.Path(f"/proc/{page.process.pid}/status").read_text(encoding="utf-8")
        self.assertLess(int(re.search(r"VmHWM:\s+(\d+)", status)[1]), 200_000)
        page.end()

    def test_a_run_is_stopped_by_any_window(self):
        page = self.page("--realtime")
        one, other = page.opens(), page.opens()
        one.send(json.dumps({"id": 1, "command": "continue 1h"}))
        other.until(lambda message: message.get("event") == "running")
        self.assertIsNone(other.asks(2, "set VW1000=7").get("error"))  # while it goes on
        other.send(json.dumps({"stop": True}))
        self.assertTrue(one.until(lambda message: message.get("id") == 1)["interrupted"])
        self.assertEqual(one.asks(3, "values VW1000")["json"]["values"][0]["number"], 7)
        page.end()

    def test_commands_read_and_write_files_only_if_the_command_line_allows_it(self):
        page = self.page()
        self.assertIn("s7200 view --files does", page.opens().asks(1, f"save {self.folder}/owned.json")["error"])
        self.assertEqual(list(self.folder.iterdir()), [])
        page.end()
        page = self.page("--files")
        window = page.opens()
        self.assertEqual(window.message()["may"], ["files"])
        self.assertIsNone(window.asks(1, f"save {self.folder}/kept.json").get("error"))
        self.assertTrue((self.folder / "kept.json").exists())
        page.end()

    def test_it_serves_this_computer_only_and_tokens_fit_an_address(self):
        for more, why in ((["--listen", "0.0.0.0:0"], b"only this computer itself is served"), (["--listen", "x"], b"--listen x")):
            done = subprocess.run([S7200, "view", SLAVE, *more], capture_output=True, check=False, timeout=LONG)
            self.assertEqual(done.returncode, 2)
            self.assertIn(why, done.stderr)
        path = self.folder / "token"
        path.write_text("correct horse battery\n", encoding="utf-8")
        done = subprocess.run([S7200, "view", SLAVE, "--token-file", path], capture_output=True, check=False, timeout=LONG)
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"a part of an address", done.stderr)

    def test_it_ends_with_a_farewell(self):
        page = self.page()
        window = page.opens()
        window.message()
        page.process.terminate()
        self.assertEqual(window.until(lambda message: message.get("event") == "ended")["why"], "the server ends")
        page.end()
        self.assertEqual(page.process.returncode, 0)
        page = self.page()
        page.opens().asks(1, "quit")
        page.process.wait(timeout=LONG)
        page.end()
        self.assertEqual(page.process.returncode, 0)


if __name__ == "__main__":
    del sys.argv[1:]
    unittest.main(verbosity=0)
