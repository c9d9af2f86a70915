%SKIP
; Whether skipped blocks are executed is a switch of the machine: unknown without `--skip`
/ N10 G01 X50 F1500
/2 N20 G01 Y50 F1500
/10 N30 X[COMP OFF FRICT]
N40 G00 X0
/10 N50 X[COMP ON FRICT]
N60 M30
