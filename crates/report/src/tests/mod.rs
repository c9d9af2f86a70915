//! Every format over one handmade session.

mod pictures;
mod player;

use std::io::{self, Write};

use player::{OFF, ON, Player, about, machine, play};
use proptest::prelude::*;

use crate::*;
use frictcomp::comp::{Kind, KindSet};
use frictcomp::diagnostic::Code;
use frictcomp::machine::Machine;
use frictcomp::text::shown_json;
use frictcomp::timeline::{Record, Sink};

/// Returns everything that a format writes.
fn written<'a, R: Report + 'a>(
    bytes: &'a mut Vec<u8>,
    make: impl FnOnce(&'a mut Vec<u8>) -> R,
    play: impl FnOnce(&mut dyn Sink),
) {
    let mut report = make(bytes);
    play(&mut report);
    report.finish().unwrap();
}

fn text(options: TextOptions, play: impl FnOnce(&mut dyn Sink)) -> String {
    let mut bytes = Vec::new();
    written(&mut bytes, |bytes| Text::new(bytes, options), play);
    String::from_utf8(bytes).unwrap()
}

fn ndjson(view: View) -> String {
    let mut bytes = Vec::new();
    let machine = machine(&[]);
    written(
        &mut bytes,
        |bytes| Ndjson::new(bytes, view),
        |sink| {
            play(&machine, sink);
        },
    );
    String::from_utf8(bytes).unwrap()
}

fn csv(view: View) -> String {
    let mut bytes = Vec::new();
    let machine = machine(&[]);
    written(
        &mut bytes,
        |bytes| Csv::new(bytes, view),
        |sink| {
            play(&machine, sink);
        },
    );
    String::from_utf8(bytes).unwrap()
}

#[test]
fn the_example_as_json_lines() {
    // 9.2
    insta::assert_snapshot!(ndjson(View::default()), @r##"
    {"record":"session","schema":2,"tool":"frictcomp 0.1.0","axes":["X","Y","Z"],"friction":{"X":"active","Y":"active","Z":"unconfigured"}}
    {"record":"program","program":1,"file":"demo.nc","name":"DEMO","friction":{"X":"active","Y":"active","Z":"unconfigured"}}
    {"record":"block","program":1,"seq":1,"file":"demo.nc","line":3,"n":15,"text":"N15 X[COMP ON FRICT] ;Activates X axis","changes":[],"friction":{"X":"active","Y":"active","Z":"unconfigured"}}
    {"record":"diagnostic","program":1,"seq":1,"code":"FC402","severity":"info","file":"demo.nc","line":3,"column":5,"end_line":3,"end_column":21,"axis":"X","message":"`X[COMP ON FRICT]` changes nothing, friction compensation of `X` is active already","help":[]}
    {"record":"block","program":1,"seq":2,"file":"demo.nc","line":4,"n":25,"text":"N25 Y[COMP OFF FRICT] ;Deactivates \"Y\" axis","changes":[{"axis":"Y","kind":"FRICT","from":"active","to":"inactive"}],"friction":{"X":"active","Y":"inactive","Z":"unconfigured"}}
    {"record":"block","program":1,"seq":3,"file":"demo.nc","line":5,"n":35,"text":"N35 X22 Y33 Z44","changes":[],"friction":{"X":"active","Y":"inactive","Z":"unconfigured"}}
    {"record":"block","program":1,"seq":4,"file":"demo.nc","line":6,"n":45,"text":"N45 X[COMP OFF FRICT] ;Deactivates X axis","changes":[{"axis":"X","kind":"FRICT","from":"active","to":"inactive"}],"friction":{"X":"inactive","Y":"inactive","Z":"unconfigured"}}
    {"record":"block","program":1,"seq":5,"file":"demo.nc","line":7,"n":55,"text":"N55 M30 ;Program end","changes":[],"friction":{"X":"inactive","Y":"inactive","Z":"unconfigured"}}
    {"record":"diagnostic","program":1,"seq":2,"code":"FC401","severity":"warning","file":"demo.nc","line":4,"column":5,"end_line":4,"end_column":22,"axis":"Y","message":"friction compensation of `Y` is left inactive","help":["add `Y[COMP ON FRICT]` before M30"]}
    {"record":"end","program":1,"seq":5,"by":"M30","friction":{"X":"inactive","Y":"inactive","Z":"unconfigured"}}
    {"record":"summary","programs":1,"blocks":5,"errors":0,"warnings":2,"opaque":{"#HSC":3},"friction":{"X":"inactive","Y":"inactive","Z":"unconfigured"},"headline":{"standing":"bad","text":"X and Y are left off (assuming friction compensation on X and Y)"}}
    "##);
}

proptest! {
    #[test]
    fn lines_are_records_in_their_serialised_form(
        blocks in prop::collection::vec(
            (1..200_u32, "(N[0-9]{1,6} )?([ -~]{0,40}|\\PC{0,9}|.{0,9})", 0..5),
            1..12,
        ),
    ) {
        let machine = machine(&[]);
        let (mut bytes, mut expected) = (Vec::new(), String::new());
        written(&mut bytes, |bytes| Ndjson::new(bytes, View::default()), |report| {
            let mut both = |record: &Record<'_>| {
                let line = serde_json::to_string(record).unwrap();
                expected.extend([&*shown_json(&line), "\n"]);
                report.record(record)
            };
            let mut player = Player::new(&machine, &mut both);
            player.begin();
            for (line, text, command) in &blocks {
                let command = match command {
                    0 => Some(("X", ON)),
                    1 => Some(("X", OFF)),
                    _ => None,
                };
                let _ = player.text(*line, text, command, &[]);
            }
            player.end(&[]);
        });
        // The summary ends with the verdict.
        let text = String::from_utf8(bytes).unwrap();
        let records = text.split(r#","headline":"#).next();
        prop_assert_eq!(records, expected.strip_suffix("}\n"));
    }
}

#[test]
fn other_kinds_come_in_an_object_of_their_own() {
    // R9.12
    let kinds = KindSet::of(Kind::Frict).union(KindSet::of(Kind::Lead));
    let text = ndjson(View {
        kinds,
        ..View::default()
    });
    let first = text.lines().next().unwrap();
    assert!(first.ends_with(
        r#""friction":{"X":"active","Y":"active","Z":"unconfigured"},"compensation":{"X":{"LEAD":"unconfigured","FRICT":"active"},"Y":{"LEAD":"unconfigured","FRICT":"active"},"Z":{"LEAD":"unconfigured","FRICT":"unconfigured"}}}"#
    ), "{first}");
}

#[test]
fn only_changed_blocks() {
    let view = View {
        blocks: Blocks::Changed,
        ..View::default()
    };
    let lines = ndjson(view);
    assert_eq!(lines.matches("\"record\":\"block\"").count(), 3, "{lines}");
    let rows = csv(view);
    let lines: Vec<&str> = rows.lines().collect();
    assert_eq!(lines.len(), 5, "{rows}");
    assert!(lines[4].ends_with(",FC401,"), "{rows}");
}

#[test]
fn the_document_holds_the_same_records_as_the_lines() {
    let machine = machine(&[]);
    let mut bytes = Vec::new();
    written(
        &mut bytes,
        |bytes| Json::new(bytes, View::default()),
        |sink| {
            play(&machine, sink);
        },
    );
    let document: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
    let lines: Vec<serde_json::Value> = ndjson(View::default())
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(document["schema"], 2);
    assert_eq!(document["records"], serde_json::Value::Array(lines));

    let mut empty = Vec::new();
    written(
        &mut empty,
        |bytes| Json::new(bytes, View::default()),
        |_| {},
    );
    let document: serde_json::Value = serde_json::from_slice(&empty).unwrap();
    assert_eq!(document["records"].as_array().unwrap().len(), 0);
}

#[test]
fn the_example_as_rows() {
    // R9.15
    insta::assert_snapshot!(csv(View::default()), @r##"
    program,seq,file,line,n,text,X,Y,Z,changes,codes,branch
    1,1,demo.nc,3,15,N15 X[COMP ON FRICT] ;Activates X axis,active,active,unconfigured,,FC402,
    1,2,demo.nc,4,25,"N25 Y[COMP OFF FRICT] ;Deactivates ""Y"" axis",active,inactive,unconfigured,Y:FRICT:active>inactive,,
    1,3,demo.nc,5,35,N35 X22 Y33 Z44,active,inactive,unconfigured,,,
    1,4,demo.nc,6,45,N45 X[COMP OFF FRICT] ;Deactivates X axis,inactive,inactive,unconfigured,X:FRICT:active>inactive,,
    1,5,demo.nc,7,55,N55 M30 ;Program end,inactive,inactive,unconfigured,,FC401,
    "##);
}

#[test]
fn rows_read_back() {
    let rows = csv(View::default());
    let mut reader = ::csv::Reader::from_reader(rows.as_bytes());
    let header = reader.headers().unwrap().clone();
    assert_eq!(header.iter().nth(6), Some("X"));
    let records: Vec<_> = reader.records().map(Result::unwrap).collect();
    assert_eq!(
        &records[1][5],
        "N25 Y[COMP OFF FRICT] ;Deactivates \"Y\" axis"
    );
}

#[test]
fn the_example_as_text() {
    let machine = machine(&[]);
    let shown = text(TextOptions::default(), |sink| play(&machine, sink));
    assert!(shown.lines().all(|line| line.chars().count() <= 80));
    assert!(shown.lines().all(|line| !line.ends_with(' ')));
    insta::assert_snapshot!(shown, @r#"
    demo.nc  %DEMO

      line  block                               X           Y           Z
            at start                            active      active      unconfigured
         3  N15 X[COMP ON FRICT] ;Activates X…  active      active      unconfigured
            info[FC402]: `X[COMP ON FRICT]` changes nothing, friction compensation
                         of `X` is active already
             --> demo.nc:3:5
              |
            3 | N15 X[COMP ON FRICT] ;Activates X axis
              |     ^^^^^^^^^^^^^^^^
         4  N25 Y[COMP OFF FRICT] ;Deactivate…  active      inactive ◄  unconfigured
         5  N35 X22 Y33 Z44                     active      inactive    unconfigured
         6  N45 X[COMP OFF FRICT] ;Deactivate…  inactive ◄  inactive    unconfigured
         7  N55 M30 ;Program end                inactive    inactive    unconfigured
            end by M30                          inactive    inactive    unconfigured
            warning[FC401]: friction compensation of `Y` is left inactive
             --> demo.nc:4:5
              |
            4 | N25 Y[COMP OFF FRICT] ;Deactivates "Y" axis
              |     ^^^^^^^^^^^^^^^^^
              |
              = help: add `Y[COMP ON FRICT]` before M30

    X and Y are left off (assuming friction compensation on X and Y)
    "#);
}

#[test]
fn eight_axes_stay_readable() {
    let machine = machine(&["A", "B", "C", "U", "V"]);
    let shown = text(TextOptions::default(), |sink| {
        let mut player = Player::new(&machine, sink);
        player.begin();
        let _ = player.block(4, Some(("Y", OFF)), &[]);
        for _ in 0..1204 {
            let _ = player.block(5, None, &[]);
        }
        let _ = player.text(101, "N10 C[COMP OFF FRICT]", Some(("C", OFF)), &[]);
        player.end(&[]);
    });
    assert!(
        shown.lines().all(|line| line.chars().count() <= 80),
        "{shown}"
    );
    insta::assert_snapshot!(shown, @"
    demo.nc  %DEMO

      line  block                            X    Y    Z    A    B    C    U    V
      on active, off inactive, on! ineffective, - unconfigured, ? unknown, ◄ changed
            at start                         on   on   -    on   on   on   on   on
         4  N25 Y[COMP OFF FRICT] ;Deactiv…  on   off◄ -    on   on   on   on   on
          … 1 204 blocks without a change
          ─ sub.nc
       101    N10 C[COMP OFF FRICT]          on   off  -    on   on   off◄ on   on
            end by M30                       on   off  -    on   on   off  on   on

    Y and C are left off (assuming friction compensation on X, Y, A, B, C, U and V)
    ");
}

#[test]
fn axes_are_listed_as_they_occur() {
    // R2.20
    let machine = Machine::enabled(["X"]);
    let shown = text(TextOptions::default(), |sink| {
        let mut player = Player::new(&machine, sink);
        player.listed.fill(false);
        player.begin();
        let _ = player.text(1, "G90", None, &[]);
        player.listed[0] = true;
        player.version += 1;
        let _ = player.text(2, "X[COMP OFF FRICT]", Some(("X", OFF)), &[]);
        player.listed[2] = true;
        player.version += 1;
        let _ = player.text(3, "Z0", None, &[]);
        player.end(&[]);
    });
    insta::assert_snapshot!(shown, @"
    demo.nc  %DEMO

      line  block
            at start
         1  G90
      line  block                                             X
         2  X[COMP OFF FRICT]                                 inactive ◄
      line  block                                           X           Z
         3  Z0                                              inactive    unconfigured
            end by M30                                      inactive    unconfigured

    X is left off (assuming friction compensation on X)
    ");
}

#[test]
fn every_block_has_its_line_when_asked() {
    let machine = machine(&[]);
    let options = TextOptions {
        runs: Runs::Full,
        ..TextOptions::default()
    };
    let shown = text(options, |sink| {
        let mut player = Player::new(&machine, sink);
        player.begin();
        for _ in 0..3 {
            let _ = player.block(5, None, &[]);
        }
        player.end(&[]);
    });
    assert_eq!(shown.matches("N35 X22 Y33 Z44").count(), 3, "{shown}");
}

#[test]
fn colours_do_not_move_the_columns() {
    let machine = machine(&[]);
    let mut options = TextOptions::default();
    let plain = text(options, |sink| play(&machine, sink));
    options.look.paint = Paint::Styled;
    let styled = text(options, |sink| play(&machine, sink));
    assert!(styled.contains("\u{1b}["));
    assert_eq!(anstream::adapter::strip_str(&styled).to_string(), plain);
}

/// A reader that has closed the pipe.
struct Closed;

impl Write for Closed {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::ErrorKind::BrokenPipe.into())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_closed_pipe_ends_the_run_without_an_error() {
    // R9.26
    let machine = machine(&[]);
    let mut report = Ndjson::new(Closed, View::default());
    let mut player = Player::new(&machine, &mut report);
    player.begin();
    let mut blocks = 0;
    while player.block(5, None, &[]).is_continue() {
        blocks += 1;
    }
    assert!(blocks < 1000);
    assert!(report.finish().is_ok());
    assert!(report.is_closed());
}

fn listing(format: ListingFormat) -> String {
    let mut bytes = Vec::new();
    let mut listing = Listing::new(&mut bytes, format, Look::default());
    listing.file();
    let mut diagnostic = about(
        Code::PErr70495,
        "X[COMP ON FRICT]",
        "50% is, \"not\" set:\nX",
    )
    .with_axis("X")
    .with_help("use `--enable X`");
    diagnostic.place.file = "a b,c.nc".into();
    let _ = listing.diagnostic(&diagnostic);
    let _ = listing.diagnostic(&about(Code::Fc402, "N35", "nothing"));
    listing.finish().unwrap();
    drop(listing);
    String::from_utf8(bytes).unwrap()
}

#[test]
fn diagnostics_in_every_format() {
    // R9.25
    insta::assert_snapshot!(listing(ListingFormat::Concise), @r##"
    a b,c.nc:3:5: error[P-ERR-70495] 50% is, "not" set:␊X
    demo.nc:5:1: info[FC402] nothing
    "##);
    insta::assert_snapshot!(listing(ListingFormat::Github), @r##"
    ::error file=a b%2Cc.nc,line=3,col=5,endColumn=21,title=P-ERR-70495::50%25 is, "not" set:%0AX%0Ahelp: use `--enable X`
    ::notice file=demo.nc,line=5,col=1,endColumn=4,title=FC402::nothing
    "##);
    insta::assert_snapshot!(listing(ListingFormat::Ndjson), @r##"
    {"record":"diagnostic","code":"P-ERR-70495","severity":"error","file":"a b,c.nc","line":3,"column":5,"end_line":3,"end_column":21,"axis":"X","message":"50% is, \"not\" set:\nX","help":["use `--enable X`"]}
    {"record":"diagnostic","code":"FC402","severity":"info","file":"demo.nc","line":5,"column":1,"end_line":5,"end_column":4,"axis":null,"message":"nothing","help":[]}
    {"record":"summary","files":1,"errors":1,"warnings":0,"infos":1}
    "##);
    let document: serde_json::Value = serde_json::from_str(&listing(ListingFormat::Json)).unwrap();
    assert_eq!(document["records"].as_array().unwrap().len(), 3);
    assert!(listing(ListingFormat::Text).contains("error[P-ERR-70495]"));
}

#[test]
fn sarif_names_the_rules_that_it_uses() {
    let document: serde_json::Value = serde_json::from_str(&listing(ListingFormat::Sarif)).unwrap();
    let run = &document["runs"][0];
    assert_eq!(document["version"], "2.1.0");
    assert_eq!(run["tool"]["driver"]["rules"].as_array().unwrap().len(), 2);
    assert_eq!(run["results"][1]["level"], "note");
    let place = &run["results"][0]["locations"][0]["physicalLocation"];
    assert_eq!(place["artifactLocation"]["uri"], "a%20b%2Cc.nc");
    assert_eq!(place["region"]["startColumn"], 5);
    assert_eq!(place["region"]["endColumn"], 21);
}
