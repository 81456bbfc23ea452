//! Good inputs to begin with: our own robots and studies, and small texts that use every part of a format.

use armill_study::library::{MATERIALS, ROBOTS, STUDIES};

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

/// The example studies, those of the validation, and one that uses every table.
pub fn studies() -> Vec<Vec<u8>> {
    let mut all = seeds(&[
        include_str!("../../validation/mh12-fractions/study.toml"),
        include_str!("../../validation/mh12-readings/study.toml"),
        EVERY_TABLE,
    ]);
    all.extend(STUDIES.iter().map(|study| study.text.into()));
    all
}

/// Properties, arguments, conditions, blocks, nested macros.
pub fn xacro() -> Vec<Vec<u8>> {
    let mut all = seeds(&[ARM_OF_MACROS, MACRO_ALONE]);
    all.extend(urdf());
    all
}

/// Parameters with lists in one line and over several.
pub fn opw() -> Vec<Vec<u8>> {
    seeds(&[
        "opw_kinematics_geometric_parameters:\n  a1: 0.15\n  a2: -0.2\n  b: 0.0\n  c1: 0.45 # h\n  c2: 0.6\n  \
         c3: 0.64\n  c4: 0.1\nopw_kinematics_joint_offsets: [0.0, 0.0, deg(-90.0), 0.0, 0.0, deg(180.0)]\n\
         opw_kinematics_joint_sign_corrections: [1, 1, -1, -1, -1, -1]\n",
        "opw_kinematics_geometric_parameters: {a1: 1, a2: 0, b: 0, c1: 1, c2: 1, c3: 1, c4: 0}\n\
         opw_kinematics_joint_offsets:\n  - 0\n  - 0\n  - 1.5\n  - 0\n  - 0\n  - 0\n\
         opw_kinematics_joint_sign_corrections:\n  - 1\n  - 1\n  - 1\n  - -1\n  - 1\n  - 1\n",
    ])
}

/// Both conventions, every separator, sliding and fixed rows.
pub fn dh() -> Vec<Vec<u8>> {
    seeds(&[
        "convention = standard\na_m, alpha_deg, d_m, theta_deg\n0, 90, 0, 0\n0.4, 0, 0.1, 0\n0, -90, 0, 0\n",
        "convention = modified\nname = arm\njoint; type; alpha_deg; a_mm; d_mm; theta_deg; sign; lower_deg; \
         upper_deg\nS; r; 0; 0; 450; 0; 1; -170; 170\nL; r; -90; 155,5; 0; -90; -1; ;\nD; p; 0; 614; 10; 0; 1; ;\n\
         ; fixed; 90; 0; 0; 0; ; ;\n",
        "# blanks\nconvention = standard\na_mm alpha_rad d_mm theta_rad\n0 1.5708 450 0\n155 0 0 1.5\n",
    ])
}

/// Both ways to write factors, symbols, offsets.
pub fn chain() -> Vec<Vec<u8>> {
    seeds(&[
        "# arm\nH = 450\nA = A^3(H) A6(phi) * Tx(155) Ry(90-q2)\nTz(q3 + 10) Rx(-psi_1) Tx(H)\n",
        "Tz(450) Rz(q1) Tx(155) Ry(q2) Tz(614) Ry(-q3) Tz(200) Rx(-q4) Tx(640)\nRy(-q5) Rx(-q6) Tx(100) Ry(-90)\n",
    ])
}

/// A file of every format, its ending on a line before it.
pub fn named() -> Vec<Vec<u8>> {
    let mut all = Vec::new();
    for (endings, files) in [
        (&["toml"][..], robots()),
        (&["urdf", "xml"], urdf()),
        (&["xacro", "xml", "urdf"], seeds(&[ARM_OF_MACROS, MACRO_ALONE])),
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

/// Every column; decimal commas.
pub fn path_csv() -> Vec<Vec<u8>> {
    seeds(&[
        "x_mm,y_mm,z_mm,i,j,k,feed_mm_min,rapid,spindle_rpm,axial_depth_mm,radial_depth_mm,op,note\n0,0,5,0,0,1,,1,,,,a,\n1,2,3,0,0.1,0.995,300,0,6000,1,2,a,x\n",
        "x_m;y_m;z_m;feed_mm_s\n0,1;0,2;0,3;10,5\n0,2;0,2;0,3;\n",
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

/// Units in names and in a row.
pub fn forces() -> Vec<Vec<u8>> {
    seeds(&[
        "time_s,fx_n,fy_n,fz_n,mx_n_m,my_n_m,mz_n_m\n0,1,2,3,0,0,0.1\n0.001,1,2,3,0,0,0.1\n0.002,1,2,3,0,0,0.1\n",
        "Time;Fx;Fy;Fz\ns;kN;N;N\n0,0;1,5;2;3\n0,1;1,5;2;3\n",
    ])
}

/// The library of materials.
pub fn materials() -> Vec<Vec<u8>> {
    MATERIALS.iter().map(|material| material.text.into()).collect()
}

fn seeds(texts: &[&str]) -> Vec<Vec<u8>> {
    texts.iter().map(|text| (*text).into()).collect()
}

const MACRO_ALONE: &str = r#"<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="h" value="0.45"/>
<xacro:macro name="arm" params="prefix">
<link name="${prefix}a"/><link name="${prefix}b"/>
<joint name="${prefix}j" type="revolute"><origin xyz="0 0 ${h + 0.1 * cos(radians(60))}" rpy="0 ${-pi/2.0} 0"/>
<parent link="${prefix}a"/><child link="${prefix}b"/><axis xyz="0 0 -1"/>
<limit lower="${-radians(170)}" upper="${radians(170)}" velocity="1"/></joint></xacro:macro></robot>
"#;

const ARM_OF_MACROS: &str = r#"<?xml version="1.0"?>
<robot name="arm" xmlns:xacro="http://wiki.ros.org/xacro">
  <xacro:property name="h" value="${0.4 + 0.05}"/>
  <xacro:property name="foot"><origin xyz="0 0 ${h}"/></xacro:property>
  <xacro:arg name="speed" default="2"/>
  <xacro:macro name="axis" params="name parent child z:=1 *origin">
    <joint name="${name}" type="revolute">
      <xacro:insert_block name="origin"/>
      <parent link="${parent}"/><child link="${child}"/>
      <axis xyz="0 0 ${z}"/>
      <limit lower="${-radians(170)}" upper="${radians(170)}" velocity="$(arg speed)"/>
    </joint>
    <link name="${child}"/>
  </xacro:macro>
  <xacro:macro name="pair" params="first second **ends">
    <xacro:axis name="${first}" parent="base" child="one"><xacro:insert_block name="foot"/></xacro:axis>
    <xacro:unless value="${first == second}">
      <xacro:axis name="${second}" parent="one" child="two" z="-1"><origin rpy="${pi/2} 0 0"/></xacro:axis>
    </xacro:unless>
    <xacro:insert_block name="ends"/>
  </xacro:macro>
  <link name="base"/>
  <xacro:if value="${h > 0.2 and not False}">
    <xacro:pair first="a" second="b"><ends><link name="side"/></ends></xacro:pair>
  </xacro:if>
  <joint name="fixed" type="fixed"><parent link="two"/><child link="side"/></joint>
</robot>
"#;

const EVERY_TABLE: &str = r#"format = 1
title = "Everything"
question = "Does it hold?"
robot = "yaskawa/mh12"
base = "base_link"
limit_um = 60
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
[[ask]]
kind = "map"
name = "plate"
plane.rotation_deg = [90, 0, 90]
plane.half_size_mm = 80
[[ask]]
kind = "sections"
name = "tilts"
tilts_deg = [0, 30]
posture.branch = "best"
[[ask]]
kind = "sections"
distances_mm = [800, 900]
[[ask]]
kind = "volume"
box = { centre_mm = [900, 0, 800], half_size_mm = [50, 50, 50], step_mm = 50 }
[[ask]]
kind = "path"
name = "circle"
circle = { centre_mm = [0, 20], radius_mm = 40 }
step_mm = 20
[[ask]]
kind = "path"
line = { from_mm = [0, 0], to_mm = [50, 0] }
[[ask]]
kind = "path"
polyline_mm = [[0, 0], [50, 0], [50, 50]]
[[ask]]
kind = "path"
rectangle = { centre_mm = [0, 0], size_mm = [60, 40] }
[[statement]]
text = "within 0.1 mm"
source = "a paper"
at_most_um = 100
of = ["plate", "circle"]
"#;
