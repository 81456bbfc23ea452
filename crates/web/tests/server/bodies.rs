//! The bodies of the cell: shapes and poses in the scene, the two nearest at a pose, meshes as STL files in mm.

use serde_json::{Value, json};

use crate::client::{STUDY, folder, serve};

/// A tetrahedron, in inches: corners at the origin and 2 inches along each axis.
const CLAMP: &str = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const CELL: &str = r#"
[part]
box_mm = { from = [-150, -150, -40], to = [150, 150, 0] }
[[obstacle]]
name = "fence"
box_mm = { from = [1600, -900, 0], to = [1650, 900, 2000] }
base_from_obstacle_mm_deg = [0, 20, 0, 0, 0, 90]
[[obstacle]]
name = "clamp"
mesh = "clamp.obj"
mesh_unit = "inch"
base_from_obstacle_mm_deg = [900, 900, 0, 0, 0, 0]
"#;

fn study(least_mm: f64) -> String {
    let tool = "tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0], body = [{ name = \"spindle\", cylinder_mm = { from = \
                [0, 0, 0], to = [0, 0, 100], diameter = 80 } }, { cuts = true, capsule_mm = { from = [0, 0, 100], to = [0, 0, \
                145], diameter = 10 } }] }";
    let plain = "tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }";
    assert!(STUDY.contains(plain));
    format!(
        "least_clearance_mm = {least_mm}\n{}{CELL}",
        STUDY.replace(plain, tool)
    )
}

fn numbers(value: &Value) -> Vec<f64> {
    serde_json::from_value(value.clone()).unwrap()
}

fn near(a: &Value, b: &[f64]) -> bool {
    let a = numbers(a);
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
}

#[test]
fn the_scene_has_the_bodies_and_a_pose_has_their_places() {
    let text = study(0.0);
    let folder = folder(&text);
    std::fs::write(folder.path().join("clamp.obj"), CLAMP).unwrap();
    let served = serve(folder.path());
    let scene = served
        .post("/api/scene", json!({ "text": text, "analysis": "plate" }))
        .json();
    let cell = &scene["cell"];
    let base = numbers(&scene["base_mm"]);
    let [fence, clamp, part] = [0, 1, 2].map(|index| &cell["still"][index]);
    assert_eq!(
        (
            &fence["body"]["name"],
            &fence["body"]["role"],
            &fence["body"]["shape"]["kind"]
        ),
        (&json!("fence"), &json!("obstacle"), &json!("box"))
    );
    assert!(near(&fence["body"]["shape"]["from_mm"], &[1600.0, -900.0, 0.0]));
    assert!(near(
        &fence["pose"]["xyz_mm"],
        &[base[0], base[1] + 20.0, base[2]]
    ));
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert!(near(&fence["pose"]["quaternion_wxyz"], &[half, 0.0, 0.0, half]));
    assert_eq!(
        (&part["body"]["role"], &part["body"]["name"]),
        (&json!("part"), &json!("part"))
    );
    // The part is in the frame of the plane, whose z is the normal of the plate.
    assert!(near(
        &part["pose"]["xyz_mm"],
        &numbers(&scene["plate"]["centre_mm"])
    ));
    assert!(near(&clamp["body"]["shape"]["to_mm"], &[50.8, 50.8, 50.8]));

    let arm = cell["arm"].as_array().unwrap();
    let role = |role: &str| arm.iter().position(|body| body["role"] == role).unwrap();
    assert_eq!(arm[role("holder")]["shape"]["radius_mm"], 40.0);

    let at = json!({ "text": text, "analysis": "plate", "at": { "y_mm": 0, "z_mm": 0 } });
    let pose = served.post("/api/pose", at).json();
    let (drawing, posture) = (&pose["drawings"][0], &pose["answer"]["postures"][0]);
    let bodies = drawing["cell"]["bodies"].as_array().unwrap();
    assert_eq!(bodies.len(), arm.len());
    // Bodies of the tool are in the frame of the flange.
    for tool in ["holder", "cutter"] {
        assert!(
            near(&bodies[role(tool)]["xyz_mm"], &numbers(&drawing["flange_mm"])),
            "{tool}"
        );
    }
    let points = [0, 1].map(|index| numbers(&drawing["cell"]["nearest_mm"][index]));
    let apart = points[0]
        .iter()
        .zip(&points[1])
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt();
    assert!((apart - posture["clearance_mm"].as_f64().unwrap()).abs() < 1e-6);
    for (index, point) in points.iter().enumerate() {
        let in_reference = numbers(&posture["nearest_mm"][index]);
        let in_base: Vec<f64> = in_reference
            .iter()
            .zip(&base)
            .map(|(at, base)| at + base)
            .collect();
        assert!(near(&json!(point), &in_base));
    }
    assert!(apart > 1.0);
    assert_eq!(drawing["cell"]["keeps_clearance"], true);
}

#[test]
fn a_posture_below_the_demanded_clearance_is_marked() {
    let text = study(10_000.0);
    let folder = folder(&text);
    std::fs::write(folder.path().join("clamp.obj"), CLAMP).unwrap();
    let served = serve(folder.path());
    let at = json!({ "text": text, "analysis": "plate", "at": { "y_mm": 0, "z_mm": 0 } });
    let pose = served.post("/api/pose", at).json();
    assert_eq!(pose["drawings"][0]["cell"]["keeps_clearance"], false);
    let answer = served
        .post("/api/answer", json!({ "text": text, "analysis": "rim" }))
        .json();
    let points = answer["paths"][0]["points"].as_u64().unwrap() as usize;
    let keys = json!({ "text": text, "analysis": "rim", "keys": ["in_collision"] });
    let column = served.post("/api/path-columns", keys);
    assert_eq!(column.body, 1.0_f32.to_le_bytes().repeat(points));
    // At spins beyond the limits of the joints, too, the robot reaches the points.
    let map = served
        .post("/api/spin-map", json!({ "text": text, "analysis": "rim" }))
        .json();
    let states: Vec<Vec<u8>> = serde_json::from_value(map["state"].clone()).unwrap();
    assert!(!states.is_empty() && states.iter().flatten().all(|state| *state == 32));
}

#[test]
fn meshes_of_bodies_are_stl_files_in_mm_and_no_other_file_is_sent() {
    let text = study(0.0);
    let folder = folder(&text);
    std::fs::write(folder.path().join("clamp.obj"), CLAMP).unwrap();
    std::fs::write(folder.path().join("secret.stl"), "secret").unwrap();
    let served = serve(folder.path());
    let scene = served
        .post("/api/scene", json!({ "text": text, "analysis": "plate" }))
        .json();
    let key = &scene["cell"]["still"][1]["body"]["shape"]["key"];
    let mesh = |key: &str| {
        let of = json!({ "text": text, "analysis": "plate", "key": key });
        served.post("/api/body-mesh", of)
    };
    let found = mesh(key.as_str().unwrap());
    assert_eq!(
        (found.status, found.header("content-type").as_deref()),
        (200, Some("model/stl"))
    );
    let read = armill_formats::mesh::read("clamp.stl", &found.body).unwrap();
    assert_eq!(read.triangles.len(), 4);
    assert!((read.longest_side() - 50.8).abs() < 1e-5);
    for key in ["secret.stl", "clamp.obj", "../secret.stl", "/etc/passwd", "0", ""] {
        let refused = mesh(key);
        assert_eq!(refused.status, 400, "{key}");
        assert!(!refused.text().contains("solid"), "{key}");
    }
}
