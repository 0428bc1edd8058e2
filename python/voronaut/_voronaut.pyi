from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["commands", "main", "metric_at", "perform", "read", "write"]

def perform(
    command: str,
    options: Sequence[tuple[str, Sequence[str]]],
    held: dict[str, dict[str, Any]],
    progress: Callable[[str, int, int], object] | None,
) -> dict[str, Any]: ...
def read(path: str) -> dict[str, Any]: ...
def write(path: str, mesh: dict[str, Any]) -> None: ...
def metric_at(
    mesh: dict[str, Any], metrics: Sequence[Any], shaping: dict[str, Any]
) -> tuple[npt.NDArray[np.float64], float]: ...
def commands() -> str: ...
def main(program: Sequence[str], words: Sequence[str]) -> int: ...
