%FACE
; Somebody believed that Z is compensated: its P-AXIS-00522 is 0.
N10 Z[COMP OFF FRICT]
N20 G01 Z-2 F600
N30 M30
