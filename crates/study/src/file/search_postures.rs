//! The search for spins and branches along every path of a study that does not request it itself.

use armill_core::optimize::PostureSearch;

use crate::analysis::Subject;
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::input::posture_search::SearchTable;

impl Study {
    /// Searches spins of the tool and branches along every path, as `requested` specifies. Without it the search of the
    /// study is used, or the default search if it has none, within the branches that the study permits.
    ///
    /// # Errors
    /// A study without paths; an invalid range of spins.
    pub fn search_postures(&mut self, requested: Option<&SearchTable>) -> Result<(), StudyError> {
        let usual = SearchTable::default();
        let mut paths = 0;
        for analysis in &mut self.analyses {
            let Subject::Path(path) = &mut analysis.subject else {
                continue;
            };
            paths += 1;
            let setting = &mut path.setting;
            let table = requested.or(setting.search.is_none().then_some(&usual));
            if let Some(table) = table {
                let search = table.search(setting.tolerance, setting.open);
                let search = search.map_err(|(message, hint)| StudyError::value(message, hint))?;
                // What the tool and the axes may do is a matter of the study, not of this search.
                let of_study = setting.search.take();
                let (lean, axes) = of_study.map(|of| (of.lean, of.axes)).unwrap_or_default();
                setting.search = Some(PostureSearch { lean, axes, ..search });
            }
        }
        if paths == 0 {
            let message = "the study has no path along which the tool could be turned";
            return Err(StudyError::value(
                message,
                "[[analysis]] kind = \"path\" with a program or a shape",
            ));
        }
        Ok(())
    }
}
