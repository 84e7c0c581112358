#!/usr/bin/env python3
"""Uses `delray view` in headless Chromium as people do: browser.py DELRAY [FOLDER FOR SCREENSHOTS].

Ends with 77, skipped, where Chromium, its driver or Selenium are missing.
"""
import array
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from chromium import errors_of, open_browser  # noqa: E402, first: it may skip

from selenium.webdriver.common.action_chains import ActionChains  # noqa: E402
from selenium.webdriver.common.actions.action_builder import ActionBuilder  # noqa: E402
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402
from selenium.webdriver.support.ui import Select  # noqa: E402

PATIENCE = 90
DRAG_SECONDS = float(os.environ.get("DELRAY_DRAG_SECONDS", "1.2"))
DELRAY = str(pathlib.Path(sys.argv[1]).resolve())


class Server:
    def __init__(self, *arguments, token="0123456789abcdefBrowser"):
        self.process = subprocess.Popen([DELRAY, "view", *arguments, "-q"], stdout=subprocess.PIPE, text=True,
                                        env={**os.environ, "DELRAY_VIEW_TOKEN": token})
        self.url = self.process.stdout.readline().strip()
        assert self.url.startswith("http://127.0.0.1:"), self.url
        self.port = self.url.split(":")[2].split("/")[0]

    def end(self):
        self.process.send_signal(signal.SIGINT)
        assert self.process.wait(PATIENCE) == 130, self.process.returncode


def until(what, condition):
    deadline = time.time() + PATIENCE
    while not (result := condition()):
        assert time.time() < deadline, "waited in vain: " + what
        time.sleep(0.02)
    return result


class Page:
    """What a user sees, and does."""

    def __init__(self, browser, screenshots):
        self.browser, self.screenshots = browser, screenshots

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def state(self):
        return self.browser.execute_script("return window.delray()")

    def rested(self, after=0):
        """Waits for a picture that will not get better."""
        return until("a picture at rest", lambda: self.browser.execute_script(
            "const d = document.body.dataset; return d.complete === 'true' && +d.frame > arguments[0] && +d.frame", after))

    def frame(self):
        return int(self.browser.execute_script("return document.body.dataset.frame || 0"))

    def pixels(self):
        """A number for the picture on the screen."""
        return self.browser.execute_script("""
          const c = document.getElementById('picture'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
          let sum = 0;
          for (let i = 0; i < d.length; i += 4) sum = (sum * 31 + d[i] + 256 * d[i + 1] + 65536 * d[i + 2]) % 4294967291;
          return sum""")

    def colours(self):
        return self.browser.execute_script("""
          const c = document.getElementById('picture'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
          const seen = new Set();
          for (let i = 0; i < d.length; i += 4) seen.add(d[i] + 256 * d[i + 1] + 65536 * d[i + 2]);
          return seen.size""")

    def drag(self, dx, dy, steps=12, button=None):
        # Some drivers add a pause to every step.
        actions = ActionBuilder(self.browser, duration=15)
        canvas = self.find("#picture")
        actions.pointer_action.move_to(canvas)
        actions.pointer_action.pointer_down(**({"button": button} if button else {}))
        for i in range(1, steps + 1):
            actions.pointer_action.move_to(canvas, dx * i // steps, dy * i // steps)
        actions.pointer_action.pointer_up(**({"button": button} if button else {}))
        actions.perform()

    def click(self, x=0, y=0):
        ActionChains(self.browser).move_to_element_with_offset(self.find("#picture"), x, y).click().perform()

    def shot(self, name):
        if self.screenshots:
            self.browser.save_screenshot(str(self.screenshots / (name + ".png")))


def eye(page):
    return page.state()["camera"]["eye"]


def check_turning(page):
    first = page.rested()
    assert page.colours() > 50, "an empty picture"
    before, place = page.pixels(), eye(page)
    page.shot("first")
    page.drag(200, 60)
    page.rested(first)
    assert page.pixels() != before and eye(page) != place, "a drag does not turn the picture"
    # Distance and what is looked at stay while it turns.
    camera = page.state()["camera"]
    far = sum((a - b) ** 2 for a, b in zip(camera["eye"], camera["at"])) ** 0.5

    frame = page.frame()
    page.drag(80, 0, button=2)
    page.rested(frame)
    moved = page.state()["camera"]
    assert moved["at"] != camera["at"], "the right button does not move the picture"
    new = sum((a - b) ** 2 for a, b in zip(moved["eye"], moved["at"])) ** 0.5
    assert abs(new - far) < 1e-6 * far, (new, far)

    frame = page.frame()
    ActionChains(page.browser).scroll_from_origin(
        ScrollOrigin.from_element(page.find("#picture")), 0, -200).perform()
    page.rested(frame)
    zoomed = page.state()["camera"]
    assert sum((a - b) ** 2 for a, b in zip(zoomed["eye"], zoomed["at"])) ** 0.5 < far, "the wheel does not zoom"

    for key in (Keys.ARROW_LEFT, "+", "w"):
        frame, place = page.frame(), eye(page)
        ActionChains(page.browser).send_keys_to_element(page.find("#picture"), key).perform()
        page.rested(frame)
        assert eye(page) != place, key
    frame = page.frame()
    page.find("#fit").click()
    page.rested(frame)


def check_frame_rate(page):
    """A mouse that moves for some seconds. The rate is told, not tested: machines differ, and are shared."""
    ActionChains(page.browser).send_keys(Keys.ESCAPE).perform()  # what was clicked lies over the picture
    box = page.find("#picture").rect
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def mouse(kind, at):
        page.browser.execute_cdp_cmd("Input.dispatchMouseEvent",
                                     {"type": kind, "x": at, "y": y, "button": "left", "buttons": 1, "clickCount": 1})

    mouse("mousePressed", x)
    begin, before, told = time.time(), page.state()["moved"], 0
    while (seconds := time.time() - begin) < DRAG_SECONDS or not told:
        assert seconds < PATIENCE, "the page tells no frame rate"
        mouse("mouseMoved", x + 150 * (seconds % 2 - 1))
        time.sleep(0.005)
        # Seldom: asking is in the way of the page.
        if seconds > DRAG_SECONDS and " frames/s" in (text := page.find("#numbers").text):
            told = int(text.split(" frames/s")[0].split()[-1])
    moved = page.state()["moved"] - before
    mouse("mouseReleased", x)
    print(f"frames a second while dragging: {moved / seconds:.1f}, told by the page: {told}")
    assert moved > 0 and told > 0
    page.rested(page.frame() - 1)


def choose(page, option, value):
    frame = page.frame()
    Select(page.find(f"[id='option{option}']")).select_by_visible_text(value)
    page.rested(frame)


def check_panel(page):
    before = page.pixels()
    # The panel is built from the program's tables: the same picture by every strategy.
    for strategy in ("sort-first", "sort-middle", "sort-last"):
        choose(page, "--strategy", strategy)
        assert page.pixels() == before, strategy
    choose(page, "--shading", "gouraud")
    assert page.pixels() != before, "another shading is the same picture"
    choose(page, "--shading", "phong")
    assert page.pixels() == before
    field = page.find("[id='option--regions']")
    assert not field.is_enabled(), "an option without effect can be set"


def check_ranks(page):
    choose(page, "--strategy", "sort-first")
    page.find("#ranks").click()
    until("regions", lambda: len(page.browser.find_elements(By.CSS_SELECTOR, "#overlay rect")) == 2)
    text = page.find("#figures").text
    assert "times the mean" in text and "messages" in text, text
    page.shot("ranks")
    choose(page, "--partition", "interlaced")
    until("other regions", lambda: page.browser.execute_script("return window.delray().figures.regions.length") > 2)
    page.shot("interlaced")
    page.find("#ranks").click()
    assert not page.browser.find_elements(By.CSS_SELECTOR, "#overlay rect")


def show_options(page, on):
    """Without options there is more room beside what lies over the picture."""
    frame = page.frame()
    page.find("#options").click()
    page.rested(frame)
    assert page.find("#panel").is_displayed() == on


def check_picks(page):
    show_options(page, False)
    page.click()
    until("a pick", lambda: page.find("#picked").is_displayed())
    text = page.find("#picked").text
    for word in ("coordinates", "triangle", "instance", "normal"):
        assert word in text, text
    page.shot("pick")
    page.find("#measure").click()
    page.click(-40, 30)
    until("one place", lambda: page.browser.execute_script("return document.body.dataset.picks") == "1")
    page.click(20, 150)
    until("a distance", lambda: "Distance" in page.find("#picked").text)
    picks = page.state()["picks"]
    expected = sum((a - b) ** 2 for a, b in zip(picks[0]["position"], picks[1]["position"])) ** 0.5
    told = float(page.find("#picked .distance").text.split()[1])
    assert abs(told - expected) < 1e-3 * expected, (told, expected)
    page.shot("measure")
    page.find("#measure").click()
    show_options(page, True)


def check_clip(page):
    whole = page.pixels()
    frame = page.frame()
    page.find("#clip").click()
    page.rested(frame)
    cut = page.pixels()
    assert cut != whole and page.state()["clip"] > 0, "nothing is cut off"
    assert page.find("#cut").is_displayed()
    page.shot("clip")
    # The plane stays where it is in the scene while the camera goes nearer.
    frame, clip = page.frame(), page.state()["clip"]
    ActionChains(page.browser).send_keys_to_element(page.find("#picture"), "w").perform()
    page.rested(frame)
    assert page.state()["clip"] < clip
    frame = page.frame()
    page.browser.execute_script("const r = arguments[0]; r.value = 100; r.dispatchEvent(new Event('input'))",
                                page.find("#cutat"))
    page.rested(frame)
    assert page.pixels() != cut
    frame = page.frame()
    page.find("#clip").click()
    page.rested(frame)
    assert page.state()["clip"] == 0 and not page.find("#cut").is_displayed()
    frame = page.frame()
    page.find("#fit").click()
    page.rested(frame)


def check_rays(page):
    choose(page, "--engine", "raytrace")
    assert page.state()["header"]["samples"] >= 1
    assert page.find("[id='option--integrator']").is_displayed()
    assert not page.browser.find_elements(By.CSS_SELECTOR, "[id='option--strategy']"), "an option of the other engine"
    page.shot("rays")
    choose(page, "--engine", "raster")


def check_command_and_save(page, folder):
    page.find("#copy").click()
    command = until("a command", lambda: page.browser.execute_script("return document.body.dataset.command"))
    assert command.startswith("delray render gen:city:3000 ") and "--camera=" in command, command
    page.find("#save").click()
    until("a file", lambda: [f for f in folder.glob("*.png") if f.stat().st_size > 0 and not list(folder.glob("*.crdownload"))])
    saved = next(folder.glob("*.png"))
    subprocess.run([DELRAY, *command.split()[1:], "-q"], cwd=folder / "made", check=True)
    assert saved.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert len(saved.read_bytes()) > 1000


def check_narrow(page):
    page.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                 {"width": 420, "height": 800, "deviceScaleFactor": 2, "mobile": True})
    page.browser.refresh()
    until("connected", lambda: page.browser.execute_script("return document.body.dataset.connected"))
    page.rested()
    assert int(page.find("html").get_property("scrollWidth")) <= 420
    canvas = page.find("#picture").size
    assert canvas["width"] == 420 and canvas["height"] > 700, canvas
    assert page.state()["header"]["width"] == 840, page.state()["header"]
    page.shot("narrow")
    for button in page.browser.find_elements(By.CSS_SELECTOR, "#bar button"):
        box = button.rect
        assert box["x"] >= 0 and box["x"] + box["width"] <= 420, button.text
    frame = page.frame()
    page.find("#options").click()
    until("options", lambda: page.find("#panel").is_displayed())
    page.rested(frame)
    assert int(page.find("html").get_property("scrollWidth")) <= 420
    page.shot("narrow_options")
    # Two fingers, wider and wider.
    camera, frame = page.state()["camera"], page.frame()
    box = page.find("#picture").rect
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def touch(kind, spread):
        points = [] if kind == "touchEnd" else [{"x": x - spread, "y": y, "id": 0}, {"x": x + spread, "y": y, "id": 1}]
        page.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", 30)
    for spread in (40, 50, 60):
        touch("touchMove", spread)
    touch("touchEnd", 0)
    page.rested(frame)
    def far(c):
        return sum((a - b) ** 2 for a, b in zip(c["eye"], c["at"])) ** 0.5
    assert far(page.state()["camera"]) < 0.8 * far(camera), "a pinch does not zoom"
    page.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def check_two_windows(page, server):
    first = page.browser.current_window_handle
    page.browser.switch_to.new_window("window")
    page.browser.get(server.url)
    page.rested()
    other = eye(page)
    page.drag(150, 0)
    until("another camera", lambda: eye(page) != other)
    moved = eye(page)
    page.browser.switch_to.window(first)
    assert eye(page) != moved, "two windows have one camera"
    for handle in page.browser.window_handles:
        if handle != first:
            page.browser.switch_to.window(handle)
            page.browser.close()
    page.browser.switch_to.window(first)


def check_restart(page, server):
    page.rested()
    camera = eye(page)
    server.end()
    until("disconnected", lambda: not page.browser.execute_script("return document.body.dataset.connected"))
    assert "Disconnected" in page.find("#waiting").text
    page.shot("disconnected")
    again = Server("gen:city:3000", "--ranks", "2", "--threads", "1", "--port", server.port)
    until("connected again", lambda: page.browser.execute_script("return document.body.dataset.connected"))
    until("a picture", lambda: not page.find("#waiting").is_displayed())
    assert eye(page) == camera, "the camera is lost"
    return again


def write_hills(path, n):
    """A surface of 2 (n - 1)^2 triangles without normals, as binary PLY."""
    waves = [math.sin(12 * i / n) for i in range(n)]
    vertices, faces = array.array("f"), array.array("i")
    for y in range(n):
        for x in range(n):
            vertices.extend((x / n, y / n, 0.05 * waves[x] * waves[y]))
    for y in range(n - 1):
        for a in range(y * n, y * n + n - 1):
            faces.extend((3, a, a + 1, a + n, 3, a + 1, a + n + 1, a + n))
    with path.open("wb") as file:
        file.write(f"ply\nformat binary_{sys.byteorder}_endian 1.0\nelement vertex {n * n}\nproperty float x\nproperty float y\n"
                   f"property float z\nelement face {2 * (n - 1) ** 2}\nproperty list int int vertex_indices\nend_header\n".encode())
        vertices.tofile(file)
        faces.tofile(file)


def check_first_picture(browser, screenshots, folder):
    """Some of a scene, whose light comes through a pipe, is there to be turned; all of it is seen from there."""
    write_hills(folder / "hills.ply", 1030)
    subprocess.run([DELRAY, "render", "gen:spheres:100", "--size", "64x32", "-o", "light.png", "-q"], cwd=folder, check=True)
    os.mkfifo(folder / "pipe.png")
    server = Server(str(folder / "hills.ply"), "--light", str(folder / "pipe.png"), "--threads", "2")
    try:
        see_first_picture(browser, screenshots, folder, server)
        server.end()
    finally:
        server.process.kill()


def see_first_picture(browser, screenshots, folder, server):
    browser.get(server.url)
    page = Page(browser, screenshots)
    until("a first picture", page.frame)
    until("progress beside it", lambda: page.find("#loading").text)
    assert not page.find("#waiting").is_displayed() and page.colours() > 50
    some = page.state()["scene"]["triangles"]
    assert 10000 < some <= 200000, some
    page.shot("first_picture")
    place, frame = eye(page), page.frame()
    page.drag(150, 40)
    until("a turned picture", lambda: page.frame() > frame and page.state()["header"]["stage"] == "sharp")
    turned = eye(page)
    assert turned != place and page.find("#loading").text
    page.shot("first_picture_turned")
    (folder / "pipe.png").write_bytes((folder / "light.png").read_bytes())
    page.rested()
    assert page.state()["scene"]["triangles"] > 2000000 and eye(page) == turned
    until("no more progress", lambda: not page.find("#loading").text)
    page.shot("whole_picture")


def check_once(browser):
    server = Server("gen:spheres:200", "--once")
    browser.get(server.url)
    Page(browser, None).rested()
    browser.get("about:blank")
    assert server.process.wait(PATIENCE) == 0


def main():
    screenshots = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "made").mkdir()
        server = Server("gen:city:3000", "--ranks", "2", "--threads", "1")
        browser = open_browser(folder, 1000, 640)
        try:
            page = Page(browser, screenshots)
            browser.get(server.url)
            for check, arguments in ((check_turning, ()), (check_frame_rate, ()), (check_panel, ()), (check_ranks, ()), (check_picks, ()), (check_clip, ()),
                                     (check_rays, ()), (check_command_and_save, (folder,)),
                                     (check_two_windows, (server,)), (check_narrow, ())):
                began = time.time()
                check(page, *arguments)
                print(f"passed: {check.__name__}, {time.time() - began:.1f} s", flush=True)
            server = check_restart(page, server)
            print("passed: check_restart", flush=True)
            errors = [entry for entry in errors_of(browser) if "WebSocket connection" not in entry["message"]]
            assert not errors, errors
            server.end()
            check_first_picture(browser, screenshots, folder)
            print("passed: check_first_picture", flush=True)
            check_once(browser)
            print("passed: check_once", flush=True)
        finally:
            browser.quit()
            if server.process.poll() is None:
                server.process.kill()


main()
