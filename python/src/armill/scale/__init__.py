"""Sweeps on one or many machines: evaluations of many items, in parts, on threads, on Dask or on Ray.

A sweep numbers its items. A part is a range of items and one Parquet file. A folder contains the parts and
``manifest.json``. Finished parts are kept: if a worker or the program is killed, only the parts in progress are lost. The
parts have the same bytes on any machine and in any order of execution.

====================================  ==========================================================================
``Sweep``, ``Block``                  axes and a function of some items (``sweep.py``)
``placements``, ``deviations``,       predefined sweeps (``sweeps/``)
``studies``
``plan``, ``Plan``                    division into parts (``planning.py``)
``run``, ``Finished``                 runs the parts that are not finished (``running.py``)
``read``                              the rows of all parts, in their order (``reading.py``)
``SweepFailed``, ``MissingExtra``     errors in addition to ``armill.InputError`` (``errors.py``)
====================================  ==========================================================================
"""

from armill.scale.errors import MissingExtra, SweepFailed
from armill.scale.planning import Plan, plan
from armill.scale.reading import read, read_xarray
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
    "read_xarray",
    "run",
    "studies",
]
