%UNKNOWN
; The condition is not known offline: nothing is guessed, the next command makes X known again.
N10 $IF V.E.FINE_PASS
N20   X[COMP ON FRICT]
N30 $ELSE
N40   X[COMP OFF FRICT]
N50 $ENDIF
N60 G1 X10 F500
N70 X[COMP ON FRICT]
N80 M30
