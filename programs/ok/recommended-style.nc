%PART
; What the program needs is set before the first motion, and every axis is
; brought back to its start-up state at the end: silent in every order of programs.
N10 X[COMP OFF FRICT] Y[COMP ON FRICT]
N20 G01 X50 Y20 F1500
N30 Y[COMP OFF FRICT]
N40 G01 Y0
N50 X[COMP ON FRICT] Y[COMP ON FRICT]
N60 M30
