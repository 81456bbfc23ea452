//! Files of pyuff, tables, and invalid input.

use std::f64::consts::TAU;

use armill_core::dynamics::modal_fit::Dof;
use armill_core::nalgebra::Complex;

use super::*;

/// The layout that pyuff 2.5.8 writes, with these lines of record 7 to 9 and data.
fn universal(form: &str, numerator: &str, data: &str) -> String {
    let none = "NONE\n".repeat(4);
    format!(
        "    -1\n    58{:74}\ntap\n{none}    4         0    0         0       NONE        12  -1       NONE         7   3\n{form}\n\
         \u{20}       18    0    0    0 NONE                 NONE                \n{numerator}\n        13    0    0    0 NONE                 N                   \n\
         \u{20}        0    0    0    0 NONE                 NONE                \n{data}    -1\n",
        ""
    )
}

const ACCELERATION: &str = "        12    0    0    0 NONE                 m/s^2               ";
const SINGLE_EVEN: &str = "         5         4         1  1.00000e+02  1.00000e+01  0.00000e+00";
const SINGLE: &str = "  1.00000e+00  2.00000e+00  3.00000e+00 -4.00000e+00 -5.00000e-03  6.00000e+00\n  7.25000e+00 -8.00000e+03\n";

fn is_as_written(text: &str) {
    let found = read("a.uff", text.as_bytes()).unwrap();
    let [frf] = &found.frfs[..] else {
        panic!("{found:?}")
    };
    assert_eq!(
        [frf.response, frf.reference],
        [Dof { point: 12, axis: 0 }, Dof { point: 7, axis: 2 }]
    );
    let written = [(1.0, 2.0), (3.0, -4.0), (-5e-3, 6.0), (7.25, -8e3)];
    for (k, (re, im)) in written.into_iter().enumerate() {
        let w = TAU * (100.0 + 10.0 * k as f64);
        assert!((frf.angular_frequencies[k] - w).abs() < 1e-9);
        // The response is along -x: receptance = -(a)/(-w^2).
        let expected = Complex::new(re, im) / (w * w);
        assert!(
            (frf.receptance[k] - expected).norm() < 1e-12 * expected.norm(),
            "{k}"
        );
        assert!((frf.weights[k] - w * w).abs() < 1e-9 * w * w);
    }
}

#[test]
fn all_layouts_of_complex_data_are_read() {
    is_as_written(&universal(SINGLE_EVEN, ACCELERATION, SINGLE));
    is_as_written(&universal(
        "         5         4         0  0.00000e+00  0.00000e+00  0.00000e+00",
        ACCELERATION,
        "  1.00000e+02  1.00000e+00  2.00000e+00  1.10000e+02  3.00000e+00 -4.00000e+00\n  1.20000e+02 -5.00000e-03  6.00000e+00  1.30000e+02  7.25000e+00 -8.00000e+03\n",
    ));
    is_as_written(&universal(
        "         6         4         1  1.00000e+02  1.00000e+01  0.00000e+00",
        ACCELERATION,
        "   1.00000000000e+00   2.00000000000e+00   3.00000000000e+00  -4.00000000000e+00\n  -5.00000000000e-03   6.00000000000e+00   7.25000000000e+00  -8.00000000000e+03\n",
    ));
    is_as_written(&universal(
        "         6         4         0  0.00000e+00  0.00000e+00  0.00000e+00",
        ACCELERATION,
        "  1.00000e+02   1.00000000000e+00   2.00000000000e+00\n  1.10000e+02   3.00000000000e+00  -4.00000000000e+00\n  1.20000e+02  -5.00000000000e-03   6.00000000000e+00\n  1.30000e+02   7.25000000000e+00  -8.00000000000e+03\n",
    ));
    // Numbers without a blank between them, with the exponent of Fortran.
    is_as_written(&universal(
        SINGLE_EVEN,
        ACCELERATION,
        " 1.000000E+00 2.000000E+00 3.000000E+00-4.000000E+00-5.000000E-03 6.000000D+00\n 7.250000E+00-8.000000E+03\n",
    ));
}

#[test]
fn units_are_those_of_labels_then_of_dataset_164() {
    let first = |text: &str| read("a.uff", text.as_bytes()).unwrap();
    let w = TAU * 100.0;
    let si = first(&universal(SINGLE_EVEN, ACCELERATION, SINGLE)).frfs[0].receptance[0];
    let in_g = first(&universal(
        SINGLE_EVEN,
        &ACCELERATION.replace("m/s^2", "g    "),
        SINGLE,
    ));
    assert!((in_g.frfs[0].receptance[0] / si - Complex::new(9.80665, 0.0)).norm() < 1e-12);
    let velocity = ACCELERATION.replace("12 ", "11 ").replace("m/s^2", "mm/s ");
    let velocity = first(&universal(SINGLE_EVEN, &velocity, SINGLE)).frfs[0].receptance[0];
    // -(1 + 2i) mm/s / (i w)
    assert!(
        (velocity - Complex::new(-2e-3, 1e-3) / w).norm() < 1e-15,
        "{velocity}"
    );
    let unlabelled = universal(SINGLE_EVEN, &ACCELERATION.replace("m/s^2", "NONE "), SINGLE);
    let assumed = first(&unlabelled);
    assert_eq!(assumed.frfs[0].receptance[0], si);
    assert!(assumed.notes[0].contains("SI"), "{:?}", assumed.notes);
    // mm: the factor by which lengths in SI are multiplied.
    let millimetres = format!(
        "    -1\n   164\n         5            mm (milli)         2\n   1.0000000000000000D+03   1.0000000000000000D+00   1.0000000000000000D+00\n   2.7315D+02\n    -1\n{unlabelled}"
    );
    let scaled = first(&millimetres).frfs[0].receptance[0];
    assert!((scaled / si - Complex::new(1e-3, 0.0)).norm() < 1e-15);
}

#[test]
fn a_coherence_gives_weights_and_other_datasets_are_listed() {
    let frf = universal(SINGLE_EVEN, ACCELERATION, SINGLE);
    let real = "         2         4         1  1.00000e+02  1.00000e+01  0.00000e+00";
    let coherence = universal(
        real,
        ACCELERATION,
        "  9.00000e-01  5.00000e-01  2.00000e-01  8.00000e-01\n",
    )
    .replace("    4         0    0", "    6         0    0");
    let found = read(
        "a.uff",
        format!("    -1\n   151\nmodel\n    -1\n{frf}{coherence}").as_bytes(),
    )
    .unwrap();
    assert_eq!(found.unused, ["1 x dataset 151"]);
    let own = &found.frfs[0];
    assert!((own.weights[0] * own.receptance[0].norm() - 3.0).abs() < 1e-12);
    assert!((own.weights[1] * own.receptance[1].norm() - 1.0).abs() < 1e-12);
}

#[test]
fn problems_of_a_universal_file_have_their_place() {
    let refused = |text: &str| read("a.uff", text.as_bytes()).unwrap_err().to_string();
    let good = universal(SINGLE_EVEN, ACCELERATION, SINGLE);
    for (from, to, said) in [
        (
            "         5         4",
            "         5         5",
            "the dataset ends after 8 of 10 numbers",
        ),
        (
            "         5         4",
            "         5         2",
            "more than 4 numbers",
        ),
        (
            "         5         4",
            "         7         4",
            "a.uff:9:1: 7 is not a type of data",
        ),
        (
            "         5         4",
            "         5  99999999",
            "a.uff:9:11: 99999999 values",
        ),
        (
            "         5         4",
            "         5         x",
            "a.uff:9:11: `x` is not a whole number",
        ),
        ("3.00000e+00", "3.0000oe+00", "a.uff:14:27"),
        ("m/s^2", "Pa   ", "SI"),
        (
            "        12    0",
            "        15    0",
            "a.uff:11:1: numerator of type 15",
        ),
        (
            "        13    0",
            "        12    0",
            "a.uff:12:1: denominator of type 12",
        ),
        (
            "        18    0",
            "        17    0",
            "a.uff:10:1: the abscissa is of type 17",
        ),
        (
            "12  -1 ",
            "12   4 ",
            "a.uff:8:52: the direction 4 of the response",
        ),
        (
            "    4         0    0",
            "    1         0    0",
            "no frequency response function",
        ),
        ("    58 ", "   58b ", "is not a byte order"),
        (
            "    -1\n    58",
            "    -1\n    55",
            "no frequency response function",
        ),
        ("1.00000e+01  0.0", "0.00000e+00  0.0", "do not rise"),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from}");
        if said == "SI" {
            assert!(
                read("a.uff", text.as_bytes()).unwrap().notes[0].contains("`Pa` of an axis is not known")
            );
            continue;
        }
        let problems = refused(&text);
        assert!(problems.contains(said), "{said}: {problems}");
    }
    // Every beginning of a file is refused or read, without a panic.
    for end in 0..good.len() {
        let _ = read("a.uff", &good.as_bytes()[..end]);
    }
}

#[test]
fn tables_of_parts_or_of_magnitude_and_phase_are_read() {
    let parts = "frequency_hz;receptance_real_um_per_n;receptance_imag_um_per_n;response;reference;x\n0;1;0;1X;1X;0\n100;0,5;-0,25;1X;1X;0\n100;1;2;1-Y;1X;0\n";
    let found = read("a.csv", parts.as_bytes()).unwrap();
    assert_eq!(found.unused, ["x"]);
    assert!(found.notes.is_empty());
    let [one, two] = &found.frfs[..] else {
        panic!("{found:?}")
    };
    // The frequency 0 is left out.
    assert_eq!(one.receptance, [Complex::new(0.5e-6, -0.25e-6)]);
    assert_eq!(two.response, Dof { point: 1, axis: 1 });
    assert!((two.receptance[0] + Complex::new(1e-6, 2e-6)).norm() < 1e-18);
    let polar = "frequency_hz,accelerance_magnitude_g_per_n,phase_deg,coherence\n100,2,90,0.5\n";
    let found = read("a.csv", polar.as_bytes()).unwrap();
    assert!(found.notes[0].contains("1X"));
    let w = TAU * 100.0;
    let expected = Complex::new(0.0, -2.0 * 9.80665 / (w * w));
    let own = &found.frfs[0];
    assert!((own.receptance[0] - expected).norm() < 1e-12 * expected.norm());
    assert!((own.weights[0] * expected.norm() - 1.0).abs() < 1e-12);
}

#[test]
fn problems_of_a_table_are_reported_together() {
    let refused = |text: &str| read("a.csv", text.as_bytes()).unwrap_err().to_string();
    let text = "frequency_hz,mobility_real_mm_per_s_per_n,mobility_imag_mm_per_s_per_n,response,coherence\n1,x,0,1X,1\n-2,0,0,1Q,2\n3,1,1,1X,1\n3,1,1,1X,1\n4,1\n";
    let problems = refused(text);
    for said in [
        "a.csv:2:3",
        "`x` is not a finite number",
        "a.csv:3:1",
        "below 0",
        "`1Q` is not a point",
        "not within 0 to 1",
        "a.csv:5:1",
        "does not rise",
        "2 cells",
    ] {
        assert!(problems.contains(said), "{said}: {problems}");
    }
    assert!(refused("").contains("no frequencies"));
    assert!(refused("frequency,phase_deg\n").contains("no unit is given for `frequency`"));
    assert!(refused("frequency_hz,receptance_real_m_per_s_per_n\n").contains("no unit that is known"));
    assert!(refused("frequency_hz,receptance_abs_m_per_n\n").contains("not real, imag or magnitude"));
    assert!(
        refused("frequency_hz,receptance_real_m_per_n\n1,1\n")
            .contains("real and imaginary part, or magnitude")
    );
    assert!(
        refused("receptance_real_m_per_n,receptance_imag_m_per_n\n1,1\n")
            .contains("`frequency_hz` is missing")
    );
    let mixed = "frequency_hz,receptance_real_m_per_n,mobility_imag_m_per_s_per_n\n1,1,1\n";
    assert!(refused(mixed).contains("not of the same quantity"));
}
