%SHOWN
N10 X[COMP OFF FRICT]
; wrong: the variable shows the state, it does not switch
N20 V.A.FRICT_COMP_ACTIVE.X = 1
N30 X[COMP ON FRICT]
N40 M30
