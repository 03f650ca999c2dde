"""Links, headings and anchors of Markdown files, as forges make them."""

import os
import re
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parents[2]
OTHERS = {"build", "out", "node_modules", ".git", ".cache"}


def pages(root: Path = ROOT) -> list[Path]:
    """All Markdown files, except those of builds and of other projects."""
    found = []
    for folder, folders, files in os.walk(root):
        folders[:] = [name for name in folders if name not in OTHERS]
        found += [Path(folder, name) for name in files if name.endswith(".md")]
    return sorted(found)


def prose(text: str) -> str:
    """The text without blocks of code."""
    return re.sub(r"^( *)(```+|~~~+).*?^ *\2`*$", "", text, flags=re.M | re.S)


def links(text: str) -> list[str]:
    """Targets of links and pictures, except those in code."""
    without_code = re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", "", prose(text), flags=re.S)
    inline = re.findall(r"\]\(\s*<?([^)\s>]+)", without_code)
    return inline + re.findall(r"^\[[^\]]+\]:\s+(\S+)", without_code, flags=re.M)


def anchors(text: str) -> set[str]:
    """Anchors of the headings: small letters, hyphens for spaces, no punctuation, a number if repeated."""
    found: set[str] = set()
    for heading in re.findall(r"^#{1,6} +(.+?)\s*#*$", prose(text), flags=re.M):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = anchor = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        number = 0
        while anchor in found:
            number += 1
            anchor = f"{slug}-{number}"
        found.add(anchor)
    return found | set(re.findall(r"""<a (?:id|name)=["']([^"']+)""", text))


def broken_links(root: Path = ROOT) -> list[str]:
    """Relative links of all pages whose file or anchor does not exist."""
    broken = []
    for page in pages(root):
        for link in links(page.read_text()):
            if re.match(r"[a-z][a-z+.-]*:", link):
                continue
            name, _, anchor = link.partition("#")
            target = page.parent / unquote(name) if name else page
            if not target.exists():
                broken.append(f"{page.relative_to(root)}: {link}: there is no such file")
            elif anchor and (target.suffix != ".md" or unquote(anchor) not in anchors(target.read_text())):
                broken.append(f"{page.relative_to(root)}: {link}: there is no such heading")
    return broken


def navigation(index: str) -> list[str]:
    """Pages that the lists of docs/index.md name, in their order, relative to docs/."""
    listed = re.findall(r"^- \[[^\]]+\]\(([^)#]+\.md)\)", index, flags=re.M)
    return [os.path.normpath(page) for page in listed]
