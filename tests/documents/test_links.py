"""The pages of docs/ are all in the navigation, and what Markdown files link to exists."""

import re
import tempfile
import unittest
from collections import Counter
from pathlib import Path

import markdown


class Navigation(unittest.TestCase):
    def test_every_page_of_docs_is_listed_once(self) -> None:
        docs = markdown.ROOT / "docs"
        listed = Counter(markdown.navigation((docs / "index.md").read_text()))
        self.assertGreater(len(listed), 50)
        twice = [page for page, count in listed.items() if count > 1]
        self.assertEqual(twice, [], "listed twice in docs/index.md")
        there = {str(page.relative_to(docs)) for page in docs.rglob("*.md")} - {"index.md"}
        self.assertEqual(there - set(listed), set(), "list them in docs/index.md")

    def test_entries_of_sections_count_and_other_links_do_not(self) -> None:
        index = "[a](a.md)\n\n## One\n\n- [B](guide/b.md), new\n- [C](../C.md)\n- see [d](d.md)\n"
        self.assertEqual(markdown.navigation(index), ["guide/b.md", "../C.md"])


class Links(unittest.TestCase):
    def test_relative_links_of_all_pages_exist(self) -> None:
        self.assertEqual("\n".join(markdown.broken_links()), "")

    def test_all_pages_are_read(self) -> None:
        names = {str(page.relative_to(markdown.ROOT)) for page in markdown.pages()}
        self.assertLessEqual({"README.md", "tests/README.md", "docs/theory/shells.md"}, names)

    def test_files_and_headings_that_are_missing_are_found(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "a.md").write_text(
                "# The *first* `[x]` heading, 2\n\n[b](b.md) [c](c.md)\n"
                "[own](#the-first-x-heading-2) [none](#second)\n[twice](b.md#twice-1) [thrice](b.md#twice-2)\n"
                "![picture](p.png) [web](https://a.example/c.md)\n"
                "`[code](d.md)`\n\n```\n[code](e.md)\n# code\n```\n\n[code](#code)\n\n[f]: f.md\n"
            )
            (root / "b.md").write_text("## Twice\n\n## Twice\n")
            (root / "build").mkdir()
            (root / "build" / "c.md").write_text("[other](other.md)\n")
            found = [line.split(": ")[1] for line in markdown.broken_links(root)]
        self.assertEqual(found, ["c.md", "#second", "b.md#twice-2", "p.png", "#code", "f.md"])

    def test_paths_that_pages_name_exist(self) -> None:
        """Paths in `code` of pages about the present: not of the changelog and the notebooks."""
        missing = []
        for page in markdown.pages():
            if page.name == "CHANGELOG.md" or "notebook" in page.parts:
                continue
            folders = "docs|scenes|tools|examples|materials|bench"
            for path in re.findall(rf"`((?:{folders})/[a-z0-9_./-]+)`", page.read_text()):
                if not (markdown.ROOT / path).exists():
                    missing.append(f"{page.relative_to(markdown.ROOT)}: {path}")
        self.assertEqual("\n".join(missing), "")


if __name__ == "__main__":
    unittest.main()
