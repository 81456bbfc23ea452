//! The part that a path leaves of its stock: cut with the tool where it will be, and compared with the nominal part.
//!
//! [`table`]: its keys; `tools`: what cuts; `stock`: what it is cut from; [`setting`]: all of it in SI; [`resolve`](mod@resolve): from the keys; [`run`]: the part and its surface; `cut`: of a path as it was followed; [`in_process`]: the stock after the first points of a path;
//! [`features`]: form, size and position of faces; [`thickness`]: of walls; [`roughness`]: marks of the teeth; [`mesh`]: its surface as triangles; [`answer`], [`report`], [`pictures`], [`files`]: the result in numbers, words, colours and files; [`scan`], [`scan_answer`]: the measured part; [`scan_contributions`]: what
//! explains it; `scan_tips`: where the tool was by it; `displacement`: of a point of the tool.

pub mod answer;
mod cut;
mod displacement;
pub mod features;
pub mod files;
pub mod in_process;
pub mod mesh;
pub mod pictures;
pub mod report;
pub mod resolve;
pub mod roughness;
pub mod run;
pub mod scan;
pub mod scan_answer;
pub mod scan_contributions;
mod scan_tips;
pub mod setting;
mod stock;
pub mod table;
pub mod thickness;
mod tools;

pub use in_process::InProcessPart;
pub use run::MachinedPart;
pub use setting::{MachinedSetting, NominalPart};
pub use table::MachinedPartTable;
