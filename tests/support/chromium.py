"""Headless Chromium for tests of pages. Whoever imports this is skipped where it is not installed.

scripts/setup chromium chromium-driver python3-selenium
"""

import shutil
import sys

SKIPPED = 77  # the exit code, for CTest


def skip(why):
    print("skipped:", why)
    sys.exit(SKIPPED)


try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
except ImportError:
    skip("python3-selenium is not installed")
for program in ("chromium", "chromedriver"):
    if not shutil.which(program):
        skip(program + " is not installed")


def open_browser(folder, width, height):
    """A browser with a window of this size, which keeps its own files, and what it saves, in `folder`."""
    options = webdriver.ChromeOptions()
    options.add_argument(f"--user-data-dir={folder / 'browser'}")
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--disable-quic",
                     "--no-first-run", "--disable-background-networking", "--disable-component-update",
                     "--disable-sync", "--disable-extensions", "--disable-default-apps",
                     f"--window-size={width},{height}"):
        options.add_argument(argument)
    options.add_experimental_option("prefs", {"download.default_directory": str(folder)})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


def errors_of(browser):
    """What went wrong on its pages since this was asked for last."""
    return [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
