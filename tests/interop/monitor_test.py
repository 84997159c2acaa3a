#!/usr/bin/env python3
"""Chromium shows the monitoring platform's page while robots report, and jsonschema holds what they send, and what the platform takes, to
the published schema.

usage: monitor_test.py PATROL REPORTING_ROBOT [TEST...]
"""
import copy
import datetime
import json
import pathlib
import shutil
import subprocess
import sys
import time
import unittest

import jsonschema
from selenium import webdriver

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "app/monitor"))
from monitoring import PlatformCase, event  # noqa: E402
from accessibility import violations  # noqa: E402

PATROL, ROBOT = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
NASTY = "<img src=x onerror=\"document.title='owned'\">"

# Share of a canvas's pixels that differ from its first one.
INKED = """const canvas = document.querySelector(arguments[0]);
const pixels = new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.buffer);
return pixels.filter((one) => one !== pixels[0]).length / pixels.length;"""

# Counts the requests of the page that are not yet answered and handled.
COUNT_REQUESTS = """window.openRequests = 0;
const fetchOfBrowser = window.fetch;
window.fetch = (...request) => {
  ++window.openRequests;
  return fetchOfBrowser(...request).finally(() => setTimeout(() => --window.openRequests, 50));
};"""


def open_browser():
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    browser = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))
    browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": COUNT_REQUESTS})
    return browser


class Case(PlatformCase):
    @classmethod
    def start_robot(cls, name, world, seconds=2.0, run=None):
        return subprocess.Popen([ROBOT, cls.platform.url, cls.platform.token_file, cls.path / (run or f"run_{world}_{name}"), name, world, str(seconds), "5"],
                                stdout=subprocess.DEVNULL)

    @classmethod
    def run_robot(cls, name, world, run=None):
        if cls.start_robot(name, world, run=run).wait(timeout=60) != 0:
            raise RuntimeError(f"{name} could not report")


class PageCase(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.browser = open_browser()
        cls.addClassCleanup(cls.browser.quit)

    def js(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def wait(self, script, limit_s=10.0):
        end = time.monotonic() + limit_s
        while not self.js(script):
            self.assertLess(time.monotonic(), end, script)
            time.sleep(0.05)


class AlarmDelay(PageCase):
    """Measures wall time: no other test runs beside it."""

    def test_an_alarm_is_on_the_page_within_two_seconds(self):
        self.browser.get(self.platform.url + "/")
        self.wait("return document.querySelector('#live').textContent === 'live';")
        robot = self.start_robot("spot-2", "street", seconds=3.0)
        self.wait("return [...document.querySelectorAll('.alarms li')].some((one) => one.textContent.includes('spot-2'));", 15.0)
        seen = datetime.datetime.now(datetime.timezone.utc)
        robot.wait(timeout=60)
        results = [json.loads(line) for line in (self.path / "run_street_spot-2/outbox.jsonl").read_text().splitlines()]
        alarm = next(one for one in results if one["kind"] == "event" and one["data"]["kind"] == "gas_alarm")
        late_s = (seen - datetime.datetime.fromisoformat(alarm["made_utc"])).total_seconds()
        print(f"alarm on the page after {late_s:.2f} s")
        self.assertLess(late_s, 2.0)
        self.assertGreater(late_s, 0.0)


class Page(PageCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        spot = cls.start_robot("spot-1", "street")
        cls.run_robot("tracked-1", "tunnel", run="first")
        cls.run_robot("tracked-1", "tunnel", run="second")
        spot.wait(timeout=60)
        cls.platform.post([event(1, robot=NASTY, subject=NASTY, text=NASTY, world=NASTY), event(2, "note", NASTY, NASTY, robot=NASTY, world=NASTY)])

    def show(self, width, robot=None):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600})
        self.browser.get(self.platform.url + "/")
        self.wait("return document.querySelectorAll('.robots b').length >= 3 && document.querySelectorAll('#history tbody tr').length > 0;")
        if robot:
            self.js("[...document.querySelectorAll('.robots button')].find((one) => one.querySelector('b').textContent === arguments[0]).click();", robot)
            self.wait("return window.openRequests === 0;")

    def test_everything_is_drawn(self):
        for width in (360, 1280):
            self.show(width, "tracked-1")
            self.assertGreater(self.js(INKED, "#map canvas"), 0.02)
            self.assertGreater(self.js(INKED, "#heat"), 0.2)
            self.assertGreater(self.js(INKED, "#rings canvas"), 0.01)
            self.assertGreaterEqual(len(self.js("return [...document.querySelectorAll('#lines tbody tr')].map((one) => one.textContent);")), 12)
            self.assertIn("14.6 m ahead", self.js("return document.querySelector('#water').textContent;"))
            self.show(width, "spot-1")
            self.assertGreater(self.js(INKED, "#gas-plot canvas"), 0.01)

    def test_axe_finds_no_serious_violation(self):
        for scheme in ("light", "dark"):
            with self.subTest(scheme):
                self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
                self.show(1280, "tracked-1")
                self.assertEqual(violations(self.browser, pathlib.Path(__file__).resolve().parents[2]), [])

    def test_nothing_overflows_from_a_phone_to_a_desk(self):
        for width in (360, 400, 768, 1280):
            for robot in ("tracked-1", "spot-1", NASTY):
                self.show(width, robot)
                self.assertLessEqual(self.js("return document.documentElement.scrollWidth;"), width, robot)

    def test_names_are_text_nothing_is_fetched_from_elsewhere_and_nothing_complains(self):
        self.browser.get_log("performance")
        self.browser.get_log("browser")
        self.show(1280, NASTY)
        self.js("const select = document.querySelector('#history-robot'); select.value = arguments[0]; select.dispatchEvent(new Event('change'));", NASTY)
        self.wait("return document.querySelectorAll('#history tbody tr').length === 2;")
        self.assertEqual(self.js("return document.querySelectorAll('main img, main script').length;"), 0)
        self.assertNotIn("owned", self.browser.title)
        for place in (".robots", ".alarms", "#history tbody", "#history-robot", "#site"):
            self.assertIn(NASTY, self.js("return document.querySelector(arguments[0]).textContent;", place))
        messages = [json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")]
        asked = [message["params"]["request"]["url"] for message in messages if message["method"] == "Network.requestWillBeSent"]
        self.assertGreater(len(asked), 8)
        self.assertEqual([url for url in asked if not url.startswith((self.platform.url + "/", "data:"))], [])
        self.assertEqual(self.browser.get_log("browser"), [])

    def test_an_alarm_is_acknowledged_with_the_token_that_is_asked_for_once(self):
        self.platform.post([event(10 + i, robot="spot-9", text=f"Leak number {i}.") for i in range(2)])
        self.show(400)
        self.js("sessionStorage.clear();")
        row = "[...document.querySelectorAll('.alarms li')].find((one) => one.textContent.includes(arguments[0]))"
        fill = "for (const [name, value] of Object.entries(arguments[0])) document.querySelector(`dialog [name=${name}]`).value = value; document.querySelector('dialog [value=ok]').click();"
        self.wait(f"return ((...arguments) => Boolean({row}))('Leak number 1.');")
        self.js(f"{row}.querySelector('button').click();", "Leak number 1.")
        self.js(fill, {"who": "Li Wei", "note": "valve closed", "token": "not-the-token-at-all"})
        self.wait("return document.querySelector('dialog .error').textContent === 'Invalid token.';")
        self.js(fill, {"token": self.platform.token})
        self.wait(f"return ((...arguments) => !{row})('Leak number 1.');")
        self.js("document.querySelector('[data-open=\"0\"]').click();")
        self.assertIn("Acknowledged by Li Wei", self.js(f"return {row}.textContent;", "Leak number 1."))
        self.js(f"{row}.querySelector('button').click();", "Leak number 0.")
        self.assertTrue(self.js("return document.querySelector('dialog label.token').hidden;"))
        self.js(fill, {"note": "also"})
        self.wait(f"return ((...arguments) => {row}.classList.contains('done'))('Leak number 0.');")

    def test_history_goes_back_and_forth(self):
        self.platform.post([event(100 + i, "note", text=f"note {i}", robot="spot-8") for i in range(60)])
        self.show(1280)
        self.js("const select = document.querySelector('#history-robot'); select.value = 'spot-8'; select.dispatchEvent(new Event('change'));")
        first = "return document.querySelector('#history tbody tr').textContent.includes('note %d');"
        self.wait(first % 59)
        self.js("document.querySelector('#older').click();")
        self.wait(first % 34)
        self.js("document.querySelector('#older').click();")
        self.wait(first % 9)
        self.assertTrue(self.js("return document.querySelector('#older').disabled;"))
        self.js("document.querySelector('#newer').click();")
        self.wait(first % 34)

    def test_a_platform_that_is_away_is_said_and_its_return_too(self):
        self.show(1280)
        self.platform.kill()
        self.wait("return document.querySelector('#live').textContent.startsWith('no response since');")
        self.platform.start()
        self.wait("return document.querySelector('#live').textContent === 'live';")


class Schema(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.schema = cls.platform.get("/schema")
        jsonschema.Draft202012Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft202012Validator(cls.schema)

    def test_what_robots_send_is_of_the_schema(self):
        kinds = set()
        for world in ("street", "tunnel"):
            self.run_robot("a", world)
            for line in (self.path / f"run_{world}_a/outbox.jsonl").read_text().splitlines():
                one = json.loads(line)
                self.validator.validate(one)
                kinds.add(one["kind"])
        self.assertEqual(kinds, {"status", "pose", "map", "event", "lining", "water"})

    def test_the_platform_and_the_schema_refuse_the_same(self):
        """Every member of every kind taken away, made a word, a list, a number below nothing; and one too many."""
        self.run_robot("b", "tunnel")
        lines = [json.loads(line) for line in (self.path / "run_tunnel_b/outbox.jsonl").read_text().splitlines()]
        samples = {one["kind"]: one for one in lines}
        for sample in samples.values():  # two entries of a list are as good as hundreds
            sample["data"] = {key: value[:2] if isinstance(value, list) and key in ("cells", "lines", "findings", "stations") else value for key, value in sample["data"].items()}
        tried = refused = 0
        for sample in samples.values():
            for changed in variants(sample):
                changed["id"] = f"variant/{tried}"
                is_fine = self.validator.is_valid(changed)
                status, answer = self.platform.post(changed)
                tried, refused = tried + 1, refused + (status == 400)
                self.assertEqual(status == 200, is_fine, (answer, json.dumps(changed)[:2000]))
        print(f"{tried} variants, {refused} refused by both")
        self.assertGreater(refused, 200)


def variants(sample):
    """Copies of a result, each wrong (or harmless) in one place."""
    def places(node, path=()):
        if isinstance(node, dict):
            for key, value in node.items():
                yield (*path, key)
                yield from places(value, (*path, key))
        elif isinstance(node, list) and node:
            yield (*path, 0)
            yield from places(node[0], (*path, 0))

    for path in places(sample):
        if path[-1] in ("id", "png_base64"):
            continue
        for value in ("a word", [], {}, -1, None, True, 1.5, "delete", "extra"):
            changed = copy.deepcopy(sample)
            node = changed
            for key in path[:-1]:
                node = node[key]
            if value == "delete":
                del node[path[-1]]
            elif value == "extra":
                if isinstance(node, list):
                    continue
                node["extra"] = 1
            else:
                node[path[-1]] = value
            yield changed


if __name__ == "__main__":
    if not (CHROMIUM and DRIVER):
        print("skipped: chromium and chromium-driver are not installed (tools/setup installs them)")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], "-v"] + sys.argv[3:])
