"""The command ``muslin sweep``, also ``python -m muslin.sweeps``."""

import argparse
import json
import math
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

from muslin.errors import Error, Interrupted
from muslin.sweeps.progress_line import ProgressLine
from muslin.sweeps.source import name_advice
from muslin.sweeps.sweep import Sweep, default_directory, describe, run_sweep
from muslin.tables import to_value


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        known = [word for action in self._actions for word in action.option_strings if word.startswith("--")]
        wrong = next(
            (word.split("=")[0].rstrip(":") for word in message.split() if word.startswith("--")), None
        )
        advice = name_advice(wrong, known) if wrong and wrong not in known else "see muslin sweep --help"
        sys.stderr.write(f"muslin: {message}; {advice}\n")
        sys.exit(2)


def _count(text: str) -> int:
    number = int(text) if text.isascii() and text.isdigit() else 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"`{text}` is no whole number of 1 or more")
    return number


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="muslin sweep",
        allow_abbrev=False,
        description="run a scene many times with other values of its keys; again to continue",
    )
    parser.add_argument("SWEEP", help="description of the sweep (.toml)")
    parser.add_argument("-o", "--output", help="directory of the sweep (default: out/SWEEP)")
    parser.add_argument("--workers", type=_count, help="processes (default: one per core)")
    parser.add_argument("--threads", type=_count, help="threads of each run (default: cores / workers)")
    parser.add_argument(
        "--ray",
        nargs="?",
        const="auto",
        metavar="ADDRESS",
        help="run on a Ray cluster (default: the one of RAY_ADDRESS)",
    )
    parser.add_argument("--limit", type=_count, help="the most runs allowed (default: 1000)")
    parser.add_argument("--plan", action="store_true", help="list the runs, simulate nothing")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.add_argument("--strict", action="store_true", help="exit code 4 if a run failed")
    parser.add_argument("--quiet", action="store_true", help="no progress, only errors")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command and returns its exit code."""
    words = _parser().parse_args(arguments)

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, stop)
    try:
        return _run(words)
    except (KeyboardInterrupt, Interrupted):
        sys.stderr.write("muslin: stopped; the same command continues the sweep\n")
        return 130
    except Error as error:
        sys.stderr.write(f"muslin: {error}\n")
        return error.exit_code


def _run(words: argparse.Namespace) -> int:
    description = describe(words.SWEEP, {}, limit=words.limit)
    if words.plan:
        if description.search:
            print(f"{description.count} runs in batches of {description.search.batch}")
            return 0
        for number, point in enumerate(description.points(), start=1):
            print(
                f"{number:04d}  " + "  ".join(f"{key}={to_value(value, key)}" for key, value in point.items())
            )
        return 0
    directory = Path(words.output) if words.output else default_directory(words.SWEEP, description)
    line = ProgressLine(description.count, words.quiet)
    try:
        made = run_sweep(
            description,
            directory,
            workers=words.workers,
            threads=words.threads,
            ray=words.ray,
            progress=line,
            cancel=None,
        )
    finally:
        line.finish()
    if words.json:
        print(json.dumps(_summary(made), indent=2))
    elif not words.quiet:
        print(_text(made, directory))
    if words.strict and made.failed:
        failed = made.failed[0]
        sys.stderr.write(
            f"muslin: {directory}: {len(made.failed)} of {len(made.rows)} runs failed, "
            f"run {failed['run']}: {failed['message']}\n"
        )
        return 4
    return 0


def _text(made: Sweep, directory: Path) -> str:
    text = f"{len(made.rows)} runs, {len(made.failed)} failed\n"
    for row in made.failed[:5]:
        text += f"run {row['run']}: exit code {row['exit_code']}: {row['message']}\n"
    if made.best:
        text += (
            f"best run {made.best['run']}: "
            + ", ".join(f"{key} = {made.best[key]}" for key in made.keys)
            + "\n"
        )
    return text + "\n".join(str(directory / file.name) for file in made.files)


def _summary(made: Sweep) -> dict[str, Any]:
    return {
        "directory": str(made.directory),
        "runs": len(made.rows),
        "failed": len(made.failed),
        "workers_replaced": made.lost,
        "keys": made.keys,
        "best": _finite(made.best) if made.best else None,
        "rows": [_finite(row) for row in made.rows],
    }


def _finite(row: dict[str, Any]) -> dict[str, Any]:
    """A row as strict JSON has it: null for what is not finite."""
    return {
        key: None if isinstance(cell, float) and not math.isfinite(cell) else cell
        for key, cell in row.items()
    }


if __name__ == "__main__":
    sys.exit(main())
