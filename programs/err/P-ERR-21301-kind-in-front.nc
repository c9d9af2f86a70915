%FINISH
; wrong: COMP is not the first keyword in the bracket
N10 G90 G17
N20 X[FRICT COMP ON]
N30 G01 X50 F1500
N40 M30
