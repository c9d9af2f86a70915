%PROBE
; wrong: the comment takes in the command after it
N10 G90 G01 X0 Y0 F1000 (probe from here X[COMP OFF FRICT]
N20 G01 X10
( wrong, too: Y[COMP OFF FRICT]
N30 Y10
N40 M30
