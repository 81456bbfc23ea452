"""Sweeps beyond one machine: what is asked of many things, in parts, on threads, on Dask or on Ray.

A sweep numbers its items; a part is a run of items and one Parquet file; a folder holds the parts and ``manifest.json``.
A part that is done stays done: a worker that dies, or this very program, costs no more than the parts it was at. The parts
hold the same bytes wherever and in whatever order they were made.

====================================  ==========================================================================
``Sweep``, ``Block``                  what is asked: axes and a function of some items (``sweep.py``)
``placements``, ``deviations``,       sweeps that are ready-made (``sweeps/``)
``studies``
``plan``, ``Plan``                    into which parts it goes (``planning.py``)
``run``, ``Finished``                 does what is not done yet (``running.py``)
``read``                              the rows of all parts, in their order (``reading.py``)
``SweepFailed``, ``MissingExtra``     what goes wrong beside ``armill.InputError`` (``errors.py``)
====================================  ==========================================================================
"""

from armill.scale.errors import MissingExtra, SweepFailed
from armill.scale.planning import Plan, plan
from armill.scale.reading import read
from armill.scale.running import Finished, run
from armill.scale.sweep import Block, Sweep
from armill.scale.sweeps.deviations import deviations
from armill.scale.sweeps.placements import placements
from armill.scale.sweeps.studies import studies

__all__ = [
    "Block",
    "Finished",
    "MissingExtra",
    "Plan",
    "Sweep",
    "SweepFailed",
    "deviations",
    "placements",
    "plan",
    "read",
    "run",
    "studies",
]
