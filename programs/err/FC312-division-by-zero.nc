%PITCH
; wrong: the number of holes is 0
N10 P1 = 0
N20 P2 = 360 / P1
N30 M30
