"""A browser under test: the W3C WebDriver protocol spoken to chromedriver over plain HTTP.

W3C Recommendation "WebDriver" (5 June 2018); `goog/cdp/execute` and `se/log` are chromedriver's own additions.
"""

from __future__ import annotations

import base64
import shutil
import socket
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
ENTER = "\ue007"
CLICKS = 5
AIM = """
    const [element] = arguments;
    window.clickArrived = false;
    element.addEventListener("click", () => { window.clickArrived = true; }, { once: true, capture: true });
    element.scrollIntoView({ block: "center" });
"""
MISSED = ("element click intercepted", "stale element reference", "element not interactable")
LOOKING = ("/execute/sync", "/se/log")
"""Calls that leave a page as it is, if their scripts do."""
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--force-device-scale-factor=1",
    "--disable-extensions",
    "--disable-default-apps",
    "--renderer-process-limit=1",
    "--disable-features=SpareRendererForSitePerProcess,BackForwardCache",
)


class WebDriverError(Exception):
    """What chromedriver refused."""


def missing() -> str:
    """What is not installed, in words; empty when a browser can be started."""
    wanted = {"chromium": browser_path(), "chromedriver": shutil.which("chromedriver")}
    return ", ".join(name for name, path in wanted.items() if path is None)


def browser_path() -> str | None:
    """The browser's program."""
    names = ("chromium", "chromium-browser", "google-chrome")
    return next((path for path in map(shutil.which, names) if path), None)


class Browser:
    """One window with an empty profile."""

    def __init__(self, profile: Path, *, width: int = 1400, height: int = 1000) -> None:
        port = _free_port()
        program = shutil.which("chromedriver")
        assert program is not None
        self._process = subprocess.Popen([program, f"--port={port}"], stdout=subprocess.DEVNULL)
        self._http = httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=60, trust_env=False)
        eventually(self._listening, what="chromedriver to listen")
        options = {
            "binary": browser_path(),
            "args": [*FLAGS, f"--user-data-dir={profile}", f"--window-size={width},{height}"],
        }
        wanted = {"browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        self._session, self._opened, self._shown, self._sized = "", 0, "", False
        self._session = self._call("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})["sessionId"]

    def _listening(self) -> bool:
        try:
            return bool(self._http.get("/status").json()["value"]["ready"])
        except httpx.TransportError:
            return False

    def _call(self, method: str, path: str, body: dict[str, Any] | None = None) -> Any:
        url = f"/session/{self._session}{path}" if self._session else path
        if method == "POST" and not path.startswith(LOOKING):
            self._shown = ""
        value = self._http.request(method, url, json=body if method == "POST" else None).json()["value"]
        if isinstance(value, dict) and "error" in value:
            raise WebDriverError(f"{value['error']}: {value['message']}")
        return value

    def open(self, url: str) -> None:
        """Load a page anew, also when only the part after # differs.

        The dashboard by a query of its own, which it does not read: after an empty page between them each page would be
        rendered by a process of its own. Other addresses may refuse queries.
        """
        address, _, place = url.partition("#")
        if address.endswith("/"):
            self._opened += 1
            url = f"{address}?{self._opened}#{place}"
        else:
            self.leave()
        self._call("POST", "/url", {"url": url})

    def show(self, url: str) -> None:
        """Load a page unless it is the last one shown and was only looked at since: by scripts that change nothing."""
        if url != self._shown:
            self.open(url)
            self._shown = url

    def leave(self) -> None:
        """To an empty page: nothing asks a server any more, so it may end."""
        self._call("POST", "/url", {"url": "about:blank"})

    def run(self, script: str, *args: object) -> Any:
        """Run a function body in the page; a promise is waited for."""
        return self._call("POST", "/execute/sync", {"script": script, "args": list(args)})

    def cdp(self, command: str, **params: object) -> Any:
        """A command of the DevTools protocol."""
        return self._call("POST", "/goog/cdp/execute", {"cmd": command, "params": params})

    def find(self, css: str, *, within_s: float = 15.0) -> str:
        """Handle of the first visible element that matches; waits for it."""
        script = "return [...document.querySelectorAll(arguments[0])].find((e) => e.getClientRects().length) ?? null"
        found: list[Any] = []

        def there() -> bool:
            found[:] = [self.run(script, css)]
            return found[0] is not None

        eventually(there, within_s=within_s, what=f"{css} to be seen")
        return str(found[0][ELEMENT])

    def click(self, css: str) -> None:
        """A real click, scrolled to first; again where the page moved meanwhile and something else was hit."""
        for _ in range(CLICKS):
            handle = self.find(css)
            self.run(AIM, {ELEMENT: handle})
            try:
                self._call("POST", f"/element/{handle}/click", {})
            except WebDriverError as error:
                if not str(error).startswith(MISSED):
                    raise
                continue
            if self.run("return window.clickArrived !== false"):
                return
        raise AssertionError(f"{CLICKS} clicks on {css} hit something else")

    def type(self, css: str, text: str, *, clear: bool = False) -> None:
        """Real key strokes into an element."""
        handle = self.find(css)
        if clear:
            self._call("POST", f"/element/{handle}/clear", {})
        self._call("POST", f"/element/{handle}/value", {"text": text})

    def text(self, css: str) -> str:
        """What is read there; waits for the element."""
        return str(self._call("GET", f"/element/{self.find(css)}/text"))

    def count(self, css: str) -> int:
        """How many elements match now."""
        return int(self.run("return document.querySelectorAll(arguments[0]).length", css))

    def complaints(self) -> list[str]:
        """Errors of the console since the last call: refused scripts, uncaught errors, failed requests."""
        log = self._call("POST", "/se/log", {"type": "browser"})
        return [str(line["message"]) for line in log if line["level"] == "SEVERE"]

    def size(self, width: int, height: int = 1000) -> None:
        """Make the page so wide, narrower than a window can be."""
        self._sized = True
        self.cdp(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600
        )

    def unsize(self) -> None:
        """The window's own size again, if it was changed."""
        if self._sized:
            self.cdp("Emulation.clearDeviceMetricsOverride")
            self._sized = False

    def screenshot(self) -> bytes:
        """PNG of the window."""
        return base64.b64decode(self._call("GET", "/screenshot"))

    def close(self) -> None:
        """End the browser, then its driver."""
        try:
            if self._session:
                self._call("DELETE", "")
        finally:
            self._http.close()
            self._process.terminate()
            self._process.wait(10)


def eventually(condition: Callable[[], object], *, within_s: float = 15.0, what: str = "it") -> None:
    """Wait for something; fails when it does not come."""
    deadline = time.monotonic() + within_s
    while time.monotonic() < deadline:
        if condition():
            return
        time.sleep(0.05)
    raise AssertionError(f"waited {within_s:g} s for {what}")


def _free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return int(listener.getsockname()[1])
