"""Sphinx: the pages of this folder, and those that `generate.py` makes from the program itself."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

from discover import __version__  # noqa: E402 - the folder has to be on the path first

project = "inerter-discovery"
author = "The inerter-discovery authors"
release = version = __version__

extensions = [
    "myst_nb",
    "numpydoc",
    "sphinx.ext.autodoc",
    "mathml",
    "generate",
    "keys",
]
root_doc = "index"
exclude_patterns = ["_build"]
myst_enable_extensions = ["dollarmath", "deflist", "attrs_inline"]
myst_heading_anchors = 4
myst_links_external_new_tab = False
default_role = "py:obj"  # names between single backticks: links where there is a page for them
nb_execution_mode = "off"  # notebooks are shown as they are kept; `make notebooks` runs them
nb_ipywidgets_js = {}  # nothing from the network
numpydoc_show_class_members = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # numpydoc's sections tell them with shapes and units
suppress_warnings = ["mystnb.unknown_mime_type"]

html_theme = "furo"
html_title = "inerter-discovery"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_copyright = False
html_show_sourcelink = False
