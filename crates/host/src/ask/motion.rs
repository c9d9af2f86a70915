//! The motions for questions that a recording answers.

use super::axis::AskedAxis;
use frictcomp::readings::Question;

/// The blocks of a question, and what they move. Each begins and ends where the axis stands, and goes
/// in the positive direction only, no farther than the travel.
pub(super) fn motion(question: Question, axis: &AskedAxis) -> (String, String) {
    let travel = axis.travel;
    let half = travel / 2.0;
    let begin = "N10 G91 G01 F1000\n";
    let blocks = match question {
        Question::WithMotion => format!(
            "{begin}N20 @[COMP OFF FRICT]\nN30 @{half}\nN40 @[COMP ON FRICT] @{half}\nN50 @-{travel}\n"
        ),
        Question::LookAhead => format!(
            "{begin}N20 @{half}\nN30 @[COMP OFF FRICT]\nN40 @{half}\nN50 @[COMP ON FRICT]\nN60 @-{travel}\n"
        ),
        Question::Start => {
            format!("{begin}N20 @{half}\nN30 G04 1\nN40 @{half}\nN50 G04 1\nN60 @-{travel}\n")
        }
        Question::Delay => format!("{begin}N20 @{half}\nN30 F200 @{half}\nN40 F1000 @-{travel}\n"),
        Question::Below => format!(
            "N10 G91 G01 F1\nN20 @{}\nN30 @-{}\n",
            travel / 100.0,
            travel / 100.0
        ),
        // Decay, standstill
        _ => format!("{begin}N20 @{travel}\nN30 @-{travel}\nN40 G04 1\n"),
    };
    let name = &axis.name;
    let moves = format!(
        "{name} by {travel} mm or degrees at most, in the positive direction from where it stands, and back"
    );
    (blocks + "N90 G90\n", moves)
}
