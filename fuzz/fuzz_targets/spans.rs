//! Places: every message about a text points at characters of it, and can be shown.
#![no_main]

use std::ops::ControlFlow;

use frictcomp::diagnostic::Diagnostic;
use frictcomp::interpreter::StopPolicy;
use frictcomp::session::Session;
use frictcomp::timeline::{Record, Sink};
use frictcomp_fuzz::{Bench, Files, Profile, machine, text_of};
use frictcomp_report::{Listing, ListingFormat, Look, Paint, render};
use libfuzzer_sys::fuzz_target;

struct Places<'a>(Files<'a>);

impl Places<'_> {
    fn hold(&self, diagnostic: &Diagnostic) {
        self.0.hold(diagnostic);
        for (paint, width) in [(Paint::Plain, 1), (Paint::Styled, 40), (Paint::Plain, 200)] {
            assert!(
                render(
                    diagnostic,
                    Look {
                        paint,
                        width,
                        ..Look::default()
                    }
                )
                .ends_with('\n')
            );
        }
        for format in [
            ListingFormat::Concise,
            ListingFormat::Github,
            ListingFormat::Sarif,
            ListingFormat::Json,
        ] {
            let mut listing = Listing::new(std::io::sink(), format, Look::default());
            assert!(listing.diagnostic(diagnostic).is_continue());
            listing.finish().expect("a sink takes everything");
        }
    }
}

impl Sink for Places<'_> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => row.diagnostics.iter().for_each(|said| self.hold(said)),
            Record::End(end) => end
                .notes
                .iter()
                .for_each(|note| self.hold(&note.diagnostic)),
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

fuzz_target!(|input: &[u8]| {
    let Some(text) = text_of(input, &Profile::HOSTILE) else {
        return;
    };
    let bench = Bench {
        files: Files::new(&text),
        stop: StopPolicy::CheckAll,
    };
    let mut session = Session::new(machine(), bench.options());
    bench.session(&mut session, &mut Places(bench.files));
});
