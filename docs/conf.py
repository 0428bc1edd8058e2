"""How Sphinx makes a book of these pages; `scripts/build-book` calls it, in a copy that has the generated pages, too."""

import re

from docutils.utils.math.latex2mathml import tex2mathml

project = "voronaut"
author = "the authors of voronaut"
root_doc = "docs/index"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
include_patterns = ["docs/**", "*.md", "data/*.md"]
exclude_patterns = ["docs/pages"]

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
# Readers of code on a forge see the same blocks.
suppress_warnings = ["myst.strikethrough"]

autodoc_mock_imports = ["voronaut._voronaut"]
autodoc_member_order = "bysource"
autodoc_typehints = "none"
default_role = "code"
napoleon_google_docstring = False

# `--` is in options.
smartquotes = False

html_theme = "furo"
html_title = "voronaut"
html_copy_source = html_show_sourcelink = False
html_static_path = ["static"]
html_css_files = ["book.css"]
html_math_renderer = "mathml"
pygments_style, pygments_dark_style = "friendly", "monokai"


LISTED = re.compile(r"^- \[([^]]*)\]\(([^)#]*)\.md\)", re.MULTILINE)


def toctree(captions: list[tuple[str, list[str]]]) -> str:
    trees = ("\n".join(["```{toctree}", ":hidden:", f":caption: {caption}", "", *pages, "```"]) for caption, pages in captions)
    return "\n\n" + "\n\n".join(trees) + "\n"


def add_toctree(_app, page: str, source: list[str]) -> None:
    """The tree of pages is what the lists of links in `index.md` say, heading by heading, so that there is no other list of them."""
    if page == root_doc:
        parts = re.split(r"^## (.*)\n", source[0], flags=re.MULTILINE)[1:]
        lists = [[f"{words} <{path}>" for words, path in LISTED.findall(text)] for text in parts[1::2]]
        source[0] += toctree(list(zip(parts[::2], lists)))
    elif page == "docs/reference":
        source[0] += toctree([("Reference", [f"reference/{name}" for name in ("commands", "report", "python", "rust")])])
    elif page == "docs/reference/commands":
        source[0] += "\n\n```{toctree}\n:hidden:\n:glob:\n\ncommands/*\n```\n"


def hide_lines(_app, _page: str, source: list[str]) -> None:
    """Lines that rustdoc hides."""
    source[0] = re.sub(r"^```rust\n.*?^```$", lambda block: re.sub(r"^# .*\n", "", block[0], flags=re.MULTILINE), source[0],
                       flags=re.MULTILINE | re.DOTALL)


def inline_math(writer, node) -> None:
    writer.body.append(tex2mathml(node.astext()))
    raise_skip()


def block_math(writer, node) -> None:
    writer.body.append(f'<div class="math">{tex2mathml(node.astext(), as_block=True)}</div>')
    raise_skip()


def raise_skip() -> None:
    from docutils.nodes import SkipNode

    raise SkipNode


def setup(app) -> None:
    app.connect("source-read", add_toctree)
    app.connect("source-read", hide_lines)
    # Browsers draw MathML themselves: no script, no network.
    app.add_html_math_renderer("mathml", (inline_math, None), (block_math, None))
