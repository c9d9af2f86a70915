%FINISH
; wrong: a comment is closed that was never opened
N10 G90
N20 G01 X50 F1500 )
N30 M30
