%OPEN
; The last line has no line end
N10 G01 X50 F1500
N20 M30