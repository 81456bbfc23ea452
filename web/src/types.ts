// Answers of the server, by the names used in the page. Their types are generated: `api.d.ts` is made from the OpenAPI
// description of the server (`npm run types`). This file only refines them.

import type { components } from "./api";
import type { Points } from "./scene/points";

type Schemas = components["schemas"];

export type Vec3 = [number, number, number];

export type Problem = Schemas["Problem"];
export type Wrong = Schemas["ErrorDetail"];
export type Study = Schemas["StudyOnDisk"];
export type StudyVersion = Schemas["StudyVersion"];
export type Analysis = Schemas["OutlinedAnalysis"];
export type Checked = Schemas["OutlineAnswer"];
export type Changed = Schemas["ChangedAnswer"];
export type Change = Schemas["ChangedValue"];
export type Tables = Omit<Schemas["TablesAnswer"], "places"> & { places: { path: string; bytes: [number, number] }[] };

// openapi-typescript does not handle nested lists of fixed length: these types are corrected by hand.
type Region = Omit<Schemas["RegionAnswer"], "rectangle_mm"> & { rectangle_mm: [[number, number], [number, number]] | null };
export type MapAnswer = Omit<Schemas["MapAnswer"], "region"> & { region: Region };
export type Plate = Omit<Schemas["PlateInScene"], "corners_mm"> & { corners_mm: [Vec3, Vec3, Vec3, Vec3] };
type Box = Omit<Schemas["BoxInScene"], "sides_mm"> & { sides_mm: [Vec3, Vec3, Vec3] };
type Stiffness = Omit<Schemas["StiffnessAnswer"], "principal_direction" | "stiffness"> & { principal_direction: [Vec3, Vec3, Vec3] };
export type Posture = Omit<Schemas["PostureAnswer"], "compliance" | "stiffness" | "jacobian" | "loaded_compliance"> & { compliance: number[][] | null; stiffness: Stiffness | null };

export type Answer = Omit<Schemas["StudyAnswer"], "maps"> & { maps: MapAnswer[] };
export type Point = Schemas["PointAnswer"];
export type Setting = Schemas["SettingAnswer"];
export type HoleRow = Schemas["HoleAnswer"];
export type Reachable = Schemas["ReachableAnswer"];
export type Values = Schemas["ValuesAnswer"];
/** The deviation over a path and the spin of the tool; the spins that a search finds. */
export type SpinMap = Schemas["SpinMapAnswer"];
export type SpinSearch = Schemas["SpinSearchAnswer"];
/** The grid of a map that is requested alone. */
export type MapGrid = Schemas["GridAnswer"];
/** y', z' of its points. */
export type Line = [number, number][];
/** Lines of equal deviation on a map. */
export type MapLines = Schemas["LinesAnswer"];

export type LayerKey = Schemas["LayerKey"];
/** The values of the quantity that colours show. */
export type LayerAnswer = Schemas["LayerAnswer"];

export type At = Schemas["PoseTarget"];
export type PoseRequest = Schemas["PoseRequest"];
/** What the robot follows: the worst or best point shown, or a point chosen by the user. */
export type Follow = Schemas["Follow"];
export type Extremes = Schemas["ExtremesAnswer"];
export type Axes = [Vec3, Vec3, Vec3];
export type ArmDrawing = Omit<Schemas["DrawnPosture"], "flange_axes" | "cell"> & { flange_axes: Axes; cell: DrawnCell | null };
/** The cell with the arm in a posture. */
export type DrawnCell = Omit<Schemas["DrawnCell"], "nearest_mm"> & { nearest_mm: [Vec3, Vec3] | null };
/** The bodies of the cell. */
export type CellScene = Schemas["CellInScene"];
export type Body = Schemas["BodyInScene"];
export type BodyRole = Schemas["BodyRole"];
export type BodyShape = Schemas["ShapeInScene"];
export type BodyPose = Schemas["BodyPose"];
export type DrawnMesh = Schemas["DrawnMesh"];
export type CaseValues = Schemas["CaseAnswer"] & {
  permissible_along_load_n?: number | null;
  permissible_any_direction_n?: number | null;
};
export type Pose = Omit<Schemas["PosturesAnswer"], "in_plane" | "answer" | "drawings"> & {
  drawings: ArmDrawing[];
  answer: Omit<Schemas["PoseAnswer"], "postures"> & { postures: Posture[] };
  /** Per posture and load case; null if the arm has no stable equilibrium. */
  in_plane: (CaseValues | null)[][];
};

/** The stability of the cut at a target. */
export type Lobes = Schemas["LobesAnswer"];
export type Stability = Schemas["StabilityAnswer"];

export type ScenePoints = Omit<Schemas["PointsInScene"], "columns"> & {
  /** Columns of the table of the analysis; a path has all of these. */
  columns: {
    in_plane_um: (number | null)[];
    normal_um?: (number | null)[];
    full_um?: (number | null)[];
    along_um?: (number | null)[];
    cross_um?: (number | null)[];
    distance_mm?: (number | null)[];
    /** With a search or a curve: in addition to the constant spin. */
    turn_deg?: (number | null)[];
    /** Why a point has no posture. */
    state?: string[];
  };
};
type SceneAs<P> = Omit<Schemas["SceneAnswer"], "points" | "plate" | "sections" | "box" | "base_axes"> & {
  base_axes: Axes;
  plate: Plate;
  sections: { label: string; plate: Plate; part: BodyPose | null }[];
  points: P | null;
  box: Box | null;
};
export type Scene = SceneAs<Points>;

/** A path whose points are requested as columns. */
export type PathInView = Schemas["PathInView"];
export type PathColumn = Schemas["PathColumnInView"];
export type OperationInView = Schemas["OperationInView"];

/** The machined part of a path in the answer. */
export type MachinedPart = Schemas["MachinedPartAnswer"];
/** What is before the columns of the surface of a machined part: see `PartSurfaceHeader` of `crates/study/src/live/part_surface.rs`. */
export interface PartHeader {
  /** Points of the path that are cut. */
  points: number;
  vertices: number;
  triangles: number;
  /** Where the frame of the program is. */
  program: BodyPose;
  columns: { key: string; components: number; range_um: number | null }[];
  /** The answer of the finished part; null of a part in process. */
  part: MachinedPart | null;
}

/** What is to be shown in addition to the answer. */
export type Shown = Pick<Schemas["ViewRequest"], "arm" | "levels_um" | "lines" | "layer">;

/** All that is shown of an analysis after a change. */
export interface View {
  text: string;
  analyses: Analysis[];
  values: Values;
  scene: SceneAs<ScenePoints>;
  /** Null of another analysis. */
  path: PathInView | null;
  answer: Answer;
  extremes: Extremes[];
  /** Levels of the colour scale; null if no point has a deviation. */
  levels_um: number[] | null;
  /** One entry a map. */
  lines: MapLines[];
  /** The requested quantity; null if none was requested. */
  layer: LayerAnswer | null;
  /** The arm at the requested point; null if there is no such point. */
  arm: { at: At; case: number; pose: Pose } | null;
}

export type MaterialRow = Schemas["MaterialRow"];
export type Process = Schemas["ProcessValues"];
export type Measure = Schemas["Measure"];
export type RobotRow = Schemas["RobotRow"];
export type Picture = Schemas["PictureAnswer"];
export type Job = Schemas["JobAnswer"];
export type StoredFile = Schemas["FileRow"];
export type TakenIn = Schemas["UploadedFile"];
