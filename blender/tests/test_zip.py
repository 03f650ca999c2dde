"""The add-on as a zip: what `muslin blender-addon` writes and what blender/package makes of the sources."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("MUSLIN_PROGRAM", str(ROOT / "build" / "release" / "muslin"))


class Zip(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="muslin.")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def written(self, *words):
        path = self.folder / "new" / "add on.zip"
        subprocess.run([PROGRAM, "blender-addon", "-o", path, *words], check=True, capture_output=True)
        return zipfile.ZipFile(path)

    def packaged(self):
        command = [sys.executable, ROOT / "blender" / "package", "-o", self.folder]
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        return zipfile.ZipFile(printed.strip())

    def test_the_program_has_the_files_of_the_sources(self):
        with self.written("--without-program") as written, self.packaged() as packaged:
            self.assertIsNone(written.testzip())
            self.assertEqual(sorted(written.namelist()), sorted(packaged.namelist()))
            for name in packaged.namelist():
                self.assertTrue(written.read(name) == packaged.read(name), f"{name} differs")

    def test_the_program_puts_itself_inside(self):
        with self.written() as written:
            self.assertEqual(written.getinfo("muslin_cloth/bin/muslin").external_attr >> 16, 0o100755)
            self.assertTrue(written.read("muslin_cloth/bin/muslin") == pathlib.Path(PROGRAM).read_bytes())
            self.assertEqual(written.getinfo("muslin_cloth/__init__.py").external_attr >> 16, 0o100644)

    def test_other_suffixes_are_refused(self):
        done = subprocess.run([PROGRAM, "blender-addon", "-o", self.folder / "addon.tar"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("name it FILE.zip", done.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
