%FINISH
; wrong: a COMP command shares its block with motion words
N10 X[COMP OFF FRICT] G01 X50 F1500
N20 X[COMP ON FRICT]
N30 M30
