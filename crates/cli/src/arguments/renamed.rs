//! Options of earlier versions: their present names are in the message that refuses them.

use clap::Error;
use clap::error::{ContextKind, ContextValue};

/// Options and their present names.
const RENAMED: &[(&str, &str)] = &[
    ("--as-drawn", "--nominal"),
    ("--ask", "--analysis"),
    ("--counts", "--component"),
    ("--goal", "--objective"),
    ("--hold-out", "--validation"),
    ("--sure", "--rank-by"),
];

/// The same error with the present name of the option as its tip, if it refuses a renamed one.
pub(crate) fn with_present_name(mut refused: Error) -> Error {
    let Some(ContextValue::String(option)) = refused.get(ContextKind::InvalidArg) else {
        return refused;
    };
    let present = RENAMED.iter().find(|(old, _)| old == option);
    if let Some((_, present)) = present {
        let present = ContextValue::String((*present).to_owned());
        refused.insert(ContextKind::SuggestedArg, present);
    }
    refused
}
