%FINISH
; wrong: there is no label N900:
N10 P1 = 1
N20 $IF P1 > 5 $GOTO N900
N30 G01 X50 F1500
N40 M30
