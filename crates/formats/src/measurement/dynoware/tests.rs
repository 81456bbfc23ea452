//! Our own exports in the described form, and exports that must be refused.

use armill_core::nalgebra::Vector3;

use super::*;

/// Eighteen header lines with this separator.
fn header(separator: &str, samples: usize) -> String {
    [
        "Program and version:|Ours 1.0",
        "Path:|C:\\data",
        "File:|a.dwd",
        "Config ID:|1",
        "Setup ID:|2",
        "Manipulated:|no",
        "Date:|1.1.2020",
        "Time:|12:00:00",
        "Sampling rate [Hz]:|100000",
        "Measuring time [s]:|1",
        "Delay time [s]:|0",
        "Cycle time [s]:|1",
        "Cycles:|1",
        "Samples per channel:|#",
        "Cycle interval:|0",
        "Remark:|none",
        "Operator:|me",
        "Cycle No:|1",
    ]
    .map(|line| line.replace('|', separator).replace('#', &samples.to_string()) + "\r\n")
    .concat()
}

fn export(text: &str) -> Result<ForceRecords, Problems> {
    read(
        "a.txt",
        text.as_bytes(),
        ActsOn::Part,
        &ForceReadOptions::default(),
    )
}

fn problems(text: &str) -> String {
    export(text).unwrap_err().to_string()
}

const COMMAS: &str =
    "Time,Fx,Fy,Fz\r\ns,N,N,N\r\n0,000000,-0,0435965,1,5,0,25\r\n0,000010,-0,05,12,0,-3,125E-02\r\n";

#[test]
fn decimal_commas_are_joined_if_every_row_has_the_same_number_of_pieces() {
    let found = export(&(header(",", 2) + COMMAS)).unwrap();
    let [cycle] = &found.records[..] else {
        panic!("{found:?}")
    };
    assert_eq!(cycle.time(), [0.0, 1e-5]);
    assert_eq!(cycle.force()[0], Vector3::new(-0.0435965, 1.5, 0.25));
    assert_eq!(cycle.force()[1], Vector3::new(-0.05, 12.0, -0.03125));
    assert_eq!(cycle.acts_on(), ActsOn::Part);
}

#[test]
fn the_same_samples_with_every_separator_and_mark_are_the_same() {
    let first = export(&(header(",", 2) + COMMAS)).unwrap();
    for (separator, table) in [
        (
            ",",
            "Time,Fx,Fy,Fz\ns,N,N,N\n0.000000,-0.0435965,1.5,0.25\n0.000010,-0.05,12,-3.125E-02\n",
        ),
        (
            "\t",
            "Time\tFx\tFy\tFz\ns\tN\tN\tN\n0,000000\t-0,0435965\t1,5\t0,25\n0,000010\t-0,05\t12\t-0,03125\n",
        ),
        (
            ";",
            "Zeit;Fx;Fy;Fz\n[ms];[kN];[N];[mN]\n0;-0,0000435965;1,5;250\n0,01;-0,00005;12;-31,25\n",
        ),
        (
            ";",
            "\"Time\";\"Fx\";\"Fy\";\"Fz\";\ns;N;N;N;\n0;-0.0435965;1.5;0.25;\n0.00001;-0.05;12;-0.03125;\n",
        ),
    ] {
        let found = export(&(header(separator, 2) + table)).unwrap_or_else(|given| panic!("{given}"));
        for (a, b) in found.records[0].force().iter().zip(first.records[0].force()) {
            assert!((a - b).norm() < 1e-15, "{table}");
        }
        assert!((found.records[0].time()[1] - 1e-5).abs() < 1e-18, "{table}");
    }
}

#[test]
fn refuses_commas_as_ambiguous_if_a_value_has_no_fraction() {
    let head = header(",", 2);
    for rows in [
        // The first row, a later one, and one that could be read in two ways with the same count as another.
        "0,000000,-1,1,5,0,25\n0,000010,-0,05,12,0,-3,1\n",
        "0,000000,-0,5,1,5,0,25\n0,000010,-1,12,0,-3,1\n",
        "0,000000,-0,5,1,5,0,25\n1,2,3,4\n",
        "0,1,2,3\n0,000010,-0,5,1,5,0,25\n",
        "0,000000,-0,5,1,5,0,-25\n0,000010,-0,5,1,5,0,25\n",
        "0,000000,-0.5,5,1,5,0,25\n0,000010,-0,5,1,5,0,25\n",
        "0,000000,-0,5,1,5,0,25\n0,000010,-0,5,,5,0,25\n",
    ] {
        let given = problems(&format!("{head}Time,Fx,Fy,Fz\ns,N,N,N\n{rows}"));
        assert!(given.contains("export with tab or semicolon"), "{rows}: {given}");
    }
}

#[test]
fn numbers_written_with_commas_are_read_correctly_or_refused() {
    // Every pattern of which of three channels have a fraction, in two rows.
    for pattern in 0..64_u32 {
        let value = |row: u32, axis: u32| f64::from(10 * row + axis) + 0.5;
        let written = |row: u32, axis: u32| match pattern >> (3 * row + axis) & 1 {
            1 => format!("{}", value(row, axis)).replace('.', ","),
            _ => format!("{}", value(row, axis).floor()),
        };
        let row = |k: u32| format!("0,{k},{},{},{}\n", written(k, 0), written(k, 1), written(k, 2));
        let found = export(&format!(
            "{}Time,Fx,Fy,Fz\ns,N,N,N\n{}{}",
            header(",", 2),
            row(0),
            row(1)
        ));
        match found {
            Ok(found) => {
                assert_eq!(pattern, 63, "only if every number has a fraction");
                assert_eq!(found.records[0].force()[1], Vector3::new(10.5, 11.5, 12.5));
            }
            Err(given) => assert!(pattern != 63, "{given}"),
        }
    }
}

#[test]
fn further_cycles_become_separate_records() {
    let rows = "0\t1\t2\t3\n0,1\t4\t5\t6\n";
    let text = header("\t", 2) + "Time\tFx\tFy\tFz\ns\tN\tN\tN\n" + rows;
    let again = "Cycle No:\t2\nTime\tFx\tFy\tFz\ns\tN\tN\tN\n0\t7\t8\t9\n0,1\t4\t5\t6\n";
    let bare = format!("\r\nCycle No:\t3\n{rows}");
    let found = export(&format!("{text}{again}{bare}")).unwrap();
    assert_eq!(found.records.len(), 3);
    assert_eq!(found.records[1].force()[0], Vector3::new(7.0, 8.0, 9.0));
    assert_eq!(found.records[2], found.records[0]);
    let other = "Cycle No:\t2\nTime\tFx\tFy\tFz\ns\tkN\tN\tN\n0\t7\t8\t9\n";
    assert!(
        problems(&format!("{text}{other}")).contains("the channels differ from those of the previous cycle")
    );
}

#[test]
fn channels_may_be_renamed_and_further_channels_are_listed() {
    let text = header(";", 2)
        + "Time;Kraft1;Kraft2;Kraft3;AE;Mx;My;Mz\ns;N;N;N;V;Nm;Nm;N.m\n0;1;2;3;9;4;5;6\n1;1;2;3;9;4;5;6\n";
    let given = problems(&text);
    assert!(
        given.contains("missing channels: `Fx`, `Fy`, `Fz`") && given.contains("Kraft1, Kraft2"),
        "{given}"
    );
    let expected = ForceReadOptions {
        channels: Some(["kraft1", "kraft2", "kraft3"].map(str::to_owned).to_vec()),
        ..ForceReadOptions::default()
    };
    let found = read("a.txt", text.as_bytes(), ActsOn::Tool, &expected).unwrap();
    assert_eq!(found.unused, ["AE"]);
    assert_eq!(found.records[0].moment().unwrap()[1], Vector3::new(4.0, 5.0, 6.0));
}

#[test]
fn problems_are_reported_with_their_positions() {
    let head = header("\t", 2);
    for (table, part) in [
        ("", "the file has no samples"),
        (
            "Time\tFx\tFy\tFz\n",
            "19:1: the file ends after the line of channels",
        ),
        (
            "Time\tFx\tFy\tFz\n0\t1\t2\t3\n1\t1\t2\t3\n",
            "20:1: a line of 4 units is required",
        ),
        ("Time\tFx\tFy\tFz\ns\tN\tN\n", "a line of 4 units is required"),
        ("Time\tFx\tFy\tFz\ns\tV\tN\tN\n", "`V` is not a unit of `Fx`"),
        ("Time\tFx\tFx\tFz\ns\tN\tN\tN\n", "two channels are called `Fx`"),
        ("Time\tFx\tFz\ns\tN\tN\n", "missing channels: `Fy`"),
        (
            "Time\tFx\tFy\tFz\ns\tN\tN\tN\n0\t1\t2\n",
            "21:1: 3 cells, but there are 4 channels",
        ),
        (
            "Time\tFx\tFy\tFz\ns\tN\tN\tN\n0\t1\tx\t3\n",
            "`x` is not a number",
        ),
        (
            "Time\tFx\tFy\tFz\ns\tN\tN\tN\n0\t1\t2\t3\n0\t1\t2\t3\n",
            "time does not increase",
        ),
        (
            "Time\tFx\tFy\tFz\ns\tN\tN\tN\n0\t1\t2\t3\n",
            "ends after 1 samples, but its header specifies 2",
        ),
    ] {
        let given = problems(&format!("{head}{table}"));
        assert!(given.contains(part), "{table}: {given}");
        assert!(given.contains("help: "), "{given}");
    }
    let three = header("\t", 3) + "Time\tFx\tFy\tFz\ns\tN\tN\tN\n0\t1\t2\t3\n1\t1\t2\t3\n5\t1\t2\t3\n";
    assert!(problems(&three).contains("equal steps are needed"));
    assert!(problems(&"key:,value\n".repeat(500)).contains("no line of channels in 200 lines"));
    assert!(problems("").contains("the file has no samples"));
}

#[test]
fn all_problems_are_reported_together_and_a_wrong_cycle_gets_no_further_messages() {
    let rows = "0\t1\t2\t3\n1\tx\t2\t3\n2\t1\t2\n3\t1\t2\t3\n";
    let text = header("\t", 4) + "Time\tFx\tFy\tFz\ns\tN\tN\tN\n" + rows;
    let again = "Cycle No:\t2\n0\t1\t2\t3\n1\t1\t2\t3\n";
    let given = export(&format!("{text}{again}")).unwrap_err();
    let lines: Vec<usize> = given.as_slice().iter().map(Problem::line).collect();
    assert_eq!(lines, [22, 23, 27], "two cells, and a second cycle of 2 samples");
    assert!(
        given.as_slice()[2]
            .message()
            .starts_with("cycle 2 ends after 2 samples")
    );
    let units = export("Time\tFx\tFy\tFz\ns\tV\tN\tA\n").unwrap_err();
    assert_eq!(units.as_slice().len(), 2);
}

#[test]
fn comment_lines_do_not_end_a_cycle() {
    let rows = "0\t1\t2\t3\n# pause\n1\t4\t5\t6\n";
    let found = export(&(header("\t", 2) + "Time\tFx\tFy\tFz\n# units\ns\tN\tN\tN\n" + rows)).unwrap();
    assert_eq!(found.records.len(), 1);
}

#[test]
fn no_text_causes_a_panic() {
    let text = header(",", 2) + COMMAS;
    for cut in (0..text.len()).rev().take(120) {
        let _ = export(&text[..cut]);
        for with in [",", "\t", ";", "\n", "x", "-", "\u{e4}"] {
            let _ = export(&format!("{}{with}{}", &text[..cut], &text[cut + 1..]));
        }
    }
}
