//! What every host may rely on: all that is public can be sent to another thread.

use frictcomp::{
    circle, comp, current, diagnostic, interpreter, lists, machine, motion, session, simulation,
    syntax, text, timeline,
};

fn is_send<T: Send>() {}

#[test]
fn what_is_public_is_send() {
    is_send::<comp::Compensation>();
    is_send::<comp::CompensationError>();
    is_send::<comp::CompCommand>();
    is_send::<diagnostic::Diagnostic>();
    is_send::<diagnostic::Collected>();
    is_send::<diagnostic::Fixed>();
    is_send::<text::SourceFile>();
    is_send::<text::TextLines<'_>>();
    is_send::<syntax::Fault>();
    is_send::<lists::Entries>();
    is_send::<lists::FrictionDraft>();
    is_send::<lists::StartupList>();
    is_send::<machine::ConfigError>();
    is_send::<machine::Machine>();
    is_send::<machine::Configuration>();
    is_send::<machine::ListsReport>();
    is_send::<interpreter::Interpreter>();
    is_send::<interpreter::Snapshot>();
    is_send::<interpreter::ResumeError>();
    is_send::<interpreter::Event<'_>>();
    is_send::<session::Session>();
    is_send::<session::SessionOptions>();
    is_send::<session::SavedState>();
    is_send::<session::StateError>();
    is_send::<timeline::Record<'_>>();
    is_send::<timeline::Summary<'_>>();
    is_send::<motion::TrajectoryPlanner>();
    is_send::<current::AdditiveCurrent>();
    is_send::<simulation::Plant>();
    is_send::<circle::CircularTest>();
    is_send::<circle::RecordedCircle>();
    is_send::<circle::CircleError>();
}
