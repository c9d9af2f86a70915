//! Assumptions about the drives.

use super::assumption::Assumption;
use super::assumption::When::Reported;
use frictcomp::diagnostic::Code;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "R7.1",
        sentence: "`antr.sercos.mdt[i].nc_ref` names the additive torque command `S-0-0081` or \
            `S_0_0081`, as it names other values; the table of P-AXIS-00132 does not show it",
        changes: "whether a telegram in an axis list holds the additive torque command",
        shows: "FC501; the line that `frictcomp drive` names",
        when: &[Reported(Code::Fc501)],
    },
    Assumption {
        rule: "R7.3",
        sentence: "in an ENI file, the telegrams of a SERCOS device's further axes have process data \
            objects that lie 1000h higher for each",
        changes: "which axis of a device has the value",
        shows: "the path that `frictcomp drive` names",
        when: &[],
    },
];
