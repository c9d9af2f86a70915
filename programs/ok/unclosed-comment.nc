%OPEN
; A parenthesis that is not closed ends with its line
N10 G90 (roughing X[COMP OFF FRICT]
N20 G01 X50 F1500 (feed (for steel) X[COMP OFF FRICT]
N30 G00 X0
N40 M30
