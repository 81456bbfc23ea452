"""``manifest.json``: the request, its parts, and which of them are finished.

====================  ==================================================================================
``format``            1
``fingerprint``       SHA-256 of the request
``request``           the request: texts by name (``fingerprint.py``)
``item_count``,       the sweep and its parts
``items_per_part``
``evaluation_count``
``columns``           name and type of each; empty before the first part is finished
``complete``          whether all parts are finished
``shard``             of a job of an array: its number from 0, and the number of jobs
``parts``             of each finished part: number, rows, size in bytes, SHA-256 of the file
====================  ==================================================================================
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

from armill.scale.errors import refused
from armill.scale.files import write_whole
from armill.scale.fingerprint import fingerprint, request_of
from armill.scale.planning import Plan
from armill.scale.remote import Folder, is_missing

NAME = "manifest.json"
FORMAT = 1
#: The folder of the parts.
PARTS = "parts"
#: The folder of the jobs of an array, each with a folder and a manifest.
JOBS = "jobs"


def part_path(folder: Folder, part: int) -> Folder:
    """The file of a part. Names of equal length sort like numbers."""
    return folder / PARTS / f"part-{part:06d}.parquet"


@dataclass(frozen=True)
class Done:
    """A finished part, as reported by a worker."""

    part: int
    rows: int
    size: int
    sha256: str
    columns: tuple[tuple[str, str], ...] = ()
    seconds: float = 0.0


@dataclass
class Manifest:
    """The contents of a folder."""

    request: dict[str, str]
    item_count: int
    items_per_part: int
    evaluation_count: int
    columns: tuple[tuple[str, str], ...] = ()
    done: dict[int, Done] = field(default_factory=dict[int, Done])
    shard: tuple[int, int] | None = None

    @staticmethod
    def of(plan: Plan, shard: tuple[int, int] | None = None) -> Manifest:
        """Of a plan without finished parts."""
        sweep = plan.sweep
        return Manifest(request_of(sweep), sweep.item_count, plan.items_per_part, sweep.evaluation_count, shard=shard)

    @property
    def fingerprint(self) -> str:
        """SHA-256 of the request."""
        return fingerprint(self.request)

    @property
    def part_count(self) -> int:
        """Number of parts of the sweep."""
        return -(-self.item_count // self.items_per_part)

    @property
    def parts(self) -> range:
        """The numbers of its parts: all, or those of its job."""
        job, jobs = self.shard or (0, 1)
        return range(job, self.part_count, jobs)

    @property
    def is_complete(self) -> bool:
        """Whether all its parts are finished."""
        return len(self.done) == len(self.parts)

    def write(self, folder: Folder) -> None:
        """Writes it into the folder, atomically."""
        head: dict[str, Any] = {
            "format": FORMAT,
            "fingerprint": self.fingerprint,
            "request": self.request,
            "item_count": self.item_count,
            "items_per_part": self.items_per_part,
            "evaluation_count": self.evaluation_count,
            "columns": [list(column) for column in self.columns],
            "complete": self.is_complete,
        }
        if self.shard:
            head["shard"] = list(self.shard)
        rows = [
            json.dumps({"part": done.part, "rows": done.rows, "size": done.size, "sha256": done.sha256})
            for _, done in sorted(self.done.items())
        ]
        # One line per part, for readers and for `diff`.
        text = json.dumps(head, indent=1)[:-2] + ',\n "parts": [' + ",".join(f"\n  {row}" for row in rows) + "\n ]\n}\n"
        write_whole(folder / NAME, text.encode())

    @staticmethod
    def read(folder: Folder) -> Manifest | None:
        """The manifest of the folder; None if there is none. Raises InputError if it cannot be read."""
        path = folder / NAME
        try:
            data = path.read_bytes()
        except OSError as error:
            if is_missing(error):
                return None
            raise refused(f"cannot read {path}: {error.strerror or error}", "give the folder of a sweep") from error
        try:
            return _manifest(json.loads(data))
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            hint = "it was changed by another program; delete the folder, or give another"
            raise refused(f"{path} is not the manifest of a sweep: {type(error).__name__} {error}", hint) from error


def _manifest(data: dict[str, Any]) -> Manifest:
    if data["format"] != FORMAT:
        raise ValueError(f"format {data['format']!r}, this version reads {FORMAT}")
    manifest = Manifest(
        {str(name): str(words) for name, words in data["request"].items()},
        int(data["item_count"]),
        int(data["items_per_part"]),
        int(data["evaluation_count"]),
        tuple((str(name), str(kind)) for name, kind in data["columns"]),
    )
    if "shard" in data:
        job, jobs = (int(number) for number in data["shard"])
        if not 0 <= job < jobs:
            raise ValueError(f"job {job} of {jobs} does not exist")
        manifest.shard = (job, jobs)
    if min(manifest.item_count, manifest.items_per_part) < 1:
        raise ValueError("a sweep and a part have at least one item")
    if manifest.fingerprint != data["fingerprint"]:
        raise ValueError("`request` and `fingerprint` do not match")
    for row in data["parts"]:
        done = Done(int(row["part"]), int(row["rows"]), int(row["size"]), str(row["sha256"]))
        if done.part not in manifest.parts:
            raise ValueError(f"part {done.part} does not exist")
        manifest.done[done.part] = done
    return manifest


def same_sweep(there: Manifest, here: dict[str, str], folder: Folder) -> None:
    """Raises InputError with the differences if the manifest is of another sweep."""
    if there.request == here:
        return
    names = [name for name in {**there.request, **here} if there.request.get(name) != here.get(name)]
    differences = "; ".join(f"{name}: {there.request.get(name, 'nothing')} there, {here.get(name, 'nothing')} here" for name in names)
    raise refused(f"{folder} contains another sweep: {differences}", "give another folder, or the same sweep as there")
