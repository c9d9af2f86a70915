//! The contour of an open program, in which blocks are found by their places (R12.17).

use serde_json::{Value, json};

use super::client::{Client, uri};
use crate::folder::Bench;

const REQUEST_FAILED: i32 = -32803;
const CANCELLED: i32 = -32800;

/// Program in which X reverses in lines 4 and 5, without compensation in line 7.
const PART: &str = "\
G90 G01 F2000
; the outline
X0 Y0
G02 X10 Y10 J10
G02 X0 Y20 I-10
X[COMP OFF FRICT]
G02 X0 Y0 J-10
LL POCKET
M30
%L POCKET
G01 X5 Y5
M17
";

fn start() -> Value {
    json!({ "capabilities": {}, "initializationOptions": { "frictcomp": {
        "contour": { "plant": "mid", "start": { "X": 0, "Y": 0 } },
    } } })
}

fn of(uri: &str) -> Value {
    json!({ "textDocument": { "uri": uri } })
}

/// Returns the contour of a program on the machine of the tests.
fn contour(text: &str, params: &Value) -> (Bench, Value, String) {
    let bench = Bench::new(&[("a.nc", "M30\n")]);
    let uri = uri(&bench.folder().join("a.nc"));
    let mut client = Client::with(params);
    client.open(&uri, text);
    let contour = client.ask("frictcomp/contour", &of(&uri));
    client.leave();
    (bench, contour, uri)
}

fn lines(contour: &Value) -> Vec<u64> {
    let stretches = contour["stretches"].as_array().expect("a list").iter();
    let mut lines: Vec<u64> = stretches
        .map(|it| it["line"].as_u64().expect("a line"))
        .collect();
    lines.dedup();
    lines
}

#[test]
fn each_block_has_its_place_in_the_picture() {
    // R12.17
    let (_bench, contour, uri) = contour(PART, &start());
    assert_eq!(contour["files"], json!([uri]));
    // As in the editor: the file on the disk moves nothing.
    assert_eq!(lines(&contour), [3, 4, 6, 10]);
    let svg = contour["svg"].as_str().expect("a picture");
    assert!(svg.starts_with("<svg ") && svg.contains("Contour of a.nc"));
    let stretches = contour["stretches"].as_array().expect("a list");
    // R12.18: the machine time up to each of them.
    let ends: Vec<f64> = stretches
        .iter()
        .map(|it| it["end"].as_f64().expect("a time"))
        .collect();
    assert!(ends.is_sorted() && ends[0] > 0.0, "{ends:?}");
    let points = |at: usize| stretches[at]["points"].as_array().expect("points");
    for at in 1..stretches.len() {
        // The path continues where it was.
        assert_eq!(points(at - 1).last(), points(at).first(), "{at}");
    }
    let first = points(0).first().expect("a point");
    assert_ne!(Some(first), points(0).last());
    // The full circle ends where it began, within a cycle.
    let [begin, end] = [first, points(2).last().expect("a point")]
        .map(|at| [0, 1].map(|axis| at[axis].as_f64().expect("a number")));
    assert!((begin[0] - end[0]).abs() < 5.0 && (begin[1] - end[1]).abs() < 5.0);
}

#[test]
fn reversals_lead_to_their_blocks_the_worst_first() {
    // R12.17
    let (_bench, contour, _) = contour(PART, &start());
    let worst = contour["worst"].as_array().expect("a list");
    assert_eq!(worst[0]["line"], 6, "{worst:?}");
    let words = worst[0]["words"].as_str().expect("words");
    assert!(
        words.starts_with("line 7: X reverses") && words.contains("inactive"),
        "{words}"
    );
    let report = &contour["report"];
    assert_eq!(report["headline"]["standing"], "bad");
    let words = report.to_string();
    assert!(
        words.contains("plant mid") && words.contains("without compensation"),
        "{words}"
    );
}

#[test]
fn what_a_contour_rests_on_is_said() {
    // R12.17
    let (_bench, usual, _) = contour(PART, &json!({ "capabilities": {} }));
    let remarks = usual["remarks"].to_string();
    assert!(remarks.contains("the preset `stiff`"), "{remarks}");
    assert!(!remarks.contains("no machine"), "{remarks}");

    let bench = Bench::new(&[("a.nc", "M30\n")]);
    bench.write(
        "drives.toml",
        include_str!("../../../../../docs/assets/plant.toml"),
    );
    let own = json!({ "capabilities": {}, "rootUri": uri(bench.folder()), "initializationOptions": {
        "contour": { "plant": "drives.toml" },
    } });
    let a = uri(&bench.folder().join("a.nc"));
    let mut client = Client::with(&own);
    client.open(&a, PART);
    let of_file = client.ask("frictcomp/contour", &of(&a));
    let remarks = of_file["remarks"].to_string();
    assert!(!remarks.contains("preset"), "{remarks}");
    client.drop_all();

    let mut client = Client::new();
    client.open("untitled:part.nc", PART);
    let bare = client.ask("frictcomp/contour", &of("untitled:part.nc"));
    let remarks = bare["remarks"].to_string();
    assert!(remarks.contains("no machine is described"), "{remarks}");
    client.drop_all();
}

#[test]
fn where_nothing_is_driven_there_is_no_picture() {
    // R12.17
    let (_bench, still, _) = contour("X[COMP OFF FRICT]\nM30\n", &start());
    assert_eq!(still["svg"], Value::Null);
    assert_eq!(still["stretches"], json!([]));
    assert!(
        still["remarks"]
            .to_string()
            .contains("no motion was driven"),
        "{still}"
    );
    assert!(
        still["report"].to_string().contains("not judged"),
        "{still}"
    );
}

#[test]
fn a_contour_that_cannot_be_driven_says_why() {
    // R12.17
    let refused = |settings: Value| -> String {
        let bench = Bench::new(&[("a.nc", "M30\n")]);
        let uri = uri(&bench.folder().join("a.nc"));
        let options = json!({ "contour": settings });
        let params = json!({ "capabilities": {}, "initializationOptions": options });
        let mut client = Client::with(&params);
        client.open(&uri, PART);
        let id = client.begin("frictcomp/contour", &of(&uri));
        let error = client.answer(&id).response_result.expect_err("a refusal");
        assert_eq!(error.code, REQUEST_FAILED, "{error:?}");
        client.leave();
        error.message
    };
    let plant = refused(json!({ "plant": "hard" }));
    assert!(plant.contains("hard"), "{plant}");
    let view = refused(json!({ "plane": ["X", "Q"] }));
    assert!(
        view.contains("no axis `Q`") && view.contains("frictcomp.contour.plane"),
        "{view}"
    );
    let start = refused(json!({ "start": { "U": 1 } }));
    assert!(
        start.contains("no axis `U`") && start.contains("frictcomp.contour.start"),
        "{start}"
    );
}

#[test]
fn a_contour_that_nobody_waits_for_is_stopped() {
    // R12.17
    let bench = Bench::new(&[("a.nc", "M30\n")]);
    let uri = uri(&bench.folder().join("a.nc"));
    let mut client = Client::with(&start());
    // Hours of machine time in one pass, repeated up to the budget of cycles.
    let long = "G90 G01 F1\nP1=0\n$WHILE P1<9\nX1000\nX0\n$ENDWHILE\nM30\n";
    client.open(&uri, long);
    let id = client.begin("frictcomp/contour", &of(&uri));
    client.tell("$/cancelRequest", &json!({ "id": 2 }));
    let stopped = client.answer(&id).response_result.expect_err("cancelled");
    assert_eq!(stopped.code, CANCELLED);
    // Quick answers do not wait for it.
    client.settle(&uri);
    client.drop_all();
}
