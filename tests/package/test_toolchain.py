"""Programs that are linked as those of a wheel need glibc 2.28 only, start, and share one C++ runtime."""

import pathlib
import re
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

LIBRARY = """
#include <stdexcept>
#include <system_error>
__attribute__((visibility("default"))) void refuse() { throw std::invalid_argument("refused"); }
__attribute__((visibility("default"))) std::error_code missing() { return std::make_error_code(std::errc::no_such_file_or_directory); }
"""

PROGRAM = """
#include <cstdio>
#include <exception>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <system_error>
#include <thread>
void refuse();
std::error_code missing();
struct Greeting {
  Greeting() { std::puts("constructed"); }
  ~Greeting() { std::puts("destroyed"); }
} greeting;
int main(int count, char** words) {
  std::thread([] { std::puts("thread"); }).join();
  try {
    refuse();
  } catch (const std::invalid_argument& error) {
    std::puts(error.what());
  }
  std::printf("%d %d %d\\n", count, std::uncaught_exceptions(), missing() == std::errc::no_such_file_or_directory);
  return std::random_device{}() == 0 && !std::filesystem::is_regular_file(words[0]);
}
"""


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


class Toolchain(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="muslin.")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        (self.folder / "built").mkdir()
        run(ROOT / "packaging" / "wheel" / "toolchain", self.folder)
        flags = (self.folder / "flags").read_text()
        self.compile = re.search(r'compile="(.*)"', flags)[1].split()
        self.link = re.search(r'link="(.*)"', flags)[1].split()

    def build(self, name, text, *words):
        source = self.folder / f"{name}.cpp"
        source.write_text(text)
        run("g++", "-std=c++20", "-O2", "-fPIC", *self.compile, source, "-o", self.folder / "built" / name, *words, *self.link,
            f"-Wl,-rpath,{self.folder}/runtime:{self.folder}/built")
        return self.folder / "built" / name

    def test_programs_run_and_need_an_old_glibc_only(self):
        library = self.build("librefuse.so", LIBRARY, "-shared", "-Wl,-soname,librefuse.so")
        program = self.build("program", PROGRAM, library)
        self.assertEqual(run(program).split("\n"), ["constructed", "thread", "refused", "1 0 1", "destroyed", ""])
        for file in (library, program, self.folder / "runtime" / "libmuslin_cxx.so"):
            described = run("readelf", "-W", "-d", "-V", "--dyn-syms", file)
            versions = [tuple(map(int, v.split("."))) for v in re.findall(r"Name: GLIBC_([0-9.]+)", described)]
            self.assertLessEqual(max(versions, default=(0,)), (2, 28), file)
            self.assertNotIn("libstdc++", described)
            self.assertNotRegex(described, r"\bUNIQUE\b")
        # Where these functions were before glibc 2.34.
        self.assertRegex(run("readelf", "-d", program), r"NEEDED.*libpthread\.so\.0")


if __name__ == "__main__":
    unittest.main()
