%PLUNGE
; wrong: Z has no friction compensation that could be switched off
N10 Z[COMP OFF FRICT]
N20 G01 Z-5 F500
N30 M30
