%REPEAT
; wrong: where the jump goes is known to the machine only
N10 G90
N20 $GOTO V.E.NEXT
N30 X[COMP OFF FRICT]
N40: G00 Z100
N50 X[COMP ON FRICT]
N60 M30
