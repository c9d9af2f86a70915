%FINISH
; wrong: the keywords of the first command are in lower case
N10 X[comp off frict]
N20 G01 X50 F1500
N30 X[COMP ON FRICT]
N40 M30
