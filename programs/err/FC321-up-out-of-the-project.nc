%POCKET
; wrong: the folder ok lies beside the folder of the configuration
N10 G90
N20 L ../ok/not-called.nc
N30 G01 X50 F1500
N40 M30
