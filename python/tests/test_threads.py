"""Any number of threads gives the same bits; Python continues meanwhile; Ctrl-C stops the work."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import armill

FORCES = [[3.0, -5.0, 5.0], [-20.0, 4.0, 1.0]]


def many(mh12, count: int) -> np.ndarray:
    low, high = mh12.limits.T
    return low + np.random.default_rng(3).uniform(0.1, 0.9, (count, 6)) * (high - low)


def test_any_number_of_threads_gives_the_same_bits(mh12):
    joints = many(mh12, 5000)
    poses = mh12.forward(joints)

    def all_of(threads):
        postures = mh12.inverse(poses, threads=threads)
        evaluation = mh12.evaluate(poses, FORCES, normal=[0, 0, 1], threads=threads)
        return [
            mh12.forward(joints, threads=threads),
            mh12.jacobian(joints, threads=threads),
            mh12.compliance(joints, threads=threads),
            mh12.deviation(joints, FORCES, threads=threads),
            mh12.contributions(joints, FORCES, threads=threads),
            postures.joints,
            postures.pose_index,
            evaluation.joints,
            evaluation.deviation,
            evaluation.contributions,
            evaluation.in_plane,
        ]

    witness = all_of(None)
    for threads in (1, 2, 3):
        assert all(np.array_equal(a, b) for a, b in zip(all_of(threads), witness))
    # One by one too: a block evaluated directly equals one sent to the pool.
    assert np.array_equal(np.concatenate([mh12.deviation(q[None], FORCES) for q in joints[:50]]), witness[3][:50])


def test_python_continues_while_armill_works(mh12):
    joints = many(mh12, 400_000)
    ticks, stop = 0, threading.Event()

    def tick():
        nonlocal ticks
        while not stop.is_set():
            ticks += 1
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    before = ticks
    mh12.contributions(joints, FORCES, threads=1)
    counted = ticks - before
    stop.set()
    thread.join()
    # With the lock evaluation it would count none, or one at either end.
    assert counted > 3


def test_several_threads_of_python_call_at_once(mh12):
    joints = many(mh12, 3000)
    witness = mh12.deviation(joints, FORCES)
    found: list[np.ndarray | None] = [None] * 6

    def evaluate(i: int) -> None:
        found[i] = mh12.deviation(joints, FORCES, threads=1 + i % 3)

    threads = [threading.Thread(target=evaluate, args=(i,)) for i in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(one, witness) for one in found)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_child_of_a_fork_works_too(mh12):
    joints = many(mh12, 3000)
    mh12.forward(joints)
    child = os.fork()
    if child == 0:
        ok = mh12.forward(joints).shape == (3000, 4, 4)
        os._exit(0 if ok else 1)
    for _ in range(600):
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            break
        time.sleep(0.05)
    else:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        pytest.fail("the child waits for threads that it does not have")
    assert os.waitstatus_to_exitcode(status) == 0


LONG = """
import sys, numpy as np, armill
robot = armill.Robot.load("yaskawa/mh12")
joints = np.random.default_rng(1).uniform(-0.5, 0.5, (6_000_000, 6))
forces = np.array([1.0, 2.0, 3.0])
print("ready", flush=True)
try:
    {work}
except armill.Cancelled as stopped:
    assert isinstance(stopped, KeyboardInterrupt)
    print("stopped:", stopped, flush=True)
    # Calls after an interrupt work as before.
    assert robot.forward(joints[:1000]).shape == (1000, 4, 4)
    sys.exit(7)
"""


@pytest.mark.parametrize("work", ["robot.contributions(joints, forces, threads=1)"])
def test_ctrl_c_stops_long_work(work):
    psutil = pytest.importorskip("psutil")
    process = subprocess.Popen([sys.executable, "-c", LONG.format(work=work)], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "ready\n"
    # In the middle of it, however busy the machine is: all of it takes ten times as much of a processor.
    used = psutil.Process(process.pid).cpu_times
    before = used().user
    while process.poll() is None and used().user < before + 0.5:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    printed, _ = process.communicate(timeout=600)
    # Python itself would report an interrupt after the work, and with another error.
    assert process.returncode == 7, printed
    assert printed == "stopped: cancelled: no result was written\n"


def test_a_signal_handler_of_the_user_is_called(mh12):
    class Mine(Exception):
        pass

    def handler(*_):
        raise Mine

    joints = many(mh12, 2_000_000)
    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with pytest.raises(Mine):
            mh12.contributions(joints, FORCES, threads=1)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert isinstance(armill.Cancelled(), KeyboardInterrupt)
