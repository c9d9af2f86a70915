//! `frictcomp.toml`: any text is a machine on which a program runs, or is refused at a place in it.
#![no_main]

use frictcomp::comp::KindSet;
use frictcomp::machine::Configuration;
use frictcomp::session::{Program, Session};
use frictcomp::text::SourceFile;
use frictcomp_fuzz::{Bench, Files, POLICIES};
use frictcomp_report::{Ndjson, View};
use libfuzzer_sys::fuzz_target;

const PROGRAM: &str = "X[COMP OFF FRICT]\nG1 X1 Y=V.E.A\nY[COMP ON FRICT LEAD]\nM6\nT1\nM30\n";

fuzz_target!(|input: &str| {
    let mut files = Files::new(input);
    let configuration = match Configuration::from_toml(files.source(), &mut files) {
        Ok(configuration) => configuration,
        Err(error) => return files.hold(&error.diagnostic),
    };
    configuration
        .diagnostics
        .iter()
        .for_each(|said| files.hold(said));
    let bench = Bench {
        files,
        stop: POLICIES[1],
    };
    let options = bench
        .options()
        .with_settings(configuration.settings)
        .with_levels(configuration.levels);
    let mut session = Session::new(configuration.machine, options);
    let view = View::default().with_kinds(KindSet::ALL);
    let mut sink = Ndjson::new(std::io::sink(), view);
    let _ = session.begin(&configuration.diagnostics, &mut sink);
    let program = Program::Whole(SourceFile::new("program.nc", PROGRAM));
    let _ = session.program("program.nc", program, &mut files, &mut sink);
    let _ = session.finish(&mut sink);
});
