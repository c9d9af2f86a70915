%PROBE
N10 G90 G00 X0 Y0
; wrong: round brackets make a comment of the command
N20 X(COMP OFF FRICT)
N30 G00 X10
N40 X[COMP ON FRICT]
N50 M30
