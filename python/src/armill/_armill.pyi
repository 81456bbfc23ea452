"""The native part of the package. stubtest compares it with the module."""

from collections.abc import Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, SupportsFloat, TypeAlias, final, overload

import numpy as np
import numpy.typing as npt

from armill._types import Branch, Poses, Progress, RobotLike

__all__ = [
    "Cancelled",
    "Evaluation",
    "Fault",
    "InputError",
    "PlacementEvaluations",
    "Postures",
    "Result",
    "Robot",
    "Samples",
    "Study",
    "Table",
    "ToolPath",
    "__version__",
    "arithmetic",
    "call",
    "command",
    "normal_draws",
    "options",
    "read_path",
]

__version__: str

_Path: TypeAlias = str | PathLike[str]
_Floats: TypeAlias = npt.NDArray[np.float64]
_Integers: TypeAlias = npt.NDArray[np.int64]
_Flags: TypeAlias = npt.NDArray[np.bool_]
_Numbers: TypeAlias = npt.ArrayLike
# A number of a pose, or a number on each of its axes.
_Index: TypeAlias = int | tuple[int, ...]

class InputError(ValueError):
    """Bad input: the text of all problems, as the command prints them; `.problems` has each as a dict (`file`, `line`, `column`, `span`, `message`, `hint` for a file; otherwise `message` and optionally `hint`)."""

    problems: list[dict[str, Any]]

class Cancelled(KeyboardInterrupt):
    """The call was interrupted; no result was written."""
class Fault(RuntimeError):
    """A fault of armill itself."""

@final
class Robot:
    """A robot: its kinematic chain, its joints and its compliances. It is immutable."""

    @staticmethod
    def load(robot: _Path) -> Robot:
        """name or path -> Robot: from the library (`yaskawa/mh12`), or from a robot file of any format (TOML, URDF, xacro, OPW,
        Denavit-Hartenberg, chain).
        """
    @staticmethod
    def from_urdf(path: _Path, flange: str | None = None) -> Robot:
        """path -> Robot: from a URDF or xacro file; `flange` is the name of a link, by default the end of the longest chain."""
    @staticmethod
    def from_text(
        text: str,
        format: Literal["armill", "urdf", "opw", "ur", "dh", "chain"],
        name: str = "robot",
        flange: str | None = None,
    ) -> Robot:
        """text -> Robot: from the text of a robot file; `format` is `armill`, `urdf`, `opw`, `ur`, `dh` or `chain`."""
    @staticmethod
    def from_dh(
        rows: _Numbers,
        convention: Literal["standard", "modified"],
        *,
        prismatic: Sequence[int] = (),
        limits: _Numbers | None = None,
        name: str = "robot",
    ) -> Robot:
        """(dof, 4) rows a, alpha, d, theta -> Robot: Denavit-Hartenberg, m and rad, at the controller's zero.

        `convention` is `standard` or `modified` (Craig); `prismatic` lists the joints, from 0, that move along d; `limits`
        (dof, 2) in rad or m.
        """
    @staticmethod
    def from_opw(
        *,
        a1: SupportsFloat,
        a2: SupportsFloat,
        b: SupportsFloat,
        c1: SupportsFloat,
        c2: SupportsFloat,
        c3: SupportsFloat,
        c4: SupportsFloat,
        offsets: Sequence[float] = (0, 0, 0, 0, 0, 0),
        signs: Sequence[int] = (1, 1, 1, 1, 1, 1),
        name: str = "robot",
    ) -> Robot:
        """seven lengths in m, (6,) offsets in rad, (6,) signs -> Robot: an ortho-parallel arm with a spherical wrist (OPW), with
        the parameters of MoveIt.
        """
    @property
    def name(self) -> str:
        """-> str: name in the library, or of its file."""
    @property
    def title(self) -> str:
        """-> str: manufacturer and model."""
    @property
    def dof(self) -> int:
        """-> int: number of joints."""
    @property
    def joint_names(self) -> list[str]:
        """-> list of str, one per joint: the names of the manufacturer."""
    @property
    def contributors(self) -> list[str]:
        """-> list of str: names along the axis of `contributions`: the joints, then those of `base`, `flange`, `tool` with springs."""
    @property
    def limits(self) -> _Floats:
        """-> (dof, 2) lower and upper limit, rad (m): minus and plus infinity for a joint without limits."""
    @property
    def joint_compliance(self) -> _Floats | None:
        """-> (dof,) compliance of each joint, rad/(N m) (prismatic: m/N); None if not known."""
    @property
    def standard_uncertainty(self) -> _Floats | None:
        """-> (dof,) standard uncertainty of each joint compliance, rad/(N m) (m/N); None if the compliances are not known."""
    @property
    def spring_names(self) -> list[str]:
        """-> list of str: names of all springs, the joints first, as in `spring_jacobian` and `spring_compliance`."""
    @property
    def spring_compliance(self) -> _Floats | None:
        """-> (springs,) compliance of each joint, then of each further spring, rad/(N m) (m/N); None if not known."""
    @property
    def compliance_covariance(self) -> _Floats | None:
        """-> (springs, springs) covariance of `spring_compliance`, rad^2/(N m)^2; None if the compliances are not known."""
    @property
    def geometry_motions(self) -> list[str]:
        """-> list of str: names of the uncertain small motions of the geometry; none if their covariance is not known."""
    @property
    def geometry_covariance(self) -> _Floats:
        """-> (motions, motions) covariance of `geometry_motions`, m and rad."""
    @property
    def uncertain_inputs(self) -> list[dict[str, Any]]:
        """-> list of dict: the independent uncertain inputs, in the order of `Samples.z`.

        `name`; `source`: `compliance`, `backlash`, `backlash side`, `mass`, `geometry`, `learnt`, `model error` or `repeatability`;
        `contributors`: the joints, `base`, `flange`, `tool`, `geometry` or `learnt` that it changes. Inputs of correlated
        compliances are the axes of their covariance.
        """
    def with_compliance(
        self, compliance: _Numbers, standard_uncertainty: _Numbers | None = None, *, source: str | None = None
    ) -> Robot:
        """(dof,) compliances, (dof,) standard uncertainties -> Robot: the same with other joint compliances, rad/(N m) (m/N).

        A covariance (dof, dof) may be given in place of the standard uncertainties. `source` states where the compliances come
        from, for `to_toml`; by default "given". Torque curves and covariance of the file are dropped: they belong to the
        compliances that are replaced.
        """
    def sample(
        self, n: int, method: Literal["sobol", "random"] = "sobol", *, seed: int = 0, first: int = 0
    ) -> Samples:
        """n -> Samples: n samples of all uncertain inputs of the robot file.

        `method` is `sobol`, a scrambled Sobol sequence (best with a power of two), or `random`. Sample i depends on
        `seed` and i alone: `first` is the index of the first one, for samples in parts. Inputs have normal distributions
        with the standard uncertainties and covariances of the file; negative compliances, backlashes and masses become 0.
        """
    def samples_at(self, z: _Numbers) -> Samples:
        """(n, inputs) standard normal numbers -> Samples: the values of the robot for numbers of your own.

        One column for each of `uncertain_inputs`: 1 is one standard uncertainty above the value of the file.
        """
    def to_toml(self) -> str:
        """-> str: the robot as a robot file of armill, with seven digits of each given compliance."""
    def to_urdf(self, *, coupling: Literal["own", "mimic"] | None = None) -> str:
        """-> str: the robot as a URDF. `coupling` of coupled joints is `own` (the angle between the links) or `mimic` (a joint follows)."""
    def to_sdf(
        self,
        *,
        stiffness: Literal["passive", "joints"] | None = None,
        joints: _Numbers | None = None,
        coupling: Literal["own", "mimic"] | None = None,
    ) -> str:
        """-> str: the robot as an SDF model. `stiffness` is `passive` (a spring joint behind each drive) or `joints` (each joint is
        a spring at `joints`, (dof,) in rad and m).
        """
    def to_mjcf(
        self,
        *,
        stiffness: Literal["passive", "joints"] | None = None,
        joints: _Numbers | None = None,
        coupling: Literal["own", "mimic"] | None = None,
    ) -> str:
        """-> str: the robot as a model of MuJoCo (MJCF), with the options of `to_sdf`; `joints` are also its key frame."""
    def to_dh(
        self, convention: Literal["standard", "modified", "hayati"] = "standard", *, coupling: Literal["own", "mimic"] | None = None
    ) -> str:
        """-> str: the robot as a Denavit-Hartenberg table (CSV). `convention` is `standard`, `modified` or `hayati`."""
    def to_ur(self) -> str:
        """-> str: the robot as a calibration file of ur_description (YAML)."""
    def forward(
        self, joints: _Numbers, tool: Poses | None = None, *, out: _Floats | None = None, threads: int | None = None
    ) -> _Floats:
        """(n, dof) joints -> (n, 4, 4) poses, base_from_tool.

        `tool` (4, 4) is flange_from_tool. rad and m. `out` is the array to write.
        """
    def jacobian(
        self, joints: _Numbers, tool: Poses | None = None, *, out: _Floats | None = None, threads: int | None = None
    ) -> _Floats:
        """(n, dof) joints -> (n, 6, dof) Jacobians: twist of the TCP per unit of joint position, translation first, base axes."""
    def compliance(
        self,
        joints: _Numbers,
        tool: Poses | None = None,
        *,
        compliances: _Numbers | None = None,
        samples: Samples | None = None,
        out: _Floats | None = None,
        threads: int | None = None,
    ) -> _Floats:
        """(n, dof) joints -> (n, 6, 6) compliances at the TCP, translation first, base axes; m/N, 1/N, rad/(N m).

        All compliances of the robot file are included: drives, springs, torque curves and compensator. `compliances` (dof,)
        or samples (s, dof), rad/(N m), are used in place of those of the joints; samples give (s, n, 6, 6). `samples` are those
        of `Robot.sample`.
        """
    def spring_jacobian(
        self, joints: _Numbers, tool: Poses | None = None, *, out: _Floats | None = None, threads: int | None = None
    ) -> _Floats:
        """(n, dof) joints -> (n, 6, springs) Jacobians: twist of the TCP per unit of deflection of each spring, base axes.

        Translation first; `spring_names` has the columns. Joints deflect in the chain: of coupled arms the columns differ from
        those of `jacobian`. Without torque curves and compensator, `compliance` is `J @ diag(spring_compliance) @ J.T`.
        """
    def mass_matrix(
        self, joints: _Numbers, *, out: _Floats | None = None, threads: int | None = None
    ) -> _Floats:
        """(n, dof) joints -> (n, dof, dof) mass matrices over the joint positions, kg m^2 (kg m, kg).

        From the masses and motors of the robot file, or the inertials of a URDF. Rotors turn with their joints.
        """
    def modes(
        self,
        joints: _Numbers,
        tool: Poses | None = None,
        *,
        compliances: _Numbers | None = None,
        samples: Samples | None = None,
        out: _Floats | None = None,
        threads: int | None = None,
    ) -> _Floats:
        """(n, dof) joints -> (n, modes, 8) modes of vibration, frequencies rising.

        The last axis is: frequency in Hz, damping ratio, and the shape at the TCP normalised by mass, base axes: translation in
        1/sqrt(kg), then rotation in rad/(m sqrt(kg)). There are as many rows as joints and springs; a motion without mass has
        an infinite frequency and shape 0. `compliances` and `samples` as for `compliance`.
        """
    def deviation(
        self,
        joints: _Numbers,
        forces: _Numbers,
        tool: Poses | None = None,
        *,
        paired: bool = False,
        compliances: _Numbers | None = None,
        samples: Samples | None = None,
        all_sources: bool = False,
        out: _Floats | None = None,
        threads: int | None = None,
    ) -> _Floats:
        """(n, dof) joints, (cases, 3) forces -> (n, cases, 3) deviations of the TCP, m, base axes.

        `forces` are forces (cases, 3) in N or wrenches (cases, 6) in N and N m on the tool at the TCP, base axes; one case
        (3,) or (6,) gives (n, 3). With `paired=True` there is one force for each of the joint positions, (n, 3), which gives
        (n, 3). `compliances` (dof,) or samples (s, dof), rad/(N m), are used in place of those of the robot; samples give
        (s, n, cases, 3). `samples` are those of `Robot.sample`. With `all_sources=True` geometry, learnt residual and backlash
        are included, and the scatter of samples; the backlash is in its middle where no torque decides its side. `out` is the
        array to write.
        """
    def deviation_covariance(
        self,
        joints: _Numbers,
        forces: _Numbers,
        tool: Poses | None = None,
        *,
        paired: bool = False,
        all_sources: bool = False,
        out: _Floats | None = None,
        threads: int | None = None,
    ) -> _Floats:
        """(n, dof) joints, (cases, 3) forces -> (n, cases, 3, 3) covariance of the deviation, m^2, base axes.

        By the law of propagation of uncertainty, from all inputs that have one. `forces`, `paired` and `all_sources` are those
        of `deviation`: without `all_sources` the compliances and their model error alone.
        """
    def contributions(
        self,
        joints: _Numbers,
        forces: _Numbers,
        tool: Poses | None = None,
        *,
        paired: bool = False,
        compliances: _Numbers | None = None,
        samples: Samples | None = None,
        out: _Floats | None = None,
        threads: int | None = None,
    ) -> _Floats:
        """(n, dof) joints, (cases, 3) forces -> (n, cases, contributors, 3) contributions to the deviation, m, base axes.

        They add up to the deviation. `Robot.contributors` has the names: the joints, then base, flange and tool with springs.
        The options are those of `deviation`.
        """
    def gravity(
        self,
        joints: _Numbers,
        reference: _Numbers,
        tool: Poses | None = None,
        *,
        acceleration: Sequence[float] = (0.0, 0.0, -9.80665),
        samples: Samples | None = None,
        out: _Floats | None = None,
        threads: int | None = None,
    ) -> _Floats:
        """(n, dof) joints, (dof,) reference -> (n, 3) deviations of the TCP by the weight of the arm, m, base axes.

        They are relative to the joint positions `reference`, at which the tool was measured. The robot file must give the
        masses. `acceleration` (3,) is the acceleration of free fall in base axes, m/s^2; `samples` are those of `Robot.sample`.
        """
    def branch_of(self, joints: _Numbers) -> list[str]:
        """(n, dof) joints -> list of n str: the branch at each of the joint positions.

        For an arm without named branches, the side of its mid-position of each joint.
        """
    def inverse(
        self,
        poses: Poses,
        tool: Poses | None = None,
        *,
        home: _Numbers | None = None,
        threads: int | None = None,
    ) -> Postures:
        """(n, 4, 4) poses -> Postures: all postures at each pose, base_from_tool.

        For an arm without closed form, those that a search finds. `home` (dof,) gives the position of a rail and the
        positions that redundant joints prefer.
        """
    def evaluate(
        self,
        poses: Poses,
        forces: _Numbers,
        tool: Poses | None = None,
        *,
        branch: Branch = "nominal",
        normal: _Numbers | None = None,
        home: _Numbers | None = None,
        paired: bool = False,
        compliances: _Numbers | None = None,
        samples: Samples | None = None,
        threads: int | None = None,
    ) -> Evaluation:
        """(n, 4, 4) poses, (cases, 3) forces -> Evaluation: one posture for each pose, and the deviation of the tool there.

        `branch` is the name of a branch (`front elbow-up no-flip`), `nominal`, or `best`: the posture inside the joint limits
        with the smallest deviation. `normal` (3,) is the outward normal of the plane into which deviations are split. By
        default it is opposite to the tool direction, which must then be the same at all poses. With `paired=True` there is one
        force for each pose. `compliances` (dof,) or samples (s, dof) are used in place of those of the robot; arrays then have
        the axis of the samples first. `samples` are those of `Robot.sample`, without their model error and scatter. Backlash of
        the robot file is included on the side that gives the largest in-plane deviation; `Robot.deviation`, at joint
        positions, includes the load only.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Samples:
    """n samples of the uncertain inputs of a robot: `samples=` of `Robot.deviation`, `compliance`, `evaluate`, ...

    Each input is a standard normal number `z`; the values of the robot are those of its file plus `z` times the standard
    uncertainty, along the axes of the covariance where inputs are correlated. `samples[10:20]` are samples again.
    """

    @property
    def robot(self) -> Robot:
        """-> Robot: the robot that they are of."""
    @property
    def z(self) -> _Floats:
        """-> (n, inputs) standard normal number of each input; `Robot.uncertain_inputs` has their names."""
    @property
    def compliances(self) -> _Floats:
        """-> (n, dof) compliance of each joint, rad/(N m) (m/N)."""
    @property
    def spring_compliances(self) -> _Floats:
        """-> (n, springs) compliance of each spring in addition to the joints, rad/(N m) (m/N)."""
    @property
    def backlash(self) -> _Floats:
        """-> (n, dof) backlash of each joint, rad (m); 0 for a joint without backlash."""
    @property
    def backlash_side(self) -> _Floats:
        """-> (n, dof) side of the backlash where no torque decides it: -1 or 1; 0 for all other joints."""
    @property
    def masses(self) -> _Floats:
        """-> (n, masses) masses of the robot file, kg."""
    @property
    def geometry(self) -> _Floats:
        """-> (n, motions) small motions of the geometry, m and rad; `Robot.geometry_motions` has their names."""
    @property
    def model_error(self) -> _Floats:
        """-> (n,) relative error of the deviation under load that no compliance explains."""
    @property
    def scatter(self) -> _Floats:
        """-> (n, 3) displacement of the TCP by scatter between repetitions, m, base axes."""
    @property
    def cut(self) -> _Integers:
        """-> (n,) int: number of compliances, backlashes and masses that are 0 because the sample would be negative."""
    def to_dict(self) -> dict[str, Any]:
        """-> dict: every array and list by name."""
    def to_pandas(self) -> Any:
        """-> pandas.DataFrame: a row per item, a column per number, with the unit in `attrs`. Needs pandas."""
    def to_xarray(self, dims: Sequence[str] | None = None) -> Any:
        """-> xarray.Dataset: every array by name, with `units` and `long_name`. Needs xarray.

        `dims` are names of the leading axes, such as those of samples or of a grid of poses.
        """
    def __len__(self) -> int: ...
    def __getitem__(self, part: slice, /) -> Samples: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Postures:
    """All postures of many poses: m postures of n poses, in the order of the poses; `postures[i]` are those of pose i.

    Poses with several leading axes are numbered in the order of numpy; `postures[i, j]` is accepted too.
    """

    @property
    def joints(self) -> _Floats:
        """-> (m, dof) joint positions of every posture, rad (m)."""
    @property
    def pose_index(self) -> _Integers:
        """-> (m,) index of the pose of each posture."""
    @property
    def offsets(self) -> _Integers:
        """-> (n + 1,) index of the first posture of each pose; `offsets[i]:offsets[i + 1]` are those of pose i."""
    @property
    def branch(self) -> list[str]:
        """-> list of m str: the branch of each posture; without named branches, the side of its mid-position of each joint."""
    @property
    def within_limits(self) -> _Flags:
        """-> (m,) bool: whether every joint is inside its limits."""
    @overload
    def __getitem__(self, i: _Index, /) -> _Floats: ...
    @overload
    def __getitem__(self, i: slice, /) -> list[_Floats]: ...
    def reason(self, i: _Index | None = None) -> str | None:
        """i -> str or None: why pose i is unreachable, and by how much."""
    def to_dict(self) -> dict[str, Any]:
        """-> dict: every array and list by name."""
    def to_pandas(self) -> Any:
        """-> pandas.DataFrame: a row per item, a column per number, with the unit in `attrs`. Needs pandas."""
    def to_xarray(self, dims: Sequence[str] | None = None) -> Any:
        """-> xarray.Dataset: every array by name, with `units` and `long_name`. Needs xarray.

        `dims` are names of the leading axes, such as those of samples or of a grid of poses.
        """
    def __len__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Evaluation:
    """The posture of an arm and the deviation of the tool at each of n poses under each load case.

    Arrays have the leading axes of the poses, after those of `compliances`; lists have one item per pose, in the same
    order. Poses that the arm cannot reach have NaN in every array of floats, -1 in `worst_case`, False in `within_limits`
    and an empty text in `branch`; `reachable` is the mask of the others.
    """

    @property
    def reachable(self) -> _Flags:
        """-> (n,) bool: whether the arm reaches each pose; all else is valid only where this is True."""
    @property
    def joints(self) -> _Floats:
        """-> (n, dof) joint positions, rad (m); NaN where unreachable."""
    @property
    def deviation(self) -> _Floats:
        """-> (n, cases, 3) deviations of the TCP, m, base axes; NaN where unreachable. (n, 3) if paired."""
    @property
    def in_plane(self) -> _Floats:
        """-> (n,) largest in-plane deviation of all load cases, m; NaN where unreachable."""
    @property
    def in_plane_uncertainty(self) -> _Floats:
        """-> (n,) standard uncertainty of the in-plane deviation from the compliances, m; NaN where unknown or unreachable."""
    @property
    def normal_deviation(self) -> _Floats:
        """-> (n,) deviation along the outward normal, of the load case where its size is largest, m; NaN where unreachable."""
    @property
    def magnitude(self) -> _Floats:
        """-> (n,) largest length of the deviation vector of all load cases, m; NaN where unreachable."""
    @property
    def worst_case(self) -> _Integers:
        """-> (n,) int: load case with the largest in-plane deviation, the row of `forces` from 0; -1 where unreachable.

        0 everywhere if paired. Tables and JSON have the same load case as `worst_case`, numbered from 1.
        """
    @property
    def within_limits(self) -> _Flags:
        """-> (n,) bool: whether every joint is inside its limits."""
    @property
    def contributions(self) -> _Floats:
        """-> (n, contributors) contribution of each joint, then of base, flange and tool with springs, to `in_plane`, m.

        NaN where unreachable. `Robot.contributors` has the names.
        """
    @property
    def joint_names(self) -> list[str]:
        """-> list of str: names along the last axis of `joints`."""
    @property
    def contributors(self) -> list[str]:
        """-> list of str: names along the last axis of `contributions`."""
    @property
    def joint_units(self) -> list[str]:
        """-> list of str: unit of each joint, `rad` or `m`."""
    @property
    def branch(self) -> list[str]:
        """-> list of n str: the branch used at each pose; empty where unreachable."""
    @property
    def singularity(self) -> list[str]:
        """-> list of n str: the singularity that the arm is near, one word; empty where it is near none."""
    def reason(self, i: _Index | None = None) -> str | None:
        """i -> str or None: why the arm does not reach pose i, and by how much; i has an index for each axis if there are several."""
    def to_dict(self) -> dict[str, Any]:
        """-> dict: every array and list by name."""
    def to_pandas(self) -> Any:
        """-> pandas.DataFrame: a row per item, a column per number, with the unit in `attrs`. Needs pandas."""
    def to_xarray(self, dims: Sequence[str] | None = None) -> Any:
        """-> xarray.Dataset: every array by name, with `units` and `long_name`. Needs xarray.

        `dims` are names of the leading axes, such as those of samples or of a grid of poses.
        """
    def __len__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class PlacementEvaluations:
    """The cost of a path for each of n placements of its part; `cost` is infinite where a point is unreachable."""

    @property
    def reachable(self) -> _Flags:
        """-> (n,) bool: whether the best branch reaches every point of the path."""
    @property
    def n_unreachable(self) -> _Integers:
        """-> (n,) int: points of the path that the best branch does not reach."""
    @property
    def cost(self) -> _Floats:
        """-> (n,) value of the objective, m; infinite where a point of the path is unreachable."""
    @property
    def cost_of_reachable(self) -> _Floats:
        """-> (n,) value of the objective over the reachable points alone, m; NaN where none is reachable."""
    @property
    def branch(self) -> list[str]:
        """-> list of n str: the best branch; empty for an arm without named branches, and for holes."""
    @property
    def point_count(self) -> int:
        """-> int: points of the path."""
    @property
    def case_count(self) -> int:
        """-> int: load cases at each point."""
    def to_dict(self) -> dict[str, Any]:
        """-> dict: every array and list by name."""
    def to_pandas(self) -> Any:
        """-> pandas.DataFrame: a row per item, a column per number, with the unit in `attrs`. Needs pandas."""
    def to_xarray(self, dims: Sequence[str] | None = None) -> Any:
        """-> xarray.Dataset: every array by name, with `units` and `long_name`. Needs xarray.

        `dims` are names of the leading axes, such as those of samples or of a grid of poses.
        """
    def __len__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Study:
    """A study file: a robot, a load, and the requested analyses."""

    @staticmethod
    def load(path: _Path, *, robot: RobotLike | None = None) -> Study:
        """path -> Study: a folder with a study.toml, the file itself, or the name of an example study.

        `robot` replaces the robot of the file: a Robot, a name of the library, or the path of a robot file.
        `problems` and `check` report the problems of the contents.
        """
    @staticmethod
    def from_text(text: str, folder: _Path = ".", *, robot: RobotLike | None = None) -> Study:
        """text, folder -> Study: the text of a study file; paths in it are relative to `folder`.

        `robot` replaces the robot of the text, as in `load`.
        """
    @property
    def problems(self) -> list[dict[str, Any]]:
        """-> list of dict: every problem of the file, with `file`, `line`, `column`, `span`, `message` and `hint`."""
    def check(self) -> None:
        """Raises InputError with all problems of the file, if there are any."""
    @property
    def analyses(self) -> list[str]:
        """-> list of str: the names of its analyses."""
    @property
    def point_count(self) -> int:
        """-> int: points and moves that progress counts."""
    @property
    def text(self) -> str:
        """-> str: the text of the file."""
    @property
    def folder(self) -> Path:
        """-> path: the folder that paths in the study are relative to."""
    @property
    def robot(self) -> Robot | None:
        """-> Robot or None: the robot that was given in place of that of the file."""
    def nominal_placement(self, analysis: str | None = None) -> _Floats:
        """analysis name or None -> (8,) x, y, z, heading, tilt, roll, spin, rail: the placement that the study gives, m and rad.

        (7,), without the rail, for an arm that is not on a rail.
        """
    def evaluate_placements(
        self, places: _Numbers, *, analysis: str | None = None, threads: int | None = None
    ) -> PlacementEvaluations:
        """(n, 6) places -> PlacementEvaluations: the cost of the path for each placement of its part.

        A placement is x, y, z of the centre of the plane (m, in the reference frame of the study), heading, tilt and roll of
        the plane (rad); (n, 7) has the spin of the tool relative to the nominal one (rad), (n, 8) the rail (m). Objective,
        branches and margin are those of `[place]` of the study. `analysis` is the name of the path if there are several.
        """
    def run(
        self,
        out: _Path | None = None,
        *,
        pictures: bool = True,
        csv: bool = False,
        force: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Result:
        """folder or None -> Result: runs all analyses; with a folder `out` it writes the files of `armill run`.

        `progress` is called repeatedly with the number of points finished, of `point_count`.
        Files in `out` that armill did not make, or that were changed since, are replaced only with `force=True`.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Result:
    """The results of a study."""

    @property
    def json(self) -> str:
        """-> str: the text of `result.json`, final newline included."""
    @property
    def answer(self) -> dict[str, Any]:
        """-> dict: `result.json` as values."""
    @property
    def sentence(self) -> str:
        """-> str: the result in one sentence."""
    @property
    def warnings(self) -> list[str]:
        """-> list of str: limitations of the result."""
    @property
    def analyses(self) -> list[str]:
        """-> list of str: the names of the analyses."""
    def table(self, analysis: str | None = None) -> Table:
        """analysis name or None -> Table: one row per point, the columns of its Parquet file; by default of the first analysis."""
    @property
    def pictures(self) -> dict[str, str]:
        """-> dict of str to str: all pictures as SVG, by name."""
    def to_pandas(self, analysis: str | None = None) -> Any:
        """analysis name or None -> pandas.DataFrame: the rows of `table`. Needs pandas and pyarrow."""
    def to_xarray(self, analysis: str | None = None) -> Any:
        """analysis name or None -> xarray.Dataset: the columns of `table`, with `units` and `long_name`. Needs xarray.

        A map is over `z` and `y` of its plane, sections with a further dimension, a volume over `z`, `y` and `x`; any other
        analysis over `point`.
        """
    def write(
        self, folder: _Path, *, pictures: bool = True, csv: bool = False, force: bool = False
    ) -> list[PathLike[str]]:
        """folder -> list of paths: writes the files of `armill run`, `result.json` last.

        Files in `folder` that armill did not make, or that were changed since, are replaced only with `force=True`.
        A result that was pickled has its JSON, tables and pictures, but cannot be written.
        """
    def __getitem__(self, key: str, /) -> Any: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Table:
    """Columns of equal length, each with its unit in its name; read by `pandas.DataFrame`, `polars.DataFrame`, `pyarrow.table`.

    `table["x_mm"]` is a column, `table.to_pandas()` a data frame; iteration gives each row as a dict.
    """

    @property
    def name(self) -> str:
        """-> str: name of the table."""
    @property
    def columns(self) -> list[str]:
        """-> list of str: the names of its columns, each ending in its unit."""
    @property
    def units(self) -> dict[str, str]:
        """-> dict of str to str: the unit of each column that has one, such as `um`."""
    @property
    def descriptions(self) -> dict[str, str]:
        """-> dict of str to str: the meaning of each column."""
    def __len__(self) -> int: ...
    def __getitem__(self, name: str, /) -> npt.NDArray[Any]: ...
    def __iter__(self) -> Iterator[dict[str, float | int | bool | str | None]]: ...
    def to_dict(self) -> dict[str, npt.NDArray[Any]]:
        """-> dict: every column by name, as an array."""
    def to_xarray(self, dims: Sequence[str] | None = None) -> Any:
        """-> xarray.Dataset: every column over `row`, with `units` and `long_name`. Needs xarray.

        `dims` is another name of the axis.
        """
    def to_pandas(self) -> Any:
        """-> pandas.DataFrame: the columns; integers with missing values as `Int64`. Needs pandas and pyarrow."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...
    def __arrow_c_schema__(self) -> object: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@final
class ToolPath:
    """The n moves of a program, m and m/s in the frame of the program; a move is given by its end point."""

    @property
    def points(self) -> _Floats:
        """-> (n, 3) end point of each move, m."""
    @property
    def axes(self) -> _Floats:
        """-> (n, 3) tool axes at the end points, from the tip towards the spindle; zeros where the program gives none."""
    @property
    def cuts(self) -> _Flags:
        """-> (n,) bool: whether the tool cuts during the move."""
    @property
    def feed(self) -> _Floats:
        """-> (n,) feed rate of each move, m/s; 0 for rapids, and where the program gives none."""
    @property
    def sweep(self) -> _Floats:
        """-> (n,) angle of each arc, rad, full turns included; 0 for straight moves."""
    @property
    def arc_centre(self) -> _Floats:
        """-> (n, 3) a point on the axis of each arc, m; zeros for straight moves."""
    @property
    def arc_axis(self) -> _Floats:
        """-> (n, 3) axis of rotation of each arc, by the right-hand rule; zeros for straight moves."""
    @property
    def line(self) -> _Integers:
        """-> (n,) line of each move in the program, from 1."""
    @property
    def operation(self) -> _Integers:
        """-> (n,) index of each move's operation in `operations`; -1 before the first."""
    @property
    def operations(self) -> list[dict[str, Any]]:
        """-> list of dict: `name`, `tool`, `diameter` (m), `corner_radius` (m), `spindle` (rad/s), `line`; None if not given."""
    @property
    def format(self) -> Literal["gcode", "apt", "csv"]:
        """-> str: the format of the file: `gcode`, `apt` or `csv`."""
    @property
    def notes(self) -> list[str]:
        """-> list of str: words of the program that were ignored, and assumptions."""
    def to_dict(self) -> dict[str, Any]:
        """-> dict: every array and list by name."""
    def to_pandas(self) -> Any:
        """-> pandas.DataFrame: a row per item, a column per number, with the unit in `attrs`. Needs pandas."""
    def to_xarray(self, dims: Sequence[str] | None = None) -> Any:
        """-> xarray.Dataset: every array by name, with `units` and `long_name`. Needs xarray.

        `dims` are names of the leading axes, such as those of samples or of a grid of poses.
        """
    def __len__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

def normal_draws(
    n: int, inputs: int, method: Literal["sobol", "random"] = "sobol", *, seed: int = 0, first: int = 0
) -> _Floats:
    """n, inputs -> (n, inputs) independent standard normal numbers.

    `method` is `sobol`, a scrambled Sobol sequence (best with a power of two), or `random`. A number depends on `seed`,
    row and column alone; `first` is the index of the first row. `Robot.samples_at` gives the samples of a robot for them.
    """
def read_path(
    file: _Path, *, unit: Literal["mm", "inch"] | None = None, dialect: Literal["nx", "solidworks"] | None = None
) -> ToolPath:
    """file -> ToolPath: the moves of G-code, cutter locations (APT-CL, CLSF) or a CSV of points.

    `unit` (`mm` or `inch`) is the unit of lengths if the file does not state it; `dialect` (`nx` or `solidworks`) is the
    dialect of the cutter locations if the file does not show it.
    """
def call(
    command: str,
    operands: Sequence[Study | RobotLike],
    options: Mapping[str, Any],
    threads: int | None = None,
    progress: Progress | None = None,
) -> tuple[str, list[str], bool]:
    """command name, operands, options -> (json, messages, within_tolerance): the output of the command on stdout with
    `--json`, the lines on stderr, and whether the tolerance is met if `strict` is given.

    Operands and options may be robots and studies in place of names and paths.
    `progress` is called repeatedly with the number of points finished.
    """
def options(name: str) -> tuple[str, list[tuple[str, bool, str]]]:
    """command name -> (help, [(name, is_operand, help)]): the help of a command and of its options."""
def command(words: Sequence[str]) -> int:
    """words -> exit code: the command `armill` on the terminal."""
def arithmetic() -> Literal["fused", "plain"]:
    """-> str: `fused` where a product and a sum are rounded once, `plain` where each is. Machines of one kind give the same bits."""
