use super::*;

const URDF: &str = "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>\
     <joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/></joint></robot>";

fn read_as(path: &str, bytes: &[u8]) -> Result<RobotDescription, String> {
    read(Path::new(path), "r", bytes, &RobotReadOptions::default()).map_err(|problems| problems.to_string())
}

#[test]
fn the_format_follows_from_ending_and_content() {
    for (path, text, format) in [
        ("a.TOML", "", Some(Format::Armill)),
        ("a.urdf", "<robot/>", Some(Format::Urdf)),
        ("a.urdf", "<robot><xacro:macro/></robot>", Some(Format::Xacro)),
        ("a.urdf.xacro", "", Some(Format::Xacro)),
        ("a.xml", "<robot/>", Some(Format::Urdf)),
        ("a.xml", "<robot xmlns:xacro=\"x\"/>", Some(Format::Xacro)),
        ("package.xml", "<package/>", None),
        ("a.yml", "", Some(Format::Opw)),
        ("a.yaml", "# c\nkinematics:\n", Some(Format::Ur)),
        ("a.csv", "", Some(Format::Dh)),
        ("a.txt", "convention = standard", Some(Format::Dh)),
        ("a.txt", "Tz(450)", Some(Format::Chain)),
        ("a.fsf", "", Some(Format::Chain)),
        ("a.step", "", None),
        ("a", "", None),
    ] {
        assert_eq!(Format::of(Path::new(path), text), format, "{path} {text}");
    }
    for format in Format::ALL {
        assert_eq!(format.name().parse(), Ok(format));
    }
}

#[test]
fn an_unknown_ending_is_reported_with_the_supported_ones() {
    let text = read_as("a.step", b"ISO-10303-21;").unwrap_err();
    assert!(
        text.contains("`.step`") && text.contains(".urdf, .xacro"),
        "{text}"
    );
    let text = read_as("package.xml", b"<package/>").unwrap_err();
    assert!(text.contains("no <robot> element"), "{text}");
}

#[test]
fn refuses_binary_files() {
    assert!(read_as("a.urdf", b"").unwrap_err().contains("the file is empty"));
    assert!(
        read_as("a.urdf", b"\xef\xbb\xbf \n\0\0")
            .unwrap_err()
            .contains("the file is empty")
    );
    let text = read_as("a.urdf", b"<robot>\n\0\x01</robot>").unwrap_err();
    assert!(
        text.contains("a.urdf:2:1: not a text file: it contains the byte 0x00"),
        "{text}"
    );
    let text = read_as("a.urdf", b"\xff\xfe<\0r\0").unwrap_err();
    assert!(text.contains("UTF-16"), "{text}");
}

#[test]
fn marks_line_ends_and_foreign_letters_in_comments_are_tolerated() {
    let comment = URDF.replace(
        "<link name=\"b\"/>",
        "\n<!-- Gr\u{f6}\u{df}e -->\n<link name=\"b\"/>\n",
    );
    let latin: Vec<u8> = comment
        .chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap())
        .collect();
    for bytes in [
        latin,
        comment.clone().into_bytes(),
        comment.replace('\n', "\r\n").into_bytes(),
        comment.replace('\n', "\r").into_bytes(),
        [b"\xef\xbb\xbf", comment.as_bytes(), b"\0\0"].concat(),
    ] {
        assert_eq!(read_as("a.urdf", &bytes).unwrap().robot.joints().len(), 1);
    }
    let chain = "\u{feff}Tz(450) # H\u{f6}he\rRz(q1)\r";
    assert_eq!(
        read_as("a.chain", chain.as_bytes()).unwrap().robot.joints().len(),
        1
    );
}

#[test]
fn a_given_format_takes_precedence_and_tips_require_links() {
    let expected = RobotReadOptions {
        format: Some(Format::Urdf),
        tip: Some("b".to_owned()),
    };
    assert!(read(Path::new("robot"), "r", URDF.as_bytes(), &expected).is_ok());
    let expected = RobotReadOptions {
        format: Some(Format::Chain),
        tip: Some("b".to_owned()),
    };
    let text = read(Path::new("a"), "r", b"Rz(q1)", &expected)
        .unwrap_err()
        .to_string();
    assert!(text.contains("--tip"), "{text}");
}

#[test]
fn elements_that_nest_without_end_are_refused_before_anything_walks_them() {
    let deep = |levels: usize| {
        format!(
            "<robot xmlns:xacro=\"http://ros.org/wiki/xacro\">{}{}</robot>",
            "<a>".repeat(levels),
            "</a>".repeat(levels)
        )
    };
    for path in ["a.urdf", "/nowhere/a.xacro"] {
        // Far more than any stack has room for.
        let text = read_as(path, deep(300_000).as_bytes()).unwrap_err();
        assert!(text.contains("nest deeper than 64 levels"), "{text}");
        let text = read_as(path, deep(63).as_bytes()).unwrap_err();
        assert!(!text.contains("nest deeper"), "{text}");
    }
}
