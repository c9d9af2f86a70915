%REPEAT
; wrong: which M function this is, is known to the machine only
N10 G90
N20 MV.E.NEXT
N30 G00 Z100
N40 X[COMP ON FRICT]
N50 M30
