"""The rows of a sweep, part after part, in the order of the items."""

from __future__ import annotations

import os
from typing import Any

from armill._labelled import needed as labelled_needed
from armill.scale.errors import needed, refused
from armill.scale.files import sha256_of
from armill.scale.manifest import Manifest, part_path
from armill.scale.remote import Folder, RemotePath, StorageOptions, folder_of


def read(
    folder: str | os.PathLike[str],
    *,
    partial: bool = False,
    verify: bool = False,
    storage_options: StorageOptions = None,
) -> Any:
    """folder -> pyarrow.dataset.Dataset: the rows of all parts in the order of the items.

    ``.to_table().to_pandas()`` makes one frame of them. An unfinished sweep is refused, unless ``partial`` is given: then the
    finished parts are read. ``verify`` reads every file once and compares its hash. ``storage_options`` as for ``run``.
    """
    place, manifest = _complete(folder, partial, storage_options)
    damaged = [part for part in sorted(manifest.done) if not is_whole(place, manifest, part, verify)]
    if damaged:
        numbers = ", ".join(map(str, damaged[:10]))
        hint = "run the same sweep into it again to repeat them"
        raise refused(f"{place}: {len(damaged)} parts are not as they were written: {numbers}", hint)
    dataset = needed("pyarrow.dataset", "scale")
    paths = [part_path(place, part) for part in sorted(manifest.done)]
    if isinstance(place, RemotePath):
        names = [path.path for path in paths if isinstance(path, RemotePath)]
        return dataset.dataset(names, format="parquet", filesystem=place.system)
    return dataset.dataset([str(path) for path in paths], format="parquet")


def _complete(folder: str | os.PathLike[str], partial: bool, options: StorageOptions) -> tuple[Folder, Manifest]:
    """The folder and its manifest. Raises InputError for an unfinished sweep, unless ``partial``."""
    place = folder_of(folder, options)
    manifest = Manifest.read(place)
    if manifest is None:
        raise refused(f"{place} contains no sweep: it has no manifest.json", "give the folder of a run")
    if not manifest.is_complete and not partial:
        message = f"{place} contains {len(manifest.done)} of {manifest.part_count} parts"
        raise refused(message, "run the same sweep into it again to continue, or read it with partial=True")
    if not manifest.done:
        raise refused(f"{place} contains no finished part", "run the sweep first")
    return place, manifest


def is_whole(folder: Folder, manifest: Manifest, part: int, verify: bool) -> bool:
    """Whether the file of a finished part has its size; with ``verify``, whether it has the same bytes."""
    path, done = part_path(folder, part), manifest.done[part]
    try:
        return path.stat().st_size == done.size and (not verify or sha256_of(path) == done.sha256)
    except OSError:
        return False


#: Units of columns by the end of their names, as pint reads them.
_UNITS = {"um": "um", "mm": "mm", "deg": "deg", "m": "m", "rad": "rad", "n": "N", "nm": "N*m", "hz": "Hz", "s": "s", "percent": "percent"}


def read_xarray(folder: str | os.PathLike[str], *, storage_options: StorageOptions = None) -> Any:
    """folder -> xarray.Dataset: the columns of a finished sweep over its axes, with units. Needs xarray.

    Where an item has several rows, such as one for each load case, the last dimension is ``row``. Missing values are NaN.
    """
    xarray = labelled_needed("xarray", "xarray")
    _, manifest = _complete(folder, False, storage_options)
    table = read(folder, storage_options=storage_options).to_table()
    axes = {name.removeprefix("axis "): int(length) for name, length in manifest.request.items() if name.startswith("axis ")}
    rows = table.num_rows // manifest.item_count
    dims, shape = list(axes), list(axes.values())
    if rows > 1:
        dims, shape = [*dims, "row"], [*shape, rows]
    data: dict[str, Any] = {}
    for name in table.column_names:
        if name.removesuffix("_index") in axes:
            continue
        unit = _UNITS.get(name.rpartition("_")[2])
        values = table[name].to_numpy().reshape(shape)
        data[name] = xarray.Variable(dims, values, {"units": unit} if unit else {})
    return xarray.Dataset(data, attrs={"fingerprint": manifest.fingerprint})
