//! Pieces of text that random bytes would not hit: keys, tags, words, limiting numbers.

/// The keys of a file and the names that it may give, as its JSON schema (one item a line) has them.
pub fn of_schema(schema: &str) -> Vec<String> {
    let mut words = Vec::new();
    for line in schema.lines() {
        let line = line.trim().trim_end_matches(',');
        let Some((name, rest)) = line.strip_prefix('"').and_then(|line| line.split_once('"')) else {
            continue;
        };
        match rest {
            // A property, or a table of the schema itself.
            ": {" => words.push(format!("{name} = ")),
            "" => words.push(format!("\"{name}\"")),
            _ if name == "const" => words.push(rest.trim_start_matches([':', ' ']).to_owned()),
            _ => {}
        }
    }
    words.sort();
    words.dedup();
    words
}

/// What a study file contains in addition to its keys and names: tables, values, limiting numbers.
#[rustfmt::skip]
pub const STUDY: &[&str] = &[
    "format = 1\n", "robot = \"yaskawa/mh12\"\n", "robot = \"kuka/lbr-iiwa-14-r820\"\n", "base = \"controller\"\n", "material = \"aluminium-6061-t6\"\n",
    "[compliance]\n", "[tool]\n", "[plane]\n", "[load]\n", "[posture]\n", "[positioner]\n", "[gravity]\n", "[cut]\n", "[cut.cutter]\n", "[cut.stock]\n",
    "[[analysis]]\n", "[[statement]]\n", "[analysis.program]\n", "[[analysis.program.feature]]\n", "[analysis.program.measured]\n", "[analysis.program.drill]\n",
    "cases_n = [[", "polyline_mm = [[", "{ ", " }", "true", "false", "best", "nominal", "flip", "rear", "front elbow-up",
    "nan", "inf", "1e308", "1e-320", "-0.0", "'''", "\"\"\"", "\\u0000", "0x7fffffffffffffff", "{}", "[]", "[[", "]]",
];

/// Keys and words of our robot file.
#[rustfmt::skip]
pub const ROBOT: &[&str] = &[
    "format = 1\n", "name = ", "nominal_branch = \"front elbow-up\"\n", "[chain]\n", "motions = [\n", "{ along = \"x\", length_mm = ",
    "{ about = \"z\", joint = \"", "angle_deg = ", "symbol = \"", "[[joint]]\n", "sign = -1\n", "zero_offset_deg = ",
    "zero_offset_mm = ", "limits_deg = [", "limits_mm = [", "max_speed_deg_per_s = ", "compliance_rad_per_n_m = ",
    "compliance_u_rad_per_n_m = ", "compliance_um_per_n = ", "compliance_u_um_per_n = ", "compliance_source = ", "coupling = { of = ",
    "factor = ", "[[frame]]\n", "rotation_deg = [", "origin_mm = [", "[[spring]]\n", "at = \"base\"\n", "at = \"flange\"\n",
    "compliance_matrix = ", "[[mass]]\n", "mass_kg = ", "centre_mm = [", "inertia_kg_m2 = [[", "[[motor]]\n", "rotor_inertia_kg_m2 = ", "ratio = ", "lead_mm = ", "[damping]\n", "damping_n_m_s_per_rad = ", "damping_n_s_per_m = ", "payload = true\n", "[compensator]\n", "free_length_mm = ",
    "stiffness_n_per_mm = ", "arm_radius_mm = ", "fixed_radius_mm = ", "torque_curve_n_m_rad = [[", "torque_curve_falling_n_m_rad = [[",
    "[covariance]\n", "of = [", "hysteresis = ", "[[source]]\n", "key = ", "what = ", "place = ", "licence = ", "nan", "inf", "1e308",
    "1e-320", "-0.0", "'''", "{}", "[]",
];

/// Tags and attributes of URDF.
#[rustfmt::skip]
pub const URDF: &[&str] = &[
    "<robot name=\"", "</robot>", "<link name=\"", "<joint name=\"", "</joint>", " type=\"revolute\">", "continuous", "prismatic",
    "fixed", "floating", "planar", "<parent link=\"", "<child link=\"", "<origin xyz=\"", " rpy=\"", "<axis xyz=\"", "<limit lower=\"",
    " upper=\"", " velocity=\"", " effort=\"", "<mimic joint=\"", "<inertial>", "</inertial>", "<mass value=\"", "<inertia ixx=\"", "\"/>", "tool0", "flange", "base_link", "base", "<!DOCTYPE x [",
    "<!ENTITY e \"", "&e;", "]>", "&lt;", "&#0;", "<![CDATA[", "]]>", "<!--", "-->", "<?xml version=\"1.0\"?>", "xmlns=\"", "nan",
    "inf", "1e308", "1e-320",
];

/// What xacro adds.
#[rustfmt::skip]
pub const XACRO: &[&str] = &[
    " xmlns:xacro=\"http://www.ros.org/wiki/xacro\"", "<xacro:property name=\"", " value=\"${", " default=\"", " scope=\"parent\"",
    "<xacro:arg name=\"", "<xacro:macro name=\"", " params=\"", "</xacro:macro>", "<xacro:insert_block name=\"", "<xacro:if value=\"",
    "</xacro:if>", "<xacro:unless value=\"", "<xacro:include filename=\"", "<xacro:call macro=\"", ":=", ":=^", ":=^|", "**", "$(arg ",
    "$(find ", "$(env ", "$(cwd)", "${", "}", "$${", "radians(", "degrees(", "pi", " if ", " else ", " and ", " not ", "lambda x: ",
    " for x in ", "range(", "len(", "str(", "int(", "['", "']", "<joint name=\"", "<parent link=\"", "<child link=\"", "<link name=\"",
    "<origin xyz=\"", "<axis xyz=\"", "\"/>", "&quot;", "<robot name=\"", "</robot>",
];

/// Keys of OPW parameters.
#[rustfmt::skip]
pub const OPW: &[&str] = &[
    "opw_kinematics_geometric_parameters:\n", "opw_kinematics_joint_offsets:", "opw_kinematics_joint_sign_corrections:", "deg(",
    "rad(", "  a1: ", "  a2: ", "  b: ", "  c1: ", "  c2: ", "  c3: ", "  c4: ", "  - ", "[", "]", "{", "}", "---\n", "&a ", "*a", "!!float ",
    "|\n", ">\n", "#", "\"", "'", ".inf", ".nan", "1e308",
];

/// Keys of a calibration file of Universal Robots.
#[rustfmt::skip]
pub const UR: &[&str] = &[
    "kinematics:\n", "  shoulder:\n", "  upper_arm:\n", "  forearm:\n", "  wrist_1:\n", "  wrist_2:\n", "  wrist_3:\n", "    x: ", "    y: ", "    z: ",
    "    roll: ", "    pitch: ", "    yaw: ", "  hash: calib_", "  - ", "[", "]", "{", "}", "#", "\"", "'", ".inf", ".nan", "1e308", "-1e-320",
];

/// Words of a Denavit-Hartenberg table.
#[rustfmt::skip]
pub const DH: &[&str] = &[
    "convention = standard\n", "convention = modified\n", "convention = hayati\n", "beta_deg", "name = ", "joint", "type", "sign", "a_mm", "a_m", "alpha_deg", "alpha_rad",
    "d_mm", "d_m", "theta_deg", "theta_rad", "lower_deg", "upper_deg", "lower_mm", "upper_mm", "revolute", "prismatic", "fixed", "; ",
    ", ", "\t", "\"", "#", "nan", "inf", "1e308", "-1",
];

/// Factors of a chain.
#[rustfmt::skip]
pub const CHAIN: &[&str] = &[
    "Tx(", "Ty(", "Tz(", "Rx(", "Ry(", "Rz(", "A1(", "A^2(", "A3(", "A4(", "A5(", "A^6(", "q1", "-q2", "90-q3", "phi", "H = 450\n", "A = ",
    " * ", ")", "#", "1e308", "1e-320", "−", "°",
];

/// Endings, and words that distinguish formats.
#[rustfmt::skip]
pub const FORMAT: &[&str] = &[
    "toml\n", "urdf\n", "xacro\n", "xml\n", "yaml\n", "yml\n", "dh\n", "csv\n", "chain\n", "fsf\n", "txt\n", "step\n", "<robot", "<xacro:",
    "xmlns:xacro", "convention", "alpha", "\u{feff}", "\u{fffd}", "\r", "\0",
];

/// Columns of a table of load tests.
#[rustfmt::skip]
pub const LOAD_TESTS: &[&str] = &[
    "test", "S_deg", "L_deg", "U_deg", "R_deg", "B_deg", "T_deg", "q1_rad", "fx_n", "fy_kn", "fz_n", "mx_n_m", "my_n_m", "mz_n_m",
    "dx_um", "dy_mm", "dz_m", "d_u_mm", "joint", "turn_urad", "turn_mrad", "turn_deg", "turn_u_urad", "force_x_mm", "force_z_m",
    "gauge_y_um", "gauge_z_mm", "weight", "note", "expected_dz_mm", ";", ",", "\t", "#", "\"", "1e308", "1e-320", "nan", "inf", "-0",
];

/// The parts of a reading, and limiting numbers.
#[rustfmt::skip]
pub const PENDANT: &[&str] = &["=", ",", "0,0,0,1,0,0,0", "-0.0", "1e9", "1e200", "1e308", "1e-320", "nan", "inf", "-", "+"];

/// Words of G-code.
#[rustfmt::skip]
pub const GCODE: &[&str] = &[
    "G0 ", "G1 ", "G2 ", "G3 ", "G10 L2 P1 ", "G10 L20 P2 ", "G17\n", "G18\n", "G19\n", "G20\n", "G21\n", "G28\n", "G40\n", "G41 D1\n", "G41.1 D6\n",
    "G42\n", "G43 H1\n", "G43.4\n", "G43.5\n", "G49\n", "G52 ", "G53 ", "G54\n", "G59.3\n", "G61\n", "G64 P0.1\n", "G73 ", "G81 ", "G82 ", "G83 ", "G89 ",
    "G80\n", "G90\n", "G91\n", "G90.1\n", "G91.1\n", "G92 ", "G92.1\n", "G93\n", "G94\n", "G95\n", "G98\n", "G99\n", "M3 S1000\n", "M5\n", "M6 T1\n",
    "M98 P100 L2\n", "M99\n", "M128\n", "M429\n", "TRAORI\n", "o1 sub\n", "o1 endsub\n", "o1 call [1]\n", "o1 while [1]\n", "o1 endwhile\n", "o1 do\n",
    "o1 repeat [3]\n", "o1 endrepeat\n", "o1 if [1]\n", "o1 elseif [0]\n", "o1 else\n", "o1 endif\n", "o1 break\n", "o1 return\n", "#1=2\n", "#<_x>=3\n",
    "[1 MOD 0]", "[2 ** 3]", "ATAN[1]/[0]", "SQRT[-1]", "EXISTS[#<x>]", "FUP[", "I1 J2 K3 ", "R5 ", "P2 ", "Q1 ", "L3 ", "A10 B20 C30 ", "F100\n", "%\n", "(MSG, x)",
    "1e308", "99999999999999999999", ";", "/",
];

/// Words of a tool table.
#[rustfmt::skip]
pub const TOOL_TABLE: &[&str] = &[
    "T1 ", "P1 ", "X1", "Y1", "Z0.5", "A1", "B1", "C1", "U1", "V1", "W1", "D0.25", "I1", "J1", "Q9", ";", "\n", "T4294967295", "nan", "inf", "1e308", "1e999", "-0",
];

/// Words of cutter locations.
#[rustfmt::skip]
pub const APT: &[&str] = &[
    "GOTO/", "FROM/", "GOHOME/", "CIRCLE/", "RAPID\n", "FEDRAT/", "MMPM", "IPM", "MMPR", "SPINDL/", "RPM", "CLW", "LOAD/TOOL,", "CUTTER/", "TLDATA/MILL,", "UNIT/MM\n",
    "UNITS/INCH\n", "CSYS/", "MSYS/", "TRNTYP/WORLD\n", "TOOL PATH/", "END-OF-PATH\n", "CYCLE/DRILL,", "CYCLE/DEEP,", "CYCLE/OFF\n", "RAPTO,", "FEDTO,", "TIMES,",
    "PARTNO/", "INSERT/", "CUTCOM/", "COOLNT/", "FINI\n", "$\n", "$$", "1e308", "NURBS/", "GODLTA/",
];

/// Words of the languages of robots.
#[rustfmt::skip]
pub const ROBOT_PROGRAM: &[&str] = &[
    "PTP {", "LIN {X ", "CIRC ", "SLIN ", "LIN_REL {", "XP1", "DECL E6POS XP1={", "{A1 ", ",S 2,T 35", "C_DIS", "$BASE=", "$TOOL={", "BASE_DATA[1]", "BAS(#BASE,",
    "FDAT_ACT=", "$VEL.CP=", " WITH ", "#TOOL", "DEFDAT A\n", "DEF A()\n", "END\n", "'B010'", "movel(p[", "movej([", "movec(", "pose_trans(", "get_inverse_kin(", "set_tcp(",
    "d2r(", "def a():\n", "MoveL ", "MoveJ ", "MoveC ", "MoveAbsJ ", "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]", "CONST robtarget p1:=", "Offs(p1,", "RelTool(p1,",
    "\\\\WObj:=", ":=", ".trans", "tool0", "v100", "MODULE M\n", "PROC a()\n", "ENDPROC\n", "/JOB\n", "//NAME A\n", "//POS\n", "///NPOS 1,0,0,0,0,0\n", "///USER 1\n",
    "///TOOL 1\n", "///POSTYPE BASE\n", "///RECTAN\n", "///RCONF 0,0,0,0,0,0\n", "C00000=", "//INST\n", "NOP\n", "MOVL C00000 V=100.0\n", "MOVC ", "MOVJ ", "/PROG A\n",
    "/MN\n", "/POS\n", "P[1]{\n", "L P[1] 100mm/sec FINE ;\n", "CONFIG : 'N U T, 0, 0, 0',", "PR[9,1]=", "UFRAME[9]=PR[9] ;\n", "<Program ", "<Data ", "pointRx", "jointRx",
];

/// Columns of a path.
#[rustfmt::skip]
pub const PATH_CSV: &[&str] = &[
    "x_mm", "y_mm", "z_mm", "x_in", "i,j,k", "feed_mm_per_min", "feed_mm_per_s", "rapid", "spindle_rpm", "axial_depth_mm", "radial_depth_mm", "op", "note", ";", "\t", "yes",
    "true", "nan", "1e308",
];

/// Words of force records.
#[rustfmt::skip]
pub const FORCES: &[&str] = &[
    "Time", "Fx", "Fy", "Fz", "Mx", "time_s", "time_ms", "fx_n", "fy_kn", "mz_n_m", "s,N,N,N", "Sampling rate [Hz]:", "Cycle No:", "Samples per channel:", "\t", ";", "0,000",
    "nan", "1e308", "-",
];

/// Words of round profiles.
#[rustfmt::skip]
pub const PROFILE: &[&str] = &[
    "x_mm", "y_um", "z_m", "x_in", "angle_deg", "theta_rad", "radius_mm", "r_mm", "deviation_um", "radius_dev_um", "\t", ";", "0,000", "# ", "\n3\n", "nan", "inf", "1e308", "1e-300",
    "<QIFDocument>", "</QIFDocument>", "<CircleFeatureActual>", "<CylinderFeatureActual>", "<Axis>", "<AxisPoint>", "<Location>", "<Diameter>", "<Factor>", "<FeatureName>",
];

/// Words of points of a part.
#[rustfmt::skip]
pub const SCAN: &[&str] = &[
    "x_mm", "Y [um]", "z (in)", "nx", "i", "nom_x", "nominal_y_mm", "dev_um", "name", "// ", "% ", "! ", "\t", ";", "0,000", "\n3\n", "nan", "inf", "1e308",
    "<QIFDocument>", "</QIFDocument>", "<PointFeatureActual>", "<Location>", "<Normal>", "<FeatureItemId>", "<FeatureNominalId>", "<Factor>",
    "ply\n", "format ascii 1.0\n", "format binary_little_endian 1.0\n", "element vertex 3\n", "property float x\n", "property double nx\n", "end_header\n",
    "UNITS/MM,ANGDEC", "UNITS/INCH", "FA(P1)=FEAT/POINT,CART,", "F(P1)=FEAT/POINT,CART,", "PTMEAS/CART,", "PTDATA/CART,", "FEAT/CIRCLE,INNER,CART,", "$\n", "$$",
];

/// Columns and remarks of circular tests, elements of a ball-bar's results.
#[rustfmt::skip]
pub const BALLBAR: &[&str] = &[
    "angle_deg", "angle_rad", "index", "radius_dev_um", "radius_mm", "direction", "run", "# radius_mm: ", "# start_deg: ", "# run: ", "# direction: ", "CW", "CCW", ";", "\t",
    "<FEATURE NAME='AF_CIRCULARITY' DT='UT_LENGTH_UM'>", "</FEATURE>", "<PLANE TEST_PLANE='XY'/>", "<READINGS>", "</READINGS>",
    "<RUN_DIRECTION>CW</RUN_DIRECTION>", "nan", "1e308",
];

/// Names of columns of measured poses.
#[rustfmt::skip]
pub const POSES: &[&str] = &[
    "q1_deg", "j2_rad", "S_deg", "x_mm", "y_um", "z_in", "rx_deg", "ry_rad", "commanded_x_m", "commanded_rz_deg", "pose", "direction", "measurement_x",
    "shoulder_pan_joint", "Goal roll", ";", "\t", "2,02E+13", "nan", "1e308",
];

/// Names of columns of points along a path.
#[rustfmt::skip]
pub const TRACE: &[&str] = &["run", "x_mm", "y_um", "z_in", "x_m", ";", "\t", "# ", "\n0,0,0\n", "nan", "1e308", "1e-300"];

/// Names of a joint log.
#[rustfmt::skip]
pub const JOINT_LOG: &[&str] = &["time_s", "timestamp", "IPOC", "J1_deg", "J2", "A1", "actual_q_0", "target_q_1", "AIPos.A1", "ASPos.A2", "fb_j1", "planned_j2", "link_j1_deg", "torque_j1_nm", "cmd_num", "[rad]", ";", "\t", " ", "nan", "1e308"];

/// Tags of a MATLAB file, signatures and messages of HDF5, and names of its arrays.
#[rustfmt::skip]
pub const MATLAB: &[&str] = &["MATLAB 5.0", "rec", "a", "\u{e}\0\0\0", "\u{f}\0\0\0", "\u{9}\0\0\0", "\u{5}\0\u{4}\0", "\u{6}\0\0\0\u{8}\0\0\0", "\u{2}\0\u{3}\0", "TREE", "SNOD", "HEAP", "GCOL", "MATLAB_class", "MATLAB_empty", "MATLAB_sparse"];

/// Keys of the journal of an arm.
#[rustfmt::skip]
pub const JOURNAL: &[&str] = &[
    "format = 1\n", "robot = \"a\"\n", "tool_mm = [0, 0, 1]\n", "[prior]\n", "length_mm = ", "angle_deg = ", "factor = ", "[[measurement]]\n", "date = \"2026-02-29\"\n", "temperature_c = ",
    "kind = \"part\"\n", "kind = \"tracker\"\n", "kind = \"load-tests\"\n", "kind = \"ball-bar\"\n", "calibrated = true\n", "file = \"a.csv\"\n", "u_um = ", "sha256 = \"", "point_mm = [0, 0, 1]\n", "note = \"\"\n", "nan", "inf", "1e308",
];

/// Names of columns of conditions.
#[rustfmt::skip]
pub const CONDITIONS: &[&str] = &["q1_deg", "S_deg", "q2_rad", "fx_n", "fy_kn", "fz_n", "mx_n_m", "radius_mm", "q1_direction", "S_direction", "-1", ";", "\t", "nan", "1e308"];

/// Names of columns of bodies.
#[rustfmt::skip]
pub const BODIES: &[&str] = &["x_mm", "Y [um]", "z_in", "q0", "q1", "q2", "q3", "qw", "qx", "m_00", "m_23", "m_33", "theta_1", "q1_deg", "S_deg", "\u{fffd}", ";", "\t", "nan", "1e308"];

/// Pieces of tables of numbers, and names in a workbook.
#[rustfmt::skip]
pub const NUMBERS: &[&str] = &[";", "\t", ",", " ", "# ", "1,5", "-3e0", "nan", "inf", "1e308", "PK\u{1}\u{2}", "PK\u{3}\u{4}", "PK\u{5}\u{6}", "xl/workbook.xml", "xl/sharedStrings.xml", "xl/styles.xml"];

/// Elements and attributes of a sheet of a workbook.
#[rustfmt::skip]
pub const SHEET: &[&str] = &[
    "<worksheet>", "<dimension ref=\"A1:XFD1048576\"/>", "<sheetData>", "</sheetData>", "<row r=\"1048576\">", "</row>", "<c r=\"XFD1\">", "<c r=\"A1048576\" t=\"s\">", "<c t=\"inlineStr\">", "<is><t>",
    "</t></is>", "<v>1</v>", "</c>", " t=\"str\"", " t=\"b\"", " t=\"d\"", " t=\"e\"", " s=\"1\"", "<f>A1</f>", "1e308", "nan", "4294967295", "AAAAAAAA1",
];

/// Columns of a table of FRFs, and lines of a universal file.
#[rustfmt::skip]
pub const FRF: &[&str] = &[
    "frequency_hz", "receptance_real_um_per_n", "receptance_imag_m_per_n", "mobility_magnitude_mm_per_s_per_n", "accelerance_real_g_per_n", "phase_deg", "phase_rad", "coherence", "response",
    "reference", "1X", "12-Y", ";", "\t", "nan", "1e308", "    -1\n", "    58\n", "   164\n", "    58b", "NONE", "         5         4         1", "m/s^2", "mm/s", "D+00",
];

/// Keys of a material file.
#[rustfmt::skip]
pub const MATERIAL: &[&str] = &[
    "[[mechanistic]]\n", "[[kienzle]]\n", "tool = ", "source = ", "ktc_n_per_mm2 = ", "krc_n_per_mm2 = ", "kac_n_per_mm2 = ", "kte_n_per_mm = ", "kre_n_per_mm = ",
    "kae_n_per_mm = ", "kc1_n_per_mm2 = ", "mc_exponent = ", "group = ", "condition = ", "note = ", "[sources.x]\n", "nan", "inf", "1e308",
];

/// Keys of a file of modal data.
#[rustfmt::skip]
pub const MODAL: &[&str] = &[
    "[[mode]]\n", "name = ", "source = ", "note = ", "frequency_hz = ", "frequency_u_hz = ", "damping_percent = ", "damping_u_percent = ", "damping_ratio = ", "direction = [0, 1, 0]\n",
    "modal_mass_kg = ", "stiffness_n_per_um = ", "stiffness_u_percent = ", "nan", "inf", "1e308",
];

/// Keys of a file of a tool assembly.
#[rustfmt::skip]
pub const TOOL_ASSEMBLY: &[&str] = &[
    "[[segment]]\n", "[segment.joint]\n", "[spindle]\n", "beam = ", "length_mm = ", "diameter_mm = ", "bore_mm = ", "fluted = true\n", "equivalent_diameter_mm = ", "material = \"carbide\"\n",
    "modulus_gpa = ", "density_kg_per_m3 = ", "poisson_ratio = ", "loss_factor = ", "lateral_n_per_um = ", "bending_n_m_per_rad = ", "torsion_damping_n_m_s_per_rad = ", "nan", "inf", "1e308",
];

/// Words of every format of tool paths, and words that distinguish them.
#[rustfmt::skip]
pub const PROGRAM: &[&str] = &[
    "G0 ", "G1 X", "G2 I", "G21\n", "M2\n", "%\n", "N10 ", "(", ")", "#1=", "o1 sub\n", "GOTO/", "UNITS/MM\n", "PARTNO/", "TOOL PATH/", "FINI\n", "$$", "x_mm,y_mm,z_mm\n", "x_m;y_m;z_m\n",
    "&ACCESS", "MODULE ", "/PROG", "/JOB", "movel(", "\r", "\0", "\u{feff}", "# ", "; ",
];

/// Words of STL.
#[rustfmt::skip]
pub const MESH_STL: &[&str] = &[
    "solid ", "facet normal 0 0 1\n", "outer loop\n", "vertex 0 0 0\n", "vertex 1e9 nan inf\n", "endloop\n", "endfacet\n", "endsolid", "color", "stlbn", "\u{feff}", "1e308",
];

/// Statements of OBJ.
#[rustfmt::skip]
pub const MESH_OBJ: &[&str] = &[
    "v 0 0 1\n", "v 1 2 3 1\n", "f 1 2 3\n", "f -1 -2 -3 -4\n", "f 1/1 2/2 3/3 4/4 5/5\n", "f 1//1 2//2 3//3\n", "vt 0 0\n", "vn 0 0 1\n", "g a\n", "\\\n", "#", "surf", "curv", "cstype",
    "9223372036854775807", "-9223372036854775808", "1e308", "nan",
];

/// Words of the header of PLY.
#[rustfmt::skip]
pub const MESH_PLY: &[&str] = &[
    "ply\n", "format ascii 1.0\n", "format binary_little_endian 1.0\n", "format binary_big_endian 1.0\n", "comment ", "obj_info ", "element vertex 3\n", "element face 1\n",
    "element tristrips 1\n", "element a 18446744073709551615\n", "property float x\n", "property double y\n", "property int z\n", "property uchar red\n",
    "property list uchar int vertex_indices\n", "property list uint32 int8 vertex_index\n", "end_header\n", "nan", "1e308",
];

/// Elements and attributes of 3MF.
#[rustfmt::skip]
pub const MESH_3MF: &[&str] = &[
    "<model ", "unit=\"micron\"", "requiredextensions=\"p\"", "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"", "<object id=\"1\" type=\"support\">",
    "<mesh>", "<vertices>", "<vertex x=\"0\" y=\"1\" z=\"2\"/>", "<triangles>", "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>", "<components>", "<component objectid=\"1\"/>", "<build>",
    "<item objectid=\"1\"/>", "transform=\"1 0 0 0 1 0 0 0 1 0 0 0\"", "p:path=\"/3D/3dmodel.model\"", "</object>", "<!DOCTYPE", "<!ENTITY", "&amp;", "<![CDATA[", "PK\u{1}\u{2}", "PK\u{5}\u{6}",
];

/// Elements and attributes of COLLADA.
#[rustfmt::skip]
pub const MESH_DAE: &[&str] = &[
    "<unit meter=\"0.001\"/>", "<up_axis>Y_UP</up_axis>", "<geometry id=\"a\">", "<mesh>", "<source id=\"b\">", "<float_array>", "<accessor stride=\"3\" count=\"1\" offset=\"1\"/>",
    "<vertices id=\"c\">", "<input semantic=\"POSITION\" source=\"#b\"/>", "<input semantic=\"VERTEX\" source=\"#c\" offset=\"0\"/>", "<triangles>", "<polylist>", "<vcount>", "<polygons>", "<ph>",
    "<tristrips>", "<trifans>", "<p>0 1 2</p>", "<node id=\"d\">", "<matrix>", "<translate>", "<rotate>", "<scale>", "<skew>", "<lookat>", "<instance_geometry url=\"#a\"/>", "<instance_node url=\"#d\"/>",
    "<instance_controller/>", "<visual_scene id=\"e\">", "<instance_visual_scene url=\"#e\"/>", "1e308", "nan", "18446744073709551615",
];
