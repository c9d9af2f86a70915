%CYCLES
; Implicit calls with values, empty places among them
N10 G01 X0 Y0 F1500
N20 G800[10, 20, , 5]
N30 G81 [2.5, -12]
N40 G815
N50 M30
