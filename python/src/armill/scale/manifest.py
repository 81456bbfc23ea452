"""``manifest.json``: what was asked, into which parts it goes, and which of them are done.

====================  ==================================================================================
``format``            1
``fingerprint``       SHA-256 of what was asked
``asked``             what was asked, by name (``fingerprint.py``)
``item_count``,       the sweep and its parts
``items_per_part``
``evaluation_count``
``columns``           name and type of each; empty before the first part is done
``complete``          whether all parts are done
``parts``             of each part that is done: number, rows, size in bytes, SHA-256 of the file
====================  ==================================================================================
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from armill.scale.errors import refused
from armill.scale.files import write_whole
from armill.scale.fingerprint import asked, fingerprint
from armill.scale.planning import Plan

NAME = "manifest.json"
FORMAT = 1
#: The folder of the parts.
PARTS = "parts"


def part_path(folder: Path, part: int) -> Path:
    """The file of a part. Names of the same length sort as numbers do."""
    return folder / PARTS / f"part-{part:06d}.parquet"


@dataclass(frozen=True)
class Done:
    """A part that is written: what a worker tells of it."""

    part: int
    rows: int
    size: int
    sha256: str
    columns: tuple[tuple[str, str], ...] = ()
    seconds: float = 0.0


@dataclass
class Manifest:
    """What a folder holds."""

    asked: dict[str, str]
    item_count: int
    items_per_part: int
    evaluation_count: int
    columns: tuple[tuple[str, str], ...] = ()
    done: dict[int, Done] = field(default_factory=dict[int, Done])

    @staticmethod
    def of(plan: Plan) -> Manifest:
        """Of a plan of which nothing is done."""
        sweep = plan.sweep
        return Manifest(asked(sweep), sweep.item_count, plan.items_per_part, sweep.evaluation_count)

    @property
    def fingerprint(self) -> str:
        """SHA-256 of what was asked."""
        return fingerprint(self.asked)

    @property
    def part_count(self) -> int:
        """How many parts there are to be."""
        return -(-self.item_count // self.items_per_part)

    @property
    def is_complete(self) -> bool:
        """Whether all of them are done."""
        return len(self.done) == self.part_count

    def write(self, folder: Path) -> None:
        """Writes it into the folder, whole."""
        head: dict[str, Any] = {
            "format": FORMAT,
            "fingerprint": self.fingerprint,
            "asked": self.asked,
            "item_count": self.item_count,
            "items_per_part": self.items_per_part,
            "evaluation_count": self.evaluation_count,
            "columns": [list(column) for column in self.columns],
            "complete": self.is_complete,
        }
        rows = [
            json.dumps({"part": done.part, "rows": done.rows, "size": done.size, "sha256": done.sha256})
            for _, done in sorted(self.done.items())
        ]
        # A line a part: whoever reads it finds one, and so does `diff`.
        text = json.dumps(head, indent=1)[:-2] + ',\n "parts": [' + ",".join(f"\n  {row}" for row in rows) + "\n ]\n}\n"
        write_whole(folder / NAME, text.encode())

    @staticmethod
    def read(folder: Path) -> Manifest | None:
        """That of the folder; None where there is none. Raises InputError for one that cannot be read."""
        path = folder / NAME
        try:
            data = path.read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise refused(f"cannot read {path}: {error.strerror}", "give the folder of a sweep") from error
        try:
            return _manifest(json.loads(data))
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            hint = "it was changed by another program; take the folder away, or give another"
            raise refused(f"{path} is no manifest of a sweep: {type(error).__name__} {error}", hint) from error


def _manifest(told: dict[str, Any]) -> Manifest:
    if told["format"] != FORMAT:
        raise ValueError(f"format {told['format']!r}, this version reads {FORMAT}")
    manifest = Manifest(
        {str(name): str(words) for name, words in told["asked"].items()},
        int(told["item_count"]),
        int(told["items_per_part"]),
        int(told["evaluation_count"]),
        tuple((str(name), str(kind)) for name, kind in told["columns"]),
    )
    if min(manifest.item_count, manifest.items_per_part) < 1:
        raise ValueError("a sweep has an item at least, and so has a part")
    if manifest.fingerprint != told["fingerprint"]:
        raise ValueError("`asked` and `fingerprint` do not belong together")
    for row in told["parts"]:
        done = Done(int(row["part"]), int(row["rows"]), int(row["size"]), str(row["sha256"]))
        if not 0 <= done.part < manifest.part_count:
            raise ValueError(f"there is no part {done.part}")
        manifest.done[done.part] = done
    return manifest


def same_sweep(there: Manifest, here: dict[str, str], folder: Path) -> None:
    """Raises InputError where the manifest is of another sweep than what is asked here, naming what differs."""
    if there.asked == here:
        return
    names = [name for name in {**there.asked, **here} if there.asked.get(name) != here.get(name)]
    told = "; ".join(f"{name}: {there.asked.get(name, 'nothing')} there, {here.get(name, 'nothing')} here" for name in names)
    raise refused(f"{folder} holds another sweep: {told}", "give another folder, or ask the same as there")
