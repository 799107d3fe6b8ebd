#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tries the package for browsers in a Chromium without a window, by what try.mjs asks.

usage: try.py PACKAGE [--figures FILE…] [--screenshot PNG]

The pictures of packaging/digests.txt and of digests.txt beside this file must have the digests that native programs give.
"""

import argparse
import functools
import http.server
import json
import pathlib
import queue
import shutil
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).parent


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".mjs": "text/javascript", ".wasm": "application/wasm"}
    task: dict = {}
    data: dict = {}
    reports: queue.Queue = queue.Queue()

    def do_GET(self):
        name = self.path.split("?")[0]
        if name == "/task":
            self.answer(json.dumps(self.task).encode(), "application/json")
        elif name == "/try.html":
            self.answer(b'<!DOCTYPE html><script type="module" src="try.mjs"></script>', "text/html")
        elif name == "/try.mjs":
            self.answer((HERE / "try.mjs").read_bytes(), "text/javascript")
        elif name == "/late.png":  # a picture of the page is taken when it is loaded, and the worker needs some seconds
            time.sleep(5)
            self.answer(b"", "image/png")
        elif name == "/late.html":
            page = (pathlib.Path(self.directory) / "index.html").read_text(encoding="utf-8")
            self.answer(page.replace("<h1>", '<img src="late.png" hidden><h1>').encode(), "text/html; charset=utf-8")
        elif name.startswith("/data/"):
            self.answer(self.data[name.removeprefix("/data/")].read_bytes(), "application/octet-stream")
        else:
            super().do_GET()

    def do_POST(self):
        self.reports.put(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
        self.answer(b"", "text/plain")

    def answer(self, body, kind):
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


def chromium(folder, *arguments):
    program = shutil.which("chromium") or sys.exit("try.py: there is no chromium")
    return [program, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", f"--user-data-dir={folder}", *arguments]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("package", type=pathlib.Path)
    parser.add_argument("--figures", type=pathlib.Path, nargs="*", default=[])
    parser.add_argument("--screenshot", type=pathlib.Path)
    a = parser.parse_args()
    tables = [HERE.parent / "digests.txt", HERE / "digests.txt"]
    lines = [line for table in tables for line in table.read_text().splitlines()]
    Handler.task = {"digests": lines, "figures": [f.name for f in a.figures]}
    Handler.data = {f.name: f for f in a.figures}
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=str(a.package)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    address = f"http://127.0.0.1:{server.server_port}"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        with open(pathlib.Path(folder) / "log", "wb") as log:
            browser = subprocess.Popen(chromium(folder, f"{address}/try.html"), stderr=log, stdout=log)
            try:
                report = Handler.reports.get(timeout=300)
            except queue.Empty:
                sys.exit("try.py: the browser gave no report within 300 s")
            finally:
                browser.terminate()
                browser.wait()
        if a.screenshot:
            size = ["--window-size=900,1000", f"--screenshot={a.screenshot}"]
            subprocess.run(chromium(folder, *size, f"{address}/late.html"), check=True, capture_output=True, timeout=120)
    print(json.dumps(report["figures"], indent=2))
    for line in report["passed"]:
        print("passed:", line)
    for line in report["failed"]:
        print("FAILED:", line)
    sys.exit(1 if report["failed"] else 0)


if __name__ == "__main__":
    main()
