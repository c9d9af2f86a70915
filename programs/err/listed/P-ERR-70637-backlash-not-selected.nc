%POCKET
; wrong: the axis list does not select backlash compensation
N10 G90 G17
N20 X[COMP ON BACKLASH]
N30 G01 X50 F1500
N40 M30
