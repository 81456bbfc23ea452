use super::*;

fn array(name: &str, values: PointValues) -> PointArray {
    PointArray {
        name: name.to_owned(),
        values,
    }
}

/// A file as an XML reader sees it: the path of each data array, its attributes, and its bytes without the header.
struct ReadBack {
    text: String,
}

impl ReadBack {
    fn of(bytes: Vec<u8>) -> Self {
        Self {
            text: String::from_utf8(bytes).unwrap(),
        }
    }

    /// The attribute of the first element of that name.
    fn attribute(&self, element: &str, name: &str) -> String {
        let document = roxmltree::Document::parse(&self.text).unwrap();
        let node = document
            .descendants()
            .find(|node| node.has_tag_name(element))
            .unwrap();
        node.attribute(name).unwrap().to_owned()
    }

    /// Type, components and bytes of the array of that name below an element.
    fn array(&self, parent: &str, name: &str) -> (String, usize, Vec<u8>) {
        let document = roxmltree::Document::parse(&self.text).unwrap();
        let node = document
            .descendants()
            .find(|node| {
                node.attribute("Name") == Some(name)
                    && node.parent().is_some_and(|above| above.has_tag_name(parent))
            })
            .unwrap();
        assert_eq!(node.attribute("format"), Some("binary"));
        let block = STANDARD.decode(node.text().unwrap().trim()).unwrap();
        let (header, bytes) = block.split_at(8);
        assert_eq!(u64::from_le_bytes(header.try_into().unwrap()), bytes.len() as u64);
        let components = node.attribute("NumberOfComponents").unwrap().parse().unwrap();
        (
            node.attribute("type").unwrap().to_owned(),
            components,
            bytes.to_vec(),
        )
    }

    fn floats(&self, parent: &str, name: &str) -> Vec<f64> {
        let (kind, _, bytes) = self.array(parent, name);
        let four = |chunk: &[u8]| f64::from(f32::from_le_bytes(chunk.try_into().unwrap()));
        let eight = |chunk: &[u8]| f64::from_le_bytes(chunk.try_into().unwrap());
        match kind.as_str() {
            "Float32" => bytes.chunks_exact(4).map(four).collect(),
            "Float64" => bytes.chunks_exact(8).map(eight).collect(),
            other => panic!("{name} is {other}"),
        }
    }

    fn integers(&self, parent: &str, name: &str) -> Vec<i64> {
        let (kind, _, bytes) = self.array(parent, name);
        let four = |chunk: &[u8]| i64::from(i32::from_le_bytes(chunk.try_into().unwrap()));
        let eight = |chunk: &[u8]| i64::from_le_bytes(chunk.try_into().unwrap());
        match kind.as_str() {
            "Int32" => bytes.chunks_exact(4).map(four).collect(),
            "Int64" => bytes.chunks_exact(8).map(eight).collect(),
            other => panic!("{name} is {other}"),
        }
    }
}

/// A grid of 3 x 2 x 2 points in which every value shows its place.
fn sample_image() -> Image {
    let points = |value: fn(f64, f64, f64) -> f64| -> Vec<f64> {
        let places = (0..12).map(|index| (index % 3, index / 3 % 2, index / 6));
        places
            .map(|(i, j, k)| value(f64::from(i), f64::from(j), f64::from(k)))
            .collect()
    };
    let place = points(|i, j, k| i + 10.0 * j + 100.0 * k);
    let missing = place
        .iter()
        .map(|value| (*value != 11.0).then_some(*value))
        .collect();
    let vectors = place.iter().map(|value| Some([*value, -value, 0.5])).collect();
    let missing_vectors = place
        .iter()
        .map(|value| (*value < 100.0).then_some([*value, 1.0, 2.0]))
        .collect();
    Image::new(
        [800.0, -50.5, 300.25],
        [10.0, 20.0, 0.1],
        [3, 2, 2],
        vec![
            array("deviation_um", PointValues::Vector(vectors)),
            array(
                "place",
                PointValues::Scalar(place.into_iter().map(Some).collect()),
            ),
            array("in_plane_um", PointValues::Scalar(missing)),
            array("sometimes_um", PointValues::Vector(missing_vectors)),
            array(
                "within <limit> & \"more\"",
                PointValues::Scalar(vec![Some(1.0); 12]),
            ),
        ],
    )
    .unwrap()
}

fn sample_surface() -> PolyData {
    let points: Vec<[f64; 3]> = (0..6)
        .map(|index| [f64::from(index % 3), f64::from(index / 3), 0.25])
        .collect();
    let values = (0..6)
        .map(|index| (index != 4).then(|| f64::from(index) * 1.5))
        .collect();
    PolyData::plane_grids(
        points,
        &[[3, 2]],
        vec![array("in_plane_um", PointValues::Scalar(values))],
    )
    .unwrap()
}

fn sample_paths() -> PolyData {
    let paths = [
        vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
        vec![[5.0, 5.0, 5.0], [6.0, 5.0, 5.0]],
    ];
    PolyData::paths(
        &paths,
        vec![array(
            "feed_mm_per_min",
            PointValues::Scalar([1.0, 2.0, 3.0, 4.0, 5.0].map(Some).to_vec()),
        )],
    )
    .unwrap()
}

#[test]
fn an_image_has_its_extent_origin_and_spacing() {
    let file = ReadBack::of(write_image(&sample_image()));
    assert_eq!(file.attribute("VTKFile", "type"), "ImageData");
    assert_eq!(file.attribute("VTKFile", "header_type"), "UInt64");
    assert_eq!(file.attribute("VTKFile", "byte_order"), "LittleEndian");
    assert_eq!(file.attribute("ImageData", "WholeExtent"), "0 2 0 1 0 1");
    assert_eq!(file.attribute("Piece", "Extent"), "0 2 0 1 0 1");
    assert_eq!(file.attribute("ImageData", "Origin"), "800.0 -50.5 300.25");
    assert_eq!(file.attribute("ImageData", "Spacing"), "10.0 20.0 0.1");
    assert_eq!(file.attribute("PointData", "Scalars"), "place");
}

#[test]
fn x_runs_fastest_in_an_image() {
    let file = ReadBack::of(write_image(&sample_image()));
    let expected = [
        0.0, 1.0, 2.0, 10.0, 11.0, 12.0, 100.0, 101.0, 102.0, 110.0, 111.0, 112.0,
    ];
    assert_eq!(file.floats("PointData", "place"), expected);
}

#[test]
fn a_missing_value_is_nan_and_masked() {
    let file = ReadBack::of(write_image(&sample_image()));
    let values = file.floats("PointData", "in_plane_um");
    let (kind, _, mask) = file.array("PointData", "in_plane_um_valid");
    assert_eq!(
        (kind.as_str(), mask.as_slice()),
        ("UInt8", [1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1].as_slice())
    );
    assert!(values[4].is_nan() && values.iter().filter(|value| value.is_nan()).count() == 1);
    let vectors = file.floats("PointData", "sometimes_um");
    assert_eq!(vectors[..3], [0.0, 1.0, 2.0]);
    assert!(vectors[18..].iter().all(|value| value.is_nan()));
    assert_eq!(file.array("PointData", "sometimes_um_valid").2[5..7], [1, 0]);
}

#[test]
fn a_vector_has_three_components_side_by_side() {
    let file = ReadBack::of(write_image(&sample_image()));
    assert_eq!(file.array("PointData", "deviation_um").1, 3);
    assert_eq!(file.floats("PointData", "deviation_um")[3..6], [1.0, -1.0, 0.5]);
}

#[test]
fn a_name_may_contain_what_xml_reserves() {
    let file = ReadBack::of(write_image(&sample_image()));
    assert_eq!(file.floats("PointData", "within <limit> & \"more\""), [1.0; 12]);
    let strange = array("a\u{0}\n\u{ffff}'b", PointValues::Scalar(vec![Some(2.0)]));
    let image = Image::new([0.0; 3], [1.0; 3], [1; 3], vec![strange]).unwrap();
    let file = ReadBack::of(write_image(&image));
    assert_eq!(file.floats("PointData", "a?\n?'b"), [2.0]);
}

#[test]
fn a_plane_grid_is_points_and_quads() {
    let file = ReadBack::of(write_poly_data(&sample_surface()));
    assert_eq!(file.attribute("Piece", "NumberOfPoints"), "6");
    assert_eq!(file.attribute("Piece", "NumberOfPolys"), "2");
    assert_eq!(file.attribute("Piece", "NumberOfLines"), "0");
    assert_eq!(file.floats("Points", "points_mm")[3..6], [1.0, 0.0, 0.25]);
    assert_eq!(file.integers("Polys", "connectivity"), [0, 1, 4, 3, 1, 2, 5, 4]);
    assert_eq!(file.integers("Polys", "offsets"), [4, 8]);
    assert_eq!(file.array("PointData", "in_plane_um_valid").2, [1, 1, 1, 1, 0, 1]);
}

#[test]
fn grids_one_after_the_other_are_not_joined() {
    let points = (0..10).map(|index| [f64::from(index), 0.0, 0.0]).collect();
    let surfaces = PolyData::plane_grids(points, &[[2, 2], [3, 2]], vec![]).unwrap();
    let file = ReadBack::of(write_poly_data(&surfaces));
    assert_eq!(
        file.integers("Polys", "connectivity"),
        [0, 1, 3, 2, 4, 5, 8, 7, 5, 6, 9, 8]
    );
}

#[test]
fn paths_are_lines_one_after_the_other() {
    let file = ReadBack::of(write_poly_data(&sample_paths()));
    assert_eq!(file.attribute("Piece", "NumberOfLines"), "2");
    assert_eq!(file.integers("Lines", "connectivity"), [0, 1, 2, 3, 4]);
    assert_eq!(file.integers("Lines", "offsets"), [3, 5]);
    assert_eq!(file.floats("Points", "points_mm")[9..12], [5.0, 5.0, 5.0]);
    assert_eq!(
        file.floats("PointData", "feed_mm_per_min"),
        [1.0, 2.0, 3.0, 4.0, 5.0]
    );
}

#[test]
fn a_grid_of_one_row_and_no_points_at_all_are_files_too() {
    let row = PolyData::plane_grids(vec![[0.0; 3], [1.0; 3]], &[[2, 1]], vec![]).unwrap();
    assert_eq!(
        ReadBack::of(write_poly_data(&row)).attribute("Piece", "NumberOfPolys"),
        "0"
    );
    let nothing = PolyData::paths(&[], vec![]).unwrap();
    assert_eq!(
        ReadBack::of(write_poly_data(&nothing)).attribute("Piece", "NumberOfPoints"),
        "0"
    );
}

#[test]
fn an_image_needs_points_spacing_and_a_finite_origin() {
    let given = |origin: [f64; 3], spacing: [f64; 3], counts: [usize; 3]| {
        Image::new(origin, spacing, counts, vec![])
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        given([0.0; 3], [1.0; 3], [3, 0, 2]),
        "the grid has 3 x 0 x 2 points: at least 1 is needed in each direction"
    );
    assert_eq!(
        given([0.0; 3], [1.0, 0.0, 1.0], [1; 3]),
        "the grid spacing is 1 x 0 x 1 mm: each must be above 0 mm"
    );
    assert!(given([0.0; 3], [f64::INFINITY, 1.0, 1.0], [1; 3]).contains("must be above 0 mm"));
    assert!(given([0.0, f64::NAN, 0.0], [1.0; 3], [1; 3]).contains("must be finite"));
}

#[test]
fn arrays_must_fit_the_points_and_differ_in_name() {
    let given = |arrays: Vec<PointArray>| {
        Image::new([0.0; 3], [1.0; 3], [2, 1, 1], arrays)
            .unwrap_err()
            .to_string()
    };
    let two = |name: &str| array(name, PointValues::Scalar(vec![Some(1.0), None]));
    assert_eq!(
        given(vec![array("a", PointValues::Scalar(vec![None]))]),
        "array `a` has 1 values: there are 2 points"
    );
    let huge = Image::new([0.0; 3], [1.0; 3], [usize::MAX, 2, 1], vec![two("a")]);
    assert!(matches!(
        huge,
        Err(VtkError::ArrayLength {
            found: 2,
            points: usize::MAX,
            ..
        })
    ));
    assert_eq!(given(vec![two("a"), two("a")]), "two arrays are called `a`");
    assert_eq!(
        given(vec![two("a"), two("a_valid")]),
        "two arrays are called `a_valid`"
    );
}

#[test]
fn values_that_are_not_finite_are_refused() {
    let strange = [
        PointValues::Scalar(vec![Some(0.0), Some(f64::NAN)]),
        PointValues::Scalar(vec![None, Some(f64::INFINITY)]),
        PointValues::Vector(vec![Some([0.0; 3]), Some([0.0, f64::NAN, 0.0])]),
        PointValues::Vector(vec![None, Some([f64::NEG_INFINITY, 0.0, 0.0])]),
    ];
    for values in strange {
        let error = Image::new([0.0; 3], [1.0; 3], [2, 1, 1], vec![array("a", values)]).unwrap_err();
        assert_eq!(error.to_string(), "array `a` is not finite at point 1");
    }
}

#[test]
fn cells_must_name_points_that_exist() {
    let points = vec![[0.0; 3]; 3];
    let given = |lines: Vec<Vec<usize>>, quads: Vec<[usize; 4]>| {
        PolyData::new(points.clone(), lines, quads, vec![])
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        given(vec![vec![0, 3]], vec![]),
        "a cell names point 3: there are 3"
    );
    assert_eq!(
        given(vec![], vec![[0, 1, 2, 7]]),
        "a cell names point 7: there are 3"
    );
    assert_eq!(
        given(vec![vec![0, 1], vec![2]], vec![]),
        "line 1 has 1 points: at least 2 are needed"
    );
    let error = PolyData::plane_grids(points.clone(), &[[2, 2]], vec![]).unwrap_err();
    assert_eq!(error.to_string(), "3 points do not make grids of 4");
    let error = PolyData::plane_grids(points.clone(), &[[usize::MAX, 2], [1, 1]], vec![]).unwrap_err();
    assert!(error.to_string().starts_with("3 points do not make grids of"));
    let error = PolyData::paths(&[vec![[0.0; 3], [f64::NAN, 0.0, 0.0]]], vec![]).unwrap_err();
    assert!(
        error.to_string().starts_with("point 1 is at (NaN, 0, 0) mm"),
        "{error}"
    );
}

#[test]
fn the_same_grid_gives_the_same_bytes() {
    assert_eq!(write_image(&sample_image()), write_image(&sample_image()));
    assert_eq!(write_poly_data(&sample_paths()), write_poly_data(&sample_paths()));
}
