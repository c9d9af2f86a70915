%FINISH
; wrong: OFF_ALL takes friction compensation with it
N10 Y[COMP OFF_ALL]
N20 G01 Y50 F1500
N30 M30
