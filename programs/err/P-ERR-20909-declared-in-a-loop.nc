N10 $FOR P1 = 1, 2, 1
; wrong: the second pass declares it again
N20 #VAR
V.P.SUM
#ENDVAR
N30 $ENDFOR
N40 M30
