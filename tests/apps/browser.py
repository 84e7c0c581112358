#!/usr/bin/env python3
"""Opens reports in headless Chromium as a user would: browser.py DELRAY.

Ends with 77, skipped, where Chromium, its driver or Selenium are missing.
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from chromium import errors_of, open_browser  # noqa: E402, first: it may skip

from selenium.webdriver.common.action_chains import ActionChains  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402

# Name, whether its charts show so many variants that some of a group are grey, command.
REPORTS = [
    ("compose", True, "compare compose gen:city:3000 --size 160x90 --ranks 2,4,80 --quick"
                " --compose tree radix-k:2 radix-k binary-swap centralized direct-send mesh"),
    ("triangulate", True, "compare triangulate {points} --threads 1,3 --quick"),
    ("distributed", False, "compare triangulate {points} --ranks 1,3 --quick"),
    ("partition", True, "compare partition gen:city:2000 --size 160x90 --ranks 2,4,80 --regions 1,2"
                  " --quick --partition mahd,kd-split,graph,whitman,whelan,interlaced"),
    ("schedule", True, "compare schedule gen:spheres:500 --size 160x90 --ranks 2,4,80 --tile 16 --quick"
                 " --schedule static,random,demand,guided,stealing,neighbour-stealing"),
]


def flattened(value, name, into):
    """As the page does it: elements of lists are named by their first text."""
    if isinstance(value, list):
        for i, element in enumerate(value):
            key = next((k for k, v in element.items() if isinstance(v, str)), None) \
                if isinstance(element, dict) else None
            if key is None:
                flattened(element, f"{name}.{i}", into)
            else:
                rest = {k: v for k, v in element.items() if k != key}
                flattened(rest, f"{name}.{element[key]}", into)
    elif isinstance(value, dict):
        for k, v in value.items():
            flattened(v, f"{name}.{k}" if name else k, into)
    else:
        into[name] = value
    return into


def same(text, value):
    if value is None:
        return text == ""
    if isinstance(value, bool):
        return text == ("true" if value else "false")
    if isinstance(value, (int, float)):
        return float(text) == value
    return text == value


def check_csv(browser, folder, statistics):
    browser.find_element(By.ID, "csv").click()
    deadline = time.time() + 20
    # The browser makes the file before it has its bytes.
    while not (files := [f for f in folder.glob("*.csv") if f.stat().st_size > 0]) or list(folder.glob("*.crdownload")):
        assert time.time() < deadline, "no CSV was saved"
        time.sleep(0.05)
    with open(files[0], newline="") as file:
        rows = list(csv.DictReader(file))
    files[0].unlink()
    assert len(rows) == len(statistics["rows"]) > 0, (len(rows), len(statistics["rows"]))
    for row, expected in zip(rows, statistics["rows"]):
        for name, value in flattened(expected, "", {}).items():
            assert same(row[name], value), (name, row[name], value)


# Of every tab: its name, how wide it makes the page, texts that are too small to be read, in pixels
# on the screen, whatever they are scaled by, and texts of plots that reach out of the window.
LOOK_AT_TABS = """
return [...document.querySelectorAll('[role=tab]')].map(tab => {
  tab.click();
  const panel = document.querySelector('[role=tabpanel]:not(.hidden)');
  const shown = [...document.querySelectorAll('body > :not(main), main > :not([role=tabpanel])'), panel]
    .flatMap(e => [e, ...e.querySelectorAll('*')]);
  const small = shown.filter(e => [...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim()) &&
      e.getClientRects().length)
    .map(e => [e.textContent, parseFloat(getComputedStyle(e).fontSize) *
      (e.ownerSVGElement ? Math.hypot(e.getScreenCTM().a, e.getScreenCTM().b) : 1)]).filter(pair => pair[1] < 11);
  const clipped = [...panel.querySelectorAll('.plot text')].filter(e => {
    const box = e.getBoundingClientRect();
    return box.width && (box.left < 0 || box.right > document.documentElement.clientWidth);
  }).map(e => e.textContent);
  return {name: tab.textContent, width: document.documentElement.scrollWidth, small, clipped};
})"""


def check_widths(browser, tabs):
    for width in (420, 1000, 1600):
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                {"width": width, "height": 900, "deviceScaleFactor": 1,
                                 "mobile": False})
        looks = browser.execute_script(LOOK_AT_TABS)
        assert len(looks) == len(tabs)
        for look in looks:
            assert look["width"] <= width and not look["small"] and not look["clipped"], (width, look)
        used = browser.execute_script(
            "return document.querySelector('main').getBoundingClientRect().width")
        assert used > 0.9 * width, (used, width)
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def colour(browser, element):
    return browser.execute_script("return getComputedStyle(arguments[0]).stroke", element)


def check_lights(browser):
    """A line that is pointed at stands out; its name below the chart does the same, and keeps it."""
    shown = "[role=tabpanel]:not(.hidden) "
    for figure in browser.find_elements(By.CSS_SELECTOR, shown + "figure.chart"):
        weak = figure.find_elements(By.CSS_SELECTOR, "g.series.weak")
        strong = figure.find_elements(By.CSS_SELECTOR, "g.series:not(.weak)")
        if not weak:
            continue
        line = weak[0].find_element(By.CSS_SELECTOR, ".line")
        grey, name = colour(browser, line), weak[0].find_element(By.CSS_SELECTOR, ".name")
        assert not name.is_displayed(), "a name of a grey line"
        key = next(k for k in figure.find_elements(By.CSS_SELECTOR, "button.key")
                   if k.get_attribute("data-name") == weak[0].get_attribute("data-name"))
        browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", figure)
        ActionChains(browser).move_to_element(key).perform()
        assert colour(browser, line) != grey and name.is_displayed(), "no highlight on hover"
        assert float(strong[0].value_of_css_property("opacity")) < 0.5, "others stay as bright"
        key.click()
        ActionChains(browser).move_to_element(browser.find_element(By.TAG_NAME, "h1")).perform()
        browser.execute_script("document.activeElement.blur()")
        assert colour(browser, line) != grey and name.is_displayed(), "a chosen line is grey"
        assert float(strong[0].value_of_css_property("opacity")) == 1
        key.click()
        ActionChains(browser).move_to_element(browser.find_element(By.TAG_NAME, "h1")).perform()
        browser.execute_script("document.activeElement.blur()")
        assert colour(browser, line) == grey
        return True
    return False


def check_colours(browser):
    """Classes that make the look of each line, by name; the same in every chart."""
    looks = {}
    for name, classes in browser.execute_script(
            "return [...document.querySelectorAll('g.series')].map(e => [e.dataset.name, [...e.classList]])"):
        look = tuple(c for c in classes if c[0] in "cd" and c[1:].isdigit())
        assert looks.setdefault(name, look) == look, (name, looks[name], look)
    assert len(looks) > 5, looks


def start(name, has_grey_lines, command, delray, folder):
    """The program, at work at a report."""
    command = command.format(points=folder / "points.xyz")
    return subprocess.Popen([delray, *command.split(), "-q", "-o", folder / f"{name}.html",
                             "--stats", folder / f"{name}.json"], stdout=subprocess.DEVNULL)


def check(browser, name, has_grey_lines, folder):
    page, statistics = folder / f"{name}.html", folder / f"{name}.json"
    browser.get(page.as_uri())
    tabs = browser.find_elements(By.CSS_SELECTOR, "[role=tab]")
    assert len(tabs) >= 2, "no tabs"
    for tab in tabs:
        tab.click()
        shown = [p for p in browser.find_elements(By.CSS_SELECTOR, "[role=tabpanel]")
                 if p.is_displayed()]
        assert [p.get_attribute("aria-labelledby") for p in shown] == [tab.get_attribute("id")]
        assert shown[0].text.strip(), "an empty tab: " + tab.text
    check_widths(browser, tabs)
    tabs[0].click()
    # The last one lies above the others.
    point = browser.find_elements(By.CSS_SELECTOR, "[role=tabpanel]:not(.hidden) figure:first-of-type"
                                                   " [data-tip]")[-1]
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", point)
    ActionChains(browser).move_to_element(point).perform()
    tip = browser.find_element(By.ID, "tip")
    assert tip.is_displayed() and tip.text, "no numbers on hover"
    assert any(source in tip.text for source in ("counted", "measured", "predicted")), tip.text
    check_colours(browser)
    assert check_lights(browser) == has_grey_lines, "grey lines on the first tab"
    for word in ("GNU", "Clang"):
        if word in browser.find_element(By.CSS_SELECTOR, ".machine").text:
            break
    else:
        raise AssertionError("no compiler is named")
    check_csv(browser, folder, json.loads(statistics.read_text()))
    assert not (errors := errors_of(browser)), errors


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([sys.argv[1], *"generate points cluster -n 900 --dim 2 -q -o".split(),
                        folder / "points.xyz"], check=True)
        # While one report is looked at, the next is made.
        making = start(*REPORTS[0], sys.argv[1], folder)
        browser = open_browser(folder, 1280, 1000)
        try:
            for report, after in zip(REPORTS, REPORTS[1:] + [None]):
                assert making.wait() == 0, report
                if after:
                    making = start(*after, sys.argv[1], folder)
                check(browser, *report[:2], folder)
                print("passed:", report[0], flush=True)
        finally:
            browser.quit()
            making.kill()


main()
