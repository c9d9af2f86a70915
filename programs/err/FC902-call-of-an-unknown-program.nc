%REPEAT
; wrong: which program is called is known to the machine only
N10 G90
N20 L V.E.NEXT
N30 G00 Z100
N40 X[COMP ON FRICT]
N50 M30
