//! Assumptions about the circular test.

use super::assumption::Assumption;

pub(super) const ASSUMED: &[Assumption] = &[
    Assumption {
        rule: "5",
        sentence: "a drive unit is 0.1 % of a rated force of 5000 N",
        changes: "the force of the additive current",
        shows: "`N a drive unit` in the report; `rated_force` or `k_I` of a plant file",
        when: &[],
    },
    Assumption {
        rule: "5",
        sentence: "a drive can give four times its rated force for a short time",
        changes: "circles that need more acceleration",
        shows: "the report counts the cycles with limited force; `max_force`",
        when: &[],
    },
    Assumption {
        rule: "5",
        sentence: "the additive current reaches the speed loop unrounded",
        changes: "less than half a drive unit",
        shows: "nothing; `frictcomp current` shows the integers",
        when: &[],
    },
    Assumption {
        rule: "R5.12",
        sentence: "four elements of equal share with stiffnesses in the ratio 1, 1/2, 1/3, 1/4, σ1 \
            shared by those that stick, attraction C 1e6 N/s",
        changes: "the shape of the glitch with `--model gms`",
        shows: "`gms` and `gms_C` of a plant file",
        when: &[],
    },
    Assumption {
        rule: "R5.20",
        sentence: "the circle starts at X+ at a CNC cycle",
        changes: "where in a cycle the reversals occur; at 5 m/min some 15 % of the \
            remaining glitch",
        shows: "the commanded start cannot be chosen",
        when: &[],
    },
    Assumption {
        rule: "R5.20",
        sentence: "without `--value-list` the list is the plant's friction at 20 velocities up to 0.5 \
            m/s",
        changes: "the remaining glitch",
        shows: "`value list` in the report",
        when: &[],
    },
    Assumption {
        rule: "R5.21",
        sentence: "D of one direction is the mean of that direction; the bidirectional D is the mean of \
            both",
        changes: "nothing if both are equal",
        shows: "rows `D` of the report",
        when: &[],
    },
    Assumption {
        rule: "R5.22",
        sentence: "before the straight line through the sides, the ellipse and the shift of the whole \
            path are subtracted",
        changes: "the glitch of a path that is an ellipse, by some 2 % of the ellipse",
        shows: "`glitch` in the conditions of the report",
        when: &[],
    },
    Assumption {
        rule: "R5.24",
        sentence: "a step counts as backlash if it is at least a tenth of the peak, and if the peak has \
            fallen below half of the step half-way to where the step is measured",
        changes: "whether little backlash beside much friction is named",
        shows: "rows `step that stays` and `peak that decays` of the report",
        when: &[],
    },
    Assumption {
        rule: "R5.24",
        sentence: "an ellipse is named if it is larger than the step of an axis whose peak has not decayed",
        changes: "whether axes that do not match are named beside friction that decays slowly",
        shows: "rows `step that stays` of the report",
        when: &[],
    },
    Assumption {
        rule: "R5.24",
        sentence: "glitches below 1 µm get no advice; a bulge of less than a quarter of the other is \
            ignored",
        changes: "whether advice is given",
        shows: "the report always shows the figures",
        when: &[],
    },
    Assumption {
        rule: "R5.25",
        sentence: "when slow points are shaped, delay_cycles, position_delay and reversal_lookahead are \
            searched again, with scaling_factor at 1000",
        changes: "how good a shaped list can be",
        shows: "the parameters in the report of `frictcomp tune`",
        when: &[],
    },
    Assumption {
        rule: "R5.25",
        sentence: "±20 % friction changes Fc, Fs and fv but not the stiffness",
        changes: "the sensitivity",
        shows: "the columns of `frictcomp tune`",
        when: &[],
    },
    Assumption {
        rule: "R5.27",
        sentence: "the position loop measures the motor, and friction holds the load while the motor \
            crosses the dead zone; all of the friction acts on the motor",
        changes: "the path within the backlash at a reversal",
        shows: "`backlash_um` of a plant file",
        when: &[],
    },
];
