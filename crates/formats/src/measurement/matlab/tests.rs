use proptest::prelude::*;

use super::*;

/// An element of a little-endian file.
fn element(code: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = code.to_le_bytes().to_vec();
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn head(class: u32, rows: i32, columns: i32, name: &str) -> Vec<u8> {
    let mut bytes = element(6, &[class.to_le_bytes(), [0; 4]].concat());
    bytes.extend(element(5, &[rows.to_le_bytes(), columns.to_le_bytes()].concat()));
    bytes.extend(element(1, name.as_bytes()));
    bytes
}

fn doubles(name: &str, rows: i32, columns: i32, values: &[f64]) -> Vec<u8> {
    let mut bytes = head(6, rows, columns, name);
    let data: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    bytes.extend(element(9, &data));
    element(14, &bytes)
}

/// A structure `rec` with an array of 2 x 3, one of whole numbers in a small element, and a structure in it.
fn sample() -> Vec<u8> {
    let mut small = head(9, 1, 3, "");
    small.extend([2, 0, 3, 0, 7, 8, 9, 0]);
    let mut inner = head(2, 1, 1, "");
    inner.extend([5, 0, 4, 0, 8, 0, 0, 0]);
    inner.extend(element(1, b"deep\0\0\0\0"));
    inner.extend(doubles("", 1, 1, &[5.0]));
    let mut rec = head(2, 1, 1, "rec");
    rec.extend([5, 0, 4, 0, 8, 0, 0, 0]);
    rec.extend(element(1, b"a\0\0\0\0\0\0\0count\0\0\0more\0\0\0\0"));
    rec.extend(doubles("", 2, 3, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    rec.extend(element(14, &small));
    rec.extend(element(14, &inner));
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend([0, 1, b'I', b'M']);
    file.extend(element(14, &rec));
    file
}

fn array(found: &MatlabFile, index: usize) -> Option<&MatlabArray> {
    match &found.requested[index] {
        Requested::Array(array) => Some(array),
        _ => None,
    }
}

#[test]
fn arrays_in_structures_are_found_by_their_paths() {
    let found = read(
        "log.mat",
        sample(),
        &["rec.a", "rec.count", "rec.more.deep", "rec.none"],
    )
    .unwrap();
    assert_eq!(found.names, ["rec.a", "rec.count", "rec.more.deep"]);
    let values = |index: usize| array(&found, index).map(|array| array.values.clone());
    assert_eq!(values(1), Some(vec![7.0, 8.0, 9.0]));
    assert_eq!(values(2), Some(vec![5.0]));
    assert_eq!(values(3), None);
    let array = array(&found, 0).unwrap();
    assert_eq!(
        array.signals(3),
        Some(vec![vec![1.0, 3.0, 5.0], vec![2.0, 4.0, 6.0]])
    );
    assert_eq!(
        array.signals(2),
        Some(vec![vec![1.0, 2.0], vec![3.0, 4.0], vec![5.0, 6.0]])
    );
    assert_eq!(array.signals(4), None);
}

#[test]
fn variables_of_other_classes_are_named() {
    let mut file = sample();
    for (class, name) in [(1, "c"), (4, "t"), (5, "s")] {
        file.extend(element(14, &head(class, 1, 1, name)));
    }
    let found = read("log.mat", file, &["c", "t", "s", "rec", "rec.none"]).unwrap();
    let other = |class: &str| Requested::Other(class.to_owned());
    assert_eq!(
        found.requested,
        [
            other("cell"),
            other("char"),
            other("sparse"),
            other("struct"),
            Requested::Absent
        ]
    );
}

#[test]
fn other_files_are_refused_with_the_way_to_save_them() {
    let refused = |bytes: &[u8]| read("log.mat", bytes.to_vec(), &[]).unwrap_err().to_string();
    let mut newer = sample();
    newer[125] = 2;
    let mut older = sample();
    older[125] = 0;
    for (bytes, words) in [
        (&newer[..], "the HDF5 file cannot be read"),
        (&older[..], "version 0x0000 of the MATLAB file is not supported"),
        (b"\x89HDF\r\n\x1a\n", "the HDF5 file cannot be read"),
        (b"MATLAB", "a header of 128 bytes"),
        (&[0; 200], "not a MATLAB file of level 5 or 7.3"),
    ] {
        let text = refused(bytes);
        assert!(text.contains(words), "{text}");
        assert!(text.contains("-v7"), "{text}");
    }
}

#[test]
fn a_variable_that_is_cut_off_is_named() {
    let mut bytes = sample();
    // The length of the 2 x 3 values: 48.
    let at = bytes
        .windows(8)
        .position(|word| word == [9, 0, 0, 0, 48, 0, 0, 0])
        .unwrap();
    bytes[at + 4] = 40;
    let text = read("log.mat", bytes.clone(), &["rec.a"])
        .unwrap_err()
        .to_string();
    assert!(
        text.contains("`rec.a`: 5 values, but its size is [2, 3]"),
        "{text}"
    );
    bytes[at + 4] = 200;
    let text = read("log.mat", bytes.clone(), &["rec.a"])
        .unwrap_err()
        .to_string();
    assert!(text.contains("`rec.a`") && text.contains("cut off"), "{text}");
}

#[test]
fn a_compressed_variable_is_that_of_the_same_file() {
    let plain = sample();
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    std::io::Write::write_all(&mut encoder, &plain[128..]).unwrap();
    let packed = encoder.finish().unwrap();
    let mut file = plain[..128].to_vec();
    file.extend(15_u32.to_le_bytes());
    file.extend((packed.len() as u32).to_le_bytes());
    file.extend(&packed);
    // The same name twice is the same array twice.
    let wanted = ["rec.a", "rec.a"];
    let found = read("log.mat", file.clone(), &wanted).unwrap();
    assert_eq!(found, read("log.mat", plain, &wanted).unwrap());
    assert!((0..2).all(|index| array(&found, index).is_some()));
    file[140] ^= 0xff;
    let text = read("log.mat", file.clone(), &wanted).unwrap_err().to_string();
    assert!(text.contains("damaged") || text.contains("cut off"), "{text}");
}

#[test]
fn sizes_beyond_all_memory_are_refused() {
    let mut bytes = sample();
    let size = [5, 0, 0, 0, 8, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0];
    let at = bytes.windows(16).position(|window| window == size).unwrap();
    bytes[at + 8..at + 16].fill(0x7f);
    let text = read("log.mat", bytes.clone(), &["rec.a"])
        .unwrap_err()
        .to_string();
    assert!(text.contains("6 values, but its size is"), "{text}");
}

proptest! {
    #[test]
    fn damaged_files_do_not_panic(edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6), cut in any::<prop::sample::Index>()) {
        let mut bytes = sample();
        for (at, byte) in &edits {
            let at = at.index(bytes.len());
            bytes[at] = *byte;
        }
        let _ = read("log.mat", bytes.clone(), &["rec.a", "rec.count"]);
        let end = cut.index(bytes.len());
        let _ = read("log.mat", bytes[..end].to_vec(), &["rec.a", "rec.count"]);
    }
}
