%FINISH
; wrong: the block switches X off and on; the last command wins
N10 G90
N20 X[COMP OFF FRICT] X[COMP ON FRICT]
N30 G01 X50 F1500
N40 M30
