"""Pages to look at meshes with."""

from __future__ import annotations

import html
import os
from pathlib import Path


class Page:
    """A page of HTML that needs no other file and no network.

    Attributes
    ----------
    html : str
        The page.
    """

    def __init__(self, text: str) -> None:
        self.html = text

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page to a file that browsers open."""
        Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        frame = 'style="width: 100%; height: 600px; border: 1px solid #8884; border-radius: 8px"'
        return f'<iframe srcdoc="{html.escape(self.html)}" {frame}></iframe>'

    def __repr__(self) -> str:
        return f"<voronaut.Page of {len(self.html) / 1e6:.2f} MB>"
