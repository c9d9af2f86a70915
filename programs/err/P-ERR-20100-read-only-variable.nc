N10 X10
; wrong: the control counts the blocks itself
N20 V.G.BLOCK_NR = 5
N30 M30
