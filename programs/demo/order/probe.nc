%PROBE
; measures the blank without friction compensation on X
N10 X[COMP OFF FRICT]
N20 G01 X10 F200
N30 G00 X0
N40 M30
