//! Whole runs: any text, in memory and line by line, with every policy, into the formats.
#![no_main]

use std::io::sink;

use frictcomp::report::{Csv, Ndjson, Report, Text, TextOptions, View};
use frictcomp::session::Session;
use frictcomp_fuzz::{Bench, Files, POLICIES, machine};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &str| {
    let files = Files::new(input);
    let reports: [&mut dyn Report; 3] = [
        &mut Text::new(sink(), TextOptions::default()),
        &mut Ndjson::new(sink(), View::default()),
        &mut Csv::new(sink(), View::default()).with_positions(),
    ];
    for (stop, report) in POLICIES.into_iter().zip(reports) {
        let bench = Bench { files, stop };
        let mut session = Session::new(machine(), bench.options());
        bench.session(&mut session, report);
        report.finish().expect("a sink takes everything");
    }
});
