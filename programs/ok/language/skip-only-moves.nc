%MOVES
; Nothing that a skip level decides here switches anything
N10 X[COMP OFF FRICT]
/N20 G00 X100
/N30 M00
/2 N40 T5
/N50 P1 = 3
/N60 $IF V.E.PART == 1
/N70 G01 X50 F500
/N80 $ENDIF
N90 X[COMP ON FRICT]
N100 M30
