%POCKET
; wrong: there is no file not-there.nc
N10 G90
N20 L not-there.nc
N30 G01 X50 F1500
N40 M30
