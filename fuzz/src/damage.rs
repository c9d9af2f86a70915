//! Valid JSON that is then damaged.

use serde_json::{Map, Number, Value, json};

use crate::Choices;

/// Changes some places of a document, each usually into something of the same kind: a document of the right shape is
/// read further.
pub(crate) fn damage(document: &mut Value, choices: &mut Choices<'_>) {
    for _ in 0..1 + choices.below(3) {
        let mut place = &mut *document;
        loop {
            let children = match place {
                Value::Array(items) => items.len(),
                Value::Object(fields) => fields.len(),
                _ => 0,
            };
            // Descending into a member is far more likely than changing it.
            if children == 0 || choices.below(12) == 1 {
                break;
            }
            let chosen = choices.below(children.min(256));
            place = match place {
                Value::Array(items) => &mut items[chosen],
                Value::Object(fields) => {
                    fields.values_mut().nth(chosen).expect("there are as many")
                }
                _ => return,
            };
        }
        touch(place, choices);
    }
}

fn touch(value: &mut Value, choices: &mut Choices<'_>) {
    match value {
        Value::Number(_) => *value = Value::Number(number(choices)),
        Value::String(text) => match choices.below(4) {
            0 => text.clear(),
            1 => text.push('\u{202e}'),
            2 => {
                *text = choices
                    .one_of(&["X", "Program", "other", "P1", "V.S.A", "On", "N10"])
                    .to_owned()
            }
            _ => *text = text.repeat(3),
        },
        Value::Array(items) => match choices.below(3) {
            0 => items.clear(),
            1 => items.extend(items.clone()),
            _ => drop(items.pop()),
        },
        Value::Object(fields) => rename(fields, choices),
        Value::Bool(is) => *is = !*is,
        Value::Null => {
            *value = match choices.below(5) {
                0 => json!(0),
                1 => json!(""),
                2 => json!([0, 0]),
                3 => json!({}),
                _ => json!("Program"),
            }
        }
    }
}

fn rename(fields: &mut Map<String, Value>, choices: &mut Choices<'_>) {
    let Some(name) = fields
        .keys()
        .nth(choices.below(256) % fields.len().max(1))
        .cloned()
    else {
        return;
    };
    let Some(value) = fields.remove(&name) else {
        return;
    };
    let other = choices.one_of(&["", "0", "X", "-1", "4294967295", "V.S.A", "\u{7f}"]);
    if choices.below(2) == 0 {
        fields.insert(other.to_owned(), value);
    }
}

fn number(choices: &mut Choices<'_>) -> Number {
    let whole = [
        0_i64,
        1,
        2,
        3,
        7,
        100,
        -1,
        255,
        65_535,
        4_294_967_295,
        i64::MAX,
        i64::MIN,
    ];
    match choices.below(whole.len() + 2) {
        12 => Number::from(u64::MAX),
        13 => Number::from_f64(1e300).expect("a finite number"),
        place => Number::from(whole[place]),
    }
}
