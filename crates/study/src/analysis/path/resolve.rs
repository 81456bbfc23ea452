//! A path, its placement and its load, from its tables.

use armill_core::load::PathLoad;
use armill_core::path::{Placing, Spin, Track};
use armill_core::units::from_deg;

use super::load::{LoadSource, put_on};
use super::robot_program::{self, RobotInCell};
use super::{PathAnalysis, PathSource, program, shape, spin_curve};
use crate::StudyError;
use crate::analysis::resolve::Resolver;
use crate::input::motion::MotionSetting;
use crate::input::problem_log::ProblemLog;
use crate::input::setting::Setting;

impl Resolver<'_> {
    /// The path of this analysis; `None` if it has problems, reported at their keys.
    ///
    /// # Errors
    /// The problems of the files that it names.
    pub fn path(
        &self,
        log: &mut ProblemLog<'_>,
        mut setting: Option<Setting>,
        push: Option<LoadSource<'_>>,
    ) -> Result<Option<PathAnalysis>, StudyError> {
        let (table, robot) = (self.table, self.robot.map(|found| &found.robot));
        if usize::from(table.program.is_some()) + shape::count(table) != 1 {
            let hint = "circle = { radius_mm = 100 }, line, polyline_mm, rectangle, or program = { file = \"part.ngc\" }";
            log.problem_here("a path has exactly one shape or program", hint);
            return Ok(None);
        }
        let (path, source) = match &table.program {
            Some(of) => {
                let cell = RobotInCell::of(robot, setting.as_ref());
                let Some(mut found) = program::read(log, of, self.folder, cell)? else {
                    return Ok(None);
                };
                if let (Some(program), Some(robot), Some(setting)) = (&found.robot, robot, &mut setting) {
                    let note = robot_program::take_posture(setting, &program.followed, robot);
                    found.summary.notes.extend(note);
                }
                let source = PathSource::Program {
                    file: of.file.clone(),
                    summary: found.summary,
                    robot: found.robot,
                };
                (found.path, source)
            }
            None => match shape::resolve(log, table, self.plane_table().step_mm) {
                Some((path, shape)) => (path, PathSource::Shape(shape)),
                None => return Ok(None),
            },
        };
        let (Some(setting), Some(push)) = (setting, push) else {
            return Ok(None);
        };
        let base_from_part = setting.plane.base_from_part;
        let placing = match &table.program {
            Some(of) => program::placing(of, &base_from_part, source.robot()),
            None => Placing {
                spin: Spin::Fixed(from_deg(table.spin_deg.unwrap_or(0.0))),
                ..Placing::on_plane(&setting.plane)
            },
        };
        if table.program.is_some() && table.spin_deg.is_some() {
            let hint = "use program.spin_deg";
            log.problem("spin_deg", "`spin_deg` is valid for shapes only", hint);
            return Ok(None);
        }
        let searches = self.of_posture(|posture| posture.search.as_ref()).is_some();
        if table.spin_curve_mm_deg.is_some() && searches {
            spin_curve::refuse_with_search(log);
            return Ok(None);
        }
        let mut analysis = PathAnalysis {
            source,
            spin_curve: None,
            track: Track {
                path,
                placing,
                base_from_part,
                spins: None,
                homes: None,
            },
            load: PathLoad::Cases(setting.load.clone()),
            cut: None,
            drill: None,
            forces: None,
            measured: None,
            machined_part: None,
            wants_limits: table.program.as_ref().is_some_and(|of| of.limits.unwrap_or(true)),
            features: table
                .program
                .as_ref()
                .map_or_else(Vec::new, |of| of.feature.clone()),
            setting: Setting {
                motion: (self.common.motion.zip(robot))
                    .map(|(table, robot)| MotionSetting::of(table, robot, self.common.rapid)),
                ..setting
            },
        };
        if let Some(points) = &table.spin_curve_mm_deg {
            let Some(curve) = spin_curve::resolve(log, points, &analysis) else {
                return Ok(None);
            };
            analysis.track.spins = Some(curve.along(&analysis.track.path));
            analysis.spin_curve = Some(curve);
        }
        if !put_on(log, push, self.folder, &mut analysis)? {
            return Ok(None);
        }
        if let Some(machined) = &table.machined_part {
            let Some(found) = self.machined_part(log, machined, &analysis)? else {
                return Ok(None);
            };
            analysis.machined_part = Some(Box::new(found));
        }
        Ok(Some(analysis))
    }
}
