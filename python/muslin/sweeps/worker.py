"""A worker process of a sweep: ``python -m muslin.sweeps.worker THREADS``.

Reads jobs as lines of JSON from standard input, and writes the lines "ready", "frame N LAST" and "done" to
standard output. When standard input ends, the current run stops in a way that can be continued.
"""

import json
import os
import queue
import sys
import threading
import time

from muslin._muslin import set_thread_count
from muslin.errors import Interrupted
from muslin.sweeps.job import Job, execute

BETWEEN_LINES = 0.1
"""Seconds between two lines about frames."""


def main() -> None:
    """Executes jobs until there are no more."""
    set_thread_count(int(sys.argv[1]))
    output = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # what libraries print does not mix with the lines
    stop, lines = threading.Event(), queue.SimpleQueue[str]()

    def listen() -> None:
        for line in sys.stdin:
            lines.put(line)
        stop.set()
        lines.put("")

    threading.Thread(target=listen, daemon=True).start()
    said = 0.0

    def report(frame: int, last: int) -> None:
        nonlocal said
        if time.monotonic() - said > BETWEEN_LINES:
            said = time.monotonic()
            output.write(f"frame {frame} {last}\n")

    output.write("ready\n")
    while line := lines.get():
        job = Job(**json.loads(line))
        try:
            execute(job, report, stop.is_set)
        except Interrupted:
            break
        output.write("done\n")


if __name__ == "__main__":
    try:
        main()
    except BrokenPipeError:  # the sweep is gone
        os._exit(1)
