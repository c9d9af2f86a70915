%FINISH
; wrong: the first part is cut with compensation, every part after it without
N10 G01 X50 F1500
N20 X[COMP OFF FRICT]
N30 G01 X0
N40 M30
