%VARIANTS
; wrong: nobody says which part it is, so X is unknown after N40
N10 G90
N20 $IF V.E.PART == 3
N30 X[COMP OFF FRICT]
N40 $ENDIF
N50 G01 X50 F1500
N60 X[COMP ON FRICT]
N70 M30
