%FINISH
; wrong: a letter in the code, and a word that is nearly `allow`
N10 X[COMP OFF FRICT] ; frictcomp: allow FC4O1 measured without compensation
N20 G01 X50 F1500 ; frictcomp: alow FC405
N30 X[COMP ON FRICT]
N40 M30
