%FINISH
; wrong: the file ends without M30
N10 G90
N20 G01 X50 F1500
N30 G00 X0
