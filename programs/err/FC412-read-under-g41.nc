%POCKET
; wrong: the state is read while cutter radius compensation is active
N10 G90 G17
N20 G41 G01 X10 Y0 F1500
N30 $IF V.A.FRICT_COMP_ACTIVE.X == 0
N40 #MSG ["X is off"]
N50 $ENDIF
N60 G40 X0
N70 M30
