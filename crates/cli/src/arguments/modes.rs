//! Arguments of `armill modes`.

use clap::Args;

#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
The arm needs masses: [[mass]] and [[motor]] of the robot file, or <inertial> of a URDF; and joint compliances.
Joints have the signs and zeros of the robot file. --tool-mm is flange to TCP in the flange frame: X,Y,Z in mm and RX,RY,RZ in \
degrees. In the place of ROBOT a study (its folder or file) adds its tool with springs and masses. Equations: docs/theory/modes.md

Examples:
  armill modes arm.toml --joints-deg 0,-20,-100,0,40,0 --tool-mm 0,0,200
  armill modes arm.urdf --joints-deg 0,-20,-100,0,40,0 --compliance-rad-per-n-m 1e-6,1e-6,2e-6,1e-5,1e-5,3e-5 --json
  armill modes cell --joints-deg 0,0,0,0,-90,0 --damping-ratio 0.02"
)]
pub(crate) struct ModesArguments {
    /// Library robot (see `armill robots`), robot file, or a study: then with its tool and its model
    pub robot: String,
    /// Joint positions A,B,... in degrees (mm for prismatic joints)
    #[arg(
        long,
        value_name = "A,B,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        required = true
    )]
    pub joints_deg: Vec<f64>,
    /// Flange to TCP
    #[arg(
        long,
        value_name = "X,Y,Z[,RX,RY,RZ]",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub tool_mm: Option<Vec<f64>>,
    /// Joint compliances in place of those of the robot file (m/N for prismatic joints)
    #[arg(
        long,
        value_name = "C1,...",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub compliance_rad_per_n_m: Option<Vec<f64>>,
    /// Assumed joint compliances by payload: light (to 20 kg), medium (to 100 kg), heavy (to 300 kg)
    #[arg(long, value_name = "CLASS", conflicts_with = "compliance_rad_per_n_m")]
    pub compliance_class: Option<String>,
    /// Damping ratio of every mode, in place of the damping of the robot file
    #[arg(long, value_name = "Z")]
    pub damping_ratio: Option<f64>,
    /// Frame in whose axes directions are given [default: base_link, or that of the study]
    #[arg(long, value_name = "FRAME")]
    pub base: Option<String>,
    /// Print the result as JSON on stdout
    #[arg(long)]
    pub json: bool,
}
