"""Progress of a sweep as a line on a terminal, or as ten lines in a file."""

import sys
import time


class ProgressLine:
    """Counts runs and frames, and writes what is done and the time left to standard error."""

    def __init__(self, total: int, quiet: bool) -> None:
        self._total, self._done, self._at_start = total, 0, 0
        self._quiet, self._terminal = quiet, sys.stderr.isatty()
        self._shares: dict[int, float] = {}
        self._lost = 0
        self._begin, self._drawn, self._tenth = time.monotonic(), 0.0, -1

    def frame(self, number: int, frame: int, last: int) -> None:
        """A run has finished a frame."""
        self._shares[number] = frame / max(last, 1)
        self._show()

    def done(self, number: int, kept: bool = False) -> None:
        """A run has a result, now or from earlier."""
        self._shares.pop(number, None)
        self._done += 1
        self._at_start += kept
        self._show()

    def lost(self, number: int, reason: str) -> None:
        """The worker of a run was lost."""
        self._lost += 1
        self._say(f"run {number}: its worker was lost ({reason}); another one continues it\n")

    def finish(self) -> None:
        """Ends the line."""
        if self._drawn and self._terminal:
            self._say("\n")

    def _show(self) -> None:
        if self._quiet:
            return
        fraction = (self._done + sum(self._shares.values())) / self._total
        now = time.monotonic()
        if self._terminal:
            if self._done < self._total and now - self._drawn < 0.1:
                return
        elif int(fraction * 10) == self._tenth:
            return
        self._drawn, self._tenth = now, int(fraction * 10)
        made, elapsed = fraction - self._at_start / self._total, now - self._begin
        left = ""
        if self._done >= self._total:
            left = "  " + _duration(elapsed)
        elif made > 0 and elapsed > 0.5:
            left = f"  {_duration(elapsed / made * (1 - fraction))} left"
        lost = f", {self._lost} workers replaced" if self._lost else ""
        text = f"{100 * fraction:3.0f} %  {self._done} of {self._total} runs{lost}{left}"
        self._say(f"\r\033[K{text}" if self._terminal else f"{text}\n")

    def _say(self, text: str) -> None:
        if not self._quiet:
            sys.stderr.write(text)
            sys.stderr.flush()


def _duration(seconds: float) -> str:
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60}:{whole % 60:02} min"
    return f"{whole // 3600}:{whole // 60 % 60:02} h"
