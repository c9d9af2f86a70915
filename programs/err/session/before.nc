%BEFORE
; Leaves X switched off. Run before the other program of this folder, in one
; session: frictcomp run before.nc FC403-state-of-another-program.nc
N10 X[COMP OFF FRICT] ; frictcomp: allow FC401 the next program shall see it
N20 G01 X50 F1500
N30 M30
