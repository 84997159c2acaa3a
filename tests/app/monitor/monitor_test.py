#!/usr/bin/env python3
"""The monitoring platform as its users meet it: what it takes, what it refuses, and that it lives through all of it.

usage: monitor_test.py PATROL
"""
import fcntl
import json
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from monitoring import Platform, PlatformCase, event, is_closed, lining, result  # noqa: E402

PATROL = pathlib.Path(sys.argv[1])
MANY = 100_000


class Refusals(PlatformCase):
    def tearDown(self):
        self.assertEqual(self.platform.get("/api/history?kind=")["results"], [], "something was stored")

    def refuse(self, status, method, path, body=None, token=None, says="", **headers):
        got, answer = self.platform.ask(method, path, body, token, **headers)
        self.assertEqual(got, status, answer)
        self.assertIn(says, json.loads(answer)["error"])
        self.assertNotIn("\n", json.loads(answer)["error"])
        self.assertIn(f" {status} {method} ", self.platform.log.read_text().splitlines()[-1])

    def test_missing_or_wrong_token(self):
        body = json.dumps(event(1))
        self.refuse(401, "POST", "/api/results", body)
        self.refuse(401, "POST", "/api/results", body, "0123456789abcdef0123456789abcdef")
        self.refuse(401, "POST", "/api/results", body, self.platform.token[:-1])
        self.refuse(401, "POST", "/api/alarms/1/acknowledge", '{"who": "x", "note": ""}')

    def test_malformed_bodies(self):
        token = self.platform.token
        for body in ("", "{", "null", "7", "[[]]", "\x00", json.dumps(event(1))[:-1], json.dumps({**event(1), "extra": 1}), json.dumps([event(1), {**event(2), "time_s": "now"}])):
            self.refuse(400, "POST", "/api/results", body.encode(), token)
        self.refuse(400, "POST", "/api/results", b'{"id": "\xff\xfe"}', token)
        self.refuse(400, "POST", "/api/results", json.dumps(event(1)).replace("640.0", "1e999"), token, says="number out of range")
        self.refuse(400, "POST", "/api/results", json.dumps([event(i) for i in range(1001)]), token, says="at most 1000 results")

    def test_an_oversized_body_with_and_without_its_size(self):
        self.refuse(413, "POST", "/api/results", b"x" * 8_100_000, self.platform.token)
        self.refuse(413, "POST", "/api/results", iter([b"x" * 1_000_000] * 9), self.platform.token)

    def test_paths_that_lead_out(self):
        for path in ("/../token", "/..%2ftoken", "/%2e%2e/token", "/page.css/../../token", "/api/maps/../../token", "/token", "/results.sqlite", "/api/maps/1;x"):
            self.refuse(404, "GET", path)

    def test_wrong_methods(self):
        for method, path in (("GET", "/api/results"), ("DELETE", "/api/results"), ("PUT", "/api/robots"), ("POST", "/"), ("POST", "/schema")):
            self.refuse(405, method, path, token=self.platform.token)

    def test_a_parameter_that_is_no_number(self):
        self.refuse(400, "GET", "/api/changes?since=x", says="since must be an integer")
        self.refuse(400, "GET", "/api/history?before=-1")

    def test_slow_clients_are_given_up_and_keep_nobody_waiting(self):
        slow = [socket.create_connection(("127.0.0.1", self.platform.port)) for _ in range(200)]
        for connection in slow:
            connection.sendall(b"POST /api/results HTTP/1.1\r\nHost: x\r\n")
        begin = time.monotonic()
        while time.monotonic() - begin < 3.0:
            for connection in slow:
                connection.sendall(b"A: b\r\n")
            asked = time.monotonic()
            self.platform.get("/api/changes?since=0")
            self.assertLess(time.monotonic() - asked, 1.0)
            time.sleep(0.3)
        self.assertTrue(all(is_closed(connection, 8.0) for connection in slow))
        for connection in slow:
            connection.close()
        self.assertIn("incomplete header after 5 s", self.platform.log.read_text())

    def test_a_log_line_stays_one_line(self):
        before = len(self.platform.log.read_text().splitlines())
        self.refuse(400, "POST", "/api/results", json.dumps({**event(1), "a\nb\x1b[31m": 1}), self.platform.token)
        self.assertEqual(len(self.platform.log.read_text().splitlines()), before + 1)
        self.assertNotIn("\x1b", self.platform.log.read_text())


    def test_another_host_name(self):
        self.refuse(421, "GET", "/api/robots", says="unknown: must be", Host="evil.example")
        self.refuse(421, "POST", "/api/results", "[]", self.platform.token, Host="evil.example:80")
        self.assertEqual(self.platform.ask("GET", "/api/robots", Host="localhost:80")[0], 200)


class Output(unittest.TestCase):
    """The platform lives on when its log cannot be written."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)

    def serve(self, redirection, **more):
        """Starts a platform whose stderr goes elsewhere, on a port of its own."""
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        command = f'exec "{PATROL}" monitor --port {port} --data-dir "{self.path / "data"}" {redirection}'
        process = subprocess.Popen(["sh", "-c", command], **more)
        self.addCleanup(lambda: (process.kill(), process.wait()))
        return process, port

    def check(self, process, port):
        for i in range(200):
            try:
                with socket.create_connection(("127.0.0.1", port), timeout=10) as connection:
                    connection.sendall(b"GET /nothing HTTP/1.1\r\nHost: localhost\r\n\r\n")  # a line for the log
                    self.assertTrue(connection.recv(100).startswith(b"HTTP/1.1 404 "))
            except ConnectionRefusedError:
                self.assertLess(i, 150)
                self.assertIsNone(process.poll())
                time.sleep(0.1)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=10), 0)

    def test_stderr_closed(self):
        self.check(*self.serve("2>&-"))
        self.assertEqual((self.path / "data/lock").read_bytes(), b"", "the log went into another file")

    def test_stderr_full(self):
        self.check(*self.serve("2>/dev/full"))

    def test_the_reader_of_stderr_gone(self):
        process, port = self.serve("", stderr=subprocess.PIPE)
        process.stderr.close()
        self.check(process, port)

    def test_nobody_reads_stderr(self):
        process, port = self.serve("", stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        fcntl.fcntl(process.stderr, fcntl.F_SETPIPE_SZ, 4096)
        self.check(process, port)


class Names(PlatformCase):
    def test_names_of_sql_and_html_are_names(self):
        for i, name in enumerate(("Robert'); DROP TABLE results;--", "<script>alert(1)</script>", "../../etc/passwd", "\u202egnirts", "x" * 150)):
            self.assertEqual(self.platform.post(event(i, robot=name, subject=name, text=name))[0], 200)
            self.assertIn(name, [robot["robot"] for robot in self.platform.get("/api/robots")["robots"]])
        self.assertEqual(len(self.platform.get("/api/history?limit=100")["results"]), 5)


class Lives(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.platform = Platform(PATROL, self.path / "data")
        self.addCleanup(lambda: self.platform.kill())

    def test_a_second_one_on_the_same_directory_is_refused(self):
        done = subprocess.run([PATROL, "monitor", "--port", "0", "--data-dir", self.path / "data"], capture_output=True, text=True, timeout=20)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("in use by another patrol monitor", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_a_port_that_is_taken_is_refused(self):
        done = subprocess.run([PATROL, "monitor", "--port", str(self.platform.port), "--data-dir", self.path / "other"], capture_output=True, text=True, timeout=20)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("Address already in use", done.stderr)

    def test_it_ends_at_once_when_it_is_asked_to(self):
        self.assertEqual(self.platform.stop(), 0)

    def test_what_it_acknowledged_is_there_after_kill_9(self):
        for i in range(50):
            self.assertEqual(self.platform.post(event(i))[0], 200)
        self.platform.kill()
        self.platform.start()
        self.assertEqual(len(self.platform.get("/api/history?limit=200")["results"]), 50)
        self.assertEqual(json.loads(self.platform.post(event(7))[1])["results"][0]["status"], "known")

    def test_a_conflict_changes_nothing(self):
        self.platform.post(event(1, text="first"))
        status, answer = self.platform.post([event(1, text="second"), event(2)])
        self.assertEqual((status, [one["status"] for one in json.loads(answer)["results"]]), (409, ["conflict", "stored"]))
        self.assertEqual([one["data"]["text"] for one in self.platform.get("/api/history")["results"]], ["Leak at well_1.", "first"])

    def test_the_page_is_quick_and_memory_flat_with_a_hundred_thousand_results(self):
        def fill(start, end):
            batch = []
            for i in range(start, end):
                robot = f"robot-{i % 20}"
                one = (lining(i, 3.0 + i % 10, robot=robot) if i % 500 == 0 else event(i, "gas_measured", f"well_{i % 5}", value=float(i % 50), robot=robot) if i % 10 == 0 else
                       event(i, robot=robot) if i % 101 == 0 else result(i, robot=robot))
                batch.append(one)
                if len(batch) == 1000:
                    self.assertEqual(self.platform.post(batch)[0], 200)
                    batch = []

        fill(0, MANY // 2)
        half_mb = self.platform.resident_mb()
        fill(MANY // 2, MANY)
        slowest = {}
        for path in ("/api/changes?since=0", "/api/robots", "/api/alarms", "/api/alarms?open=1", "/api/run?robot=robot-1", "/api/run?robot=robot-0", "/api/lining?world=tunnel",
                     "/api/water?world=tunnel", "/api/gas?world=street", "/api/history", "/api/history?before=50000", "/api/history?robot=robot-3", "/api/history?kind=lining",
                     "/api/history?robot=robot-3&kind=pose&before=40000", "/api/history?robot=nobody"):
            times = []
            for _ in range(5):
                begin = time.monotonic()
                self.platform.get(path)
                times.append(1e3 * (time.monotonic() - begin))
            slowest[path] = sorted(times)[2]
        all_mb = self.platform.resident_mb()
        print({path: round(ms, 1) for path, ms in slowest.items()}, f"memory {half_mb:.1f} MB at half, {all_mb:.1f} MB at the end")
        self.assertLess(max(slowest.values()), 100.0, slowest)
        self.assertLess(all_mb - half_mb, 10.0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"] + sys.argv[2:])
