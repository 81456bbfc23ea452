"""A bar on stderr: how far, how fast, how long still. A line now and then where stderr is no terminal and it is asked for."""

from __future__ import annotations

import sys
import time

#: A bar moves so often, s; without a terminal there is a line so often.
BEAT_S = 0.1
LINE_S = 10.0
WIDTH = 24


class Progress:
    """Told of parts as they are done. ``wanted``: always, never, or (None) where stderr is a terminal."""

    def __init__(self, wanted: bool | None, evaluations: int, done: int) -> None:
        self._all, self._done, self._before = evaluations, done, done
        self._terminal = sys.stderr.isatty()
        self._shown = self._terminal if wanted is None else wanted
        self._any = False
        self.begin()

    def begin(self) -> None:
        """The clock starts: workers are there."""
        self._began = self._told = time.monotonic()

    def note(self, text: str) -> None:
        """A line of its own."""
        if self._shown:
            print(f"{self._clear()}{text}", file=sys.stderr, flush=True)

    def add(self, evaluations: int) -> None:
        """So many more are done."""
        self._done += evaluations
        now = time.monotonic()
        if self._shown and now - self._told > (BEAT_S if self._terminal else LINE_S):
            self._told = now
            self._tell(now)

    def end(self) -> None:
        """The last word."""
        if self._shown:
            self._tell(time.monotonic())
            if self._terminal:
                print(file=sys.stderr, flush=True)

    def _tell(self, now: float) -> None:
        self._any = True
        print(f"{self._clear()}{self.line(now)}", end="" if self._terminal else "\n", file=sys.stderr, flush=True)

    def _clear(self) -> str:
        return "\r\x1b[K" if self._terminal and self._any else ""

    def line(self, now: float) -> str:
        """now -> what the bar says: how far, of how many, how fast, how long still."""
        part = self._done / self._all
        rate = (self._done - self._before) / max(now - self._began, 1e-9)
        filled = int(part * WIDTH)
        bar = "#" * filled + "." * (WIDTH - filled)
        text = f"[{bar}] {100 * part:5.1f} %  {self._done:.3g} of {self._all:.3g} evaluations"
        if not rate:
            return text
        return f"{text}  {rate:.3g}/s  {_duration((self._all - self._done) / rate)} left"


def _duration(seconds: float) -> str:
    whole = round(seconds)
    hours, minutes = whole // 3600, whole // 60 % 60
    return f"{hours}:{minutes:02d}:{whole % 60:02d}" if hours else f"{minutes}:{whole % 60:02d}"
