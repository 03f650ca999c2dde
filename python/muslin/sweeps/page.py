"""The page of a sweep: one HTML file with the table, pictures and curves of all runs."""

import base64
import html
import json
import math
import re
from collections import Counter
from pathlib import Path
from typing import Any

from muslin._muslin import version
from muslin.sweeps.description import Description, Row
from muslin.sweeps.directory import SweepDirectory, write_atomically
from muslin.sweeps.table import columns_of

MOST_PICTURES = 24_000_000
"""Bytes of pictures in a page; further ones are shown from the run directories."""


def write_page(
    file: Path, description: Description, rows: list[Row], place: SweepDirectory, best: int | None
) -> None:
    """Writes the page. It needs no network; with the directory of the sweep beside it, its links work."""
    left = MOST_PICTURES
    runs = []
    for row in rows:
        number = int(row["run"])
        result = place.result(number) or {"files": [], "curves": {}}
        folder = place.run(number)
        link = folder.relative_to(place.path).as_posix()
        picture = folder / "picture.png"
        source = None
        if "picture.png" in result["files"] and picture.exists():
            source = f"{link}/picture.png"
            if picture.stat().st_size <= left:
                left -= picture.stat().st_size
                source = "data:image/png;base64," + base64.b64encode(picture.read_bytes()).decode()
        pages = [
            [name, f"{link}/{name}.html"] for name in ("report", "view") if (folder / f"{name}.html").exists()
        ]
        links = [*pages, ["files", f"{link}/"]] if folder.exists() else pages
        runs.append({"picture": source, "links": links, "curves": result["curves"]})
    columns = columns_of(rows)
    data = {
        "keys": description.keys,
        "columns": columns,
        "rows": [[_cell(row.get(column)) for column in columns] for row in rows],
        "runs": runs,
        "best": best,
        "objective": description.search.objective
        if description.search and isinstance(description.search.objective, str)
        else None,
    }
    counts = Counter(row["status"] for row in rows)
    about = ", ".join(
        f"{counts[status]} {status}" for status in ("finished", "failed", "missing") if counts[status]
    )
    text = (Path(__file__).parent / "page.html").read_text()
    parts = {
        "%TITLE%": html.escape(description.title),
        "%ABOUT%": html.escape(f"{len(rows)} runs: {about}" if rows else "no runs yet"),
        "%SCENE%": html.escape(Path(description.scene.file).name),
        "%VERSION%": html.escape(version()),
        "%DATA%": json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
    }
    # In one pass, so that what is filled in is not searched again.
    text = re.sub("|".join(parts), lambda match: parts[match.group()], text)
    write_atomically(file, text.encode())


def _cell(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value
