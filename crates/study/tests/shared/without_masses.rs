//! An MH12 whose links have no masses: those of the library are estimated.

use std::path::Path;

/// The text with such an arm.
pub fn without_masses(text: &str) -> String {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let library = std::fs::read_to_string(repository.join("robots/yaskawa/mh12.toml")).unwrap();
    let is_other = |table: &&str| !table.contains("[[mass]]") && !table.contains("[sources.masses]");
    let tables: Vec<&str> = library.split("\n\n").filter(is_other).collect();
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mh12-without-masses.toml");
    // Tests run together: each writes a file of its own, and a rename is complete.
    let own = file.with_extension(format!(
        "{}-{:?}",
        std::process::id(),
        std::thread::current().id()
    ));
    std::fs::write(&own, tables.join("\n\n")).unwrap();
    std::fs::rename(&own, &file).unwrap();
    text.replace("yaskawa/mh12", &file.display().to_string())
}
