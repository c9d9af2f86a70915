%MACRO
; wrong: the macro contains itself
N10 "STEP" = "G01 X50 \"STEP\" F1500"
N20 "STEP"
N30 M30
