%MIRROR
; G20 to G23 mirror, they are neither inch nor metric
N10 G71 G90
N20 G21
N30 G01 X50 Y20 F1500
N40 G20
N50 G01 X0 Y0
N60 M30
