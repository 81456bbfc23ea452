"""Results as dicts, data frames of pandas and data sets of xarray, with units and meanings.

Units are written as pint reads them (``m``, ``rad``, ``um``, ``deg``): ``dataset.pint.quantify()`` of pint-xarray gives quantities.
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from armill import _armill
from armill._armill import Evaluation, PlacementEvaluations, Postures, Result, Samples, Table, ToolPath

if TYPE_CHECKING:
    from armill._sensitivity import VarianceShares


@dataclass(frozen=True)
class Quantity:
    """An array of a result: the axes after the leading ones, its unit, its meaning."""

    rest: tuple[str, ...] = ()
    unit: str | None = None
    meaning: str = ""
    is_list: bool = False


_AXES = ("axis",)
EVALUATION = {
    "reachable": Quantity((), None, "whether the arm reaches the pose"),
    "joints": Quantity(("joint",), "rad", "joint positions"),
    "deviation": Quantity(("case", "axis"), "m", "deviation of the TCP, base axes"),
    "in_plane": Quantity((), "m", "largest in-plane deviation of all load cases"),
    "in_plane_uncertainty": Quantity((), "m", "standard uncertainty of the in-plane deviation"),
    "normal_deviation": Quantity((), "m", "deviation along the outward normal"),
    "magnitude": Quantity((), "m", "largest length of the deviation vector"),
    "worst_case": Quantity((), None, "load case with the largest in-plane deviation, from 0"),
    "within_limits": Quantity((), None, "whether every joint is inside its limits"),
    "contributions": Quantity(("contributor",), "m", "contribution to the in-plane deviation"),
    "branch": Quantity((), None, "branch", is_list=True),
    "singularity": Quantity((), None, "singularity that the arm is near", is_list=True),
}
PLACEMENTS = {
    "reachable": Quantity((), None, "whether every point of the path is reachable"),
    "n_unreachable": Quantity((), None, "points of the path that are not reachable"),
    "cost": Quantity((), "m", "value of the objective"),
    "cost_of_reachable": Quantity((), "m", "value of the objective over the reachable points"),
    "branch": Quantity((), None, "best branch", is_list=True),
}
POSTURES = {
    "joints": Quantity(("joint",), "rad", "joint positions"),
    "pose_index": Quantity((), None, "index of the pose"),
    "branch": Quantity((), None, "branch", is_list=True),
    "within_limits": Quantity((), None, "whether every joint is inside its limits"),
}
SAMPLES = {
    "z": Quantity(("input",), "dimensionless", "standard normal number of the input"),
    "compliances": Quantity(("joint",), "rad/(N*m)", "compliance of the joint"),
    "spring_compliances": Quantity(("spring",), "rad/(N*m)", "compliance of the spring"),
    "backlash": Quantity(("joint",), "rad", "backlash of the joint"),
    "backlash_side": Quantity(("joint",), "dimensionless", "side of the backlash where no torque decides it"),
    "masses": Quantity(("mass",), "kg", "mass"),
    "geometry": Quantity(("motion",), None, "small motion of the geometry, m or rad"),
    "model_error": Quantity((), "dimensionless", "relative error of the deviation under load"),
    "scatter": Quantity(_AXES, "m", "displacement of the TCP by scatter, base axes"),
    "cut": Quantity((), None, "number of values that are 0 because the sample would be negative"),
}
TOOL_PATH = {
    "points": Quantity(_AXES, "m", "end point of the move"),
    "axes": Quantity(_AXES, "dimensionless", "tool axis, from the tip towards the spindle"),
    "cuts": Quantity((), None, "whether the tool cuts during the move"),
    "feed": Quantity((), "m/s", "feed rate"),
    "sweep": Quantity((), "rad", "angle of the arc"),
    "arc_centre": Quantity(_AXES, "m", "point on the axis of the arc"),
    "arc_axis": Quantity(_AXES, "dimensionless", "axis of rotation of the arc"),
    "line": Quantity((), None, "line of the program, from 1"),
    "operation": Quantity((), None, "index of the operation"),
}
_CLASSES: dict[type, tuple[dict[str, Quantity], str]] = {
    Evaluation: (EVALUATION, "pose"),
    PlacementEvaluations: (PLACEMENTS, "placement"),
    Postures: (POSTURES, "posture"),
    Samples: (SAMPLES, "sample"),
    ToolPath: (TOOL_PATH, "move"),
}


class MissingPackage(ImportError):
    """A package is not installed; the message says how to install it."""


def needed(module: str, extra: str) -> Any:
    """The module of a package that is not a requirement of armill."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        package = module.partition(".")[0]
        raise MissingPackage(f'{package} is not installed ({error}): pip install "armill[{extra}]"', name=package) from error


def to_dict(of: Any) -> dict[str, Any]:
    """A result -> its arrays and lists by name."""
    if isinstance(of, Table):
        return {name: of[name] for name in of.columns}
    quantities, _ = _CLASSES[type(of)]
    return {name: getattr(of, name) for name in quantities}


def equal(one: Any, other: Any) -> bool:
    """Whether two results of a class have equal arrays and lists, NaN where NaN, and the same of what else they have."""
    import numpy as np

    if isinstance(one, Samples):
        return bool(one.robot == other.robot) and np.array_equal(one.z, other.z)
    rest = ("joint_names", "contributors", "point_count", "case_count", "offsets", "operations", "notes", "format")
    more = [name for name in rest if hasattr(one, name)]
    theirs = to_dict(other) | {name: getattr(other, name) for name in more}
    for name, own in (to_dict(one) | {name: getattr(one, name) for name in more}).items():
        if isinstance(own, np.ndarray):
            if not np.array_equal(own, theirs[name], equal_nan=own.dtype.kind == "f"):
                return False
        elif own != theirs[name]:
            return False
    return True


def to_pandas(of: Any) -> Any:
    """A result -> a data frame: a row per item; units are in ``frame.attrs["units"]``."""
    import numpy as np

    pandas = needed("pandas", "pandas")
    quantities, item = _CLASSES[type(of)]
    lead = _lead(of)
    index = pandas.RangeIndex(int(np.prod(lead, dtype=int)), name=item)
    if len(lead) > 1:
        index = pandas.MultiIndex.from_product([range(length) for length in lead], names=_dims(of, None))
    columns: dict[str, Any] = {}
    units: dict[str, str] = {}
    for name, quantity in quantities.items():
        values = getattr(of, name)
        flat = np.array(values, dtype=object) if quantity.is_list else np.asarray(values).reshape(len(index), -1)
        labels = [name] if quantity.is_list or flat.shape[1:] == (1,) and not quantity.rest else None
        if labels is None:
            parts = [_names(of, dim, length) for dim, length in zip(_rest(of, name, quantity), np.asarray(values).shape[len(lead) :], strict=True)]
            labels = [f"{name}_{'_'.join(each)}" for each in _product(parts)]
        for place, label in enumerate(labels):
            columns[label] = flat if quantity.is_list else flat[:, place]
            unit = _unit_of(of, name, quantity, place)
            if unit:
                units[label] = unit
    frame = pandas.DataFrame(columns, index=index)
    frame.attrs["units"] = units
    return frame


def to_xarray(of: Any, dims: Sequence[str] | None = None) -> Any:
    """A result -> a data set, with ``units`` and ``long_name`` of each array."""
    import numpy as np

    xarray = needed("xarray", "xarray")
    if isinstance(of, Table):
        return _table_dataset(of, (dims or ["row"])[0])
    quantities, _ = _CLASSES[type(of)]
    lead, names = _lead(of), _dims(of, dims)
    data: dict[str, Any] = {}
    coords: dict[str, Any] = {}
    for name, quantity in quantities.items():
        values = np.asarray(getattr(of, name), dtype=str if quantity.is_list else None)
        if quantity.is_list:
            values = values.reshape(lead)
        rest = _rest(of, name, quantity)
        if 0 in values.shape[len(lead) :]:
            continue
        for dim, length in zip(rest, values.shape[len(lead) :], strict=True):
            coords[dim] = _names(of, dim, length)
        data[name] = xarray.Variable((*names, *rest), values, _attributes(_unit_of(of, name, quantity, None), quantity.meaning))
    coords |= _more_coords(of, xarray)
    return xarray.Dataset(data, coords, {"source": f"armill {_armill.__version__}"})


def _lead(of: Any) -> tuple[int, ...]:
    """The lengths of the leading axes."""
    if isinstance(of, Evaluation):
        return tuple(of.reachable.shape)
    if isinstance(of, PlacementEvaluations):
        return tuple(of.cost.shape)
    if isinstance(of, Postures):
        return (len(of.pose_index),)
    return (len(of),)


def _dims(of: Any, dims: Sequence[str] | None) -> list[str]:
    """The names of the leading axes."""
    lead, (_, item) = _lead(of), _CLASSES[type(of)]
    if dims is None:
        return [item] if len(lead) == 1 else [f"{item}_{axis}" for axis in range(len(lead))]
    if len(dims) != len(lead):
        raise ValueError(f"dims: expected {len(lead)} names, given {', '.join(dims) or 'none'}")
    return list(dims)


def _rest(of: Any, name: str, quantity: Quantity) -> tuple[str, ...]:
    """The axes of an array after the leading ones: of load cases there may be none, or several."""
    if not isinstance(of, Evaluation) or name != "deviation":
        return quantity.rest
    cases = of.deviation.ndim - of.reachable.ndim - 1
    return (*(("case",) if cases == 1 else tuple(f"case_{axis}" for axis in range(cases))), "axis")


def _names(of: Any, dim: str, length: int) -> list[Any]:
    """The coordinates along an axis."""
    known: dict[str, list[str]] = {"axis": ["x", "y", "z"]}
    if isinstance(of, Evaluation):
        known |= {"joint": of.joint_names, "contributor": of.contributors}
    if isinstance(of, Samples):
        robot = of.robot
        known |= {
            "input": [entry["name"] for entry in robot.uncertain_inputs],
            "joint": robot.joint_names,
            "spring": robot.spring_names[robot.dof :],
            "motion": robot.geometry_motions,
        }
    names = known.get(dim, [])
    return names if len(names) == length else [str(place) for place in range(length)] if dim != "case" else list(range(length))


def _product(parts: list[list[Any]]) -> list[list[str]]:
    found: list[list[str]] = [[]]
    for part in parts:
        found = [[*before, str(name)] for before in found for name in part]
    return found


def _unit_of(of: Any, name: str, quantity: Quantity, place: int | None) -> str | None:
    """The unit of an array, or of one number of it; none for joints of two units together."""
    if name == "joints" and isinstance(of, Evaluation):
        units = of.joint_units
        return units[place] if place is not None else units[0] if len(set(units)) == 1 else None
    return quantity.unit


def _attributes(unit: str | None, meaning: str) -> dict[str, str]:
    found = {"units": unit} if unit else {}
    return found | ({"long_name": meaning} if meaning else {})


def _more_coords(of: Any, xarray: Any) -> dict[str, Any]:
    if isinstance(of, Evaluation):
        return {"joint_unit": xarray.Variable(("joint",), of.joint_units)}
    return {}


def _column_attributes(table: Table, name: str) -> dict[str, str]:
    unit = table.units.get(name)
    return _attributes(unit.replace("^", "**") if unit else None, table.descriptions.get(name, ""))


def _column(table: Table, name: str) -> Any:
    """A column as xarray stores it: integers with missing values as floats."""
    import numpy as np

    values = table[name]
    if np.ma.isMaskedArray(values):
        return np.ma.filled(values.astype(float), np.nan) if values.dtype.kind in "iu" else np.ma.filled(values.astype(object), "")
    return values if values.dtype.kind != "O" else values.astype(str)


def _table_dataset(table: Table, dim: str) -> Any:
    xarray = needed("xarray", "xarray")
    data = {name: xarray.Variable((dim,), _column(table, name), _column_attributes(table, name)) for name in table.columns}
    return xarray.Dataset(data, attrs={"title": table.name, "source": f"armill {_armill.__version__}"})


def result_dataset(result: Result, analysis: str | None) -> Any:
    """A result, the name of an analysis -> its table over the axes of a plane or a box, or over its points."""
    xarray = needed("xarray", "xarray")
    name = analysis if analysis is not None else result.analyses[0]
    table = result.table(name)
    answer = result.answer
    planes = [each for each in answer.get("maps") or [] if each["name"] == name or each["name"].startswith(f"{name}: ")]
    volumes = [each for each in answer.get("volumes") or [] if each["name"] == name]
    lengths: list[int] = []
    dims: list[str] = []
    coords: dict[str, Any] = {}
    if planes:
        grid = planes[0]["grid"]
        if len(planes) > 1 or planes[0]["name"] != name:
            labels = [each["name"].removeprefix(f"{name}: ") for each in planes]
            lengths, dims, coords = [len(planes)], ["section"], {"section": labels}
        for axis, key, meaning in (("z", "z_mm", "along the plane, z'"), ("y", "y_mm", "across, y'")):
            lengths.append(len(grid[key]))
            dims.append(axis)
            coords[axis] = xarray.Variable((axis,), grid[key], _attributes("mm", meaning))
    elif volumes:
        counts = volumes[0]["point_counts"]
        lengths, dims = [int(count) for count in reversed(counts)], ["z", "y", "x"]
    size = 1
    for length in lengths:
        size *= length
    if not dims or size != len(table):
        return _table_dataset(table, "point")
    data: dict[str, Any] = {}
    for column in table.columns:
        if column in coords:
            continue
        variable = xarray.Variable(dims, _column(table, column).reshape(lengths), _column_attributes(table, column))
        data[column] = variable
    if volumes:
        for axis, column in (("x", "x_mm"), ("y", "y_mm"), ("z", "z_mm")):
            whole = data[column]
            along = whole.isel({other: 0 for other in dims if other != axis})
            if bool((whole == along).all()):
                coords[axis] = xarray.Variable((axis,), along.values, whole.attrs)
    return xarray.Dataset(data, coords, {"title": name, "source": f"armill {_armill.__version__}"})


def shares_dataset(shares: VarianceShares) -> Any:
    """Shares of the variance -> a data set over ``group`` and the axes of the result."""
    xarray = needed("xarray", "xarray")
    rest = tuple(f"result_{axis}" for axis in range(shares.mean.ndim))
    names = ("first_order", "total", "first_order_u", "total_u")
    data: dict[str, Any] = {name: (("group", *rest), getattr(shares, name), {"units": "dimensionless"}) for name in names}
    data |= {name: (rest, getattr(shares, name)) for name in ("mean", "variance")}
    return xarray.Dataset(data, {"group": shares.groups}, {"evaluations": shares.evaluations})


def shares_frame(shares: VarianceShares) -> Any:
    """Shares of the variance -> a data frame with a row per group and result."""
    import numpy as np

    pandas = needed("pandas", "pandas")
    levels = [shares.groups, *(range(length) for length in shares.mean.shape)]
    names = ["group", *(f"result_{axis}" for axis in range(shares.mean.ndim))]
    index = pandas.MultiIndex.from_product(levels, names=names) if shares.mean.ndim else pandas.Index(shares.groups, name="group")
    columns = ("first_order", "total", "first_order_u", "total_u")
    return pandas.DataFrame({name: np.ravel(getattr(shares, name)) for name in columns}, index=index)
