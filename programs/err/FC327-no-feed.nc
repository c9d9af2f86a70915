%FACE
N10 G90 G17 X[COMP OFF FRICT]
; wrong: no F before the first feed move
N20 G01 X10
N30 X[COMP ON FRICT]
N40 M30
