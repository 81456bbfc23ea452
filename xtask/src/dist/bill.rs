//! The bill of materials (SBOM) for programs: CycloneDX 1.6 in JSON.
//!
//! It lists what every component is, its licence, the checksum of its package, and which others it uses; nothing of
//! when and where it was made, so that the same sources give the same bytes. Format: ECMA-424,
//! <https://cyclonedx.org/docs/1.6/json/>

use super::component::{Component, Components};

/// The bill of armill of this version.
pub fn text(version: &str, components: &Components) -> String {
    let root = format!("pkg:cargo/armill@{version}");
    let entry = |(url, component): (&String, &Component)| format!("    {}", entry(url, component));
    let others = components.iter().filter(|(url, _)| **url != root);
    let others: Vec<String> = others.map(entry).collect();
    let uses = |(url, component): (&String, &Component)| {
        let uses: Vec<String> = component.uses.iter().map(|url| quoted(url)).collect();
        format!(
            "    {{\"ref\": {}, \"dependsOn\": [{}]}}",
            quoted(url),
            uses.join(", ")
        )
    };
    let dependencies: Vec<String> = components.iter().map(uses).collect();
    format!(
        "{{\n  \"bomFormat\": \"CycloneDX\",\n  \"specVersion\": \"1.6\",\n  \"version\": 1,\n  \
         \"metadata\": {{\"component\": {{\"type\": \"application\", \"bom-ref\": {root}, \"name\": \"armill\", \
         \"version\": {version}, \"licenses\": [{{\"expression\": \"Apache-2.0 OR MIT\"}}], \"purl\": {root}}}}},\n  \
         \"components\": [\n{}\n  ],\n  \"dependencies\": [\n{}\n  ]\n}}\n",
        others.join(",\n"),
        dependencies.join(",\n"),
        root = quoted(&root),
        version = quoted(version),
    )
}

/// One component, on one line.
fn entry(url: &str, component: &Component) -> String {
    let mut entry = format!(
        "{{\"type\": \"library\", \"bom-ref\": {url}, \"name\": {}, \"version\": {}",
        quoted(&component.name),
        quoted(&component.version),
        url = quoted(url)
    );
    if let Some(sha256) = &component.sha256 {
        entry += &format!(
            ", \"hashes\": [{{\"alg\": \"SHA-256\", \"content\": {}}}]",
            quoted(sha256)
        );
    }
    if !component.licence.is_empty() {
        entry += &format!(
            ", \"licenses\": [{{\"expression\": {}}}]",
            quoted(&component.licence)
        );
    }
    entry += &format!(", \"purl\": {}", quoted(url));
    if !component.repository.is_empty() {
        let from = quoted(&component.repository);
        entry += &format!(", \"externalReferences\": [{{\"type\": \"vcs\", \"url\": {from}}}]");
    }
    entry + "}"
}

/// A text in JSON.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            control if control.is_control() => quoted += &format!("\\u{:04x}", u32::from(control)),
            other => quoted.push(other),
        }
    }
    quoted + "\""
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_bill_lists_component_licence_checksum_and_use() {
        let armill = Component {
            name: "armill".to_owned(),
            version: "0.1.0".to_owned(),
            uses: BTreeSet::from(["pkg:cargo/a@1.0.0".to_owned()]),
            ..Component::default()
        };
        let a = Component {
            name: "a".to_owned(),
            version: "1.0.0".to_owned(),
            licence: "MIT".to_owned(),
            repository: "https://example.org/a".to_owned(),
            sha256: Some("0f".to_owned()),
            ..Component::default()
        };
        let components = Components::from([
            ("pkg:cargo/armill@0.1.0".to_owned(), armill),
            ("pkg:cargo/a@1.0.0".to_owned(), a),
        ]);
        let bill = text("0.1.0", &components);
        let component = "    {\"type\": \"library\", \"bom-ref\": \"pkg:cargo/a@1.0.0\", \"name\": \"a\", \"version\": \"1.0.0\", \
             \"hashes\": [{\"alg\": \"SHA-256\", \"content\": \"0f\"}], \"licenses\": [{\"expression\": \"MIT\"}], \
             \"purl\": \"pkg:cargo/a@1.0.0\", \"externalReferences\": [{\"type\": \"vcs\", \"url\": \"https://example.org/a\"}]}\n";
        assert!(bill.contains(component), "{bill}");
        let used = "{\"ref\": \"pkg:cargo/armill@0.1.0\", \"dependsOn\": [\"pkg:cargo/a@1.0.0\"]}";
        assert!(bill.contains(used), "{bill}");
        // The application itself is not one of its components.
        assert_eq!(bill.matches("\"name\": \"armill\"").count(), 1);
        assert_eq!(bill.matches('{').count(), bill.matches('}').count());
    }

    #[test]
    fn characters_that_json_cannot_represent_are_escaped() {
        assert_eq!(quoted("a\"b\\c\n"), "\"a\\\"b\\\\c\\u000a\"");
    }
}
