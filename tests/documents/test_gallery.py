"""The gallery shows every scene, and its page follows from docs/gallery.toml."""

import importlib.machinery
import importlib.util
import unittest

from markdown import ROOT

loader = importlib.machinery.SourceFileLoader("gallery", str(ROOT / "tools/gallery"))
gallery = importlib.util.module_from_spec(importlib.util.spec_from_loader("gallery", loader))
loader.exec_module(gallery)


class Gallery(unittest.TestCase):
    def setUp(self) -> None:
        self.groups = gallery.read_groups()
        self.scenes = {scene: entry for group in self.groups.values() for scene, entry in group.items()}

    def test_every_scene_has_one_line(self) -> None:
        files = ROOT / "scenes"
        there = {str(file.relative_to(files).with_suffix("")) for file in files.rglob("*.toml")}
        self.assertEqual(set(self.scenes), there)
        self.assertEqual(sum(len(group) for group in self.groups.values()), len(there))

    def test_names_of_pictures_differ(self) -> None:
        self.assertEqual(len({gallery.name_of(scene) for scene in self.scenes}), len(self.scenes))

    def test_entries_have_known_keys(self) -> None:
        for scene, entry in self.scenes.items():
            self.assertLessEqual({"shows", "still"}, set(entry), scene)
            self.assertLessEqual(set(entry), {"shows", "still", "view", "frames"}, scene)

    def test_every_scene_has_its_picture(self) -> None:
        pictures = {picture.stem for picture in (ROOT / "docs/pictures/gallery").glob("*.jpg")}
        names = {gallery.name_of(scene) for scene in self.scenes}
        self.assertEqual(pictures, names, "run tools/gallery --draw")

    def test_page_follows_from_the_list(self) -> None:
        page = (ROOT / "docs/gallery.md").read_text()
        self.assertEqual(page, gallery.page(self.groups), "run tools/gallery")

    def test_a_movie_is_linked_where_there_is_one(self) -> None:
        scenes = {"contact/funnel": {"shows": "a"}, "contact/no_movie": {"shows": "b"}}
        page = gallery.page({"Contact": scenes})
        self.assertIn("[![funnel](pictures/gallery/funnel.jpg)](movies/funnel.mp4)", page)
        self.assertIn("| ![no_movie](pictures/gallery/no_movie.jpg) |", page)


if __name__ == "__main__":
    unittest.main()
