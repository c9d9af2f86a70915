//! Lists: any text as a list of any kind, with any text after the lists that it names.
#![no_main]

use frictcomp::machine::{Configuration, check_list};
use frictcomp_fuzz::Files;
use frictcomp_report::results::lists::render_parameters;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &str| {
    let mut files = Files::new(input);
    let report = check_list(files.source(), None, &mut files);
    report.diagnostics.iter().for_each(|said| files.hold(said));
    let _ = render_parameters(&report.reports, &report.programs, 80);
    let machine = Configuration::from_startup(files.source(), &mut files);
    machine.diagnostics.iter().for_each(|said| files.hold(said));
});
