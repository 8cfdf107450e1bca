#!/usr/bin/env python3
"""Pages of `hsdm reconstruct --html` as headless Chromium shows them, without a graphics card.

  python3 docs/page.py picture PAGE.html OUT.png [dark] [phone] [key=K...]   the window, 1440 x 960 or a phone's 390 x 844
  python3 docs/page.py print PAGE.html OUT.pdf                               what it prints
  python3 docs/page.py bench PAGE.html [FRAMES]                              how quickly the mesh turns

key=K presses a key before, `key=p` for the points.
"""
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "page"))
import browser


def picture(page, out, *words):
    phone = "phone" in words
    size = (390, 844) if phone else (1440, 960)
    keys = [w[4:] for w in words if w.startswith("key=")]
    with browser.Browser(*size, mobile=phone, dark="dark" in words, ratio=2 if phone else 1) as shown:
        shown.open(page)
        for key in keys:
            shown.press(key)
        with open(out, "wb") as file:
            file.write(shown.picture())


def print_page(page, out):
    with browser.Browser() as shown:
        shown.open(page)
        with open(out, "wb") as file:
            file.write(shown.pdf())


def bench(page, frames="120"):
    with browser.Browser(1280, 800) as shown:
        start = time.monotonic()
        shown.open(page, "", 300)
        seconds = time.monotonic() - start
        cpu = browser.cpu_seconds(shown.process.pid)
        shown.value(f"hsdm.shown.bench({int(frames)}, (result) => {{ window.turned = result; }})")
        shown.wait_for("!!window.turned", 300)
        cpu = browser.cpu_seconds(shown.process.pid) - cpu
        result = shown.value("window.turned")
        wide, high = shown.value("[hsdm.shown.canvas.width, hsdm.shown.canvas.height]")
        print(f"{page}: {os.path.getsize(page) / 1e6:.2f} MB, open after {seconds:.1f} s, {result['fps']:.1f} pictures a second "
              f"of {wide} x {high}, {1000 * cpu / int(frames):.0f} ms of processor each, {result['triangles']:.0f} triangles"
              + (" of a coarser mesh" if result["coarse"] else ""))


if __name__ == "__main__":
    does = {"picture": picture, "print": print_page, "bench": bench}
    if len(sys.argv) < 3 or sys.argv[1] not in does:
        sys.exit(__doc__)
    if not browser.find():
        sys.exit("no chromium here: apt-get install chromium")
    does[sys.argv[1]](*sys.argv[2:])
