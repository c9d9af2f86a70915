%CHORD
; wrong: the chord is longer than the diameter
N10 P1 = 20  P2 = 50
N20 P3 = SQRT[P1*P1 - P2*P2]
N30 M30
