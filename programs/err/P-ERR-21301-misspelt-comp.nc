%FINISH
; wrong: the first keyword in the bracket is KOMP, not COMP
N10 G90 G17
N20 X[KOMP ON FRICT]
N30 G01 X50 F1500
N40 M30
