//! 2.9: axis exchange: the meaning of axis names.

use frictcomp::comp::State::{self, Active, Inactive, Unknown};
use frictcomp::comp::{AxisIndex, Kind};

use crate::support::Bench;

/// X, Y and C with the logical numbers 1, 2 and 4.
fn machine() -> String {
    let axis = |(name, number)| {
        format!(
            "[[axis]]\nname = \"{name}\"\nnumber = {number}\nfrict_comp = true\n\
             value = {{ mode = 3, table = [[0, 12], [1800, 10]] }}\n"
        )
    };
    [("X", 1), ("Y", 2), ("C", 4)].map(axis).concat()
}

/// Programs that exchange axes, and the states that they leave on X, Y and C.
const PROGRAMS: [(&str, [State; 3]); 27] = [
    // An axis that the channel already has is not requested.
    ("#CALL AX [X,1,0]\nM30", [Active; 3]),
    ("#AX REQUEST FAST [C, 4, 3]\nM30", [Active; 3]),
    ("#SET AX [X,1,0][Y,2,1][C,4,2]\nM30", [Active; 3]),
    // An axis that is given back keeps its states; the control refuses a command to it.
    ("#PUT AX [C]\nM30", [Active; 3]),
    (
        "#PUT AX [C]\nC[COMP ON FRICT]\nM30",
        [Active, Active, Unknown],
    ),
    ("#AX RELEASE ALL\nM30", [Active; 3]),
    (
        "#PUT AX [X, C]\nC[COMP OFF FRICT]\nM30",
        [Active, Active, Unknown],
    ),
    (
        "#AX RELEASE [NAME=C]\nC[COMP OFF FRICT]\nX[COMP OFF FRICT]\nM30",
        [Inactive, Active, Unknown],
    ),
    (
        "#AX DEF [X,1,0]\nY[COMP OFF FRICT]\nM30",
        [Active, Unknown, Active],
    ),
    (
        "#PUT AX [C]\n#CALL AX [C,4,3]\nC[COMP OFF FRICT]\nM30",
        [Active, Active, Inactive],
    ),
    (
        "#PUT AX ALL\n#AX DEF DEFAULT\nX[COMP OFF FRICT]\nM30",
        [Inactive, Active, Active],
    ),
    (
        "#PUT AX [C]\n#AX REQUEST [NAME = C NR = 4]\nC[COMP OFF FRICT]\nM30",
        [Active, Active, Inactive],
    ),
    (
        "#AX RELEASE [NAME = C]\nC[COMP OFF FRICT]\nM30",
        [Active, Active, Unknown],
    ),
    // Comments, continued lines and their block numbers are no names.
    (
        "#PUT AX [C (not X)]\nX[COMP OFF FRICT]\nM30",
        [Inactive, Active, Active],
    ),
    (
        "#PUT AX [X, \\\nN20 C] ; Y\r\nY[COMP OFF FRICT]\r\nM30",
        [Active, Inactive, Active],
    ),
    (
        "#PUT AX [X (a), C]\nC[COMP OFF FRICT]\nM30",
        [Active, Active, Unknown],
    ),
    // Which axes are meant is not known.
    ("#PUT AX [X C]\nX[COMP OFF FRICT]\nM30", [Unknown; 3]),
    (
        "#SET AX [X 1, 0][Y, 2, 1]\nY[COMP OFF FRICT]\nM30",
        [Unknown; 3],
    ),
    // Another name for an axis.
    (
        "#PUT AX [X, Y]\n#CALL AX [Y,1,0]\nY[COMP OFF FRICT]\nM30",
        [Inactive, Active, Active],
    ),
    (
        "P1=3\n#PUT AX [X]\n#CALL AX [U,P1-2,0]\nU[COMP ON FRICT]\nM30",
        [Active; 3],
    ),
    (
        "#PUT AX [X]\n#AX REQUEST [NAME=U NR=1 IDX=0]\nU[COMP OFF FRICT]\nM30",
        [Inactive, Active, Active],
    ),
    // An unknown axis.
    ("#CALL AX [U,V.E.N,5]\nU[COMP OFF FRICT]\nM30", [Unknown; 3]),
    // An exchange that may or may not have been executed.
    (
        "$IF V.E.A==1\n#PUT AX [X]\n$ENDIF\nX[COMP ON FRICT]\nM30",
        [Unknown; 3],
    ),
    (
        "$IF V.E.A==1 $GOTO N10\n#PUT AX [X]\n#CALL AX [X,2,0]\nN10: X[COMP OFF FRICT]\nM30",
        [Unknown; 3],
    ),
    ("#SAVE CONFIG\n#LOAD CONFIG\nM30", [Active; 3]),
    (
        "#SAVE CONFIG\n#PUT AX [X]\n#LOAD CONFIG\nX[COMP ON FRICT]\nM30",
        [Unknown; 3],
    ),
    // A coupling is not an exchange.
    ("#SET AX LINK [1, C=X]\nM30", [Active; 3]),
];

#[test]
fn names_mean_the_axes_that_the_channel_has() {
    // R2.70
    for (program, expected) in PROGRAMS {
        let machine = machine();
        let bench = Bench::on(&machine).keep_going();
        let mut session = bench.session();
        let said = bench.run_in(&mut session, &[program]);
        let states = [0, 1, 2].map(|axis| session.state().state(AxisIndex::new(axis), Kind::Frict));
        assert_eq!(states, expected, "{program}\n{said}");
        let all_clear = !said.contains("FC401");
        assert_eq!(all_clear, expected == [Active; 3], "{program}\n{said}");
    }
}
