// What the server answers, as far as the page reads it.

export type Vec3 = [number, number, number];

export interface Problem {
  file: string | null;
  line: number | null;
  column: number | null;
  span?: unknown;
  message: string;
  hint: string | null;
}

export interface Ask {
  name: string;
  kind: "map" | "sections" | "volume" | "path" | "holes";
  keys?: string[];
}

export interface Study {
  file: string;
  folder: string;
  writable: boolean;
  version: string;
  text: string;
  title: string | null;
  robot: string | null;
  asks: Ask[];
  problems: Problem[];
  armill: string;
}

export interface Checked {
  problems: Problem[];
  title: string | null;
  robot: string | null;
  asks: Ask[];
}

export interface Changed {
  text: string;
  problems: Problem[];
  asks: Ask[];
}

export interface Point {
  xyz_mm: Vec3;
  in_plane_mm: [number, number];
  branch: string | null;
  joints_deg: number[];
  within_limits: boolean;
  singularity: string | null;
  deciding_case: number;
  in_plane_um: number;
  in_plane_u_um: number;
  normal_um: number;
  full_um: number;
  joint_share_um: number[];
  permissible_along_load_n: number | null;
  permissible_any_direction_n: number;
}

export interface Setting {
  base: string;
  centre_mm: Vec3;
  tilt_deg: number | null;
  normal_axis: Vec3;
  tool_length_mm: number;
  load_frame: string;
  cases_n: Vec3[];
  limit_um: number;
  load_source: string | null;
  model: string[];
  shares_of: string[];
}

export interface MapGrid {
  points: number;
  y_mm: number[];
  z_mm: number[];
  in_plane_um: (number | null)[];
  in_plane_u_um: (number | null)[];
  probability_within: (number | null)[];
  normal_um: (number | null)[];
  full_um: (number | null)[];
  remarks: { reason: string; points: number[] }[];
}

export interface MapAnswer {
  name: string;
  branch: string;
  fraction_within: number;
  fraction_within_and_inside_joint_limits: number;
  max_in_plane_um: number | null;
  min_in_plane_um: number | null;
  counts: Record<string, number>;
  outside_joint_limits: number;
  near_singularity: number;
  worst: Point | null;
  best: Point | null;
  region: { area_mm2: number; boundary_mm: [number, number][][]; rectangle_mm: [[number, number], [number, number]] | null };
  certainty: { fraction_surely_within: number; fraction_possibly_within: number; boundary_surely_mm: [number, number][][]; boundary_possibly_mm: [number, number][][] } | null;
  setting: Setting;
  grid: MapGrid;
}

export interface PathAnswer {
  name: string;
  branch: string;
  followed_branch: string | null;
  points: number;
  unreached: number;
  outside_joint_limits: number;
  length_mm: number;
  max_in_plane_um: number | null;
  min_in_plane_um: number | null;
  fraction_within: number;
  roundness_um: number | null;
  worst: Point | null;
  worst_points: { line: number; distance_mm: number; cause: string; point: Point }[];
  setting: Setting;
  notes: string[];
}

export interface VolumeAnswer {
  name: string;
  branch: string;
  fraction_within: number;
  volume_within_mm3: number;
  counts: Record<string, number>;
  point_counts: Vec3;
  step_mm: number;
  origin_mm: Vec3;
  best: Point | null;
  worst: Point | null;
  setting: Setting;
}

export interface HolesAnswer {
  name: string;
  branch: string;
  holes: number;
  unreached: number;
  fraction_within: number;
  max_in_plane_um: number | null;
  worst_holes: { hole: number; point: Point }[];
  setting?: Setting;
}

export interface Source {
  key: string;
  what: string;
  where: string;
  licence: string;
}

export interface Answer {
  title: string;
  answer: string;
  robot: { name: string; title: string; compliance_assumed: boolean };
  maps: MapAnswer[];
  paths: PathAnswer[];
  volumes: VolumeAnswer[];
  holes: HolesAnswer[];
  warnings: string[];
  sources: Source[];
}

export interface Values {
  robot: string;
  kind: Ask["kind"];
  base: string;
  centre_mm: Vec3 | null;
  tilt_deg: number | null;
  half_size_mm: number | [number, number] | null;
  step_mm: number | null;
  flange_from_tool_mm_deg: number[] | null;
  tool_length_mm: number | null;
  cases_n: Vec3[] | null;
  limit_um: number | null;
  branch: string | null;
  spin_deg: number | null;
  /** The branch that "nominal" and such mean. */
  branch_meant: string;
  branches: string[];
}

export interface Posture {
  branch: string | null;
  joints_deg: number[];
  within_limits: boolean;
  limit_margin_deg: number | null;
  limit_joint: string | null;
  tool: { xyz_mm: Vec3; quaternion_wxyz: [number, number, number, number] };
  singularity: string | null;
  condition_number: number | null;
  compliance: number[][];
  stiffness: { principal_um_per_n: number[]; principal_direction: number[][]; permissible_n_per_um: number } | null;
  deviation_um: Vec3 | null;
  rotation_urad: Vec3 | null;
  joint_share_um: Vec3[] | null;
  deviation_u_um: Vec3 | null;
}

export interface PoseAnswer {
  robot: string;
  base: string;
  joint_names: string[];
  joint_units: string[];
  compliance_assumed: boolean;
  shares_of: string[];
  postures: Posture[];
}

export interface ArmDrawing {
  joints: { name: string; origin_mm: Vec3; axis: Vec3; kind: "turns" | "slides" }[];
  flange_mm: Vec3;
  tool_mm: Vec3;
  tool_axis: Vec3;
  links_mm: Vec3[];
}

export interface JointLimit {
  name: string;
  lower_deg: number | null;
  upper_deg: number | null;
  unit: string;
}

export interface CaseValues {
  in_plane_um: number;
  normal_um: number;
  full_um: number;
  in_plane_u_um?: number | null;
  /** One of each of `shares_of`; they add up to `in_plane_um`. */
  share_um?: number[] | null;
  permissible_along_load_n?: number | null;
  permissible_any_direction_n?: number | null;
}

export interface Pose {
  answer: PoseAnswer;
  drawings: ArmDrawing[];
  limits: JointLimit[];
  /** Of each posture, of each case; null where the arm finds no rest. */
  in_plane: (CaseValues | null)[][];
}

export type At = { y_mm: number; z_mm: number; section?: number } | { xyz_mm: Vec3 } | { joints_deg: number[] } | { point: number };

export interface Plate {
  corners_mm: Vec3[];
  normal_axis: Vec3;
  y_axis: Vec3;
  z_axis: Vec3;
  centre_mm: Vec3;
}

export interface ScenePoints {
  xyz_mm: Vec3[];
  /** Under the deciding case, base. */
  deviation_um: (Vec3 | null)[];
  columns: {
    in_plane_um: (number | null)[];
    normal_um?: (number | null)[];
    full_um?: (number | null)[];
    along_um?: (number | null)[];
    cross_um?: (number | null)[];
    axial_um?: (number | null)[];
    distance_mm?: (number | null)[];
    branch?: (string | null)[];
    state?: (string | null)[];
  };
}

/** Everything in base. */
export interface Scene {
  robot: string;
  /** Where the frame stands that coordinates count from. */
  base_mm: Vec3;
  plate: Plate;
  sections: { label: string; plate: Plate }[];
  points: ScenePoints | null;
  /** Its points come in `points`. */
  box: { corner_mm: Vec3; sides_mm: [Vec3, Vec3, Vec3]; counts: Vec3 } | null;
}

export interface RobotRow {
  name: string;
  title: string;
  payload_kg: number | null;
  reach_mm: number | null;
  compliance: boolean;
}

export interface Picture {
  name: string;
  title: string;
  svg: string;
}

export interface Job {
  id: string;
  kind: string;
  title: string;
  state: "waiting" | "running" | "done" | "failed" | "cancelled";
  done: number;
  of: number | null;
  best: string | null;
  started_s_ago: number;
  seconds: number;
  error: { message: string; problems: Problem[] } | null;
  answer?: unknown;
  files: string[];
}

export interface StoredFile {
  name: string;
  bytes: number;
  modified_s_ago: number;
}
