//! Stiction compensation, `stiction`.

use crate::document::{Document, Headline, Standing, Table};
use crate::wording::to_json;
use std::fmt::Write as _;

use serde_json::{Map, Value, json};

use frictcomp_physics::stiction::{FeedEffect, Guideline, Quantity, Solution};

/// Returns the verdict: the computed values, and whether stiction is compensated.
fn headline(solution: &Solution) -> Headline {
    let computed = solution.values.iter().filter(|it| it.by.is_some());
    let computed = computed.map(|it| {
        let shown = it.quantity.shown(it.value);
        format!("{} = {shown}", it.quantity.symbol())
    });
    let (standing, effect) = match solution.effect {
        FeedEffect::Acts => (
            Standing::Good,
            "the feed is at most MP1513: stiction is compensated, with feed precontrol",
        ),
        FeedEffect::TooFast => (
            Standing::Bad,
            "the feed is above MP1513: stiction is not compensated",
        ),
        FeedEffect::Unknown => (
            Standing::Plain,
            "stiction is compensated up to a feed of MP1513, and only with feed precontrol",
        ),
    };
    let parts: Vec<String> = computed.chain([effect.to_owned()]).collect();
    Headline::new(standing, parts.join("; "))
}

/// Returns the values as a table, the computed ones with their formula, and remarks on them.
pub fn document(solution: &Solution) -> Document<'_> {
    let mut values = Table::plain(["quantity", "value", "computed by"]);
    for solved in &solution.values {
        let (quantity, by) = (solved.quantity, solved.by.unwrap_or_default());
        values.row(&[&quantity.symbol(), &quantity.shown(solved.value), &by]);
    }
    let mut out = Document::new("Stiction compensation", headline(solution));
    out.push_str("\n");
    out.table(values);
    if let Some(clipped) = solution.clipped_to {
        let _ = writeln!(
            out,
            "\nΔs_a is cut to {} by its limit",
            Quantity::DeltaSa.shown(clipped)
        );
    }
    out
}

/// Returns the advice on a guideline that is not kept (R8.3).
pub fn guideline(guideline: Guideline) -> &'static str {
    match guideline {
        Guideline::Mp1511 => "MP1511 is outside the guideline of 5000 to 10000 µs",
        Guideline::Mp1512 => {
            "MP1512 is not below the guideline of 50: the axis may oscillate at standstill"
        }
    }
}

/// Returns the values as a JSON document.
pub fn render_json(solution: &Solution) -> String {
    to_json(&record(solution))
}

fn record(solution: &Solution) -> Value {
    let values = solution.values.iter().map(|solved| {
        let value = json!({
            "value": solved.value,
            "unit": solved.quantity.unit(),
            "computed_by": solved.by,
        });
        (solved.quantity.as_str().to_owned(), value)
    });
    json!({
        "schema": 1,
        "headline": headline(solution),
        "values": values.collect::<Map<String, Value>>(),
        "clipped_to_mm": solution.clipped_to,
        "effect": solution.effect,
        "guidelines": solution.guidelines,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wording::Detail;
    use frictcomp_physics::stiction::solve;

    #[test]
    fn the_worked_case_is_shown_with_its_formulas() {
        // R8.1, R8.5
        let given = [
            (Quantity::Kv, 1.5),
            (Quantity::Tc, 3000.0),
            (Quantity::Mp1511, 8000.0),
            (Quantity::DeltaSa, 0.002),
        ];
        let solution = solve(&given.into_iter().collect()).expect("a solution");
        insta::assert_snapshot!(document(&solution).shown(Detail::Brief).to_string(), @r"
        F_add = 0.008 m/min; stiction is compensated up to a feed of MP1513, and only with feed precontrol

        Δs_a    0.002 mm
        t_C     3000 µs
        k_v     1.5 (m/min)/mm
        MP1511  8000 µs
        F_add   0.008 m/min     F_add = Δs_a / t_C · k_v · MP1511
        ");
        let record = record(&solution);
        assert_eq!(record["values"]["f_add"]["unit"], "m/min");
        assert!(
            (record["values"]["f_add"]["value"]
                .as_f64()
                .unwrap_or_default()
                - 0.008)
                .abs()
                < 1e-15
        );
    }
}
