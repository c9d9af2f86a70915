%POCKET
N10 X[COMP OFF FRICT]
; wrong: the channel that has X does not have Y
N20 Y[COMP ON FRICT]
N30 X[COMP ON FRICT]
N40 M30
