//! Arrays of a file, and what is found of those that are requested.

/// Deepest structure.
pub(super) const DEEPEST: usize = 16;
/// Most bytes that the variables of a file need in memory.
pub(super) const MOST_BYTES: u64 = 1 << 28;
/// Most numeric arrays.
const MOST_ARRAYS: usize = 100_000;

/// The requested arrays, and the names of all of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MatlabFile {
    /// What the file has of each requested array, in the order of the request.
    pub requested: Vec<Requested>,
    /// Path of each numeric array of the file, in the order of the file.
    pub names: Vec<String>,
}

/// What a file has under a path.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Requested {
    /// Nothing.
    #[default]
    Absent,
    /// A variable that is not a numeric array: its class, such as `cell`.
    Other(String),
    /// A numeric array.
    Array(MatlabArray),
}

/// A numeric array.
#[derive(Clone, Debug, PartialEq)]
pub struct MatlabArray {
    /// Size of each dimension.
    pub dimensions: Vec<usize>,
    /// Its values, column after column.
    // unit: that of the file
    pub values: Vec<f64>,
}

impl MatlabArray {
    /// The array as signals of `samples` values: its rows or its columns, whichever have that length. `None` if neither has.
    pub fn signals(&self, samples: usize) -> Option<Vec<Vec<f64>>> {
        let &[rows, columns] = &self.dimensions[..] else {
            return None;
        };
        if samples == 0 {
            return None;
        }
        if rows == samples {
            return Some(self.values.chunks_exact(rows).map(<[f64]>::to_vec).collect());
        }
        let row = |row: usize| self.values.iter().skip(row).step_by(rows).copied().collect();
        (columns == samples).then(|| (0..rows).map(row).collect())
    }
}

/// What was found so far.
pub(super) struct Collected<'w> {
    wanted: &'w [&'w str],
    file: MatlabFile,
}

impl<'w> Collected<'w> {
    pub(super) fn new(wanted: &'w [&'w str]) -> Collected<'w> {
        let file = MatlabFile {
            requested: vec![Requested::Absent; wanted.len()],
            names: Vec::new(),
        };
        Collected { wanted, file }
    }

    pub(super) fn into_file(self) -> MatlabFile {
        self.file
    }

    /// Lists a numeric array; whether it is requested.
    ///
    /// # Errors
    /// Too many of them.
    pub(super) fn lists(&mut self, path: &str) -> Result<bool, String> {
        if self.file.names.len() == MOST_ARRAYS {
            return Err(format!("more than {MOST_ARRAYS} arrays"));
        }
        self.file.names.push(path.to_owned());
        Ok(self.wanted.contains(&path))
    }

    /// Passes over a variable of another class.
    pub(super) fn pass_over(&mut self, path: &str, class: &str) {
        self.place(path, &Requested::Other(class.to_owned()));
    }

    /// Takes the values of a requested array.
    ///
    /// # Errors
    /// Their number is not that of its size.
    pub(super) fn take(
        &mut self,
        path: &str,
        dimensions: Vec<usize>,
        values: Vec<f64>,
    ) -> Result<(), String> {
        let size = dimensions
            .iter()
            .try_fold(1_usize, |size, next| size.checked_mul(*next));
        if size != Some(values.len()) {
            return Err(format!("{} values, but its size is {dimensions:?}", values.len()));
        }
        self.place(path, &Requested::Array(MatlabArray { dimensions, values }));
        Ok(())
    }

    fn place(&mut self, path: &str, found: &Requested) {
        for (place, wanted) in self.file.requested.iter_mut().zip(self.wanted) {
            if *wanted == path {
                *place = found.clone();
            }
        }
    }
}
