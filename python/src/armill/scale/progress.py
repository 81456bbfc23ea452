"""A progress bar on stderr: progress, rate, remaining time. If requested without a terminal, a line at intervals."""

from __future__ import annotations

import sys
import time

#: Interval of a bar, and of a line without a terminal, s.
BEAT_S = 0.1
LINE_S = 10.0
WIDTH = 24


class Progress:
    """Shows finished parts. ``show``: always, never, or (None) if stderr is a terminal."""

    def __init__(self, show: bool | None, evaluations: int, done: int) -> None:
        self._all, self._done, self._before = evaluations, done, done
        self._terminal = sys.stderr.isatty()
        self._shown = self._terminal if show is None else show
        self._any = False
        self.begin()

    def begin(self) -> None:
        """Starts the clock when the workers are available."""
        self._began = self._reported = time.monotonic()

    def note(self, text: str) -> None:
        """A separate line."""
        if self._shown:
            print(f"{self._clear()}{text}", file=sys.stderr, flush=True)

    def add(self, evaluations: int) -> None:
        """Adds finished evaluations."""
        self._done += evaluations
        now = time.monotonic()
        if self._shown and now - self._reported > (BEAT_S if self._terminal else LINE_S):
            self._reported = now
            self._report(now)

    def end(self) -> None:
        """The last word."""
        if self._shown:
            self._report(time.monotonic())
            if self._terminal:
                print(file=sys.stderr, flush=True)

    def _report(self, now: float) -> None:
        self._any = True
        print(f"{self._clear()}{self.line(now)}", end="" if self._terminal else "\n", file=sys.stderr, flush=True)

    def _clear(self) -> str:
        return "\r\x1b[K" if self._terminal and self._any else ""

    def line(self, now: float) -> str:
        """now -> the text of the bar: finished, total, rate, remaining time."""
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
