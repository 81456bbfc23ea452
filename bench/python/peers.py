"""Rates of the Python peers on the poses that armill-bench wrote; called by `cargo xtask bench`.

usage: python peers.py FOLDER [--quick]. Rows go to stdout. A peer with a result that differs from the yardstick is an
error; one that cannot be loaded is reported in a line that begins with `skipped`.
"""

import functools
import importlib.metadata
import pathlib
import sys

ROUNDS, QUICK_ROUNDS = 15, 3
CHECKED = 1000
REPEATED = 40  # runs in a row: a processor takes milliseconds to change its clock for wide vectors
FEW = 20_000  # poses for a peer that makes a Python object of every posture
ALLOWED = 1e-6  # relative, or rad


def main():
    folder, rounds = pathlib.Path(sys.argv[1]), QUICK_ROUNDS if "--quick" in sys.argv else ROUNDS
    candidates = []
    for peer in (of_numpy, of_numba, of_eaik):
        try:
            candidates += peer(folder)
        except ImportError as problem:
            print("skipped", peer.__name__.removeprefix("of_"), problem, sep="\t")
    from clock import print_rates

    print_rates(candidates, rounds)


def read(folder, name, width):
    import numpy as np

    return np.fromfile(folder / name, dtype="<f8").reshape(-1, width)


def columns(folder):
    import numpy as np

    return np.ascontiguousarray(read(folder, "poses.f64", 12).T)


def agree(who, difference):
    print(f"{who}: {difference:.1e} off the yardstick", file=sys.stderr)
    if not difference < ALLOWED:
        sys.exit(f"{who} is off the yardstick by {difference:.1e}, allowed {ALLOWED:.0e}")


def relative(ours, theirs):
    import numpy as np

    return np.max(np.abs(ours - theirs)) / np.max(np.abs(theirs))


def named(package):
    return f"{package} {importlib.metadata.version(package)}"


def of_numpy(folder):
    import numpy as np
    import with_numpy as w

    e, who = columns(folder), named("numpy")
    count, out = e.shape[1], np.empty(e.shape[1])
    expected = read(folder, "dev.f64", 1)[:, 0]
    agree(f"{who}, dev", relative(w.in_blocks(w.dev, e, out), expected))
    agree(f"{who}, dev trig-free", relative(w.in_blocks(w.dev_without_trigonometry, e, out), expected))
    few = e[:, :CHECKED]
    matrices = w.c66(few).transpose(2, 0, 1).reshape(-1, 36)
    agree(f"{who}, C66", relative(matrices, read(folder, "c66.f64", 36)))
    with np.errstate(invalid="ignore"):
        agree(f"{who}, ik8", relative(w.ik8(few)[0].T, read(folder, "angles.f64", 6)[:CHECKED]))

    def ik8():
        with np.errstate(invalid="ignore"):
            w.reduced_in_blocks(w.ik8, e)

    return [
        (f"{who}, blocked", "dev", count, "poses as columns", lambda: w.in_blocks(w.dev, e, out)),
        (
            f"{who}, blocked, trig-free",
            "dev",
            count,
            "poses as columns; tool along axis 6",
            lambda: w.in_blocks(w.dev_without_trigonometry, e, out),
        ),
        (f"{who}, blocked", "C66", count, "poses as columns", lambda: w.reduced_in_blocks(w.c66, e)),
        (f"{who}, blocked", "ik8", count, "poses as columns", ik8),
    ]


def of_numba(folder):
    import numba
    import numpy as np
    import with_numba as w

    e, who, threads = columns(folder), named("numba"), numba.get_num_threads()
    blocks, expected = w.blocked(e), read(folder, "dev.f64", 1)[:, 0]
    note = 'fastmath, error_model="numpy"; poses as columns; tool along axis 6, all constants compiled in'
    rows = []
    for kind, work in (("trigonometry", w.dev), ("trig-free", w.dev_without_trigonometry)):
        shape = (blocks.shape[0], blocks.shape[2])
        for count, run, given, out in (
            (1, work, e, np.empty(e.shape[1])),
            (threads, w.on_all_threads(work), blocks, np.empty(shape)),
        ):
            run(given, out)
            agree(f"{who}, {kind}, {count} threads", relative(out.reshape(-1), expected))
            job = functools.partial(repeatedly, run, given, out)
            rows.append((f"{who}, {kind}", "dev", REPEATED * out.size, note, job, count))
    return rows


def repeatedly(run, *given):
    for _ in range(REPEATED):
        run(*given)


def of_eaik(folder):
    import with_eaik as w

    who, robot = named("EAIK"), w.mh12()
    batch = w.targets(read(folder, "poses.f64", 12)[:FEW])
    agree(who, w.difference(robot, batch[:CHECKED], read(folder, "angles.f64", 6)))
    note = "IK_batched, one thread; branches out of reach come as least squares"
    return [(who, "ik8", len(batch), note, lambda: robot.IK_batched(batch, 1))]


if __name__ == "__main__":
    main()
