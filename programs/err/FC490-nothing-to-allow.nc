%FINISH
; wrong: the block raises no FC402 that could be allowed
N10 X[COMP OFF FRICT] ; frictcomp: allow FC402 measured without compensation
N20 G01 X50 F1500
N30 X[COMP ON FRICT]
N40 M30
