//! A whole contour as data.

use serde_json::{Value, json};

use super::recorder::ContourRecorder;
use super::records::{reversal_record, rounded};
use crate::contour::{ContourSink, Deviations, ProgramContour};

fn figures(deviations: &Deviations) -> Value {
    json!({
        "max": rounded(deviations.max_um(), 3),
        "rms": rounded(deviations.rms_um(), 4),
        "outermost": rounded(deviations.outermost_um, 3),
        "innermost": rounded(deviations.innermost_um, 3),
    })
}

/// The figures of the three runs and the counts of each axis.
pub fn summary_record(contour: &ProgramContour<ContourRecorder<'_>>) -> Value {
    let deviations = contour.deviations();
    let axes = contour.axes().iter().map(|axis| {
        let worst = axis.worst.as_ref().map(|worst| &worst.reversal);
        json!({
            "axis": axis.axis,
            "cutting": axis.cutting,
            "rapid": axis.rapid,
            "uncompensated": axis.uncompensated,
            "glitch_uncompensated": rounded(axis.uncompensated_um, 3),
            "glitch_compensated": rounded(axis.compensated_um, 3),
            "worst": worst.map(|it| json!({
                "file": &*it.file,
                "line": it.line,
                "glitch": rounded(it.glitch_um.programmed, 3),
            })),
        })
    });
    json!({
        "schema": 1,
        "machine_time": rounded(contour.machine_time_s(), 6),
        "programmed": figures(&deviations.programmed),
        "all_on": figures(&deviations.all_on),
        "all_off": figures(&deviations.all_off),
        "axes": axes.collect::<Vec<Value>>(),
        "left_out": contour.left_out(),
        "cut_short": contour.is_cut_short(),
        "time_not_of_the_machine": rounded(contour.time_not_of_the_machine_s(), 6),
    })
}

/// Everything as one document.
pub fn document(contour: &mut ProgramContour<ContourRecorder<'_>>) -> String {
    let mut document = summary_record(contour);
    let names = names(contour);
    let recorder = contour.sink();
    let reversals = recorder.reversals().iter();
    let reversals = reversals.map(|reversal| reversal_record(reversal, &names));
    document["reversals"] = reversals.collect::<Vec<Value>>().into();
    let blocks = recorder.blocks().iter().map(
        |((file, line), max)| json!({ "file": &**file, "line": line, "max": rounded(*max, 3) }),
    );
    document["blocks"] = blocks.collect::<Vec<Value>>().into();
    format!("{document:#}\n")
}

/// The names of the driven axes.
fn names<S: ContourSink>(contour: &ProgramContour<S>) -> Vec<String> {
    let axes = contour.options().axes.iter();
    axes.map(|axis| axis.name.clone()).collect()
}
