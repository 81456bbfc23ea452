//! The sample was written with h5py 3.16 (libhdf5), not with the crate that reads it, in the earliest format, as MATLAB's own files are, with
//! MATLAB's attributes and its header of 128 bytes in the user block. mat73, another program, finds the same values in it.
//!
//! ```text
//! rec.a           100 i + j / 4, 3 x 80, chunks of 2 x 64, shuffled and deflated
//! rec.count       7, 8, 9, int16     rec.more.deep, rec.more.flat   5; [1.5 2.5; 3.5 -4.5], single
//! rec.int64, rec.uint64              the least and the greatest number of the class
//! rec.logical     1, 0, 1            rec.empty   0 x 3      rec.cube   0 to 23, 2 x 3 x 4
//! rec.text, rec.complex, cell, sparse                       classes that are passed over
//! ```

use super::super::array::{MatlabArray, Requested};
use super::*;

const SAMPLE: &[u8] = include_bytes!("../../../../tests/seeds/arrays_7_3.mat");
const WANTED: [&str; 4] = ["rec.a", "rec.empty", "rec.more.flat", "rec.cube"];

fn array(path: &str) -> MatlabArray {
    let found = read(SAMPLE.to_vec(), &[path]).unwrap();
    match &found.requested[..] {
        [Requested::Array(array)] => array.clone(),
        other => panic!("{path}: {other:?}"),
    }
}

fn values(path: &str) -> (Vec<usize>, Vec<f64>) {
    let array = array(path);
    (array.dimensions, array.values)
}

#[test]
fn chunks_are_put_together_column_after_column() {
    let found = array("rec.a");
    assert_eq!(found.dimensions, [3, 80]);
    let row = |i: u32| -> Vec<f64> {
        (1..=80)
            .map(|j| 100.0 * f64::from(i) + f64::from(j) / 4.0)
            .collect()
    };
    assert_eq!(found.signals(80), Some(vec![row(1), row(2), row(3)]));
}

#[test]
fn numbers_of_each_class_are_read() {
    assert_eq!(values("rec.count"), (vec![1, 3], vec![7.0, 8.0, 9.0]));
    assert_eq!(values("rec.more.deep"), (vec![1, 1], vec![5.0]));
    assert_eq!(values("rec.more.flat"), (vec![2, 2], vec![1.5, 3.5, 2.5, -4.5]));
    assert_eq!(values("rec.int64").1, [-(2.0_f64.powi(63)), 2.0_f64.powi(63)]);
    assert_eq!(values("rec.uint64").1, [0.0, 2.0_f64.powi(64)]);
    assert_eq!(values("rec.logical").1, [1.0, 0.0, 1.0]);
    assert_eq!(values("rec.empty"), (vec![0, 3], vec![]));
    assert_eq!(
        values("rec.cube"),
        (vec![2, 3, 4], (0..24).map(f64::from).collect())
    );
}

#[test]
fn other_classes_are_named_and_not_listed() {
    let wanted = ["rec", "rec.text", "rec.complex", "cell", "sparse", "rec.none"];
    let found = read(SAMPLE.to_vec(), &wanted).unwrap();
    let other = |class: &str| Requested::Other(class.to_owned());
    assert_eq!(
        found.requested,
        [
            other("struct"),
            other("char"),
            other("complex double"),
            other("cell"),
            other("sparse"),
            Requested::Absent
        ]
    );
    let names = [
        "a",
        "count",
        "cube",
        "empty",
        "int64",
        "logical",
        "uint64",
        "more.deep",
        "more.flat",
    ];
    assert_eq!(found.names, names.map(|name| format!("rec.{name}")));
}

/// 2 x 3 x 4 is 4 x 3 x 2 in the file: a size of 4 becomes 10^12.
#[test]
fn sizes_beyond_all_memory_are_refused_before_data_are_read() {
    let at = SAMPLE
        .windows(24)
        .position(|sizes| sizes == [4_u64, 3, 2].map(u64::to_le_bytes).as_flattened())
        .unwrap();
    let mut bytes = SAMPLE.to_vec();
    bytes[at..at + 8].copy_from_slice(&10_u64.pow(12).to_le_bytes());
    let text = read(bytes.clone(), &["rec.cube"]).unwrap_err();
    assert_eq!(
        text,
        "`rec.cube`: the requested arrays need more than 268435456 bytes"
    );
    // It is not requested.
    assert!(read(bytes, &["rec.a"]).is_ok());
}

/// Each chunk of 2 x 64 values has its length in the index, 4 bytes, before the mask of its filters, 4 zeros, and the place.
#[test]
fn a_chunk_that_is_longer_than_the_file_is_refused() {
    let mut bytes = SAMPLE.to_vec();
    let second = [64_u64, 0, 0].map(u64::to_le_bytes);
    let at = SAMPLE
        .windows(24)
        .position(|offsets| offsets == second.as_flattened())
        .unwrap();
    bytes[at - 8..at - 4].copy_from_slice(&0xfff0_0000_u32.to_le_bytes());
    let text = read(bytes, &["rec.a"]).unwrap_err();
    assert_eq!(text, "`rec.a`: a chunk of 4293918720 bytes is cut off");
}

#[test]
fn what_is_read_in_total_is_limited() {
    let file = File::from_source(Metered::new(SAMPLE.to_vec(), 2_000));
    let error = file.and_then(|file| file.dataset("rec/a")).unwrap_err();
    assert!(error.to_string().contains("too often"), "{error}");
}

/// A byte changed anywhere, and a file cut off anywhere: an error or other values, but no panic, and no more than the limits.
#[test]
fn damaged_files_do_not_panic() {
    let mut damaged = 0;
    for at in (0..SAMPLE.len()).step_by(3) {
        for value in [0, 0xff, SAMPLE[at] ^ 0x10] {
            let mut bytes = SAMPLE.to_vec();
            bytes[at] = value;
            damaged += usize::from(read(bytes, &WANTED).is_err());
        }
    }
    assert!(damaged > 500, "{damaged}");
    for length in (0..SAMPLE.len()).step_by(64) {
        let cut = read(SAMPLE[..length].to_vec(), &WANTED);
        // The last parts of the file are data of `cell` and `sparse`.
        assert!(length > 18_000 || cut.is_err(), "{length}");
    }
}
