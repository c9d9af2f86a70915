%COOLANT
; M words may carry a value; words of tool and spindle
N10 T5 D5 M6
N20 M3 S1200 M8
N30 M200=1200
N40 G01 X50 F1500 M201=-3.5
N50 H12 M9
N60 M5
N70 M30
