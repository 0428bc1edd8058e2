"""The page that the program holds, and the sources that it is made from."""

import hashlib
from pathlib import Path

DRAW = Path(__file__).resolve().parents[2] / "crates/voronaut-draw"


def test_the_page_is_made_from_its_sources():
    viewer = DRAW / "viewer"
    names = ["package-lock.json", "page.html", *sorted(f"src/{path.name}" for path in (viewer / "src").iterdir())]
    digest = hashlib.sha256()
    for name in names:
        digest.update(name.encode() + b"\0" + (viewer / name).read_bytes() + b"\0")
    built = (DRAW / "src/page/viewer.html").read_text(encoding="utf-8")
    assert f'data-sources="{digest.hexdigest()}"' in built, "run scripts/test_page --build"
