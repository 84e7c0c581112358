#!/usr/bin/env python3
"""Opens reports in headless Chromium as a user would: browser.py DELRAY.

Ends with 77, skipped, where Chromium, its driver or Selenium are missing.
"""
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
REPORTS = [
    ("compose", "compare compose gen:city:3000 --size 160x90 --ranks 2,4,80 --quick"
                " --compose tree radix-k:2 centralized"),
    ("triangulate", "compare triangulate {points} --threads 1,3 --quick"),
    ("partition", "compare partition gen:city:2000 --size 160x90 --ranks 2,4,80 --regions 1,2"
                  " --quick --partition mahd,graph,interlaced"),
    ("schedule", "compare schedule gen:spheres:500 --size 160x90 --ranks 2,4,80 --tile 16 --quick"
                 " --schedule static,demand,stealing"),
]


def skip(why):
    print("skipped:", why)
    sys.exit(SKIPPED)


try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.chrome.service import Service
except ImportError:
    skip("python3-selenium is not installed")
for program in ("chromium", "chromedriver"):
    if not shutil.which(program):
        skip(program + " is not installed")


def open_browser(folder):
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--window-size=1280,1000"):
        options.add_argument(argument)
    options.add_experimental_option("prefs", {"download.default_directory": str(folder)})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


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
    while not (files := list(folder.glob("*.csv"))):
        assert time.time() < deadline, "no CSV was saved"
        time.sleep(0.05)
    with open(files[0], newline="") as file:
        rows = list(csv.DictReader(file))
    files[0].unlink()
    assert len(rows) == len(statistics["rows"]) > 0, (len(rows), len(statistics["rows"]))
    for row, expected in zip(rows, statistics["rows"]):
        for name, value in flattened(expected, "", {}).items():
            assert same(row[name], value), (name, row[name], value)


def check(browser, name, command, delray, folder):
    page, statistics = folder / f"{name}.html", folder / f"{name}.json"
    command = command.format(points=folder / "points.xyz")
    subprocess.run([delray, *command.split(), "-q", "-o", page, "--stats", statistics],
                   check=True, stdout=subprocess.DEVNULL)
    browser.get(page.as_uri())
    tabs = browser.find_elements(By.CSS_SELECTOR, "[role=tab]")
    assert len(tabs) >= 2, "no tabs"
    for tab in tabs:
        tab.click()
        shown = [p for p in browser.find_elements(By.CSS_SELECTOR, "[role=tabpanel]")
                 if p.is_displayed()]
        assert [p.get_attribute("aria-labelledby") for p in shown] == [tab.get_attribute("id")]
        assert shown[0].text.strip(), "an empty tab: " + tab.text
    tabs[0].click()
    point = browser.find_element(By.CSS_SELECTOR, "[role=tabpanel]:not(.hidden) [data-tip]")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", point)
    ActionChains(browser).move_to_element(point).perform()
    tip = browser.find_element(By.ID, "tip")
    assert tip.is_displayed() and tip.text, "no numbers on hover"
    assert any(source in tip.text for source in ("counted", "measured", "predicted")), tip.text
    keys = browser.find_elements(By.CSS_SELECTOR, "[role=tabpanel]:not(.hidden) button.key")
    if keys:
        series = browser.find_element(By.CSS_SELECTOR, "[role=tabpanel]:not(.hidden) g.series")
        keys[0].click()
        assert not series.is_displayed(), "the legend turns nothing off"
    check_csv(browser, folder, json.loads(statistics.read_text()))
    errors = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
    assert not errors, errors


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([sys.argv[1], *"generate points cluster -n 900 --dim 2 -q -o".split(),
                        folder / "points.xyz"], check=True)
        browser = open_browser(folder)
        try:
            for report, command in REPORTS:
                check(browser, report, command, sys.argv[1], folder)
                print("passed:", report)
        finally:
            browser.quit()


main()
