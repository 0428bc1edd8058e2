#!/usr/bin/env python3
"""The oldest Rust that Cargo.toml promises is enough: no dependency asks for a later one, and with that Rust, where it is installed, all
is checked.

    scripts/rust_version.py

Where it is not installed, what is left is clippy's incompatible_msrv, among its lints by default: it knows functions of the standard
library that are later, but not traits and what the language has.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def order(version: str) -> list[int]:
    """Numbers by which versions are compared."""
    return [int(part) for part in re.findall(r"\d+", version)][:2]


def has(version: str) -> bool:
    """Whether this Rust is installed."""
    try:
        return subprocess.run(["rustup", "run", version, "cargo", "--version"], capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        return False


def main() -> int:
    told = subprocess.run(["cargo", "metadata", "--format-version=1", "--locked"], cwd=ROOT, check=True, capture_output=True, text=True)
    packages = json.loads(told.stdout)["packages"]
    [promised] = {package["rust_version"] for package in packages if package["source"] is None}
    later = [package for package in packages if order(package["rust_version"] or "1") > order(promised)]
    for package in later:
        print(f"{package['name']} {package['version']} asks for Rust {package['rust_version']}", file=sys.stderr)
    if later:
        return 1
    print(f"{len(packages)} packages ask for Rust {promised} or earlier")
    if not has(promised):
        print(f"Rust {promised} is not installed: clippy has looked for functions that are later")
        return 0
    environment = os.environ | {"CARGO_TARGET_DIR": str(ROOT / "target/oldest")}
    return subprocess.run(["rustup", "run", promised, "cargo", "check", "--workspace"], cwd=ROOT, env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
