%FINISH
; wrong: $IF has no $ENDIF, and is true
N10 P1 = 1
N20 $IF P1 == 1
N30 G01 X50 F1500
N40 M30
