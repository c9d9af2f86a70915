%FINISH
; wrong: N30 repeats what N10 did, nothing between them could have changed it
N10 X[COMP ON FRICT]
N20 G01 X50 F1500
N30 X[COMP ON FRICT]
N40 M30
