%SLOT
; Nothing says whether Y is compensated: on a machine where it is, the next program cuts without it.
N10 G90 G00 X0 Y0
N20 Y[COMP OFF FRICT]
N30 G01 X40 Y5 F1500
N40 Y[COMP OFF_ALL]
N50 G01 Y0
N60 M30
