%WAIT
; wrong: nothing changes P1 while the program waits
N10 P1 = 0
N20 #WAIT FOR P1 == 1
N30 X[COMP OFF FRICT]
N40 M30
