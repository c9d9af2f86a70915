//! The file of a plan, by which recordings are recognised later.

use serde::{Deserialize, Serialize};

use super::plan::Plan;

/// A value list that is loaded while programs of stage 2 run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ValueListUsed {
    /// Name of the axis.
    pub axis: String,
    /// The file, as it is shown.
    pub file: String,
    /// The SHA-256 of its bytes in hexadecimal digits.
    pub sha256: String,
}

/// The content of `plan-1.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct PlanFile {
    /// The version of the format of this file.
    pub schema: u32,
    /// The programs without their motions.
    pub plan: Plan,
    /// The value lists of stage 2.
    pub lists: Vec<ValueListUsed>,
}

impl PlanFile {
    /// The version that is written.
    pub const SCHEMA: u32 = 1;

    /// Returns whether it has a program with a number.
    pub fn has(&self, number: u16) -> bool {
        self.plan.programs.iter().any(|it| it.number == number)
    }

    /// Returns the plan of a program, if its number is known.
    pub fn of(plans: &[Self], program: Option<u16>) -> Option<&Self> {
        let number = program?;
        plans.iter().find(|it| it.has(number))
    }
}

/// A plan with its basis.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct PlanReport {
    /// The programs.
    pub plan: Plan,
    /// The value lists of stage 2.
    pub lists: Vec<ValueListUsed>,
    /// The file that describes the machine, as it is shown.
    pub machine: String,
    /// Axes whose ramps are those of the control's defaults.
    pub assumed_jerk: Vec<String>,
}

impl PlanReport {
    /// Returns the content of `plan.json`.
    pub fn file(&self) -> PlanFile {
        PlanFile {
            schema: PlanFile::SCHEMA,
            plan: self.plan.clone(),
            lists: self.lists.clone(),
        }
    }
}
