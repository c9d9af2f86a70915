%SKIP
; Run with `--skip 2`, the block of level 2 is not executed.
/1 N10 G0 X0
/2 N20 X10
/10 N30 X20
N40 M30
