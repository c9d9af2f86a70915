%RING
; wrong: R on a circle that ends where it starts
N10 G01 X10 Y0 F1000
N20 G02 X10 Y0 R5
N30 M30
