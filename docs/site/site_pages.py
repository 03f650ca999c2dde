"""Adds to the Markdown files navigation, the names of the C++ interface, and a check of all links."""

import posixpath
import re
import shutil
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

INDEX = "docs/index"
CPP = "docs/guide/cpp"
REFERENCE = "reference"


def with_navigation(text: str) -> str:
    """The index with a hidden table of contents for each `##` section: the links of its list, in order."""
    parts = []
    for section in re.split(r"^(?=## )", text, flags=re.M):
        parts.append(section)
        links = re.findall(r"^- \[([^\]]+)\]\(([^)#]+)\.md\)", section, flags=re.M)
        if section.startswith("## ") and links:
            caption = section.split("\n")[0].removeprefix("## ")
            pages = [f"{title} </{posixpath.normpath(f'docs/{page}')}>" for title, page in links]
            lines = ["```{toctree}", ":hidden:", f":caption: {caption}", "", *pages, "```", "", ""]
            parts.append("\n".join(lines))
    return "".join(parts)


def add_navigation(app: Sphinx, page: str, source: list[str]) -> None:
    if page == INDEX:
        source[0] = with_navigation(source[0])


def names_of_headers(tags: Path) -> list[tuple[str, str, list[tuple[str, str]]]]:
    """For each header its path, its page and the names that it declares with their pages, by doxygen's tags."""
    compounds = ElementTree.parse(tags).getroot().findall("compound")
    types = [compound for compound in compounds if compound.get("kind") in ("class", "struct")]
    pages = {compound.findtext("name"): compound.findtext("filename") for compound in types}
    headers = []
    for file in (c for c in compounds if c.get("kind") == "file" and c.findtext("name", "").endswith(".hpp")):
        names = {name: pages[name] for name in (c.text or "" for c in file.findall("class")) if name in pages}
        for member in (m for m in file.findall("member") if m.get("kind") != "define"):
            anchor = f"{member.findtext('anchorfile')}#{member.findtext('anchor')}"
            names.setdefault(member.findtext("name", ""), anchor)
        path = (file.findtext("path", "") + file.findtext("name", "")).rpartition("/src/")[2]
        listed = sorted((name.removeprefix("muslin::"), page) for name, page in names.items())
        headers.append((path, file.findtext("filename", ""), listed))
    return sorted(headers)


def link(text: str, page: str) -> nodes.reference:
    name, _, anchor = page.partition("#")
    address = f"../../{REFERENCE}/{name.removesuffix('.html')}.html" + (f"#{anchor}" if anchor else "")
    return nodes.reference("", "", nodes.literal(text=text), refuri=address)


def add_names(app: Sphinx, doctree: nodes.document) -> None:
    if app.env.docname != CPP:
        return
    section = nodes.section(ids=["classes-and-functions"], names=["classes and functions"])
    section += nodes.title(text="Classes and functions")
    paragraph = nodes.paragraph(text="Every public header and the names that it declares. ")
    paragraph += nodes.reference("", "The pages of the headers", refuri=f"../../{REFERENCE}/index.html")
    paragraph += nodes.Text(" have a search of their own, by name.")
    section += paragraph
    entries = nodes.bullet_list()
    headers = names_of_headers(Path(app.config.muslin_reference, "tags.xml"))
    if not headers:
        raise ExtensionError("the reference has no headers")
    for path, page, names in headers:
        line = nodes.paragraph()
        line += [link(path, page)] + ([nodes.Text(": ")] if names else [])
        for number, (name, target) in enumerate(names):
            line += ([nodes.Text(", ")] if number else []) + [link(name, target)]
        entries += nodes.list_item("", line)
    section += entries
    doctree.children[0] += section


class Links(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found: set[str] = set()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.found.update(value for name, value in attributes if name in ("href", "src") and value)


def broken_links(site: Path) -> list[str]:
    """Links of the pages to files that the site lacks."""
    broken = []
    for page in sorted(site.rglob("*.html")):
        if "_static" in page.parts:
            continue
        links = Links()
        links.feed(page.read_text())
        for address in sorted(links.found):
            parts = urlsplit(address)
            if parts.scheme or parts.netloc or not parts.path or (page.parent / unquote(parts.path)).exists():
                continue
            broken.append(f"{page.relative_to(site)}: {address}")
    return broken


def finish(app: Sphinx, failure: Exception | None) -> None:
    """Adds the pages of the headers and the page at the top of the site, and checks all links."""
    if failure or app.builder.name != "html":
        return
    site = Path(app.outdir)
    shutil.copytree(Path(app.config.muslin_reference, "html"), site / REFERENCE, dirs_exist_ok=True)
    (site / "index.html").write_text(
        '<!doctype html><title>muslin</title><meta http-equiv="refresh" content="0; url=docs/index.html">\n'
        '<a href="docs/index.html">muslin</a>\n'
    )
    broken = broken_links(site)
    if broken:
        raise ExtensionError("links to files that do not exist:\n" + "\n".join(broken))


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_config_value("muslin_reference", "", "env", types=str)
    app.connect("source-read", add_navigation)
    app.connect("doctree-read", add_names)
    app.connect("build-finished", finish)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
