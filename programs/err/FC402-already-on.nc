%FINISH
; wrong: X is on since the start of the control
N10 X[COMP ON FRICT]
N20 G01 X50 F1500
N30 M30
