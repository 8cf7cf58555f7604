"""Configure the documentation site: ``make docs`` writes ``docs/_build/html/index.html``, without the network."""

import sys
from pathlib import Path

from sphinx.application import Sphinx

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS.parent / "tools"))

from documentation.command_reference import command_reference  # noqa: E402
from documentation.docstrings import (  # noqa: E402
    keep_other_names,
    qualify_names,
    read_sections,
    shorten_arrays,
)
from documentation.json_reference import with_key_tables  # noqa: E402
from documentation.layout_lexer import LayoutLexer  # noqa: E402
from documentation.package_reference import write_package_pages  # noqa: E402
from documentation.page_examples import run_commands  # noqa: E402
from pygments.lexers.special import TextLexer  # noqa: E402

from deixis.version import VERSION  # noqa: E402

PAGES_WITH_PICTURES = ("tutorial/checked_table", "tutorial/seeing", "gallery")
"""The pages whose commands are run in ``docs/_pictures``, so that they show what their commands draw."""

project = "Deixis"
author = "the authors of Deixis"
project_copyright = "the authors of Deixis, Apache-2.0"
version = release = VERSION

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton"]
exclude_patterns = ["_build", "_pictures"]

html_theme = "furo"
html_title = f"Deixis {VERSION}"
html_copy_source = False
html_show_sphinx = False
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True

myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
add_module_names = False
python_use_unqualified_type_names = True
maximum_signature_line_length = 88
nitpicky = True


def insert_what_is_generated(app: Sphinx, page: str, source: list[str]) -> None:
    """Put the reference of the commands in the place of its mark, and the keys of JSON answers below their commands."""
    if page == "reference/commands":
        source[0] = source[0].replace("<!-- commands -->", command_reference())
    if page == "reference/json":
        source[0] = with_key_tables(source[0], DOCS / f"{page}.md", DOCS / "_pictures" / page)


def write_what_is_generated(app: Sphinx) -> None:
    """Write the pages of the packages, and draw the pictures of the pages that show some."""
    write_package_pages(DOCS / "reference" / "python")
    for page in PAGES_WITH_PICTURES:
        run_commands(DOCS / f"{page}.md", DOCS / "_pictures" / page)


def setup(app: Sphinx) -> None:
    """Connect what writes pages and reads docstrings, and register the languages of the examples."""
    app.connect("builder-inited", write_what_is_generated)
    app.connect("source-read", insert_what_is_generated)
    app.connect("autodoc-process-docstring", read_sections)
    app.connect("autodoc-process-signature", shorten_arrays)
    app.connect("doctree-read", qualify_names)
    app.connect("missing-reference", keep_other_names)
    app.add_lexer("layout", LayoutLexer)
    app.add_lexer("facts", LayoutLexer)
    app.add_lexer("layout-error", LayoutLexer)
    app.add_lexer("error", TextLexer)
