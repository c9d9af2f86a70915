%GUARD
N10 X[COMP OFF FRICT]
; wrong: nothing after this block is executed
N20 #ERROR [ID=455 RC=2 PV1=1]
N30 X[COMP ON FRICT]
N40 M30
