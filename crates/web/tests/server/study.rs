//! The study and its answers: the bytes of the command, the text of the user.

use std::path::Path;

use armill_core::watch::Watch;
use armill_study::live::{PartCache, PartSurfaceQuestion, PathCache, StudyText, answer_json, scene, values};
use armill_study::{output, studies};
use serde_json::{Value, json};

use crate::client::{STUDY, folder, serve};

#[test]
fn answers_are_the_bytes_of_the_command() {
    let served = serve(Path::new("mh12-groove"));
    let found = studies::find(Path::new("mh12-groove")).unwrap();
    let study = found.read().unwrap();
    let done = armill_study::run::run(&study, Watch::NONE).unwrap();
    let command = output::json(&armill_study::answer::answer(&study, &done)).unwrap();
    let on_disk = served.get("/api/study").json();
    assert_eq!(on_disk["writable"], false);
    assert_eq!(on_disk["text"].as_str().unwrap().as_bytes(), found.bytes);
    let answer = served.post(
        "/api/answer",
        json!({ "text": on_disk["text"], "analysis": null }),
    );
    assert_eq!((answer.status, answer.text()), (200, command));

    let rows = armill_study::robot_answers::library_rows().unwrap();
    assert_eq!(
        served.get("/api/robots").text(),
        serde_json::to_string(&rows).unwrap()
    );
}

#[test]
fn points_of_a_path_come_as_columns_and_the_pose_at_one_is_the_same_with_the_path_kept() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let pose = || {
        let of = json!({ "text": STUDY, "analysis": "rim", "at": { "point": 7 }, "case": 1 });
        served.post("/api/pose", of).text()
    };
    let before = pose();
    let view = served.post(
        "/api/view",
        json!({ "text": STUDY, "analysis": "rim", "columns": true }),
    );
    let view = view.json();
    assert_eq!(
        (&view["path"]["points"], &view["scene"]["points"]),
        (&json!(360), &Value::Null)
    );
    assert_eq!(pose(), before);
    let columns = |keys: Value| {
        served.post(
            "/api/path-columns",
            json!({ "text": STUDY, "analysis": "rim", "keys": keys }),
        )
    };
    let given = columns(json!(["xyz_mm", "in_plane_um"]));
    assert_eq!(given.header("content-type").unwrap(), "application/octet-stream");
    assert_eq!(given.body.len(), 360 * 4 * 4);
    let refused = columns(json!(["weight_kg"]));
    assert_eq!((refused.status, refused.kind().as_str()), (400, "invalid-input"));
}

#[test]
fn the_surface_of_a_machined_part_is_sent_as_bytes_and_refused_in_one_sentence() {
    let part = "machined_part = { cell_mm = 4, tool = { diameter_mm = 8 }, stock = { box_mm = { from = [-60, -60, -5], to = [60, 60, 2] } } }\n";
    let text = format!("{STUDY}{part}");
    let folder = folder(&text);
    let served = serve(folder.path());
    let surface = |text: &str, analysis: &str, frame: u32| {
        let of = json!({ "text": text, "analysis": analysis, "frame": frame, "frames": 4 });
        served.post("/api/part-surface", of)
    };
    let view = json!({ "text": text, "analysis": "rim", "columns": true });
    let view = served.post("/api/view", view).json();
    assert_eq!(view["path"]["has_part"], true);
    let expected = |frame: usize| {
        let text = StudyText {
            shown: "study.toml",
            folder: folder.path(),
            bytes: text.as_bytes(),
        };
        let question = PartSurfaceQuestion {
            analysis: Some("rim"),
            frame,
            frames: 4,
        };
        let found = PartCache::default().surface(text, &question, &PathCache::default(), Watch::NONE);
        found.unwrap()
    };
    for frame in [4, 2, 0] {
        let given = surface(&text, "rim", frame);
        assert_eq!(given.status, 200, "{}", given.text());
        assert_eq!(given.header("content-type").unwrap(), "application/octet-stream");
        assert!(given.body == expected(frame as usize), "frame {frame}");
    }
    for (text, analysis, frame, message) in [
        (&text[..], "rim", 5, "frame 5 is out of range: 0 to 4"),
        (&text, "plate", 4, "the analysis `plate` has no `machined_part`"),
        (STUDY, "rim", 4, "the analysis `rim` has no `machined_part`"),
    ] {
        let refused = surface(text, analysis, frame);
        assert_eq!((refused.status, refused.kind().as_str()), (400, "invalid-input"));
        assert_eq!(refused.json()["error"]["message"], message);
    }
}

#[test]
fn values_scene_pose_table_and_pictures_are_those_of_the_study() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let text = StudyText {
        shown: "study.toml",
        folder: folder.path(),
        bytes: STUDY.as_bytes(),
    };
    let of = |path: &str, analysis: &str| served.post(path, json!({ "text": STUDY, "analysis": analysis }));
    let same = |body: String, value: String| assert_eq!(body, value);
    same(
        of("/api/values", "rim").text(),
        serde_json::to_string(&values(text, Some("rim")).unwrap()).unwrap(),
    );
    let given = scene(text, Some("rim"), Watch::NONE).unwrap();
    same(
        of("/api/scene", "rim").text(),
        serde_json::to_string(&given).unwrap(),
    );
    same(
        of("/api/answer", "plate").text(),
        answer_json(text, Some("plate"), Watch::NONE).unwrap(),
    );

    let pose = served.post(
        "/api/pose",
        json!({ "text": STUDY, "analysis": "plate", "at": { "y_mm": 0, "z_mm": 0 }, "case": 2 }),
    );
    let pose = pose.json();
    let postures = pose["answer"]["postures"].as_array().unwrap().len();
    assert!(postures > 1);
    assert_eq!(pose["drawings"].as_array().unwrap().len(), postures);
    assert_eq!(pose["in_plane"][0].as_array().unwrap().len(), 2);

    let csv = of("/api/table", "rim");
    assert_eq!(csv.header("content-type").unwrap(), "text/csv; charset=utf-8");
    assert_eq!(csv.text().lines().count(), 361);
    let pictures = of("/api/pictures", "rim").json();
    let name = pictures["pictures"][0]["name"].as_str().unwrap();
    let png = served.post(
        "/api/picture.png",
        json!({ "text": STUDY, "analysis": "rim", "name": name }),
    );
    assert_eq!(&png.body[..8], b"\x89PNG\r\n\x1a\n");
    let none = served.post(
        "/api/picture.png",
        json!({ "text": STUDY, "analysis": "rim", "name": "none" }),
    );
    assert_eq!((none.status, none.kind().as_str()), (400, "invalid-input"));
}

#[test]
fn an_invalid_study_is_shown_with_its_problems_at_their_places() {
    let broken = STUDY.replace("step_mm = 20", "step_mm = -20");
    let folder = folder(&broken);
    let served = serve(folder.path());
    let given = served.get("/api/study");
    assert_eq!(given.status, 200);
    let problem = &given.json()["problems"][0];
    assert_eq!(
        (
            problem["line"].as_u64(),
            problem["file"].as_str().unwrap().ends_with("study.toml")
        ),
        (Some(7), true)
    );
    assert!(problem["column"].as_u64().unwrap() > 1 && problem["hint"].is_string());
    let answer = served.post("/api/answer", json!({ "text": broken, "analysis": "plate" }));
    assert_eq!(
        (
            answer.status,
            answer.json()["error"]["problems"][0]["line"].as_u64()
        ),
        (422, Some(7))
    );
    let no_toml = served.post("/api/check", json!({ "text": "tolerance_um = = 3" }));
    assert_eq!(
        (no_toml.status, no_toml.json()["problems"][0]["line"].as_u64()),
        (200, Some(1))
    );
}

#[test]
fn the_study_is_written_only_over_what_was_read() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let file = folder.path().join("study.toml");
    let put = |text: &str, version: &Value| {
        served.analysis(
            "PUT",
            "/api/study",
            json!({ "text": text, "version": version }).to_string().as_bytes(),
        )
    };
    let read = served.get("/api/study").json();
    let new = STUDY.replace("100 #", "80 #");
    let written = put(&new, &read["version"]);
    assert_eq!(written.status, 200);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), new);
    assert_ne!(written.json()["version"], read["version"]);
    // The version that was read first is old now.
    let old = put(STUDY, &read["version"]);
    assert_eq!((old.status, old.kind().as_str()), (409, "conflict"));
    // So is any, where an editor has been at the file.
    std::fs::write(&file, STUDY).unwrap();
    assert_eq!(put(&new, &written.json()["version"]).status, 409);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), STUDY);

    let example = serve(Path::new("mh12-groove"));
    let read = example.get("/api/study").json();
    let refused = example.analysis(
        "PUT",
        "/api/study",
        json!({ "text": "", "version": read["version"] })
            .to_string()
            .as_bytes(),
    );
    assert_eq!(refused.status, 403);
}

#[test]
fn changes_by_other_programs_are_seen_and_a_deleted_file_is_made_again() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let file = folder.path().join("study.toml");
    let version = || served.get("/api/study/version").json();
    let read = served.get("/api/study").json();
    assert_eq!(version(), json!({ "version": read["version"], "exists": true }));
    std::fs::write(&file, STUDY.replace("100 #", "80 #")).unwrap();
    assert_ne!(version()["version"], read["version"]);
    std::fs::remove_file(&file).unwrap();
    let gone = version();
    assert_eq!(gone["exists"], false);
    let on_disk = served.get("/api/study").json();
    assert_eq!(
        (&on_disk["exists"], &on_disk["version"], &on_disk["text"]),
        (&json!(false), &gone["version"], &json!(""))
    );
    let put = |version: &Value| {
        let body = json!({ "text": STUDY, "version": version }).to_string();
        served.analysis("PUT", "/api/study", body.as_bytes())
    };
    // A page that has not seen that it is gone gets a conflict.
    let refused = put(&read["version"]);
    assert_eq!((refused.status, refused.kind().as_str()), (409, "conflict"));
    assert!(refused.text().contains("deleted") && !file.exists());
    assert_eq!(put(&gone["version"]).status, 200);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), STUDY);
    assert_eq!(version()["version"], read["version"]);
    // The version of a missing file is not one of any other.
    assert_eq!(put(&gone["version"]).status, 409);
}

#[test]
fn a_study_is_served_at_the_same_port_again_while_that_is_free() {
    let (one, other) = (folder(STUDY), folder(STUDY));
    let first = serve(one.path());
    let port = first.port;
    let identity = first.get("/api/study").json()["identity"].clone();
    assert!(identity.as_str().unwrap().ends_with("study.toml"));
    // The port is taken: another one, and the same study.
    let second = serve(one.path());
    assert_ne!(second.port, port);
    assert_eq!(second.get("/api/study").json()["identity"], identity);
    drop((first, second));
    assert_eq!(serve(one.path()).port, port);
    assert_ne!(serve(other.path()).get("/api/study").json()["identity"], identity);
}

#[test]
fn robots_without_known_compliances_have_a_class_that_can_be_assumed() {
    let served = serve(Path::new("mh12-groove"));
    let rows = served.get("/api/robots").json();
    let class = |name: &str| {
        let row = rows.as_array().unwrap().iter().find(|row| row["name"] == name);
        row.unwrap()["compliance_class"].clone()
    };
    assert_eq!(class("yaskawa/mh12"), Value::Null);
    assert_eq!(class("kuka/kr120r2500pro"), "heavy");
    // It is enough for an answer, which says so; taken away, the known ones of another robot are used.
    let change = |text: &str, changes: Value| {
        served
            .post(
                "/api/change",
                json!({ "text": text, "analysis": null, "changes": changes }),
            )
            .json()
    };
    let refused = change(STUDY, json!([{ "key": "robot", "value": "kuka/kr120r2500pro" }]));
    assert!(
        refused["problems"][0]["message"]
            .as_str()
            .unwrap()
            .starts_with("no joint compliance is known for robot `kuka/kr120r2500pro`")
    );
    let assumed = change(
        refused["text"].as_str().unwrap(),
        json!([{ "key": "compliance.class", "value": "heavy" }]),
    );
    assert_eq!(assumed["problems"], json!([]));
    let text = assumed["text"].as_str().unwrap();
    let answer = served
        .post("/api/answer", json!({ "text": text, "analysis": "plate" }))
        .json();
    assert_eq!(answer["robot"]["compliance_assumed"], true);
    let back = json!([{ "key": "compliance", "value": null }, { "key": "robot", "value": "yaskawa/mh12" }]);
    assert_eq!(change(text, back)["text"], STUDY);
}

#[test]
fn a_change_keeps_the_comments() {
    let served = serve(Path::new("mh12-groove"));
    let changes =
        json!([{ "key": "plane.centre_mm", "value": [900, 0, 700] }, { "key": "tolerance_um", "value": 50 }]);
    let whole = served
        .post(
            "/api/change",
            json!({ "text": STUDY, "analysis": null, "changes": changes }),
        )
        .json();
    let expected = STUDY
        .replace("[1000, 0, 800]", "[900, 0, 700]")
        .replace("100 #", "50 #");
    assert_eq!(whole["text"], expected);
    let changes = json!([{ "key": "posture.branch", "value": "front elbow-up no-flip" }]);
    let own = served
        .post(
            "/api/change",
            json!({ "text": STUDY, "analysis": "rim", "changes": changes }),
        )
        .json();
    let text = own["text"].as_str().unwrap();
    assert!(
        text.contains("# of the drawing")
            && text.contains("posture = { branch = \"front elbow-up no-flip\" }"),
        "{text}"
    );
    assert_eq!(
        own["analyses"][1]["keys"],
        json!(["circle.radius_mm", "kind", "name", "posture.branch"])
    );
    assert_eq!(own["problems"], json!([]));
}

#[test]
fn a_view_equals_change_answer_values_and_scene_in_sequence() {
    let served = serve(Path::new("mh12-groove"));
    for analysis in ["plate", "rim"] {
        let changes = json!([
            { "key": "plane.step_mm", "value": 25 },
            { "key": "tolerance_um", "value": 70, "whole": true },
        ]);
        let of = json!({ "text": STUDY, "analysis": analysis, "changes": changes });
        let arm = json!({ "follow": "worst" });
        let view = served.post(
            "/api/view",
            json!({ "text": STUDY, "analysis": analysis, "changes": changes, "arm": arm }),
        );
        assert_eq!(view.status, 200, "{}", view.text());
        let changed = served.post("/api/change", of.clone()).json();
        assert_eq!(changed["problems"], json!([]));
        let text = changed["text"].as_str().unwrap();
        assert!(
            text.contains("tolerance_um = 70 # of the drawing") && text.contains("plane = { step_mm = 25 }"),
            "{text}"
        );
        let body = view.text();
        for (key, path) in [
            ("answer", "/api/answer"),
            ("values", "/api/values"),
            ("scene", "/api/scene"),
        ] {
            let alone = served
                .post(path, json!({ "text": text, "analysis": analysis }))
                .text();
            // The bytes themselves, not only their meaning.
            assert!(
                body.contains(&format!("\"{key}\":{}", alone.trim_end())),
                "{analysis} {key}"
            );
        }
        assert_eq!(
            (&view.json()["text"], &view.json()["analyses"]),
            (&changed["text"], &changed["analyses"])
        );
        let arm = &view.json()["arm"];
        assert_eq!(arm["at"], view.json()["extremes"][0]["worst"]);
        let pose = served.post(
            "/api/pose",
            json!({ "text": text, "analysis": analysis, "at": arm["at"], "case": arm["case"] }),
        );
        assert!(
            body.contains(&format!("\"pose\":{}", pose.text().trim_end())),
            "{analysis}"
        );
        // Without `arm` in the request there is none in the answer.
        assert!(served.post("/api/view", of).json()["arm"].is_null());
    }
    let refused = |changes: Value| {
        served.post(
            "/api/view",
            json!({ "text": STUDY, "analysis": "plate", "changes": changes }),
        )
    };
    let wrong = refused(json!([{ "key": "plane.step_mm", "value": -1 }]));
    assert_eq!((wrong.status, wrong.kind().as_str()), (422, "invalid-input"));
    assert!(
        wrong.json()["error"]["problems"][0]["message"]
            .as_str()
            .unwrap()
            .contains("step_mm")
    );
    assert_eq!(refused(json!([{ "key": "analysis", "value": 1 }])).status, 422);
    assert_eq!(refused(json!([{ "value": 1 }])).status, 400);
}

#[test]
fn tables_and_schema_describe_the_fields() {
    let served = serve(Path::new("mh12-groove"));
    let schema = served.get("/api/schema");
    let command = armill_formats::document::schema_json::<armill_study::file::format::StudyFile>();
    assert_eq!((schema.status, schema.text()), (200, command));
    let given = served
        .post(
            "/api/tables",
            json!({ "text": STUDY.replace("step_mm = 20", "step_mm = -20") }),
        )
        .json();
    assert_eq!(given["values"]["analysis"][1]["circle"]["radius_mm"], 50);
    let problem = &given["problems"][0]["span"]["start"];
    let places = given["places"].as_array().unwrap();
    let place = places
        .iter()
        .find(|place| place["path"] == "plane.step_mm")
        .unwrap();
    assert_eq!(&place["bytes"][0], problem);
    let broken = served
        .post("/api/tables", json!({ "text": "tolerance_um = = 3" }))
        .json();
    assert!(broken["values"].is_null() && broken["problems"][0]["line"] == 1);
}

/// An arm whose first two links name meshes.
const ARM: &str = r#"<robot name="arm">
<link name="foot"><visual><geometry><mesh filename="package://arm/meshes/foot.stl" scale="0.001 0.001 0.001"/></geometry></visual></link>
<link name="rod"><visual><geometry><mesh filename="package://arm/meshes/rod.stl"/></geometry></visual></link>
<joint name="A" type="revolute"><parent link="foot"/><child link="rod"/><origin xyz="0 0 0.4"/><axis xyz="0 0 1"/><limit lower="-3" upper="3"/></joint>
<link name="l2"/><joint name="B" type="revolute"><parent link="rod"/><child link="l2"/><origin xyz="0.1 0 0"/><axis xyz="0 1 0"/><limit lower="-3" upper="3"/></joint>
<link name="l3"/><joint name="C" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="0 0 0.6"/><axis xyz="0 1 0"/><limit lower="-3" upper="3"/></joint>
<link name="l4"/><joint name="D" type="revolute"><parent link="l3"/><child link="l4"/><origin xyz="0.2 0 0.2"/><axis xyz="1 0 0"/><limit lower="-3" upper="3"/></joint>
<link name="l5"/><joint name="E" type="revolute"><parent link="l4"/><child link="l5"/><origin xyz="0.4 0 0"/><axis xyz="0 1 0"/><limit lower="-3" upper="3"/></joint>
<link name="l6"/><joint name="F" type="revolute"><parent link="l5"/><child link="l6"/><origin xyz="0.1 0 0"/><axis xyz="1 0 0"/><limit lower="-3" upper="3"/></joint>
</robot>"#;

#[test]
fn only_meshes_that_the_robot_names_are_served() {
    let study = STUDY.replace(
        "\"yaskawa/mh12\"",
        "\"arm.urdf\"\ncompliance = { rad_per_n_m = [1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6], source = \"made up\" }",
    );
    let folder = folder(&study);
    std::fs::write(folder.path().join("arm.urdf"), ARM).unwrap();
    std::fs::write(folder.path().join("secret.stl"), "secret").unwrap();
    let served = serve(folder.path());
    let pose = || {
        served
            .post(
                "/api/pose",
                json!({ "text": study, "analysis": "plate", "at": { "joints_deg": [90, 0, 0, 0, 0, 0] } }),
            )
            .json()
    };
    // Not all are there: the arm is drawn from its chain.
    assert_eq!(pose()["drawings"][0]["meshes"], json!([]));
    std::fs::create_dir(folder.path().join("meshes")).unwrap();
    std::fs::write(folder.path().join("meshes/foot.stl"), "solid foot\nendsolid\n").unwrap();
    std::fs::write(folder.path().join("meshes/rod.stl"), "solid rod\nendsolid\n").unwrap();
    let meshes = pose()["drawings"][0]["meshes"].clone();
    assert_eq!(
        (&meshes[0]["scale_mm"], &meshes[0]["xyz_mm"]),
        (&json!([1.0, 1.0, 1.0]), &json!([0.0, 0.0, 0.0]))
    );
    // A quarter turn about z, at the joint.
    assert_eq!(
        (&meshes[1]["scale_mm"], &meshes[1]["xyz_mm"]),
        (&json!([1000.0, 1000.0, 1000.0]), &json!([0.0, 0.0, 400.0]))
    );
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let turn: Vec<f64> = serde_json::from_value(meshes[1]["quaternion_wxyz"].clone()).unwrap();
    assert!(
        turn.iter()
            .zip([half, 0.0, 0.0, half])
            .all(|(a, b)| (a - b).abs() < 1e-9),
        "{turn:?}"
    );
    let mesh = |file: &str| served.post("/api/mesh", json!({ "text": study, "file": file }));
    let rod = mesh("package://arm/meshes/rod.stl");
    assert_eq!((rod.status, rod.text().as_str()), (200, "solid rod\nendsolid\n"));
    assert_eq!(rod.header("content-type").as_deref(), Some("model/stl"));
    for file in [
        "secret.stl",
        "meshes/rod.stl",
        "../secret.stl",
        "package://arm/../secret.stl",
        "/etc/passwd",
        "",
    ] {
        assert_eq!(mesh(file).status, 400, "{file}");
    }
}

#[test]
fn every_documented_path_answers_by_its_method() {
    let served = serve(Path::new("mh12-groove"));
    let document = served.get("/api/openapi.json").json();
    assert_eq!(document, armill_web::openapi_document());
    for (path, methods) in document["paths"].as_object().unwrap() {
        let path = path.replace("{id}", "no-such").replace("{path}", "no-such");
        for method in methods.as_object().unwrap().keys() {
            let answer = served.analysis(&method.to_uppercase(), &path, b"");
            assert_ne!(answer.status, 405, "{method} {path}");
            assert!(
                !answer.text().contains("there is nothing at this path"),
                "{method} {path}"
            );
        }
        assert_eq!(served.analysis("PATCH", &path, b"").status, 405, "{path}");
    }
}

#[test]
fn the_page_knows_this_server() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web/openapi.json");
    // A checkout without the page has none.
    let Ok(text) = std::fs::read_to_string(file) else {
        return;
    };
    let known: Value = serde_json::from_str(&text).unwrap();
    assert!(
        known == armill_web::openapi_document(),
        "stale: `cargo xtask web --describe` writes web/openapi.json and the types again"
    );
}
