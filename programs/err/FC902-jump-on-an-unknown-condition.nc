%REPEAT
; wrong: whether the jump is taken is known to the machine only
N10 G90
N20 $IF V.E.DONE == 1 $GOTO N40
N30 X[COMP OFF FRICT]
N40: G00 Z100
N50 X[COMP ON FRICT]
N60 M30
