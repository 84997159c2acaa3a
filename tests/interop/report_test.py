#!/usr/bin/env python3
"""Chromium opens the reports of a run, a sweep and a test: nothing is fetched, nothing complains, nothing overflows, everything is drawn, and it prints.

usage: report_test.py PATROL SOURCE_DIR RUN_DIRECTORY
"""
import base64
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from selenium import webdriver

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "app"))
from standing_still import PATROL, SOURCE, standing_still  # noqa: E402
from accessibility import violations  # noqa: E402

RUN = sys.argv[3]
CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")

# Share of a canvas's pixels that are not transparent; a drawing has axes, a grid and a curve.
INKED = """return [...document.querySelectorAll('canvas')].map((canvas) => {
  const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  let inked = 0;
  for (let i = 3; i < pixels.length; i += 4) inked += pixels[i] > 0;
  return inked / (pixels.length / 4);
});"""


def open_browser():
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))


def setUpModule():
    PageCase.browser = open_browser()
    unittest.addModuleCleanup(PageCase.browser.quit)


class PageCase:
    """What holds for every page."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.path = pathlib.Path(folder.name)
        cls.page = cls.make_page()

    def show(self, width, height=900):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})
        self.browser.get(self.page.as_uri())

    def run_script(self, script):
        return self.browser.execute_script(script)

    def test_nothing_is_fetched_and_nothing_complains(self):
        self.browser.get_log("performance")
        self.browser.get_log("browser")
        self.show(1280)
        messages = [json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")]
        asked = [message["params"]["request"]["url"] for message in messages if message["method"] == "Network.requestWillBeSent"]
        self.assertIn(self.page.as_uri(), asked)
        self.assertEqual([url for url in asked if url != self.page.as_uri() and not url.startswith("data:")], [])
        self.assertEqual(self.browser.get_log("browser"), [])

    def test_no_page_overflows_from_a_phone_to_a_desk(self):
        for width in (400, 768, 1280):
            with self.subTest(width):
                self.show(width)
                self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth;"), width)
                self.run_script("document.querySelectorAll('details').forEach((one) => { one.open = true; });")
                self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth;"), width, "unfolded")

    def test_the_verdict_comes_first(self):
        self.show(400)
        self.assertLess(self.run_script("return document.querySelector('main .word').getBoundingClientRect().bottom;"), 500)

    def test_axe_finds_no_serious_violation(self):
        for scheme in ("light", "dark"):
            with self.subTest(scheme):
                self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
                self.show(1280)
                self.assertEqual(violations(self.browser, SOURCE), [])

    def test_it_prints(self):
        self.show(1280)
        pdf = base64.b64decode(self.browser.print_page())
        self.assertTrue(pdf.startswith(b"%PDF"))
        self.assertGreater(len(pdf), 20_000)


def report(directory, page):
    subprocess.run([PATROL, "report", directory, "--out", page], check=True, capture_output=True, timeout=120)
    return page


class RunReport(PageCase, unittest.TestCase):
    @classmethod
    def make_page(cls):
        return report(RUN, cls.path / "report.html")

    def test_a_replay_next_to_the_page_plays(self):
        run = self.path / "run"
        shutil.copytree(RUN, run)
        subprocess.run([PATROL, "replay", run, "--style", "continuous", "--speed", "100", "--size", "160x90", "--out", run / "replay.mp4"], check=True, capture_output=True, timeout=120)
        with open(run / "replay.mp4", "ab") as video:  # over what is embedded: an MP4 box of kind "free"
            video.write((7 << 20).to_bytes(4, "big") + b"free" + bytes((7 << 20) - 8))
        self.browser.get(report(run, run / "report.html").as_uri())
        self.assertEqual(self.run_script("return document.querySelector('video').getAttribute('src');"), "replay.mp4")
        size = self.browser.execute_async_script("""const done = arguments[0], video = document.querySelector('video');
          if (video.videoWidth > 0) done([video.videoWidth, video.controls]);
          video.addEventListener('loadedmetadata', () => done([video.videoWidth, video.controls]));
          video.addEventListener('error', () => done(video.error.message));
          setTimeout(() => done('nothing was loaded'), 10000);""")
        self.assertEqual(size, [160, True])

    def test_every_plot_is_drawn(self):
        for width in (400, 1280):
            self.show(width)
            inked = self.run_script(INKED)
            self.assertEqual(len(inked), self.run_script("return document.querySelectorAll('.plot').length;"))
            self.assertGreaterEqual(len(inked), 4)  # events, position, odometry, heading
            self.assertGreater(min(inked), 0.01, inked)

    def test_the_map_is_a_picture_with_paths_and_marks_and_zooms(self):
        self.show(1280)
        self.assertGreater(self.run_script("const image = new Image(); image.src = document.querySelector('.view image').href.baseVal;"
                                           "return image.decode().then(() => image.naturalWidth);"), 100)
        self.assertGreaterEqual(self.run_script("return document.querySelectorAll('.view polyline').length;"), 2)
        self.assertGreaterEqual(self.run_script("return document.querySelectorAll('.view text').length;"), 2)
        shown = "return document.querySelector('.view svg').viewBox.baseVal.width;"
        whole = self.run_script(shown)
        self.run_script("document.querySelector('.controls button').click();")
        self.assertAlmostEqual(self.run_script(shown), whole / 2, delta=0.01)

    def test_the_run_passed(self):
        self.show(400)
        self.assertEqual(self.run_script("return document.querySelector('main .word').textContent;"), "Passed")

    def test_the_same_run_gives_the_same_bytes(self):
        self.assertEqual(report(RUN, self.path / "again.html").read_bytes(), self.page.read_bytes())


class SweepReport(PageCase, unittest.TestCase):
    @classmethod
    def make_page(cls):
        scenario = standing_still(cls.path)
        sweep = cls.path / "sweep"
        subprocess.run([PATROL, "sweep", scenario, "--vary", "sensors.lidar.range_noise_std_m=0.0,0.05", "--seeds", "2", "--out", sweep], check=True,
                       capture_output=True, timeout=120, cwd=SOURCE)
        return report(sweep, cls.path / "report.html")

    def test_each_metric_has_its_boxes_and_its_table(self):
        self.show(1280)
        self.assertEqual(self.run_script("return document.querySelectorAll('section').length;"), 1 + 4 + 1)
        self.assertGreaterEqual(self.run_script("return document.querySelectorAll('.boxes .median').length;"), 4 * 2)
        self.assertGreaterEqual(self.run_script("return document.querySelectorAll('.spans .span').length;"), 1)


class TestReport(PageCase, unittest.TestCase):
    @classmethod
    def make_page(cls):
        standing_still(cls.path, "expect:\n  mission.completed: true\n")
        out = cls.path / "out"
        subprocess.run([PATROL, "test", cls.path, "--out", out], check=True, capture_output=True, timeout=120, cwd=SOURCE)
        return out / "report.html"

    def test_it_passed(self):
        self.show(1280)
        self.assertEqual(self.run_script("return document.querySelector('main .word').textContent;"), "Passed")


if __name__ == "__main__":
    if not (CHROMIUM and DRIVER):
        print("skipped: chromium and chromium-driver are not installed (tools/setup installs them)")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], "-v"])
