%IMPLICIT
; No program is configured for these: they are passed over and counted.
N10 G81[5, 2, , 10]
N20 G800[1]
N30 T3 M6
N40 M30
