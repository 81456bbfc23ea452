//! The surface of a machined part that a page requests: that of the answer, and the stock as it is cut.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use armill_core::watch::Watch;
use armill_study::StudyError;
use armill_study::live::{
    PartCache, PartSurfaceQuestion, PathCache, StudyText, ViewQuestion, answer_json, view,
};
use serde_json::Value;

/// The stock, mm.
const STOCK: [[f64; 3]; 2] = [[-100.0, -70.0, -20.0], [150.0, 70.0, 0.0]];

/// The pocket of the examples with a part in cells of 2 mm.
struct Pocket {
    folder: PathBuf,
    text: String,
}

impl Pocket {
    fn new() -> Pocket {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/r2000ic-pocket");
        let text = std::fs::read_to_string(folder.join("study.toml")).unwrap();
        let coarse = text.replace("cell_mm = 0.5", "cell_mm = 2");
        assert_ne!(coarse, text);
        Pocket { folder, text: coarse }
    }

    fn text(&self) -> StudyText<'_> {
        StudyText {
            shown: "study.toml",
            folder: &self.folder,
            bytes: self.text.as_bytes(),
        }
    }

    fn frame(&self, parts: &PartCache, frame: usize, frames: usize) -> Surface {
        let question = PartSurfaceQuestion {
            analysis: Some("pocket"),
            frame,
            frames,
        };
        let bytes = parts.surface(self.text(), &question, &PathCache::default(), Watch::NONE);
        Surface(bytes.unwrap())
    }
}

/// A surface as it is sent.
#[derive(PartialEq)]
struct Surface(Vec<u8>);

impl Surface {
    fn header(&self) -> Value {
        serde_json::from_slice(&self.0[4..self.begin()]).unwrap()
    }

    /// Where the columns begin.
    fn begin(&self) -> usize {
        4 + u32::from_le_bytes(self.0[..4].try_into().unwrap()) as usize
    }

    /// The numbers of a column.
    fn column(&self, key: &str) -> Vec<[u8; 4]> {
        let header = self.header();
        let mut at = self.begin();
        for column in header["columns"].as_array().unwrap() {
            let of = if column["key"] == "triangles" {
                "triangles"
            } else {
                "vertices"
            };
            let size = header[of].as_u64().unwrap() * column["components"].as_u64().unwrap();
            let end = at + 4 * size as usize;
            if column["key"] == key {
                return self.0[at..end]
                    .chunks(4)
                    .map(|four| four.try_into().unwrap())
                    .collect();
            }
            at = end;
        }
        panic!("no column {key}")
    }

    fn numbers(&self, key: &str) -> Vec<f64> {
        self.column(key)
            .into_iter()
            .map(|four| f64::from(f32::from_le_bytes(four)))
            .collect()
    }

    /// By the theorem of Gauss, mm^3.
    fn volume(&self) -> f64 {
        let xyz = self.numbers("xyz_mm");
        let vertex = |four: [u8; 4]| {
            let at = 3 * u32::from_le_bytes(four) as usize;
            armill_core::nalgebra::Vector3::from_column_slice(&xyz[at..at + 3])
        };
        let triangles = self.column("triangles");
        let of = triangles.chunks(3).map(|three| {
            let [a, b, c] = [0, 1, 2].map(|corner| vertex(three[corner]));
            a.dot(&b.cross(&c)) / 6.0
        });
        of.sum()
    }
}

#[test]
fn the_finished_surface_has_the_answer_of_the_command_and_its_deviations() {
    let pocket = Pocket::new();
    let given = pocket.frame(&PartCache::default(), 1, 1);
    let header = given.header();
    let answer: Value =
        serde_json::from_str(&answer_json(pocket.text(), Some("pocket"), Watch::NONE).unwrap()).unwrap();
    let part = &answer["paths"][0]["machined_part"];
    assert_eq!(&header["part"], part);
    let known: Vec<f64> = given
        .numbers("deviation_um")
        .into_iter()
        .filter(|um| um.is_finite())
        .collect();
    assert!(known.len() > 1000, "{}", known.len());
    let largest = |sign: f64| known.iter().map(|um| sign * um).fold(0.0, f64::max);
    // Vertices average the ends around them, which are not those of the steepest dexels alone: 5 %.
    for (key, sign) in [("most_left_um", 1.0), ("most_gouged_um", -1.0)] {
        let expected = sign * part[key].as_f64().unwrap();
        assert!(
            (largest(sign) / expected - 1.0).abs() < 0.05,
            "{key}: {} {expected}",
            largest(sign)
        );
    }
    // A deviation has its uncertainty and the move that made it.
    let [deviation, u] = ["deviation_um", "u_um"].map(|key| given.numbers(key));
    let points = given.column("point").into_iter().map(i32::from_le_bytes);
    let count = header["points"].as_u64().unwrap() as i32;
    for ((um, u), point) in deviation.iter().zip(&u).zip(points) {
        assert_eq!(um.is_finite(), u.is_finite(), "{um} {u}");
        assert!(um.is_nan() || point >= 0, "{um} {point}");
        assert!(point < count);
    }
}

#[test]
fn material_goes_away_along_the_path_and_a_frame_is_the_same_from_either_side() {
    let pocket = Pocket::new();
    let (forward, back) = (PartCache::default(), PartCache::default());
    const FRAMES: usize = 7;
    let all: Vec<Surface> = (0..FRAMES)
        .map(|frame| pocket.frame(&forward, frame, FRAMES))
        .collect();
    let volumes: Vec<f64> = all.iter().map(Surface::volume).collect();
    let [from, to] = STOCK;
    let stock: f64 = from.iter().zip(to).map(|(from, to)| to - from).product();
    // Edges and corners are as far off as a vertex of 4 bytes.
    assert!((volumes[0] / stock - 1.0).abs() < 1e-5, "{} {stock}", volumes[0]);
    assert!(volumes.windows(2).all(|two| two[1] < two[0]), "{volumes:?}");
    let part = pocket.frame(&forward, FRAMES, FRAMES);
    let removed = part.header()["part"]["removed_mm3"].as_f64().unwrap();
    // What the last frame has not removed is at most the part of one frame; chamfers of cells at concave edges are 2 %.
    let last = stock - volumes[FRAMES - 1];
    assert!(last < 1.02 * removed && last > 0.5 * removed, "{last} {removed}");
    for frame in (0..FRAMES).rev() {
        assert!(pocket.frame(&back, frame, FRAMES) == all[frame], "frame {frame}");
    }
    // The same point of the path, of more frames.
    assert!(pocket.frame(&back, 3 * 5, FRAMES * 5) == all[3]);
    let header = all[3].header();
    assert!(header["part"].is_null());
    let points = part.header()["points"].as_u64().unwrap();
    assert_eq!(header["points"].as_u64().unwrap(), points * 3 / FRAMES as u64);
    let made = all[3]
        .column("point")
        .into_iter()
        .map(i32::from_le_bytes)
        .max()
        .unwrap();
    assert!(made > 0 && (made as u64) < points * 3 / FRAMES as u64);
}

#[test]
fn a_cancelled_request_leaves_what_was_kept() {
    let pocket = Pocket::new();
    let cancel = AtomicBool::new(true);
    let watch = Watch {
        finished: &|_| (),
        cancel: &cancel,
    };
    let (parts, paths) = (PartCache::default(), PathCache::default());
    let before = pocket.frame(&parts, 1, 3);
    for frame in [2, 3] {
        let question = PartSurfaceQuestion {
            analysis: Some("pocket"),
            frame,
            frames: 3,
        };
        let refused = parts.surface(pocket.text(), &question, &paths, watch);
        assert!(matches!(refused, Err(StudyError::Cancelled(_))), "{refused:?}");
    }
    assert!(pocket.frame(&parts, 1, 3) == before);
    assert!(pocket.frame(&parts, 2, 3) == pocket.frame(&PartCache::default(), 2, 3));
}

#[test]
fn a_finished_part_that_is_cancelled_under_way_is_cut_again() {
    let pocket = Pocket::new();
    let (parts, paths) = (PartCache::default(), PathCache::default());
    // The path is kept: what follows is the part alone.
    let stock = pocket.frame(&parts, 0, 1);
    let cancel = AtomicBool::new(false);
    let watch = Watch {
        finished: &|_| cancel.store(true, Ordering::Relaxed),
        cancel: &cancel,
    };
    let question = PartSurfaceQuestion {
        analysis: Some("pocket"),
        frame: 1,
        frames: 1,
    };
    let refused = parts.surface(pocket.text(), &question, &paths, watch);
    assert!(matches!(refused, Err(StudyError::Cancelled(_))), "{refused:?}");
    assert!(pocket.frame(&parts, 0, 1) == stock);
    assert!(pocket.frame(&parts, 1, 1) == pocket.frame(&PartCache::default(), 1, 1));
}

#[test]
fn a_view_has_no_part_whatever_was_requested_before() {
    let pocket = Pocket::new();
    let (parts, paths) = (PartCache::default(), PathCache::default());
    let question = ViewQuestion {
        analysis: Some("pocket"),
        paths: Some(&paths),
        ..ViewQuestion::default()
    };
    let shown = || {
        let answer = view(pocket.text(), &question, Watch::NONE).unwrap();
        assert!(answer.path.as_ref().unwrap().has_part);
        serde_json::to_string(&answer).unwrap()
    };
    let before = shown();
    let of = PartSurfaceQuestion {
        analysis: Some("pocket"),
        frame: 1,
        frames: 1,
    };
    let kept = parts.surface(pocket.text(), &of, &paths, Watch::NONE).unwrap();
    assert_eq!(shown(), before);
    // The path that is kept gives the same part as one that is evaluated again.
    assert!(Surface(kept) == pocket.frame(&PartCache::default(), 1, 1));
}

#[test]
fn frames_out_of_range_and_analyses_without_a_part_are_refused() {
    let pocket = Pocket::new();
    let without = pocket.text.lines().filter(|line| {
        !["[analysis.machined_part]", "cell_mm =", "stock ="]
            .iter()
            .any(|key| line.starts_with(key))
    });
    let without: String = without.map(|line| format!("{line}\n")).collect();
    let refused = |text: &str, frame: usize, frames: usize| {
        let text = StudyText {
            bytes: text.as_bytes(),
            ..pocket.text()
        };
        let question = PartSurfaceQuestion {
            analysis: Some("pocket"),
            frame,
            frames,
        };
        let found = PartCache::default().surface(text, &question, &PathCache::default(), Watch::NONE);
        found.unwrap_err().to_string().lines().next().unwrap().to_owned()
    };
    assert_eq!(refused(&pocket.text, 4, 3), "frame 4 is out of range: 0 to 3");
    assert_eq!(refused(&pocket.text, 0, 0), "`frames` must be at least 1 (got 0)");
    assert_eq!(
        refused(&without, 1, 1),
        "the analysis `pocket` has no `machined_part`"
    );
}
