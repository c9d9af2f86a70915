%NUMBERS
; Block numbers may be expressions and need no order; a colon makes a jump label.
N100 P1=7
N[P1*10+0.4] G1 X10 F1000
N20 $GOTO N200
N30 X[COMP OFF FRICT]
N200: $GOTO [PARK]
N40 Y[COMP OFF FRICT]
[PARK] G0 X0
N999 M30
