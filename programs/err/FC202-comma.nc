%FINISH
; wrong: kinds are separated by blanks, not by a comma
N10 G90
N20 X[COMP ON FRICT, LEAD]
N30 G01 X50 F1500
N40 M30
