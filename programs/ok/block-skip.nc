%SKIP
; Without a skip level that is set, skipped blocks are executed
/ N10 G01 X50 F1500
/2 N20 G01 Y50
/10 N30 X[COMP OFF FRICT]
N40 G00 X0
/10 N50 X[COMP ON FRICT]
N60 M30
