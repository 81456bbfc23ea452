//! Files of pyuff, other forms of numbers by the published format, and invalid files.

use std::f64::consts::TAU;

use armill_core::nalgebra::Complex;

use super::super::read;

/// The text that pyuff 2.5.8 writes before the data, with this first line and record 7, remarks shortened.
fn head(first: &str, form: &str) -> String {
    let none = "NONE\n".repeat(4);
    format!(
        "    -1\n{first}\ntap\n{none}    4         0    0         0       NONE        12  -1       NONE         7   3\n{form}\n\
         \u{20}       18    0    0    0 NONE                 NONE                \n        12    0    0    0 NONE                 m/s^2               \n\
         \u{20}       13    0    0    0 NONE                 N                   \n         0    0    0    0 NONE                 NONE                \n"
    )
}

const DOUBLE_EVEN: &str = "         6         4         1  1.00000e+02  1.00000e+01  0.00000e+00";
const DOUBLE_UNEVEN: &str = "         6         4         0  0.00000e+00  0.00000e+00  0.00000e+00";
const SINGLE_EVEN: &str = "         5         4         1  1.00000e+02  1.00000e+01  0.00000e+00";
const SINGLE_UNEVEN: &str = "         5         4         0  0.00000e+00  0.00000e+00  0.00000e+00";
/// What was written: 100, 110, 120, 130 Hz.
const VALUES: [(f64, f64); 4] = [(1.0, 2.0), (3.0, -4.0), (-5e-3, 6.0), (7.25, -8e3)];
/// The data of pyuff 2.5.8, even spacing, on a machine with little endian.
const BY_PYUFF: &[u8] = b"\x00\x00\x00\x00\x00\x00\xf0?\x00\x00\x00\x00\x00\x00\x00@\x00\x00\x00\x00\x00\x00\x08@\x00\x00\x00\x00\x00\x00\x10\xc0\
{\x14\xaeG\xe1zt\xbf\x00\x00\x00\x00\x00\x00\x18@\x00\x00\x00\x00\x00\x00\x1d@\x00\x00\x00\x00\x00@\xbf\xc0";

/// The first line of a dataset.
fn first(order: u8, bytes: usize) -> String {
    format!("    58b{order:6}     2          11{bytes:12}     0     0           0           0")
}

fn file(first: &str, form: &str, data: &[u8]) -> Vec<u8> {
    [head(first, form).as_bytes(), data, b"    -1\n"].concat()
}

/// The values with or without frequencies, by this function to bytes.
fn data(frequency: Option<&dyn Fn(f64) -> Vec<u8>>, number: &dyn Fn(f64) -> Vec<u8>) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (k, (re, im)) in VALUES.into_iter().enumerate() {
        bytes.extend(frequency.map_or_else(Vec::new, |to| to(100.0 + 10.0 * k as f64)));
        bytes.extend(number(re));
        bytes.extend(number(im));
    }
    bytes
}

/// Relative deviation of single precision: half of 2^-23.
fn is_as_written(bytes: &[u8], relative: f64) -> Vec<String> {
    let found = read("a.uff", bytes).unwrap();
    let [frf] = &found.frfs[..] else {
        panic!("{found:?}")
    };
    for (k, (re, im)) in VALUES.into_iter().enumerate() {
        let w = TAU * (100.0 + 10.0 * k as f64);
        assert!((frf.angular_frequencies[k] - w).abs() < 1e-9);
        // The response is along -x: receptance = -(a)/(-w^2).
        let expected = Complex::new(re, im) / (w * w);
        let deviation = (frf.receptance[k] - expected).norm();
        assert!(deviation <= relative * expected.norm(), "{k}");
    }
    found.notes
}

#[test]
fn files_of_pyuff_are_read_although_their_number_of_bytes_is_half() {
    assert_eq!(BY_PYUFF, data(None, &|value| value.to_le_bytes().to_vec()));
    let notes = is_as_written(&file(&first(1, 32), DOUBLE_EVEN, BY_PYUFF), 1e-14);
    assert!(
        notes[0].contains("states 32 bytes of data and has 64"),
        "{notes:?}"
    );
    let uneven = data(Some(&|hz| hz.to_le_bytes().to_vec()), &|value| {
        value.to_le_bytes().to_vec()
    });
    is_as_written(&file(&first(1, 32), DOUBLE_UNEVEN, &uneven), 1e-14);
}

#[test]
fn all_forms_of_numbers_are_read() {
    let double = |value: f64| value.to_be_bytes().to_vec();
    let small = |value: f64| (value as f32).to_le_bytes().to_vec();
    let big = |value: f64| (value as f32).to_be_bytes().to_vec();
    let is_read = |order: u8, form: &str, data: &[u8], relative: f64| {
        let bytes = file(&first(order, data.len()), form, data);
        assert!(is_as_written(&bytes, relative).is_empty());
        // With line ends of Windows in the text, and one after the data.
        let text = head(&first(order, data.len()), form).replace('\n', "\r\n");
        is_as_written(&[text.as_bytes(), data, b"\r\n    -1\r\n"].concat(), relative);
    };
    is_read(2, DOUBLE_EVEN, &data(None, &double), 1e-14);
    is_read(2, DOUBLE_UNEVEN, &data(Some(&double), &double), 1e-14);
    // A frequency of single precision before values of double precision, as in text.
    is_read(2, DOUBLE_UNEVEN, &data(Some(&big), &double), 1e-14);
    is_read(1, SINGLE_EVEN, &data(None, &small), 1e-7);
    is_read(1, SINGLE_UNEVEN, &data(Some(&small), &small), 1e-7);
    is_read(2, SINGLE_EVEN, &data(None, &big), 1e-7);
}

#[test]
fn a_file_after_a_binary_dataset_is_read_on() {
    let one = file(&first(1, 64), DOUBLE_EVEN, BY_PYUFF);
    let found = read("a.uff", &[&one[..], &one].concat()[..]).unwrap();
    assert_eq!(found.frfs.len(), 2);
    assert_eq!(found.frfs[0], found.frfs[1]);
}

#[test]
fn problems_are_refused_with_their_place() {
    let refused = |bytes: &[u8]| read("a.uff", bytes).unwrap_err().to_string();
    let good = file(&first(1, 64), DOUBLE_EVEN, BY_PYUFF);
    assert!(read("a.uff", &good[..]).is_ok());
    for (from, to, said) in [
        ("58b     1", "58b     3", "a.uff:2:1: `3` is not a byte order"),
        (
            "     2          11",
            "     1          11",
            "format `1` are not supported",
        ),
        ("          11", "          12", "`12` lines of text"),
        ("          64", "         x64", "`x64` is not a number of bytes"),
        (
            "         4         1",
            "         3         1",
            "a.uff:2:1: the binary data of the function do not end",
        ),
        (
            "         4         1",
            "         5         1",
            "ends after 71 of 80 bytes",
        ),
        ("         4         1", "    999999         1", "of data"),
    ] {
        let text = head(&first(1, 64), DOUBLE_EVEN).replacen(from, to, 1);
        assert_ne!(text, head(&first(1, 64), DOUBLE_EVEN), "{from}");
        let problems = refused(&[text.as_bytes(), BY_PYUFF, b"    -1\n"].concat());
        assert!(problems.contains(said), "{said}: {problems}");
    }
    let nan = data(None, &|_| f64::NAN.to_le_bytes().to_vec());
    assert!(refused(&file(&first(1, 64), DOUBLE_EVEN, &nan)).contains("number 1 of the data is not finite"));
    // Every beginning of a file is refused or read, without a panic.
    for end in 0..good.len() {
        let _ = read("a.uff", &good[..end]);
    }
}
