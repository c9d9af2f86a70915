%FINISH
; wrong: a kind, but neither ON nor OFF in front of it
N10 G90
N20 X[COMP FRICT]
N30 G01 X50 F1500
N40 M30
