"""Every snippet of README.md and of the book runs, and prints what the page says that it prints.

The blocks of a page run in their order, in one directory with `data/` in it; those of Python share their names. A block of text right after
another is what that one prints: the same words, numbers within 2 %, but those of seconds and megabytes; a line `...` is any lines. What a page
shows as `![...](NAME.png)` beside itself is drawn by its blocks (`scripts/draw-book` draws it again).

Before a block that cannot run here stands <!-- not run: REASON -->, before one that takes something else <!-- needs: WHAT -->: a program, an
option of ours (`voronaut mesh --parts`), modules of Python (`import mpi4py`). Where another program runs all blocks of a language, the page
says so: <!-- LANGUAGE is run elsewhere: WHERE -->.
"""

import contextlib
import importlib.util
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
BESIDE = [ROOT / name for name in ("ARCHITECTURE.md", "CONTRIBUTING.md", "DESIGN.md", "data/README.md")]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), *BESIDE]
ELSEWHERE = re.compile(r"^<!-- (\w+) is run elsewhere: *(\S.*?) *-->$", re.MULTILINE)
PICTURE = re.compile(r"^!\[[^]]*\]\(([\w-]+\.png)\)", re.MULTILINE)
BLOCK = re.compile(r"(?:^<!-- (not run|needs): *(.*?) *-->\n)?^```(\w*)\n(.*?)^```$(\n*)", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?")
VARIES = re.compile(NUMBER.pattern + r"(?= (?:s|ms|MB)\b)|(?<=seconds) +" + NUMBER.pattern)
ROUNDING = 1e-12
CITATION = re.compile(r"([A-Z][a-z]+)\w*(?: et al\.)?,? \(?((?:19|20)\d\d)\b")
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


def environment():
    """That of commands: with the programs beside this Python."""
    return {**os.environ, "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])}


def run_shell(snippet, line, page):
    run = subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", snippet],
        env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, check=False,
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
    shown, said = VARIES.sub("", shown), VARIES.sub("", said)
    if NUMBER.sub("#", shown) != NUMBER.sub("#", said):
        return False
    pairs = zip(*([float(number.replace(",", "")) for number in NUMBER.findall(text)] for text in (shown, said)))
    return all(abs(a - b) <= 0.02 * max(abs(a), abs(b)) + ROUNDING for a, b in pairs)


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


def is_here(what):
    """Whether there is what a block needs."""
    first, *rest = what.split()
    if first == "import":
        return all(importlib.util.find_spec(name) for name in " ".join(rest).split(", "))
    program = shutil.which(first, path=environment()["PATH"])
    if not rest or not program:
        return bool(program)
    return rest[-1] in subprocess.run([program, *rest[:-1], "--help"], capture_output=True, text=True, check=True).stdout.split()


def run_page(page):
    """Runs the blocks of a page in the working directory."""
    Path("data").symlink_to(ROOT / "data")
    names = {"__name__": "snippet"}
    elsewhere = {language for language, _ in ELSEWHERE.findall(page.read_text())}
    for line, marker, reason, language, snippet, shown in blocks(page):
        if marker:
            assert reason, f"{name_of(page)}:{line}: it is not said why this is not run"
        if marker == "not run" or (marker == "needs" and not is_here(reason)) or language in elsewhere:
            continue
        assert language in ("sh", "python", "rust"), f"{name_of(page)}:{line}: a block of {language or 'no language'}"
        if language == "rust":
            # A test of documentation of the crate voronaut.
            assert f'"../../../{name_of(page)}"' in (ROOT / "crates/voronaut/src/lib.rs").read_text()
            continue
        said = run_shell(snippet, line, page) if language == "sh" else run_python(snippet, names, line, page)
        if shown is not None:
            check_printed(shown, said, f"{name_of(page)}:{line}")


def pictures(page):
    """What is drawn by the page's own blocks: pictures beside pages in folders, and of two others."""
    is_drawn = page.parent.parent == ROOT / "docs" and page.parent.name in ("concepts", "howto")
    return PICTURE.findall(page.read_text()) if is_drawn or page.name in ("guarantees.md", "start.md") else []


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_snippets(page, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    run_page(page)
    for name in pictures(page):
        assert Path(name).stat().st_size > 1000, f"{name_of(page)}: {name} is not drawn"


def test_few_snippets_are_not_run():
    left_out = [(name_of(page), line) for page in PAGES for line, marker, *_ in blocks(page) if marker == "not run"]
    assert len(left_out) <= 14, left_out


def anchors(page):
    """What a forge makes of headings: what links may name."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()).replace(" ", "-") for heading in headings}


def test_links_lead_somewhere():
    for page in PAGES:
        text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
        for link in LINK.findall(text):
            path, _, anchor = link.partition("#")
            if ":" in path:
                continue
            target = page.parent / path if path else page
            assert target.exists(), f"{name_of(page)}: {link}"
            if anchor:
                assert anchor in anchors(target.resolve()), f"{name_of(page)}: {link}"


def test_readme_is_short():
    assert len((ROOT / "README.md").read_text().split()) <= 1200


def test_measured_figures_are_in_tables():
    """What is measured stands where `scripts/measure.py` finds it, in blocks that run, or on pages that their scripts write."""
    written = {"docs/benchmark.md", "docs/report/README.md"}
    for page in PAGES:
        if page in BESIDE or name_of(page) in written:
            continue
        prose = re.sub(r"<!-- measured: .*?<!-- end -->|^```.*?^```$|`[^`\n]*`", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
        prose = prose.replace("does not end within 60 s", "")
        assert not (found := re.search(r".*\d (?:s|ms|MB|min|seconds|minutes|microseconds)\b.*", prose)), f"{name_of(page)}: {found[0]}"


def test_what_is_cited_is_in_the_bibliography():
    entries = (ROOT / "references.bib").read_text().split("\n@")
    for page in PAGES:
        for author, year in CITATION.findall(page.read_text()):
            assert any(author in entry and f"year = {{{year}}}" in entry for entry in entries), f"{name_of(page)}: {author} {year}"


def test_every_page_is_in_the_book():
    index = (ROOT / "docs/index.md").read_text()
    listed = {target for target in re.findall(r"^- \[[^]]*\]\(([^)#]*\.md)\)", index, re.MULTILINE) if not target.startswith("../")}
    assert listed == {str(page.relative_to(ROOT / "docs")) for page in PAGES if page.is_relative_to(ROOT / "docs")} - {"index.md"}
