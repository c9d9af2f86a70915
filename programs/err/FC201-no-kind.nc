%FINISH
; wrong: ON without a kind; it does not mean all kinds
N10 G90
N20 X[COMP ON]
N30 G01 X50 F1500
N40 M30
