//! Good inputs to begin with: our own robots and studies, and small texts that use every part of a format; those of
//! robots are files in `crates/formats/tests/seeds/`, which the tests change at random too.

use armill_study::library::{MATERIALS, ROBOTS, example_studies};

/// Four arms in URDF: two of makers, one with every oddity, one of a single joint.
pub fn urdf() -> Vec<Vec<u8>> {
    seeds(&[
        include_str!("../../validation/urdf-forward/mh12.urdf"),
        include_str!("../../validation/urdf-forward/kr120r2500pro.urdf"),
        include_str!("../../validation/urdf-forward/oblique.urdf"),
        "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='continuous'>\
         <parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint></robot>",
    ])
}

/// The robot library.
pub fn robots() -> Vec<Vec<u8>> {
    ROBOTS.iter().map(|robot| robot.text.into()).collect()
}

/// The example studies, those of the validation, and two that use every table.
pub fn studies() -> Vec<Vec<u8>> {
    let mut all = seeds(&[
        include_str!("../../validation/mh12-fractions/study.toml"),
        include_str!("../../validation/mh12-readings/study.toml"),
        EVERY_TABLE,
        EVERY_PROGRAM,
    ]);
    all.extend(example_studies().map(|study| study.text.into()));
    all
}

/// Values that are changed, made, taken away and refused, in texts with comments, tables on a line and lists of tables.
pub fn edits() -> Vec<Vec<u8>> {
    const TEXT: &str = "# mine\ntolerance_um = 100 # of the drawing\n[plane]\ncentre_mm = [1000, 0, 500] # mm\n\n[[analysis]]\nkind = \"map\"\n\n\
                        [[analysis]]\nkind = \"path\"\nplane = { tilt_deg = 90 }\n";
    let changes = [
        ("plane.centre_mm", "[900, 0.5, 500]"),
        ("plane.centre_mm[2]", "600"),
        ("analysis[1].plane.tilt_deg", "null"),
        ("analysis[0].load.cases_n", "[[1, 2, 3]]"),
        ("place.\"x y\"", "{\"a\": [true, \"b\"]}"),
        ("analysis", "null"),
        ("analysis[7].tolerance_um", "1e300"),
        ("analysis[2]", "{\"kind\": \"map\"}"),
        ("analysis[0]", "null"),
        ("ballbar[0]", "{\"files\": []}"),
        ("analysis[1].tool.spring[0]", "{\"at\": \"tool\"}"),
        ("plane.centre_mm[1]", "null"),
        ("", "plain"),
    ];
    let one = |(path, value)| format!("{path}\n{value}\n{TEXT}").into_bytes();
    changes.into_iter().map(one).collect()
}

/// Meshes of every kind of name, with and without origin and scale, on a chain and off it.
pub fn meshes() -> Vec<Vec<u8>> {
    seeds(&[
        "<robot name='r'><link name='a'><visual><origin xyz='0 0 1' rpy='0 1 0'/><geometry><mesh filename='package://p/a.stl' \
         scale='0.001 0.001 0.001'/></geometry></visual><collision><geometry><mesh filename='a.stl'/></geometry></collision></link>\
         <link name='b'><visual><geometry><box size='1 1 1'/></geometry></visual></link><joint name='j' type='continuous'>\
         <parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint><link name='c'><visual><geometry>\
         <mesh filename='file:///c.dae'/></geometry></visual></link><joint name='k' type='prismatic'><parent link='b'/>\
         <child link='c'/><axis xyz='0.6 0 0.8'/></joint></robot>",
    ])
}

/// A cube as text, a tetrahedron as bytes.
pub fn mesh_stl() -> Vec<Vec<u8>> {
    vec![
        include_bytes!("../../crates/formats/tests/seeds/cube.ascii.stl").to_vec(),
        include_bytes!("../../crates/formats/tests/seeds/tetrahedron.stl").to_vec(),
    ]
}

/// A cube with every kind of index.
pub fn mesh_obj() -> Vec<Vec<u8>> {
    seeds(&[
        include_str!("../../crates/formats/tests/seeds/cube.obj"),
        "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf 2 3 4 1\n",
    ])
}

/// A cube as text, and as bytes in big-endian order with its faces first.
pub fn mesh_ply() -> Vec<Vec<u8>> {
    vec![
        include_bytes!("../../crates/formats/tests/seeds/cube.ascii.ply").to_vec(),
        include_bytes!("../../crates/formats/tests/seeds/cube.big.ply").to_vec(),
    ]
}

/// Two cubes, one of them by a component.
pub fn mesh_3mf() -> Vec<Vec<u8>> {
    vec![include_bytes!("../../crates/formats/tests/seeds/cubes.3mf").to_vec()]
}

/// A model with components and a path.
pub fn mesh_3mf_model() -> Vec<Vec<u8>> {
    seeds(&[
        "<?xml version=\"1.0\"?>\n<model unit=\"inch\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
         xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" requiredextensions=\"p\"><resources>\
         <object id=\"1\" type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>\
         <vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object>\
         <object id=\"2\"><components><component objectid=\"1\" p:path=\"/3D/3dmodel.model\" \
         transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/></components></object></resources><build><item objectid=\"2\"/></build></model>",
    ])
}

/// Two cubes with every kind of polygon and of node.
pub fn mesh_dae() -> Vec<Vec<u8>> {
    seeds(&[include_str!("../../crates/formats/tests/seeds/cubes.dae")])
}

/// Properties, arguments, conditions, blocks, nested macros.
pub fn xacro() -> Vec<Vec<u8>> {
    [macros(), urdf()].concat()
}

fn macros() -> Vec<Vec<u8>> {
    seeds(&[
        include_str!("../../crates/formats/tests/seeds/arm.xacro"),
        include_str!("../../crates/formats/tests/seeds/macro.xacro"),
    ])
}

/// Parameters with lists in one line and over several.
pub fn opw() -> Vec<Vec<u8>> {
    seeds(&[
        include_str!("../../crates/formats/tests/seeds/arm.opw.yaml"),
        include_str!("../../crates/formats/tests/seeds/lists.opw.yaml"),
    ])
}

/// A calibration file of Universal Robots.
pub fn ur() -> Vec<Vec<u8>> {
    seeds(&[include_str!("../../crates/formats/tests/seeds/arm.ur.yaml")])
}

/// Both conventions, every separator, sliding and fixed rows.
pub fn dh() -> Vec<Vec<u8>> {
    seeds(&[
        include_str!("../../crates/formats/tests/seeds/standard.dh"),
        include_str!("../../crates/formats/tests/seeds/arm.dh"),
        include_str!("../../crates/formats/tests/seeds/blanks.dh"),
    ])
}

/// Both ways to write factors, symbols, offsets.
pub fn chain() -> Vec<Vec<u8>> {
    seeds(&[
        include_str!("../../crates/formats/tests/seeds/arm.chain"),
        include_str!("../../crates/formats/tests/seeds/lines.chain"),
    ])
}

/// A file of every format, its ending on a line before it.
pub fn named() -> Vec<Vec<u8>> {
    let mut all = Vec::new();
    for (endings, files) in [
        (&["toml"][..], robots()),
        (&["urdf", "xml"], urdf()),
        (&["xacro", "xml", "urdf"], macros()),
        (&["yaml", "yml"], opw()),
        (&["dh", "csv", "txt"], dh()),
        (&["chain", "fsf", "txt"], chain()),
        (&["step", ""], chain()),
    ] {
        for ending in endings {
            let of_ending = |file: &Vec<u8>| [ending.as_bytes(), b"\n", file.as_slice()].concat();
            all.extend(files.iter().map(of_ending));
        }
    }
    all
}

/// Displacements, turns, every kind of column; decimal commas; rows without reading. The joints are those of the
/// Yaskawa MH12.
pub fn load_tests() -> Vec<Vec<u8>> {
    seeds(&[
        "test,S_deg,L_deg,U_deg,R_deg,B_deg,T_deg,fz_n,dz_mm,d_u_mm,note\nfirst,0,10,20,0,30,0,-98.1,-0.25,0.01,x\n\
         ,30,-20,0,10,-45,5,-98.1,-0.3,0.01,\n",
        "\u{feff}# mine\r\nq1_rad;q2_rad;q3_rad;q4_rad;q5_rad;q6_rad;fx_kn;mx_n_m;dx_um;dy_m;gauge_z_mm;force_x_mm;\
         weight\r\n0,1;0;0,2;0;0,3;0;0,1;3;120;;80;10;2\r\n;;;;;;;;;;;;\r\n",
        "S_deg\tL_deg\tU_deg\tR_deg\tB_deg\tT_deg\tfz_n\tjoint\tturn_urad\tturn_u_urad\texpected_dz_mm\n\
         0\t0\t0\t0\t10\t0\t-500\tL\t250\t5\t1\n",
    ])
}

/// A reading of each length.
pub fn pendant() -> Vec<Vec<u8>> {
    seeds(&[
        "0,-90,90,0,0,0 = 1200,0,900,0,90,0",
        "10,20,30,40,50,60=900,-0.5,1e3,0.7071,0,0.7071,0",
        "0=1,2,3,-3.03,0.81,0",
    ])
}

/// Lines, arcs, cycles, subroutines, expressions, offsets, five axes.
pub fn gcode() -> Vec<Vec<u8>> {
    seeds(&[
        "%\nG21 G90 G94 G17\nT1 M6 S6000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG2 X10 Y0 I5 J0\nG3 X0 R5 Z-2\nG81 X5 Y5 Z-3 R1\nX8\nG80\nM2\n%\n",
        "o100 sub\nG91 G1 X#1 F[#2 * 2]\no100 endsub\nG20 G90\n#<n>=3\no1 while [#<n> GT 0]\no100 call [1.5] [10]\n#<n>=[#<n>-1]\no1 endwhile\n\
         o2 if [EXISTS[#<n>]]\nG1 X[SIN[30]+ATAN[1]/[2]] F10\no2 endif\nG10 L2 P1 X1 Y2 R30\nG54 G92 X0\nG53 G0 Z0\nM30\n",
        "G21 G43.4 H1\nG0 X0 Y0 Z50 A0 C0\nG93 G1 X1 Y2 Z3 A-30 C45 F60\nG43.5 X1 I0 J0.1 K0.99 F30\nG49\nM2\n",
        "G21 G41.1 D6\nG0 X-5 Y-5\nG1 X0 Y0 F100\nG1 Y20\nG2 X10 Y30 I10 J0\nG1 X30\nG40 X40 Y40\nM2\n",
    ])
}

/// Every word; remarks.
pub fn tool_tables() -> Vec<Vec<u8>> {
    seeds(&[
        "T1 P1 X0 Y0 Z0.5 A1 B2 C3 U4 V5 W6 D0.25 I10 J20 Q0 ;first\n\n; none\nt32 p2 x-1 q2\n",
        "T1 Z+0.511 D0.125\r\nT2 Z0.1 D-0.0625\r\n",
    ])
}

/// Both dialects, cycles, arcs, planes.
pub fn apt() -> Vec<Vec<u8>> {
    seeds(&[
        "PARTNO/PLATE\nUNIT/MM\nTRNTYP/WORLD\nCSYS/1,0,0,0,0,1,0,0,0,0,1,0\nLOAD/TOOL,1\nCUTTER/6,0.5\nSPINDL/5000,RPM,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/300,MMPM\n\
         GOTO/0,0,-1\nCIRCLE/5,0,-1,0,0,1\nGOTO/10,0,-1\nCYCLE/DRILL,RAPTO,2,FEDTO,-5,MMPM,100\nGOTO/20,0,0\nCYCLE/OFF\nFINI\n",
        "TOOL PATH/MILL_1,TOOL,T1\nTLDATA/MILL,10.0,1.0,50.0\nMSYS/0,0,0,1,0,0,0,1,0\nFEDRAT/MMPM,250.0\nGOTO/1,2,3,0,0,1\nGOTO/4,5,6\n\
         CIRCLE/4,0,6,0,0,-1,5.0,0.06,0.5,10.0,1.0\nGOTO/9,0,6\nEND-OF-PATH\n",
    ])
}

/// A program of each language, files parted by a zero byte: points by name, by numbers, in frames, arcs.
pub fn robot_programs() -> Vec<Vec<u8>> {
    seeds(&[
        "DEF A()\n$BASE={FRAME: X 1,Y 2.5,Z 3,A 4,B 5,C 6}\nBAS(#TOOL,2)\nPTP XP1 C_PTP\nLIN {X 20.125 ,B -.5E1}\nLIN_REL {Z 10} #TOOL\nCIRC {X 1},{Y 2}\nLIN \
         XP1:{X 1,Y 2,Z 3,A 0,B 0,C 0} C_DIS\nPTP {A1 1,A2 2,A3 3,A4 4,A5 5,A6 6}\nEND\n\0DEFDAT A\nDECL E6POS XP1={X 1,Y 2,Z 3,A 0,B 0,C 0,S 'B10',T 35}\nENDDAT\n",
        "def a():\n  f = p[1, 2, 3, 0.1, -.2, d2r(30)]\n  movej([0, 1, 2, 3, 4, 5], a=1)\n  movel(pose_trans(f, p[1e-1,2,3 ,0,0,0]), 1.2, 0.25, 0, r=0.01)\n  movec(f, p[1,2,3,0,0,1])\n  \
         set_tcp(f)\n  movej(get_inverse_kin(f))\nend\n",
        "MODULE M\nCONST robtarget p1:=[[1,2,3],[1,0,0,0],[0,1,-1,1],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPERS tooldata t:=[TRUE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n\
         PROC a()\nMoveAbsJ [[1,2,3,4,5,6],[9E9,9E9,9E9,9E9,9E9,9E9]]\\NoEOffs,v5,fine,t;\nMoveL p1,v100\\V:=5,z1,t\\WObj:=wobj0;\nMoveC p1,Offs(p1,0,0,-5.5),v5,z1,t;\nENDPROC\nENDMODULE\n",
        "/JOB\r\n//NAME A\r\n//POS\r\n///NPOS 2,0,0,0,0,0\r\n///USER 1\r\n///TOOL 1\r\n///POSTYPE USER\r\n///RECTAN\r\n///RCONF 0,0,0,0,0,0,0,0\r\nC00000=1.000,2.000,3.000,0.00,0.00,0.00\r\n\
         C00001=2.000,2.000,3.000,0.00,90.00,0.00\r\n//INST\r\n///DATE 2026/01/01 00:00\r\n///ATTR SC,RW,RJ\r\n////FRAME USER 1\r\n///GROUP1 RB1\r\nNOP\r\nMOVJ C00000 VJ=5.00\r\nMOVL C00001 V=10.0\r\nEND\r\n",
        "/PROG  A\n/ATTR\nLINE_COUNT\t= 2;\n/MN\n   1:J P[1] 20% FINE ;\n   2:L P[1] 100mm/sec CNT100 ;\n/POS\nP[1]{\n   GP1:\n    UF : 1, UT : 1,  CONFIG : 'N U T, 0, 0, 0',\n\
         \tX = 1.000 mm,\tY = 2.000 mm,\tZ = 3.000 mm,\n\tW = 0.000 deg,\tP = 0.000 deg,\tR = 0.000 deg\n};\n/END\n",
        "<Database><Datas><Data name=\"f\" type=\"frame\"><Value key=\"0\" x=\"1\" rz='90' fatherId=\"world[0]\" /></Data><Data name=\"p\" type=\"pointRx\"><Value key=\"0\" y=\"2.5\" \
         shoulder=\"righty\" fatherId=\"f[0]\" /><Value key=\"1\" /></Data><Data name=\"j\" type=\"jointRx\"><Value j1=\"5\" /></Data></Datas></Database>\0<Programs><Program \
         name=\"start\"><Code><![CDATA[begin\n movej(j,flange,m)\n movec(p[0],p[0],flange,m)\n movel(p[1],flange,m)\nend]]></Code></Program></Programs>",
    ])
}

/// Every column; decimal commas.
pub fn path_csv() -> Vec<Vec<u8>> {
    seeds(&[
        "x_mm,y_mm,z_mm,i,j,k,feed_mm_per_min,rapid,spindle_rpm,axial_depth_mm,radial_depth_mm,op,note\n0,0,5,0,0,1,,1,,,,a,\n1,2,3,0,0.1,0.995,300,0,6000,1,2,a,x\n",
        "x_m;y_m;z_m;feed_mm_per_s\n0,1;0,2;0,3;10,5\n0,2;0,2;0,3;\n",
    ])
}

/// Programs of every format.
pub fn program() -> Vec<Vec<u8>> {
    [gcode(), apt(), path_csv()].concat()
}

/// With tabs and with commas that are decimal marks too.
pub fn dynoware() -> Vec<Vec<u8>> {
    let header = "DynoWare:,3.2.5.0\nFile:,c.dwd\nSampling rate [Hz]:,1000\nCycle No:,1\n";
    seeds(&[
        &format!("{header}Time,Fx,Fy,Fz\ns,N,N,N\n0,000,1,5,-2,5,3,0\n0,001,1,6,-2,4,3,1\n"),
        &format!(
            "{}Time\tFx\tFy\tFz\ns\tN\tN\tN\n0.000\t1.5\t-2.5\t3.0\n0.001\t1.6\t-2.4\t3.1\n",
            header.replace(',', "\t")
        ),
    ])
}

/// Both formats.
pub fn forces() -> Vec<Vec<u8>> {
    [dynoware(), force_csv()].concat()
}

/// Units in names and in a row.
pub fn force_csv() -> Vec<Vec<u8>> {
    seeds(&[
        "time_s,fx_n,fy_n,fz_n,mx_n_m,my_n_m,mz_n_m\n0,1,2,3,0,0,0.1\n0.001,1,2,3,0,0,0.1\n0.002,1,2,3,0,0,0.1\n",
        "Time;Fx;Fy;Fz\ns;kN;N;N\n0,0;1,5;2;3\n0,1;1,5;2;3\n",
    ])
}

/// Points in every form that is read, and results without points.
pub fn profiles() -> Vec<Vec<u8>> {
    seeds(&[
        "x_mm,y_mm\n25,0\n0,25.001\n-25,0\n0,-25\n",
        "# bore\r\nangle_deg;deviation_um;note\r\n0;1,5;a\r\n120;-2,25;b\r\n240;0;c\r\n",
        "x_um\ty_in\tz_m\n1\t2\t3\n4\t5\t7\n9\t8\t7\n1\t1\t0\n",
        "4\n0 25.001 3\n-25 0 3\n0 -25 3\n25 0 3\n",
        "<QIFDocument><LinearUnit><UnitConversion><Factor>0.001</Factor></UnitConversion></LinearUnit>\
         <CircleFeatureActual><Location>1 2 3</Location><Diameter>9.5</Diameter></CircleFeatureActual></QIFDocument>",
    ])
}

/// Runs by angle and by number, of both separators.
pub fn ballbar_csv() -> Vec<Vec<u8>> {
    let turn = |row: &dyn Fn(usize) -> String| (0..12).map(row).collect::<String>();
    let angles = turn(&|k| format!("{},{k}.5,CCW,1\n", 30 * k));
    let numbers = turn(&|k| format!("{k};100,0{k}\n"));
    seeds(&[
        &format!("# radius_mm: 100\nangle_deg,radius_dev_um,direction,run\n{angles}"),
        &format!(
            "# radius_mm: 100\n# start_deg: 0\n# direction: CW\nindex;radius_mm\n{numbers}# direction: CCW\n{numbers}"
        ),
    ])
}

/// Results of a ball-bar's own program.
pub fn ballbar_results() -> Vec<Vec<u8>> {
    seeds(&[
        "<B><TEST_SPEC NAME='a'/><PLANE TEST_PLANE='XY'/><MACHINE_TESTED NAME='m'/><OPERATOR>o</OPERATOR>\
             <FEATURE NAME='AF_CIRCULARITY' DT='UT_LENGTH_UM'>9.5</FEATURE><FEATURE NAME='AF_X'><VALUE>1</VALUE></FEATURE></B>",
    ])
}

/// Measured poses with names of ours and those of a public data set.
pub fn poses() -> Vec<Vec<u8>> {
    seeds(&[
        "pose,direction,q1_deg,S_deg,q3_deg,q4_deg,q5_deg,q6_deg,x_mm,y_mm,z_mm\nP,up,0,1,2,3,4,5,6,7,8\n",
        "q1_deg;q2_deg;q3_deg;q4_deg;q5_deg;q6_deg;x_mm;y_mm;z_mm;rx_deg;ry_deg;rz_deg\r\n0;1,5;2;3;4;5;6;7;8;9;10;11\0\r\n",
        "shoulder_pan_joint;shoulder_lift_joint;elbow_joint;wrist_1_joint;wrist_2_joint;wrist_3_joint;measurement_x;\
         measurement_y;measurement_z;Goal x;Goal y;Goal z\n0;1;2;3;-1;-2;100,5;200;300;1;2;3\n",
    ])
}

/// Points along a path, of one run and of several.
pub fn traces() -> Vec<Vec<u8>> {
    seeds(&[
        "x_mm,y_mm,z_mm\n0,0,0\n10,0,0\n20,0,1\n30,0,1\n",
        "# tracker\nrun;x_um;y_m;z_in;time\nA;1,5;0;0;1\nA;2e4;0;0;2\nB;1;0;0;1\nB;3e4;0,001;0;2\n",
        "// SpatialAnalyzer SA 2024.2 ( x64 )\n// AXES = CARTESIAN: X,  Y,  Z (mm)\nPath,  P1,  0,  1.5,  -2,  3,  02/12/25 16:52:45\nPath,  P1,  1,  2,  -2,  3\n",
    ])
}

/// The library of materials.
pub fn materials() -> Vec<Vec<u8>> {
    MATERIALS.iter().map(|material| material.text.into()).collect()
}

pub(crate) fn seeds(texts: &[&str]) -> Vec<Vec<u8>> {
    texts.iter().map(|text| (*text).into()).collect()
}

const EVERY_TABLE: &str = r#"format = 1
title = "Everything"
question = "Is it within the tolerance?"
robot = "yaskawa/mh12"
base = "base_link"
tolerance_um = 60
[compliance]
rad_per_n_m = [1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6]
u_rad_per_n_m = [1e-7, 1e-7, 1e-7, 1e-7, 1e-7, 1e-7]
source = "a guess"
assumed = true
[positioner]
robot = "yaskawa/mh12"
base_from_root_mm_deg = [2000, 0, 0, 0, 0, 180]
joints_deg = [0, 0, 0, 0, 0, 0]
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
diameter_mm = 10
stick_out_mm = 40
modulus_gpa = 600
[plane]
centre_mm = [900, 0, 800]
tilt_deg = 0
half_size_mm = [100, 50]
step_mm = 50
[load]
frame = "base"
cases_n = [[3, -5, 5], [3, 5, 5]]
moments_n_m = [[0, 0, 1], [0, 0, 2]]
u_percent = 10
source = "none"
[posture]
branch = "front elbow-up"
home_deg = [0, 0, 0, 0, 0, 0]
[[analysis]]
kind = "map"
name = "plate"
plane.rotation_deg = [90, 0, 90]
plane.half_size_mm = 80
[[analysis]]
kind = "sections"
name = "tilts"
tilts_deg = [0, 30]
posture.branch = "best"
[[analysis]]
kind = "sections"
distances_mm = [800, 900]
[[analysis]]
kind = "volume"
box = { centre_mm = [900, 0, 800], half_size_mm = [50, 50, 50], step_mm = 50 }
[[analysis]]
kind = "path"
name = "circle"
circle = { centre_mm = [0, 20], radius_mm = 40 }
step_mm = 20
[[analysis]]
kind = "path"
line = { from_mm = [0, 0], to_mm = [50, 0] }
[[analysis]]
kind = "path"
polyline_mm = [[0, 0], [50, 0], [50, 50]]
[[analysis]]
kind = "path"
rectangle = { centre_mm = [0, 0], size_mm = [60, 40] }
[[statement]]
text = "within 0.1 mm"
source = "a paper"
at_most_um = 100
of = ["plate", "circle"]
"#;
const EVERY_PROGRAM: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
load_dependent = true
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
[gravity]
reference_joints_deg = [0, 0, 0, 0, 0, 0]
direction = [0, 0, -1]
[plane]
centre_mm = [900, 0, 800]
tilt_deg = 0
half_size_mm = [100, 50]
step_mm = 50
[cut]
material = "aluminium-6061-t6"
law = "mechanistic"
axial_depth_mm = 1
radial_depth_mm = 5
side = "down"
feed_mm_per_min = 300
spindle_rpm = 3000
greatest = true
u_percent = 10
[cut.cutter]
diameter_mm = 10
corner_radius_mm = 1
flutes = 4
helix_deg = 30
rake_deg = 5
runout_um = 10
[cut.stock]
from_mm = [-50, -50, -20]
to_mm = [50, 50, 0]
cell_mm = 1
[[analysis]]
kind = "path"
name = "part"
[analysis.program]
file = "part.ngc"
unit = "mm"
dialect = "nx"
rotaries = "table-ac"
tool_table = "tool.tbl"
part_from_path_mm_deg = [0, 0, 0, 0, 0, 0]
tool_axis = "normal"
spin = "along-feed"
spin_deg = 10
chord_error_mm = 0.01
step_mm = 1
limits = false
[[analysis.program.feature]]
name = "slot"
lines = [10, 20]
[[analysis]]
kind = "path"
[analysis.program]
file = "forces.csv"
[analysis.program.measured]
file = "cut.txt"
acts_on = "part"
frame = "part"
sensor_turned_deg = 90
air_s = [[0, 0.1]]
drift = true
low_pass_hz = 500
spindle_rpm = 3000
value = "mean"
start_s = 0.5
rapid_mm_per_min = 10000
channels = ["Fx", "Fy", "Fz"]
[[analysis]]
kind = "path"
[analysis.program]
file = "holes.apt"
[analysis.program.drill]
material = "aluminium-6061-t6"
diameter_mm = 6
point_deg = 118
feed_mm_per_min = 100
spindle_rpm = 1000
"#;
