N10 $FOR P1 = 1, 3, 1
; wrong: the label is in the same loop
N20 $IF P1 == 2 $GOTO N40
N30 X[COMP OFF FRICT]
N40: X[COMP ON FRICT]
N50 $ENDFOR
N60 M30
