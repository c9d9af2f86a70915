%REPEAT
; wrong: the label is known to the machine only
N10 G90
N20 $GOTO V.E.NEXT_STEP
N30 G01 X50 F1500
[RETRACT]
N40 G00 Z100
N50 M30
