%MACRO
; wrong: the macro contains itself
N10 "STEP" = "H10 \"STEP\" P1=5"
N20 "STEP"
N30 M30
