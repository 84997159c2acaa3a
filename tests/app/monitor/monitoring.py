"""A monitoring platform as a process of its own, for tests: started, asked, killed, started again on the same port."""
import datetime
import http.client
import json
import os
import pathlib
import re
import select
import signal
import subprocess
import sys
import tempfile
import time
import unittest


class Platform:
    def __init__(self, patrol, folder, port=0):
        self.patrol, self.folder, self.port = patrol, folder, port
        self.process, self.log = None, folder.parent / (folder.name + ".log")
        self.start()

    def start(self):
        environment = {name: value for name, value in os.environ.items() if name != "PATROL_TOKEN"}
        with open(self.log, "a") as log:
            at = log.tell()
            self.process = subprocess.Popen([self.patrol, "monitor", "--port", str(self.port), "--data-dir", self.folder], stderr=log, env=environment)
        for _ in range(300):
            said = re.search(r"monitor listening at http://127.0.0.1:(\d+)/", self.log.read_text()[at:])
            if said:
                self.port = int(said.group(1))
                return
            if self.process.poll() is not None:
                break
            time.sleep(0.05)
        raise RuntimeError(self.log.read_text())

    def kill(self):
        self.process.kill()
        self.process.wait()

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=10)

    @property
    def url(self):
        return f"http://127.0.0.1:{self.port}"

    @property
    def token_file(self):
        return self.folder / "token"

    @property
    def token(self):
        return self.token_file.read_text().strip()

    def ask(self, method, path, body=None, token=None, **headers):
        """(status, body)"""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        if token:
            headers["Authorization"] = "Bearer " + token
        connection.request(method, path, body, headers)
        answer = connection.getresponse()
        content = answer.read().decode(errors="replace")
        connection.close()
        return answer.status, content

    def get(self, path):
        status, body = self.ask("GET", path)
        assert status == 200, (path, status, body)
        return json.loads(body)

    def post(self, results):
        return self.ask("POST", "/api/results", json.dumps(results), self.token)

    def resident_mb(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status).group(1)) / 1024


def to_utc(seconds):
    """After noon of a day."""
    return (datetime.datetime(2026, 11, 21, 12) + datetime.timedelta(seconds=seconds)).isoformat(timespec="milliseconds") + "Z"


def result(sequence, kind="pose", data=None, robot="spot-1", run="run_1", world="street", **more):
    """One that the platform takes."""
    data = data if data is not None else {"x": 0.1 * sequence, "y": 0.0, "yaw": 0.0}
    return {"schema": "patrol-result/2", "id": f"{robot}/{run}/{sequence}", "robot": robot, "run": run, "world": world, "sequence": sequence, "time_s": float(sequence),
            "made_utc": to_utc(sequence), "kind": kind, "data": data, **more}


def event(sequence, kind="gas_alarm", subject="well_1", text="Leak at well_1.", value=640.0, **more):
    data = {"kind": kind, "subject": subject, "text": text, "value": value, "pose": {"x": 0.0, "y": 0.0, "yaw": 0.0}, "position_m": [1.0, 2.0]}
    return result(sequence, "event", data, **more)


def lining(sequence, pushed_mm=4.0, rings=12, **more):
    cells = [{"ring": ring, "clock_deg": 10.0 * i + 5.0, "inward_m": 1e-3 * (pushed_mm if ring == 3 and i == 6 else 0.1), "std_m": 0.0004, "points": 500}
             for ring in range(1, rings + 1) for i in range(24)]
    data = {"stamp_ns": sequence * 10**9, "station": f"station_{sequence // 500 % 4}", "pose": {"x": 0.0, "y": 0.0, "yaw": 0.0}, "registered": True, "registration_rms_m": 0.002,
            "registration_inlier_ratio": 0.9, "correction_m": 0.03, "cells": cells, "lines": [{"ring": ring, "name": "9-3", "change_m": -0.001, "std_m": 0.0005} for ring in range(1, rings + 1)],
            "findings": [{"ring": 3, "clock_deg": 65.0, "inward_m": 1e-3 * pushed_mm, "std_m": 0.0004, "level": "alarm" if pushed_mm >= 10 else "notice", "position_m": [4.0, -4.0, 3.0]}]}
    return result(sequence, "lining", data, world=more.pop("world", "tunnel"), **more)


def is_closed(connection, within_s):
    """Whether the other side has hung up."""
    end = time.monotonic() + within_s
    while time.monotonic() < end:
        if select.select([connection], [], [], 0.1)[0] and not connection.recv(65536):
            return True
    return False


class PlatformCase(unittest.TestCase):
    """A platform for all tests of a class; the test program's first argument is patrol."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.path = pathlib.Path(folder.name)
        cls.platform = Platform(pathlib.Path(sys.argv[1]), cls.path / "data")
        cls.addClassCleanup(lambda: cls.platform.kill())
