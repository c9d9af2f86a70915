%L SUB
N10 P1 = 0
; wrong: $IF has no $ENDIF, and is false
N20 $IF P1 == 1
N30 M17
%MAIN
N10 LL SUB
N20 M30
