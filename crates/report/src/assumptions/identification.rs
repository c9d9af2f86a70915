//! Assumptions of the identification of friction.

use super::assumption::Assumption;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "R6.10",
        sentence: "a speed is constant where its mean over 50 ms stays within 30 µm/s, 1 % or five standard deviations for 0.3 s; its ends are cut",
        changes: "which samples count",
        shows: "the segments in the HTML report",
        when: &[],
    },
    Assumption {
        rule: "R6.11",
        sentence: "the torque of a segment is its mean between the 5th and the 95th percentile",
        changes: "friction at a speed, by a fraction of its noise",
        shows: "the column `±`",
        when: &[],
    },
    Assumption {
        rule: "R6.12",
        sentence: "friction is half of what differs between both directions; the offset is the median of what does not",
        changes: "friction and offset of an axis with asymmetric friction",
        shows: "the column `offset`",
        when: &[],
    },
    Assumption {
        rule: "R6.13",
        sentence: "where friction drifts, its mean over time is used",
        changes: "the value list of an axis that warms up",
        shows: "FC516",
        when: &[],
    },
    Assumption {
        rule: "R6.15",
        sentence: "friction follows Coulomb, Stribeck and viscous friction, or else straight lines",
        changes: "friction between the recorded speeds",
        shows: "FC517, the residuals",
        when: &[],
    },
    Assumption {
        rule: "R6.16",
        sentence: "below the slowest and above the fastest recorded speed friction is held",
        changes: "friction just after a reversal",
        shows: "FC511, FC512",
        when: &[],
    },
    Assumption {
        rule: "R6.17",
        sentence: "a value list has eight points",
        changes: "how close the list is to the curve",
        shows: "`--points`, `--max-error`",
        when: &[],
    },
    Assumption {
        rule: "R6.19",
        sentence: "on circles torque is friction, inertia and offset; samples shortly after a reversal do not count",
        changes: "friction from circles",
        shows: "the speeds that are left out",
        when: &[],
    },
    Assumption {
        rule: "R6.20",
        sentence: "the recorded torque is the additive current of the list times a factor, inertia and offset; without a CNC cycle, the time between two samples counts as one",
        changes: "the verdict of `verify`",
        shows: "the column `recorded/predicted`",
        when: &[],
    },
];
