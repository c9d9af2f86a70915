%PLUNGE
; wrong: Z has no other compensation that N20 could switch off
N10 Z[COMP OFF FRICT]
N20 Z[COMP OFF LEAD CROSS]
N30 G01 Z-5 F500
N40 M30
