"""Every snippet of README.md and docs/ runs, and prints what the page says that it prints.

The blocks of a page run in their order, in one directory with `data/` in it; those of Python share their names. A block of text right after
another is what that one prints: the same words, numbers within 2 %, but those of seconds and megabytes; a line `...` is any lines. Before a
block that cannot run here stands <!-- not run: REASON -->, before one that takes another program <!-- needs: PROGRAM -->.
"""

import contextlib
import io
import itertools
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
# Its commands run in crates/voronaut-cli/tests/coming_from.rs.
ELSEWHERE = {"docs/coming-from.md": "sh"}
BLOCK = re.compile(r"(?:^<!-- (not run|needs): *(.*?) *-->\n)?^```(\w*)\n(.*?)^```$(\n*)", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?")
VARIES = re.compile(r"\bs\b|\bms\b|seconds|\btime\b|\bMB\b")
LINK = re.compile(r"\]\(([^)\s]+)\)")


def name_of(page):
    return str(page.relative_to(ROOT))


def blocks(page):
    """Line, marker with its text, language, text, and what is printed, of every block that is not itself what is printed."""
    text = page.read_text()
    found = list(BLOCK.finditer(text))
    for match, after in zip(found, [*found[1:], None]):
        marker, reason, language, snippet, _ = match.groups()
        shown = after and after.start() == match.end() and after[3] == "text" and not after[1]
        if language != "text":
            yield text.count("\n", 0, match.start(4)) + 1, marker, reason, language, snippet, after[4] if shown else None


def run_shell(snippet, line, page):
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    run = subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", snippet],
        env={**os.environ, "PATH": path}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, f"{name_of(page)}:{line}: {run.stdout}"
    return run.stdout


def run_python(snippet, names, line, page):
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        # With the numbers of its lines in the page.
        exec(compile("\n" * (line - 1) + snippet, str(page), "exec"), names)
    return said.getvalue()


def is_same(shown, said):
    """Whether a line that a page shows is what was said."""
    if VARIES.search(shown):
        return NUMBER.sub("#", shown) == NUMBER.sub("#", said)
    if NUMBER.sub("#", shown) != NUMBER.sub("#", said):
        return False
    pairs = zip(*([float(number.replace(",", "")) for number in NUMBER.findall(text)] for text in (shown, said)))
    return all(abs(a - b) <= 0.02 * max(abs(a), abs(b)) for a, b in pairs)


def check_printed(shown, said, where):
    waiting, elided = [line.rstrip() for line in said.strip("\n").splitlines()], False
    for line in (line.rstrip() for line in shown.strip("\n").splitlines()):
        if line.strip() == "...":
            elided = True
            continue
        if elided:
            waiting = list(itertools.dropwhile(lambda one, line=line: not is_same(line, one), waiting))
        assert waiting and is_same(line, waiting[0]), f"{where}: the page has\n{line}\nand what was printed is\n{said}"
        waiting, elided = waiting[1:], False
    assert elided or not waiting, f"{where}: not on the page: {waiting}"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_snippets(page, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    Path("data").symlink_to(ROOT / "data")
    names = {"__name__": "snippet"}
    for line, marker, reason, language, snippet, shown in blocks(page):
        if marker:
            assert reason, f"{name_of(page)}:{line}: it is not said why this is not run"
        if marker == "not run" or (marker == "needs" and not shutil.which(reason)) or ELSEWHERE.get(name_of(page)) == language:
            continue
        assert language in ("sh", "python", "rust"), f"{name_of(page)}:{line}: a block of {language or 'no language'}"
        if language == "rust":
            # A test of documentation of the crate voronaut.
            assert f'"../../../{name_of(page)}"' in (ROOT / "crates/voronaut/src/lib.rs").read_text()
            continue
        said = run_shell(snippet, line, page) if language == "sh" else run_python(snippet, names, line, page)
        if shown is not None:
            check_printed(shown, said, f"{name_of(page)}:{line}")


def test_few_snippets_are_not_run():
    left_out = [(name_of(page), line) for page in PAGES for line, marker, *_ in blocks(page) if marker == "not run"]
    assert len(left_out) <= 12, left_out


def anchors(page):
    """What a forge makes of headings: what links may name."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()).replace(" ", "-") for heading in headings}


def test_links_lead_somewhere():
    for page in [*PAGES, *(ROOT / name for name in ("DESIGN.md", "ARCHITECTURE.md", "CONTRIBUTING.md"))]:
        text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
        for link in LINK.findall(text):
            path, _, anchor = link.partition("#")
            if ":" in path:
                continue
            target = page.parent / path if path else page
            assert target.exists(), f"{name_of(page)}: {link}"
            if anchor:
                assert anchor in anchors(target.resolve()), f"{name_of(page)}: {link}"


def test_every_page_is_in_the_book():
    index = (ROOT / "docs/index.md").read_text()
    listed = {target for target in re.findall(r"^- \[[^]]*\]\(([^)#]*\.md)\)", index, re.MULTILINE) if not target.startswith("../")}
    assert listed == {str(page.relative_to(ROOT / "docs")) for page in PAGES[1:]} - {"index.md"}
