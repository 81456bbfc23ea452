"""What each uncertain input explains of the variance of a result: Sobol indices, and the law of propagation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from armill._armill import InputError, Robot, Samples, normal_draws

if TYPE_CHECKING:
    # The import of armill does not load numpy.
    import numpy as np
    import numpy.typing as npt

    from armill._types import Poses

    Floats: TypeAlias = npt.NDArray[np.float64]

#: Inputs that belong together: those of a source, of a joint or another contributor, or each by itself.
Grouping: TypeAlias = Literal["source", "contributor", "input"]


@dataclass(frozen=True, eq=False)
class VarianceShares:
    """Shares of the variance of results by groups of inputs; arrays begin with the axis of the groups.

    ``groups`` has the names; ``first_order`` the share that disappears on average if the group were known, ``total`` the share that
    is left if all others were known: their difference is by interactions. ``first_order_u`` and ``total_u`` are standard errors of
    the estimates; ``mean``, ``variance`` and ``evaluations`` those of the samples.
    """

    groups: list[str]
    first_order: Floats
    total: Floats
    first_order_u: Floats
    total_u: Floats
    mean: Floats
    variance: Floats
    evaluations: int

    def to_xarray(self) -> Any:
        """-> xarray.Dataset: every array by name, over the groups and the axes of the result. Needs xarray."""
        from armill import _labelled

        return _labelled.shares_dataset(self)

    def to_pandas(self) -> Any:
        """-> pandas.DataFrame: a row per group and result. Needs pandas."""
        from armill import _labelled

        return _labelled.shares_frame(self)

    def __eq__(self, other: object) -> bool:
        import numpy as np

        if not isinstance(other, VarianceShares) or self.groups != other.groups:
            return False
        names = ("first_order", "total", "first_order_u", "total_u", "mean", "variance")
        return all(np.array_equal(getattr(self, name), getattr(other, name), equal_nan=True) for name in names)

    def _repr_html_(self) -> str:
        import numpy as np

        rows = ""
        for group, first, total in zip(self.groups, self.first_order, self.total):
            cells = "".join(f"<td>{np.nanmean(values):.3f}</td>" for values in (first, total))
            rows += f"<tr><th>{escape(group)}</th>{cells}</tr>"
        head = "<tr><th>group</th><th>first order</th><th>total</th></tr>"
        return f"<table><caption>Shares of the variance, mean of all results</caption>{head}{rows}</table>"


def sobol_indices(
    robot: Robot,
    joints: npt.ArrayLike | None = None,
    forces: npt.ArrayLike | None = None,
    tool: Poses | None = None,
    *,
    function: Callable[[Samples], npt.ArrayLike] | None = None,
    n: int = 1024,
    by: Grouping = "contributor",
    method: Literal["sobol", "random"] = "sobol",
    seed: int = 0,
    paired: bool = False,
    all_sources: bool = True,
    threads: int | None = None,
) -> VarianceShares:
    """robot, joints, forces -> VarianceShares: first-order and total Sobol indices of the deviation, by groups of inputs.

    ``joints``, ``forces``, ``tool``, ``paired`` and ``all_sources`` are those of ``Robot.deviation``. In their place ``function`` may be
    given, which returns (n, ...) results of its own for ``Samples`` of the robot. ``by`` groups the inputs: by ``source``, by
    ``contributor`` (joint, base, ...; those with correlated compliances together), or each ``input`` by itself. ``n`` is the number of
    base samples, best a power of two: there are ``n`` times 2 and the number of groups evaluations.
    """
    import numpy as np

    run = _function(robot, joints, forces, tool, function, paired, all_sources, threads)
    groups = _groups(robot, by)
    inputs = len(robot.uncertain_inputs)
    if n < 2:
        raise _refused(f"n is {n}", "at least 2 samples, best a power of two")
    z = normal_draws(n, 2 * inputs, method, seed=seed)
    first, second = z[:, :inputs], z[:, inputs:]
    y_a, y_b = run(robot.samples_at(first)), run(robot.samples_at(second))
    both = np.concatenate([y_a, y_b])
    mean, variance = both.mean(axis=0), both.var(axis=0)
    # Estimates have less scatter for results with mean 0.
    y_a, y_b = y_a - mean, y_b - mean
    found: list[list[Floats]] = []
    for columns in groups.values():
        mixed = first.copy()
        mixed[:, columns] = second[:, columns]
        y_ab = run(robot.samples_at(mixed)) - mean
        with np.errstate(invalid="ignore", divide="ignore"):
            terms = [y_b * (y_ab - y_a) / variance, 0.5 * (y_a - y_ab) ** 2 / variance]
        found.append([*(term.mean(axis=0) for term in terms), *(term.std(axis=0, ddof=1) / np.sqrt(n) for term in terms)])
    first_order, total, first_order_u, total_u = (np.array(each) for each in zip(*found, strict=True))
    return VarianceShares(list(groups), first_order, total, first_order_u, total_u, mean, variance, n * (2 + len(groups)))


def variance_shares(
    robot: Robot,
    joints: npt.ArrayLike | None = None,
    forces: npt.ArrayLike | None = None,
    tool: Poses | None = None,
    *,
    function: Callable[[Samples], npt.ArrayLike] | None = None,
    by: Grouping = "contributor",
    paired: bool = False,
    all_sources: bool = True,
    threads: int | None = None,
) -> VarianceShares:
    """robot, joints, forces -> VarianceShares: shares of the variance by the law of propagation of uncertainty.

    Each input is changed by plus and minus one standard uncertainty: exact for a result that is linear in the inputs, and fast.
    There ``first_order`` and ``total`` are equal, and no standard error is known. The arguments are those of ``sobol_indices``.
    The side of a backlash has the sign of its input, and both signs are equally likely: its change is that from the middle.
    """
    import numpy as np

    run = _function(robot, joints, forces, tool, function, paired, all_sources, threads)
    groups = _groups(robot, by)
    inputs = len(robot.uncertain_inputs)
    steps = np.concatenate([np.zeros((1, inputs)), np.eye(inputs), -np.eye(inputs)])
    y = run(robot.samples_at(steps))
    squares = ((y[1 : inputs + 1] - y[inputs + 1 :]) / 2) ** 2
    variance = squares.sum(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        shares = np.array([squares[columns].sum(axis=0) / variance for columns in groups.values()])
    unknown = np.full_like(shares, np.nan)
    return VarianceShares(list(groups), shares, shares.copy(), unknown, unknown.copy(), y[0], variance, 2 * inputs + 1)


def _function(
    robot: Robot,
    joints: npt.ArrayLike | None,
    forces: npt.ArrayLike | None,
    tool: Poses | None,
    function: Callable[[Samples], npt.ArrayLike] | None,
    paired: bool,
    all_sources: bool,
    threads: int | None,
) -> Callable[[Samples], Floats]:
    """Results of samples: of the caller, or deviations."""
    import numpy as np

    if (function is None) == (joints is None or forces is None):
        raise _refused("joints with forces, or a function, are given twice or not at all", "give either joints and forces, or function=")

    def run(samples: Samples) -> Floats:
        if function is None:
            assert joints is not None and forces is not None
            return robot.deviation(
                joints, forces, tool, samples=samples, paired=paired, all_sources=all_sources, threads=threads
            )
        found = np.asarray(function(samples), dtype=float)
        if found.ndim < 1 or len(found) != len(samples):
            raise _refused(f"function: a result of shape {found.shape} for {len(samples)} samples", "return (n, ...) for n samples")
        return found

    return run


def _groups(robot: Robot, by: Grouping) -> dict[str, list[int]]:
    """Indices of the inputs of each group, by its name."""
    inputs = robot.uncertain_inputs
    if by == "input":
        return {entry["name"]: [index] for index, entry in enumerate(inputs)}
    groups: dict[str, list[int]] = {}
    if by == "source":
        for index, entry in enumerate(inputs):
            groups.setdefault(entry["source"], []).append(index)
        return groups
    if by != "contributor":
        raise _refused(f"by: {by!r} is not a valid grouping", "`source`, `contributor` or `input`")
    # Contributors with a common input are one group.
    sets: list[tuple[list[str], list[int]]] = []
    for index, entry in enumerate(inputs):
        names: list[str] = entry["contributors"] or [entry["source"]]
        touching = [each for each in sets if set(each[0]) & set(names)]
        merged = [name for each in touching for name in each[0]]
        merged += [name for name in names if name not in merged]
        columns = sorted([column for each in touching for column in each[1]] + [index])
        kept = [each for each in sets if each not in touching]
        at = sets.index(touching[0]) if touching else len(kept)
        sets = [*kept[:at], (merged, columns), *kept[at:]]
    return {"+".join(names): columns for names, columns in sets}


def _refused(message: str, hint: str) -> InputError:
    error = InputError(f"{message}\n  help: {hint}")
    error.problems = [{"message": message, "hint": hint}]
    return error
