%POCKET
; wrong: friction compensation is switched while a transformation is active
N10 G90 G17
N20 #TRAFO ON
N30 X[COMP OFF FRICT]
N40 G01 X50 F1500
N50 X[COMP ON FRICT]
N60 #TRAFO OFF
N70 M30
