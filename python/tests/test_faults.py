"""What is wrong is said, with its place; nothing is left behind."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import voronaut
from voronaut import Metric

SQUARE = "rect:0,0,1,1"
CAMPAIGN = Path(__file__).resolve().parents[2] / "scripts/campaign_python.py"
POINTS = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


@pytest.mark.parametrize(
    ("function", "kind", "message"),
    [
        (lambda p: 1 / 0, ZeroDivisionError, "division"),
        (lambda p: np.full(len(p), np.nan), ValueError, r"the metric function's result: nan at index 0.*, at the point \("),
        (lambda p: np.where(p[:, 0] > 0.5, -1.0, 1.0), ValueError, "size -1.0 at index .* is not positive"),
        (lambda p: np.ones(3), ValueError, "10000 entries|entries are expected, not 3"),
        (lambda p: np.ones((len(p), 5)), ValueError, r"entries m11, m12, m22.*not an array \(\d+, 5\)"),
        (lambda p: ["a"] * len(p), TypeError, "numbers are expected"),
        (lambda p: None, TypeError, "numbers are expected"),
        (lambda p: np.tile([[1.0, 2.0], [0.0, 1.0]], (len(p), 1, 1)), ValueError, "at index 0 is not symmetric"),
        (lambda p: np.tile([1.0, 2.0, 1.0], (len(p), 1)), voronaut.MetricError, "not positive definite"),
    ],
)
def test_functions_of_points(function, kind, message):
    with pytest.raises(kind, match=message):
        voronaut.mesh(SQUARE, function, n=100)


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (lambda: voronaut.mesh(SQUARE, "uniform", n=2), ValueError, "n='2': 2 is not in"),
        (lambda: voronaut.mesh(SQUARE, "uniform", n="many"), ValueError, "many"),
        (lambda: voronaut.mesh(SQUARE, "uniform", n=100, colour="red"), TypeError, "colour"),
        (lambda: voronaut.mesh(SQUARE, "uniform", n=100, h_min=-1), ValueError, "h_min='-1': not a positive number"),
        (lambda: voronaut.mesh(SQUARE, "uniform", n=100, canvas="grid"), ValueError, "canvas='grid'"),
        (lambda: voronaut.mesh(SQUARE, "uniform", n=100, complexity=4), ValueError, "n cannot be used with complexity$"),
        (lambda: voronaut.mesh(SQUARE, "uniform", n=100, fit=True), voronaut.UnsupportedError, "fit"),
        (lambda: voronaut.mesh("rect:0,0,1", "uniform", n=100), voronaut.InputError, "3 numbers where 4"),
        (lambda: voronaut.mesh("none.mesh", "uniform", n=100), OSError, "none.mesh"),
        (lambda: voronaut.mesh(3, "uniform", n=100), TypeError, "domain: a mesh is expected"),
        (lambda: voronaut.mesh((POINTS, [[0, 1], [1, 2]]), "uniform", n=100), voronaut.DomainError, "domain"),
        (lambda: voronaut.mesh((POINTS, [[0, 1, 4]]), "uniform", n=100), ValueError, "domain.triangles: row 0 names vertex 4"),
        (lambda: voronaut.mesh((POINTS * np.nan, [[0, 1, 2]]), "uniform", n=100), ValueError, r"domain.points: nan at index \(0, 0\)"),
        (lambda: voronaut.mesh((POINTS, [[0, 1, 2]], [1, 2]), "uniform", n=9), ValueError, "1 labels are expected, not 2"),
        (lambda: voronaut.mesh((POINTS, [[0.5, 1, 2]]), "uniform", n=9), TypeError, "integers are expected"),
        (lambda: voronaut.mesh((np.ma.masked_less(POINTS, 1), [[0, 1, 2]]), "uniform", n=9), ValueError, "masked"),
        (lambda: voronaut.mesh(SQUARE, "nonsense", n=100), voronaut.Error, "nonsense"),
        (lambda: voronaut.mesh(SQUARE, np.ones(4), n=100), voronaut.UnsupportedError, "without their mesh"),
        (lambda: voronaut.mesh(SQUARE, "uniform", n=10**9), voronaut.LimitError, "memory_limit|memory"),
        (lambda: voronaut.mesh(SQUARE, "swirl", n=500_000, time_limit=0.2), voronaut.LimitError, "not done within 0.2 s"),
        (lambda: voronaut.mesh(SQUARE, "swirl", n=500_000, progress=lambda *_: False), voronaut.Cancelled, "stopped"),
        (lambda: voronaut.mesh(SQUARE, "uniform", n=9, progress=3), TypeError, "progress"),
        (lambda: voronaut.dual(SQUARE, "uniform", [[0.1, 0.1], [0.1, 0.1]]), voronaut.InputError, "seeds, row 1"),
        (lambda: voronaut.dual(SQUARE, "uniform", [[0.1, 0.1], [3, 0.1]]), voronaut.InputError, "seeds, row 1"),
        (lambda: voronaut.dual(SQUARE, "uniform", np.zeros((0, 2))), voronaut.InputError, "seed"),
        (lambda: voronaut.distance(SQUARE, "uniform", (3, 3)), voronaut.DomainError, "outside"),
        (lambda: voronaut.Mesh.read("none.mesh"), OSError, "none.mesh"),
        (lambda: voronaut.Mesh(POINTS, [[0, 1, 2]]).save("a.stp"), voronaut.Error, "stp"),
        (lambda: voronaut.transfer((POINTS, [[0, 1, 2]]), (POINTS, [[0, 1, 2]]), [1.0, 2.0]), ValueError, "fields: 2 entries"),
        (lambda: Metric.uniform(-1.0), ValueError, "not positive"),
        (lambda: Metric.from_array(np.ones((4, 4))), ValueError, "values: "),
        (lambda: Metric.uniform().average("swirl", weights=[1.0]), ValueError, "2 are expected"),
    ],
)
def test_calls(call, kind, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(kind, match=message):
        call()
    assert not list(tmp_path.iterdir())


def test_an_exception_in_progress_is_the_caller_s():
    def fail(stage, done, total):
        raise KeyError(stage)

    with pytest.raises(KeyError):
        voronaut.mesh(SQUARE, "swirl", n=500_000, progress=fail)


def test_progress_is_told():
    told = []
    voronaut.mesh(SQUARE, "swirl", n=20_000, progress=lambda *it: told.append(it))
    stages = {stage for stage, _, _ in told}
    assert len(stages) > 1 and all(0 <= done <= total for _, done, total in told)


def test_an_interrupt_is_heard_within_a_second():
    import _thread

    # Jobs in the background of a shell ignore it.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.5, _thread.interrupt_main)
    start = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        voronaut.mesh(SQUARE, "swirl", n=500_000)
    assert time.monotonic() - start < 2
    signal.signal(signal.SIGINT, before)


def test_other_threads_go_on():
    count = 0

    def work():
        voronaut.mesh(SQUARE, "swirl", n=5_000)

    worker = threading.Thread(target=work)
    worker.start()
    while worker.is_alive():
        count += 1
    worker.join()
    assert count > 100


@pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="there is no list of threads")
def test_no_thread_and_no_file_is_left(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    threads = lambda: len(os.listdir("/proc/self/task"))  # noqa: E731
    before = threads()
    for _ in range(5):
        voronaut.mesh(SQUARE, "uniform", n=500)
    deadline = time.monotonic() + 5
    while threads() > before and time.monotonic() < deadline:
        time.sleep(0.01)
    assert threads() <= before and not list(tmp_path.iterdir())


def resident():
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="memory is not told")
def test_memory_stays_flat():
    def rounds(count):
        for _ in range(count):
            mesh = voronaut.mesh(SQUARE, "uniform", n=2000)
            mesh.fields["u"] = mesh.points[:, 0].copy()
            voronaut.check(mesh)
        gc.collect()
        return resident()

    before = rounds(15)
    assert rounds(60) < before + 30e6


def test_arrays_own_what_was_made():
    mesh = voronaut.mesh(SQUARE, "uniform", n=100)
    points = mesh.points
    del mesh
    gc.collect()
    assert np.isfinite(points).all() and points.flags.writeable


def test_random_calls_are_done_or_refused():
    words = ["-n", os.environ.get("VORONAUT_CASES", "150"), "--seed", os.environ.get("VORONAUT_SEED", "0")]
    done = subprocess.run([sys.executable, CAMPAIGN, *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
