%NUMBERS
; The order of block numbers is free, they may be left out
N100 G90
N20 G01 X50 F1500
G00 X0
N20 M30
