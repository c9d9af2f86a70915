%PROBE
N10 G90 G01 X0 Y0 F1000
; wrong: no block after this one is executed
N20 #COMMENT BEGIN
N30 X[COMP OFF FRICT]
N40 M30
