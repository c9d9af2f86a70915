%AFTER
; wrong: X moves, its friction state is what the program before has left
N10 G90
N20 G01 X0 F1500
N30 M30
