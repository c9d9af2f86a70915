%FINISH
; wrong: neither ON nor OFF nor a kind
N10 G90
N20 X[COMP]
N30 G01 X50 F1500
N40 M30
