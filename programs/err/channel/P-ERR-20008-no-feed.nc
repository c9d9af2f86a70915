%FACE
N10 G90 G17
; wrong: neither the program nor the channel list gives a feed
N20 G01 X10
N30 G00 X0
N40 M30
