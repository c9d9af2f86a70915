%FINISH
; wrong: nothing follows the multiplication sign
N10 P1 = 3 *
N20 G01 X50 F1500
N30 M30
