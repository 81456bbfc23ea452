//! The rows are those of the data set, where it is at hand.

use super::ROWS;

#[test]
fn typed_rows_are_those_of_the_data_set() {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return;
    };
    let folder = std::path::Path::new(&samples).join("datasets/fanuc-r2000ic-deflection");
    let numbers = |file: &str| -> Vec<Vec<f64>> {
        let text = std::fs::read_to_string(folder.join(file)).expect(file);
        text.lines()
            .skip(1)
            .map(|line| line.split(',').map(|cell| cell.trim().parse().unwrap()).collect())
            .collect()
    };
    let (joints, forces) = (numbers("joint_angles.csv"), numbers("forces.csv"));
    for row in ROWS {
        assert_eq!(joints[row.number - 1], row.joints, "angles of row {}", row.number);
        assert_eq!(forces[row.number - 1], row.force, "forces of row {}", row.number);
    }
}
