//! Good inputs of the parsers of `tracked`: joint logs, MATLAB files and frequency response functions.

use crate::fixtures::seeds;

/// Joint logs with names of ours and of RTDE.
pub fn joint_logs() -> Vec<Vec<u8>> {
    seeds(&[
        "timestamp, cmd_num, J1, J2\n0, -1, 10, 87\n0.004, -1, 10.1, 87\n0.008, 2, 10.2, 86\n",
        "timestamp actual_q_0 actual_q_1 target_q_0 target_q_1\n1 0.1 0.2 0.1 0.2\n1.002 0.1 0.2 0.1 0.2\n",
    ])
}

/// A MATLAB file with one structure, and one array in it; one of version 7.3, from the tests.
pub fn matlab_files() -> Vec<Vec<u8>> {
    let element = |code: u32, data: &[u8]| {
        let mut bytes = [code.to_le_bytes(), (data.len() as u32).to_le_bytes()].concat();
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    };
    let head = |class: u8, columns: u8, name: &str| {
        let dimensions = element(5, &[1, 0, 0, 0, columns, 0, 0, 0]);
        [element(6, &[class, 0, 0, 0, 0, 0, 0, 0]), dimensions, element(1, name.as_bytes())].concat()
    };
    let array = element(14, &[head(6, 2, ""), element(9, &[0; 16])].concat());
    let fields = [&[5, 0, 4, 0, 8, 0, 0, 0][..], &element(1, b"a\0\0\0\0\0\0\0")].concat();
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend([0, 1, b'I', b'M']);
    file.extend(element(14, &[head(2, 1, "rec"), fields, array].concat()));
    vec![file, include_bytes!("../../crates/formats/tests/seeds/arrays_7_3.mat").to_vec()]
}

/// FRFs as tables and as universal files.
pub fn frfs() -> Vec<Vec<u8>> {
    let universal = |form: &str, data: &str| {
        format!(
            "    -1\n   164\n         1                  SI         1\n   1.0D+00   1.0D+00   1.0D+00\n   2.7315D+02\n    -1\n    -1\n    58\ntap\nNONE\nNONE\nNONE\nNONE\n\
             \u{20}   4         0    0         0       NONE        12  -1       NONE         7   3\n{form}\n        18    0    0    0 NONE                 NONE\n\
             \u{20}       12    0    0    0 NONE                 m/s^2\n        13    0    0    0 NONE                 N\n         0    0    0    0 NONE                 NONE\n{data}\n    -1\n"
        )
    };
    let mut all = seeds(&[
        "frequency_hz,receptance_real_um_per_n,receptance_imag_um_per_n,response,reference\n100,1,0.5,1X,1X\n110,2,-1,1X,1X\n100,1,0.5,1-Y,1X\n",
        "frequency_hz;accelerance_magnitude_g_per_n;phase_deg;coherence\n100;1,5;90;0,9\n110;2;80;0,99\n",
        &universal("         5         2         1  1.00000e+02  1.00000e+01  0.00000e+00", "  1.00000e+00  2.00000e+00  3.00000e+00 -4.00000e+00"),
        &universal("         6         2         0  0.00000e+00  0.00000e+00  0.00000e+00", "  1.00000e+02   1.00000000000e+00   2.00000000000e+00\n  1.10000e+02   3.00000000000e+00  -4.00000000000e+00"),
    ]);
    let binary = universal("         6         2         1  1.00000e+02  1.00000e+01  0.00000e+00", "    -1")
        .replace("    58\n", "    58b     1     2          11          32     0     0           0           0\n");
    let (text, end) = binary.split_at(binary.len() - "    -1\n    -1\n".len());
    let data: Vec<u8> = [1.0_f64, 2.0, 3.0, -4.0].into_iter().flat_map(f64::to_le_bytes).collect();
    all.push([text.as_bytes(), &data, &end.as_bytes()["    -1\n".len()..]].concat());
    all
}
