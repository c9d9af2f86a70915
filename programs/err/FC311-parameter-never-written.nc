%FINISH
; wrong: P5 is read, but nothing wrote it
N10 P4 = 50
N20 G01 XP5 F1500
N30 M30
