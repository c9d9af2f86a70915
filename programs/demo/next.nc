%NEXT
; A contour with reversals of X and Y. Friction compensation is not
; mentioned: whether it works here is decided by the program before.
N10 G17 G90 G94
N20 G00 X0 Y0 Z5
N30 G01 Z-2 F500
N40 G01 X40 F2000
N50 G03 X60 Y20 I0 J20
N60 G01 Y60
N70 G03 X40 Y80 I-20 J0
N80 G01 X0
N90 G01 Y0
N100 G00 Z50
N110 M30
