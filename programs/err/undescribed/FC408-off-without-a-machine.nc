%FINISH
; wrong: run without a machine (--isolated), nobody can say what this leaves
N10 X[COMP OFF FRICT]
N20 G01 X50 F1500
N30 M30
