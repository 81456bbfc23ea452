//! What was measured? Force records in.
