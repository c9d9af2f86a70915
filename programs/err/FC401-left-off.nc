%FINISH
; wrong: X is switched off and never on again; the next program starts with it off
N10 X[COMP OFF FRICT]
N20 G01 X50 F1500
N30 G01 X0
N40 M30
