%FACE
; wrong: the feed of the second move is 0
N10 G01 X10 F500
N20 G01 X20 F0
N30 M30
