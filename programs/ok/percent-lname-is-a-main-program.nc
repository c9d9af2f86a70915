%LEVEL
; No blank after the L: a main program called LEVEL
N10 G01 X50 F1500
N20 M30
