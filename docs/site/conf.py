"""The documentation site: `make site` builds it with Sphinx into build/site."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(Path(__file__).parent))
sys.dont_write_bytecode = True

project = "muslin"
author = "The muslin contributors"
version = release = re.search(r"project\(muslin VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]

# The sources are the Markdown files where they lie, so that relative links hold here and on a forge.
extensions = ["myst_parser", "sphinx_copybutton", "site_pages"]
root_doc = "docs/index"
include_patterns = [
    "docs/*.md", "docs/*/*.md", "tests/README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md",
]
exclude_patterns = ["build", "out", "**/node_modules"]
myst_heading_anchors = 6

highlight_language = "none"  # of code whose language is not named

html_theme = "furo"
html_title = f"muslin {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_js_files = ["movies.js"]
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
copybutton_prompt_text = "$ "
