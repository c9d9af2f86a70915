%POCKET
; wrong: X moves while its friction compensation is off
N10 G90 G17
N20 X[COMP OFF FRICT]
N30 G01 X50 Y20 F1500
N40 X[COMP ON FRICT]
N50 M30
