//! Assumptions about motion.

use super::assumption::Assumption;
use super::assumption::When::Reported;
use frictcomp::diagnostic::Code;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "R5.1",
        sentence: "a motion that is not known is left out and the trace restarts after it",
        changes: "the trace, and a first start of the current",
        shows: "FC903, `the trace restarts`",
        when: &[Reported(Code::Fc903)],
    },
    Assumption {
        rule: "R5.1",
        sentence: "F refers to X, Y, Z; other axes follow; without X, Y, Z it refers to the axes that \
            move (the default of P-CHAN-00096)",
        changes: "the velocity of motions with rotary or further axes",
        shows: "the column `v`",
        when: &[],
    },
    Assumption {
        rule: "R5.1",
        sentence: "with G70, F is in inch/min in the block in which it stands, with G95 in inch/rev; \
            if F is in m/min (P-CHAN-00108), its unit is then not known",
        changes: "the velocity of programs in inches",
        shows: "the column `v`, FC903",
        when: &[],
    },
    Assumption {
        rule: "R5.1",
        sentence: "where only rotary axes move, F is in °/min, whatever the unit for lengths",
        changes: "the velocity of rotary axes",
        shows: "the column `v`",
        when: &[],
    },
    Assumption {
        rule: "R5.1",
        sentence: "with G95 the spindle has the last programmed speed, from the block of S on, unless \
            M5 or M19 stopped it",
        changes: "the velocity of turning programs",
        shows: "the column `v`",
        when: &[],
    },
    Assumption {
        rule: "R5.1",
        sentence: "programmed overrides, G129 and the speed of the spindle do not outlive a program; \
            the operator's overrides are at 100 %",
        changes: "the velocity at the start of a program",
        shows: "the column `v`",
        when: &[],
    },
    Assumption {
        rule: "R5.1",
        sentence: "what is not modelled is followed in a simpler way",
        changes: "times and velocities near such blocks, and corners that the control rounds",
        shows: "FC907, `--columns simplified`",
        when: &[Reported(Code::Fc907)],
    },
    Assumption {
        rule: "R5.1",
        sentence: "motions whose start is not known are left out before the trace",
        changes: "where the trace begins",
        shows: "FC906; `--start`",
        when: &[Reported(Code::Fc906)],
    },
    Assumption {
        rule: "R5.1",
        sentence: "a rotary axis moves by the programmed difference, even with G00 and G90",
        changes: "the path of a modulo axis",
        shows: "the column `x`",
        when: &[],
    },
    Assumption {
        rule: "R5.1",
        sentence: "COMP takes effect when the path reaches its block, without a stop",
        changes: "the first cycle in which the current changes",
        shows: "`--columns comp`",
        when: &[],
    },
    Assumption {
        rule: "R5.2",
        sentence: "without `max_velocity` 10 000 mm/min or °/min, the default of P-AXIS-00209",
        changes: "rapid motions, high feeds",
        shows: "`limits assumed` on stderr",
        when: &[],
    },
    Assumption {
        rule: "R5.2",
        sentence: "without `max_acceleration` 1 m/s² or 1000 °/s², the default of P-AXIS-00001",
        changes: "the time of every motion",
        shows: "`limits assumed` on stderr",
        when: &[],
    },
    Assumption {
        rule: "R5.2",
        sentence: "without `max_jerk` 20 m/s³ or 20 000 °/s³, the default acceleration in the default \
            ramp time of P-AXIS-00195 to P-AXIS-00198",
        changes: "the time of every motion, velocities at transitions",
        shows: "`limits assumed` on stderr",
        when: &[],
    },
    Assumption {
        rule: "R11.20",
        sentence: "jerk is acceleration by ramp time; where a list gives only some of the accelerations \
            or ramp times of P-AXIS-00001, P-AXIS-00002 and P-AXIS-00195 to P-AXIS-00198, they count for \
            speeding up and braking; without P-CHAN-00071 the acceleration has ramps",
        changes: "the time of every motion",
        shows: "`lists --show`, the column `v`",
        when: &[],
    },
    Assumption {
        rule: "R11.21",
        sentence: "a contour mode rounds corners between lines by a B-spline, symmetrical, within its \
            tolerance; without one there is no rounding",
        changes: "the path at corners, and the velocity there",
        shows: "FC907, `transitions` of `contour`",
        when: &[Reported(Code::Fc907)],
    },
    Assumption {
        rule: "R5.2",
        sentence: "a transition takes at most a quarter of the jerk of an axis in a CNC cycle; with \
            P-AXIS-00013 that share of its acceleration; P-AXIS-00154, P-AXIS-00339 and P-AXIS-00340 are not \
            used",
        changes: "the velocity at kinks and at the ends of arcs",
        shows: "the column `v`",
        when: &[],
    },
    Assumption {
        rule: "R5.2",
        sentence: "an exact stop waits for no control window (P-AXIS-00236)",
        changes: "the time at rest",
        shows: "the column `t`",
        when: &[],
    },
    Assumption {
        rule: "R5.3",
        sentence: "a circle takes at most 90 % of the acceleration and 70 % of the jerk of \
            its axes",
        changes: "the velocity on small, fast circles",
        shows: "the column `v`",
        when: &[],
    },
    Assumption {
        rule: "R5.3",
        sentence: "a centre that fits the end points to within 5 % of the radius is moved, as with G165; \
            the limits P-CHAN-00059 and P-CHAN-00060 are not read",
        changes: "the arc",
        shows: "FC903 beyond it",
        when: &[Reported(Code::Fc903)],
    },
];
