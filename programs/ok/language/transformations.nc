%CHAIN
; Positions are those of the program from here on.
N10 G0 X10 Y10
N20 #CS ON [0, 0, 0, 0, 0, 45]
N30 X20
N40 #CS OFF
N50 G41 G1 X5 Y5 F500
N60 X10
N70 G40
N80 G21
N90 G20
N100 M30
