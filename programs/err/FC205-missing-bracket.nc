%FINISH
; wrong: the bracket is not closed
N10 G90
N20 X[COMP ON FRICT
N30 G01 X50 F1500
N40 M30
