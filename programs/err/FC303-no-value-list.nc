%SWIVEL
; wrong: B is switched on, but there is no value list for it
N10 B[COMP OFF FRICT]
N20 G01 B90 F1500
N30 B[COMP ON FRICT]
N40 M30
