"""Candidates in turn, round after round; median and quartiles as rows of `cargo xtask bench`."""

import time


def print_rates(candidates, rounds):
    """candidates: (who, work, poses a run, note, run), and the threads if it is not one. The first round, which compiles and warms up, does not count."""
    measured = [[] for _ in candidates]
    for turn in range(rounds + 1):
        for (_, _, count, _, run, *_), rates in zip(candidates, measured):
            start = time.perf_counter()
            run()
            seconds = time.perf_counter() - start
            if turn > 0:
                rates.append(count * 1e-6 / seconds)
    for (who, work, _, note, _, *threads), rates in zip(candidates, measured):
        rates.sort()
        median, low, high = (rates[round((len(rates) - 1) * q)] for q in (0.5, 0.25, 0.75))
        print(who, work, *(threads or [1]), f"{median:.6f}", f"{low:.6f}", f"{high:.6f}", note, sep="\t", flush=True)
