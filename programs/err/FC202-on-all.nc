%RESTORE
; wrong: only OFF_ALL is about every kind
N10 X[COMP ON_ALL]
N20 M30
