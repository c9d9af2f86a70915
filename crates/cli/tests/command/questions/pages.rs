//! The pages of docs that are made from questions, conformance cases and the table of differences.

use std::fmt::Write as _;

use frictcomp::readings::Question;
use frictcomp_report::assumptions::differences;

use super::cases;
use crate::workspace::{agree, root};

/// R15.10: the list of cases is that of the files.
#[test]
fn the_list_of_cases_is_that_of_the_files() {
    let mut text = "# Conformance cases\n\nMade from the files in `conformance`. \
        [conformance.md](conformance.md) says what a case is and how it is run.\n"
        .to_owned();
    let mut chapter = String::new();
    for case in cases() {
        let (of, name) = case.name.split_once('/').expect("a chapter");
        if of != chapter {
            chapter = of.to_owned();
            let title = match of {
                "1" => "The COMP command",
                "2" => "The NC language",
                "3" => "Lists",
                _ => "The additive current",
            };
            write!(text, "\n## {of}. {title}\n\n| case | rule | what it shows | source |\n|---|---|---|---|\n")
                .expect("text");
        }
        let source = match (&case.source, case.question()) {
            (Some(source), _) => source.clone(),
            (None, Some(_)) => "open, both readings".to_owned(),
            (None, None) => "assumed".to_owned(),
        };
        writeln!(
            text,
            "| {name} | {} | {} | {source} |",
            case.rule, case.about
        )
        .expect("text");
    }
    agree(&root().join("docs/conformance-cases.md"), &text);
}

/// R15.12: one row per difference from the control, made from the questions, the cases and the table of
/// what is not modelled.
#[test]
fn the_page_of_differences_is_that_of_the_data() {
    let mut text = "# Compatibility with the control\n\nWhere frictcomp differs from the control on purpose, \
        does not model it, or assumes what no document says. Made from the questions, the conformance \
        cases and one table in the code.\n"
        .to_owned();
    for (kind, title) in [("purpose", "On purpose"), ("not modelled", "Not modelled")] {
        write!(
            text,
            "\n## {title}\n\n| what | the control | frictcomp | rule |\n|---|---|---|---|\n"
        )
        .expect("text");
        for it in differences().iter().filter(|it| it.kind == kind) {
            writeln!(
                text,
                "| {} | {} | {} | {} |",
                it.what, it.control, it.frictcomp, it.rule
            )
            .expect("text");
        }
    }
    text.push_str(
        "\nMotion that is followed in a simpler way is reported at its block (FC907); \
         [motion.md](motion.md#what-is-not-modelled) lists it.\n\n## Not in the simulated machine\n\n\
         `circle`, `tune`, `contour`, `commission learn` and a fitted plant depend on it, and name it.\n\n\
         | what | the machine | the simulation | rule |\n|---|---|---|---|\n",
    );
    for it in differences().iter().filter(|it| it.kind == "simulation") {
        writeln!(
            text,
            "| {} | {} | {} | {} |",
            it.what, it.control, it.frictcomp, it.rule
        )
        .expect("text");
    }
    text.push_str(
        "\n## Open questions\n\nfrictcomp supports both readings; `[reading]` selects one, and `frictcomp ask` tests it on the \
         control.\n\n| rule | question | readings | taken | why | depends on it | asked by |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for question in Question::ALL {
        let it = question.facts();
        let [first, second] = it.readings;
        let cells = [
            it.rule,
            it.question,
            &format!(
                "`{first}`: {}; `{second}`: {}",
                it.meanings[0], it.meanings[1]
            ),
            &format!("`{}`", it.assumed_name()),
            it.why,
            it.depends,
            &format!("{}: {}", it.way.as_str(), it.how),
        ];
        writeln!(text, "| {} |", cells.join(" | ")).expect("text");
    }
    text.push_str(
        "\n## Assumed, with a case\n\n| rule | case | what is assumed |\n|---|---|---|\n",
    );
    for case in cases()
        .iter()
        .filter(|it| it.source.is_none() && it.question().is_none())
    {
        writeln!(text, "| {} | {} | {} |", case.rule, case.name, case.about).expect("text");
    }
    text.push_str(
        "\n[assumptions.md](assumptions.md) lists every assumption that can change a result.\n",
    );
    agree(&root().join("docs/compatibility.md"), &text);
}
