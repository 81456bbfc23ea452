"""The sweep of the recipes: a ring placed in the cell of an MH12. Replace `sweep` by your own.

python sweep.py FOLDER                            on the threads of this machine
python sweep.py FOLDER --backend tcp://HOST:8786  on a scheduler of Dask; ray://HOST:10001 or ray: on Ray
python sweep.py FOLDER --shard 3 16               job 3 of an array of 16; a last call without --shard takes them over
"""

import argparse

import armill
import numpy as np
from armill import scale

STUDY = """format = 1
robot = "yaskawa/mh12"
tolerance_um = 200
tool = { flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }
plane = { centre_mm = [1000, 0, 800], half_size_mm = 150, step_mm = 75 }
load = { cases_n = [[3, -5, -5], [3, -5, 5], [3, 5, -5], [3, 5, 5]] }
[[analysis]]
kind = "path"
name = "ring"
circle = { radius_mm = 100 }
"""


def sweep(positions: int) -> scale.Sweep:
    """positions ** 2 placements of the ring in each of 3 spins: 360 points under 4 load cases each."""
    study = armill.Study.from_text(STUDY)
    x, y = np.linspace(700, 1100, positions), np.linspace(-300, 300, positions)
    return scale.placements(study, x_mm=x, y_mm=y, spin_deg=[-30, 0, 30])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="a folder on a shared disk, or an address such as s3://bucket/ring")
    parser.add_argument("--backend", default="local", help="local, dask, ray, tcp://HOST:8786, ray://HOST:10001")
    parser.add_argument("--workers", type=int, help="number of workers to wait for")
    parser.add_argument("--threads", type=int, default=1, help="threads of each worker")
    parser.add_argument("--shard", type=int, nargs=2, metavar=("JOB", "JOBS"), help="this job of an array, from 0, and their number")
    parser.add_argument("--items-per-part", type=int, default=20000, help="the same for all jobs of an array")
    parser.add_argument("--positions", type=int, default=300, help="along each axis")
    given = parser.parse_args()
    found = scale.run(
        sweep(given.positions),
        given.folder,
        given.backend,
        workers=given.workers,
        threads_per_worker=given.threads,
        items_per_part=given.items_per_part,
        shard=tuple(given.shard) if given.shard else None,
        timeout=600,
    )
    rate = found.evaluation_count / found.seconds
    print(f"{found.part_count} parts, {found.done_before} of them before; {found.evaluation_count:.3g} evaluations, {found.seconds:.1f} s, {rate:.3g}/s")


if __name__ == "__main__":
    main()
