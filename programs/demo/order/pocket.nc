%POCKET
; says nothing about friction compensation: it runs with what it finds
N10 G00 X0 Y0
N20 G01 X40 F1500
N30 Y30
N40 X0
N50 Y0
N60 M30
