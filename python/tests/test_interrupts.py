"""Ctrl-C, the end of the process, forks, threads: in processes of their own, which are killed where they hang."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import membrane_contact as mc
from helpers import OBSTACLE, PAIR, STACK, TIMEOUT_SECONDS, environment, run_python, same_bits, zero_backend

# It is to be there within half a second. A machine that does other things at the same time may take longer.
TIMELY_SECONDS = 1.5

# When it is late, by how much does not matter.
LATE_SECONDS = 2

# What takes less than a second and is not there by then hangs.
HANGS_SECONDS = 6

posix = pytest.mark.skipif(os.name == "nt", reason="no signals between processes")

PRELUDE = """
import os, signal, sys, threading, time
import numpy as np
import membrane_contact as mc

PAIR = {"tension": (1, 3), "load": (-15, "10*sin(pi*x)"), "height": 0.1}
fired = []

def fire(after=0.15, number=signal.SIGINT):
    def now():
        fired.append(time.monotonic())
        os.kill(os.getpid(), number)
    timer = threading.Timer(after, now)
    timer.daemon = True
    timer.start()

def sleeping(x, y, *further, **keywords):
    fire()
    time.sleep(30)
    return x - 1

def busy(x, y, *further, **keywords):
    fire()
    end = time.monotonic() + 30
    while time.monotonic() < end:
        pass
    return x - 1

def zeros(P, q, A, b, **keywords):
    fire()
    return 0 * q, 0 * b

def attempt(work):
    try:
        work()
    except KeyboardInterrupt:
        print(f"interrupted after {time.monotonic() - fired[-1]:.3f}", flush=True)
    else:
        print("not interrupted", flush=True)

mesh = mc.Mesh.rectangle(16)
"""


def script(body: str) -> str:
    """A script with all of this."""
    return PRELUDE + textwrap.dedent(body)


WORK = {
    "multigrid": "big = mc.Mesh.rectangle(700); fire(); attempt(lambda: mc.solve(big, **PAIR, solver='multigrid', tolerance=1e-11))",
    "active set": "big = mc.Mesh.rectangle(300); fire(); attempt(lambda: mc.solve(big, **PAIR, solver='active-set'))",
    "Clarabel": "big = mc.Mesh.rectangle(150); fire(); attempt(lambda: mc.solve(big, **PAIR, solver='clarabel'))",
    "program": "big = mc.Mesh.rectangle(1000); fire(); attempt(lambda: mc.qp(big, **PAIR))",
    "sleeping load": "attempt(lambda: mc.solve(mesh, tension=(1, 3), load=(sleeping, 1)))",
    "busy load": "attempt(lambda: mc.solve(mesh, tension=(1, 3), load=(busy, 1)))",
    "sleeping height": "attempt(lambda: mc.solve(mesh, tension=(1, 3), height=sleeping))",
    "slow height, while the error is bounded": """if True:
        calls = []
        def height(x, y):
            calls.append(len(x))
            if len(calls) == 2:
                fire()
            time.sleep(0.002)
            return 0 * x + 0.1
        attempt(lambda: mc.solve(mc.Mesh.rectangle(60), tension=(1, 3), height=height))
    """,
    "busy floor": "attempt(lambda: mc.solve(mesh, membranes=[{'tension': 1, 'load': -9}], floor=busy))",
    "busy load of a program": "attempt(lambda: mc.qp(mesh, tension=(1, 3), load=(busy, 1)))",
    "sleeping backend": "attempt(lambda: mc.solve(mesh, **PAIR, solver=sleeping))",
    "busy backend": "attempt(lambda: mc.solve(mesh, **PAIR, solver=busy))",
    "polish after a backend": "big = mc.Mesh.rectangle(300); attempt(lambda: mc.solve(big, **PAIR, solver=zeros))",
    "sleeping region": "attempt(lambda: mesh.with_region('a', sleeping))",
    "busy curve": "attempt(lambda: mesh.with_curve('a', busy))",
    "slow curve": "fire(); attempt(lambda: mc.Mesh.rectangle(60).with_curve('a', lambda x, y: time.sleep(0.02) or x < 1))",
}


@posix
@pytest.mark.parametrize("work", WORK.values(), ids=WORK)
def test_an_interrupt_is_there_at_once(work: str) -> None:
    ended = run_python(script(work + "\nos._exit(0)"), timeout=TIMELY_SECONDS + LATE_SECONDS)
    assert "interrupted after" in ended.output, f"no interrupt: {ended}"
    assert float(ended.output.split()[-1]) < TIMELY_SECONDS


ENDINGS = {
    "caught in a sleeping load": "attempt(lambda: mc.solve(mesh, tension=(1, 3), load=(sleeping, 1)))",
    "caught in a busy load": "attempt(lambda: mc.solve(mesh, tension=(1, 3), load=(busy, 1)))",
    "caught in a busy floor": "attempt(lambda: mc.solve(mesh, membranes=[{'tension': 1, 'load': -9}], floor=busy))",
    "caught in a solver": "big = mc.Mesh.rectangle(500); fire(); attempt(lambda: mc.solve(big, **PAIR))",
    "thread that solves": """
        def work():
            while True:
                mc.solve(mesh, **PAIR)
        threading.Thread(target=work, daemon=True).start()
        time.sleep(0.2)
    """,
    "thread with a callable": """
        def work():
            while True:
                mc.solve(mesh, tension=(1, 3), load=(lambda x, y: -15 - min(range(20000)), 1))
        threading.Thread(target=work, daemon=True).start()
        time.sleep(0.2)
    """,
}


@posix
@pytest.mark.parametrize("work", ENDINGS.values(), ids=ENDINGS)
def test_a_process_ends_well_while_work_goes_on(work: str) -> None:
    """Work which is still there is no reason to crash, nor to wait."""
    ended = run_python(script(textwrap.dedent(work) + "\nprint('end', flush=True)"), timeout=HANGS_SECONDS)
    assert "end" in ended.output, str(ended)
    assert ended.code == 0, str(ended)
    assert ended.errors == ""


@posix
@pytest.mark.parametrize("load", ["sleeping", "busy"])
def test_an_interrupt_that_nobody_catches_ends_the_process_as_ever(load: str) -> None:
    ended = run_python(script(f"mc.solve(mesh, tension=(1, 3), load=({load}, 1))"), timeout=HANGS_SECONDS)
    assert ended.code == -signal.SIGINT, str(ended)
    assert ended.errors.splitlines()[-1] == "KeyboardInterrupt"


@posix
def test_an_interrupt_is_never_swallowed() -> None:
    """A callable that is interrupted while the error is bounded, on the thread that gets signals."""
    body = """
    calls = []
    def floor(x, y):
        calls.append(len(x))
        if len(calls) == 2:
            fire(0)
            time.sleep(1)
        return 0 * x - 0.1
    attempt(lambda: mc.solve(mesh, membranes=[{"tension": 1, "load": -9}], floor=floor, solver=lambda P, q, A, b, **_: (0 * q, 0 * b)))
    assert len(calls) >= 2
    """
    ended = run_python(script(body), timeout=HANGS_SECONDS)
    assert ended.output.startswith("interrupted"), str(ended)


@posix
def test_what_another_handler_raises_is_raised() -> None:
    body = """
    class Alarm(Exception):
        pass
    alarm = Alarm("time is up")
    def handler(number, frame):
        raise alarm
    signal.signal(signal.SIGALRM, handler)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    try:
        mc.solve(mesh, tension=(1, 3), load=(lambda x, y: time.sleep(5), 1))
    except Alarm as error:
        print(error is alarm, flush=True)
    os._exit(0)
    """
    ended = run_python(script(body), timeout=HANGS_SECONDS)
    assert ended.output == "True\n", str(ended)


@posix
def test_a_handler_that_does_not_raise_changes_nothing() -> None:
    body = """
    seen = []
    signal.signal(signal.SIGINT, lambda number, frame: seen.append(number))
    def slow(x, y):
        fire(0.1)
        time.sleep(0.5)
        return 0 * x - 15
    slowly = mc.solve(mesh, tension=(1, 3), load=(slow, 1))
    assert seen, "no signal has come"
    quickly = mc.solve(mesh, tension=(1, 3), load=(-15, 1))
    print(np.abs(slowly.u1 - quickly.u1).max() < 1e-12)
    """
    ended = run_python(script(body), timeout=HANGS_SECONDS)
    assert ended.output == "True\n", str(ended)


@posix
@pytest.mark.parametrize("load", ["sleeping", "busy"])
def test_solving_goes_on_after_interrupts(load: str) -> None:
    """Callables that were left behind, more of them than there are cores, stand in nobody's way."""
    body = f"""
    for _ in range(3):
        attempt(lambda: mc.solve(mesh, tension=(1, 3), load=({load}, 1)))
    mc.solve(mesh, **PAIR)
    print("solved", flush=True)
    os._exit(0)
    """
    # Three Python loops at once take turns.
    ended = run_python(script(body), timeout=HANGS_SECONDS, RAYON_NUM_THREADS="2")
    assert ended.output.splitlines()[-1:] == ["solved"], str(ended)


def test_callables_that_wait_do_not_hold_up_other_threads() -> None:
    body = """
    enough = threading.Event()
    def waiting(x, y):
        enough.wait()
        return 0 * x - 15
    threads = [
        threading.Thread(target=lambda: mc.solve(mesh, tension=(1, 3), load=(waiting, 1)), daemon=True) for _ in range(3)
    ]
    for thread in threads:
        thread.start()
    time.sleep(0.2)
    mc.solve(mesh, **PAIR)
    print("solved", flush=True)
    enough.set()
    for thread in threads:
        thread.join()
    """
    ended = run_python(script(body), timeout=HANGS_SECONDS, RAYON_NUM_THREADS="2")
    assert ended.output == "solved\n", str(ended)


@pytest.mark.parametrize("solver", ["None", "lambda P, q, A, b, **_: (0 * q, 0 * b)"], ids=["auto", "backend"])
def test_a_callable_may_solve_on_one_core(solver: str) -> None:
    body = f"""
    def nested(depth):
        def load(x, y):
            if depth > 0:
                mc.solve(mesh, tension=(1, 3), load=(nested(depth - 1), 1), solver={solver})
            return 0 * x - 15
        return load
    mc.solve(mesh, tension=(1, 3), load=(nested(3), 1), solver={solver})
    print("solved", flush=True)
    """
    ended = run_python(script(body), timeout=HANGS_SECONDS, RAYON_NUM_THREADS="1")
    assert ended.output == "solved\n", str(ended)


FORKED = {
    "solve": "mc.solve(mesh, **PAIR)",
    "solve with a callable": "mc.solve(mesh, tension=(1, 3), load=(lambda x, y: x - 15, 1))",
    "solve on a finer mesh": "mc.solve(fine, **PAIR)",
    "qp": "mc.qp(mesh, **PAIR)",
    "make a mesh": "mc.Mesh.rectangle(64)",
    "make an unstructured mesh": "mc.Mesh.polygon([[0, 0], [1, 0], [0, 1]], size=0.1)",
    "read a mesh": "mc.Mesh(fine.points, fine.triangles)",
    "refine": "mesh.refined()",
    "name a region": "mesh.with_region('a', lambda x, y: x < 0.5)",
    "solve with a backend": "mc.solve(mesh, **PAIR, solver=lambda P, q, A, b, **_: (0 * q, 0 * b))",
}


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no forks here")
def test_everything_works_in_a_forked_child() -> None:
    """As `multiprocessing` makes them by default on Linux up to Python 3.13."""
    jobs = "\n".join(f"    {name!r}: lambda: {work}," for name, work in FORKED.items())
    body = f"""
import warnings
warnings.simplefilter("ignore")
fine = mc.Mesh.rectangle(64)
jobs = {{
{jobs}
}}
for job in jobs.values():
    job()
children = {{}}
for name, job in jobs.items():
    child = os.fork()
    if child == 0:
        code = 1
        try:
            job()
            code = 0
        finally:
            os._exit(code)
    children[name] = child
end = time.monotonic() + 4
while children and time.monotonic() < end:
    for name, child in list(children.items()):
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            del children[name]
            if status != 0:
                print(name, "failed with", status)
    time.sleep(0.02)
for name, child in children.items():
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    print(name, "hangs")
"""
    ended = run_python(PRELUDE + body, timeout=20)
    assert ended.output == "", str(ended)
    assert ended.code == 0, str(ended)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no forks here")
def test_a_fork_while_another_thread_solves() -> None:
    body = """
    import warnings
    warnings.simplefilter("ignore")
    expected = mc.solve(mesh, **PAIR).energy
    ready = threading.Event()
    def work():
        while True:
            mc.solve(mesh, **PAIR)
            ready.set()
    threading.Thread(target=work, daemon=True).start()
    ready.wait()
    for _ in range(20):
        child = os.fork()
        if child == 0:
            os._exit(0 if mc.solve(mesh, **PAIR).energy == expected else 1)
        end = time.monotonic() + 3
        while True:
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                assert status == 0, status
                break
            if time.monotonic() > end:
                os.kill(child, signal.SIGKILL)
                print("hangs", flush=True)
                os._exit(1)
            time.sleep(0.005)
    print("solved", flush=True)
    os._exit(0)
    """
    ended = run_python(script(body), timeout=20)
    assert ended.output == "solved\n", str(ended)


SPAWNED = """
import multiprocessing

import membrane_contact as mc
import numpy as np


def solve(cells):
    solution = mc.solve(mc.Mesh.rectangle(cells), tension=(1, 3), load=(-15, lambda x, y: 10 * x), height=0.1)
    return solution.energy, np.array(solution.u1)


def fail(_):
    mc.solve(mc.Mesh.rectangle(4), tension=(1, 3), load=(-15, 1), solver=lambda P, q, A, b, **_: (q, b), polish=False)


if __name__ == "__main__":
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        for cells, (energy, u1) in zip((8, 16), pool.map(solve, (8, 16))):
            expected = solve(cells)
            assert energy == expected[0]
            assert u1.tobytes() == expected[1].tobytes()
        try:
            pool.map(fail, [0])
        except mc.CertificationError as error:
            assert error.residuals["stationarity"] > 0
            print("solved")
"""


def test_spawned_processes_have_the_same_bits_and_errors(tmp_path: Path) -> None:
    path = tmp_path / "spawned.py"
    path.write_text(SPAWNED, encoding="utf-8")
    ended = subprocess.run(
        [sys.executable, str(path)], capture_output=True, text=True, timeout=TIMEOUT_SECONDS, env=environment()
    )
    assert ended.stdout == "solved\n", ended.stderr


def test_threads_at_once_have_the_bits_of_one_after_the_other() -> None:
    mesh = mc.Mesh.rectangle(48)
    jobs = [
        {**PAIR},
        {**OBSTACLE},
        {**STACK},
        {**PAIR, "load": (lambda x, y: -15 - x, 5), "solver": "multigrid"},
        {**PAIR, "solver": zero_backend},
        {**STACK, "floor": lambda x, y: -0.12 + 0 * x, "tolerance": "auto"},
    ]
    alone = [mc.solve(mesh, **job) for job in jobs]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda job: mc.solve(mesh, **job), 3 * jobs))
    for expected, found in zip(3 * alone, together):
        assert all(same_bits(a, b) for a, b in zip(expected.u, found.u))
        assert expected.error_bound == found.error_bound
        assert expected.energy == found.energy


def test_the_number_of_threads_does_not_change_a_bit() -> None:
    body = """
    import hashlib
    for cells, solver in (16, None), (60, "multigrid"), (40, lambda P, q, A, b, **_: (0 * q, 0 * b)):
        solution = mc.solve(mc.Mesh.rectangle(cells), **PAIR, solver=solver)
        print(hashlib.sha256(solution.u1.tobytes()).hexdigest(), solution.error_bound.hex())
    """
    outputs = [run_python(script(body), RAYON_NUM_THREADS=threads).output for threads in ("1", "2", "5")]
    assert outputs[0].count("\n") == 3
    assert outputs == 3 * outputs[:1]


INTERPRETER = """
import sys
try:
    import _interpreters as interpreters
except ImportError:
    try:
        import _xxsubinterpreters as interpreters
    except ImportError:
        print("none")
        sys.exit()
if WHEN == "after":
    import membrane_contact
code = f'''
import {interpreters.__name__} as interpreters
def load(x, y):
    here = interpreters.get_current()
    print("called here" if str(here) == str(HERE) else "called elsewhere", flush=True)
    return 5 + 0 * x
HERE = interpreters.get_current()
try:
    # Which refuses to be there twice, too; with Python 3.10, by a SystemError.
    import numpy
except (ImportError, SystemError):
    print("refused", flush=True)
else:
    try:
        import membrane_contact as mc
        solution = mc.solve(mc.Mesh.rectangle(4), tension=(1, 3), load=(-15, load))
        assert solution.contact.any()
        print("works", flush=True)
    except ImportError as error:
        print("refused", flush=True)
'''
for number in range(2):
    interpreter = interpreters.create()
    try:
        failed = interpreters.run_string(interpreter, code)
        assert failed is None, failed
    finally:
        interpreters.destroy(interpreter)
"""


@pytest.mark.parametrize("when", ["before", "after"])
def test_subinterpreters_work_or_refuse(when: str) -> None:
    """Before the main interpreter has imported the package, and after; and none leaves something to the next one."""
    ended = run_python(INTERPRETER.replace("WHEN", repr(when)), "-W", "ignore")
    assert ended.code == 0, str(ended)
    if ended.output == "none\n":
        pytest.skip("this Python has no subinterpreters")
    assert "called elsewhere" not in ended.output, str(ended)
    outcomes = [line for line in ended.output.splitlines() if not line.startswith("called")]
    assert len(outcomes) == 2
    assert set(outcomes) <= {"works", "refused"}, str(ended)
    assert ended.errors == "", str(ended)
