%INDEX
; wrong: the machine has no axis C
N10 G90
N20 C[COMP ON FRICT]
N30 G01 X50 F1500
N40 M30
