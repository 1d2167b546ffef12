"""A headless Chromium, controlled through its debugging pipe, which lays out pages and evaluates scripts in them. It
needs no packages.

    with Browser() as browser:
        browser.open("view.html", width=800, dark=True)
        browser.evaluate("document.title"), browser.faults
"""

import base64
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time

FLAGS = ["--headless", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run", "--use-gl=angle", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--proxy-server=127.0.0.1:9", "--hide-scrollbars", "--remote-debugging-pipe"]


def find():
    """The program, or None."""
    return next((p for p in map(shutil.which, ["chromium", "google-chrome", "chromium-browser"]) if p), None)


class Browser:
    def __init__(self):
        self.folder = tempfile.mkdtemp()
        to_child, self._out = os.pipe()
        self._in, from_child = os.pipe()
        # Commands are read from descriptor 3 and answers written to 4.
        words = ["sh", "-c", f'exec "$@" 3<&{to_child} 4>&{from_child}', "sh", find(), *FLAGS,
                 f"--user-data-dir={self.folder}/profile", "about:blank"]
        self._process = subprocess.Popen(words, pass_fds=(to_child, from_child), stdin=subprocess.DEVNULL,
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_child)
        os.close(from_child)
        self._rest, self._next, self._session = b"", 1, None
        self.faults, self.events, self._page = [], [], ""
        targets = []
        while not targets:
            targets = [t for t in self.send("Target.getTargets")["targetInfos"] if t["type"] == "page"]
        attached = self.send("Target.attachToTarget", targetId=targets[0]["targetId"], flatten=True)
        self._session = attached["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self.send(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()
        os.close(self._in)
        os.close(self._out)
        shutil.rmtree(self.folder, ignore_errors=True)

    def send(self, method, **params):
        number, self._next = self._next, self._next + 1
        message = {"id": number, "method": method, "params": params}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._receive()
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def _receive(self):
        while b"\0" not in self._rest:
            part = os.read(self._in, 1 << 16)
            if not part:
                raise RuntimeError("the browser ended")
            self._rest += part
        text, _, self._rest = self._rest.partition(b"\0")
        message = json.loads(text)
        if "method" in message:
            self._see(message["method"], message["params"])
        return message

    def _see(self, method, params):
        """Records faults of a page: errors on the console, exceptions, and requests beyond the page itself."""
        self.events.append(method)
        if method == "Runtime.exceptionThrown":
            self.faults.append("exception: " + json.dumps(params["exceptionDetails"])[:300])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            self.faults.append(f"console, {params['type']}: " + json.dumps(params["args"])[:300])
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.faults.append("console: " + params["entry"]["text"][:300])
        elif method == "Network.requestWillBeSent":
            url = params["request"]["url"]
            if url != self._page and not url.startswith(("data:", "blob:")):
                self.faults.append("asks for " + url[:200])

    def open(self, page, width=1300, height=1400, dark=False, media="screen", scripts=True, calm=False):
        """Loads a page and fills `faults`. On paper (media "print") the width is that of the paper; a calm reader asks
        for less motion."""
        self.faults, self.events = [], []
        self._page = pathlib.Path(page).resolve().as_uri()
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
                  {"name": "prefers-reduced-motion", "value": "reduce" if calm else ""}]
        self.send("Emulation.setEmulatedMedia", media=media, features=scheme)
        self.send("Emulation.setScriptExecutionDisabled", value=not scripts)
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.send("Page.navigate", url=self._page)
        while "Page.loadEventFired" not in self.events:
            self._receive()
        # Views report that they have drawn; other scripts have ended when the page is loaded.
        if scripts and self.evaluate("Boolean(document.getElementById('viewer'))"):
            self.evaluate("""new Promise(function (done) { (function look() {
              const is_done = document.documentElement.classList.contains("no-view") || window.boughView && window.boughView.drawn > 0;
              is_done ? setTimeout(done, 100) : setTimeout(look, 10); })(); })""")

    def evaluate(self, text):
        answer = self.send("Runtime.evaluate", expression=text, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(json.dumps(answer["exceptionDetails"])[:600])
        return answer["result"].get("value")

    def saved(self, act):
        """Name and bytes of the file that a page saves after an expression; waits for it for ten seconds."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        self.send("Page.setDownloadBehavior", behavior="allow", downloadPath=str(folder))
        self.evaluate(act)
        for _ in range(200):
            done = [f for f in folder.iterdir() if f.suffix != ".crdownload" and not f.name.startswith(".")]
            if done and done[0].stat().st_size:
                return done[0].name, done[0].read_bytes()
            time.sleep(0.05)
        raise RuntimeError("nothing was saved after " + act)

    def screenshot(self, file):
        """The whole page as PNG."""
        answer = self.send("Page.captureScreenshot", captureBeyondViewport=True)
        pathlib.Path(file).write_bytes(base64.b64decode(answer["data"]))
