%CONTINUED
; A command over several lines, with block numbers, comments and blank lines
N10 X[COMP OFF \ ; the kinds follow
; nothing is lost by a comment line
N20 FRICT \

N30 LEAD NO_MOVE]
N40 G01 X50 \
N50 Y20 F1500
N60 X[COMP \
ON FRICT]
N70 M30
