%BATCH
; wrong: how often the loop runs is known to the machine only
N10 $WHILE V.E.PARTS_LEFT > 0
N20 Y[COMP OFF FRICT]
N30 G01 Y50 F1500
N40 $ENDWHILE
N50 Y[COMP ON FRICT]
N60 M30
