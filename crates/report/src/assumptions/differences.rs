//! The intended differences between frictcomp and the control, and the parts that it does not model
//! (R15.12).

/// One difference. The texts name codes and words of programs in backquotes.
#[derive(Debug, Clone, Copy)]
pub struct Difference {
    /// `purpose` or `not modelled`.
    pub kind: &'static str,
    /// Subject.
    pub what: &'static str,
    /// Behaviour of the control, as far as it is known.
    pub control: &'static str,
    /// Behaviour of frictcomp.
    pub frictcomp: &'static str,
    /// The rule.
    pub rule: &'static str,
}

const fn purpose(what: &'static str, [control, frictcomp, rule]: [&'static str; 3]) -> Difference {
    Difference {
        kind: "purpose",
        what,
        control,
        frictcomp,
        rule,
    }
}

const fn not_modelled(
    what: &'static str,
    [control, frictcomp, rule]: [&'static str; 3],
) -> Difference {
    Difference {
        kind: "not modelled",
        what,
        control,
        frictcomp,
        rule,
    }
}

/// Every difference that is known and no assumption.
pub const DIFFERENCES: &[Difference] = &[
    purpose(
        "an unknown value",
        [
            "has the value of the machine",
            "stays unknown and is never guessed; both ways are followed",
            "R2.50",
        ],
    ),
    purpose(
        "a program that never ends",
        [
            "runs until a reset",
            "is cut off by a budget, which is said (FC910 to FC914)",
            "R2.60",
        ],
    ),
    purpose(
        "programs outside the project",
        [
            "are called",
            "are not read (FC321), unless `--allow-outside`",
            "R2.16",
        ],
    ),
    purpose(
        "text that no form of the language explains",
        [
            "stops with an error of the decoder",
            "stops with FC207",
            "R2.70",
        ],
    ),
    purpose(
        "errors without a documented number",
        ["have a number", "have a code that begins with FC", "R9.23"],
    ),
    purpose(
        "an error",
        [
            "keeps the channel in the error state until a reset",
            "ends the session; `--keep-going` goes on",
            "R9.20",
        ],
    ),
    not_modelled(
        "switching from outside",
        [
            "the PLC and objects of the control may switch",
            "only programs switch",
            "R1.30",
        ],
    ),
    not_modelled(
        "`#FRICTION`",
        [
            "is known by error texts only",
            "leaves the state unknown (FC902)",
            "R2.93",
        ],
    ),
    not_modelled(
        "cycles in real time, `#RT CYCLE`",
        ["run beside the program", "are passed over", "R2.81"],
    ),
    not_modelled(
        "transformations and kinematics",
        [
            "move machine axes by a chain of coordinates",
            "positions are programmed, not those of the machine",
            "R2.47",
        ],
    ),
    not_modelled(
        "other channels",
        [
            "may switch an axis that they were given",
            "an axis keeps its state until it comes back",
            "R2.70",
        ],
    ),
    not_modelled(
        "the motion that drives out an offset",
        ["is made by COMP without `NO_MOVE`", "is not made", "R1.6"],
    ),
];
